/// @file spec.h
/// Specification of the explicit solver, as a program: see spec.c. It knows nothing of the library.
///
/// SPDX-License-Identifier: MIT
#ifndef SPEC_H
#define SPEC_H

#include <stdbool.h>
#include <stdint.h>

/// No spring.
#define SPEC_NONE UINT32_MAX

/// Numbers of substeps for "as few as are stable in any shape", and for "of even length while dt varies".
#define SPEC_AUTO UINT32_MAX
#define SPEC_EVEN (UINT32_MAX - 1)

/// Rest length of a weld, m.
#define SPEC_WELD 0x1p-50f

/// Neighbours in rows, from a particle's point of view: a row goes east, the next row lies north of it.
typedef enum spec_side {
    SPEC_EAST,
    SPEC_NORTH_EAST,
    SPEC_NORTH,
    SPEC_NORTH_WEST,
    SPEC_WEST,
    SPEC_SOUTH_WEST,
    SPEC_SOUTH,
    SPEC_SOUTH_EAST,
    SPEC_SIDES
} spec_side;

typedef struct spec_vector {
    float x, y;
} spec_vector;

/// Motion of a particle in two words: its position is origin + place + low_place, its velocity velocity +
/// low_velocity (low_velocity of precise networks only, else 0).
typedef struct spec_motion {
    spec_vector place, low_place, velocity, low_velocity;
} spec_motion;

/// A rest length that goes evenly from that of a restored spring to its own.
typedef struct spec_ramp {
    double from; ///< m
    float to;    ///< m
    double seconds, passed; ///< seconds 0: there is none
} spec_ramp;

typedef struct spec_spring {
    uint32_t a, b;
    float stiffness, damping, rest_length; ///< N/m, N s/m, m; 0: a weld
    bool is_relative; ///< stiffness and damping follow from these shares, masses and the substep
    float stiffness_share, damping_share;
    bool is_broken;
    int side;      ///< 1: it only pulls, -1: it only pushes, 0: both
    bool is_slack; ///< of one that has a side: it does nothing in this substep
    spec_ramp ramp;
    float break_strain; ///< or INFINITY
    float yield_strain, hardening, plastic_limit; ///< yield_strain INFINITY: it doesn't yield
    float nominal; ///< m, rest length before any flow; 0 in a network where none yields
    bool is_warm;  ///< it was near to yielding at the last look
} spec_spring;

/// Place of a particle's springs in the sum of its forces. It is part of the input, as it decides the bits.
typedef struct spec_sums {
    bool is_in_rows;                   ///< in a lattice or chain: springs in rows act first, then the others
    bool is_top;                       ///< in a chain, or in a row with none north of it
    uint32_t rows[SPEC_SIDES];         ///< springs summed by rows, or SPEC_NONE
    uint32_t first_other, other_count; ///< the other springs, in spec_network.others, by rising number
} spec_sums;

/// A half-plane that particles may not enter: n . p + offset < 0 in world coordinates, n of length 1.
typedef struct spec_plane {
    double x, y;                  ///< a point on the border
    double nx, ny;                ///< points to the free side
    double offset;                ///< of the border, local coordinates
    double friction, restitution; ///< Coulomb's coefficient; speed after over speed before
} spec_plane;

/// A field of heights: straight parts from (x + i spacing, y + heights[i]) to the next, level beyond both ends.
typedef struct spec_heights {
    uint32_t count; ///< 0: none
    const float *heights;
    double x, y, spacing; ///< world coordinates
    double local_x, local_y;
    double friction, restitution;
    const float *frictions, *restitutions; ///< [count - 1] of each part instead; or NULL
} spec_heights;

/// Most corners of an element.
#define SPEC_CORNERS 8

/// An area or an angle spring.
typedef enum spec_element_kind { SPEC_ELASTIC, SPEC_GAS, SPEC_ANGLE } spec_element_kind;

