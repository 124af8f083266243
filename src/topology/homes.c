/// Homes: which lattice rows the particles of ropes and other oddments are swept with.
///
/// Strips of rows are swept for several substeps in one pass, each substep some strips behind the one before: the
/// lag. A leftover spring needs both its ends as they were at the substep before, so its ends must be swept within
/// lag strips of each other. For a given lag, the highest and lowest strip that each particle can have follow from
/// the lattice particles that it hangs on (the extensions of a Lipschitz function by McShane, 1934); halfway
/// between them is a solution too, and the smoothest of the three.
#include <string.h>

#include "analysis.h"
#include "base/forest.h"

/// Particles in the rows of a strip, about: few strips cost fewer calls, small ones fit the cache more often. Where
/// something hangs on them, each has oddments to sweep, and few such sweeps are better than many (40 ropes on our
/// ship, ratio to naive with 512: 4.2 at AVX2, 7.7 at AVX-512; with 2048: 4.5 and 8.3).
#define BARE_STRIP_PARTICLES 512
#define STRIP_PARTICLES 2048

/// Particles of lattices from which a step is worth sharing.
#define FEWEST_SHARED 4000

/// Strips that each of several workers should find, so that it need not wait for those before and behind it. With 24
/// of them, single rows of 96 x 96, calls took an eighth of the time: two workers came to 0.83 of what two threads
/// that share nothing do, and with 8, 12 and 16 to 0.9.
#define STRIPS_PER_WORKER 12

/// Whether the rows of a component can be swept together.
enum { FIT, UNFIT_FOR_LAG, UNFIT };

/// What is done one after the other once something hangs on the lattices; from NUMBERS on for each lag anew.
typedef enum homes_stage {
    JOINS_SPRINGS, ///< the components of what springs join,
    JOINS_MEMBERS, ///< and of what shares rows
    WEIGHS_MEMBERS,
    WEIGHS_STRANDS,
    JUDGES,      ///< which components are ropy
    NUMBERS,     ///< rows and strips
    BOUNDS_ROWS, ///< each lattice particle's strip
    BEGINS,      ///< with the attached ones
    SPREADS,     ///< from there: these three once from below, once upside down
    COMBINES,    ///< both bounds
    RELENTS,     ///< some component does not fit this lag
    IS_FOUND
} homes_stage;

typedef struct mspringi_homes_finder {
    const mspringi_graph *graph;
    const mspringi_grids *grids;
    const mspringi_strands *strands;
    mspringi_homes *homes;
    uint32_t strip_particles; ///< in a strip, about
    uint32_t *height;         ///< [grids] rows
    uint32_t *component;      ///< [particles] parent in a forest; its roots name the components
    int64_t *balance;         ///< [particles] of roots: lattice particles less strands'
    uint8_t *fitness;         ///< [particles] of roots
    uint32_t *attached;       ///< [attached_count] lattice particles with leftover springs
    uint32_t attached_count;
    uint32_t *low;   ///< [particles] lowest strip that each may have
    uint32_t *queue; ///< [strips] first particle of each strip, MSPRING_NONE at the end
    uint32_t *next;  ///< [particles] next particle of the same strip

    homes_stage stage;
    uint32_t strip;   ///< strips from here on have been spread from
    bool upside_down; ///< strips count from the last, and bounds are upper ones
    bool fits;
} finder;

/* --------------------------------------------------------------------------------------------- the components */

static void join_springs(finder *f, mspringi_pace *pace) {
    const mspring_builder *builder = f->graph->builder;
    uint32_t first, end;
    mspringi_pace_take(pace, (uint32_t)builder->spring_count, 6, &first, &end);
    for (uint32_t s = first; s < end; ++s)
        mspringi_forest_join(f->component, builder->springs[s].a, builder->springs[s].b);
}

// What shares rows fits or fits not as one.
static void join_members(finder *f, mspringi_pace *pace) {
    const mspringi_grids *grids = f->grids;
    uint32_t first, end;
    mspringi_pace_take(pace, grids->member_count, 4, &first, &end);
    for (uint32_t m = first > 0 ? first : 1; m < end; ++m)
        if (grids->grid_of[grids->members[m]] == grids->grid_of[grids->members[m - 1]])
            mspringi_forest_join(f->component, grids->members[m - 1], grids->members[m]);
}

static uint8_t *fitness_of(const finder *f, uint32_t particle) {
    return &f->fitness[mspringi_forest_root(f->component, particle)];
}

