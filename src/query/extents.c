/// Length, direction and strain of all springs at once.
///
/// Springs are computed in the order of their spring slots, sixteen of a record at a time, into scratch planes
/// indexed by spring slot.
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "store/springs.h"
#include "store/store.h"

/// Result of a pass, in one plane or two.
typedef enum measure { LENGTHS, STRAINS, LENGTHS_AND_STRAINS, DIRECTIONS } measure;

enum { PLANE_COUNT = 2 };

static size_t plane_size(const mspring_network *network) {
    return mspringi_spring_slot_words(&network->topology) * MSPRINGI_WIDTH;
}

// Set the spring's bit in `reversed`: its base is its second end.
static void set_reversed(mspring_network *network, mspring_id spring) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    uint16_t *bits = &network->extents.reversed[spring_slot / MSPRINGI_WIDTH];
    const uint16_t bit = (uint16_t)(1u << spring_slot % MSPRINGI_WIDTH);
    uint32_t base, tip;
    mspringi_topology_ends(&network->topology, spring_slot, &base, &tip);
    *bits = mspringi_spring_ends(network, spring).b == base ? *bits | bit : *bits & (uint16_t)~bit;
}

static mspring_result reserve(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    mspringi_extents *made = &network->extents;
    if (made->reversed)
        return MSPRING_OK;
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_EXTENTS))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to measure %u springs at once",
                             (unsigned)t->spring_count);
    for (mspring_id s = 0; s < t->spring_count; ++s)
        set_reversed(network, s);
    return MSPRING_OK;
}

void mspringi_extents_turn(mspring_network *network, mspring_id spring) {
    if (network->extents.reversed)
        set_reversed(network, spring);
}

/* -------------------------------------------------------------------------------------------------- computation */

// Clear the strain of broken springs. Words without any are common.
static inline void set_strain_of_broken(float *strain, uint32_t live) {
    for (uint32_t lane = 0; live != UINT16_MAX && lane < MSPRINGI_WIDTH; ++lane)
        if (!(live >> lane & 1))
            strain[lane] = 0.0f;
}

static inline void reverse_some(float *along_x, float *along_y, uint32_t reversed) {
    for (uint32_t lane = 0; reversed != 0 && reversed != UINT16_MAX && lane < MSPRINGI_WIDTH; ++lane)
        if (reversed >> lane & 1) {
            along_x[lane] = -along_x[lane] + 0.0f;
            along_y[lane] = -along_y[lane] + 0.0f;
        }
}

// Compute the springs of one word, from the slots from `base` on to those from `tip` on, into the planes. Broken
// ones have no strain; no direction is -0.
static inline void compute_word(const mspring_network *network, size_t word, const float *x, const float *y,
                                size_t base, size_t tip, const float *rest_lengths, measure what) {
    const mspringi_extents *extents = &network->extents;
    const float sign = what == DIRECTIONS && extents->reversed[word] == UINT16_MAX ? -1.0f : 1.0f;
    const size_t at = word * MSPRINGI_WIDTH;
    float first[MSPRINGI_WIDTH],
        second[MSPRINGI_WIDTH]; // not in the planes, which may alias x for the compiler
    for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        const float dx = x[tip + lane] - x[base + lane], dy = y[tip + lane] - y[base + lane];
        const float length = sqrtf(dx * dx + dy * dy);
        if (what == DIRECTIONS) {
            const float divisor = length + (float)(length == 0.0f);
            first[lane] = dx / divisor * sign + 0.0f;
            second[lane] = dy / divisor * sign + 0.0f;
        } else {
            first[lane] = length;
            second[lane] = mspringi_strain_of(length, rest_lengths[lane]);
        }
    }
    if (what == DIRECTIONS)
        reverse_some(first, second, extents->reversed[word]);
    else if (what != LENGTHS)
        set_strain_of_broken(second, network->live[word]);
    if (what != STRAINS)
        memcpy(extents->scratch + at, first, sizeof first);
    if (what != LENGTHS)
        memcpy(extents->scratch + plane_size(network) + at, second, sizeof second);
}

