/// Giving every particle a slot and every spring a place.
#include "topology.h"

#include <string.h>

#include "analysis.h"

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
typedef struct assembly {
    mspringi_topology *topology;
    mspringi_memory *memory;
    mspringi_message *message;
    const mspring_builder *builder;
    uint8_t *kinds;
    mspringi_graph graph;
    mspringi_strands strands;
    mspringi_grids grids;
    mspringi_web_list web;
    block_key *blocks; ///< of all grids, grid after grid, each sorted
    size_t block_count, block_capacity;
    size_t grid_begin;     ///< where the blocks of the grid that is being listed begin
    uint32_t *first_block; ///< [grids + 1] in blocks
    size_t row_capacity, span_capacity;
} assembly;

static mspring_result out_of_memory(assembly *a) {
    return mspringi_fail(a->message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles and %zu springs",
                         a->builder->particle_count, a->builder->spring_count);
}

/* --------------------------------------------------------------------------------------------- lattice blocks */

// How a spring lies on its grid; false if it does not join neighbouring cells of one grid.
typedef struct lattice_spring {
    mspringi_direction direction;
    uint32_t column, row; ///< the slot whose record it is in
} lattice_spring;

static bool find_direction(const mspringi_grids *grids, const mspringi_spring *spring, lattice_spring *found) {
    uint32_t base = spring->a, tip = spring->b;
    if (grids->grid_of[base] == MSPRING_NONE || grids->grid_of[base] != grids->grid_of[tip])
        return false;
    // The base is in the column to the left or, in the same column, in the row below.
    if (grids->column[base] > grids->column[tip] ||
        (grids->column[base] == grids->column[tip] && grids->row[base] > grids->row[tip])) {
        base = spring->b;
        tip = spring->a;
    }
    const uint32_t right = grids->column[tip] - grids->column[base];
    const int64_t up = (int64_t)grids->row[tip] - (int64_t)grids->row[base];
    if (right > 1 || up > 1 || up < -1)
        return false;
    found->column = grids->column[base];
    found->row = grids->row[base] - (up < 0);
    found->direction = up < 0       ? MSPRINGI_SOUTH_EAST
                       : up == 0    ? MSPRINGI_EAST
                       : right == 0 ? MSPRINGI_NORTH
                                    : MSPRINGI_NORTH_EAST;
    return true;
}

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

// List the blocks of one grid: those with particles; those that own a spring; and, where a block's last slot has a
// north-east spring, the block to its right, through which the spring's force is handed on to the row above, and
// the block above it, so that the slot to the right of that is the spring's other end.
static bool list_blocks(assembly *a, uint32_t grid) {
    const mspringi_grids *grids = &a->grids;
    for (uint32_t m = grids->first_member[grid]; m < grids->first_member[grid + 1]; ++m) {
        const uint32_t p = grids->members[m];
        if (!append_block(a, grids->row[p], grids->column[p] / MSPRINGI_WIDTH))
            return false;
        for (uint32_t i = a->graph.first[p]; i < a->graph.first[p + 1]; ++i) {
            lattice_spring spring;
            if (!find_direction(grids, &a->builder->springs[a->graph.springs[i]], &spring) ||
                spring.column % MSPRINGI_WIDTH != MSPRINGI_WIDTH - 1)
                continue;
            const uint32_t column_block = spring.column / MSPRINGI_WIDTH;
            if (spring.direction == MSPRINGI_SOUTH_EAST && !append_block(a, spring.row, column_block))
                return false;
            if (spring.direction == MSPRINGI_NORTH_EAST &&
                (!append_block(a, spring.row, column_block + 1) || !append_block(a, spring.row + 1, column_block)))
                return false;
        }
    }
    return true;
}

