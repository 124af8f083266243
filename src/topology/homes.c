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

/// Strips that each of several workers should find, so that it need not wait for those before and behind it.
#define STRIPS_PER_WORKER 24

/// Whether the rows of a component can be swept together.
enum { FIT, UNFIT_FOR_LAG, UNFIT };

typedef struct finder {
    const mspringi_graph *graph;
    const mspringi_grids *grids;
    const mspringi_strands *strands;
    mspringi_homes *homes;
    mspringi_memory *memory;
    uint32_t strip_particles; ///< in a strip, about
    uint32_t *component;      ///< [particles] parent in a forest; its roots name the components
    uint8_t *fitness;         ///< [particles] of roots
    uint32_t *attached;       ///< [attached_count] lattice particles with leftover springs
    uint32_t attached_count;
    uint32_t *low;   ///< [particles] lowest strip that each may have
    uint32_t *queue; ///< [strips] first particle of each strip, MSPRING_NONE at the end
    uint32_t *next;  ///< [particles] next particle of the same strip
} finder;

/* --------------------------------------------------------------------------------------------- the components */

static void find_components(finder *f) {
    const mspring_builder *builder = f->graph->builder;
    for (uint32_t p = 0; p < builder->particle_count; ++p)
        f->component[p] = p;
    for (size_t s = 0; s < builder->spring_count; ++s)
        mspringi_forest_join(f->component, builder->springs[s].a, builder->springs[s].b);
    // What shares rows fits or fits not as one.
    for (uint32_t g = 0; g < f->grids->count; ++g)
        for (uint32_t m = f->grids->first_member[g] + 1; m < f->grids->first_member[g + 1]; ++m)
            mspringi_forest_join(f->component, f->grids->members[m - 1], f->grids->members[m]);
}

static uint8_t *fitness_of(const finder *f, uint32_t particle) {
    return &f->fitness[mspringi_forest_root(f->component, particle)];
}

