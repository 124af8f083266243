/// @file kernels.h
/// The inner loops, one table of them per instruction set.
///
/// Every table computes the same values by the same operations in the same order, so all give the same bits; the
/// scalar one is the definition. No table uses fused multiply-add or an approximate reciprocal.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_KERNELS_H
#define MSPRINGI_KERNELS_H

#include "base/target.h"
#include "kernels/shared_records.h"
#include "kernels/system.h"
#include "kernels/yield_law.h"
#include "layout/topology.h"

/// Squared length, m^2, up to which a spring has no direction, and so no force: above, its inverse is finite.
#define MSPRINGI_NO_DIRECTION 1e-37f

/// What a sweep has to do, bits of these. Where they are known to a compiler, a kernel's code is for them alone.
typedef uint32_t mspringi_variant;
enum {
    MSPRINGI_DAMPED = 1u << 0,  ///< springs have damping
    MSPRINGI_FORCED = 1u << 1,  ///< there are forces from outside
    MSPRINGI_PRECISE = 1u << 2, ///< low words count in the lengths of springs
    MSPRINGI_CELLS = 1u << 3,   ///< lattice cells keep their area
    MSPRINGI_TESTED = 1u << 4   ///< springs that yield are looked for
};

/// The parts of a spring record, each one value per slot; damping only if the network has any.
typedef enum mspringi_part { MSPRINGI_REST_LENGTH = 0, MSPRINGI_STIFFNESS = 1, MSPRINGI_DAMPING = 2 } mspringi_part;

/// Of each lane the largest absolute coordinate, speed and change of a velocity of the slots that have been moved,
/// as mspringi_largest has them.
typedef struct mspringi_extrema_lanes {
    float coordinate[MSPRINGI_WIDTH], speed[MSPRINGI_WIDTH], change[MSPRINGI_WIDTH];
} mspringi_extrema_lanes;

/// The same of all lanes.
typedef struct mspringi_extrema {
    float coordinate, speed, change;
} mspringi_extrema;
typedef mspringi_extrema (*mspringi_extrema_fn)(const mspringi_extrema_lanes *watch);

/// Substeps from one look for warm springs to the next, counted from the first of a step.
#define MSPRINGI_YIELD_PERIOD 4u

/// What a strip was found to be: a spring is near to what it yields at, one has been in this step, one has flowed.
enum { MSPRINGI_WARM = 1, MSPRINGI_WAS_WARM = 2, MSPRINGI_HAS_FLOWED = 4 };

/// What a tested sweep looks at, and writes to, by place. Bounds are squares of lengths.
typedef struct mspringi_yield_test {
    bool looks;                        ///< for springs that are warm; else for those that flow
    bool maps;                         ///< what flows gets another rest length
    const float *test_low, *test_high; ///< what is not between these is looked at closer
    float *low, *high, *flow_low, *flow_high;
    const float *nominal, *yield_strain, *hardening, *plastic_limit, *gain; ///< see yield_law.h
    float *lattice_rests;                                                   ///< [lattice places]
    float *chain_springs;                                                   ///< records: [block][part][lane]
    const uint16_t *live;                                                   ///< [places / MSPRINGI_WIDTH] bits
    size_t first_chain_slot;                                                ///< first place of a chain
    mspringi_shared_records shared_records; ///< blocks with the same rest lengths and bounds
    uint32_t block_count;
    float *heat;          ///< what flow has dissipated in the step, J
    float *before;        ///< rest lengths before the step of those that have flowed in it
    uint16_t *has_flowed; ///< [places / MSPRINGI_WIDTH] bits
    uint8_t *warmth;      ///< of the strip: MSPRINGI_WARM, ...
} mspringi_yield_test;

/// Note which springs of a word are warm.
static inline void mspringi_yield_note(const mspringi_yield_test *test, size_t word, uint32_t warm) {
    if (test->looks && warm & test->live[word])
        *test->warmth |= MSPRINGI_WARM | MSPRINGI_WAS_WARM;
}

// Rest lengths and bounds of a word are about to change.
static inline void mspringi_yield_part(const mspringi_yield_test *test, size_t word) {
    const uint32_t block = (uint32_t)(word / MSPRINGI_DIRECTIONS);
    mspringi_shared_records shared = test->shared_records;
    if (word * MSPRINGI_WIDTH < test->first_chain_slot &&
        (shared.of_block[block] != block || shared.readers[block] > 0))
        mspringi_shared_records_unshare_block(&shared, block, test->block_count);
}