static void weigh(finder *f, const uint32_t *particles, uint32_t count, int64_t weight, mspringi_pace *pace) {
    uint32_t first, end;
    mspringi_pace_take(pace, count, 2, &first, &end);
    for (uint32_t i = first; i < end; ++i)
        f->balance[mspringi_forest_root(f->component, particles[i])] += weight;
}

// Components that are more rope than lattice: their strands are better swept as chains.
static void judge(finder *f, mspringi_pace *pace) {
    uint32_t first, end;
    mspringi_pace_take(pace, (uint32_t)f->graph->builder->particle_count, 1, &first, &end);
    for (uint32_t p = first; p < end; ++p)
        f->fitness[p] = f->balance[p] < 0 ? UNFIT : FIT;
}

static bool has_leftover_spring(const finder *f, uint32_t particle) {
    for (uint32_t i = f->graph->first[particle]; i < f->graph->first[particle + 1]; ++i) {
        mspringi_lattice_spring found;
        if (!mspringi_grids_place(f->grids, &f->graph->builder->springs[f->graph->springs[i]], &found))
            return true;
    }
    return false;
}

/* -------------------------------------------------------------------------------------------------- the homes */

// Number the rows of the grids: first those that are swept together, grid after grid, then the others.
static void number_rows(finder *f) {
    mspringi_homes *homes = f->homes;
    const mspringi_grids *grids = f->grids;
    uint32_t row = 0, ordered = 0;
    for (int unfit = 0; unfit <= 1; ++unfit) {
        for (uint32_t grid = 0; grid < grids->count; ++grid) {
            const uint32_t first = grids->first_member[grid];
            if ((f->attached_count > 0 && *fitness_of(f, grids->members[first]) != FIT) != unfit)
                continue;
            homes->grid_order[ordered++] = grid;
            homes->first_row[grid] = row;
            row += f->height[grid];
        }
        if (!unfit)
            homes->row_count = row;
    }
    const uint32_t per_row = row > 0 ? grids->member_count / row : 0;
    homes->strip_rows = per_row < f->strip_particles ? f->strip_particles / (per_row + 1) : 1;
}

static uint32_t strip_count(const mspringi_homes *homes) {
    return (homes->row_count + homes->strip_rows - 1) / homes->strip_rows;
}

static void enqueue(finder *f, uint32_t particle, uint32_t strip) {
    f->next[particle] = f->queue[strip];
    f->queue[strip] = particle;
}

static void begin_spreading(finder *f, bool upside_down) {
    f->upside_down = upside_down;
    f->strip = strip_count(f->homes);
    memset(f->queue, 0xff, f->strip * sizeof *f->queue);
    memset(upside_down ? f->homes->home : f->low, 0xff, f->graph->builder->particle_count * sizeof *f->low);
}

static uint32_t *bounds_of(const finder *f) {
    return f->upside_down ? f->homes->home : f->low;
}

static void bound_rows(finder *f, mspringi_pace *pace) {
    const mspringi_grids *grids = f->grids;
    const mspringi_homes *homes = f->homes;
    const uint32_t strips = strip_count(homes);
    uint32_t *bounds = bounds_of(f), first, end;
    mspringi_pace_take(pace, grids->member_count, 2, &first, &end);
    for (uint32_t m = first; m < end; ++m) {
        const uint32_t p = grids->members[m];
        const uint32_t strip = (homes->first_row[grids->grid_of[p]] + grids->row[p]) / homes->strip_rows;
        bounds[p] = f->upside_down ? strips - 1 - strip : strip;
    }
}

static void begin_queues(finder *f, mspringi_pace *pace) {
    const uint32_t *bounds = bounds_of(f);
    uint32_t first, end;
    mspringi_pace_take(pace, f->attached_count, 4, &first, &end);
    for (uint32_t i = first; i < end; ++i)
        if (*fitness_of(f, f->attached[i]) == FIT)
            enqueue(f, f->attached[i], bounds[f->attached[i]]);
}

// From one particle to its neighbours: they have a bound lower by the lag, and the highest bound counts.
static void spread_from(finder *f, uint32_t p, uint32_t *bounds) {
    const mspringi_graph *graph = f->graph;
    const uint32_t lag = f->homes->lag, bound = f->strip > lag ? f->strip - lag : 0;
    for (uint32_t i = graph->first[p]; i < graph->first[p + 1]; ++i) {
        const uint32_t other = mspringi_other_end(&graph->builder->springs[graph->springs[i]], p);
        if (bounds[other] == MSPRING_NONE) {
            bounds[other] = bound;
            enqueue(f, other, bound);
        } else if (bound > bounds[other]) {
            // Only lattice particles can be lower: all others were reached from the highest first.
            *fitness_of(f, other) = UNFIT_FOR_LAG;
            f->fits = false;
        }
    }
}

