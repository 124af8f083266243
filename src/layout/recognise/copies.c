/// Equal components side by side, sixteen to a herd: many copies of a robot, a rag doll, a tree.
///
/// Two components are equal if a search from the lowest id of each, which goes through the springs of a particle by
/// rising id, meets the same graph. So copies that were built by the same calls are found, wherever they lie and
/// whatever their springs are, without comparing graphs of any order.
///
/// Each shape is laid out alone to see what it consists of. One that is all lattice or all strand stays so: rows of
/// lattices side by side take as long for 3x3 particles, and 0.7 of the time for 6x6. A spring that is left over
/// costs as much as twenty of a lattice's where it pulls at rows, and as much as two in a herd.
#include "base/mix.h"
#include "layout/emit/assembly.h"

/// Of shapes that are partly lattice or strand: springs of these for each that is left over, up to which a
/// component is better off in a herd, and copies from which it stands there. With another copy, or one less, bits
/// must not change in batches of which a host compares robots one by one.
#define MOST_REGULAR 20
#define FEWEST_MIXED 64

/// What is known of a particle: nothing, that its component is none of these, or one more than its number there.
#define UNKNOWN 0
#define IN_OTHER UINT16_MAX

static mspring_result out_of_memory(const mspringi_copies *copies, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to compare %u components",
                         (unsigned)copies->count);
}

static uint32_t neighbour(const mspringi_graph *graph, uint32_t particle, uint32_t i) {
    return mspringi_other_end(&graph->builder->springs[graph->springs[graph->first[particle] + i]], particle);
}

/* ------------------------------------------------------------------------------------------------- components */

mspring_result mspringi_copies_begin(mspringi_copies *copies, const mspringi_graph *graph, mspringi_memory *memory,
                                     mspringi_message *message) {
    copies->number = mspringi_alloc(memory, graph->builder->particle_count, sizeof *copies->number);
    return copies->number ? MSPRING_OK : out_of_memory(copies, message);
}

// Number all that a particle is joined with, in queue. Returns how many these are; 0 if they are too many.
static uint32_t explore(const mspringi_copies *copies, const mspringi_graph *graph, uint32_t start,
                        uint32_t *queue) {
    uint32_t count = 1, ends = 0;
    bool is_small = true;
    queue[0] = start;
    copies->number[start] = 1;
    for (uint32_t at = 0; is_small && at < count; ++at) {
        ends += mspringi_degree_of(graph, queue[at]);
        is_small = ends <= MSPRINGI_MOST_ENDS;
        for (uint32_t i = 0; is_small && i < mspringi_degree_of(graph, queue[at]); ++i) {
            const uint32_t other = neighbour(graph, queue[at], i);
            is_small = copies->number[other] != IN_OTHER &&
                       (copies->number[other] != UNKNOWN || count < MSPRINGI_LARGEST_COPY);
            if (!is_small || copies->number[other] != UNKNOWN)
                continue;
            queue[count++] = other;
            copies->number[other] = (uint16_t)count;
        }
    }
    for (uint32_t i = 0; !is_small && i < count; ++i)
        copies->number[queue[i]] = IN_OTHER;
    return is_small ? count : 0;
}

void mspringi_copies_explore(mspringi_copies *copies, const mspringi_graph *graph, const uint8_t *kinds,
                             uint32_t first, uint32_t end) {
    uint32_t queue[MSPRINGI_LARGEST_COPY];
    for (uint32_t p = first; p < end; ++p) {
        if (copies->number[p] != UNKNOWN || kinds[p] != MSPRINGI_ROW_LOOSE || mspringi_degree_of(graph, p) == 0)
            continue;
        const uint32_t count = explore(copies, graph, p, queue);
        copies->count += count > 0;
        copies->particle_count += count;
    }
}

mspring_result mspringi_copies_reserve(mspringi_copies *copies, mspringi_memory *memory,
                                       mspringi_message *message) {
    if (copies->count < MSPRINGI_WIDTH)
        return MSPRING_OK;
    copies->in_order = mspringi_alloc(memory, copies->particle_count, sizeof *copies->in_order);
    copies->first = mspringi_alloc(memory, (size_t)copies->count + 1, sizeof *copies->first);
    copies->keys = mspringi_alloc(memory, copies->count, sizeof *copies->keys);
    copies->scratch = mspringi_alloc(memory, copies->count, sizeof *copies->scratch);
    copies->chosen = mspringi_alloc(memory, copies->count, sizeof *copies->chosen);
    return copies->in_order && copies->first && copies->keys && copies->scratch && copies->chosen
               ? MSPRING_OK
               : out_of_memory(copies, message);
}