/// Keep the rest lengths of springs of a word that flow, if they have not in this step.
static inline void mspringi_yield_keep(const mspringi_yield_test *test, size_t word, uint32_t flow,
                                       const float *rests) {
    mspringi_yield_part(test, word);
    uint32_t left = flow & ~(uint32_t)test->has_flowed[word];
    test->has_flowed[word] |= (uint16_t)flow;
    *test->warmth |= MSPRINGI_HAS_FLOWED;
    for (uint32_t lane = 0; left; left >>= 1, ++lane)
        if (left & 1)
            test->before[word * MSPRINGI_WIDTH + lane] = rests[lane];
}

/// What a sweep works on: arrays by slot, and what is the same for all of them.
typedef struct mspringi_sweep {
    float *x, *y, *vx, *vy;
    float *low_x, *low_y; ///< what positions have beyond single precision
    const float *inverse_mass;
    const float *force_x, *force_y;   ///< forces from outside, or NULL; read by the kernels with forces only
    float *carry_x, *carry_y;         ///< forces that the row below exerts, by column
    const float *lattice_springs;     ///< records: [direction][part after the rest length][lane]
    const uint32_t *springs_of_block; ///< [block] which of these it has
    const float *rest_lengths;        ///< of lattice springs: [block of rest lengths][direction][lane]
    const uint32_t *rests_of_block;   ///< [block] which of these it has
    const float *cells; ///< [block][2][lane] half the force of an area per distance at area 0, and by how much it
                        ///< falls with the cross product of the diagonals; 0 where no cell is; read with areas only
    const float *chain_springs; ///< records: [block][part][lane]
    const mspringi_sell *irregular;
    const float *irregular_springs; ///< records: [slice column][part][lane]
    const float *gathered; ///< [node][4] x, y, vx, vy of the irregular part's nodes at the start of the substep; of
                           ///< precise kernels x, y, low_x, low_y and, with damping, at
                           ///< mspringi_gathered_half() vx and vy, with something behind
    uint32_t parts;        ///< parts in a record: 2 or, with damping, 3
    float h;               ///< substep, s
    float decay;           ///< what global damping leaves of a velocity
    float gravity_h_x, gravity_h_y; ///< gravity times h
    float *keep; ///< [6][slots] where the state goes that is found, as x, y, vx, vy, low_x, low_y lie; or NULL
    mspringi_extrema_lanes *watch; ///< what is seen of the state that is made, or NULL
    const float *before; ///< vx of before the step, vy behind, to watch changes by, which is where keep has them
                         ///< put if there is both; or NULL
    bool watches_coordinate, watches_speed; ///< whether coordinates and speeds are watched
    const mspringi_yield_test *test;        ///< read by the kernels that test only
} mspringi_sweep;

/// Floats that four values of each of an irregular part's nodes take.
static inline size_t mspringi_gathered_half(const mspringi_sell *irregular) {
    return (size_t)4 * irregular->slice_count * MSPRINGI_WIDTH;
}

/// Compute the forces of the springs of one or more rows and move their particles, in place. In lattice rows and
/// chains, forces from the row below are taken from the carry row, and those on the row above left there (0 where
/// there is none).
///
/// What the last spring of a span hands on is handed to the next span, whether or not that lies next to it: where
/// it does not, there is no such spring, and the force is 0.
typedef void (*mspringi_row_fn)(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count);

/// What becomes of a particle that no spring pulls at in n substeps, each of which adds the same change c to its
/// velocity v, leaves a part d of the sum, and moves it by that times h:
///     v_n = keep v + gain c,   x_n = x + (reach v + fall c)
/// with keep = d^n, gain = d + d^2 + ... + d^n, reach = h gain and fall = h times the sum of the gains of 1 to n. A
/// pinned one keeps its velocity and moves by drift v, with drift = h n.
typedef struct mspringi_free_motion {
    float keep, gain, reach, fall, drift;
} mspringi_free_motion;

/// Move the particles of a span that have no springs, all substeps of a glide at once.
typedef void (*mspringi_loose_fn)(const mspringi_sweep *sweep, const mspringi_span *span,
                                  const mspringi_free_motion *glide);

/// Copy position and velocity of block_count blocks of slots behind one another into packed.
typedef void (*mspringi_pack_fn)(const mspringi_sweep *sweep, size_t first_block, size_t block_count,
                                 float *gathered);

