/// Equal components side by side, sixteen to a bundle: copies of a robot, a rag doll or a tree.
///
/// Two components are equal if breadth-first searches from the lowest id of each, through incident springs by
/// rising id, meet the same graph. This finds copies that the same calls built, wherever they lie and whatever
/// their springs are, without a general test of isomorphism.
///
/// One component of each shape is laid out alone. If it is all lattice or all chain, it stays so. Lattice rows side
/// by side take as long as bundles for 3x3 particles, and 0.7 of the time for 6x6. An irregular spring costs as
/// much as twenty lattice springs if it joins rows, and as two in a bundle.
#include "base/hash.h"
#include "layout/emit/layout_builder.h"

/// Shapes that are partly lattice or chain: most lattice and chain springs for each irregular one in a bundle, and
/// fewest copies. A host may compare the robots of a batch one by one, so one copy more or less must not change
/// bits.
#define MAX_REGULAR_PER_IRREGULAR 20
#define MIN_MIXED_COMPONENTS 64

/// State of a particle: not visited, in no such component, or 1 + its number in one.
#define NOT_VISITED 0
#define NOT_ELIGIBLE UINT16_MAX

static mspring_result out_of_memory(const mspringi_equal_components *equal, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to compare %u components",
                         (unsigned)equal->count);
}

static uint32_t neighbour(const mspringi_graph *graph, uint32_t particle, uint32_t i) {
    return graph->others[graph->first[particle] + i];
}

/* ------------------------------------------------------------------------------------------------- components */

mspring_result mspringi_equal_components_begin(mspringi_equal_components *equal, const mspringi_graph *graph,
                                               mspringi_memory *memory, mspringi_message *message) {
    equal->number = mspringi_alloc(memory, graph->builder->particle_count, sizeof *equal->number);
    return equal->number ? MSPRING_OK : out_of_memory(equal, message);
}

// Number the particles of a component, and list them in queue. Return their number, or 0 if there are too many.
static uint32_t explore(const mspringi_equal_components *equal, const mspringi_graph *graph, uint32_t start,
                        uint32_t *queue) {
    uint32_t count = 1, ends = 0;
    bool is_small = true;
    queue[0] = start;
    equal->number[start] = 1;
    for (uint32_t at = 0; is_small && at < count; ++at) {
        ends += mspringi_degree_of(graph, queue[at]);
        is_small = ends <= MSPRINGI_MAX_SPRING_ENDS;
        for (uint32_t i = 0; is_small && i < mspringi_degree_of(graph, queue[at]); ++i) {
            const uint32_t other = neighbour(graph, queue[at], i);
            is_small = equal->number[other] != NOT_ELIGIBLE &&
                       (equal->number[other] != NOT_VISITED || count < MSPRINGI_MAX_COMPONENT);
            if (!is_small || equal->number[other] != NOT_VISITED)
                continue;
            queue[count++] = other;
            equal->number[other] = (uint16_t)count;
        }
    }
    for (uint32_t i = 0; !is_small && i < count; ++i)
        equal->number[queue[i]] = NOT_ELIGIBLE;
    return is_small ? count : 0;
}

void mspringi_equal_components_explore(mspringi_equal_components *equal, const mspringi_graph *graph,
                                       const uint8_t *kinds, uint32_t first, uint32_t end) {
    uint32_t queue[MSPRINGI_MAX_COMPONENT];
    for (uint32_t p = first; p < end; ++p) {
        if (equal->number[p] != NOT_VISITED || kinds[p] != MSPRINGI_ROW_LOOSE || mspringi_degree_of(graph, p) == 0)
            continue;
        const uint32_t count = explore(equal, graph, p, queue);
        equal->count += count > 0;
        equal->particle_count += count;
    }
}

mspring_result mspringi_equal_components_reserve(mspringi_equal_components *equal, mspringi_memory *memory,
                                                 mspringi_message *message) {
    if (equal->count < MSPRINGI_WIDTH)
        return MSPRING_OK;
    equal->in_order = mspringi_alloc(memory, equal->particle_count, sizeof *equal->in_order);
    equal->first = mspringi_alloc(memory, (size_t)equal->count + 1, sizeof *equal->first);
    equal->keys = mspringi_alloc(memory, equal->count, sizeof *equal->keys);
    equal->scratch = mspringi_alloc(memory, equal->count, sizeof *equal->scratch);
    equal->chosen = mspringi_alloc(memory, equal->count, sizeof *equal->chosen);
    return equal->in_order && equal->first && equal->keys && equal->scratch && equal->chosen
               ? MSPRING_OK
               : out_of_memory(equal, message);
}

// List a component's particles by number. Return a hash of its graph.
static uint64_t list_component(const mspringi_equal_components *equal, const mspringi_graph *graph, uint32_t start,
                               uint32_t *to, uint32_t *count) {
    uint64_t hash = MSPRINGI_HASH_START;
    *count = 1;
    to[0] = start;
    for (uint32_t at = 0; at < *count; ++at) {
        hash = mspringi_hash(hash, mspringi_degree_of(graph, to[at]));
        for (uint32_t i = 0; i < mspringi_degree_of(graph, to[at]); ++i) {
            const uint32_t other = neighbour(graph, to[at], i);
            hash = mspringi_hash(hash, equal->number[other]);
            if (equal->number[other] > *count)
                to[(*count)++] = other;
        }
    }
    return hash;
}