// List a component's particles by number. Returns a hash of its graph.
static uint64_t list_component(const mspringi_copies *copies, const mspringi_graph *graph, uint32_t start,
                               uint32_t *to, uint32_t *count) {
    uint64_t hash = MSPRINGI_MIX_START;
    *count = 1;
    to[0] = start;
    for (uint32_t at = 0; at < *count; ++at) {
        hash = mspringi_mix(hash, mspringi_degree_of(graph, to[at]));
        for (uint32_t i = 0; i < mspringi_degree_of(graph, to[at]); ++i) {
            const uint32_t other = neighbour(graph, to[at], i);
            hash = mspringi_mix(hash, copies->number[other]);
            if (copies->number[other] > *count)
                to[(*count)++] = other;
        }
    }
    return hash;
}

void mspringi_copies_list(mspringi_copies *copies, const mspringi_graph *graph, uint32_t first, uint32_t end) {
    for (uint32_t p = first; copies->in_order && p < end; ++p) {
        if (copies->number[p] != 1)
            continue;
        uint32_t count;
        const uint32_t begin = copies->first[copies->listed];
        const uint64_t hash = list_component(copies, graph, p, copies->in_order + begin, &count);
        copies->keys[copies->listed] = hash << 32 | copies->listed;
        copies->first[++copies->listed] = begin + count;
    }
}

/* ----------------------------------------------------------------------------------------------------- shapes */

static uint32_t component_of(uint64_t key) {
    return (uint32_t)key;
}

static uint32_t size_of(const mspringi_copies *copies, uint32_t component) {
    return copies->first[component + 1] - copies->first[component];
}

static bool are_equal(const mspringi_copies *copies, const mspringi_graph *graph, uint32_t one, uint32_t other) {
    const uint32_t *a = copies->in_order + copies->first[one], *b = copies->in_order + copies->first[other];
    if (size_of(copies, one) != size_of(copies, other))
        return false;
    for (uint32_t at = 0; at < size_of(copies, one); ++at) {
        const uint32_t degree = mspringi_degree_of(graph, a[at]);
        if (mspringi_degree_of(graph, b[at]) != degree)
            return false;
        for (uint32_t i = 0; i < degree; ++i)
            if (copies->number[neighbour(graph, a[at], i)] != copies->number[neighbour(graph, b[at], i)])
                return false;
    }
    return true;
}

static uint32_t springs_of(const mspringi_copies *copies, const mspringi_graph *graph, uint32_t component) {
    uint32_t ends = 0;
    for (uint32_t i = copies->first[component]; i < copies->first[component + 1]; ++i)
        ends += mspringi_degree_of(graph, copies->in_order[i]);
    return ends / 2;
}

// A builder of a component alone, with no more than a layout looks at.
static void fill_builder(const mspringi_copies *copies, const mspringi_graph *graph, uint32_t component,
                         struct mspring_builder *alone) {
    const uint32_t *particles = copies->in_order + copies->first[component];
    for (uint32_t at = 0; at < alone->particle_count; ++at) {
        alone->particles[at] = graph->builder->particles[particles[at]];
        for (uint32_t i = 0; i < mspringi_degree_of(graph, particles[at]); ++i) {
            const uint32_t other = copies->number[neighbour(graph, particles[at], i)] - 1u;
            if (other > at)
                alone->springs[alone->spring_count++] = (mspringi_spring){.a = at, .b = other};
        }
    }
}

// Lay out a component alone, to see how many of its springs are left over.
static mspring_result lay_out(mspringi_assembly *a, struct mspring_builder *alone, uint32_t *irregular) {
    const mspringi_reserve reserve = {.particle_end = (uint32_t)alone->particle_count,
                                      .spring_end = (uint32_t)alone->spring_count};
    mspringi_assembly *begun = NULL;
    mspring_result result =
        mspringi_topology_begin(alone, &reserve, true, false, 1, a->lanes, a->memory, a->message, &begun);
    for (bool is_done = false; result == MSPRING_OK && !is_done;)
        result = mspringi_topology_run(begun, &is_done);
    *irregular = result == MSPRING_OK ? begun->made.leftover_count : 0;
    mspringi_topology_abandon(begun, a->memory);
    return result;
}

static mspring_result look_at_shape(mspringi_assembly *a, uint32_t component, uint32_t *irregular) {
    struct mspring_builder alone = {.particle_count = size_of(&a->copies, component)};
    const uint32_t springs = springs_of(&a->copies, &a->graph, component);
    alone.particles = mspringi_alloc(a->memory, alone.particle_count, sizeof *alone.particles);
    alone.springs = mspringi_alloc(a->memory, springs, sizeof *alone.springs);
    mspring_result result = MSPRING_OK;
    if (alone.particles && alone.springs) {
        fill_builder(&a->copies, &a->graph, component, &alone);
        result = lay_out(a, &alone, irregular);
    } else {
        result = out_of_memory(&a->copies, a->message);
    }
    mspringi_free(a->memory, alone.particles);
    mspringi_free(a->memory, alone.springs);
    return result;
}

/* ------------------------------------------------------------------------------------------------------ herds */

