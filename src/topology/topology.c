/// Giving every particle a slot and every spring a place.
#include "topology.h"

#include <string.h>

#include "analysis.h"
#include "spare.h"

/// Chains are swept in spans of this many blocks.
#define LONGEST_CHAIN_SPAN 64

/// A block of a grid on its way to a number: row, then column block.
typedef uint64_t block_key;

static block_key make_key(uint32_t row, uint32_t column_block) {
    return (uint64_t)row << 32 | column_block;
}

static uint32_t row_of(block_key key) {
    return (uint32_t)(key >> 32);
}

static uint32_t column_block_of(block_key key) {
    return (uint32_t)key;
}

/// What is needed while a topology is made.
typedef struct mspringi_assembly {
    mspringi_topology made, *topology; ///< the latter is the former
    mspringi_memory *memory;
    mspringi_message *message;
    const mspring_builder *builder;
    uint32_t workers;
    uint8_t *kinds;
    mspringi_graph graph;
    mspringi_strands strands;
    mspringi_grids grids;
    mspringi_homes homes;
    mspringi_web_list web;
    block_key *blocks; ///< of all grids, grid after grid in the order of their rows, each sorted
    size_t block_count, block_capacity;
    size_t grid_begin;      ///< where the blocks of the grid that is being listed begin
    uint32_t *first_block;  ///< [grids] in blocks
    uint32_t *end_block;    ///< [grids] in blocks
    mspringi_place *places; ///< [springs]
    uint32_t home_blocks;   ///< blocks of the web that have been given to rows
    size_t row_capacity, span_capacity;
    bool is_checked; ///< no two springs join the same particles
    mspringi_pace pace;
    uint32_t grid;     ///< the grid that is gone through, as a number in grid_order
    uint32_t stage;    ///< of a pass that has several: what is done with the grid
    uint64_t *scratch; ///< [blocks of the grid that is sorted]
    mspringi_sorting sorting;
    uint32_t loose;        ///< loose particles so far, counted or placed
    uint32_t web_place;    ///< of the web's last particle so far
    uint32_t homed_blocks; ///< blocks of the web's particles with a home
    uint32_t runs;         ///< of empty slots so far
    bool in_run;           ///< the slot before is in one
    uint8_t *busy;         ///< [blocks] bits of quarters that have to be swept
    mspringi_weaving weaving;
} assembly;

static mspring_result out_of_memory(assembly *a) {
    return mspringi_fail(a->message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles and %zu springs",
                         a->builder->particle_count, a->builder->spring_count);
}

/* --------------------------------------------------------------------------------------------- lattice blocks */

static bool append_block(assembly *a, uint32_t row, uint32_t column_block) {
    if (a->block_count > a->grid_begin && a->blocks[a->block_count - 1] == make_key(row, column_block))
        return true; // most particles are in the block of the one before; sorting drops the other repetitions
    void *blocks = a->blocks;
    const bool grown = mspringi_grow(a->memory, &blocks, &a->block_capacity, a->block_count + 1, sizeof *a->blocks);
    a->blocks = blocks;
    if (grown)
        a->blocks[a->block_count++] = make_key(row, column_block);
    return grown;
}

// List the blocks of one of a grid's particles: its own; those that own a spring; and, where a block's last slot
// has a north-east spring, the block to its right, through which the spring's force is handed on to the row above,
// and the block above it, so that the slot to the right of that is the spring's other end.
static bool list_blocks(assembly *a, uint32_t p) {
    const mspringi_grids *grids = &a->grids;
    const uint32_t column = grids->column[p];
    if (!append_block(a, grids->row[p], column / MSPRINGI_WIDTH))
        return false;
    // Springs reach one column to the right at most, so only those of a block's first and last slot leave it.
    if ((column + 1) % MSPRINGI_WIDTH > 1)
        return true;
    for (uint32_t i = a->graph.first[p]; i < a->graph.first[p + 1]; ++i) {
        mspringi_lattice_spring spring;
        if (!mspringi_grids_place(grids, &a->builder->springs[a->graph.springs[i]], &spring) ||
            spring.column % MSPRINGI_WIDTH != MSPRINGI_WIDTH - 1)
            continue;
        const uint32_t column_block = spring.column / MSPRINGI_WIDTH;
        if (spring.direction == MSPRINGI_SOUTH_EAST && !append_block(a, spring.row, column_block))
            return false;
        if (spring.direction == MSPRINGI_NORTH_EAST &&
            (!append_block(a, spring.row, column_block + 1) || !append_block(a, spring.row + 1, column_block)))
            return false;
    }
    return true;
}

// Drop repeated blocks of the grid that has been listed and sorted.
static void drop_repeated(assembly *a) {
    const size_t count = a->block_count - a->grid_begin;
    block_key *keys = a->blocks + a->grid_begin;
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i)
        if (i == 0 || keys[i] != keys[i - 1])
            keys[kept++] = keys[i];
    a->block_count = a->grid_begin + kept;
}

// Where the web's particle i goes among its slots: those of each home begin a block, and so do those without.
static uint32_t web_place(const assembly *a, uint32_t i, uint32_t place_before) {
    const uint32_t *particles = a->web.particles, *home = a->homes.home;
    if (i == 0)
        return 0;
    const bool goes_on = home[particles[i]] == home[particles[i - 1]];
    return goes_on ? place_before + 1 : (place_before / MSPRINGI_WIDTH + 1) * MSPRINGI_WIDTH;
}

// Whether a particle lies in the loose row. One that is absent has the first slot, which holds none, or a spare
// one.
static bool is_loose(const assembly *a, uint32_t particle) {
    return a->kinds[particle] == MSPRINGI_ROW_LOOSE &&
           !(a->builder->particles[particle].flags & MSPRINGI_PARTICLE_ABSENT);
}

