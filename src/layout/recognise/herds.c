/// Small trees of one shape side by side, sixteen to a herd.
///
/// What is left of a shattered hull are thousands of pairs, threes and other trees of a few particles. As strands
/// and web each spring of theirs is swept with lanes that hold none, or at both its ends, from memory that is read
/// anew in each substep. Sixteen trees of one shape, a lane each, need none of that: the particles that have the
/// same place in it fill a group of the web, so a spring of the shape is one of whole vectors, computed once, and a
/// herd knows nothing of the others, so it can take all substeps while it is in the first-level cache. (Our ship
/// with one spring of ten left anywhere: 12,064 of the 15,668 stand in 437 herds. Of the rest, 184 components are
/// no trees, and of 66 trees of eight particles no sixteen have the same shape; nor have larger ones.)
///
/// Herds are made when a network is compacted (network/left.c). They pay where most springs have broken. Shares of
/// a step of a whole lattice of 200 x 200, with one spring of ten left anywhere: 38 %, without herds 51; with two
/// of ten: 118 and 133; with more there is no difference. A minute of the example game takes 2 to 7 % less.
///
/// Trees are compared by a code of brackets, one pair for each particle, around those of the subtrees below it in
/// rising order: two trees have the same shape if they have the same code, from the root from which it is least
/// (Aho, Hopcroft and Ullman 1974).
#include <string.h>

#include "layout/analysis.h"

/// Particles in herds from which they are worth it: fewer take a microsecond or two in a substep.
#define FEWEST_IN_HERDS 512

/// What is known of a particle.
enum { UNKNOWN, IN_TREE, IN_OTHER };

/// A connected component as far as it has been looked at.
typedef struct tree {
    uint32_t particles[MSPRINGI_LARGEST_TREE];
    uint32_t joined[MSPRINGI_LARGEST_TREE]; ///< to which of these, a bit each
    uint32_t count, springs;
} tree;

/// Springs of one of its particles.
#define MOST_SPRINGS (MSPRINGI_LARGEST_TREE - 1)

/* ------------------------------------------------------------------------------------------------- components */

static uint32_t degree_of(const mspringi_graph *graph, uint32_t particle) {
    return graph->first[particle + 1] - graph->first[particle];
}

// The number of a particle in a tree; count if it is not there.
static uint32_t number_in(const tree *t, uint32_t particle) {
    uint32_t i = 0;
    while (i < t->count && t->particles[i] != particle)
        ++i;
    return i;
}

// Go from a particle to all that it is joined with, unless those are too many, or known to belong to such. Returns
// whether they are a tree.
static bool explore(const mspringi_graph *graph, const uint8_t *known, uint32_t start, tree *t) {
    *t = (tree){.particles = {start}, .count = 1};
    for (uint32_t at = 0; at < t->count; ++at) {
        const uint32_t p = t->particles[at];
        if (degree_of(graph, p) > MOST_SPRINGS)
            return false;
        for (uint32_t i = graph->first[p]; i < graph->first[p + 1]; ++i) {
            const uint32_t other = mspringi_other_end(&graph->builder->springs[graph->springs[i]], p);
            const uint32_t number = number_in(t, other);
            if (number == t->count && (known[other] == IN_OTHER || t->count == MSPRINGI_LARGEST_TREE))
                return false;
            t->particles[number] = other;
            t->count += number == t->count;
            t->joined[at] |= 1u << number;
            t->springs++;
        }
    }
    return t->springs == 2 * (t->count - 1);
}

/* ------------------------------------------------------------------------------------------------------ shapes */

// Bits of a code, which begins with a one.
static uint32_t bits_of(uint32_t code) {
    uint32_t bits = 0;
    while (code >> bits)
        ++bits;
    return bits;
}

static uint32_t code_of(const tree *t, uint32_t node, uint32_t from);

