/// Small grids side by side, as books on shelves, so that their rows fill blocks.
///
/// A piece of ten columns leaves six of sixteen lanes empty, and what blasts have left is of no shape at all. Rows
/// say nothing of where particles are, so grids that have nothing to do with each other can share them: each is put
/// where its particles find room farthest left, between those that stand there, and all of a shelf are one grid
/// from then on. Falling height is an old order in which to fill shelves (Coffman, Garey, Johnson and Tarjan,
/// 1980). (Our ship with nine of ten springs broken: 362 lattice blocks instead of 564 where squares are left, 501
/// instead of 604 where blasts have left shapes.)
#include <string.h>

#include "analysis.h"

/// Widest and highest grid that is put on a shelf, others fill their blocks well enough; and the width of a shelf.
#define LARGEST 64
#define SHELF 256
/// Columns before the grid put last from which room is looked for: most of what is further left is full.
#define REACH 64
#define SHELF_WORDS (SHELF / 64 + 1)

typedef struct shelver {
    mspringi_grids *grids;
    uint32_t *width, *height; ///< [grids]
    uint32_t *shelf;          ///< [grids] the first grid on its shelf; itself if it is on none
    uint32_t *number;         ///< [grids] of the first on a shelf, among what is left
    uint64_t *keys, *scratch; ///< [grids]
    uint32_t *members, *first_member;
    uint32_t shelf_height, last_column;   ///< of what was put on it last
    uint64_t taken[LARGEST][SHELF_WORDS]; ///< cells of the shelf, a bit each
    uint64_t rows[LARGEST];               ///< cells of a grid
} shelver;

static uint32_t measure(const shelver *s) {
    const mspringi_grids *grids = s->grids;
    uint32_t narrow = 0;
    for (uint32_t g = 0; g < grids->count; ++g) {
        for (uint32_t m = grids->first_member[g]; m < grids->first_member[g + 1]; ++m) {
            const uint32_t width = grids->column[grids->members[m]] + 1, height = grids->row[grids->members[m]] + 1;
            s->width[g] = width > s->width[g] ? width : s->width[g];
            s->height[g] = height > s->height[g] ? height : s->height[g];
        }
        s->shelf[g] = g;
        if (s->width[g] <= LARGEST && s->height[g] <= LARGEST)
            s->keys[narrow++] = (uint64_t)(UINT32_MAX - s->height[g]) << 32 | g;
    }
    return narrow;
}

static void draw(shelver *s, uint32_t grid) {
    const mspringi_grids *grids = s->grids;
    memset(s->rows, 0, sizeof s->rows);
    for (uint32_t m = grids->first_member[grid]; m < grids->first_member[grid + 1]; ++m)
        s->rows[grids->row[grids->members[m]]] |= (uint64_t)1 << grids->column[grids->members[m]];
}

// The bits of a shelf's row from a column on.
static uint64_t bits_from(const uint64_t *row, uint32_t column) {
    const uint32_t word = column / 64, shift = column % 64;
    return row[word] >> shift | (shift > 0 ? row[word + 1] << (64 - shift) : 0);
}

static bool has_room(const shelver *s, uint32_t height, uint32_t column, uint32_t row) {
    for (uint32_t r = 0; r < height; ++r)
        if (bits_from(s->taken[row + r], column) & s->rows[r])
            return false;
    return true;
}

// Find room on the shelf for the grid that is drawn. Returns false if there is none.
static bool find_room(const shelver *s, uint32_t grid, uint32_t *column, uint32_t *row) {
    for (*column = s->last_column > REACH ? s->last_column - REACH : 0; *column + s->width[grid] <= SHELF;
         ++*column)
        for (*row = 0; *row + s->height[grid] <= s->shelf_height; ++*row)
            if (has_room(s, s->height[grid], *column, *row))
                return true;
    return false;
}

