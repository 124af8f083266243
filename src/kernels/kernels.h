/// @file kernels.h
/// Inner loops, a table of them for each instruction set.
///
/// All tables compute the same values by the same operations in the same order, so all give the same bits. The
/// scalar table is the definition. No table uses fused multiply-add or an approximate reciprocal, but where the
/// result is rounded correctly all the same (inverse_avx512.h).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_KERNELS_H
#define MSPRINGI_KERNELS_H

#include "base/target.h"
#include "kernels/shared_records.h"
#include "kernels/system.h"
#include "kernels/yield_law.h"
#include "layout/topology.h"

/// Squared length, m^2, up to which a spring has no direction and no force. Above it the inverse is finite.
#define MSPRINGI_NO_DIRECTION 1e-37f

/// Mask of a float without its last 12 bits: the square of what is left is exact.
#define MSPRINGI_LEADING_BITS 0xfffff000u

/// Speeds below this count as none, m/s: they move no position, and are far above subnormal numbers.
#define MSPRINGI_TINY_SPEED 1e-30f

/// Dampers, and lengths in two words, pass on a small part of a motion at once, so that ahead of a front speeds
/// fall by a factor of a thousand from cell to cell, down to subnormal numbers, which take x86 processors 2 to 4
/// times as long. In substeps whose number in the step is a multiple of this period, tiny speeds become 0 (a period
/// of 4 costs 1 to 2 % less, but leaves frames that take twice as long).
#define MSPRINGI_FLUSH_PERIOD 2u

/// Features of a sweep, as bits. Kernels are compiled for each set of constant bits.
typedef uint32_t mspringi_variant;
enum {
    MSPRINGI_DAMPED = 1u << 0,  ///< springs have damping
    MSPRINGI_FORCED = 1u << 1,  ///< external forces act
    MSPRINGI_PRECISE = 1u << 2, ///< low words count in spring lengths
    MSPRINGI_CELLS = 1u << 3,   ///< lattice cells have areas
    MSPRINGI_TESTED = 1u << 4,  ///< springs are tested for yielding
    /// External forces act if there are any. That takes irregular parts -1.2 to 0.7 % more instructions (SSE2,
    /// AVX2) and a level 8 kB less, but chains and bundles up to 2.7 %.
    MSPRINGI_FORCED_OR_NOT = 1u << 5
};

/// Parts of a spring record, each one value per slot; damping only if the network has any.
typedef enum mspringi_part { MSPRINGI_REST_LENGTH = 0, MSPRINGI_STIFFNESS = 1, MSPRINGI_DAMPING = 2 } mspringi_part;

/// Largest absolute coordinate, speed and change of velocity of the moved slots in each lane. NaN counts as the
/// largest, as in mspringi_largest.
typedef struct mspringi_extrema_lanes {
    float coordinate[MSPRINGI_WIDTH], speed[MSPRINGI_WIDTH], change[MSPRINGI_WIDTH];
} mspringi_extrema_lanes;

/// The maxima over all lanes.
typedef struct mspringi_extrema {
    float coordinate, speed, change;
} mspringi_extrema;
typedef mspringi_extrema (*mspringi_extrema_fn)(const mspringi_extrema_lanes *watch);

/// Substeps between two tests for warm springs, counted from the first of a step.
#define MSPRINGI_YIELD_PERIOD 4u

/// Result of a test of a strip: a spring is close to its yield limit; one was in this step; one has flowed.
enum { MSPRINGI_WARM = 1, MSPRINGI_WAS_WARM = 2, MSPRINGI_HAS_FLOWED = 4 };