// List the nodes below one, by rising code, with their codes. Returns how many there are.
static uint32_t list_below(const tree *t, uint32_t node, uint32_t from, uint32_t *below, uint32_t *codes) {
    uint32_t count = 0;
    for (uint32_t other = 0; other < t->count; ++other) {
        if (other == from || !(t->joined[node] >> other & 1))
            continue;
        const uint32_t code = code_of(t, other, node);
        uint32_t i = count++;
        for (; i > 0 && codes[i - 1] > code; --i) {
            codes[i] = codes[i - 1];
            below[i] = below[i - 1];
        }
        codes[i] = code;
        below[i] = other;
    }
    return count;
}

static uint32_t code_of(const tree *t, uint32_t node, uint32_t from) {
    uint32_t below[MOST_SPRINGS], codes[MOST_SPRINGS], code = 1;
    const uint32_t count = list_below(t, node, from, below, codes);
    for (uint32_t i = 0; i < count; ++i)
        code = code << bits_of(codes[i]) | codes[i];
    return code << 1;
}

// The least code of a tree, and the root it has it from.
static uint32_t shape_of(const tree *t, uint32_t *root) {
    uint32_t least = UINT32_MAX;
    for (uint32_t node = 0; node < t->count; ++node) {
        const uint32_t code = code_of(t, node, MSPRING_NONE);
        *root = code < least ? node : *root;
        least = code < least ? code : least;
    }
    return least;
}

// Append particles in the order of the brackets that they open.
static uint32_t *append_in_order(const tree *t, uint32_t node, uint32_t from, uint32_t *to) {
    uint32_t below[MOST_SPRINGS], codes[MOST_SPRINGS];
    const uint32_t count = list_below(t, node, from, below, codes);
    *to++ = t->particles[node];
    for (uint32_t i = 0; i < count; ++i)
        to = append_in_order(t, below[i], node, to);
    return to;
}

// The rung, among those of the node above, that each node of a shape has.
static void list_rungs(uint32_t code, uint8_t *rung_above) {
    uint32_t above[MSPRINGI_LARGEST_TREE] = {0}, rungs[MSPRINGI_LARGEST_TREE] = {0}, depth = 0, node = 0;
    for (uint32_t bit = bits_of(code); bit-- > 0;) {
        if (!(code >> bit & 1)) {
            --depth;
            continue;
        }
        rung_above[node] = (uint8_t)(depth > 0 ? rungs[above[depth - 1]]++ : MSPRINGI_ROOT);
        rungs[node] = depth > 0; // the first is the one to the node above
        above[depth++] = node++;
    }
}

/* ------------------------------------------------------------------------------------------------------ passes */

mspring_result mspringi_herds_begin(mspringi_herds *herds, const mspringi_graph *graph, mspringi_memory *memory,
                                    mspringi_message *message) {
    herds->known = mspringi_alloc(memory, graph->builder->particle_count, sizeof *herds->known);
    return herds->known
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to look for trees in %zu particles",
                               graph->builder->particle_count);
}

void mspringi_herds_explore(mspringi_herds *herds, const mspringi_graph *graph, uint32_t first, uint32_t end) {
    for (uint32_t p = first; p < end; ++p) {
        if (herds->known[p] != UNKNOWN || degree_of(graph, p) == 0)
            continue;
        tree found;
        const bool is_tree = explore(graph, herds->known, p, &found);
        for (uint32_t i = 0; i < found.count; ++i)
            herds->known[found.particles[i]] = is_tree ? IN_TREE : IN_OTHER;
        herds->tree_count += is_tree;
        herds->tree_particles += is_tree ? found.count : 0;
    }
}

mspring_result mspringi_herds_reserve(mspringi_herds *herds, mspringi_memory *memory, mspringi_message *message) {
    if (herds->tree_particles < FEWEST_IN_HERDS)
        return MSPRING_OK;
    herds->in_order = mspringi_alloc(memory, herds->tree_particles, sizeof *herds->in_order);
    herds->keys = mspringi_alloc(memory, herds->tree_count, sizeof *herds->keys);
    herds->scratch = mspringi_alloc(memory, herds->tree_count, sizeof *herds->scratch);
    return herds->in_order && herds->keys && herds->scratch
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for %u trees",
                               (unsigned)herds->tree_count);
}

