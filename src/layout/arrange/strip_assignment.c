/// Assigned strips: lattice rows that the irregular particles connected to them are swept with.
///
/// A pass sweeps strips for several substeps, each one `skew` strips behind the one before. An irregular spring
/// needs both ends as of the substep before, so they must be swept within skew strips of each other. For a given
/// skew, the connected lattice particles bound the strip of each particle from above and below (extensions of a
/// Lipschitz function, McShane 1934). The mean of both bounds is a solution, too, and the smoothest of the three.
#include <string.h>

#include "base/union_find.h"
#include "layout/analysis.h"

/// Particles in a strip, approximately. Few strips take fewer calls, small ones fit the cache more often. Irregular
/// particles add a sweep to each strip, so fewer are better. (Speedup over the naive code for 40 ropes on our ship,
/// AVX2 and AVX-512: 4.5 and 8.3 with 2048, 4.2 and 7.7 with 512.)
#define BARE_STRIP_PARTICLES 512
#define STRIP_PARTICLES 2048

/// Lattice particles from which sharing a step among workers pays.
#define MIN_SHARED_PARTICLES 4000

/// Strips of each worker, enough to avoid waiting for its neighbours. (Two workers on 96 x 96 reach 0.9 of the
/// speed of two independent threads with 8, 12 and 16. With 24, single rows, it is 0.83: calls take an eighth of
/// the time.)
#define STRIPS_PER_WORKER 12

/// Particles visited by one call.
#define PARTICLES_PER_CALL 4000

/// Fitness of a component: its rows can be swept together, not with this skew, or not at all.
enum { FIT, UNFIT_FOR_SKEW, UNFIT };

typedef struct mspringi_strip_assignment_finder {
    const mspringi_graph *graph;
    const mspringi_grids *grids;
    const mspringi_chains *chains;
    mspringi_strip_assignment *assignment;
    uint32_t strip_particles; ///< in a strip, approximately
    uint32_t *height;         ///< [grids] rows
    uint32_t *component;      ///< [particles] parent in a disjoint-set forest; the roots are the components
    int64_t *balance;         ///< [particles] of roots: lattice particles less chain particles
    uint8_t *fitness;         ///< [particles] of roots
    uint32_t *attached;       ///< [attached_count] lattice particles with irregular springs
    uint32_t attached_count;
    uint32_t *low;   ///< [particles] lower bound of the strip
    uint32_t *queue; ///< [strips] first particle in each strip's list, or MSPRING_NONE
    uint32_t *next;  ///< [particles] next particle in the list
    uint32_t strip;  ///< present strip; those above it are done
    bool is_spreading, is_upside_down, is_fit;
    bool is_found;
} finder;

/* --------------------------------------------------------------------------------------------- the components */

void mspringi_strip_assignment_join_springs(mspringi_strip_assignment *assignment, uint32_t first, uint32_t end) {
    const finder *f = assignment->finder;
    const mspring_builder *builder = f->graph->builder;
    if (f->is_found)
        return;
    for (uint32_t s = first; s < end; ++s)
        if (f->grids->place[s] == 0) // else within a grid
            mspringi_union_find_join(f->component, builder->springs[s].a, builder->springs[s].b);
}

// Join the members of each grid: shelved grids share rows, so they fit together or not at all.
static void join_members(const finder *f) {
    const mspringi_grids *grids = f->grids;
    for (uint32_t m = 1; m < grids->member_count; ++m)
        if (grids->grid_of[grids->members[m]] == grids->grid_of[grids->members[m - 1]])
            mspringi_union_find_join(f->component, grids->members[m - 1], grids->members[m]);
}

static uint8_t *fitness_of(const finder *f, uint32_t particle) {
    return &f->fitness[mspringi_union_find_root(f->component, particle)];
}

static void add_balance(const finder *f, const uint32_t *particles, uint32_t count, int64_t weight) {
    for (uint32_t i = 0; i < count; ++i)
        f->balance[mspringi_union_find_root(f->component, particles[i])] += weight;
}

