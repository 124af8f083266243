/// @file arrange.c
/// Which springs are summed by rows. A network has three kinds of particles with springs:
///
///   chain      in a path of particles with one or two springs each
///   lattice    in a grid with neighbours in eight directions
///   irregular  all others
///
/// Springs between neighbours in a lattice or a chain are summed by rows, all others by rising number. This follows
/// the layout of a network at creation, for less than 1,000 particles in lattices, less than 60,000 others, and
/// less than 64 equal components that are partly lattice or chain. In larger networks the layout drops some
/// lattices and chains.
///
/// SPDX-License-Identifier: MIT
#include "arrange.h"

#include <stdlib.h>
#include <string.h>

/// Largest lattice that shares rows with others, and columns and rows of such a shelf.
#define LARGEST_SHELVED 64
#define SHELF_COLUMNS 256

void *spec_make(size_t count, size_t size) {
    void *memory = calloc(count + 1, size);
    if (memory == NULL) {
        abort();
    }
    return memory;
}

static uint32_t degree_of(const spec_arrangement *a, uint32_t p) {
    return a->first[p + 1] - a->first[p];
}

uint32_t spec_other_end(const spec_arrangement *a, uint32_t spring, uint32_t p) {
    const spec_spring *s = &a->network->springs[spring];
    return s->a == p ? s->b : s->a;
}

static void list_springs(spec_arrangement *a) {
    const spec_network *n = a->network;
    uint32_t *next = spec_make(n->particle_count, sizeof *next);
    for (uint32_t s = 0; s < n->spring_count; s++) {
        a->first[n->springs[s].a + 1]++;
        a->first[n->springs[s].b + 1]++;
    }
    for (uint32_t p = 0; p < n->particle_count; p++) {
        a->first[p + 1] += a->first[p];
        next[p] = a->first[p];
    }
    for (uint32_t s = 0; s < n->spring_count; s++) {
        a->springs[next[n->springs[s].a]++] = s;
        a->springs[next[n->springs[s].b]++] = s;
    }
    free(next);
}

bool spec_joins_cells(const spec_arrangement *a, uint32_t spring) {
    const spec_spring *s = &a->network->springs[spring];
    return a->lattice[s->a] != 0 && a->lattice[s->a] == a->lattice[s->b] &&
           abs(a->column[s->a] - a->column[s->b]) <= 1 && abs(a->row[s->a] - a->row[s->b]) <= 1;
}

int spec_compare_keys(const void *a, const void *b) {
    const uint64_t one = *(const uint64_t *)a, other = *(const uint64_t *)b;
    return (one > other) - (one < other);
}

/* ------------------------------------------------------------------------------------------------------- chains */

static bool may_be_in_chain(const spec_arrangement *a, uint32_t p) {
    return degree_of(a, p) == 1 || degree_of(a, p) == 2;
}

// First spring of a particle that goes on along a chain, or SPEC_NONE.
static uint32_t next_in_chain(const spec_arrangement *a, uint32_t p, uint32_t came_by) {
    for (uint32_t i = a->first[p]; i < a->first[p + 1]; i++) {
        if (a->springs[i] != came_by && may_be_in_chain(a, spec_other_end(a, a->springs[i], p))) {
            return a->springs[i];
        }
    }
    return SPEC_NONE;
}

// From a particle to an end of its path, or once around a ring.
static uint32_t find_chain_end(const spec_arrangement *a, uint32_t start) {
    uint32_t at = start, came_by = SPEC_NONE;
    do {
        const uint32_t spring = next_in_chain(a, at, came_by);
        if (spring == SPEC_NONE) {
            return at;
        }
        at = spec_other_end(a, spring, at);
        came_by = spring;
    } while (at != start);
    return at;
}