static void put(shelver *s, uint32_t grid, uint32_t column, uint32_t row) {
    const mspringi_grids *grids = s->grids;
    for (uint32_t m = grids->first_member[grid]; m < grids->first_member[grid + 1]; ++m) {
        const uint32_t p = grids->members[m];
        grids->column[p] += column;
        grids->row[p] += row;
        s->taken[grids->row[p]][grids->column[p] / 64] |= (uint64_t)1 << grids->column[p] % 64;
    }
}

static void fill_shelves(shelver *s, uint32_t narrow) {
    uint32_t shelf = 0, column, row;
    mspringi_sort_keys(s->keys, s->scratch, narrow);
    for (uint32_t i = 0; i < narrow; ++i) {
        const uint32_t g = (uint32_t)s->keys[i];
        draw(s, g);
        if (!find_room(s, g, &column, &row)) {
            memset(s->taken, 0, sizeof s->taken);
            s->shelf_height = s->height[g];
            s->last_column = 0;
            shelf = g;
            column = row = 0;
        }
        s->shelf[g] = shelf;
        s->last_column = column;
        put(s, g, column, row);
    }
}

// Make one grid of each shelf.
static void number_shelves(shelver *s) {
    mspringi_grids *grids = s->grids;
    uint32_t count = 0;
    for (uint32_t g = 0; g < grids->count; ++g)
        if (s->shelf[g] == g)
            s->number[g] = count++;
    for (uint32_t g = 0; g < grids->count; ++g)
        s->first_member[s->number[s->shelf[g]] + 1] += grids->first_member[g + 1] - grids->first_member[g];
    for (uint32_t n = 0; n < count; ++n)
        s->first_member[n + 1] += s->first_member[n];
    // Each number's first member wanders to where the next one's begin.
    for (uint32_t m = 0; m < grids->member_count; ++m) {
        const uint32_t p = grids->members[m], number = s->number[s->shelf[grids->grid_of[p]]];
        grids->grid_of[p] = number;
        s->members[s->first_member[number]++] = p;
    }
    memmove(s->first_member + 1, s->first_member, count * sizeof *s->first_member);
    s->first_member[0] = 0;
    memcpy(grids->members, s->members, grids->member_count * sizeof *s->members);
    memcpy(grids->first_member, s->first_member, ((size_t)count + 1) * sizeof *s->first_member);
    grids->count = count;
}

mspring_result mspringi_grids_shelve(mspringi_grids *grids, mspringi_memory *memory, mspringi_message *message) {
    const size_t count = grids->count;
    mspring_result result = MSPRING_OK;
    if (count < 2)
        return result;
    shelver s = {
        .grids = grids,
        .width = mspringi_alloc(memory, count, sizeof *s.width),
        .height = mspringi_alloc(memory, count, sizeof *s.height),
        .shelf = mspringi_alloc(memory, count, sizeof *s.shelf),
        .number = mspringi_alloc(memory, count, sizeof *s.number),
        .keys = mspringi_alloc(memory, count, sizeof *s.keys),
        .scratch = mspringi_alloc(memory, count, sizeof *s.scratch),
        .members = mspringi_alloc(memory, grids->member_count, sizeof *s.members),
        .first_member = mspringi_alloc(memory, count + 1, sizeof *s.first_member),
    };
    if (!s.width || !s.height || !s.shelf || !s.number || !s.keys || !s.scratch || !s.members || !s.first_member) {
        result = mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to put %zu grids side by side", count);
    } else {
        const uint32_t narrow = measure(&s);
        if (narrow > 1) {
            fill_shelves(&s, narrow);
            number_shelves(&s);
        }
    }
    void *const blocks[] = {s.width, s.height, s.shelf, s.number, s.keys, s.scratch, s.members, s.first_member};
    for (size_t i = 0; i < sizeof blocks / sizeof blocks[0]; ++i)
        mspringi_free(memory, blocks[i]);
    return result;
}