static mspring_result begin_blocks(assembly *a) {
    a->first_block = mspringi_pace_alloc(&a->pace, a->memory, a->grids.count, sizeof *a->first_block);
    a->end_block = mspringi_pace_alloc(&a->pace, a->memory, a->grids.count, sizeof *a->end_block);
    return a->first_block && a->end_block ? MSPRING_OK : out_of_memory(a);
}

/// What is done with each grid in turn: list its blocks, then sort them.
enum { LISTS_BLOCKS, SORTS_BLOCKS };

static mspring_result list_grid(assembly *a, uint32_t grid) {
    const mspringi_grids *grids = &a->grids;
    uint32_t m = grids->first_member[grid] + a->pace.at;
    if (a->pace.at == 0) {
        a->first_block[grid] = (uint32_t)a->block_count;
        a->grid_begin = a->block_count;
    }
    for (; m < grids->first_member[grid + 1] && a->pace.left > 0; ++m) {
        if (!list_blocks(a, grids->members[m]))
            return out_of_memory(a);
        mspringi_pace_spend(&a->pace, 4);
    }
    a->pace.at = m - grids->first_member[grid];
    if (m < grids->first_member[grid + 1])
        return MSPRING_OK;
    a->stage = SORTS_BLOCKS;
    a->scratch = mspringi_alloc(a->memory, a->block_count - a->grid_begin, sizeof *a->scratch);
    if (!a->scratch)
        return out_of_memory(a);
    mspringi_sorting_begin(&a->sorting, a->blocks + a->grid_begin, a->scratch,
                           (uint32_t)(a->block_count - a->grid_begin));
    return MSPRING_OK;
}

static void sort_grid(assembly *a, uint32_t grid) {
    if (!mspringi_sorting_go_on(&a->sorting, &a->pace))
        return;
    mspringi_free(a->memory, a->scratch);
    a->scratch = NULL;
    drop_repeated(a);
    a->end_block[grid] = (uint32_t)a->block_count;
    a->grid++;
    a->stage = LISTS_BLOCKS;
    a->pace.at = 0;
}

static mspring_result number_blocks(assembly *a) {
    mspring_result result = MSPRING_OK;
    while (result == MSPRING_OK && a->grid < a->grids.count && a->pace.left > 0) {
        const uint32_t grid = a->homes.grid_order[a->grid];
        if (a->stage == LISTS_BLOCKS)
            result = list_grid(a, grid);
        else
            sort_grid(a, grid);
        mspringi_pace_spend(&a->pace, 64); // for the counts of the sort
    }
    a->pace.is_halfway = a->grid < a->grids.count;
    return result;
}

static mspring_result count_loose(assembly *a) {
    uint32_t first, end;
    mspringi_pace_take(&a->pace, (uint32_t)a->builder->particle_count, 1, &first, &end);
    for (uint32_t p = first; p < end; ++p)
        a->loose += is_loose(a, p);
    return MSPRING_OK;
}

static mspring_result count_web_blocks(assembly *a) {
    uint32_t first, end;
    mspringi_pace_take(&a->pace, a->web.count, 1, &first, &end);
    for (uint32_t i = first; i < end; ++i) {
        a->web_place = web_place(a, i, a->web_place);
        if (i + 1 == a->web.homed_count)
            a->homed_blocks = a->web_place / MSPRINGI_WIDTH + 1;
    }
    return MSPRING_OK;
}

