/// Finding the components: a union-find over slots, in which most of the work is done on bits.
///
/// In a row, a slot hangs on its left neighbour or starts a run; that takes one pass. Between rows, a link is
/// needed only where no link beside it says the same, and masks of live springs tell that for a whole block at
/// once: in a hull that is whole, one slot of sixteen is left. Roots are the lowest slots, so a component has the
/// same root whatever the order of the links.
#include "store/roots.h"

#include "base/union_find.h"
#include "store/id_pool.h"
#include "store/springs.h"

/// So many changes are looked at one by one, before finding everything anew costs less.
#define FEW_CHANGES 64

static uint32_t lowest_bit(uint32_t bits) {
#if defined(__GNUC__)
    return (uint32_t)__builtin_ctz(bits);
#else
    uint32_t bit = 0;
    while (!(bits >> bit & 1))
        ++bit;
    return bit;
#endif
}

// Let every slot from first on hang on the one before it where the springs to the right, a word of bits for each
// block, say so.
static void join_runs(uint32_t *root, uint32_t first, uint32_t block_count, const uint16_t *to_right,
                      size_t words_per_block) {
    uint32_t slot = first * MSPRINGI_WIDTH, carried = 0;
    for (uint32_t block = 0; block < block_count; ++block) {
        const uint32_t right = to_right[block * words_per_block], joined = right << 1 | carried;
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane, ++slot)
            root[slot] = joined >> lane & 1 ? root[slot - 1] : slot;
        carried = right >> (MSPRINGI_WIDTH - 1);
    }
}

// Join slots of a lattice block with those of the block above it.
static void join_rows(const mspring_network *network, uint32_t *root, uint32_t block) {
    const mspringi_topology *t = &network->topology;
    const uint16_t *live = network->live + (size_t)block * MSPRINGI_DIRECTIONS;
    const uint32_t here = (t->lattice_first + block) * MSPRINGI_WIDTH, up = t->up_of_block[block] * MSPRINGI_WIDTH;
    const uint32_t above = t->up_of_block[block] - t->lattice_first;
    const uint32_t east = live[MSPRINGI_EAST], north = live[MSPRINGI_NORTH];
    const uint32_t east_above = network->live[(size_t)above * MSPRINGI_DIRECTIONS + MSPRINGI_EAST];
    // A link between two rows says nothing new if the one to its left does and both rows hang together there; a
    // diagonal one if a square's side and an upright link go the same way.
    const uint32_t uprights = north & ~((north & east & east_above) << 1);
    const uint32_t known = (north & east_above) | (north >> 1 & east),
                   known_down = (north & east) | (north >> 1 & east_above);
    for (uint32_t bits = uprights; bits; bits &= bits - 1)
        mspringi_union_find_join(root, here + lowest_bit(bits), up + lowest_bit(bits));
    for (uint32_t bits = live[MSPRINGI_NORTH_EAST] & ~known; bits; bits &= bits - 1)
        mspringi_union_find_join(root, here + lowest_bit(bits), up + lowest_bit(bits) + 1);
    for (uint32_t bits = live[MSPRINGI_SOUTH_EAST] & ~known_down; bits; bits &= bits - 1)
        mspringi_union_find_join(root, up + lowest_bit(bits), here + lowest_bit(bits) + 1);
}

void mspringi_find_roots(const mspring_network *network, uint32_t *root) {
    const mspringi_topology *t = &network->topology;
    const uint32_t slots = (uint32_t)mspringi_slot_count(network);
    for (uint32_t slot = 0; slot < slots; ++slot)
        root[slot] = slot;
    join_runs(root, t->lattice_first, t->lattice_blocks, network->live + MSPRINGI_EAST, MSPRINGI_DIRECTIONS);
    join_runs(root, t->chain_first, t->chain_blocks, network->live + t->lattice_spring_slots / MSPRINGI_WIDTH, 1);
    for (uint32_t block = 0; block < t->lattice_blocks; ++block)
        join_rows(network, root, block);
    for (uint32_t i = 0; i < t->irregular_count; ++i) {
        const mspringi_spring_slot spring_slot = t->row_spring_slots + i;
        if (network->live[spring_slot / MSPRINGI_WIDTH] >> spring_slot % MSPRINGI_WIDTH & 1)
            mspringi_union_find_join(root, t->irregular_a[i], t->irregular_b[i]);
    }
    for (uint32_t slot = 0; slot < slots; ++slot)
        root[slot] = root[root[slot]]; // no root is above its slot, so it has its own already
}

/* ----------------------------------------------------------------------------------------------------- changes */

typedef struct pair {
    mspring_id a, b;
} pair;

static pair ends_of(const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_slot_of_spring(t, spring), &base, &tip);
    return (pair){t->particle_of_slot[base], t->particle_of_slot[tip]};
}

static bool are_still_joined(const mspring_network *network, pair ends) {
    mspringi_incident_springs around_a = mspringi_incident_springs_begin(network, ends.a);
    for (mspring_id s; (s = mspringi_incident_springs_next(network, &around_a)) != MSPRING_NONE;) {
        if (!mspringi_spring_is_live(network, s))
            continue;
        const mspring_id between = mspringi_end_beyond(network, s, ends.a);
        if (between == ends.b)
            return true;
        mspringi_incident_springs around_between = mspringi_incident_springs_begin(network, between);
        for (mspring_id r; (r = mspringi_incident_springs_next(network, &around_between)) != MSPRING_NONE;)
            if (mspringi_end_beyond(network, r, between) == ends.b && mspringi_spring_is_live(network, r))
                return true;
    }
    return false;
}

// Restored springs must lie within one component, and the ends of broken ones have a neighbour in common. Then
// every path there was can still be gone.
bool mspringi_links_change_nothing(const mspring_network *network, uint64_t seen, const uint32_t *number,
                                   const uint32_t *index) {
    const mspringi_edits *edits = &network->edits;
    MSPRINGI_ASSERT(network->incidence.first && seen <= edits->links);
    if (edits->links - seen > FEW_CHANGES || !mspringi_edits_have_link(edits, seen))
        return edits->links == seen;
    for (uint64_t n = seen; n < edits->links; ++n) {
        const mspring_id spring = mspringi_edits_link(edits, n);
        const pair ends = ends_of(network, spring);
        const uint32_t a = index ? index[ends.a] : ends.a, b = index ? index[ends.b] : ends.b;
        const bool together = number[a] == number[b];
        if (mspringi_spring_is_live(network, spring) ? !together : together && !are_still_joined(network, ends))
            return false;
    }
    return true;
}
