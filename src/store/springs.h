/// @file springs.h
/// Values of springs, wherever they lie: in lattices, chains, the irregular part, or added.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SPRINGS_H
#define MSPRINGI_SPRINGS_H

#include <float.h>

#include "store/fractions.h"
#include "store/selection.h"

/// Values of a spring in force, m, N/m and N s/m, and the slots that it joins.
typedef struct mspringi_spring_values {
    float rest_length, stiffness, damping;
    uint32_t base, tip;
} mspringi_spring_values;
mspringi_spring_values mspringi_spring_slot_get(const mspring_network *network, mspringi_spring_slot spring_slot);
mspringi_spring_values mspringi_spring_get(const mspring_network *network, mspring_id spring);
/// Those of the springs of a selection from the first-th on, in a third of the time of one by one.
void mspringi_springs_get(const mspring_network *network, const mspringi_selection *at, uint32_t first,
                          uint32_t count, mspringi_spring_values *values);
/// Set stiffness and damping in force, wherever the spring has records.
void mspringi_spring_slot_set(mspring_network *network, mspringi_spring_slot spring_slot, float stiffness,
                              float damping);

/// Copy the values of a spring slot into one of another network.
void mspringi_spring_slot_copy(const mspring_network *from, mspringi_spring_slot had, mspring_network *to,
                               mspringi_spring_slot spring_slot);

/// The slots of a spring's ends, in the order in which they were given.
typedef struct mspringi_ends {
    uint32_t a, b;
} mspringi_ends;
mspringi_ends mspringi_spring_ends(const mspring_network *network, mspring_id spring);
/// True if a spring was given with the particle at its tip first.
static inline bool mspringi_spring_is_from_tip(const mspring_network *network, mspring_id spring, uint32_t base,
                                               uint32_t tip) {
    const uint32_t first_spare = network->topology.reserve.first_spring,
                   *of_slot = network->topology.particle_of_slot;
    bool is_reversed = false; // the higher id first
    if (spring >= first_spare) {
        const mspring_id *ends = network->growth.particle_of_end + 2 * (size_t)(spring - first_spare);
        is_reversed = ends[0] > ends[1];
    } else if (network->is_reversed) {
        is_reversed = network->is_reversed[spring / 8] >> spring % 8 & 1;
    }
    return (of_slot[base] > of_slot[tip]) != is_reversed;
}

/// The ramp of the spring in a spring slot, or NULL; and its rest length at the end of its ramp.
const struct mspringi_ramp *mspringi_spring_slot_ramp(const mspring_network *network,
                                                      mspringi_spring_slot spring_slot);
float mspringi_spring_slot_own_length(const mspring_network *network, mspringi_spring_slot spring_slot);
/// The rest length that the host gave, before any flow.
float mspringi_spring_slot_given_length(const mspring_network *network, mspringi_spring_slot spring_slot);

/// 1: the spring only pulls; -1: it only pushes; 0: it does both, as all that are added later.
static inline int mspringi_side_of(const mspring_network *network, mspring_id spring) {
    return network->side && spring < network->topology.reserve.first_spring ? network->side[spring] : 0;
}

/// True if a spring of this side exerts no force. stretch: length minus rest length, m.
static inline bool mspringi_is_slack(int side, double stretch) {
    return (double)side * stretch < 0.0;
}

/// MSPRING_SPRING_PULL_ONLY or _PUSH_ONLY, or 0.
uint32_t mspringi_side_flags(const mspring_network *network, mspring_id spring);
/// These with MSPRING_SPRING_RELATIVE, _METRES, _BROKEN and _STRESSED.
uint32_t mspringi_spring_flags(const mspring_network *network, mspring_id spring);

/// (length - rest_length) / rest_length, now, of a spring that is not broken.
float mspringi_spring_strain(const mspring_network *network, mspring_id spring);

static inline bool mspringi_spring_slot_is_live(const mspring_network *network, mspringi_spring_slot spring_slot) {
    return network->live[spring_slot / MSPRINGI_WIDTH] >> spring_slot % MSPRINGI_WIDTH & 1;
}

static inline bool mspringi_spring_is_live(const mspring_network *network, mspring_id spring) {
    return mspringi_spring_slot_is_live(network, mspringi_slot_of_spring(&network->topology, spring));
}

static inline bool mspringi_spring_slot_is_stressed(const mspring_network *network,
                                                    mspringi_spring_slot spring_slot) {
    const uint16_t *stressed = network->strain.stressed;
    return stressed && stressed[spring_slot / MSPRINGI_WIDTH] >> spring_slot % MSPRINGI_WIDTH & 1;
}

static inline bool mspringi_spring_is_relative(const mspring_network *network, mspring_id spring) {
    return network->fractions.values && mspringi_fractions_of(&network->fractions, spring).stiffness >= 0.0f;
}