// Reject components with more chain than lattice: their chains are cheaper as chain rows.
void mspringi_strip_assignment_choose_grids(mspringi_strip_assignment *assignment) {
    const finder *f = assignment->finder;
    if (f->is_found)
        return;
    join_members(f);
    add_balance(f, f->grids->members, f->grids->member_count, 1);
    add_balance(f, f->chains->particles, f->chains->count, -1);
    for (uint32_t p = 0; p < f->graph->builder->particle_count; ++p)
        f->fitness[p] = f->balance[p] < 0 ? UNFIT : FIT;
}

// Springs between grids that share a shelf may have a place, too, by now.
static bool has_irregular_spring(const finder *f, uint32_t particle) {
    const mspringi_graph *graph = f->graph;
    bool has = false;
    for (uint32_t i = graph->first[particle]; i < graph->first[particle + 1]; ++i) {
        uint8_t *place = &f->grids->place[graph->springs[i]];
        if (*place == 0)
            *place = mspringi_grids_place_spring(f->grids, &graph->builder->springs[graph->springs[i]]);
        has = has || *place == 0;
    }
    return has;
}

/* ----------------------------------------------------------------------------------------- the assigned strips */

// Number the rows of all grids, grid after grid: first those that are swept together, then the others.
static void number_rows(finder *f) {
    mspringi_strip_assignment *assignment = f->assignment;
    const mspringi_grids *grids = f->grids;
    uint32_t row = 0, ordered = 0;
    for (int unfit = 0; unfit <= 1; ++unfit) {
        for (uint32_t grid = 0; grid < grids->count; ++grid) {
            const uint32_t first = grids->first_member[grid];
            if ((f->attached_count > 0 && *fitness_of(f, grids->members[first]) != FIT) != unfit)
                continue;
            assignment->grid_order[ordered++] = grid;
            assignment->first_row[grid] = row;
            row += f->height[grid];
        }
        if (!unfit)
            assignment->row_count = row;
    }
    assignment->all_rows = row;
    const uint32_t per_row = row > 0 ? grids->member_count / row : 0;
    assignment->strip_rows = per_row < f->strip_particles ? f->strip_particles / (per_row + 1) : 1;
}

static uint32_t strip_count(const mspringi_strip_assignment *assignment) {
    return (assignment->row_count + assignment->strip_rows - 1) / assignment->strip_rows;
}

static void enqueue(finder *f, uint32_t particle, uint32_t strip) {
    f->next[particle] = f->queue[strip];
    f->queue[strip] = particle;
}

// Set the strips of lattice particles, counted from the last one if upside down, and queue the attached particles.
static void begin_spreading(finder *f, uint32_t *bounds, bool upside_down) {
    const mspringi_grids *grids = f->grids;
    const mspringi_strip_assignment *assignment = f->assignment;
    const uint32_t strips = strip_count(assignment);
    f->queue[0] = MSPRING_NONE; // also if there is no strip
    memset(f->queue, 0xff, strips * sizeof *f->queue);
    memset(bounds, 0xff, f->graph->builder->particle_count * sizeof *bounds);
    for (uint32_t m = 0; m < grids->member_count; ++m) {
        const uint32_t p = grids->members[m];
        const uint32_t strip = (assignment->first_row[grids->grid_of[p]] + grids->row[p]) / assignment->strip_rows;
        bounds[p] = upside_down ? strips - 1 - strip : strip;
    }
    for (uint32_t i = 0; i < f->attached_count; ++i)
        if (*fitness_of(f, f->attached[i]) == FIT)
            enqueue(f, f->attached[i], bounds[f->attached[i]]);
}

// Bound the neighbours of a particle: its strip less the skew. The highest bound counts. Return false if a
// component does not fit this skew.
static bool spread_from(finder *f, uint32_t p, uint32_t *bounds) {
    const mspringi_graph *graph = f->graph;
    const uint32_t skew = f->assignment->skew, bound = f->strip > skew ? f->strip - skew : 0;
    bool is_fit = true;
    for (uint32_t i = graph->first[p]; i < graph->first[p + 1]; ++i) {
        const uint32_t other = graph->others[i];
        if (bounds[other] == MSPRING_NONE) {
            bounds[other] = bound;
            enqueue(f, other, bound);
        } else if (bound > bounds[other]) {
            // Only lattice particles can be lower: all others were first reached from their highest neighbour.
            *fitness_of(f, other) = UNFIT_FOR_SKEW;
            is_fit = false;
        }
    }
    return is_fit;
}