// Compute the springs of the irregular part and the inactive ones, gathered sixteen at a time.
static inline void compute_irregular_springs(const mspring_network *network, measure what) {
    const mspringi_topology *t = &network->topology;
    const uint32_t count = t->irregular_capacity + t->inactive_count;
    const mspringi_state *s = &network->state;
    for (uint32_t first = 0; first < count; first += MSPRINGI_WIDTH) {
        float x[2 * MSPRINGI_WIDTH] = {0}, y[2 * MSPRINGI_WIDTH] = {0}, rest_lengths[MSPRINGI_WIDTH] = {0};
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH && first + lane < count; ++lane) {
            const mspringi_spring_values values =
                mspringi_spring_slot_get(network, t->row_spring_slots + first + lane);
            x[lane] = s->x[values.base];
            y[lane] = s->y[values.base];
            x[MSPRINGI_WIDTH + lane] = s->x[values.tip];
            y[MSPRINGI_WIDTH + lane] = s->y[values.tip];
            rest_lengths[lane] = values.rest_length;
        }
        compute_word(network, (t->row_spring_slots + first) / MSPRINGI_WIDTH, x, y, 0, MSPRINGI_WIDTH, rest_lengths,
                     what);
    }
}

static inline void compute(const mspring_network *network, measure what) {
    const mspringi_topology *t = &network->topology;
    const float *x = network->state.x, *y = network->state.y;
    size_t word, words;
    for (size_t block = 0; block < t->block_count; ++block) {
        if (!mspringi_words_of_block(t, block, &word, &words))
            continue;
        const size_t here = block * MSPRINGI_WIDTH;
        const float *rests = mspringi_row_rest_lengths(network, word);
        compute_word(network, word, x, y, here, here + 1, rests, what); // to the east, or to the next of a chain
        if (words == 1)
            continue;
        const size_t up = (size_t)t->up_of_block[block - t->lattice_first] * MSPRINGI_WIDTH;
        compute_word(network, word + MSPRINGI_NORTH, x, y, here, up, rests + MSPRINGI_NORTH * MSPRINGI_WIDTH, what);
        compute_word(network, word + MSPRINGI_NORTH_EAST, x, y, here, up + 1,
                     rests + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH, what);
        compute_word(network, word + MSPRINGI_SOUTH_EAST, x, y, up, here + 1,
                     rests + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH, what);
    }
    compute_irregular_springs(network, what);
}

/* ---------------------------------------------------------------------------------------------------- results */

// Set the values of removed springs to 0.
static void clear_removed(const mspring_network *network, float *of_spring) {
    const uint8_t *there = network->growth.springs;
    for (mspring_id s = 0; there && s < network->topology.spring_count; ++s)
        of_spring[s] = there[s] == MSPRINGI_THERE ? of_spring[s] : 0.0f;
}

// Copy the two planes to the host; first or second may be NULL.
static void read_out(const mspring_network *network, float *restrict first, float *restrict second) {
    const mspring_id springs = network->topology.spring_count;
    const mspringi_spring_slot *restrict spring_slot = network->topology.slot_of_spring;
    const float *restrict planes[PLANE_COUNT] = {network->extents.scratch,
                                                 network->extents.scratch + plane_size(network)};
    if (first && second)
        for (mspring_id s = 0; s < springs; ++s) {
            first[s] = planes[0][spring_slot[s]];
            second[s] = planes[1][spring_slot[s]];
        }
    else if (first)
        for (mspring_id s = 0; s < springs; ++s)
            first[s] = planes[0][spring_slot[s]];
    else if (second)
        for (mspring_id s = 0; s < springs; ++s)
            second[s] = planes[1][spring_slot[s]];
    if (first)
        clear_removed(network, first);
    if (second)
        clear_removed(network, second);
}

static MSPRINGI_NOINLINE void measure_all(const mspring_network *network, float *length, float *direction_x,
                                          float *direction_y, float *strain) {
    if (length && strain)
        compute(network, LENGTHS_AND_STRAINS);
    else if (length)
        compute(network, LENGTHS);
    else if (strain)
        compute(network, STRAINS);
    read_out(network, length, strain);
    if (direction_x) {
        compute(network, DIRECTIONS);
        read_out(network, direction_x, direction_y);
    }
}

mspring_result mspring_network_get_extents(mspring_network *network, float *length, float *direction_x,
                                           float *direction_y, float *strain) {
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK && !direction_x != !direction_y)
        result =
            mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "one of x and y of the directions is NULL");
    if (result == MSPRING_OK)
        result = reserve(network);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    measure_all(network, length, direction_x, direction_y, strain);
    mspringi_fp_leave(before);
    return MSPRING_OK;
}