/// Mass, kg, and rate, 1/s, from which stiffness and damping of relative springs follow: the reduced mass of the
/// ends, and the inverse of the substep.
static inline double mspringi_reduced_mass(double a, double b) {
    return 1.0 / (1.0 / a + 1.0 / b);
}
static inline double mspringi_relative_rate(const mspring_network *network) {
    return network->relative_h > 0.0f ? 1.0 / (double)network->relative_h : 0.0;
}
/// At most FLT_MAX: great masses over short substeps would give infinity.
static inline float mspringi_derived_stiffness(float fraction, double reduced_mass, double rate) {
    const double stiffness = (double)fraction * reduced_mass * rate * rate;
    return stiffness < (double)FLT_MAX ? (float)stiffness : FLT_MAX;
}
static inline float mspringi_derived_damping(float fraction, double reduced_mass, double rate) {
    const double damping = (double)fraction * reduced_mass * rate;
    return damping < (double)FLT_MAX ? (float)damping : FLT_MAX;
}

/// Stiffness and damping of the spring in this spring slot as if it were not broken; fractions if it is relative.
mspringi_relative mspringi_spring_get_nominal(const mspring_network *network, mspring_id spring,
                                              mspringi_spring_slot spring_slot);
/// Set these. Values of a relative spring that change need mspringi_fractions_separate() before. A broken spring
/// still exerts nothing.
void mspringi_spring_set_nominal(mspring_network *network, mspring_id spring, mspringi_spring_slot spring_slot,
                                 mspringi_relative nominal);

/// Write the values of a spring in force, as nobody has read any yet: without notice, and without
/// mspringi_shared_records_unshare().
void mspringi_spring_slot_fill(mspring_network *network, mspringi_spring_slot spring_slot, float rest_length,
                               mspringi_relative nominal);

/// Note each rest length that is written, for network->shortest_set and has_welds.
void mspringi_note_rest_length(mspring_network *network, float rest_length);

/// Set the rest length in force; a ramp of the spring continues from its own. A value that changes needs
/// mspringi_rest_lengths_unshare() before.
void mspringi_spring_slot_set_rest_length(mspring_network *network, mspringi_spring_slot spring_slot,
                                          float rest_length);
/// Set the rest length that the host gives. In force is that times 1 + the plastic strain, which stays.
void mspringi_spring_slot_give_length(mspring_network *network, mspringi_spring_slot spring_slot, float length);

/// Derive stiffness and damping of the relative springs for a substep of h. h = 0 makes both 0, as before the first
/// step.
void mspringi_derive_relative(mspring_network *network, float h);
/// Derive them again, with other masses.
void mspringi_renew_relative(mspring_network *network);
/// Those of a particle; its lists of springs are there (mspringi_incidence_reserve()). Return how many springs it
/// has.
uint32_t mspringi_renew_relative_around(mspring_network *network, mspring_id particle);

/// Values of a spring outside lattices and chains: as mspringi_spring_slot_get(), without a search for its record.
static inline mspringi_spring_values mspringi_irregular_spring(const mspring_network *network, uint32_t irregular) {
    const mspringi_topology *t = &network->topology;
    const uint32_t at = t->irregular.entry[2 * (size_t)irregular], parts = network->parts;
    const float *record =
        network->irregular_springs + (size_t)(at / MSPRINGI_WIDTH) * MSPRINGI_WIDTH * parts + at % MSPRINGI_WIDTH;
    return (mspringi_spring_values){.base = t->irregular_a[irregular],
                                    .tip = t->irregular_b[irregular],
                                    .rest_length = record[MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH],
                                    .stiffness = record[MSPRINGI_STIFFNESS * MSPRINGI_WIDTH],
                                    .damping = parts > MSPRINGI_DAMPING ? record[MSPRINGI_DAMPING * MSPRINGI_WIDTH]
                                                                        : 0.0f};
}

/// Rest lengths of a word of spring slots in a row, sixteen side by side; those of a lattice block follow each
/// other.
static inline const float *mspringi_row_rest_lengths(const mspring_network *network, size_t word) {
    const size_t lattice_words = network->topology.lattice_spring_slots / MSPRINGI_WIDTH;
    return word < lattice_words
               ? network->rest_lengths.lengths +
                     ((size_t)network->rest_lengths.of_block[word / MSPRINGI_DIRECTIONS] * MSPRINGI_DIRECTIONS +
                      word % MSPRINGI_DIRECTIONS) *
                         MSPRINGI_WIDTH
               : network->chain_springs +
                     ((word - lattice_words) * network->parts + MSPRINGI_REST_LENGTH) * MSPRINGI_WIDTH;
}

#endif