// Spread bounds from at most `most` particles, starting with the attached ones. Unreached particles keep
// MSPRING_NONE. A component becomes unfit if a lattice particle would have to lie higher than it does. Strips above
// f->strip are done: particles are queued in lower strips, or in the lowest one.
static void spread(finder *f, uint32_t *bounds, uint32_t max_particles) {
    for (uint32_t n = 0; n < max_particles; ++n) {
        while (f->queue[f->strip] == MSPRING_NONE && f->strip > 0)
            f->strip--;
        const uint32_t p = f->queue[f->strip];
        f->is_spreading = p != MSPRING_NONE;
        if (!f->is_spreading)
            return;
        f->queue[f->strip] = f->next[p];
        f->is_fit = spread_from(f, p, bounds) && f->is_fit;
    }
}

// Set assigned strips to the mean of both bounds.
static void average_bounds(const finder *f) {
    mspringi_strip_assignment *assignment = f->assignment;
    const uint32_t strips = strip_count(assignment);
    for (uint32_t p = 0; p < f->graph->builder->particle_count; ++p)
        if (f->grids->grid_of[p] != MSPRING_NONE)
            assignment->assigned_strip[p] = MSPRING_NONE;
        else if (assignment->assigned_strip[p] != MSPRING_NONE)
            assignment->assigned_strip[p] = (f->low[p] + (strips - 1 - assignment->assigned_strip[p])) / 2;
}

// Try the next skew for components that do not fit; reject them at the longest one.
static void extend_skew(const finder *f) {
    const bool is_longest = f->assignment->skew == MSPRINGI_MAX_SKEW;
    for (uint32_t p = 0; p < f->graph->builder->particle_count; ++p)
        if (f->fitness[p] == UNFIT_FOR_SKEW)
            f->fitness[p] = is_longest ? UNFIT : FIT;
    f->assignment->skew += !is_longest;
}

// Continue a try: spread downwards, then upside down, then decide.
static void try_skew(finder *f) {
    uint32_t *const bounds = f->is_upside_down ? f->assignment->assigned_strip : f->low;
    if (!f->is_spreading) {
        if (!f->is_upside_down)
            number_rows(f);
        f->is_fit = f->is_spreading = true;
        f->strip = strip_count(f->assignment) > 0 ? strip_count(f->assignment) - 1 : 0;
        begin_spreading(f, bounds, f->is_upside_down);
        return;
    }
    spread(f, bounds, PARTICLES_PER_CALL);
    if (f->is_spreading)
        return;
    f->is_found = f->is_fit && f->is_upside_down;
    f->is_upside_down = f->is_fit && !f->is_upside_down;
    if (f->is_found)
        average_bounds(f);
    else if (!f->is_upside_down)
        extend_skew(f);
}

// Make strips as small as the workers need them, if nothing is attached to the lattices. Assigned strips must not
// depend on the workers, since they order slots and so sums.
static void number_rows_for(finder *f, uint32_t workers) {
    const uint32_t wanted = f->grids->member_count / workers / STRIPS_PER_WORKER;
    if (workers > 1 && f->grids->member_count >= MIN_SHARED_PARTICLES && wanted < f->strip_particles)
        f->strip_particles = wanted;
    number_rows(f);
}

/* ---------------------------------------------------------------------------------------------------- the whole */

static mspring_result out_of_memory(const mspringi_graph *graph, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles",
                         graph->builder->particle_count);
}

