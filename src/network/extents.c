/// Length, direction and strain of all springs at once.
///
/// Springs are computed in the order of their places, sixteen of a record at a time, into a scratch array, from
/// which they are then read in the order of their ids: two loops without branches, the first of which the compiler
/// can vectorise. (Computing spring by spring, or writing each to its id at once, takes four times as long on our
/// ship.)
#include <math.h>

#include "base/cpu.h"
#include "springs.h"

/// Springs whose places are asked for at once.
enum { TOGETHER = 256 };

/// What is computed in one pass.
typedef enum measure { LENGTH, DIRECTION_X, DIRECTION_Y, STRAIN } measure;

// Note whether the base of a spring, which lies in this place, is the end with the higher id.
static void turn(mspring_network *network, mspring_id spring, mspringi_place place) {
    const mspringi_topology *t = &network->topology;
    uint8_t *bits = &network->extents.reversed[spring / 8];
    const uint8_t bit = (uint8_t)(1u << spring % 8);
    uint32_t base, tip;
    mspringi_topology_ends(t, place, &base, &tip);
    *bits = t->particle_of_slot[base] > t->particle_of_slot[tip] ? *bits | bit : *bits & (uint8_t)~bit;
}

static mspring_result reserve(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    mspringi_extents *made = &network->extents;
    if (made->reversed)
        return MSPRING_OK;
    if (!made->scratch)
        made->scratch =
            mspringi_alloc(&network->memory, mspringi_place_words(t) * MSPRINGI_WIDTH, sizeof *made->scratch);
    if (made->scratch)
        made->reversed =
            mspringi_alloc(&network->memory, (size_t)t->reserve.spring_end / 8 + 1, sizeof *made->reversed);
    if (!made->reversed)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to measure %u springs at once",
                             (unsigned)t->spring_count);
    mspringi_place_reader reader;
    mspringi_places_begin(&reader, &t->places, 0);
    for (mspring_id s = 0; s < t->spring_count; ++s)
        turn(network, s, mspringi_places_next(&reader));
    return MSPRING_OK;
}

void mspringi_extents_turn(mspring_network *network, mspring_id spring) {
    if (network->extents.reversed)
        turn(network, spring, mspringi_place_of(&network->topology, spring));
}

// The springs of one word, from the slots base ... on to the slots tip ... on.
static inline void compute_word(const float *x, const float *y, size_t base, size_t tip, const float *rest_lengths,
                                measure what, float *out) {
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        const float dx = x[tip + lane] - x[base + lane], dy = y[tip + lane] - y[base + lane];
        const float length = sqrtf(dx * dx + dy * dy), divisor = length + (float)(length == 0.0f);
        out[lane] = what == LENGTH        ? length
                    : what == DIRECTION_X ? dx / divisor
                    : what == DIRECTION_Y ? dy / divisor
                                          : (length - rest_lengths[lane]) / rest_lengths[lane];
    }
}

// The springs of the web and the parked ones, gathered sixteen at a time.
static inline void compute_leftovers(const mspring_network *network, measure what) {
    const mspringi_topology *t = &network->topology;
    const uint32_t count = t->leftover_capacity + t->parked_count;
    const mspringi_state *s = &network->state;
    for (uint32_t first = 0; first < count; first += MSPRINGI_WIDTH) {
        float x[2 * MSPRINGI_WIDTH] = {0}, y[2 * MSPRINGI_WIDTH] = {0}, rest_lengths[MSPRINGI_WIDTH] = {0};
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH && first + lane < count; ++lane) {
            const mspringi_spring_values values = mspringi_place_get(network, t->chain_places + first + lane);
            x[lane] = s->x[values.base];
            y[lane] = s->y[values.base];
            x[MSPRINGI_WIDTH + lane] = s->x[values.tip];
            y[MSPRINGI_WIDTH + lane] = s->y[values.tip];
            rest_lengths[lane] = values.rest_length;
        }
        compute_word(x, y, 0, MSPRINGI_WIDTH, rest_lengths, what,
                     network->extents.scratch + t->chain_places + first);
    }
}

static inline void compute(const mspring_network *network, measure what) {
    const mspringi_topology *t = &network->topology;
    const float *x = network->state.x, *y = network->state.y;
    const size_t record = (size_t)network->parts * MSPRINGI_WIDTH; // values of a chain block
    float *out = network->extents.scratch;
    for (size_t block = 0; block < t->lattice_blocks; ++block) {
        const size_t here = (t->lattice_first + block) * MSPRINGI_WIDTH;
        const size_t up = (size_t)t->up_of_block[block] * MSPRINGI_WIDTH;
        const float *rest_lengths =
            network->rests.lengths + (size_t)network->rests.of_block[block] * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
        compute_word(x, y, here, here + 1, rest_lengths + MSPRINGI_EAST * MSPRINGI_WIDTH, what, out);
        compute_word(x, y, here, up, rest_lengths + MSPRINGI_NORTH * MSPRINGI_WIDTH, what, out + MSPRINGI_WIDTH);
        compute_word(x, y, here, up + 1, rest_lengths + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH, what,
                     out + 2 * MSPRINGI_WIDTH);
        compute_word(x, y, up, here + 1, rest_lengths + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH, what,
                     out + 3 * MSPRINGI_WIDTH);
        out += MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
    }
    for (size_t block = 0; block < t->chain_blocks; ++block, out += MSPRINGI_WIDTH) {
        const size_t here = (t->chain_first + block) * MSPRINGI_WIDTH;
        compute_word(x, y, here, here + 1, network->chain_springs + block * record, what, out);
    }
    compute_leftovers(network, what);
}

static void read_out(const mspring_network *network, float *to) {
    mspringi_place places[TOGETHER];
    const uint32_t springs = network->topology.spring_count;
    for (mspring_id first = 0; first < springs; first += TOGETHER) {
        const uint32_t count = springs - first < TOGETHER ? springs - first : TOGETHER;
        mspringi_places_read(&network->topology.places, first, count, places);
        for (uint32_t i = 0; i < count; ++i)
            to[first + i] = network->extents.scratch[places[i]];
    }
}

static void read_out_directions(const mspring_network *network, float *to) {
    read_out(network, to);
    for (mspring_id s = 0; s < network->topology.spring_count; ++s) {
        const int reversed = network->extents.reversed[s / 8] >> s % 8 & 1;
        to[s] = to[s] * (float)(1 - 2 * reversed) + 0.0f; // never -0
    }
}

// Broken springs have no strain.
static void clear_broken(const mspring_network *network) {
    const size_t words = mspringi_place_words(&network->topology);
    for (size_t word = 0; word < words; ++word)
        for (uint32_t lane = 0; network->live[word] != UINT16_MAX && lane < MSPRINGI_WIDTH; ++lane)
            if (!(network->live[word] >> lane & 1))
                network->extents.scratch[word * MSPRINGI_WIDTH + lane] = 0.0f;
}

static MSPRINGI_NOINLINE void measure_all(const mspring_network *network, float *length, float *direction_x,
                                          float *direction_y, float *strain) {
    if (length) {
        compute(network, LENGTH);
        read_out(network, length);
    }
    if (direction_x) {
        compute(network, DIRECTION_X);
        read_out_directions(network, direction_x);
        compute(network, DIRECTION_Y);
        read_out_directions(network, direction_y);
    }
    if (strain) {
        compute(network, STRAIN);
        clear_broken(network);
        read_out(network, strain);
    }
}

mspring_result mspring_network_get_extents(mspring_network *network, float *length, float *direction_x,
                                           float *direction_y, float *strain) {
    mspring_result result = mspringi_enter(network);
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
