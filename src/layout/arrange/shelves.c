/// Small grids side by side on shelves, so that their rows fill blocks.
///
/// A component of ten columns leaves six of sixteen lanes empty, and blasts leave ragged shapes. Rows do not depend
/// on positions, so independent grids can share them. Each grid goes where it fits between others with the fewest
/// new blocks; a shelf is then one grid. Grids are placed by falling height (Coffman, Garey, Johnson and Tarjan
/// 1980).
///
/// (Lattice blocks of our ship with nine of ten springs broken: 362 instead of 564 if squares are left. After
/// blasts, which leave ragged shapes, 423 instead of 604, or 501 with the leftmost room.)
#include <string.h>

#include "layout/analysis.h"

/// Largest width and height of a grid on a shelf, as larger ones fill their blocks well enough. Width of a shelf.
#define MAX_SIDE 64
#define SHELF_WIDTH 256
#define SHELF_WORDS (SHELF_WIDTH / 64 + 1)
/// Positions tried for a grid, from the right end of the shelf: this many per particle of an average grid.
#define TRIES_PER_PARTICLE 64

typedef struct mspringi_grid_shelver {
    mspringi_grids *grids;
    uint32_t *width, *height; ///< [grids]
    uint32_t *shelf;          ///< [grids] first grid on the same shelf; itself if it is on none
    uint32_t *number;         ///< [grids] new number of a shelf's first grid
    uint32_t count;           ///< grids after shelving
    uint64_t *keys, *scratch; ///< [grids]
    uint32_t *members, *first_member;
    uint32_t shelf_height, shelf_end;           ///< rows of the shelf, and columns in use
    uint64_t used_cells[MAX_SIDE][SHELF_WORDS]; ///< cells of the shelf in use, a bit each
    uint32_t blocks[MAX_SIDE];                  ///< blocks in use of each row, a bit each
    uint64_t rows[MAX_SIDE];                    ///< cells of the present grid
    uint32_t narrow_count, narrow_member_count; ///< grids that fit on shelves, and their particles
    uint32_t first_on_shelf;                    ///< first grid on the present shelf
} shelver;

static void measure(shelver *s) {
    const mspringi_grids *grids = s->grids;
    for (uint32_t m = 0, g = 0; m < grids->member_count; ++m) {
        const uint32_t width = grids->column[grids->members[m]] + 1, height = grids->row[grids->members[m]] + 1;
        s->width[g] = width > s->width[g] ? width : s->width[g];
        s->height[g] = height > s->height[g] ? height : s->height[g];
        if (m + 1 < grids->first_member[g + 1])
            continue;
        s->shelf[g] = g;
        if (s->width[g] <= MAX_SIDE && s->height[g] <= MAX_SIDE) {
            s->narrow_member_count += grids->first_member[g + 1] - grids->first_member[g];
            s->keys[s->narrow_count++] =
                (uint64_t)((MAX_SIDE - s->height[g]) << 8 | (MAX_SIDE - s->width[g])) << 32 | g;
        }
        ++g;
    }
}

static void load_cells(shelver *s, uint32_t grid) {
    const mspringi_grids *grids = s->grids;
    memset(s->rows, 0, sizeof s->rows);
    for (uint32_t m = grids->first_member[grid]; m < grids->first_member[grid + 1]; ++m)
        s->rows[grids->row[grids->members[m]]] |= (uint64_t)1 << grids->column[grids->members[m]];
}

// Bits of a shelf's row from a column on.
static uint64_t bits_from(const uint64_t *row, uint32_t column) {
    const uint32_t word = column / 64, shift = column % 64;
    return row[word] >> shift | (shift > 0 ? row[word + 1] << (64 - shift) : 0);
}

static bool has_room(const shelver *s, uint32_t height, uint32_t column, uint32_t row) {
    for (uint32_t r = 0; r < height; ++r)
        if (bits_from(s->used_cells[row + r], column) & s->rows[r])
            return false;
    return true;
}

// Blocks that the present grid would add to the shelf.
static uint32_t new_blocks(const shelver *s, uint32_t height, uint32_t column, uint32_t row) {
    const uint32_t block = column / MSPRINGI_WIDTH, shift = column % MSPRINGI_WIDTH;
    uint32_t count = 0;
    for (uint32_t r = 0; r < height; ++r) {
        const uint32_t used = s->blocks[row + r] >> block;
        uint64_t cells = s->rows[r] << shift;
        for (uint32_t k = 0; k < 64 / MSPRINGI_WIDTH; ++k, cells >>= MSPRINGI_WIDTH)
            count += (cells & 0xffff) != 0 && !(used >> k & 1);
        count += shift > 0 && s->rows[r] >> (64 - shift) != 0 && !(used >> 64 / MSPRINGI_WIDTH & 1);
    }
    return count;
}

// Find room on the shelf for the present grid: with the fewest new blocks, then farthest left. Return false if
// there is none.
static bool find_room(const shelver *s, uint32_t grid, uint32_t *column, uint32_t *row) {
    if (s->shelf_height < s->height[grid])
        return false;
    const uint32_t rows = s->shelf_height - s->height[grid] + 1;
    const uint32_t reach =
        (uint32_t)((uint64_t)TRIES_PER_PARTICLE * s->narrow_member_count / s->narrow_count / rows);
    uint32_t fewest = UINT32_MAX;
    for (uint32_t c = s->shelf_end > reach ? s->shelf_end - reach : 0;
         c <= s->shelf_end && c + s->width[grid] <= SHELF_WIDTH && fewest > 0; ++c) {
        for (uint32_t r = 0; r < rows; ++r) {
            if (!has_room(s, s->height[grid], c, r))
                continue;
            const uint32_t blocks = new_blocks(s, s->height[grid], c, r);
            if (blocks >= fewest)
                continue;
            fewest = blocks;
            *column = c;
            *row = r;
        }
    }
    return fewest < UINT32_MAX;
}