typedef struct spec_element {
    spec_element_kind kind;
    uint32_t count;                           ///< corners; 3 of an angle
    uint32_t corners[SPEC_CORNERS];           ///< particles; counterclockwise when it was added
    uint32_t sides[SPEC_CORNERS];             ///< springs along the outline or the arms, or SPEC_NONE
    float reach[SPEC_CORNERS];                ///< growth where a corner moves outwards, when it was added
    float stiffness, damping, pressure, fill; ///< damping: of angles; fill: 1 of angles
    double rest_area;                         ///< m^2; 1 of angles
    double cosine, sine;                      ///< of an angle's rest
    uint32_t cell[4]; ///< corners by rows: south-west, south-east, north-east, north-west; SPEC_NONE: in no rows
    float cell_force, cell_decrease; ///< half the force of a cell per distance at area 0, and what it loses per area
} spec_element;

/// Most grips of one particle.
#define SPEC_GRIPS 4

/// A soft constraint of one particle to a place.
typedef struct spec_grip {
    uint32_t particle;
    float stiffness, damping, max_force;
    double from_x, from_y, x, y; ///< where the target is at the start of a step and at its end, world coordinates, m
} spec_grip;

/// A spring whose rest length changes in a step.
typedef struct spec_actuator {
    uint32_t spring;
    float from, to; ///< m
} spec_actuator;

/// Pace of SPEC_EVEN.
typedef struct spec_pace {
    double dt;      ///< from which h was chosen, s; 0: none was
    double h;       ///< substep, s
    double left;    ///< that steps were given and have not taken, s; < 0: they are ahead
    uint32_t steps; ///< in a row that ask for another h
} spec_pace;

typedef struct spec_network spec_network;

struct spec_network {
    uint32_t particle_count, spring_count, plane_count;
    spec_motion *motions;        ///< [particle_count]
    spec_motion *before;         ///< [particle_count] scratch: before the substep
    spec_vector *forces;         ///< [particle_count] of the host in the next step, N
    spec_vector *fields;         ///< [particle_count] scratch: forces from outside in the substep, N
    const float *inverse_masses; ///< [particle_count] 1/kg, 0 if pinned
    const float *masses;         ///< [particle_count] kg
    bool has_relative;           ///< springs
    const spec_sums *sums;       ///< [particle_count]
    const uint32_t *others;
    spec_spring *springs;  ///< [spring_count]
    uint32_t first_added;  ///< number of the first spring that was added after the layout was made
    spec_plane planes[8];
    spec_heights heights;
    uint32_t element_count, grip_count, actuator_count;
    spec_grip *grips;         ///< in the order in which they were added
    spec_actuator *actuators; ///< set in the next step
    uint32_t changes;         ///< most of an actuator's length in a step
    spec_element *elements; ///< in the order in which they were added
    void (*hook)(const spec_network *network, spec_vector *forces); ///< adds forces; or NULL
    uint32_t hook_period; ///< substeps that its forces last, counted from the first of a step
    spec_vector *held;    ///< [particle_count] scratch: its forces, N
    float gravity_x, gravity_y, global_damping; ///< m/s^2, 1/s
    bool is_precise;
    uint32_t substeps;                ///< of a step, or SPEC_AUTO or SPEC_EVEN
    uint32_t max_substeps, most_work; ///< most of those two; times as many as for calm motion, or 0: no bound

    // Set by spec_begin().
    bool is_damped;   ///< a spring has damping
    float grid;       ///< m, of the first words of places in precise networks, else 0
    double shortest;  ///< rest length at the beginning, m
    double any_shape; ///< longest substep that is stable in any shape, s
    double origin_x, origin_y;
    float look_distance; ///< m, distance of the first particle at which the origin is looked at
    float lag;           ///< s, length of the last substep; 0: velocities are of now
    double dt;           ///< of the last step, s; 0: none
    uint32_t uneven;     ///< steps for which dt counts as uneven
    spec_pace pace;
};

/// Begin: set what follows from the springs, before spec_place() of all particles.
void spec_begin(spec_network *network);

/// Set any_shape, after a change of masses or springs.
void spec_renew(spec_network *network);

/// Move the origin to the middle of these places in whole metres, before spec_place() of all particles.
void spec_set_origin(spec_network *network, double min_x, double min_y, double max_x, double max_y);

