/// Islands, and the blocks that are swept while some of them sleep.
///
/// Rows are swept by blocks. A block with an awake particle is swept as usual, with its sleeping particles pinned:
/// their active inverse mass is 0. Other blocks are skipped, and whole strips of them unread. No live spring
/// connects a sleeping particle to an awake one, so skipped blocks do not matter.
#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "features/sleep/sleep.h"
#include "store/roots.h"

/* -------------------------------------------------------------------------------------------------- islands */

// Write the number of each slot's island to scratch.
static uint32_t number_islands(mspring_network *network) {
    mspringi_sleep *s = &network->sleep;
    const mspringi_topology *t = &network->topology;
    uint32_t count = 0;
    mspringi_find_roots(network, s->scratch);
    for (uint32_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        if (t->particle_of_slot[slot] == MSPRING_NONE) {
            s->scratch[slot] = MSPRING_NONE;
        } else if (s->scratch[slot] == slot) {
            s->lowest[count] = slot;
            s->scratch[slot] = count++;
        } else {
            s->scratch[slot] = s->scratch[s->scratch[slot]]; // lower, so numbered already
        }
    }
    return count;
}

// Inherit the time at rest: the shortest of the old islands that a new one contains. Sleep counts as the longest.
static void inherit_rest_time(mspring_network *network, uint32_t count) {
    mspringi_sleep *s = &network->sleep;
    for (uint32_t i = 0; i < count; ++i)
        s->kept[i] = s->count > 0 ? INFINITY : 0.0;
    for (size_t slot = 0; s->count > 0 && slot < mspringi_slot_count(network); ++slot) {
        if (s->scratch[slot] == MSPRING_NONE)
            continue;
        const double still = s->still[s->island[slot]];
        double *to = &s->kept[s->scratch[slot]];
        *to = still >= 0.0 && still < *to ? still : *to;
    }
    s->sleeping = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (s->kept[i] == INFINITY)
            s->kept[i] = -1.0;
        s->sleeping += s->kept[i] < 0.0;
    }
    MSPRINGI_ASSERT(s->sleeping <= count);
    double *const before = s->still;
    s->still = s->kept;
    s->kept = before;
    s->has_kept = false;
}

static void assign_block_islands(const mspring_network *network) {
    const mspringi_sleep *s = &network->sleep;
    for (uint32_t block = 0; block < network->topology.block_count; ++block) {
        const uint32_t *island = s->island + (size_t)block * MSPRINGI_WIDTH;
        uint32_t one = MSPRING_NONE;
        bool several = false;
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            several |= island[lane] != MSPRING_NONE && one != MSPRING_NONE && island[lane] != one;
            one = island[lane] != MSPRING_NONE ? island[lane] : one;
        }
        s->block_island[block] = several ? MSPRING_NONE : one;
    }
}

void mspringi_islands_find(mspring_network *network) {
    mspringi_sleep *s = &network->sleep;
    const uint64_t links = network->edits.links;
    if (s->count > 0 &&
        mspringi_links_change_nothing(network, s->links, s->island, network->topology.slot_of_particle)) {
        s->links = links;
        return;
    }
    const uint32_t count = number_islands(network);
    inherit_rest_time(network, count);
    uint32_t *const before = s->island;
    s->island = s->scratch;
    s->scratch = before;
    s->count = count;
    s->links = links;
    assign_block_islands(network);
    if (s->sleeping > 0)
        mspringi_islands_map(network);
}

/* ----------------------------------------------------------------------------------------------------- blocks */

static void map_block(const mspring_network *network, uint32_t block) {
    const mspringi_sleep *s = &network->sleep;
    uint32_t asleep = 0, awake = 0;
    for (uint32_t lane = 0, slot = block * MSPRINGI_WIDTH; lane < MSPRINGI_WIDTH; ++lane, ++slot) {
        const uint32_t island = s->island[slot];
        const bool sleeps = island != MSPRING_NONE && s->still[island] < 0.0;
        asleep |= (uint32_t)sleeps << lane;
        awake |= (uint32_t)(island != MSPRING_NONE && !sleeps) << lane;
        s->active_inverse_mass[slot] = sleeps ? 0.0f : network->inverse_mass[slot];
    }
    s->sleepers[block] = (uint16_t)asleep;
    s->swept[block] = awake != 0;
}

// Also sweep blocks that a swept block's springs pass through, even without particles. A south-east spring has its
// record in the block below its upper end. A north-east spring of a block's last slot carries its force through the
// next block.
static void sweep_spring_blocks(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const uint32_t last_lane = 1u << (MSPRINGI_WIDTH - 1);
    uint8_t *swept = network->sleep.swept;
    for (uint32_t i = 0; i < t->lattice_blocks; ++i) {
        const uint32_t block = t->lattice_first + i, up = t->up_of_block[i];
        const uint16_t *live = network->live + (size_t)i * MSPRINGI_DIRECTIONS;
        if (up != block && swept[up] && live[MSPRINGI_SOUTH_EAST] != 0)
            swept[block] = 1;
        if (swept[block] && i + 1 < t->lattice_blocks && (live[MSPRINGI_NORTH_EAST] & last_lane) != 0)
            swept[block + 1] = 1;
    }
}

// True if the row above takes the carry of this block.
static bool has_swept_carry(const mspring_network *network, uint32_t block) {
    const mspringi_topology *t = &network->topology;
    const uint32_t i = block - t->lattice_first;
    return i >= t->lattice_blocks || network->sleep.swept[t->up_of_block[i]];
}

static void map_span(const mspring_network *network, const mspringi_span *span, bool *all, bool *any) {
    for (uint32_t block = span->first_slot / MSPRINGI_WIDTH; block * MSPRINGI_WIDTH < span->end_slot; ++block) {
        const bool is_swept = network->sleep.swept[block];
        *any |= is_swept;
        *all &= is_swept && has_swept_carry(network, block);
    }
}

static void map_strip(const mspring_network *network, uint32_t number) {
    const mspringi_topology *t = &network->topology;
    const mspringi_strip *strip = &t->strips[number];
    const mspringi_row *first = &t->rows[strip->first_row], *last = first + strip->row_count - 1;
    bool all = true, any = false;
    for (uint32_t i = first->first_span; i < last->first_span + last->span_count; ++i)
        map_span(network, &t->spans[i], &all, &any);
    if (strip->assigned_span != MSPRING_NONE)
        map_span(network, &t->spans[strip->assigned_span], &all, &any);
    network->sleep.share[number] = (uint8_t)(all ? MSPRINGI_AWAKE : any ? MSPRINGI_PARTLY_ASLEEP : MSPRINGI_ASLEEP);
}

void mspringi_islands_map(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    network->sleep.is_mapped = true;
    for (uint32_t block = 0; block < t->block_count; ++block)
        map_block(network, block);
    sweep_spring_blocks(network);
    for (uint32_t strip = 0; strip < t->strip_count; ++strip)
        map_strip(network, strip);
    network->sleep.masses = network->edits.masses;
}

void mspringi_islands_update_masses(mspring_network *network) {
    mspringi_sleep *s = &network->sleep;
    for (size_t block = 0; block < network->topology.block_count; ++block)
        for (size_t slot = block * MSPRINGI_WIDTH; s->swept[block] && slot < (block + 1) * MSPRINGI_WIDTH; ++slot)
            s->active_inverse_mass[slot] =
                mspringi_slot_is_asleep(network, slot) ? 0.0f : network->inverse_mass[slot];
    s->masses = network->edits.masses;
}