void mspringi_equal_components_list(mspringi_equal_components *equal, const mspringi_graph *graph, uint32_t first,
                                    uint32_t end) {
    for (uint32_t p = first; equal->in_order && p < end; ++p) {
        if (equal->number[p] != 1)
            continue;
        uint32_t count;
        const uint32_t begin = equal->first[equal->listed];
        const uint64_t hash = list_component(equal, graph, p, equal->in_order + begin, &count);
        equal->keys[equal->listed] = hash << 32 | equal->listed;
        equal->first[++equal->listed] = begin + count;
    }
}

/* ----------------------------------------------------------------------------------------------------- shapes */

static uint32_t component_of(uint64_t key) {
    return (uint32_t)key;
}

static uint32_t size_of(const mspringi_equal_components *equal, uint32_t component) {
    return equal->first[component + 1] - equal->first[component];
}

static bool are_equal(const mspringi_equal_components *equal, const mspringi_graph *graph, uint32_t one,
                      uint32_t other) {
    const uint32_t *a = equal->in_order + equal->first[one], *b = equal->in_order + equal->first[other];
    if (size_of(equal, one) != size_of(equal, other))
        return false;
    for (uint32_t at = 0; at < size_of(equal, one); ++at) {
        const uint32_t degree = mspringi_degree_of(graph, a[at]);
        if (mspringi_degree_of(graph, b[at]) != degree)
            return false;
        for (uint32_t i = 0; i < degree; ++i)
            if (equal->number[neighbour(graph, a[at], i)] != equal->number[neighbour(graph, b[at], i)])
                return false;
    }
    return true;
}

static uint32_t springs_of(const mspringi_equal_components *equal, const mspringi_graph *graph,
                           uint32_t component) {
    uint32_t ends = 0;
    for (uint32_t i = equal->first[component]; i < equal->first[component + 1]; ++i)
        ends += mspringi_degree_of(graph, equal->in_order[i]);
    return ends / 2;
}

// Fill a builder with one component, as far as the layout reads it.
static void fill_builder(const mspringi_equal_components *equal, const mspringi_graph *graph, uint32_t component,
                         struct mspring_builder *alone) {
    const uint32_t *particles = equal->in_order + equal->first[component];
    for (uint32_t at = 0; at < alone->particle_count; ++at) {
        alone->particles[at] = graph->builder->particles[particles[at]];
        for (uint32_t i = 0; i < mspringi_degree_of(graph, particles[at]); ++i) {
            const uint32_t other = equal->number[neighbour(graph, particles[at], i)] - 1u;
            if (other > at)
                alone->springs[alone->spring_count++] = (mspringi_spring){.a = at, .b = other};
        }
    }
}

// Lay out a component alone and count its irregular springs.
static mspring_result lay_out(mspringi_layout_builder *a, struct mspring_builder *alone, uint32_t *irregular) {
    const mspringi_reserve reserve = {.particle_end = (uint32_t)alone->particle_count,
                                      .spring_end = (uint32_t)alone->spring_count};
    mspringi_layout_builder *begun = NULL;
    mspring_result result =
        mspringi_topology_begin(alone, &reserve, true, false, 1, a->lanes, a->memory, a->message, &begun);
    for (bool is_done = false; result == MSPRING_OK && !is_done;)
        result = mspringi_topology_run(begun, &is_done);
    *irregular = result == MSPRING_OK ? begun->made.irregular_count : 0;
    mspringi_topology_abandon(begun, a->memory);
    return result;
}

static mspring_result count_irregular_springs(mspringi_layout_builder *a, uint32_t component, uint32_t *irregular) {
    struct mspring_builder alone = {.particle_count = size_of(&a->equal_components, component)};
    const uint32_t springs = springs_of(&a->equal_components, &a->graph, component);
    alone.particles = mspringi_alloc(a->memory, alone.particle_count, sizeof *alone.particles);
    alone.springs = mspringi_alloc(a->memory, springs, sizeof *alone.springs);
    mspring_result result = MSPRING_OK;
    if (alone.particles && alone.springs) {
        fill_builder(&a->equal_components, &a->graph, component, &alone);
        result = lay_out(a, &alone, irregular);
    } else {
        result = out_of_memory(&a->equal_components, a->message);
    }
    mspringi_free(a->memory, alone.particles);
    mspringi_free(a->memory, alone.springs);
    return result;
}

/* ------------------------------------------------------------------------------------------------------ bundles */

static bool is_worth_bundling(uint32_t equal, uint32_t springs, uint32_t irregular) {
    const uint32_t regular = springs - irregular;
    return irregular > 0 &&
           (regular == 0 || (equal >= MIN_MIXED_COMPONENTS && regular <= MAX_REGULAR_PER_IRREGULAR * irregular));
}