// Components that are more rope than lattice: their strands are better swept as chains.
static bool find_ropy(finder *f) {
    const size_t particles = f->graph->builder->particle_count;
    int64_t *balance = mspringi_alloc(f->memory, particles, sizeof *balance); // lattice particles less strands'
    if (!balance)
        return false;
    for (uint32_t m = 0; m < f->grids->member_count; ++m)
        balance[mspringi_forest_root(f->component, f->grids->members[m])]++;
    for (uint32_t i = 0; i < f->strands->count; ++i)
        balance[mspringi_forest_root(f->component, f->strands->particles[i])]--;
    for (size_t p = 0; p < particles; ++p)
        f->fitness[p] = balance[p] < 0 ? UNFIT : FIT;
    mspringi_free(f->memory, balance);
    return true;
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
            uint32_t height = 0;
            for (uint32_t m = first; m < grids->first_member[grid + 1]; ++m)
                height = grids->row[grids->members[m]] >= height ? grids->row[grids->members[m]] + 1 : height;
            row += height;
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

// Spread from the attached particles along leftover springs: a particle reached from one with bound b has bound
// b - lag, and the highest bound counts. Upside down, strips count from the last, and the bounds are upper ones.
// Bounds of particles that are not reached are MSPRING_NONE. A component in which a lattice particle would have to
// be higher than it is becomes unfit.
static bool spread(finder *f, uint32_t *bounds, uint32_t lag, bool upside_down) {
    const mspringi_graph *graph = f->graph;
    const uint32_t strips = strip_count(f->homes);
    bool fits = true;
    memset(f->queue, 0xff, strips * sizeof *f->queue);
    memset(bounds, 0xff, graph->builder->particle_count * sizeof *bounds);
    for (uint32_t m = 0; m < f->grids->member_count; ++m) {
        const uint32_t p = f->grids->members[m];
        const uint32_t row = f->homes->first_row[f->grids->grid_of[p]] + f->grids->row[p];
        const uint32_t strip = row / f->homes->strip_rows;
        bounds[p] = upside_down ? strips - 1 - strip : strip;
    }
    for (uint32_t i = 0; i < f->attached_count; ++i)
        if (*fitness_of(f, f->attached[i]) == FIT)
            enqueue(f, f->attached[i], bounds[f->attached[i]]);
    for (uint32_t strip = strips; strip-- > 0;) {
        for (uint32_t p = f->queue[strip]; p != MSPRING_NONE; p = f->queue[strip]) {
            f->queue[strip] = f->next[p];
            const uint32_t bound = strip > lag ? strip - lag : 0;
            for (uint32_t i = graph->first[p]; i < graph->first[p + 1]; ++i) {
                const uint32_t other = mspringi_other_end(&graph->builder->springs[graph->springs[i]], p);
                if (bounds[other] == MSPRING_NONE) {
                    bounds[other] = bound;
                    enqueue(f, other, bound);
                } else if (bound > bounds[other]) {
                    // Only lattice particles can be lower: all others were reached from the highest first.
                    *fitness_of(f, other) = UNFIT_FOR_LAG;
                    fits = false;
                }
            }
        }
    }
    return fits;
}

// Find homes for a lag, or which components are unfit for it.
static bool find_for_lag(finder *f, uint32_t lag) {
    mspringi_homes *homes = f->homes;
    number_rows(f);
    if (!spread(f, f->low, lag, false) || !spread(f, homes->home, lag, true))
        return false;
    for (size_t p = 0; p < f->graph->builder->particle_count; ++p)
        if (f->grids->grid_of[p] != MSPRING_NONE)
            homes->home[p] = MSPRING_NONE;
        else if (homes->home[p] != MSPRING_NONE)
            homes->home[p] = (f->low[p] + (strip_count(homes) - 1 - homes->home[p])) / 2;
    return true;
}

// Find the smallest lag; components that need more than the longest are left out.
static void find_smallest_lag(finder *f) {
    f->homes->lag = 1;
    while (!find_for_lag(f, f->homes->lag)) {
        const bool is_longest = f->homes->lag == MSPRINGI_LONGEST_LAG;
        for (size_t p = 0; p < f->graph->builder->particle_count; ++p)
            if (f->fitness[p] == UNFIT_FOR_LAG)
                f->fitness[p] = is_longest ? UNFIT : FIT;
        f->homes->lag += !is_longest;
    }
}

// Where nothing hangs on the lattices, strips are as small as the workers want them: no slot depends on it. Homes
// must not depend on the workers, since the order of slots is that of sums.
static void number_rows_for(finder *f, uint32_t workers) {
    const uint32_t wanted = f->grids->member_count / workers / STRIPS_PER_WORKER;
    if (workers > 1 && f->grids->member_count >= FEWEST_SHARED && wanted < f->strip_particles)
        f->strip_particles = wanted;
    number_rows(f);
}

static bool find(finder *f, uint32_t workers) {
    const size_t particles = f->graph->builder->particle_count;
    mspringi_homes *homes = f->homes;
    homes->lag = 1;
    homes->home = mspringi_alloc(f->memory, particles, sizeof *homes->home);
    homes->grid_order = mspringi_alloc(f->memory, f->grids->count, sizeof *homes->grid_order);
    homes->first_row = mspringi_alloc(f->memory, f->grids->count, sizeof *homes->first_row);
    f->attached = mspringi_alloc(f->memory, f->grids->member_count, sizeof *f->attached);
    if (!homes->home || !homes->grid_order || !homes->first_row || !f->attached)
        return false;
    memset(homes->home, 0xff, particles * sizeof *homes->home);
    for (uint32_t m = 0; m < f->grids->member_count; ++m)
        if (has_leftover_spring(f, f->grids->members[m]))
            f->attached[f->attached_count++] = f->grids->members[m];
    if (f->attached_count == 0) {
        number_rows_for(f, workers);
        return true;
    }
    f->component = mspringi_alloc(f->memory, particles, sizeof *f->component);
    f->fitness = mspringi_alloc(f->memory, particles, sizeof *f->fitness);
    f->low = mspringi_alloc(f->memory, particles, sizeof *f->low);
    f->next = mspringi_alloc(f->memory, particles, sizeof *f->next);
    f->queue = mspringi_alloc(f->memory, f->grids->member_count, sizeof *f->queue); // no more rows than particles
    if (!f->component || !f->fitness || !f->low || !f->next || !f->queue)
        return false;
    find_components(f);
    if (!find_ropy(f))
        return false;
    f->strip_particles = STRIP_PARTICLES;
    find_smallest_lag(f);
    return true;
}

mspring_result mspringi_homes_find(mspringi_homes *homes, const mspringi_graph *graph, const mspringi_grids *grids,
                                   const mspringi_strands *strands, uint32_t workers, mspringi_memory *memory,
                                   mspringi_message *message) {
    finder f = {.graph = graph,
                .grids = grids,
                .strands = strands,
                .homes = homes,
                .memory = memory,
                .strip_particles = BARE_STRIP_PARTICLES};
    const bool found = find(&f, workers);
    mspringi_free(memory, f.component);
    mspringi_free(memory, f.fitness);
    mspringi_free(memory, f.attached);
    mspringi_free(memory, f.low);
    mspringi_free(memory, f.next);
    mspringi_free(memory, f.queue);
    if (!found)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the homes of %zu particles",
                             graph->builder->particle_count);
    return MSPRING_OK;
}

void mspringi_homes_destroy(mspringi_homes *homes, mspringi_memory *memory) {
    mspringi_free(memory, homes->home);
    mspringi_free(memory, homes->grid_order);
    mspringi_free(memory, homes->first_row);
}