/// Compute the forces of the irregular part on the attached nodes first (a multiple of MSPRINGI_WIDTH) to first +
/// count - 1, and perhaps on some more of the last one's group, into x and y by number of the attached node.
typedef void (*mspringi_attached_fn)(const mspringi_sweep *sweep, uint32_t first, uint32_t count, float *x,
                                     float *y);

/// Of count values (a multiple of MSPRINGI_WIDTH) the largest absolute one and, if before is not NULL, the largest
/// absolute change. NaN, if there is one, counts as the largest.
typedef struct mspringi_largest {
    float value, change;
} mspringi_largest;
typedef mspringi_largest (*mspringi_largest_fn)(const float *now, const float *before, size_t count);

/// A box.
typedef struct mspringi_bounds {
    float min_x, max_x, min_y, max_y;
} mspringi_bounds;

/// Find the first block of slots from first to end (multiples of MSPRINGI_WIDTH) of which a slot lies outside a
/// box.
/// @return its first slot, or end if there is none
typedef size_t (*mspringi_beyond_fn)(const float *x, const float *y, size_t first, size_t end,
                                     const mspringi_bounds *bounds);

/// The border of a half-plane. The distance from it is n . p + offset, > 0 where particles may be.
typedef struct mspringi_line {
    double nx, ny, offset; ///< n of length 1, offset for local coordinates
    double friction, restitution;
} mspringi_line;

/// A floor, and the particles that it acts on, by slot.
typedef struct mspringi_floor_args {
    const mspringi_line *lines;
    uint32_t line_count;
    uint32_t height_count; ///< 0: there are none
    const float *heights;
    const double *normals;        ///< as in mspringi_heights
    double left, bottom, spacing; ///< likewise, local
    const float *frictions,
        *restitutions; ///< [height_count - 1] of each straight part; NULL: all have the next two
    double friction, restitution;
    double h;              ///< of the substep, s
    double per_length;     ///< 4 h over the shortest spring's length, s/m
    mspringi_bounds clear; ///< particles in here are left alone
    float *x, *y, *vx, *vy;
    const float *from_vx, *from_vy; ///< before the substep
    float *low_x, *low_y;
    float *before_vx, *before_vy; ///< from_vx and from_vy; NULL if these are vx and vy
    double silt_depth, silt_rate;
    double undamped; ///< times a velocity: what it would be without global damping in the substep
    float *impulse_x, *impulse_y;
    const float *inverse_mass, *active_inverse_mass;
} mspringi_floor_args;

/// Let a floor act on the particles of the block of slots that begins with slot, after a substep of symplectic
/// Euler: on those with springs, or on those without.
/// @return a bit for each that nothing has been done to, as it has come from one straight part of the heights to
///         another or is in a corner: mspringi_floor_bounce() and mspringi_floor_move_free_particle() are for them
typedef uint32_t (*mspringi_floor_fn)(const mspringi_floor_args *args, size_t slot);

/// Let silt brake the particles of that block, before a floor acts on them.
typedef void (*mspringi_silt_fn)(const mspringi_floor_args *args, size_t slot);

/// What a strain pass works on: arrays by slot and, by place, the least strain that anything happens at.
typedef struct mspringi_strain_sweep {
    const float *x, *y;
    const float *rest_lengths, *chain_springs; ///< as in mspringi_sweep
    const uint32_t *rests_of_block;            ///< as in mspringi_sweep
    uint32_t parts;
    const uint32_t *up_of_block;         ///< [lattice blocks] block above each
    uint32_t lattice_first, chain_first; ///< first block of lattice and of chain rows
    uint32_t chain_word;                 ///< word of the first chain block's bits
    const float *least;                  ///< [places]
    const uint16_t *live, *stressed;     ///< [places / MSPRINGI_WIDTH] bits
    const float *break_strain, *stress;  ///< [places] stress is NULL: stressed springs are listed unseen
    const float *relax;                  ///< [places] < 0: relax_fraction of stress instead; NULL: of all
    float relax_fraction;
} mspringi_strain_sweep;

/// Springs of one word of bits that have to be looked at.
typedef struct mspringi_strain_hit {
    uint32_t word, bits;
} mspringi_strain_hit;

/// List, of the blocks first ... end - 1 (counted from the first of their kind), the live springs whose stretch,
/// |length - rest_length|, is over their least strain times rest_length. Stressed ones are listed if they are over
/// their break strain, or may relax. hits has room for all words of these blocks.
/// @return the number of hits
typedef uint32_t (*mspringi_strain_fn)(const mspringi_strain_sweep *sweep, uint32_t first, uint32_t end,
                                       mspringi_strain_hit *hits);

