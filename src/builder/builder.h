/// @file builder.h
/// Contents of a builder, for the code that turns it into a network.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BUILDER_H
#define MSPRINGI_BUILDER_H

#include <float.h>

#include "base/memory.h"
#include "base/structs.h"
#include "builder/builder_areas.h"

#include <massspring/massspring.h>

typedef struct mspringi_particle {
    double x, y;
    float vx, vy;
    float mass;
    uint32_t flags; ///< MSPRING_PARTICLE_ and MSPRINGI_PARTICLE_ABSENT
} mspringi_particle;

/// Flag of a particle that was removed from the network being laid out: it gets no slot.
#define MSPRINGI_PARTICLE_ABSENT (1u << 31)

/// Stored rest length of a weld, m. It is below the resolution of positions, so it acts as 0. If both ends
/// coincide, the spring counts as compressed. The linear system of the implicit solver gives it equal stiffness in
/// all directions.
#define MSPRINGI_WELD 0x1p-50f

/// Convert a rest length from the host's to the stored one, and back.
static inline float mspringi_stored_length(float given) {
    return given == 0.0f ? MSPRINGI_WELD : given;
}
static inline float mspringi_read_length(float kept) {
    return kept == MSPRINGI_WELD ? 0.0f : kept;
}

/// Length that strains are relative to, from the stored rest length. Strains of a weld are in metres.
static inline float mspringi_strain_length(float kept) {
    return kept == MSPRINGI_WELD ? 1.0f : kept;
}
static inline float mspringi_strain_of(float length, float kept) {
    return (length - mspringi_read_length(kept)) / mspringi_strain_length(kept);
}

/// Strain of a limit that is given in metres. It is still a limit: neither 0 nor, unless it is large, infinite.
static inline float mspringi_strain_of_metres(float metres, float kept) {
    const double strain = (double)metres / (double)mspringi_strain_length(kept);
    if (!(metres > 0.0f && metres < MSPRING_NEVER)) // never, at once, or the default relax strain
        return metres;
    return strain < (double)FLT_MIN ? FLT_MIN : strain < (double)FLT_MAX ? (float)strain : MSPRING_NEVER;
}

/// Flags of a definition that are stored with the spring.
#define MSPRINGI_ONE_WAY_FLAGS (MSPRING_SPRING_PULL_ONLY | MSPRING_SPRING_PUSH_ONLY)
#define MSPRINGI_KEPT_SPRING_FLAGS (MSPRING_SPRING_RELATIVE | MSPRINGI_ONE_WAY_FLAGS | MSPRING_SPRING_METRES)

typedef struct mspringi_spring {
    mspring_id a, b;
    float stiffness, damping, rest_length;
    uint32_t flags;
} mspringi_spring;

/// Strain limits of a spring, as in its definition: strains, or m if it has MSPRING_SPRING_METRES.
typedef struct mspringi_limits {
    float break_strain, warn_strain, relax_strain;
    float yield_strain, hardening, plastic_limit;
    float nominal_length; ///< rest length before plastic flow, m; 0: it has not flowed
} mspringi_limits;

#define MSPRINGI_LIMITS_OF(def)                                                                                    \
    ((mspringi_limits){(def)->break_strain, (def)->warn_strain, (def)->relax_strain, (def)->yield_strain,          \
                       (def)->hardening, (def)->plastic_limit, 0.0f})

/// Largest plastic strain and largest hardening.
#define MSPRINGI_MAX_PLASTIC_STRAIN 0.9f
#define MSPRINGI_MAX_HARDENING 10.0f

struct mspring_builder {
    mspringi_memory memory;
    mspringi_message message;        ///< of the last call
    mspringi_message failed_message; ///< of the first description that failed
    mspring_result failed;           ///< its result, or MSPRING_OK
    mspringi_particle *particles;
    mspringi_spring *springs;
    size_t particle_count, particle_capacity;
    size_t spring_count, spring_capacity;
    mspringi_limits *limits; ///< [limit_count] of the first springs; later ones have none
    size_t limit_count, limit_capacity;
    mspringi_area *areas; ///< [area_count] from networks that were added
    size_t area_count, area_capacity;
    mspring_id *corners; ///< [corner_count] corners by area
    size_t corner_count, corner_capacity;
    struct mspringi_archive *archive;                   ///< that it has read (archive/archive_format.h), or NULL
    const struct mspringi_archive_calls *archive_calls; ///< with an archive
    float lag; ///< of the velocities, as in mspringi_steps: that of the networks that were added, or 0
};

/// Lag of a builder to which particles with this lag are added: theirs, or 0 if others have another.
static inline float mspringi_joint_lag(const mspring_builder *builder, float lag) {
    return builder->particle_count == 0 || builder->lag == lag ? lag : 0.0f;
}