// Spread from the attached particles along leftover springs. Bounds of particles that are not reached are
// MSPRING_NONE. A component in which a lattice particle would have to be higher than it is becomes unfit. Strips
// above f->strip are done; particles are put into queues of lower ones, or of the lowest.
static void spread(finder *f, mspringi_pace *pace) {
    uint32_t *bounds = bounds_of(f);
    while (f->strip > 0 && pace->left > 0) {
        f->strip--;
        uint32_t p = f->queue[f->strip];
        for (; p != MSPRING_NONE && pace->left > 0; p = f->queue[f->strip]) {
            f->queue[f->strip] = f->next[p];
            mspringi_pace_spend(pace, 8 + (uint64_t)4 * (f->graph->first[p + 1] - f->graph->first[p]));
            spread_from(f, p, bounds);
        }
        mspringi_pace_spend(pace, 1);
        f->strip += p != MSPRING_NONE;
    }
    pace->is_halfway = f->strip > 0;
}

static void combine(finder *f, mspringi_pace *pace) {
    mspringi_homes *homes = f->homes;
    const uint32_t strips = strip_count(homes);
    uint32_t first, end;
    mspringi_pace_take(pace, (uint32_t)f->graph->builder->particle_count, 1, &first, &end);
    for (uint32_t p = first; p < end; ++p)
        if (f->grids->grid_of[p] != MSPRING_NONE)
            homes->home[p] = MSPRING_NONE;
        else if (homes->home[p] != MSPRING_NONE)
            homes->home[p] = (f->low[p] + (strips - 1 - homes->home[p])) / 2;
}

// Components that need more than the longest lag are left out; the others get a longer one.
static void relent(finder *f, mspringi_pace *pace) {
    const bool is_longest = f->homes->lag == MSPRINGI_LONGEST_LAG;
    uint32_t first, end;
    mspringi_pace_take(pace, (uint32_t)f->graph->builder->particle_count, 1, &first, &end);
    for (uint32_t p = first; p < end; ++p)
        if (f->fitness[p] == UNFIT_FOR_LAG)
            f->fitness[p] = is_longest ? UNFIT : FIT;
    if (!pace->is_halfway)
        f->homes->lag += !is_longest;
}

// Where nothing hangs on the lattices, strips are as small as the workers want them: no slot depends on it. Homes
// must not depend on the workers, since the order of slots is that of sums.
static void number_rows_for(finder *f, uint32_t workers) {
    const uint32_t wanted = f->grids->member_count / workers / STRIPS_PER_WORKER;
    if (workers > 1 && f->grids->member_count >= FEWEST_SHARED && wanted < f->strip_particles)
        f->strip_particles = wanted;
    number_rows(f);
}

/* ---------------------------------------------------------------------------------------------------- the whole */

static mspring_result out_of_memory(const mspringi_graph *graph, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the homes of %zu particles",
                         graph->builder->particle_count);
}

mspring_result mspringi_homes_reserve(mspringi_homes *homes, const mspringi_graph *graph,
                                      const mspringi_grids *grids, const mspringi_strands *strands,
                                      mspringi_pace *pace, mspringi_memory *memory, mspringi_message *message) {
    const size_t particles = graph->builder->particle_count;
    finder *f = homes->finder = mspringi_alloc(memory, 1, sizeof *f);
    homes->lag = 1;
    homes->home = mspringi_pace_alloc(pace, memory, particles, sizeof *homes->home);
    homes->grid_order = mspringi_pace_alloc(pace, memory, grids->count, sizeof *homes->grid_order);
    homes->first_row = mspringi_pace_alloc(pace, memory, grids->count, sizeof *homes->first_row);
    if (f) {
        f->graph = graph;
        f->grids = grids;
        f->strands = strands;
        f->homes = homes;
        f->strip_particles = BARE_STRIP_PARTICLES;
        f->height = mspringi_pace_alloc(pace, memory, grids->count, sizeof *f->height);
        f->attached = mspringi_pace_alloc(pace, memory, grids->member_count, sizeof *f->attached);
    }
    if (!f || !homes->home || !homes->grid_order || !homes->first_row || !f->height || !f->attached)
        return out_of_memory(graph, message);
    memset(homes->home, 0xff, particles * sizeof *homes->home);
    return MSPRING_OK;
}