/// Arguments and results of a tested sweep, by spring slot. Bounds are squared lengths.
typedef struct mspringi_yield_test {
    bool looks;                        ///< test for warm springs; else for flowing ones
    bool maps;                         ///< update the rest lengths of flowing springs
    const float *test_low, *test_high; ///< bounds for the test of a sweep
    float *low, *high, *flow_low, *flow_high;
    const float *nominal, *yield_strain, *hardening, *plastic_limit, *gain; ///< see yield_law.h
    float *lattice_rests;                                                   ///< [lattice spring slots]
    float *chain_springs;                                                   ///< records: [block][part][lane]
    const uint16_t *live;                                                   ///< [spring slots / MSPRINGI_WIDTH]
                                                                            ///< bits
    size_t first_chain_slot;                                                ///< first spring slot of a chain
    mspringi_shared_records shared_records; ///< blocks with the same rest lengths and bounds
    uint32_t block_count;
    float *heat;          ///< dissipated by flow in the step, J
    float *before;        ///< rest lengths before the step, of springs that have flowed in it
    uint16_t *has_flowed; ///< [spring slots / MSPRINGI_WIDTH] bits
    uint8_t *warmth;      ///< of the strip: MSPRINGI_WARM, ...
    uint32_t look;        ///< number of the last look in the step
    uint16_t *warm;       ///< [spring slots / MSPRINGI_WIDTH] bits: warm in the look look_of[word]
    uint32_t *look_of;
} mspringi_yield_test;

/// Mark the warm springs of a word.
static inline void mspringi_yield_mark_warm(const mspringi_yield_test *test, size_t word, uint32_t warm) {
    warm &= test->live[word];
    if (!test->looks || !warm)
        return;
    *test->warmth |= MSPRINGI_WARM | MSPRINGI_WAS_WARM;
    if (!test->maps) // several workers look at a border
        return;
    test->warm[word] = (uint16_t)((test->look_of[word] == test->look ? test->warm[word] : 0u) | warm);
    test->look_of[word] = test->look;
}

/// Springs of a word that were warm in the last look. Only these flow, so results do not depend on the layout.
static inline uint32_t mspringi_yield_warm(const mspringi_yield_test *test, size_t word) {
    return test->look_of[word] == test->look ? test->warm[word] : 0u;
}

// Prepare a change of the rest lengths and bounds of a word.
static inline void mspringi_yield_unshare(const mspringi_yield_test *test, size_t word) {
    const uint32_t block = (uint32_t)(word / MSPRINGI_DIRECTIONS);
    mspringi_shared_records shared = test->shared_records;
    if (word * MSPRINGI_WIDTH < test->first_chain_slot &&
        (shared.of_block[block] != block || shared.readers[block] > 0))
        mspringi_shared_records_unshare_block(&shared, block, test->block_count);
}

/// Save the rest lengths of a word's flowing springs, once in a step.
static inline void mspringi_yield_save(const mspringi_yield_test *test, size_t word, uint32_t flow,
                                       const float *rests) {
    mspringi_yield_unshare(test, word);
    uint32_t left = flow & ~(uint32_t)test->has_flowed[word];
    test->has_flowed[word] |= (uint16_t)flow;
    *test->warmth |= MSPRINGI_HAS_FLOWED;
    for (uint32_t lane = 0; left; left >>= 1, ++lane)
        if (left & 1)
            test->before[word * MSPRINGI_WIDTH + lane] = rests[lane];
}

/// Largest low word relative to its value. A larger one, unless it is within the grid of precise coordinates,
/// belongs to a value that was overwritten through a view, and counts as 0.
#define MSPRINGI_LARGEST_LOW 0x1p-21f

static inline float mspringi_low_of(float coordinate, float low, float grid) {
    return fabsf(low) <= fabsf(coordinate) * MSPRINGI_LARGEST_LOW || fabsf(low) <= grid ? low : 0.0f;
}

/// Number that rounds a coordinate to a grid when it is added and subtracted.
#define MSPRINGI_GRID_ROUNDING 0x1.8p23f

/// First word of a coordinate on the grid of a precise network, if there is one.
static inline float mspringi_round_to_grid(float grid, float coordinate) {
    const float rounding = grid * MSPRINGI_GRID_ROUNDING, rounded = (coordinate + rounding) - rounding;
    return rounding > 0.0f ? rounded : coordinate;
}