// Take the trees' codes, and their particles in order. The first of a tree to be met comes first in it.
void mspringi_herds_compare(mspringi_herds *herds, const mspringi_graph *graph, uint32_t first, uint32_t end) {
    for (uint32_t p = first; herds->in_order && p < end; ++p) {
        if (herds->known[p] != IN_TREE)
            continue;
        tree found;
        uint32_t root = 0;
        (void)explore(graph, herds->known, p, &found);
        const uint32_t code = shape_of(&found, &root);
        herds->keys[herds->listed++] = (uint64_t)code << 32 | herds->listed_particles;
        (void)append_in_order(&found, root, MSPRING_NONE, herds->in_order + herds->listed_particles);
        herds->listed_particles += found.count;
        for (uint32_t i = 0; i < found.count; ++i)
            herds->known[found.particles[i]] = UNKNOWN;
    }
}

static uint32_t code_of_key(uint64_t key) {
    return (uint32_t)(key >> 32);
}

// Whether a whole herd begins with this tree.
static bool is_herd(const mspringi_herds *herds, uint32_t first) {
    return first + MSPRINGI_WIDTH <= herds->tree_count &&
           code_of_key(herds->keys[first]) == code_of_key(herds->keys[first + MSPRINGI_WIDTH - 1]);
}

static void count_groups(mspringi_herds *herds) {
    for (uint32_t first = 0; first < herds->tree_count;) {
        const bool is_whole = is_herd(herds, first);
        herds->group_count += is_whole ? bits_of(code_of_key(herds->keys[first])) / 2 : 0;
        first += is_whole ? MSPRINGI_WIDTH : 1;
    }
    if (herds->group_count * MSPRINGI_WIDTH < FEWEST_IN_HERDS)
        herds->group_count = 0;
}

static void stand(mspringi_herds *herds, uint32_t first, uint32_t group, uint32_t size, uint8_t *kinds) {
    for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        const uint32_t *members = herds->in_order + (uint32_t)herds->keys[first + lane];
        for (uint32_t node = 0; node < size; ++node) {
            herds->particles[(group + node) * MSPRINGI_WIDTH + lane] = members[node];
            kinds[members[node]] = MSPRINGI_ROW_WEB;
        }
    }
}

static void stand_all(mspringi_herds *herds, uint8_t *kinds) {
    for (uint32_t first = 0, filled = 0; filled < herds->group_count;) {
        const uint32_t code = code_of_key(herds->keys[first]), size = bits_of(code) / 2;
        if (!is_herd(herds, first)) {
            ++first;
            continue;
        }
        list_rungs(code, herds->rung_above + filled);
        stand(herds, first, filled, size, kinds);
        herds->spring_count += size - 1;
        filled += size;
        first += MSPRINGI_WIDTH;
    }
}

mspring_result mspringi_herds_fill(mspringi_herds *herds, uint8_t *kinds, mspringi_memory *memory,
                                   mspringi_message *message) {
    if (herds->in_order) {
        mspringi_sort_keys(herds->keys, herds->scratch, herds->tree_count);
        count_groups(herds);
    }
    const size_t particles = (size_t)herds->group_count * MSPRINGI_WIDTH;
    herds->particles = mspringi_alloc(memory, particles, sizeof *herds->particles);
    herds->rung_above = mspringi_alloc(memory, herds->group_count, sizeof *herds->rung_above);
    if (!herds->particles || !herds->rung_above)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for herds of %zu particles", particles);
    stand_all(herds, kinds);
    mspringi_herds_forget(herds, memory);
    return MSPRING_OK;
}

void mspringi_herds_forget(mspringi_herds *herds, mspringi_memory *memory) {
    mspringi_free(memory, herds->known);
    mspringi_free(memory, herds->in_order);
    mspringi_free(memory, herds->keys);
    mspringi_free(memory, herds->scratch);
    herds->known = NULL;
    herds->in_order = NULL;
    herds->keys = herds->scratch = NULL;
}

void mspringi_herds_destroy(mspringi_herds *herds, mspringi_memory *memory) {
    mspringi_herds_forget(herds, memory);
    mspringi_free(memory, herds->particles);
    mspringi_free(memory, herds->rung_above);
}
