/// @file builder.h
/// What a builder holds, for the code that turns it into a network.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BUILDER_H
#define MSPRINGI_BUILDER_H

#include "base/memory.h"
#include "builder/builder_areas.h"

#include <massspring/massspring_batch.h>
#include <massspring/massspring_laws.h>
#include <massspring/massspring_tools.h>

typedef struct mspringi_particle {
    double x, y;
    float vx, vy;
    float mass;
    uint32_t flags; ///< MSPRING_PARTICLE_ and MSPRINGI_PARTICLE_ABSENT
} mspringi_particle;

/// Of a particle that has been removed from the network whose topology is made anew: it gets no slot.
#define MSPRINGI_PARTICLE_ABSENT (1u << 31)

/// What networks keep for the rest length 0 of a weld, m: shorter than what positions tell apart, so it pulls as a
/// spring of length 0 does. Where both ends are in the same place it counts as pressed. Such springs are as stiff
/// in all directions in the linear system of the implicit solver.
#define MSPRINGI_WELD 0x1p-50f

/// A rest length as it is kept, and as the host reads it.
static inline float mspringi_broken_length(float given) {
    return given == 0.0f ? MSPRINGI_WELD : given;
}
static inline float mspringi_read_length(float kept) {
    return kept == MSPRINGI_WELD ? 0.0f : kept;
}

/// The length that strains are shares of, by the rest length that is kept: of a weld they are in metres.
static inline float mspringi_strain_length(float kept) {
    return kept == MSPRINGI_WELD ? 1.0f : kept;
}
static inline float mspringi_strain_of(float length, float kept) {
    return (length - mspringi_read_length(kept)) / mspringi_strain_length(kept);
}

/// Flags of definitions that a spring keeps.
#define MSPRINGI_ONE_WAY_FLAGS (MSPRING_SPRING_PULL_ONLY | MSPRING_SPRING_PUSH_ONLY)
#define MSPRINGI_KEPT_SPRING_FLAGS (MSPRING_SPRING_RELATIVE | MSPRINGI_ONE_WAY_FLAGS)

typedef struct mspringi_spring {
    mspring_id a, b;
    float stiffness, damping, rest_length;
    uint32_t flags;
} mspringi_spring;

/// The strains at which something happens to a spring, as its definition gives them.
typedef struct mspringi_limits {
    float break_strain, stress_strain, relax_strain;
    float yield_strain, hardening, plastic_limit;
    float nominal_length; ///< rest length before any flow, m; 0: it has not flowed
} mspringi_limits;

#define MSPRINGI_LIMITS_OF(def)                                                                                    \
    ((mspringi_limits){(def)->break_strain, (def)->stress_strain, (def)->relax_strain, (def)->yield_strain,        \
                       (def)->hardening, (def)->plastic_limit, 0.0f})

/// Most plastic strain, and most hardening.
#define MSPRINGI_MOST_PLASTIC_STRAIN 0.9f
#define MSPRINGI_MOST_HARDENING 10.0f

struct mspring_builder {
    mspringi_memory memory;
    mspringi_message message;
    mspringi_particle *particles;
    mspringi_spring *springs;
    size_t particle_count, particle_capacity;
    size_t spring_count, spring_capacity;
    mspringi_limits *limits; ///< [limit_count] of the first springs; those behind them have none
    size_t limit_count, limit_capacity;
    mspringi_area *areas; ///< [area_count] of networks that were added
    size_t area_count, area_capacity;
    mspring_id *corners; ///< [corner_count] of the first area, of the second, and so on
    size_t corner_count, corner_capacity;
};

/// Whether a component of a velocity is in range. Faster ones overflow where a rate of strain is computed: for the
/// springs that are not there as well, which differ from one instruction set to the next.
static inline bool mspringi_is_speed(float value) {
    return value >= -(float)MSPRING_MAX_SPEED && value <= (float)MSPRING_MAX_SPEED;
}