/// Arguments of a sweep: arrays by slot, and constants.
typedef struct mspringi_sweep {
    float *x, *y, *vx, *vy;
    float *low_x, *low_y;   ///< low words of the positions
    float *low_vx, *low_vy; ///< low words of the velocities, of precise networks; else NULL
    const float *inverse_mass;
    const float *force_x, *force_y;   ///< external forces, or NULL; read by MSPRINGI_FORCED kernels only
    float *carry_x, *carry_y;         ///< forces from the row below, by column
    const float *lattice_springs;     ///< records: [direction][part after the rest length][lane]
    const uint32_t *springs_of_block; ///< [block] number of its record
    const float *rest_lengths;        ///< of lattice springs: [record][direction][lane]
    const uint32_t *rests_of_block;   ///< [block] number of its record
    const float *cells; ///< [block][2][lane] half the force of an area per distance at area 0, and its decrease
                        ///< with the cross product of the diagonals; 0 without a cell; for MSPRINGI_CELLS kernels
    const float *chain_springs; ///< records: [block][part][lane]
    const mspringi_sell *irregular;
    const float *irregular_springs; ///< records: [slice column][part][lane]
    const float *gathered; ///< [node][4] x, y, vx, vy of the irregular part's nodes at the start of the substep;
                           ///< for precise kernels x, y, low_x, low_y and, with damping, at
                           ///< mspringi_gathered_half() vx, vy and padding
    uint32_t parts;        ///< number of parts in a record: 2 or, with damping, 3
    float h;               ///< substep, s
    float time;         ///< from the middle of the substep before, s: velocities go from there to the middle of h
    float kick;         ///< change of velocity per acceleration in that time, s
    float gravity_time; ///< the same for gravity, s: longer where an edit has cut that of springs
    float gravity_kick; ///< change of velocity per gravity, s
    float damping_loss; ///< share of a velocity that global damping takes in it
    float loss;         ///< the same with the substep's dither, see mspringi_dither()
    float grid;         ///< 1.5 * 2^23 times the grid of precise coordinates: adding and subtracting it rounds
    float gravity_h_x, gravity_h_y; ///< gravity times its kick, m/s
    float *keep; ///< [6 or 8][slots] copy of the state before the substep, in the order of mspringi_state; or NULL
    mspringi_extrema_lanes *watch; ///< maxima over the new state, or NULL
    const float *before; ///< vx before the step, followed by vy, to measure changes; equals the copy in keep if
                         ///< there is one; or NULL
    bool flushes;        ///< tiny speeds become 0
    bool watches_coordinate, watches_speed; ///< update the maxima of coordinates and speeds
    const mspringi_yield_test *test;        ///< read by MSPRINGI_TESTED kernels only
} mspringi_sweep;

/// True if a kernel turns tiny speeds into 0.
static inline bool mspringi_flushes(const mspringi_sweep *sweep, mspringi_variant of) {
    return of & (MSPRINGI_DAMPED | MSPRINGI_PRECISE) && sweep->flushes;
}

/// Number of floats in four values of each node of the irregular part.
static inline size_t mspringi_gathered_half(const mspringi_sell *irregular) {
    return (size_t)4 * irregular->slice_count * MSPRINGI_WIDTH;
}

/// Compute the forces of the springs of one or more rows and move their particles, in place. Lattice rows and
/// chains add the carry row from the row below, and replace it with the forces on the row above (0 where there are
/// none).
///
/// The force of a span's last spring is carried to the next span, adjacent or not. If it is not adjacent, there is
/// no such spring, and the force is 0.
typedef void (*mspringi_row_fn)(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count);