void mspringi_homes_attach(mspringi_homes *homes, mspringi_pace *pace) {
    finder *f = homes->finder;
    const mspringi_grids *grids = f->grids;
    uint32_t first, end;
    mspringi_pace_take(pace, grids->member_count, 24, &first, &end);
    for (uint32_t m = first; m < end; ++m) {
        const uint32_t p = grids->members[m];
        uint32_t *height = &f->height[grids->grid_of[p]];
        *height = grids->row[p] >= *height ? grids->row[p] + 1 : *height;
        if (has_leftover_spring(f, p))
            f->attached[f->attached_count++] = p;
    }
}

// What it takes to find homes, if anything hangs on the lattices.
mspring_result mspringi_homes_prepare(mspringi_homes *homes, uint32_t workers, mspringi_pace *pace,
                                      mspringi_memory *memory, mspringi_message *message) {
    finder *f = homes->finder;
    const size_t particles = f->graph->builder->particle_count;
    if (f->attached_count == 0) {
        number_rows_for(f, workers);
        f->stage = IS_FOUND;
        return MSPRING_OK;
    }
    f->component = mspringi_pace_alloc(pace, memory, particles, sizeof *f->component);
    f->balance = mspringi_pace_alloc(pace, memory, particles, sizeof *f->balance);
    f->fitness = mspringi_pace_alloc(pace, memory, particles, sizeof *f->fitness);
    f->low = mspringi_pace_alloc(pace, memory, particles, sizeof *f->low);
    f->next = mspringi_pace_alloc(pace, memory, particles, sizeof *f->next);
    // No more rows than particles.
    f->queue = mspringi_pace_alloc(pace, memory, f->grids->member_count, sizeof *f->queue);
    if (!f->component || !f->balance || !f->fitness || !f->low || !f->next || !f->queue)
        return out_of_memory(f->graph, message);
    for (uint32_t p = 0; p < particles; ++p)
        f->component[p] = p;
    f->strip_particles = STRIP_PARTICLES;
    return MSPRING_OK;
}

static void do_stage(finder *f, mspringi_pace *pace) {
    switch (f->stage) {
    case JOINS_SPRINGS:
        join_springs(f, pace);
        break;
    case JOINS_MEMBERS:
        join_members(f, pace);
        break;
    case WEIGHS_MEMBERS:
        weigh(f, f->grids->members, f->grids->member_count, 1, pace);
        break;
    case WEIGHS_STRANDS:
        weigh(f, f->strands->particles, f->strands->count, -1, pace);
        break;
    case JUDGES:
        judge(f, pace);
        break;
    case NUMBERS:
        number_rows(f);
        f->fits = true;
        begin_spreading(f, false);
        break;
    case BOUNDS_ROWS:
        bound_rows(f, pace);
        break;
    case BEGINS:
        begin_queues(f, pace);
        break;
    case SPREADS:
        spread(f, pace);
        break;
    case COMBINES:
        combine(f, pace);
        break;
    default:
        relent(f, pace);
        break;
    }
}

static homes_stage stage_after(finder *f) {
    switch (f->stage) {
    case SPREADS:
        if (!f->fits)
            return RELENTS;
        if (f->upside_down)
            return COMBINES;
        begin_spreading(f, true);
        return BOUNDS_ROWS;
    case COMBINES:
        return IS_FOUND;
    case RELENTS:
        return NUMBERS;
    default:
        return f->stage + 1;
    }
}

static void free_finder(finder *f, mspringi_memory *memory) {
    if (!f)
        return;
    void *const blocks[] = {f->height, f->component, f->balance, f->fitness, f->attached,
                            f->low,    f->next,      f->queue,   f};
    for (size_t i = 0; i < sizeof blocks / sizeof blocks[0]; ++i)
        mspringi_free(memory, blocks[i]);
}

void mspringi_homes_find(mspringi_homes *homes, mspringi_pace *pace, mspringi_memory *memory) {
    finder *f = homes->finder;
    while (f->stage != IS_FOUND && pace->left > 0) {
        pace->is_halfway = false;
        do_stage(f, pace);
        if (pace->is_halfway)
            continue;
        f->stage = stage_after(f);
        pace->at = 0;
    }
    pace->is_halfway = f->stage != IS_FOUND;
    if (pace->is_halfway)
        return;
    free_finder(f, memory);
    homes->finder = NULL;
}

void mspringi_homes_destroy(mspringi_homes *homes, mspringi_memory *memory) {
    free_finder(homes->finder, memory);
    mspringi_free(memory, homes->home);
    mspringi_free(memory, homes->grid_order);
    mspringi_free(memory, homes->first_row);
}