static mspring_result number_the_rest(assembly *a) {
    mspringi_topology *t = a->topology;
    t->lattice_first = 1;
    t->lattice_blocks = (uint32_t)a->block_count;
    t->chain_first = t->lattice_first + t->lattice_blocks;
    t->chain_blocks = (a->strands.count + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    // One of padding: vectors at the end of the rows before reach into it, while other threads move the web.
    t->web_first = t->chain_first + t->chain_blocks + 1;
    t->web_blocks = a->web.count > 0 ? a->web_place / MSPRINGI_WIDTH + 1 : 0;
    t->loose_first = t->web_first + t->web_blocks;
    t->loose_particles = a->loose;
    t->loose_blocks = (a->loose + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    t->spare_first = t->loose_first + t->loose_blocks;
    t->spare_blocks = (mspringi_spare_particles(t) + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    t->block_count = t->spare_first + t->spare_blocks + 1;
    if ((uint64_t)t->lattice_blocks * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH + a->strands.count + MSPRINGI_WIDTH +
            t->reserve.spring_end >=
        MSPRING_NONE)
        return mspringi_fail(a->message, MSPRING_ERROR_LIMIT, "%u blocks of lattice are more than can be numbered",
                             (unsigned)t->lattice_blocks);
    t->lattice_places = t->lattice_blocks * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
    t->chain_places = t->lattice_places + t->chain_blocks * MSPRINGI_WIDTH;
    return MSPRING_OK;
}

// The number of a grid's block among all lattice blocks; MSPRING_NONE if it is not stored.
static uint32_t find_block(const assembly *a, uint32_t grid, uint32_t row, uint32_t column_block) {
    const block_key key = make_key(row, column_block);
    uint32_t low = a->first_block[grid], high = a->end_block[grid];
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (a->blocks[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < a->end_block[grid] && a->blocks[low] == key ? low : MSPRING_NONE;
}

/* -------------------------------------------------------------------------------------------- slots and places */

static void place_particle(mspringi_topology *t, uint32_t particle, uint32_t slot) {
    t->slot_of_particle[particle] = slot;
    t->particle_of_slot[slot] = particle;
}

static mspring_result reserve_maps(assembly *a) {
    mspringi_topology *t = a->topology;
    const size_t slots = (size_t)t->block_count * MSPRINGI_WIDTH;
    t->slot_of_particle =
        mspringi_pace_alloc(&a->pace, a->memory, t->reserve.particle_end, sizeof *t->slot_of_particle);
    t->particle_of_slot = mspringi_pace_alloc(&a->pace, a->memory, slots, sizeof *t->particle_of_slot);
    if (!t->slot_of_particle || !t->particle_of_slot)
        return out_of_memory(a);
    memset(t->particle_of_slot, 0xff, slots * sizeof *t->particle_of_slot);
    a->loose = t->loose_first * MSPRINGI_WIDTH;
    a->web_place = 0;
    return MSPRING_OK;
}

static mspring_result assign_slots(assembly *a) {
    mspringi_topology *t = a->topology;
    const mspringi_grids *grids = &a->grids;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->particle_count, 8, &first, &end);
    for (uint32_t p = first; p < end; ++p) {
        if (a->kinds[p] == MSPRINGI_ROW_LATTICE) {
            const uint32_t block =
                find_block(a, grids->grid_of[p], grids->row[p], grids->column[p] / MSPRINGI_WIDTH);
            place_particle(t, p, (t->lattice_first + block) * MSPRINGI_WIDTH + grids->column[p] % MSPRINGI_WIDTH);
        } else if (is_loose(a, p)) {
            place_particle(t, p, a->loose++);
        } else if (a->kinds[p] == MSPRINGI_ROW_LOOSE && p >= t->reserve.first_particle) {
            t->slot_of_particle[p] = mspringi_spare_slot(t, p);
        }
    }
    return MSPRING_OK;
}

static mspring_result assign_chain_slots(assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, a->strands.count, 1, &first, &end);
    for (uint32_t i = first; i < end; ++i)
        place_particle(t, a->strands.particles[i], t->chain_first * MSPRINGI_WIDTH + i);
    return MSPRING_OK;
}

static mspring_result assign_web_slots(assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, a->web.count, 2, &first, &end);
    for (uint32_t i = first; i < end; ++i) {
        a->web_place = web_place(a, i, a->web_place);
        place_particle(t, a->web.particles[i], t->web_first * MSPRINGI_WIDTH + a->web_place);
    }
    return MSPRING_OK;
}

static mspring_result assign_spare_slots(assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->reserve.particle_end - t->particle_count, 1, &first, &end);
    for (mspring_id p = t->particle_count + first; p < t->particle_count + end; ++p)
        t->slot_of_particle[p] = mspringi_spare_slot(t, p);
    return MSPRING_OK;
}

static mspring_result begin_places(assembly *a) {
    const uint32_t springs = a->topology->reserve.spring_end;
    a->places = mspringi_pace_alloc(&a->pace, a->memory, springs, sizeof *a->places);
    if (!a->places)
        return out_of_memory(a);
    memset(a->places, 0xff, springs * sizeof *a->places);
    return MSPRING_OK;
}

static mspring_result assign_chain_places(assembly *a) {
    uint32_t first, end;
    mspringi_pace_take(&a->pace, a->strands.count, 1, &first, &end);
    for (uint32_t i = first; i < end; ++i)
        if (a->strands.springs[i] != MSPRING_NONE)
            a->places[a->strands.springs[i]] = a->topology->lattice_places + i;
    return MSPRING_OK;
}

// In an array: lattice springs where they are, and the others one after the other.
static mspring_result assign_places(assembly *a) {
    mspringi_topology *t = a->topology;
    mspringi_place *places = a->places;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->spring_count, 12, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        mspringi_lattice_spring found;
        if (places[s] != MSPRING_NONE)
            continue;
        if (!mspringi_grids_place(&a->grids, &a->builder->springs[s], &found)) {
            places[s] = t->chain_places + t->leftover_count++;
            continue;
        }
        // The spring's first particle is in its block, in the one to the right, or in the one above or both.
        const uint32_t grid = a->grids.grid_of[a->builder->springs[s].a];
        const uint32_t block = find_block(a, grid, found.row, found.column / MSPRINGI_WIDTH);
        places[s] = (block * MSPRINGI_DIRECTIONS + (uint32_t)found.direction) * MSPRINGI_WIDTH +
                    found.column % MSPRINGI_WIDTH;
        t->lattice_springs++;
    }
    return MSPRING_OK;
}

static mspring_result reserve_ends(assembly *a) {
    mspringi_topology *t = a->topology;
    t->woven_count = t->leftover_capacity = t->leftover_count;
    t->leftover_a = mspringi_pace_alloc(&a->pace, a->memory, t->leftover_count, sizeof *t->leftover_a);
    t->leftover_b = mspringi_pace_alloc(&a->pace, a->memory, t->leftover_count, sizeof *t->leftover_b);
    return t->leftover_a && t->leftover_b ? MSPRING_OK : out_of_memory(a);
}

static mspring_result note_ends(assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->spring_count, 1, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        if (a->places[s] < t->chain_places)
            continue;
        const uint32_t i = a->places[s] - t->chain_places;
        t->leftover_a[i] = t->slot_of_particle[a->builder->springs[s].a];
        t->leftover_b[i] = t->slot_of_particle[a->builder->springs[s].b];
    }
    return MSPRING_OK;
}