/// Motion of a particle without springs in some substeps, with acceleration a by external forces:
///     v' = keep v + (gain a + gravity),   x' = x + (reach v + (fall a + gravity_way))
/// A pinned particle keeps its velocity and moves by drift v.
typedef struct mspringi_free_motion {
    float keep, gain, reach, fall, drift;
    float loss;                         ///< 1 - keep, for velocities in two words
    float gravity_x, gravity_y;         ///< change of velocity, m/s
    float gravity_way_x, gravity_way_y; ///< m
} mspringi_free_motion;

/// Move the particles of a span that have no springs, by all substeps at once.
typedef void (*mspringi_loose_fn)(const mspringi_sweep *sweep, const mspringi_span *span,
                                  const mspringi_free_motion *glide);

/// Copy position and velocity of block_count consecutive blocks of slots into packed.
typedef void (*mspringi_pack_fn)(const mspringi_sweep *sweep, size_t first_block, size_t block_count,
                                 float *gathered);

/// Compute the irregular part's forces on the attached nodes first (a multiple of MSPRINGI_WIDTH) to first + count
/// - 1, into x and y by number of the attached node. May fill up the last node's slice.
typedef void (*mspringi_attached_fn)(const mspringi_sweep *sweep, uint32_t first, uint32_t count, float *x,
                                     float *y);

/// Largest absolute value of count values (a multiple of MSPRINGI_WIDTH) and, if before is not NULL, largest
/// absolute change. NaN counts as the largest.
typedef struct mspringi_largest {
    float value, change;
} mspringi_largest;
typedef mspringi_largest (*mspringi_largest_fn)(const float *now, const float *before, size_t count);

/// A box.
typedef struct mspringi_bounds {
    float min_x, max_x, min_y, max_y;
} mspringi_bounds;

/// Find the first block of slots from first to end (multiples of MSPRINGI_WIDTH) with a slot outside a box. Return
/// its first slot, or end if there is none.
typedef size_t (*mspringi_beyond_fn)(const float *x, const float *y, size_t first, size_t end,
                                     const mspringi_bounds *bounds);

/// Border of a half-plane. The distance from it is n . p + offset, > 0 on the free side.
typedef struct mspringi_line {
    double nx, ny, offset; ///< n of length 1, offset for local coordinates
    double friction, restitution;
} mspringi_line;

/// Friction and restitution of a contact.
typedef struct mspringi_contact_material {
    float friction, restitution; ///< of a particle, < 0 means the value of what it touches
} mspringi_contact_material;

/// Global damping in a substep: v' = keep v + a h / scale, with acceleration a.
typedef struct mspringi_damping {
    double keep, scale; ///< 1 and 1 without damping
} mspringi_damping;

/// A floor, and the particles it acts on, by slot.
typedef struct mspringi_floor_args {
    const mspringi_line *lines;
    uint32_t line_count;
    uint32_t height_count; ///< 0: no heights
    const float *heights;
    const double *normals;        ///< as in mspringi_heights
    double left, bottom, spacing; ///< as in mspringi_heights, local
    const float *frictions,
        *restitutions; ///< [height_count - 1] of each straight part; NULL: the next two apply to all
    double friction, restitution;
    double h;              ///< length of the substep, s
    double per_length;     ///< 4 h over the shortest spring's length, s/m
    mspringi_bounds clear; ///< the floor ignores particles in this box
    float *x, *y, *vx, *vy;
    const float *from_vx, *from_vy; ///< before the substep
    float *low_x, *low_y;
    float *low_vx, *low_vy;       ///< of precise networks; else NULL
    float grid;                   ///< m, of precise networks; else 0
    float *before_vx, *before_vy; ///< from_vx and from_vy; NULL if these are vx and vy
    double silt_depth, silt_rate;
    const float *silt_depths; ///< [height_count] instead of silt_depth; NULL: that is all
    mspringi_damping damping;
    float *impulse_x, *impulse_y;
    const float *inverse_mass, *active_inverse_mass;
    const mspringi_contact_material *own; ///< [MSPRINGI_WIDTH] of the block's particles; NULL: none has any
} mspringi_floor_args;