static bool stand_in_herds(uint32_t copies, uint32_t springs, uint32_t irregular) {
    const uint32_t regular = springs - irregular;
    return irregular > 0 && (regular == 0 || (copies >= FEWEST_MIXED && regular <= MOST_REGULAR * irregular));
}

// Choose whole herds of the components that have the same hash, and the same shape as the first one.
static mspring_result choose(mspringi_assembly *a, uint32_t begin, uint32_t end) {
    mspringi_copies *copies = &a->copies;
    const uint32_t model = component_of(copies->keys[begin]);
    uint32_t *chosen = copies->chosen + copies->chosen_count, count = 0, irregular = 0;
    for (uint32_t i = begin; end - begin >= MSPRINGI_WIDTH && i < end; ++i)
        if (are_equal(copies, &a->graph, model, component_of(copies->keys[i])))
            chosen[count++] = component_of(copies->keys[i]);
    const uint32_t herds = count / MSPRINGI_WIDTH, springs = springs_of(copies, &a->graph, model);
    const mspring_result result = herds > 0 ? look_at_shape(a, model, &irregular) : MSPRING_OK;
    if (stand_in_herds(count, springs, irregular)) {
        for (uint32_t i = herds * MSPRINGI_WIDTH; i < count; ++i)
            copies->chosen[copies->count - ++copies->left_count] = chosen[i];
        copies->chosen_count += herds * MSPRINGI_WIDTH;
        copies->group_count += herds * size_of(copies, model);
        a->herds.spring_count += herds * springs;
    }
    return result;
}

// Where the components end that have the same hash as this one.
static uint32_t end_of_run(const mspringi_copies *copies, uint32_t begin) {
    uint32_t end = begin + 1;
    while (end < copies->count && copies->keys[end] >> 32 == copies->keys[begin] >> 32)
        ++end;
    return end;
}

// One shape at a time; those of which there are too few are passed over.
mspring_result mspringi_copies_choose(mspringi_assembly *a) {
    mspringi_copies *copies = &a->copies;
    if (!copies->in_order)
        return MSPRING_OK;
    if (copies->looked_at == 0)
        mspringi_sort_keys(copies->keys, copies->scratch, copies->count);
    uint32_t begin = copies->looked_at, end = end_of_run(copies, begin);
    for (; end - begin < MSPRINGI_WIDTH && end < copies->count; end = end_of_run(copies, begin))
        begin = end;
    copies->looked_at = end;
    a->cursor.again = end < copies->count;
    return choose(a, begin, end);
}

// Put a herd of chosen components behind the others.
static void stand(mspringi_assembly *a, const uint32_t *chosen) {
    mspringi_herds *herds = &a->herds;
    const uint32_t size = size_of(&a->copies, chosen[0]);
    for (uint32_t node = 0; node < size; ++node, ++herds->group_count) {
        herds->is_first[herds->group_count] = node == 0;
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const uint32_t p = a->copies.in_order[a->copies.first[chosen[lane]] + node];
            herds->particles[herds->group_count * MSPRINGI_WIDTH + lane] = p;
            a->kinds[p] = MSPRINGI_ROW_WEB;
        }
    }
}

// Of the components that are left of the chosen shapes.
static void mark_left(mspringi_assembly *a, mspringi_row_kind kind) {
    const mspringi_copies *copies = &a->copies;
    for (uint32_t i = copies->count - copies->left_count; i < copies->count; ++i)
        for (uint32_t at = copies->first[copies->chosen[i]]; at < copies->first[copies->chosen[i] + 1]; ++at)
            a->kinds[copies->in_order[at]] = (uint8_t)kind;
}

mspring_result mspringi_copies_fill(mspringi_assembly *a) {
    mspringi_herds *herds = &a->herds;
    if (a->copies.group_count > 0) {
        herds->particles =
            mspringi_alloc(a->memory, (size_t)a->copies.group_count * MSPRINGI_WIDTH, sizeof *herds->particles);
        herds->is_first = mspringi_alloc(a->memory, a->copies.group_count, sizeof *herds->is_first);
        if (!herds->particles || !herds->is_first)
            return out_of_memory(&a->copies, a->message);
    }
    for (uint32_t i = 0; i < a->copies.chosen_count; i += MSPRINGI_WIDTH)
        stand(a, a->copies.chosen + i);
    mark_left(a, MSPRINGI_ROW_WEB);
    return MSPRING_OK;
}

mspring_result mspringi_copies_release(mspringi_assembly *a) {
    mark_left(a, MSPRINGI_ROW_LOOSE);
    mspringi_copies_destroy(&a->copies, a->memory);
    return MSPRING_OK;
}

void mspringi_copies_destroy(mspringi_copies *copies, mspringi_memory *memory) {
    mspringi_free(memory, copies->number);
    mspringi_free(memory, copies->in_order);
    mspringi_free(memory, copies->first);
    mspringi_free(memory, copies->keys);
    mspringi_free(memory, copies->scratch);
    mspringi_free(memory, copies->chosen);
    *copies = (mspringi_copies){0};
}