/// Over any distance between two places within MSPRING_MAX_COORDINATE.
#define MSPRINGI_LARGEST_LENGTH 4e12f

// Comparisons are written so that NaN fails them.

static inline bool mspringi_in_range(float value, float low, float high) {
    return value >= low && value <= high;
}

static inline bool mspringi_is_coordinate(double value) {
    return value >= -MSPRING_MAX_COORDINATE && value <= MSPRING_MAX_COORDINATE;
}

/// Whether a spring may have this break or stress strain, and this relax strain.
static inline bool mspringi_is_threshold(float strain) {
    return strain > 0.0f;
}
static inline bool mspringi_is_relax_strain(float strain) {
    return (strain >= 0.0f) | (strain == MSPRING_RELAX_STRAIN_DEFAULT);
}

/// Make room for count more.
mspring_result mspringi_builder_reserve_particles(mspring_builder *builder, size_t count);
mspring_result mspringi_builder_reserve_springs(mspring_builder *builder, size_t count);

/// Limits of springs (limits.c). Refuse those that no spring may have, as the functions below do with other values.
mspring_result mspringi_check_limits(mspringi_message *message, const char *what, size_t index,
                                     mspringi_limits limits);
bool mspringi_has_limits(mspringi_limits limits);
bool mspringi_has_plasticity(mspringi_limits limits);
/// Make room for those of count springs more, if these are any; give them to all springs from one on.
mspring_result mspringi_builder_reserve_limits(mspring_builder *builder, size_t count, mspringi_limits limits);
void mspringi_builder_put_limits(mspring_builder *builder, size_t first, mspringi_limits limits);
mspringi_limits mspringi_builder_limits_of(const mspring_builder *builder, size_t spring);
/// Make room for so many areas and corners more; append one, whose corners are given with so much added to each.
mspring_result mspringi_builder_reserve_areas(mspring_builder *builder, size_t areas, size_t corners);
void mspringi_builder_append_area(mspring_builder *builder, mspringi_area area, const mspring_id *corners,
                                  mspring_id more);
/// Forget the springs from one on.
void mspringi_builder_cut_springs(mspring_builder *builder, size_t count);

/// Refuse values that no particle or spring may have. what and index are for the message.
mspring_result mspringi_check_mass(mspringi_message *message, const char *what, size_t index, float mass);
mspring_result mspringi_check_coefficients(mspringi_message *message, const char *what, size_t index,
                                           float stiffness, float damping, uint32_t flags);
/// The damping of a spring between these masses, where it may be given as a ratio: N s/m, or a fraction if the
/// spring is relative.
float mspringi_find_damping(float stiffness, float damping, uint32_t flags, float mass_a, float mass_b);
/// Refuse a struct_size, where the definition is one of several, of which the first has this one.
mspring_result mspringi_check_struct_of(mspringi_message *message, const char *what, size_t index, const char *name,
                                        const void *given, size_t known, size_t struct_size);

/// Add a mesh: all of it or, on error, nothing.
mspring_result mspringi_builder_add_mesh(mspring_builder *builder, const mspring_mesh_def *def);

/// Refuse definitions that are wrong whatever they are added to. index is for the message; struct_size is that of
/// the first of several.
mspring_result mspringi_check_particle_def(mspringi_message *message, size_t index, const mspring_particle_def *def,
                                           size_t struct_size);
mspring_result mspringi_check_spring_def(mspringi_message *message, size_t index, const mspring_spring_def *def,
                                         size_t struct_size);
/// The same for what is in the definition of a spring, after its particles have been looked at.
mspring_result mspringi_check_spring_values(mspringi_message *message, size_t index, const mspring_spring_def *def);
/// The rest length of a spring whose ends are (dx, dy) apart.
mspring_result mspringi_find_rest_length(mspringi_message *message, size_t index, const mspring_spring_def *def,
                                         double dx, double dy, float *rest_length);

#endif