/// Let a floor act on the particles of the block that begins at slot, after a leapfrog substep. One
/// kernel is for particles with springs, one for those without. Return a bit for each unmodified particle that
/// changed from one straight part of the heights to another, or is in a corner: mspringi_floor_bounce() and
/// mspringi_floor_move_free_particle() handle these.
typedef uint32_t (*mspringi_floor_fn)(const mspringi_floor_args *args, size_t slot);

/// Let silt brake the particles of the block, before a floor acts on them.
typedef void (*mspringi_silt_fn)(const mspringi_floor_args *args, size_t slot);

/// Arguments of a strain pass: arrays by slot, and the smallest strain with an effect by spring slot.
typedef struct mspringi_strain_sweep {
    const float *x, *y;
    const float *rest_lengths, *chain_springs; ///< as in mspringi_sweep
    const uint32_t *rests_of_block;            ///< as in mspringi_sweep
    uint32_t parts;
    const uint32_t *up_of_block;         ///< [lattice blocks] block above each
    uint32_t lattice_first, chain_first; ///< first block of lattice and of chain rows
    uint32_t chain_word;                 ///< word of the first chain block's bits
    const float *least;                  ///< [spring slots]
    const uint16_t *live, *stressed;     ///< [spring slots / MSPRINGI_WIDTH] bits
    const float *break_strain, *stress;  ///< [spring slots] stress is NULL: stressed springs are listed untested
    const float *relax;                  ///< [spring slots] < 0: relax_fraction of stress instead; NULL: of all
    float relax_fraction;
} mspringi_strain_sweep;

/// Springs of one word of bits that need a closer test.
typedef struct mspringi_strain_hit {
    uint32_t word, bits;
} mspringi_strain_hit;

/// List the live springs of the blocks first ... end - 1 (counted from the first of their kind) whose stretch,
/// |length - rest_length|, exceeds their least strain times rest_length. Stressed ones are listed if they exceed
/// their break strain, or may relax. hits has room for all words of these blocks. Return the number of hits.
typedef uint32_t (*mspringi_strain_fn)(const mspringi_strain_sweep *sweep, uint32_t first, uint32_t end,
                                       mspringi_strain_hit *hits);

/// Arguments of a yield pass: arrays by slot, and by spring slot the squared lengths between which a spring is
/// elastic.
typedef struct mspringi_yield_sweep {
    const float *x, *y;
    const uint32_t *up_of_block; ///< as in mspringi_strain_sweep, like the next three and live
    uint32_t lattice_first, chain_first;
    uint32_t chain_word;
    const float *low, *high; ///< [spring slots]
    const uint16_t *live;
} mspringi_yield_sweep;

/// List the live springs of the blocks first ... end - 1 outside their bounds, as mspringi_strain_fn does.
typedef uint32_t (*mspringi_yield_fn)(const mspringi_yield_sweep *sweep, uint32_t first, uint32_t end,
                                      mspringi_strain_hit *hits);

/// Arguments of a search for violent motion.
typedef struct mspringi_violence_sweep {
    const float *vx, *vy;
    const uint32_t *up_of_block; ///< as in mspringi_strain_sweep, like the next two
    uint32_t lattice_first;
    const uint16_t *live;
    float square; ///< of a difference of velocities
} mspringi_violence_sweep;

/// The first of the lattice blocks first ... end - 1 with a live spring whose ends' velocities differ by more; or
/// end.
typedef uint32_t (*mspringi_violence_fn)(const mspringi_violence_sweep *sweep, uint32_t first, uint32_t end);

/// Clamped steps (solvers/clamped/clamp.c): ratio above which springs are clamped, and the share of a substep ahead
/// at which they act; square of the way of a violent spring's ends against each other in a substep, in squares of
/// its length.
#define MSPRINGI_CLAMP_RATIO 1.375f
#define MSPRINGI_CLAMP_AHEAD 0.1875f
#define MSPRINGI_CLAMP_WAY 0.0625f

