/// Blocks of the grids, and the first blocks of chains and irregular part.
#include "layout/emit/layout_builder.h"
#include "layout/emit/spare.h"

#include <string.h>

static bool append_block(mspringi_layout_builder *a, uint32_t row, uint32_t column_block) {
    uint32_t *last = &a->begin_of_row[a->row_begin + row];
    if (*last == column_block)
        return true; // particles mostly share a block with the one before; sorting drops the remaining duplicates
    *last = column_block;
    void *blocks = a->blocks;
    const bool grown = mspringi_grow(a->memory, &blocks, &a->block_capacity, a->block_count + 1, sizeof *a->blocks);
    a->blocks = blocks;
    if (grown)
        a->blocks[a->block_count++] = mspringi_make_key(row, column_block);
    return grown;
}

// List the blocks of a grid's particle: its own, and those with its springs' records. A north-east spring of a
// block's last slot needs two more: the block to the right carries its force to the row above. Its other end is the
// slot to the right of the block above.
static bool list_blocks(mspringi_layout_builder *a, uint32_t p) {
    const mspringi_grids *grids = &a->grids;
    const uint32_t column = grids->column[p];
    if (!append_block(a, grids->row[p], column / MSPRINGI_WIDTH))
        return false;
    if (column % MSPRINGI_WIDTH < MSPRINGI_WIDTH - 1)
        return true;
    for (uint32_t i = a->graph.first[p]; i < a->graph.first[p + 1]; ++i) {
        const uint32_t other = a->graph.others[i], row = grids->row[p];
        if (grids->place[a->graph.springs[i]] == 0 || grids->column[other] != column + 1)
            continue;
        if (grids->row[other] < row && !append_block(a, row - 1, column / MSPRINGI_WIDTH))
            return false;
        if (grids->row[other] > row && (!append_block(a, row, column / MSPRINGI_WIDTH + 1) ||
                                        !append_block(a, row + 1, column / MSPRINGI_WIDTH)))
            return false;
    }
    return true;
}

// Drop duplicates of the present grid's sorted blocks, and find where its rows begin.
static void drop_repeated(mspringi_layout_builder *a) {
    const size_t count = a->block_count - a->grid_begin;
    mspringi_block_key *keys = a->blocks + a->grid_begin;
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        if (i > 0 && keys[i] == keys[i - 1])
            continue;
        MSPRINGI_ASSERT(i == 0 ||
                        mspringi_row_of_key(keys[i]) <= mspringi_row_of_key(keys[i - 1]) + 1); // none is empty
        if (i == 0 || mspringi_row_of_key(keys[i]) != mspringi_row_of_key(keys[i - 1]))
            a->begin_of_row[a->row_begin + mspringi_row_of_key(keys[i])] = (uint32_t)(a->grid_begin + kept);
        keys[kept++] = keys[i];
    }
    a->block_count = a->grid_begin + kept;
    a->begin_of_row[a->assignment.all_rows] = (uint32_t)a->block_count;
}

uint32_t mspringi_layout_builder_irregular_slot(const mspringi_layout_builder *a, uint32_t i,
                                                uint32_t previous_slot) {
    const uint32_t *particles = a->irregular.particles, *assigned_strip = a->assignment.assigned_strip;
    if (i == 0)
        return 0;
    const uint32_t *tier_of = a->tiers.count > 0 ? a->tiers.tier_of : assigned_strip;
    const bool is_consecutive = assigned_strip[particles[i]] == assigned_strip[particles[i - 1]] &&
                                tier_of[particles[i]] == tier_of[particles[i - 1]] &&
                                i != a->irregular.first_in_bundles;
    return is_consecutive ? previous_slot + 1 : (previous_slot / MSPRINGI_WIDTH + 1) * MSPRINGI_WIDTH;
}

bool mspringi_layout_builder_is_loose(const mspringi_layout_builder *a, uint32_t particle) {
    return a->kinds[particle] == MSPRINGI_ROW_LOOSE &&
           !(a->builder->particles[particle].flags & MSPRINGI_PARTICLE_ABSENT);
}

mspring_result mspringi_layout_builder_begin_blocks(mspringi_layout_builder *a) {
    a->end_block = mspringi_alloc(a->memory, a->grids.count, sizeof *a->end_block);
    a->begin_of_row = mspringi_alloc_unset(a->memory, (size_t)a->assignment.all_rows + 1, sizeof *a->begin_of_row);
    if (!a->end_block || !a->begin_of_row)
        return mspringi_layout_builder_fail(a);
    memset(a->begin_of_row, 0xff, ((size_t)a->assignment.all_rows + 1) * sizeof *a->begin_of_row);
    return MSPRING_OK;
}