void mspringi_topology_ends(const mspringi_topology *topology, mspringi_place place, uint32_t *base,
                            uint32_t *tip) {
    const uint32_t lane = place % MSPRINGI_WIDTH;
    if (place >= topology->chain_places) {
        *base = topology->leftover_a[place - topology->chain_places];
        *tip = topology->leftover_b[place - topology->chain_places];
    } else if (place >= topology->lattice_places) {
        *base = topology->chain_first * MSPRINGI_WIDTH + (place - topology->lattice_places);
        *tip = *base + 1;
    } else {
        const uint32_t block = place / (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH);
        const uint32_t here = (topology->lattice_first + block) * MSPRINGI_WIDTH + lane;
        const uint32_t up = topology->up_of_block[block] * MSPRINGI_WIDTH + lane;
        switch ((mspringi_direction)(place / MSPRINGI_WIDTH % MSPRINGI_DIRECTIONS)) {
        case MSPRINGI_NORTH:
            *base = here;
            *tip = up;
            break;
        case MSPRINGI_NORTH_EAST:
            *base = here;
            *tip = up + 1;
            break;
        case MSPRINGI_SOUTH_EAST:
            *base = up;
            *tip = here + 1;
            break;
        default:
            *base = here;
            *tip = here + 1;
            break;
        }
    }
}

/* ---------------------------------------------------------------------------------------------- rows and spans */

// Append a row without spans.
static bool append_row(assembly *a, mspringi_row_kind kind) {
    mspringi_topology *t = a->topology;
    void *rows = t->rows;
    const bool grown = mspringi_grow(a->memory, &rows, &a->row_capacity, (size_t)t->row_count + 1, sizeof *t->rows);
    t->rows = rows;
    if (grown)
        t->rows[t->row_count++] = (mspringi_row){.kind = kind, .first_span = t->span_count};
    return grown;
}

static bool store_span(assembly *a, const mspringi_span *span) {
    mspringi_topology *t = a->topology;
    void *spans = t->spans;
    const bool grown = mspringi_grow(a->memory, &spans, &a->span_capacity, (size_t)t->span_count + 1, sizeof *span);
    t->spans = spans;
    if (grown)
        t->spans[t->span_count++] = *span;
    return grown;
}

// Append a span to the last row, or lengthen its last one if this is what that would go on with.
static bool append_span(assembly *a, const mspringi_span *span) {
    mspringi_topology *t = a->topology;
    mspringi_row *row = &t->rows[t->row_count - 1];
    if (row->span_count > 0) {
        mspringi_span *last = &t->spans[t->span_count - 1];
        if (last->end_slot == span->first_slot && last->up == span->up && last->carry == span->carry) {
            last->end_slot = span->end_slot;
            return true;
        }
    }
    row->span_count++;
    return store_span(a, span);
}

// A span of whole blocks.
static mspringi_span span_of_blocks(uint32_t first_block, uint32_t block_count, uint32_t first_record,
                                    uint32_t record_slots) {
    return (mspringi_span){.first_slot = first_block * MSPRINGI_WIDTH,
                           .end_slot = (first_block + block_count) * MSPRINGI_WIDTH,
                           .first_record = first_record,
                           .record_slots = record_slots};
}

// From the slots of one block to those of another.
static int64_t offset_between(uint32_t from_block, uint32_t to_block) {
    return ((int64_t)to_block - (int64_t)from_block) * MSPRINGI_WIDTH;
}

static uint32_t widest_row(const assembly *a) {
    uint32_t widest =
        a->topology->chain_blocks < LONGEST_CHAIN_SPAN ? a->topology->chain_blocks : LONGEST_CHAIN_SPAN;
    for (size_t i = 0; i < a->block_count; ++i)
        widest = column_block_of(a->blocks[i]) + 1 > widest ? column_block_of(a->blocks[i]) + 1 : widest;
    return widest;
}

// Append the row of a grid's block, or the block to its row.
static bool append_lattice_block(assembly *a, uint32_t i, uint32_t grid, uint32_t number) {
    mspringi_topology *t = a->topology;
    const uint32_t row = row_of(a->blocks[i]), column_block = column_block_of(a->blocks[i]);
    const bool starts_row = i == a->first_block[grid] || row_of(a->blocks[i - 1]) != row;
    const uint32_t up = find_block(a, grid, row + 1, column_block);
    const uint32_t block = t->lattice_first + i, up_block = up == MSPRING_NONE ? block : t->lattice_first + up;
    mspringi_span span = span_of_blocks(block, 1, i, MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH);
    span.up = offset_between(block, up_block);
    span.carry = offset_between(block, column_block);
    t->up_of_block[i] = up_block;
    if (starts_row) {
        if (!append_row(a, MSPRINGI_ROW_CHAIN))
            return false;
        t->grid_of_row[t->lattice_rows++] = number;
    }
    if (up != MSPRING_NONE)
        t->rows[t->row_count - 1].kind = MSPRINGI_ROW_LATTICE;
    return append_span(a, &span);
}

static mspring_result append_lattice_rows(assembly *a) {
    const mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->lattice_blocks, 24, &first, &end);
    for (uint32_t i = first; i < end; ++i) {
        while (i >= a->end_block[a->homes.grid_order[a->grid]])
            a->grid++;
        if (!append_lattice_block(a, i, a->homes.grid_order[a->grid], a->grid))
            return out_of_memory(a);
    }
    return MSPRING_OK;
}

// Append the chains. Their spans are no longer than the carry row, which has no force for them.
static bool append_chain_row(assembly *a) {
    mspringi_topology *t = a->topology;
    bool ok = t->chain_blocks == 0 || append_row(a, MSPRINGI_ROW_CHAIN);
    for (uint32_t i = 0; ok && i < t->chain_blocks; i += LONGEST_CHAIN_SPAN) {
        const uint32_t left = t->chain_blocks - i, block = t->chain_first + i;
        mspringi_span span =
            span_of_blocks(block, left < LONGEST_CHAIN_SPAN ? left : LONGEST_CHAIN_SPAN, i, MSPRINGI_WIDTH);
        span.carry = offset_between(block, 0);
        ok = append_span(a, &span);
    }
    return ok;
}