/// Least geometric stiffness of a compressed spring in the stability limit, in stiffnesses: that at a 65th of its
/// rest length. It never makes a limit tighter. Left as it is, rounding of a spring of length 0 hides all others.
#define MSPRINGI_DEEPEST_SOFTENING (-64.0f)

/// Arguments of the stability limit's passes: see limit_kernel.h. Arrays by slot, and springs as in mspringi_sweep.
typedef struct mspringi_stability_limit {
    const float *x, *y, *inverse_mass;
    const mspringi_topology *topology;
    const float *lattice_springs, *rest_lengths, *chain_springs;
    const uint32_t *springs_of_block, *rests_of_block;
    bool is_damped;           ///< springs have damping
    float stiffness, damping; ///< factors on a spring's at the substep
    const float *in[3];       ///< operand at both ends: weights; a displacement; velocities and ratios
    float *out[3];            ///< sums to add to
    float h;                  ///< of clamped springs, s
} mspringi_stability_limit;
typedef void (*mspringi_stability_limit_fn)(const mspringi_stability_limit *border);

/// Checksum of a snapshot over whole units of 64-bit words, little-endian.
#define MSPRINGI_CHECKSUM_UNIT 64
#define MSPRINGI_CHECKSUM_LANES 8
typedef struct mspringi_checksum {
    uint64_t sums[MSPRINGI_CHECKSUM_LANES], sums_of_sums[MSPRINGI_CHECKSUM_LANES];
} mspringi_checksum;

/// Add units, of any alignment, to a checksum and, unless to is NULL, copy them.
typedef void (*mspringi_checksum_fn)(uint8_t *to, const uint8_t *from, size_t units, mspringi_checksum *checksum);

/// Kernels with low words. They test for dampers (parts) and forces (force_x not NULL) at run time: all of them
/// take 50 kB in the four levels of x86; with a copy for each case they would take 104.
typedef struct mspringi_precise_kernels {
    mspringi_row_fn lattice, cells, chain, irregular, bundle;
    mspringi_attached_fn attached;
} mspringi_precise_kernels;

typedef struct mspringi_kernels {
    mspring_simd level;
    uint32_t lanes;                ///< lanes of a sweep, at least MSPRINGI_QUARTER
    mspringi_row_fn lattice[2][2]; ///< [with damping][with forces]
    mspringi_row_fn cells[2][2];   ///< lattices with areas
    mspringi_row_fn chain[2][2];
    mspringi_row_fn irregular[2]; ///< [with damping]
    mspringi_row_fn bundle[2]
                          [2];  ///< of spans of whole bundles, with a carry row for the forces of all slice columns
    mspringi_loose_fn loose[2]; ///< [with forces]
    mspringi_pack_fn pack;
    mspringi_attached_fn attached[2]; ///< [with damping]
    mspringi_precise_kernels precise;
    mspringi_row_fn tested_lattice[2], tested_chain[2]; ///< [precise]; tests for the rest at run time
    mspringi_largest_fn largest;
    mspringi_extrema_fn extrema_of;
    mspringi_beyond_fn beyond;
    mspringi_floor_fn bounce, bounce_free; ///< for particles with and without springs
    mspringi_silt_fn brake;
    mspringi_strain_fn lattice_strain, chain_strain;
    mspringi_yield_fn lattice_yield, chain_yield;
    mspringi_violence_fn lattice_violence;
    mspringi_stability_limit_fn bound_rows, image_rows, clamp_rows;
    mspringi_checksum_fn checksum;
    mspringi_system_kernels system;
} mspringi_kernels;

#define LEVEL(name, number) extern const mspringi_kernels mspringi_kernels_##name;
#include "base/levels.def"
#undef LEVEL

/// Table of a level from mspringi_cpu_choose().
const mspringi_kernels *mspringi_kernels_of(mspring_simd level);

#endif