static mspring_result sort_blocks(mspringi_layout_builder *a) {
    const size_t count = a->block_count - a->grid_begin;
    uint64_t *scratch = mspringi_alloc(a->memory, count, sizeof *scratch);
    if (!scratch)
        return mspringi_layout_builder_fail(a);
    mspringi_sort_keys(a->blocks + a->grid_begin, scratch, count);
    mspringi_free(a->memory, scratch);
    drop_repeated(a);
    return MSPRING_OK;
}

mspring_result mspringi_layout_builder_number_blocks(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    const mspringi_grids *grids = &a->grids;
    mspring_result result = MSPRING_OK;
    for (uint32_t i = first; result == MSPRING_OK && i < end; ++i) {
        const uint32_t grid = a->assignment.grid_order[a->grid];
        if (a->grid_members == 0) {
            a->grid_begin = a->block_count;
            a->row_begin = a->assignment.first_row[grid];
        }
        if (!list_blocks(a, grids->members[grids->first_member[grid] + a->grid_members++]))
            return mspringi_layout_builder_fail(a);
        if (grids->first_member[grid] + a->grid_members < grids->first_member[grid + 1])
            continue;
        result = sort_blocks(a);
        a->end_block[grid] = (uint32_t)a->block_count;
        a->grid++;
        a->grid_members = 0;
    }
    return result;
}

static void count_irregular_blocks(mspringi_layout_builder *a) {
    a->irregular_slot = 0;
    for (uint32_t i = 0; i < a->irregular.count; ++i) {
        a->irregular_slot = mspringi_layout_builder_irregular_slot(a, i, a->irregular_slot);
        if (i + 1 == a->irregular.assigned_count)
            a->assigned_blocks = a->irregular_slot / MSPRINGI_WIDTH + 1;
        if (i + 1 == a->irregular.first_in_bundles)
            a->unbundled_blocks = a->irregular_slot / MSPRINGI_WIDTH + 1;
    }
}

mspring_result mspringi_layout_builder_number_other_blocks(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    uint32_t loose = 0;
    for (uint32_t p = 0; p < a->builder->particle_count; ++p)
        loose += mspringi_layout_builder_is_loose(a, p);
    count_irregular_blocks(a);
    t->lattice_first = 1;
    t->lattice_blocks = (uint32_t)a->block_count;
    t->chain_first = t->lattice_first + t->lattice_blocks;
    t->chain_blocks = (a->chains.count + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    t->irregular_blocks = a->irregular.count > 0 ? a->irregular_slot / MSPRINGI_WIDTH + 1 : 0;
    t->loose_particles = loose;
    t->loose_blocks = (loose + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    t->spare_blocks = (mspringi_spare_particles(t) + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    // One block of padding: vectors at the end of a chain row reach into it while other threads move the next row.
    t->irregular_first =
        t->chain_first + t->chain_blocks + (t->irregular_blocks + t->loose_blocks + t->spare_blocks > 0);
    t->loose_first = t->irregular_first + t->irregular_blocks;
    t->spare_first = t->loose_first + t->loose_blocks;
    t->block_count = t->spare_first + t->spare_blocks + 1;
    if ((uint64_t)t->lattice_blocks * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH + a->chains.count + MSPRINGI_WIDTH +
            t->reserve.spring_end >=
        MSPRING_NONE)
        return mspringi_fail(a->message, MSPRING_ERROR_LIMIT, "%u lattice blocks exceed the limit of the layout",
                             (unsigned)t->lattice_blocks);
    t->lattice_spring_slots = t->lattice_blocks * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
    t->row_spring_slots = t->lattice_spring_slots + t->chain_blocks * MSPRINGI_WIDTH;
    return MSPRING_OK;
}

uint32_t mspringi_layout_builder_find_block(const mspringi_layout_builder *a, uint32_t grid, uint32_t row,
                                            uint32_t column_block) {
    const mspringi_block_key key = mspringi_make_key(row, column_block);
    const uint32_t *begin = &a->begin_of_row[a->assignment.first_row[grid] + row];
    if (a->assignment.first_row[grid] + row >= a->assignment.all_rows || *begin >= a->end_block[grid])
        return MSPRING_NONE;
    // Rows mostly have no gap.
    const uint32_t ahead = column_block - mspringi_column_block_of_key(a->blocks[*begin]);
    if (ahead < begin[1] - *begin && a->blocks[*begin + ahead] == key)
        return *begin + ahead;
    uint32_t low = *begin, high = begin[1];
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (a->blocks[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < begin[1] && a->blocks[low] == key ? low : MSPRING_NONE;
}