mspring_result mspringi_strip_assignment_begin(mspringi_strip_assignment *assignment, const mspringi_graph *graph,
                                               const mspringi_grids *grids, const mspringi_chains *chains,
                                               mspringi_memory *memory, mspringi_message *message) {
    const size_t particles = graph->builder->particle_count;
    finder *f = assignment->finder = mspringi_alloc(memory, 1, sizeof *f);
    assignment->skew = 1;
    assignment->assigned_strip = mspringi_alloc_unset(memory, particles, sizeof *assignment->assigned_strip);
    assignment->grid_order = mspringi_alloc(memory, grids->count, sizeof *assignment->grid_order);
    assignment->first_row = mspringi_alloc(memory, grids->count, sizeof *assignment->first_row);
    if (f) {
        f->graph = graph;
        f->grids = grids;
        f->chains = chains;
        f->assignment = assignment;
        f->strip_particles = BARE_STRIP_PARTICLES;
        f->height = mspringi_alloc(memory, grids->count, sizeof *f->height);
        f->attached = mspringi_alloc(memory, grids->member_count, sizeof *f->attached);
    }
    if (!f || !assignment->assigned_strip || !assignment->grid_order || !assignment->first_row || !f->height ||
        !f->attached)
        return out_of_memory(graph, message);
    memset(assignment->assigned_strip, 0xff, particles * sizeof *assignment->assigned_strip);
    return MSPRING_OK;
}

void mspringi_strip_assignment_find_attached(mspringi_strip_assignment *assignment, uint32_t first, uint32_t end) {
    finder *f = assignment->finder;
    const mspringi_grids *grids = f->grids;
    for (uint32_t m = first; m < end; ++m) {
        const uint32_t p = grids->members[m];
        uint32_t *height = &f->height[grids->grid_of[p]];
        *height = grids->row[p] >= *height ? grids->row[p] + 1 : *height;
        if (has_irregular_spring(f, p))
            f->attached[f->attached_count++] = p;
    }
}

// Allocate the search, if anything is attached to the lattices.
mspring_result mspringi_strip_assignment_reserve(mspringi_strip_assignment *assignment, uint32_t workers,
                                                 mspringi_memory *memory, mspringi_message *message) {
    finder *f = assignment->finder;
    const size_t particles = f->graph->builder->particle_count;
    if (f->attached_count == 0) {
        number_rows_for(f, workers);
        f->is_found = true;
        return MSPRING_OK;
    }
    f->component = mspringi_alloc_unset(memory, particles, sizeof *f->component);
    f->balance = mspringi_alloc(memory, particles, sizeof *f->balance);
    f->fitness = mspringi_alloc(memory, particles, sizeof *f->fitness);
    f->low = mspringi_alloc_unset(memory, particles, sizeof *f->low);
    f->next = mspringi_alloc_unset(memory, particles, sizeof *f->next);
    // There are no more rows than members.
    f->queue = mspringi_alloc(memory, f->grids->member_count, sizeof *f->queue);
    if (!f->component || !f->balance || !f->fitness || !f->low || !f->next || !f->queue)
        return out_of_memory(f->graph, message);
    for (uint32_t p = 0; p < particles; ++p)
        f->component[p] = p;
    f->strip_particles = STRIP_PARTICLES;
    return MSPRING_OK;
}

static void free_finder(finder *f, mspringi_memory *memory) {
    if (!f)
        return;
    void *const blocks[] = {f->height, f->component, f->balance, f->fitness, f->attached,
                            f->low,    f->next,      f->queue,   f};
    for (size_t i = 0; i < sizeof blocks / sizeof blocks[0]; ++i)
        mspringi_free(memory, blocks[i]);
}

// This ends: at the longest skew, each try rejects at least one component.
bool mspringi_strip_assignment_try_skews(mspringi_strip_assignment *assignment) {
    if (!assignment->finder->is_found)
        try_skew(assignment->finder);
    return assignment->finder->is_found;
}

void mspringi_strip_assignment_end(mspringi_strip_assignment *assignment, mspringi_memory *memory) {
    free_finder(assignment->finder, memory);
    assignment->finder = NULL;
}

void mspringi_strip_assignment_destroy(mspringi_strip_assignment *assignment, mspringi_memory *memory) {
    free_finder(assignment->finder, memory);
    mspringi_free(memory, assignment->assigned_strip);
    mspringi_free(memory, assignment->grid_order);
    mspringi_free(memory, assignment->first_row);
}