/// True if a velocity component is in range. Faster ones overflow strain rates, even of absent springs in records,
/// which differ between instruction sets.
static inline bool mspringi_is_speed(float value) {
    return value >= -(float)MSPRING_MAX_SPEED && value <= (float)MSPRING_MAX_SPEED;
}

/// Larger than any distance within MSPRING_MAX_COORDINATE, m.
#define MSPRINGI_MAX_LENGTH 4e12f

// Comparisons are written to reject NaN.

static inline bool mspringi_in_range(float value, float low, float high) {
    return value >= low && value <= high;
}

static inline bool mspringi_is_coordinate(double value) {
    return value >= -MSPRING_MAX_COORDINATE && value <= MSPRING_MAX_COORDINATE;
}

/// True if a strain is a valid break, stress or yield strain; a valid relax strain.
static inline bool mspringi_is_threshold(float strain) {
    return strain > 0.0f;
}
static inline bool mspringi_is_relax_strain(float strain) {
    return (strain >= 0.0f) | (strain == MSPRING_RELAX_STRAIN_DEFAULT);
}

/// End a call that describes something: remember the first failure, and return its result.
mspring_result mspringi_builder_end(mspring_builder *builder, mspring_result result);

/// Copy a material and check it; `what` is for the message.
mspring_result mspringi_take_good_material(mspringi_message *message, const char *what, size_t index,
                                           const mspring_material *materials, mspring_material *material);
/// Copy and check the material of a rope, a mesh or a disc; from may be NULL, which is an error.
mspring_result mspringi_take_own_material(mspringi_message *message, const char *shape,
                                          const mspring_material *from, mspring_material *material);

/// Make room for `count` more particles or springs.
mspring_result mspringi_builder_reserve_particles(mspring_builder *builder, size_t count);
mspring_result mspringi_builder_reserve_springs(mspring_builder *builder, size_t count);

/// Limits of springs (limits.c). Reject invalid ones; `what` and `index` are for the message.
mspring_result mspringi_check_limits(mspringi_message *message, const char *what, size_t index,
                                     mspringi_limits limits);
bool mspringi_has_limits(mspringi_limits limits);
bool mspringi_has_plasticity(mspringi_limits limits);
/// Make room for the limits of `count` more springs, unless these are the defaults; set the limits of all springs
/// from `first` on.
mspring_result mspringi_builder_reserve_limits(mspring_builder *builder, size_t count, mspringi_limits limits);
void mspringi_builder_put_limits(mspring_builder *builder, size_t first, mspringi_limits limits);
mspringi_limits mspringi_builder_limits_of(const mspring_builder *builder, size_t spring);
/// Make room for more areas and corners; append an area, with `more` added to each of its corner ids.
mspring_result mspringi_builder_reserve_areas(mspring_builder *builder, size_t areas, size_t corners);
void mspringi_builder_append_area(mspring_builder *builder, mspringi_area area, const mspring_id *corners,
                                  mspring_id more);
/// Remove the springs from index `count` on.
void mspringi_builder_cut_springs(mspring_builder *builder, size_t count);

/// Reject invalid values of particles and springs. `what` and `index` are for the message.
mspring_result mspringi_check_mass(mspringi_message *message, const char *what, size_t index, float mass);
mspring_result mspringi_check_coefficients(mspringi_message *message, const char *what, size_t index,
                                           float stiffness, float damping, uint32_t flags);
/// Damping of a spring between these masses, from a coefficient or a ratio: N s/m, or a fraction if the spring is
/// relative.
float mspringi_find_damping(float stiffness, float damping, uint32_t flags, float mass_a, float mass_b);

/// Add a whole mesh of a good material or, on error, nothing.
mspring_result mspringi_builder_add_mesh(mspring_builder *builder, const mspring_mesh_def *def,
                                         const mspring_material *material);

/// Copy definition i of the host's array; reject one that is invalid in any builder. `index` is for the message.
mspring_result mspringi_take_particle(mspringi_message *message, size_t index, const mspring_particle_def *defs,
                                      size_t i, mspring_particle_def *def);
mspring_result mspringi_take_spring(mspringi_message *message, size_t index, const mspring_spring_def *defs,
                                    size_t i, mspring_spring_def *def);
/// Reject invalid values in a spring's definition, after its particles were checked.
mspring_result mspringi_check_spring_values(mspringi_message *message, size_t index, const mspring_spring_def *def);
/// Find the rest length of a spring whose ends are (dx, dy) apart.
mspring_result mspringi_find_rest_length(mspringi_message *message, size_t index, const mspring_spring_def *def,
                                         double dx, double dy, float *rest_length);

#endif