// Append a row of one span.
static bool append_simple_row(assembly *a, mspringi_row_kind kind, uint32_t first_block, uint32_t block_count,
                              uint32_t first_record) {
    const mspringi_span span = span_of_blocks(first_block, block_count, first_record, MSPRINGI_WIDTH);
    return append_row(a, kind) && append_span(a, &span);
}

// Append the span of a strip's own particles of the web, of which the last is in last_slot.
static bool append_home_span(assembly *a, uint32_t strip, uint32_t last_slot) {
    mspringi_topology *t = a->topology;
    const uint32_t first_block = t->web_first + a->home_blocks, end_block = last_slot / MSPRINGI_WIDTH + 1;
    mspringi_span span = span_of_blocks(first_block, end_block - first_block, a->home_blocks, MSPRINGI_WIDTH);
    span.end_slot = (last_slot / MSPRINGI_QUARTER + 1) * MSPRINGI_QUARTER;
    a->home_blocks += end_block - first_block;
    t->strips[strip].home_span = t->span_count;
    return store_span(a, &span);
}

static bool append_home_spans(assembly *a) {
    const mspringi_topology *t = a->topology;
    const uint32_t *particles = a->web.particles, *home = a->homes.home;
    for (uint32_t i = 0; i < a->web.homed_count; ++i) {
        const bool is_last = i + 1 == a->web.count || home[particles[i + 1]] != home[particles[i]];
        if (is_last && !append_home_span(a, home[particles[i]], t->slot_of_particle[particles[i]]))
            return false;
    }
    return true;
}

// Cut the rows into strips: those of the wave as their homes want it, of the others each on its own.
static mspring_result make_strips(assembly *a) {
    mspringi_topology *t = a->topology;
    const uint32_t rows = a->homes.strip_rows;
    t->lag = a->homes.lag;
    t->wave_rows = a->homes.row_count;
    t->wave_strips = (t->wave_rows + rows - 1) / rows;
    t->strip_count = t->wave_strips + (t->row_count - t->wave_rows);
    t->strips = mspringi_alloc(a->memory, t->strip_count, sizeof *t->strips);
    if (!t->strips)
        return out_of_memory(a);
    for (uint32_t s = 0, row = 0; s < t->strip_count; ++s) {
        const uint32_t left = t->wave_rows - row, count = s >= t->wave_strips ? 1 : left < rows ? left : rows;
        t->strips[s] = (mspringi_strip){.first_row = row, .row_count = count, .home_span = MSPRING_NONE};
        row += count;
    }
    return append_home_spans(a) ? MSPRING_OK : out_of_memory(a);
}

// The strip of each lattice and chain block, [block_count].
static uint32_t *list_strips_of_blocks(const assembly *a) {
    const mspringi_topology *t = a->topology;
    uint32_t *strip_of_block = mspringi_alloc(a->memory, t->block_count, sizeof *strip_of_block);
    for (uint32_t s = 0; strip_of_block && s < t->strip_count; ++s) {
        const mspringi_row *first = &t->rows[t->strips[s].first_row], *last = first + t->strips[s].row_count - 1;
        for (uint32_t i = first->first_span; i < last->first_span + last->span_count; ++i)
            for (uint32_t slot = t->spans[i].first_slot; slot < t->spans[i].end_slot; slot += MSPRINGI_QUARTER)
                strip_of_block[slot / MSPRINGI_WIDTH] = s;
    }
    return strip_of_block;
}

// Set a bit of busy for the quarter of a slot.
static void mark_busy(uint8_t *busy, uint32_t slot) {
    busy[slot / MSPRINGI_WIDTH] |= (uint8_t)(1u << slot % MSPRINGI_WIDTH / MSPRINGI_QUARTER);
}

static bool is_busy(const uint8_t *busy, uint32_t slot) {
    return busy[slot / MSPRINGI_WIDTH] >> slot % MSPRINGI_WIDTH / MSPRINGI_QUARTER & 1;
}

// Find the quarters at the ends of lattice spans that need not be swept: they hold no particle, own no spring, and
// no force is handed on through them. The latter two are so if no spring's record, and no slot to the right of a
// north-east spring, lies in them.

static mspring_result mark_particles(assembly *a) {
    const mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->chain_first * MSPRINGI_WIDTH, 1, &first, &end);
    for (uint32_t slot = first; slot < end; ++slot)
        if (t->particle_of_slot[slot] != MSPRING_NONE)
            mark_busy(a->busy, slot);
    return MSPRING_OK;
}

static mspring_result mark_springs(assembly *a) {
    const mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->spring_count, 1, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        const mspringi_place place = a->places[s];
        if (place >= t->lattice_places)
            continue;
        const uint32_t block = place / (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH);
        const uint32_t slot = (t->lattice_first + block) * MSPRINGI_WIDTH + place % MSPRINGI_WIDTH;
        mark_busy(a->busy, slot);
        if (place / MSPRINGI_WIDTH % MSPRINGI_DIRECTIONS == MSPRINGI_NORTH_EAST)
            mark_busy(a->busy, slot + 1);
    }
    return MSPRING_OK;
}