// Make a chain of the path from an end on. One or two particles that hang on something else are irregular.
static void make_chain(const spec_arrangement *a, uint32_t end, uint8_t *is_visited) {
    uint32_t count = 0, at = end, spring = SPEC_NONE;
    bool hangs = false;
    for (bool goes_on = true; goes_on;) {
        a->queue[count++] = at;
        is_visited[at] = 1;
        for (uint32_t i = a->first[at]; i < a->first[at + 1]; i++) {
            hangs |= !may_be_in_chain(a, spec_other_end(a, a->springs[i], at));
        }
        spring = next_in_chain(a, at, spring);
        goes_on = spring != SPEC_NONE && !is_visited[spec_other_end(a, spring, at)];
        at = goes_on ? spec_other_end(a, spring, at) : at;
        if (goes_on) {
            a->is_in_chain[spring] = 1;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        a->kinds[a->queue[i]] = hangs && count < 3 ? SPEC_LOOSE : SPEC_CHAIN;
        a->column[a->queue[i]] = (int32_t)end;
        a->row[a->queue[i]] = (int32_t)count;
    }
}

static void find_chains(const spec_arrangement *a) {
    uint8_t *is_visited = spec_make(a->network->particle_count, 1);
    for (uint32_t p = 0; p < a->network->particle_count; p++) {
        if (may_be_in_chain(a, p) && !is_visited[p]) {
            make_chain(a, find_chain_end(a, p), is_visited);
        }
    }
    free(is_visited);
}
/* ------------------------------------------------------------------------------------------------------ shelves */

/// Cells and blocks in use of a shelf, on which small lattices lie side by side.
typedef struct shelf {
    uint8_t is_used[LARGEST_SHELVED][SHELF_COLUMNS], is_block[LARGEST_SHELVED][SHELF_COLUMNS / SPEC_BLOCK];
    int32_t height, end; ///< rows; columns in use
    uint32_t number;
} shelf;

static void find_size(const spec_arrangement *a, uint32_t lattice, int32_t *width, int32_t *height,
                      uint32_t *count) {
    *width = *height = 0;
    *count = 0;
    for (uint32_t p = 0; p < a->network->particle_count; p++) {
        if (a->lattice[p] == lattice) {
            *width = a->column[p] >= *width ? a->column[p] + 1 : *width;
            *height = a->row[p] >= *height ? a->row[p] + 1 : *height;
            ++*count;
        }
    }
}

// Blocks that a lattice would add to a shelf, or SPEC_NONE if a cell is in use.
static uint32_t count_new_blocks(const spec_arrangement *a, const shelf *s, uint32_t lattice, int32_t column,
                                 int32_t row) {
    uint8_t is_new[LARGEST_SHELVED][SHELF_COLUMNS / SPEC_BLOCK];
    uint32_t count = 0;
    memset(is_new, 0, sizeof is_new);
    for (uint32_t p = 0; p < a->network->particle_count; p++) {
        const int32_t c = a->column[p] + column, r = a->row[p] + row;
        if (a->lattice[p] != lattice) {
            continue;
        }
        if (s->is_used[r][c]) {
            return SPEC_NONE;
        }
        count += !s->is_block[r][c / SPEC_BLOCK] && !is_new[r][c / SPEC_BLOCK];
        is_new[r][c / SPEC_BLOCK] = 1;
    }
    return count;
}

// Put a lattice where it adds fewest blocks, then farthest left, then lowest; on a new shelf if there is no room.
static void shelve(const spec_arrangement *a, shelf *s, uint32_t lattice, int32_t reach) {
    int32_t width, height, to[2] = {0, 0};
    uint32_t count, fewest = SPEC_NONE;
    find_size(a, lattice, &width, &height, &count);
    const int32_t rows = s->height - height + 1;
    reach = rows > 0 ? reach / rows : 0;
    for (int32_t c = s->end > reach ? s->end - reach : 0; c <= s->end && c + width <= SHELF_COLUMNS && fewest > 0;
         c++) {
        for (int32_t r = 0; r < rows; r++) {
            const uint32_t blocks = count_new_blocks(a, s, lattice, c, r);
            if (blocks < fewest) {
                fewest = blocks;
                to[0] = c;
                to[1] = r;
            }
        }
    }
    if (fewest == SPEC_NONE) {
        *s = (shelf){.height = height, .number = lattice};
    }
    s->end = to[0] + width > s->end ? to[0] + width : s->end;
    for (uint32_t p = 0; p < a->network->particle_count; p++) {
        if (a->lattice[p] == lattice) {
            a->column[p] += to[0];
            a->row[p] += to[1];
            s->is_used[a->row[p]][a->column[p]] = s->is_block[a->row[p]][a->column[p] / SPEC_BLOCK] = 1;
        }
    }
    a->part[lattice] = s->number;
}

// Put small lattices side by side, the highest first, then the widest. Those on one shelf are one lattice from here
// on.
static void shelve_lattices(const spec_arrangement *a) {
    uint64_t *keys = spec_make(a->lattice_count, sizeof *keys);
    uint32_t narrow = 0, members = 0;
    for (uint32_t i = 1; i <= a->lattice_count; i++) {
        int32_t width, height;
        uint32_t count;
        find_size(a, i, &width, &height, &count);
        a->part[i] = i;
        if (width <= LARGEST_SHELVED && height <= LARGEST_SHELVED) {
            members += count;
            keys[narrow++] = (uint64_t)((LARGEST_SHELVED - height) << 8 | (LARGEST_SHELVED - width)) << 32 | i;
        }
    }
    qsort(keys, narrow, sizeof *keys, spec_compare_keys);
    shelf *s = spec_make(1, sizeof *s);
    for (uint32_t i = 0; narrow > 1 && i < narrow; i++) {
        shelve(a, s, (uint32_t)keys[i], (int32_t)(64 * members / narrow));
    }
    for (uint32_t p = 0; p < a->network->particle_count; p++) {
        a->lattice[p] = a->lattice[p] > 0 ? a->part[a->lattice[p]] : 0;
    }
    free(s);
    free(keys);
}

/* ----------------------------------------------------------------------------------------------------- the sums */

static uint32_t root_of(const spec_arrangement *a, uint32_t p) {
    while (a->part[p] != p) {
        p = a->part[p];
    }
    return p;
}

// Join the particles of each component, and those of each shelf.
static void join_parts(const spec_arrangement *a) {
    const spec_network *n = a->network;
    uint32_t *first_of = spec_make(a->lattice_count + 1, sizeof *first_of); // 1 + the first particle of a shelf
    for (uint32_t p = 0; p < n->particle_count; p++) {
        a->part[p] = p;
    }
    for (uint32_t s = 0; s < n->spring_count; s++) {
        a->part[root_of(a, n->springs[s].a)] = root_of(a, n->springs[s].b);
    }
    for (uint32_t p = 0; p < n->particle_count; p++) {
        uint32_t *first = &first_of[a->lattice[p]];
        *first = *first == 0 ? p + 1 : *first;
        if (a->lattice[p] > 0) {
            a->part[root_of(a, p)] = root_of(a, *first - 1);
        }
    }
    free(first_of);
}

// True if a particle has a spring to an irregular one.
static bool is_on_irregular(const spec_arrangement *a, uint32_t p) {
    for (uint32_t i = a->first[p]; i < a->first[p + 1]; i++) {
        if (a->kinds[spec_other_end(a, a->springs[i], p)] == SPEC_LOOSE) {
            return true;
        }
    }
    return false;
}

// A chain is irregular if it hangs on a lattice, unless its part of the network has more chain than lattice. In a
// network with bundles, chains of at most 16 particles are irregular if they hang on others that are.
static void drop_chains(const spec_arrangement *a, bool has_bundles) {
    const spec_network *n = a->network;
    int32_t *balance = spec_make(n->particle_count, sizeof *balance);
    uint8_t *has_lattice = spec_make(n->particle_count, 1), *is_dropped = spec_make(n->particle_count, 1);
    join_parts(a);
    for (uint32_t p = 0; p < n->particle_count; p++) {
        balance[root_of(a, p)] += (a->kinds[p] == SPEC_LATTICE) - (a->kinds[p] == SPEC_CHAIN);
        has_lattice[root_of(a, p)] |= a->kinds[p] == SPEC_LATTICE;
    }
    for (uint32_t p = 0; p < n->particle_count; p++) {
        const uint32_t root = root_of(a, p);
        if (a->kinds[p] == SPEC_CHAIN) { // is_dropped: of the first particle of each chain
            is_dropped[a->column[p]] |= (has_lattice[root] && balance[root] >= 0) ||
                                        (has_bundles && a->row[p] <= 16 && is_on_irregular(a, p));
        }
    }
    for (uint32_t p = 0; p < n->particle_count; p++) {
        a->kinds[p] = a->kinds[p] == SPEC_CHAIN && is_dropped[a->column[p]] ? SPEC_LOOSE : a->kinds[p];
    }
    free(balance);
    free(has_lattice);
    free(is_dropped);
}

static spec_side side_of(int32_t dc, int32_t dr) {
    static const spec_side sides[3][3] = {{SPEC_SOUTH_WEST, SPEC_SOUTH, SPEC_SOUTH_EAST},
                                          {SPEC_WEST, SPEC_SIDES, SPEC_EAST},
                                          {SPEC_NORTH_WEST, SPEC_NORTH, SPEC_NORTH_EAST}};
    return sides[dr + 1][dc + 1];
}

// Blocks of a row of a lattice, as bits.
static uint64_t blocks_of_row(const spec_arrangement *a, uint32_t lattice, int32_t row) {
    uint64_t blocks = 0;
    for (uint32_t p = 0; p < a->network->particle_count; p++) {
        if (a->lattice[p] == lattice && a->row[p] == row) {
            blocks |= (uint64_t)1 << a->column[p] / SPEC_BLOCK;
        }
    }
    // A diagonal spring from the last slot of a block needs more.
    for (uint32_t i = 0; i < a->network->spring_count; i++) {
        const spec_spring *s = &a->network->springs[i];
        if (!spec_joins_cells(a, i) || a->lattice[s->a] != lattice) {
            continue;
        }
        const uint32_t west = a->column[s->a] < a->column[s->b] ? s->a : s->b, east = west == s->a ? s->b : s->a;
        const int32_t column = a->column[west], up = a->row[east] - a->row[west];
        if (a->column[east] == column || column % SPEC_BLOCK != SPEC_BLOCK - 1 || up == 0) {
            continue;
        }
        const uint64_t left = (uint64_t)1 << column / SPEC_BLOCK, right = left << 1;
        if (up < 0) {
            blocks |= a->row[east] == row ? left : 0;
        } else {
            blocks |= a->row[west] == row ? right : 0;
            blocks |= a->row[east] == row ? left : 0;
        }
    }
    return blocks;
}

static void sum_by_rows(const spec_arrangement *a, uint32_t spring, spec_sums *sums) {
    const spec_spring *s = &a->network->springs[spring];
    const uint32_t ends[2] = {s->a, s->b};
    for (int i = 0; i < 2; i++) {
        const uint32_t p = ends[i], q = ends[1 - i];
        spec_side side = SPEC_WEST;
        if (a->kinds[p] == SPEC_LATTICE) {
            side = side_of(a->column[q] - a->column[p], a->row[q] - a->row[p]);
        } else if (sums[p].rows[side] != SPEC_NONE) {
            side = SPEC_EAST; // the order of two does not matter
        }
        sums[p].rows[side] = spring;
    }
}

static spec_plan fill_sums(const spec_arrangement *a, spec_sums *sums, uint32_t *others) {
    const spec_network *n = a->network;
    spec_plan plan = {0};
    uint32_t count = 0;
    uint8_t *is_by_rows = spec_make(n->spring_count, 1);
    for (uint32_t p = 0; p < n->particle_count; p++) {
        sums[p] = (spec_sums){.is_in_rows = a->kinds[p] != SPEC_LOOSE, .is_top = a->kinds[p] == SPEC_CHAIN};
        memset(sums[p].rows, 0xff, sizeof sums[p].rows);
        plan.lattice_particles += a->kinds[p] == SPEC_LATTICE;
        plan.chain_particles += a->kinds[p] == SPEC_CHAIN;
        plan.irregular_particles += a->kinds[p] == SPEC_LOOSE && degree_of(a, p) > 0;
    }
    for (uint32_t s = 0; s < n->spring_count; s++) {
        const bool is_in_chain = a->is_in_chain[s] && a->kinds[n->springs[s].a] == SPEC_CHAIN;
        is_by_rows[s] = is_in_chain || spec_joins_cells(a, s);
        plan.chain_springs += is_in_chain;
        plan.lattice_springs += is_by_rows[s] && !is_in_chain;
        plan.irregular_springs += !is_by_rows[s];
        if (is_by_rows[s]) {
            sum_by_rows(a, s, sums);
        }
    }
    for (uint32_t p = 0; p < n->particle_count; p++) {
        sums[p].first_other = count;
        for (uint32_t i = a->first[p]; i < a->first[p + 1]; i++) {
            if (!is_by_rows[a->springs[i]]) {
                others[count++] = a->springs[i];
            }
        }
        sums[p].other_count = count - sums[p].first_other;
    }
    free(is_by_rows);
    return plan;
}

// A row is a top row if none of its blocks has a block north of it.
static void mark_top_rows(const spec_arrangement *a, spec_sums *sums) {
    for (uint32_t p = 0, last = SPEC_NONE; p < a->network->particle_count; p++) {
        if (a->kinds[p] != SPEC_LATTICE) {
            continue;
        }
        if (last == SPEC_NONE || a->lattice[last] != a->lattice[p] || a->row[last] != a->row[p]) {
            sums[p].is_top =
                (blocks_of_row(a, a->lattice[p], a->row[p]) & blocks_of_row(a, a->lattice[p], a->row[p] + 1)) == 0;
        } else {
            sums[p].is_top = sums[last].is_top;
        }
        last = p;
    }
}

spec_plan spec_arrange(const spec_network *network, const double *x, const double *y, spec_sums *sums,
                       uint32_t *others, bool has_bundles) {
    const size_t particles = network->particle_count, springs = network->spring_count;
    spec_arrangement a = {.network = network,
                          .x = x,
                          .y = y,
                          .first = spec_make(particles + 1, sizeof *a.first),
                          .springs = spec_make(2 * springs, sizeof *a.springs),
                          .kinds = spec_make(particles, sizeof *a.kinds),
                          .is_in_chain = spec_make(springs, 1),
                          .lattice = spec_make(particles, sizeof *a.lattice),
                          .column = spec_make(particles, sizeof *a.column),
                          .row = spec_make(particles, sizeof *a.row),
                          .queue = spec_make(particles, sizeof *a.queue),
                          .part = spec_make(particles, sizeof *a.part)};
    list_springs(&a);
    find_chains(&a);
    spec_find_lattices(&a);
    shelve_lattices(&a);
    drop_chains(&a, has_bundles);
    const spec_plan plan = fill_sums(&a, sums, others);
    mark_top_rows(&a, sums);
    void *const memory[] = {a.first,  a.springs, a.kinds, a.is_in_chain, a.lattice,
                            a.column, a.row,     a.queue, a.part};
    for (size_t i = 0; i < sizeof memory / sizeof memory[0]; i++) {
        free(memory[i]);
    }
    return plan;
}