// Sort the blocks of the grid that has been listed and drop repeated ones.
static bool sort_blocks(assembly *a) {
    const size_t count = a->block_count - a->grid_begin;
    block_key *keys = a->blocks + a->grid_begin;
    block_key *scratch = mspringi_alloc(a->memory, count, sizeof *scratch);
    if (!scratch)
        return false;
    mspringi_sort_keys(keys, scratch, count);
    mspringi_free(a->memory, scratch);
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i)
        if (i == 0 || keys[i] != keys[i - 1])
            keys[kept++] = keys[i];
    a->block_count = a->grid_begin + kept;
    return true;
}

static mspring_result number_blocks(assembly *a) {
    mspringi_topology *t = a->topology;
    a->first_block = mspringi_alloc(a->memory, a->grids.count + 1, sizeof *a->first_block);
    if (!a->first_block)
        return out_of_memory(a);
    for (uint32_t grid = 0; grid < a->grids.count; ++grid) {
        a->first_block[grid] = (uint32_t)a->block_count;
        a->grid_begin = a->block_count;
        if (!list_blocks(a, grid) || !sort_blocks(a))
            return out_of_memory(a);
    }
    a->first_block[a->grids.count] = (uint32_t)a->block_count;

    uint32_t loose = 0;
    for (size_t p = 0; p < a->builder->particle_count; ++p)
        loose += a->kinds[p] == MSPRINGI_ROW_LOOSE;
    t->lattice_first = 1;
    t->lattice_blocks = (uint32_t)a->block_count;
    t->chain_first = t->lattice_first + t->lattice_blocks;
    t->chain_blocks = (a->strands.count + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    t->web_first = t->chain_first + t->chain_blocks;
    t->web_blocks = (a->web.count + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    t->loose_first = t->web_first + t->web_blocks;
    t->loose_blocks = (loose + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    t->block_count = t->loose_first + t->loose_blocks + 1;
    if ((uint64_t)t->lattice_blocks * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH + a->strands.count + MSPRINGI_WIDTH +
            a->builder->spring_count >=
        MSPRING_NONE)
        return mspringi_fail(a->message, MSPRING_ERROR_LIMIT, "%u blocks of lattice are more than can be numbered",
                             (unsigned)t->lattice_blocks);
    return MSPRING_OK;
}

// The number of a grid's block among all lattice blocks; MSPRING_NONE if it is not stored.
static uint32_t find_block(const assembly *a, uint32_t grid, uint32_t row, uint32_t column_block) {
    const block_key key = make_key(row, column_block);
    uint32_t low = a->first_block[grid], high = a->first_block[grid + 1];
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (a->blocks[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < a->first_block[grid + 1] && a->blocks[low] == key ? low : MSPRING_NONE;
}

/* -------------------------------------------------------------------------------------------- slots and places */

static void place_particle(mspringi_topology *t, uint32_t particle, uint32_t slot) {
    t->slot_of_particle[particle] = slot;
    t->particle_of_slot[slot] = particle;
}

static void assign_slots(assembly *a) {
    mspringi_topology *t = a->topology;
    const mspringi_grids *grids = &a->grids;
    for (uint32_t slot = 0; slot < t->block_count * MSPRINGI_WIDTH; ++slot)
        t->particle_of_slot[slot] = MSPRING_NONE;
    uint32_t loose = t->loose_first * MSPRINGI_WIDTH;
    for (uint32_t p = 0; p < t->particle_count; ++p) {
        if (a->kinds[p] == MSPRINGI_ROW_LATTICE) {
            const uint32_t block =
                find_block(a, grids->grid_of[p], grids->row[p], grids->column[p] / MSPRINGI_WIDTH);
            place_particle(t, p, (t->lattice_first + block) * MSPRINGI_WIDTH + grids->column[p] % MSPRINGI_WIDTH);
        } else if (a->kinds[p] == MSPRINGI_ROW_LOOSE) {
            place_particle(t, p, loose++);
        }
    }
    for (uint32_t i = 0; i < a->strands.count; ++i)
        place_particle(t, a->strands.particles[i], t->chain_first * MSPRINGI_WIDTH + i);
    for (uint32_t i = 0; i < a->web.count; ++i)
        place_particle(t, a->web.particles[i], t->web_first * MSPRINGI_WIDTH + i);
}

static mspring_result assign_places(assembly *a) {
    mspringi_topology *t = a->topology;
    t->lattice_places = t->lattice_blocks * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
    t->chain_places = t->lattice_places + t->chain_blocks * MSPRINGI_WIDTH;
    for (uint32_t s = 0; s < t->spring_count; ++s)
        t->place_of_spring[s] = MSPRING_NONE;
    for (uint32_t i = 0; i < a->strands.count; ++i)
        if (a->strands.springs[i] != MSPRING_NONE)
            t->place_of_spring[a->strands.springs[i]] = t->lattice_places + i;
    for (uint32_t s = 0; s < t->spring_count; ++s) {
        lattice_spring found;
        if (t->place_of_spring[s] != MSPRING_NONE)
            continue;
        if (!find_direction(&a->grids, &a->builder->springs[s], &found)) {
            t->place_of_spring[s] = t->chain_places + t->leftover_count++;
            continue;
        }
        const uint32_t grid = a->grids.grid_of[a->builder->springs[s].a];
        const uint32_t block = find_block(a, grid, found.row, found.column / MSPRINGI_WIDTH);
        t->place_of_spring[s] = (block * MSPRINGI_DIRECTIONS + (uint32_t)found.direction) * MSPRINGI_WIDTH +
                                found.column % MSPRINGI_WIDTH;
        t->lattice_springs++;
    }

    t->leftover_a = mspringi_alloc(a->memory, t->leftover_count, sizeof *t->leftover_a);
    t->leftover_b = mspringi_alloc(a->memory, t->leftover_count, sizeof *t->leftover_b);
    if (!t->leftover_a || !t->leftover_b)
        return out_of_memory(a);
    for (uint32_t s = 0; s < t->spring_count; ++s) {
        if (t->place_of_spring[s] < t->chain_places)
            continue;
        const uint32_t i = t->place_of_spring[s] - t->chain_places;
        t->leftover_a[i] = t->slot_of_particle[a->builder->springs[s].a];
        t->leftover_b[i] = t->slot_of_particle[a->builder->springs[s].b];
    }
    return mspringi_web_create(&t->web, t->leftover_a, t->leftover_b, t->leftover_count,
                               t->web_first * MSPRINGI_WIDTH, t->web_blocks * MSPRINGI_WIDTH,
                               t->block_count * MSPRINGI_WIDTH, a->memory, a->message);
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
    void *spans = t->spans;
    const bool grown = mspringi_grow(a->memory, &spans, &a->span_capacity, (size_t)t->span_count + 2, sizeof *span);
    t->spans = spans;
    if (grown) {
        t->spans[t->span_count++] = *span;
        row->span_count++;
    }
    return grown;
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

static bool append_lattice_rows(assembly *a, uint32_t grid) {
    mspringi_topology *t = a->topology;
    for (uint32_t i = a->first_block[grid]; i < a->first_block[grid + 1]; ++i) {
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
            t->lattice_rows++;
        }
        if (up != MSPRING_NONE)
            t->rows[t->row_count - 1].kind = MSPRINGI_ROW_LATTICE;
        if (!append_span(a, &span))
            return false;
    }
    return true;
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
static bool append_simple_row(assembly *a, mspringi_row_kind kind, uint32_t first_block, uint32_t block_count) {
    const mspringi_span span = span_of_blocks(first_block, block_count, 0, MSPRINGI_WIDTH);
    return block_count == 0 || (append_row(a, kind) && append_span(a, &span));
}

// Mark the rows at whose slots the web pulls. Both lists are in slot order.
static void mark_pulled_rows(mspringi_topology *t) {
    uint32_t i = 0;
    for (uint32_t r = 0; r < t->row_count; ++r) {
        mspringi_row *row = &t->rows[r];
        const mspringi_span *last = &t->spans[row->first_span + row->span_count - 1];
        for (; i < t->web.attached_count && t->web.attached_slot[i] < last->end_slot; ++i)
            row->pulled = 1;
    }
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
static bool trim_spans(assembly *a) {
    mspringi_topology *t = a->topology;
    uint8_t *busy = mspringi_alloc(a->memory, t->block_count, sizeof *busy);
    if (!busy)
        return false;
    for (uint32_t slot = 0; slot < t->block_count * MSPRINGI_WIDTH; ++slot)
        if (t->particle_of_slot[slot] != MSPRING_NONE)
            mark_busy(busy, slot);
    for (uint32_t s = 0; s < t->spring_count; ++s) {
        const mspringi_place place = t->place_of_spring[s];
        if (place >= t->lattice_places)
            continue;
        const uint32_t block = place / (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH);
        const uint32_t slot = (t->lattice_first + block) * MSPRINGI_WIDTH + place % MSPRINGI_WIDTH;
        mark_busy(busy, slot);
        if (place / MSPRINGI_WIDTH % MSPRINGI_DIRECTIONS == MSPRINGI_NORTH_EAST)
            mark_busy(busy, slot + 1);
    }
    const uint32_t lattice_end = t->chain_first * MSPRINGI_WIDTH;
    for (uint32_t s = 0; s < t->span_count && t->spans[s].first_slot < lattice_end; ++s) {
        mspringi_span *span = &t->spans[s];
        // Within its first and its last block; one quarter is left of a block that is all idle (and is there for
        // the slot to its right).
        while (span->first_slot % MSPRINGI_WIDTH < MSPRINGI_WIDTH - MSPRINGI_QUARTER &&
               !is_busy(busy, span->first_slot))
            span->first_slot += MSPRINGI_QUARTER;
        while (span->end_slot - MSPRINGI_QUARTER > span->first_slot &&
               (span->end_slot - 1) % MSPRINGI_WIDTH >= MSPRINGI_QUARTER && !is_busy(busy, span->end_slot - 1))
            span->end_slot -= MSPRINGI_QUARTER;
    }
    mspringi_free(a->memory, busy);
    return true;
}

static mspring_result make_rows(assembly *a) {
    mspringi_topology *t = a->topology;
    t->carry_blocks = widest_row(a);
    t->up_of_block = mspringi_alloc(a->memory, t->lattice_blocks, sizeof *t->up_of_block);
    if (!t->up_of_block)
        return out_of_memory(a);
    for (uint32_t grid = 0; grid < a->grids.count; ++grid)
        if (!append_lattice_rows(a, grid))
            return out_of_memory(a);
    if (!append_chain_row(a) || !append_simple_row(a, MSPRINGI_ROW_WEB, t->web_first, t->web_blocks) ||
        !append_simple_row(a, MSPRINGI_ROW_LOOSE, t->loose_first, t->loose_blocks) || !trim_spans(a))
        return out_of_memory(a);
    mark_pulled_rows(t);
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------------- the whole */

// List the slots without particle, the padding in front and behind among them.
static mspring_result list_empty_slots(assembly *a) {
    mspringi_topology *t = a->topology;
    const uint32_t end = t->block_count * MSPRINGI_WIDTH;
    for (int pass = 0; pass < 2; ++pass) { // first count, then fill
        uint32_t runs = 0;
        bool in_run = false;
        for (uint32_t slot = 0; slot < end; ++slot) {
            const bool empty = t->particle_of_slot[slot] == MSPRING_NONE;
            if (empty && !in_run && pass == 1)
                t->empty_runs[runs] = (mspringi_empty_run){.first_slot = slot};
            runs += empty && !in_run;
            if (empty && pass == 1)
                t->empty_runs[runs - 1].slot_count++;
            in_run = empty;
        }
        if (pass == 0)
            t->empty_runs = mspringi_alloc(a->memory, runs, sizeof *t->empty_runs);
        if (!t->empty_runs)
            return out_of_memory(a);
        t->empty_run_count = runs;
    }
    return MSPRING_OK;
}

static mspring_result allocate_maps(assembly *a) {
    mspringi_topology *t = a->topology;
    const size_t slots = (size_t)t->block_count * MSPRINGI_WIDTH;
    t->slot_of_particle = mspringi_alloc(a->memory, t->particle_count, sizeof *t->slot_of_particle);
    t->particle_of_slot = mspringi_alloc(a->memory, slots, sizeof *t->particle_of_slot);
    t->place_of_spring = mspringi_alloc(a->memory, t->spring_count, sizeof *t->place_of_spring);
    return t->slot_of_particle && t->particle_of_slot && t->place_of_spring ? MSPRING_OK : out_of_memory(a);
}

static mspring_result assemble(assembly *a) {
    const size_t particles = a->builder->particle_count;
    a->kinds = mspringi_alloc(a->memory, particles, sizeof *a->kinds);
    if (!a->kinds)
        return out_of_memory(a);
    memset(a->kinds, MSPRINGI_ROW_LOOSE, particles);
    mspring_result result = mspringi_graph_create(&a->graph, a->builder, a->memory, a->message);
    if (result == MSPRING_OK)
        result = mspringi_strands_find(&a->strands, &a->graph, a->kinds, a->memory, a->message);
    if (result == MSPRING_OK)
        result = mspringi_grids_find(&a->grids, &a->graph, a->kinds, a->memory, a->message);
    if (result == MSPRING_OK)
        result = mspringi_web_list_find(&a->web, &a->graph, a->kinds, a->memory, a->message);
    if (result == MSPRING_OK)
        result = number_blocks(a);
    if (result == MSPRING_OK)
        result = allocate_maps(a);
    if (result != MSPRING_OK)
        return result;
    assign_slots(a);
    result = list_empty_slots(a);
    if (result == MSPRING_OK)
        result = assign_places(a);
    return result == MSPRING_OK ? make_rows(a) : result;
}

mspring_result mspringi_topology_create(mspringi_topology *topology, const mspring_builder *builder,
                                        mspringi_memory *memory, mspringi_message *message) {
    *topology = (mspringi_topology){.particle_count = (uint32_t)builder->particle_count,
                                    .spring_count = (uint32_t)builder->spring_count};
    assembly a = {.topology = topology, .memory = memory, .message = message, .builder = builder};
    mspring_result result = assemble(&a);
    if (result == MSPRING_OK) {
        topology->lattice_count = a.grids.count;
        topology->lattice_particles = a.grids.member_count;
        topology->chain_count = a.strands.strand_count;
        topology->chain_particles = a.strands.count;
        topology->chain_springs = a.strands.spring_count;
        topology->web_particles = a.web.count;
    } else {
        mspringi_topology_destroy(topology, memory);
    }
    mspringi_free(memory, a.kinds);
    mspringi_free(memory, a.blocks);
    mspringi_free(memory, a.first_block);
    mspringi_graph_destroy(&a.graph, memory);
    mspringi_strands_destroy(&a.strands, memory);
    mspringi_grids_destroy(&a.grids, memory);
    mspringi_web_list_destroy(&a.web, memory);
    return result;
}

void mspringi_topology_destroy(mspringi_topology *topology, mspringi_memory *memory) {
    mspringi_free(memory, topology->slot_of_particle);
    mspringi_free(memory, topology->particle_of_slot);
    mspringi_free(memory, topology->place_of_spring);
    mspringi_free(memory, topology->up_of_block);
    mspringi_web_destroy(&topology->web, memory);
    mspringi_free(memory, topology->leftover_a);
    mspringi_free(memory, topology->leftover_b);
    mspringi_free(memory, topology->spans);
    mspringi_free(memory, topology->rows);
    mspringi_free(memory, topology->empty_runs);
    *topology = (mspringi_topology){0};
}