/// Set a place in world coordinates, or a velocity. Neither changes lag.
void spec_place(spec_network *network, uint32_t particle, double x, double y);
void spec_set_velocity(spec_network *network, uint32_t particle, float vx, float vy);

/// Give an impulse, N s.
void spec_hit(spec_network *network, uint32_t particle, float x, float y);

/// Step by dt seconds.
/// @return  substeps taken, or 0 if more than max_substeps were needed
uint32_t spec_step(spec_network *network, double dt);

/// Choose the substeps of a step and its time: dt, but for SPEC_EVEN. 0: more than max_substeps. spec_pace.c
uint32_t spec_choose_substeps(spec_network *network, double dt, double *time);
bool spec_changes_dt(const spec_network *network, double dt);

/// Set the springs along an element and its reach, after it was added. spec_laws.c
void spec_begin_element(const spec_network *network, spec_element *element);

/// Springs that change. spec_springs.c
void spec_derive_relative(const spec_network *network, float h);
double spec_reduced_mass(const spec_network *network, const spec_spring *spring);
uint32_t spec_changes_by(const spec_network *network, uint32_t substep, uint32_t count); ///< of actuators
void spec_begin_substeps(spec_network *network, uint32_t first, uint32_t count); ///< actuators, one-way springs
void spec_begin_ramp(const spec_network *network, spec_spring *spring, double seconds); ///< of one restored
void spec_follow_ramps(const spec_network *network, double dt);
void spec_break(spec_spring *spring);
void spec_end_step(spec_network *network, double dt);

/// Springs that yield. spec_yield.c
void spec_look(spec_network *network, uint32_t substep);
void spec_yield(spec_network *network);
uint32_t spec_free_of_yield(const spec_network *network, uint32_t first, uint32_t count);
float spec_square_of(const spec_network *network, uint32_t spring); ///< squared length as rows have it. spec.c

/// Forces beside springs. spec_laws.c
uint32_t spec_free_substeps(const spec_network *network, uint32_t first, uint32_t count); ///< taken together
void spec_add_fields(const spec_network *network, uint32_t first);               ///< to spec_network.fields
void spec_find_cells(const spec_network *network); ///< areas that rows have in their sums
void spec_pull_grips(const spec_network *network, uint32_t substep, uint32_t count, float h); ///< spec_grips.c
void spec_add_strengths(const spec_network *network, spec_motion *sums);
double spec_largest_quotient(const spec_network *network, const spec_motion *sums, bool of_damping);

/// Words of coordinates. spec_state.c
float spec_last_place_of(float value); ///< difference of neighbouring floats there
float spec_on_grid(float grid, float coordinate);
void spec_put_coordinate(double x, float grid, float *first, float *low);
void spec_tidy(const spec_network *network);  ///< before and after a step
void spec_follow(spec_network *network);      ///< after a step: the origin follows a network that flies away

/// A coordinate in local coordinates, both words.
double spec_x_of(const spec_network *network, uint32_t particle);
double spec_y_of(const spec_network *network, uint32_t particle);
void spec_put(const spec_network *network, uint32_t particle, double x, double y);

/// Outcome of a substep's floor for a particle.
typedef struct spec_bounce {
    bool acts;
    double x, y, vx, vy;
} spec_bounce;

/// Let the floor act on a particle that a substep of h seconds has moved from network->before to network->motions.
/// Its velocity became keep v + a h / scale, with the acceleration a. spec_floor.c
spec_bounce spec_touch_floor(const spec_network *network, uint32_t particle, double h, double keep, double scale);

/// Move a particle without springs likewise. spec_flight.c
spec_bounce spec_fly(const spec_network *network, uint32_t particle, double h, double keep, double scale);

/// True if a particle without springs takes these seconds substep by substep, because it may meet the floor.
bool spec_may_meet_floor(const spec_network *network, uint32_t particle, double seconds);

/// Let the floor stop a particle that a grip has moved from here: b is where it would be. spec_floor.c
void spec_stop_at_floor(const spec_network *network, double from_x, double from_y, double h, spec_bounce *b);

#endif