// Choose whole bundles from components of equal hash that have the shape of the first one.
static mspring_result choose_bundles(mspringi_layout_builder *a, uint32_t begin, uint32_t end) {
    mspringi_equal_components *equal = &a->equal_components;
    const uint32_t model = component_of(equal->keys[begin]);
    uint32_t *chosen = equal->chosen + equal->chosen_count, count = 0, irregular = 0;
    for (uint32_t i = begin; end - begin >= MSPRINGI_WIDTH && i < end; ++i)
        if (are_equal(equal, &a->graph, model, component_of(equal->keys[i])))
            chosen[count++] = component_of(equal->keys[i]);
    const uint32_t bundles = count / MSPRINGI_WIDTH, springs = springs_of(equal, &a->graph, model);
    const mspring_result result = bundles > 0 ? count_irregular_springs(a, model, &irregular) : MSPRING_OK;
    if (is_worth_bundling(count, springs, irregular)) {
        // Backwards: chosen ends where the rest begins if the network has this shape only.
        for (uint32_t i = count; i > bundles * MSPRINGI_WIDTH; --i)
            equal->chosen[equal->count - ++equal->rest_count] = chosen[i - 1];
        equal->chosen_count += bundles * MSPRINGI_WIDTH;
        equal->slice_count += bundles * size_of(equal, model);
        a->bundles.spring_count += bundles * springs;
    }
    return result;
}

// End of the components with the same hash as this one.
static uint32_t end_of_run(const mspringi_equal_components *equal, uint32_t begin) {
    uint32_t end = begin + 1;
    while (end < equal->count && equal->keys[end] >> 32 == equal->keys[begin] >> 32)
        ++end;
    return end;
}

// Visit one shape at a time. Skip those with too few components.
mspring_result mspringi_equal_components_choose(mspringi_layout_builder *a) {
    mspringi_equal_components *equal = &a->equal_components;
    if (!equal->in_order)
        return MSPRING_OK;
    if (equal->next_key == 0)
        mspringi_sort_keys(equal->keys, equal->scratch, equal->count);
    uint32_t begin = equal->next_key, end = end_of_run(equal, begin);
    for (; end - begin < MSPRINGI_WIDTH && end < equal->count; end = end_of_run(equal, begin))
        begin = end;
    equal->next_key = end;
    a->cursor.again = end < equal->count;
    return choose_bundles(a, begin, end);
}

// Append a bundle of chosen components.
static void append_bundle(mspringi_layout_builder *a, const uint32_t *chosen) {
    mspringi_bundles *bundles = &a->bundles;
    const uint32_t size = size_of(&a->equal_components, chosen[0]);
    for (uint32_t node = 0; node < size; ++node, ++bundles->slice_count) {
        bundles->is_first[bundles->slice_count] = node == 0;
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const uint32_t p = a->equal_components.in_order[a->equal_components.first[chosen[lane]] + node];
            bundles->particles[bundles->slice_count * MSPRINGI_WIDTH + lane] = p;
            a->kinds[p] = MSPRINGI_ROW_IRREGULAR;
        }
    }
}

// Set the kind of the components that share a chosen shape but fill no bundle.
static void mark_rest(mspringi_layout_builder *a, mspringi_row_kind kind) {
    const mspringi_equal_components *equal = &a->equal_components;
    for (uint32_t i = equal->count - equal->rest_count; i < equal->count; ++i)
        for (uint32_t at = equal->first[equal->chosen[i]]; at < equal->first[equal->chosen[i] + 1]; ++at)
            a->kinds[equal->in_order[at]] = (uint8_t)kind;
}

mspring_result mspringi_equal_components_fill(mspringi_layout_builder *a) {
    mspringi_bundles *bundles = &a->bundles;
    if (a->equal_components.slice_count > 0) {
        bundles->particles = mspringi_alloc(a->memory, (size_t)a->equal_components.slice_count * MSPRINGI_WIDTH,
                                            sizeof *bundles->particles);
        bundles->is_first = mspringi_alloc(a->memory, a->equal_components.slice_count, sizeof *bundles->is_first);
        if (!bundles->particles || !bundles->is_first)
            return out_of_memory(&a->equal_components, a->message);
    }
    for (uint32_t i = 0; i < a->equal_components.chosen_count; i += MSPRINGI_WIDTH)
        append_bundle(a, a->equal_components.chosen + i);
    mark_rest(a, MSPRINGI_ROW_IRREGULAR);
    return MSPRING_OK;
}

mspring_result mspringi_equal_components_release(mspringi_layout_builder *a) {
    mark_rest(a, MSPRINGI_ROW_LOOSE);
    mspringi_equal_components_destroy(&a->equal_components, a->memory);
    return MSPRING_OK;
}

void mspringi_equal_components_destroy(mspringi_equal_components *equal, mspringi_memory *memory) {
    mspringi_free(memory, equal->number);
    mspringi_free(memory, equal->in_order);
    mspringi_free(memory, equal->first);
    mspringi_free(memory, equal->keys);
    mspringi_free(memory, equal->scratch);
    mspringi_free(memory, equal->chosen);
    *equal = (mspringi_equal_components){0};
}