static mspring_result trim_spans(assembly *a) {
    const mspringi_topology *t = a->topology;
    const uint32_t lattice_end = t->chain_first * MSPRINGI_WIDTH;
    for (uint32_t s = 0; s < t->span_count && t->spans[s].first_slot < lattice_end; ++s) {
        mspringi_span *span = &t->spans[s];
        // Within its first and its last block; one quarter is left of a block that is all idle (and is there for
        // the slot to its right).
        while (span->first_slot % MSPRINGI_WIDTH < MSPRINGI_WIDTH - MSPRINGI_QUARTER &&
               !is_busy(a->busy, span->first_slot))
            span->first_slot += MSPRINGI_QUARTER;
        while (span->end_slot - MSPRINGI_QUARTER > span->first_slot &&
               (span->end_slot - 1) % MSPRINGI_WIDTH >= MSPRINGI_QUARTER && !is_busy(a->busy, span->end_slot - 1))
            span->end_slot -= MSPRINGI_QUARTER;
    }
    mspringi_free(a->memory, a->busy);
    a->busy = NULL;
    return MSPRING_OK;
}

static mspring_result begin_rows(assembly *a) {
    mspringi_topology *t = a->topology;
    t->carry_blocks = widest_row(a);
    t->up_of_block = mspringi_pace_alloc(&a->pace, a->memory, t->lattice_blocks, sizeof *t->up_of_block);
    t->grid_of_row = mspringi_pace_alloc(&a->pace, a->memory, t->lattice_blocks,
                                         sizeof *t->grid_of_row); // no more rows than blocks
    a->busy = mspringi_pace_alloc(&a->pace, a->memory, t->block_count, sizeof *a->busy);
    a->grid = 0;
    return t->up_of_block && t->grid_of_row && a->busy ? MSPRING_OK : out_of_memory(a);
}

static mspring_result append_other_rows(assembly *a) {
    const mspringi_topology *t = a->topology;
    const uint32_t web_blocks = t->web_blocks - a->homed_blocks;
    const bool has_loose_row = t->loose_blocks + t->spare_blocks > 0;
    if (!append_chain_row(a) ||
        (web_blocks > 0 &&
         !append_simple_row(a, MSPRINGI_ROW_WEB, t->web_first + a->homed_blocks, web_blocks, a->homed_blocks)) ||
        (has_loose_row && !append_simple_row(a, MSPRINGI_ROW_LOOSE, t->loose_first, t->loose_blocks, 0)))
        return out_of_memory(a);
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------------- the web */

static mspring_result begin_web(assembly *a) {
    mspringi_topology *t = a->topology;
    a->weaving = (mspringi_weaving){.web = &t->web,
                                    .a = t->leftover_a,
                                    .b = t->leftover_b,
                                    .count = t->leftover_count,
                                    .first_slot = t->web_first * MSPRINGI_WIDTH,
                                    .own_count = t->web_blocks * MSPRINGI_WIDTH,
                                    .block_count = t->block_count,
                                    .strip_of_block = list_strips_of_blocks(a)};
    return a->weaving.strip_of_block ? mspringi_web_begin(&a->weaving, &a->pace, a->memory, a->message)
                                     : out_of_memory(a);
}

// The attached nodes are in slot order, and each strip's begin a group.
static mspring_result attach_to_strips(assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->web.attached_count, 4, &first, &end);
    for (uint32_t i = first; i < end; ++i) {
        if (t->web.attached_slot[i] == MSPRING_NONE)
            continue;
        mspringi_strip *strip = &t->strips[a->weaving.strip_of_block[t->web.attached_slot[i] / MSPRINGI_WIDTH]];
        if (strip->attached_count++ == 0)
            strip->first_attached = i;
    }
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------------- the whole */

// List the slots without particle, the padding in front and behind among them: first count them, then fill.
static mspring_result go_through_empty_slots(assembly *a, mspringi_empty_run *runs) {
    const mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->block_count * MSPRINGI_WIDTH, 1, &first, &end);
    for (uint32_t slot = first; slot < end; ++slot) {
        const bool empty = t->particle_of_slot[slot] == MSPRING_NONE && !mspringi_slot_is_spare(t, slot);
        if (empty && !a->in_run && runs)
            runs[a->runs] = (mspringi_empty_run){.first_slot = slot};
        a->runs += empty && !a->in_run;
        if (empty && runs)
            runs[a->runs - 1].slot_count++;
        a->in_run = empty;
    }
    return MSPRING_OK;
}

static mspring_result count_empty_slots(assembly *a) {
    return go_through_empty_slots(a, NULL);
}

static mspring_result reserve_empty_slots(assembly *a) {
    mspringi_topology *t = a->topology;
    t->empty_runs = mspringi_pace_alloc(&a->pace, a->memory, a->runs, sizeof *t->empty_runs);
    t->empty_run_count = a->runs;
    a->runs = 0;
    a->in_run = false;
    return t->empty_runs ? MSPRING_OK : out_of_memory(a);
}

static mspring_result list_empty_slots(assembly *a) {
    return go_through_empty_slots(a, a->topology->empty_runs);
}

/* The passes of others. */

static mspring_result begin_graph(assembly *a) {
    const size_t particles = a->builder->particle_count;
    a->kinds = mspringi_pace_alloc(&a->pace, a->memory, particles, sizeof *a->kinds);
    if (!a->kinds)
        return out_of_memory(a);
    memset(a->kinds, MSPRINGI_ROW_LOOSE, particles);
    return mspringi_graph_reserve(&a->graph, a->builder, a->is_checked, &a->pace, a->memory, a->message);
}