static void place_grid(shelver *s, uint32_t grid, uint32_t column, uint32_t row) {
    const mspringi_grids *grids = s->grids;
    for (uint32_t m = grids->first_member[grid]; m < grids->first_member[grid + 1]; ++m) {
        const uint32_t p = grids->members[m];
        grids->column[p] += column;
        grids->row[p] += row;
        s->used_cells[grids->row[p]][grids->column[p] / 64] |= (uint64_t)1 << grids->column[p] % 64;
        s->blocks[grids->row[p]] |= 1u << grids->column[p] / MSPRINGI_WIDTH;
    }
}

static void shelve_grid(shelver *s, uint32_t g) {
    uint32_t column = 0, row = 0;
    load_cells(s, g);
    if (!find_room(s, g, &column, &row)) {
        memset(s->used_cells, 0, sizeof s->used_cells);
        memset(s->blocks, 0, sizeof s->blocks);
        s->shelf_height = s->height[g];
        s->shelf_end = 0;
        s->first_on_shelf = g;
        column = row = 0;
    }
    s->shelf[g] = s->first_on_shelf;
    s->shelf_end = column + s->width[g] > s->shelf_end ? column + s->width[g] : s->shelf_end;
    place_grid(s, g, column, row);
}

uint32_t mspringi_grids_narrow_count(const mspringi_grids *grids) {
    return grids->shelver && grids->shelver->narrow_count > 1 ? grids->shelver->narrow_count : 0;
}

void mspringi_grids_shelve(mspringi_grids *grids, uint32_t first, uint32_t end) {
    shelver *s = grids->shelver;
    for (uint32_t i = first; i < end; ++i)
        shelve_grid(s, (uint32_t)s->keys[i]);
}

// Make one grid of each shelf, and find where its members begin.
static void number_shelves(shelver *s) {
    const mspringi_grids *grids = s->grids;
    uint32_t count = 0;
    for (uint32_t g = 0; g < grids->count; ++g)
        if (s->shelf[g] == g)
            s->number[g] = count++;
    for (uint32_t g = 0; g < grids->count; ++g)
        s->first_member[s->number[s->shelf[g]] + 1] += grids->first_member[g + 1] - grids->first_member[g];
    for (uint32_t n = 0; n < count; ++n)
        s->first_member[n + 1] += s->first_member[n];
    s->count = count;
}

// Move members to their new grids. The begin of each grid moves to its end.
static void move_members(const shelver *s) {
    const mspringi_grids *grids = s->grids;
    for (uint32_t m = 0; m < grids->member_count; ++m) {
        const uint32_t p = grids->members[m], number = s->number[s->shelf[grids->grid_of[p]]];
        grids->grid_of[p] = number;
        s->members[s->first_member[number]++] = p;
    }
}

void mspringi_grids_number(mspringi_grids *grids, mspringi_memory *memory) {
    shelver *s = grids->shelver;
    if (mspringi_grids_narrow_count(grids) > 0) {
        number_shelves(s);
        move_members(s);
        memmove(s->first_member + 1, s->first_member, s->count * sizeof *s->first_member);
        s->first_member[0] = 0;
        memcpy(grids->members, s->members, grids->member_count * sizeof *s->members);
        memcpy(grids->first_member, s->first_member, ((size_t)s->count + 1) * sizeof *s->first_member);
        grids->count = s->count;
    }
    mspringi_shelver_destroy(s, memory);
    grids->shelver = NULL;
}

static mspring_result reserve(mspringi_grids *grids, mspringi_memory *memory, mspringi_message *message) {
    const size_t count = grids->count;
    shelver *s = grids->shelver = mspringi_alloc(memory, 1, sizeof *s);
    if (s) {
        s->grids = grids;
        s->width = mspringi_alloc(memory, count, sizeof *s->width);
        s->height = mspringi_alloc(memory, count, sizeof *s->height);
        s->shelf = mspringi_alloc(memory, count, sizeof *s->shelf);
        s->number = mspringi_alloc(memory, count, sizeof *s->number);
        s->keys = mspringi_alloc(memory, count, sizeof *s->keys);
        s->scratch = mspringi_alloc(memory, count, sizeof *s->scratch);
        s->members = mspringi_alloc(memory, grids->member_count, sizeof *s->members);
        s->first_member = mspringi_alloc(memory, count + 1, sizeof *s->first_member);
    }
    if (!s || !s->width || !s->height || !s->shelf || !s->number || !s->keys || !s->scratch || !s->members ||
        !s->first_member)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu lattices", count);
    return MSPRING_OK;
}

mspring_result mspringi_grids_measure(mspringi_grids *grids, mspringi_memory *memory, mspringi_message *message) {
    if (grids->count < 2)
        return MSPRING_OK;
    mspring_result result = reserve(grids, memory, message);
    if (result != MSPRING_OK)
        return result;
    shelver *s = grids->shelver;
    measure(s);
    mspringi_sort_keys(s->keys, s->scratch, s->narrow_count);
    return MSPRING_OK;
}

void mspringi_shelver_destroy(struct mspringi_grid_shelver *s, mspringi_memory *memory) {
    if (!s)
        return;
    void *const blocks[] = {s->width,   s->height,  s->shelf,        s->number, s->keys,
                            s->scratch, s->members, s->first_member, s};
    for (size_t i = 0; i < sizeof blocks / sizeof blocks[0]; ++i)
        mspringi_free(memory, blocks[i]);
}