/// What a look for springs that may yield works on: arrays by slot and, by place, the squares of the lengths
/// between which nothing happens to a spring.
typedef struct mspringi_yield_sweep {
    const float *x, *y;
    const uint32_t *up_of_block; ///< as in mspringi_strain_sweep, like the next three and live
    uint32_t lattice_first, chain_first;
    uint32_t chain_word;
    const float *low, *high; ///< [places]
    const uint16_t *live;
} mspringi_yield_sweep;

/// List, of the blocks first ... end - 1, the live springs that are shorter or longer than that, as
/// mspringi_strain_fn does.
typedef uint32_t (*mspringi_yield_fn)(const mspringi_yield_sweep *sweep, uint32_t first, uint32_t end,
                                      mspringi_strain_hit *hits);

/// What every spring adds to the stability limit: see limit_kernel.h. Arrays by slot, and springs as in
/// mspringi_sweep.
typedef struct mspringi_stability_limit {
    const float *x, *y, *inverse_mass;
    const float *lattice_springs, *rest_lengths, *chain_springs;
    const uint32_t *springs_of_block, *rests_of_block;
    const uint32_t *up_of_block; ///< [lattice blocks] block above each
    uint32_t lattice_first, lattice_blocks, chain_first, chain_blocks;
    bool is_damped;           ///< springs have damping
    float stiffness, damping; ///< what a spring's are multiplied by at the substep
    const float *in[2];       ///< to be read of both ends: weights, or a displacement
    float *out[3];            ///< what is added to
} mspringi_stability_limit;
typedef void (*mspringi_stability_limit_fn)(const mspringi_stability_limit *border);

/// The checksum of a snapshot, of what has been looked at so far, in whole units: 64-bit words, little-endian.
#define MSPRINGI_CHECKSUM_UNIT 64
#define MSPRINGI_CHECKSUM_LANES 8
typedef struct mspringi_checksum {
    uint64_t sums[MSPRINGI_CHECKSUM_LANES], sums_of_sums[MSPRINGI_CHECKSUM_LANES];
} mspringi_checksum;

/// Take so many units, of any alignment, into a checksum and, unless to is NULL, copy them.
typedef void (*mspringi_checksum_fn)(uint8_t *to, const uint8_t *from, size_t units, mspringi_checksum *checksum);

/// Those in which low words count. They look for themselves whether there are dampers (parts) and forces (force_x
/// not NULL): all of them take 50 kB in the four levels of x86, a copy of each of the others 104.
typedef struct mspringi_precise_kernels {
    mspringi_row_fn lattice, cells, chain, irregular, bundle;
    mspringi_attached_fn attached;
} mspringi_precise_kernels;

typedef struct mspringi_kernels {
    mspring_simd level;
    uint32_t lanes;                ///< that rows are swept by, at least MSPRINGI_QUARTER
    mspringi_row_fn lattice[2][2]; ///< [with damping][with forces]
    mspringi_row_fn cells[2][2];   ///< lattices with areas
    mspringi_row_fn chain[2][2];
    mspringi_row_fn irregular[2][2];
    mspringi_row_fn bundle[2]
                          [2];  ///< of spans of whole bundles, with a carry row for the forces of all slice columns
    mspringi_loose_fn loose[2]; ///< [with forces]
    mspringi_pack_fn pack;
    mspringi_attached_fn attached[2]; ///< [with damping]
    mspringi_precise_kernels precise;
    mspringi_row_fn tested_lattice[2], tested_chain[2]; ///< [precise]; like these they look for the rest themselves
    mspringi_largest_fn largest;
    mspringi_extrema_fn extrema_of;
    mspringi_beyond_fn beyond;
    mspringi_floor_fn touch, fly_past; ///< of particles with and without springs
    mspringi_silt_fn brake;
    mspringi_strain_fn lattice_strain, chain_strain;
    mspringi_yield_fn lattice_yield, chain_yield;
    mspringi_stability_limit_fn bound_lattice, bound_chain, image_lattice, image_chain;
    mspringi_checksum_fn checksum;
    mspringi_system_kernels system;
} mspringi_kernels;

#define LEVEL(name, number) extern const mspringi_kernels mspringi_kernels_##name;
#include "base/levels.def"
#undef LEVEL

/// The table of a level that mspringi_cpu_choose() has given.
const mspringi_kernels *mspringi_kernels_of(mspring_simd level);

#endif