static mspring_result count_graph(assembly *a) {
    mspringi_graph_count(&a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result sum_graph(assembly *a) {
    mspringi_graph_sum(&a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result fill_graph(assembly *a) {
    mspringi_graph_fill(&a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result check_graph(assembly *a) {
    return mspringi_graph_check(&a->graph, &a->pace, a->memory, a->message);
}

static mspring_result count_strands(assembly *a) {
    mspringi_strands_count(&a->strands, &a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result begin_strands(assembly *a) {
    return mspringi_strands_reserve(&a->strands, &a->graph, &a->pace, a->memory, a->message);
}

static mspring_result find_strands(assembly *a) {
    mspringi_strands_find(&a->strands, &a->graph, a->kinds, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result begin_grids(assembly *a) {
    return mspringi_grids_reserve(&a->grids, &a->graph, a->kinds, &a->pace, a->memory, a->message);
}

static mspring_result find_grids(assembly *a) {
    mspringi_grids_find(&a->grids, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result measure_grids(assembly *a) {
    return mspringi_grids_measure(&a->grids, &a->pace, a->memory, a->message);
}

static mspring_result shelve_grids(assembly *a) {
    mspringi_grids_shelve(&a->grids, &a->pace);
    return MSPRING_OK;
}

static mspring_result number_grids(assembly *a) {
    mspringi_grids_number(&a->grids, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result begin_homes(assembly *a) {
    return mspringi_homes_reserve(&a->homes, &a->graph, &a->grids, &a->strands, &a->pace, a->memory, a->message);
}

static mspring_result attach_homes(assembly *a) {
    mspringi_homes_attach(&a->homes, &a->pace);
    return MSPRING_OK;
}

static mspring_result prepare_homes(assembly *a) {
    return mspringi_homes_prepare(&a->homes, a->workers, &a->pace, a->memory, a->message);
}

static mspring_result find_homes(assembly *a) {
    mspringi_homes_find(&a->homes, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result drop_strands(assembly *a) {
    mspringi_strands_drop(&a->strands, &a->homes, a->kinds, &a->pace);
    return MSPRING_OK;
}

static mspring_result count_web(assembly *a) {
    mspringi_web_list_count(&a->web, &a->graph, &a->homes, a->kinds, &a->pace);
    return MSPRING_OK;
}

static mspring_result begin_web_list(assembly *a) {
    return mspringi_web_list_reserve(&a->web, &a->pace, a->memory, a->message);
}

static mspring_result list_web(assembly *a) {
    mspringi_web_list_fill(&a->web, &a->graph, &a->homes, a->kinds, &a->pace);
    return MSPRING_OK;
}

static mspring_result set_web_keys(assembly *a) {
    mspringi_web_list_set_keys(&a->web, &a->graph, &a->homes, &a->pace);
    return MSPRING_OK;
}

static mspring_result sort_web(assembly *a) {
    mspringi_web_list_sort(&a->web, &a->pace);
    return MSPRING_OK;
}

static mspring_result order_web(assembly *a) {
    mspringi_web_list_take_order(&a->web, &a->pace);
    return MSPRING_OK;
}

static mspring_result order_web_windows(assembly *a) {
    mspringi_web_list_order_windows(&a->web, &a->graph, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result count_degrees(assembly *a) {
    mspringi_web_count_degrees(&a->weaving, &a->pace);
    return MSPRING_OK;
}

static mspring_result list_attached(assembly *a) {
    mspringi_web_list_attached(&a->weaving, &a->pace);
    return MSPRING_OK;
}

static mspring_result reserve_web(assembly *a) {
    return mspringi_web_reserve(&a->weaving, &a->pace, a->memory, a->message);
}

static mspring_result number_nodes(assembly *a) {
    mspringi_web_number_nodes(&a->weaving, &a->pace);
    return MSPRING_OK;
}

static mspring_result count_rungs(assembly *a) {
    return mspringi_web_count_rungs(&a->weaving, &a->pace, a->message);
}

static mspring_result reserve_rungs(assembly *a) {
    return mspringi_web_reserve_rungs(&a->weaving, &a->pace, a->memory, a->message);
}

static mspring_result lay_rungs(assembly *a) {
    mspringi_web_lay_rungs(&a->weaving, &a->pace);
    return MSPRING_OK;
}

static mspring_result fill_web(assembly *a) {
    mspringi_web_fill(&a->weaving, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result (*const layout_passes[])(assembly *a) = {
    begin_graph,       count_graph,         sum_graph,          fill_graph,       check_graph,
    count_strands,     begin_strands,       find_strands,       begin_grids,      find_grids,
    measure_grids,     shelve_grids,        number_grids,       begin_homes,      attach_homes,
    prepare_homes,     find_homes,          drop_strands,       count_web,        begin_web_list,
    list_web,          set_web_keys,        sort_web,           order_web,        order_web_windows,
    begin_blocks,      number_blocks,       count_loose,        count_web_blocks, number_the_rest,
    reserve_maps,      assign_slots,        assign_chain_slots, assign_web_slots, assign_spare_slots,
    count_empty_slots, reserve_empty_slots, list_empty_slots,   begin_places,     assign_chain_places,
    assign_places,     reserve_ends,        note_ends,          begin_rows,       append_lattice_rows,
    append_other_rows, mark_particles,      mark_springs,       trim_spans,       make_strips,
    begin_web,         count_degrees,       list_attached,      reserve_web,      list_attached,
    attach_to_strips,  number_nodes,        count_rungs,        reserve_rungs,    lay_rungs,
    fill_web,
};

#define LAYOUT_PASSES (sizeof layout_passes / sizeof layout_passes[0])

mspring_result mspringi_topology_begin(const mspring_builder *builder, const mspringi_reserve *reserve,
                                       bool is_checked, uint32_t workers, mspringi_memory *memory,
                                       mspringi_message *message, mspringi_assembly **begun) {
    assembly *a = mspringi_alloc(memory, 1, sizeof *a);
    if (!a)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles and %zu springs",
                             builder->particle_count, builder->spring_count);
    a->made = (mspringi_topology){.particle_count = (uint32_t)builder->particle_count,
                                  .spring_count = (uint32_t)builder->spring_count,
                                  .reserve = *reserve};
    a->topology = &a->made;
    a->memory = memory;
    a->message = message;
    a->builder = builder;
    a->is_checked = is_checked;
    a->workers = workers;
    *begun = a;
    return MSPRING_OK;
}

// No pass may spend effort on what depends on the number of workers, as strips do: when the work is done must not.
mspring_result mspringi_topology_go_on(mspringi_assembly *begun, uint32_t *effort, bool *is_done) {
    mspringi_pace *pace = &begun->pace;
    mspring_result result = MSPRING_OK;
    pace->left = *effort;
    while (result == MSPRING_OK && pace->pass < LAYOUT_PASSES && pace->left > 0) {
        pace->is_halfway = false;
        result = layout_passes[pace->pass](begun);
        if (pace->is_halfway)
            continue;
        pace->pass++;
        pace->at = 0;
    }
    *effort = pace->left;
    *is_done = pace->pass == LAYOUT_PASSES;
    return result;
}

void mspringi_topology_abandon(mspringi_assembly *begun, mspringi_memory *memory) {
    if (!begun)
        return;
    mspringi_topology_destroy(&begun->made, memory);
    mspringi_free(memory, begun->kinds);
    mspringi_free(memory, begun->places);
    mspringi_free(memory, begun->blocks);
    mspringi_free(memory, begun->first_block);
    mspringi_free(memory, begun->end_block);
    mspringi_free(memory, begun->scratch);
    mspringi_free(memory, begun->busy);
    mspringi_weaving_destroy(&begun->weaving, memory);
    mspringi_graph_destroy(&begun->graph, memory);
    mspringi_strands_destroy(&begun->strands, memory);
    mspringi_grids_destroy(&begun->grids, memory);
    mspringi_homes_destroy(&begun->homes, memory);
    mspringi_web_list_destroy(&begun->web, memory);
    mspringi_free(memory, begun);
}

void mspringi_topology_finish(mspringi_assembly *begun, mspringi_memory *memory, mspringi_topology *topology,
                              mspringi_place **places) {
    begun->made.lattice_count = begun->grids.found_count;
    begun->made.lattice_particles = begun->grids.member_count;
    begun->made.chain_count = begun->strands.strand_count;
    begun->made.chain_particles = begun->strands.count;
    begun->made.chain_springs = begun->strands.spring_count;
    begun->made.web_particles = begun->web.count;
    // NOLINTNEXTLINE(-Wanalyzer-null-dereference): it was begun
    *topology = begun->made;
    *places = begun->places;
    begun->places = NULL;
    // NOLINTNEXTLINE(-Wanalyzer-null-dereference): as above
    begun->made = (mspringi_topology){0};
    mspringi_topology_abandon(begun, memory);
}

static mspring_result keep_places(mspringi_topology *t, mspringi_place *places, mspringi_memory *memory,
                                  mspringi_message *message) {
    mspring_result result = mspringi_spare_reserve(t, 0, memory, message);
    if (result != MSPRING_OK)
        return result;
    mspringi_pace pace = {0};
    do {
        pace.left = MSPRINGI_PACE_ALL;
        mspringi_spare_enter(t, &pace);
    } while (pace.is_halfway);
    result = mspringi_spare_keep(t, places, memory, message);
    if (result == MSPRING_OK && !mspringi_places_create(&t->places, places, t->reserve.spring_end,
                                                        t->reserve.first_spring, t->lattice_places, memory))
        result = mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the places of %u springs",
                               (unsigned)t->spring_count);
    return result;
}

mspring_result mspringi_topology_create(mspringi_topology *topology, const mspring_builder *builder,
                                        const mspringi_reserve *reserve, uint32_t workers, mspringi_memory *memory,
                                        mspringi_message *message) {
    mspringi_assembly *begun = NULL;
    mspring_result result = mspringi_topology_begin(builder, reserve, false, workers, memory, message, &begun);
    for (bool is_done = false; result == MSPRING_OK && !is_done;) {
        uint32_t effort = MSPRINGI_PACE_ALL;
        result = mspringi_topology_go_on(begun, &effort, &is_done);
    }
    if (result != MSPRING_OK) {
        mspringi_topology_abandon(begun, memory);
        return result;
    }
    mspringi_place *places;
    mspringi_topology_finish(begun, memory, topology, &places);
    result = keep_places(topology, places, memory, message);
    mspringi_free(memory, places);
    if (result != MSPRING_OK)
        mspringi_topology_destroy(topology, memory);
    return result;
}

void mspringi_topology_destroy(mspringi_topology *topology, mspringi_memory *memory) {
    mspringi_free(memory, topology->slot_of_particle);
    mspringi_free(memory, topology->particle_of_slot);
    mspringi_places_destroy(&topology->places, memory);
    mspringi_free(memory, topology->up_of_block);
    mspringi_free(memory, topology->grid_of_row);
    mspringi_web_destroy(&topology->web, memory);
    mspringi_free(memory, topology->leftover_a);
    mspringi_free(memory, topology->leftover_b);
    mspringi_free(memory, topology->laid_slots);
    mspringi_free(memory, topology->laid_places);
    mspringi_free(memory, topology->spans);
    mspringi_free(memory, topology->rows);
    mspringi_free(memory, topology->strips);
    mspringi_free(memory, topology->empty_runs);
    *topology = (mspringi_topology){0};
}
