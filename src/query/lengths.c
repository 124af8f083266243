/// Lengths, directions and strains of springs.
///
/// Ends are gathered for LANES springs at a time. Then all of these take one root and one division each, which
/// compilers vectorise.
#include <math.h>

#include "query/measure.h"
#include "store/rest_lengths.h"
#include "store/springs.h"

enum { LANES = 32 };

/// Values gathered of some springs.
typedef struct batch {
    float dx[LANES], dy[LANES]; ///< from base to tip, m
    float rest[LANES];          ///< m
    float sign[LANES];          ///< -1 where the base is the second end, 0 where there is no spring
    float live[LANES];          ///< 1 or 0
} batch;

// Difference of two coordinates. Those of low words are small between neighbours, so single precision suffices.
static inline float difference(const float *x, const float *low, uint32_t base, uint32_t tip, bool may_be_stale,
                               float grid) {
    const float low_tip = may_be_stale ? mspringi_low_of(x[tip], low[tip], grid) : low[tip];
    const float low_base = may_be_stale ? mspringi_low_of(x[base], low[base], grid) : low[base];
    return (x[tip] - x[base]) + (low_tip - low_base);
}

static inline void gather(const mspring_network *network, const mspringi_selection *at, uint32_t first,
                          uint32_t count, bool may_be_stale, bool has_direction, batch *to) {
    const mspringi_topology *t = &network->topology;
    const mspringi_state s = network->state;
    const mspringi_rest_lengths rests = network->rest_lengths;
    const uint16_t *live = network->live;
    for (uint32_t i = 0; i < count; ++i) {
        const mspring_id spring = mspringi_selected(at, first + i);
        const mspringi_spring_slot spring_slot = t->slot_of_spring[spring];
        uint32_t base, tip;
        if (spring_slot < t->lattice_spring_slots) {
            mspringi_lattice_ends(t, spring_slot, &base, &tip);
            to->rest[i] = *mspringi_rest_lengths_at(&rests, spring_slot);
        } else {
            const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
            base = values.base;
            tip = values.tip;
            to->rest[i] = values.rest_length;
        }
        to->dx[i] = difference(s.x, s.low_x, base, tip, may_be_stale, s.grid);
        to->dy[i] = difference(s.y, s.low_y, base, tip, may_be_stale, s.grid);
        to->live[i] = (float)(live[spring_slot / MSPRINGI_WIDTH] >> spring_slot % MSPRINGI_WIDTH & 1);
        to->sign[i] = has_direction && mspringi_spring_is_from_tip(network, spring, base, tip) ? -1.0f : 1.0f;
    }
}

// Removed springs have 0 everywhere.
static void clear_removed(const mspring_network *network, const mspringi_selection *at, uint32_t first,
                          uint32_t count, batch *of) {
    for (uint32_t i = 0; network->growth.springs && i < count; ++i)
        if (!mspringi_spring_exists(network, mspringi_selected(at, first + i)))
            of->dx[i] = of->dy[i] = of->live[i] = 0.0f;
}

static inline void put_column(float *values, uint32_t stride, uint32_t first, const float *from, uint32_t count) {
    float *to = values + (size_t)first * stride;
    if (stride == 1)
        memcpy(to, from, count * sizeof *to);
    else
        for (uint32_t i = 0; i < count; ++i)
            to[(size_t)i * stride] = from[i];
}

static inline void measure(const mspring_network *network, const mspringi_selection *at, bool may_be_stale,
                           const mspringi_lengths *to) {
    const bool has_direction = to->direction_x || to->direction_y;
    batch b = {.rest = {0}};
    float length[LANES], along_x[LANES], along_y[LANES], strain[LANES];
    for (uint32_t first = 0; first < at->count; first += LANES) {
        const uint32_t left = at->count - first, count = left < LANES ? left : LANES;
        gather(network, at, first, count, may_be_stale, has_direction, &b);
        clear_removed(network, at, first, count, &b);
        for (int i = 0; i < LANES; ++i)
            length[i] = sqrtf(b.dx[i] * b.dx[i] + b.dy[i] * b.dy[i]);
        if (to->length)
            put_column(to->length, to->length_stride, first, length, count);
        if (has_direction) {
            for (int i = 0; i < LANES; ++i) {
                const float inverse = b.sign[i] / (length[i] + (float)(length[i] == 0.0f));
                along_x[i] = b.dx[i] * inverse + 0.0f; // no -0
                along_y[i] = b.dy[i] * inverse + 0.0f;
            }
            if (to->direction_x)
                put_column(to->direction_x, to->direction_x_stride, first, along_x, count);
            if (to->direction_y)
                put_column(to->direction_y, to->direction_y_stride, first, along_y, count);
        }
        if (to->strain) {
            for (int i = 0; i < LANES; ++i)
                strain[i] = b.live[i] > 0.0f ? mspringi_strain_of(length[i], b.rest[i]) : 0.0f;
            put_column(to->strain, to->strain_stride, first, strain, count);
        }
    }
}

void mspringi_measure(const mspring_network *network, const mspringi_selection *at, const mspringi_lengths *to) {
    if (network->is_open)
        measure(network, at, true, to);
    else
        measure(network, at, false, to);
}
