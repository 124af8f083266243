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

typedef struct mspringi_grid_shelver {
    mspringi_grids *grids;
    uint32_t *width, *height; ///< [grids]
    uint32_t *shelf;          ///< [grids] the first grid on its shelf; itself if it is on none
    uint32_t *number;         ///< [grids] of the first on a shelf, among what is left
    uint32_t count;           ///< what is left
    uint64_t *keys, *scratch; ///< [grids]
    uint32_t *members, *first_member;
    uint32_t shelf_height, last_column;   ///< of what was put on it last
    uint64_t taken[LARGEST][SHELF_WORDS]; ///< cells of the shelf, a bit each
    uint64_t rows[LARGEST];               ///< cells of a grid
    uint32_t narrow;                      ///< grids that may be put on shelves
    uint32_t grid;                        ///< the one that is measured
    uint32_t first_on_shelf;              ///< the grid that the shelf began with
    bool is_sorted;
    mspringi_sorting sorting;
} shelver;

static void measure(shelver *s, mspringi_pace *pace) {
    const mspringi_grids *grids = s->grids;
    uint32_t first, end, g = s->grid;
    mspringi_pace_take(pace, grids->member_count, 2, &first, &end);
    for (uint32_t m = first; m < end; ++m) {
        const uint32_t width = grids->column[grids->members[m]] + 1, height = grids->row[grids->members[m]] + 1;
        s->width[g] = width > s->width[g] ? width : s->width[g];
        s->height[g] = height > s->height[g] ? height : s->height[g];
        if (m + 1 < grids->first_member[g + 1])
            continue;
        s->shelf[g] = g;
        if (s->width[g] <= LARGEST && s->height[g] <= LARGEST)
            s->keys[s->narrow++] = (uint64_t)(UINT32_MAX - s->height[g]) << 32 | g;
        ++g;
    }
    s->grid = g;
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
static bool find_room(const shelver *s, uint32_t grid, uint32_t *column, uint32_t *row, mspringi_pace *pace) {
    for (*column = s->last_column > REACH ? s->last_column - REACH : 0; *column + s->width[grid] <= SHELF;
         ++*column)
        for (*row = 0; *row + s->height[grid] <= s->shelf_height; ++*row) {
            mspringi_pace_spend(pace, 1);
            if (has_room(s, s->height[grid], *column, *row))
                return true;
        }
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

static void put_next(shelver *s, uint32_t g, mspringi_pace *pace) {
    uint32_t column, row;
    draw(s, g);
    if (!find_room(s, g, &column, &row, pace)) {
        memset(s->taken, 0, sizeof s->taken);
        s->shelf_height = s->height[g];
        s->last_column = 0;
        s->first_on_shelf = g;
        column = row = 0;
    }
    s->shelf[g] = s->first_on_shelf;
    s->last_column = column;
    put(s, g, column, row);
}

void mspringi_grids_shelve(mspringi_grids *grids, mspringi_pace *pace) {
    shelver *s = grids->shelver;
    if (!s || s->narrow < 2)
        return;
    s->is_sorted = s->is_sorted || mspringi_sorting_go_on(&s->sorting, pace);
    for (; s->is_sorted && pace->at < s->narrow && pace->left > 0; pace->at++) {
        const uint32_t g = (uint32_t)s->keys[pace->at];
        mspringi_pace_spend(pace, LARGEST + 4 * (grids->first_member[g + 1] - grids->first_member[g]));
        put_next(s, g, pace);
    }
    pace->is_halfway = pace->at < s->narrow;
}

// Make one grid of each shelf: count their members, then have these wander to their shelf's.
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

// Each number's first member wanders to where the next one's begin.
static void move_members(shelver *s, mspringi_pace *pace) {
    const mspringi_grids *grids = s->grids;
    uint32_t first, end;
    mspringi_pace_take(pace, grids->member_count, 4, &first, &end);
    for (uint32_t m = first; m < end; ++m) {
        const uint32_t p = grids->members[m], number = s->number[s->shelf[grids->grid_of[p]]];
        grids->grid_of[p] = number;
        s->members[s->first_member[number]++] = p;
    }
}

void mspringi_grids_number(mspringi_grids *grids, mspringi_pace *pace, mspringi_memory *memory) {
    shelver *s = grids->shelver;
    if (s && s->narrow > 1) {
        if (pace->at == 0)
            number_shelves(s);
        move_members(s, pace);
        if (pace->is_halfway)
            return;
        memmove(s->first_member + 1, s->first_member, s->count * sizeof *s->first_member);
        s->first_member[0] = 0;
        memcpy(grids->members, s->members, grids->member_count * sizeof *s->members);
        memcpy(grids->first_member, s->first_member, ((size_t)s->count + 1) * sizeof *s->first_member);
        grids->count = s->count;
    }
    mspringi_shelver_destroy(s, memory);
    grids->shelver = NULL;
}

static mspring_result reserve(mspringi_grids *grids, mspringi_pace *pace, mspringi_memory *memory,
                              mspringi_message *message) {
    const size_t count = grids->count;
    shelver *s = grids->shelver = mspringi_alloc(memory, 1, sizeof *s);
    if (s) {
        s->grids = grids;
        s->width = mspringi_pace_alloc(pace, memory, count, sizeof *s->width);
        s->height = mspringi_pace_alloc(pace, memory, count, sizeof *s->height);
        s->shelf = mspringi_pace_alloc(pace, memory, count, sizeof *s->shelf);
        s->number = mspringi_pace_alloc(pace, memory, count, sizeof *s->number);
        s->keys = mspringi_pace_alloc(pace, memory, count, sizeof *s->keys);
        s->scratch = mspringi_pace_alloc(pace, memory, count, sizeof *s->scratch);
        s->members = mspringi_pace_alloc(pace, memory, grids->member_count, sizeof *s->members);
        s->first_member = mspringi_pace_alloc(pace, memory, count + 1, sizeof *s->first_member);
    }
    if (!s || !s->width || !s->height || !s->shelf || !s->number || !s->keys || !s->scratch || !s->members ||
        !s->first_member)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to put %zu grids side by side", count);
    return MSPRING_OK;
}

mspring_result mspringi_grids_measure(mspringi_grids *grids, mspringi_pace *pace, mspringi_memory *memory,
                                      mspringi_message *message) {
    if (grids->count < 2)
        return MSPRING_OK;
    mspring_result result = grids->shelver ? MSPRING_OK : reserve(grids, pace, memory, message);
    if (result != MSPRING_OK)
        return result;
    measure(grids->shelver, pace);
    if (!pace->is_halfway)
        mspringi_sorting_begin(&grids->shelver->sorting, grids->shelver->keys, grids->shelver->scratch,
                               grids->shelver->narrow);
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
