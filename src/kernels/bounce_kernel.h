/// @file bounce_kernel.h
/// Action of a straight surface on one particle in a substep. Branch-free, so that blocks of particles
/// (floor_kernel.h, free_kernel.h) and single ones (features/contact/floor_bounce.c) take the same operations.
///
/// After a leapfrog substep, velocities lag half a substep behind. For linear springs the integrator
/// conserves exactly
///     E~ = T(w) + V - h^2/8 F . F / m,   with w = v + h/2 F/m, the velocity in step with the positions,
/// in which an impulse changes w only. So contact acts at x, before the move, on w = (v + v') / 2. It neither moves
/// x nor increases |w|, so it dissipates energy whatever the forces are.
///
/// With global damping v' = d v + g F/m (see mspringi_gain()). Damping acts at x too, before the contact, which
/// acts on its result: w = v' - h/2 F/m, with F/m = (v' - d v) / g. As a part of F it would act on the velocity
/// after contact.
///
/// If the substep before was shorter, of length l, E~ came with l^2/8 instead of h^2/8. So contact may leave
/// |w|^2 larger by (1 - (l/h)^2) |h/2 F/m|^2. Rest, v' = 0, takes just that. (Without it, bodies crept down slopes
/// by 1 mm a minute where dt varied by 2 %.)
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BOUNCE_KERNEL_H
#define MSPRINGI_BOUNCE_KERNEL_H

#include "kernels/kernels.h"

#include <math.h>

#if defined(_MSC_VER)
#define MSPRINGI_BOUNCE_INLINE static __forceinline
#else
#define MSPRINGI_BOUNCE_INLINE static inline __attribute__((always_inline))
#endif

/// Friction and restitution of a surface and a particle, as of two bodies. The root of a square is exact, so equal
/// values have the bits of the surface's alone.
static inline double mspringi_mixed_friction(double of_surface, const mspringi_contact_material *own) {
    return own->friction >= 0.0f ? sqrt((double)own->friction * of_surface) : of_surface;
}
static inline double mspringi_mixed_restitution(double of_surface, const mspringi_contact_material *own) {
    return (double)own->restitution > of_surface ? (double)own->restitution : of_surface;
}

/// Restitution that counts as none: such particles land exactly, others bounce from their present position.
#define MSPRINGI_MIN_RESTITUTION 0.1

/// Margin for rounding where |w|^2 must not grow.
#define MSPRINGI_GROWTH_MARGIN (1.0 + 1e-9)

/// A particle with springs before its move.
typedef struct mspringi_bouncing_particle {
    double x, y;           ///< before the substep, m
    double vx, vy;         ///< velocity of the move, m/s
    double half_x, half_y; ///< half of its change by forces, m/s
    double max_restitution;
    double slack; ///< 1 - (l/h)^2 if the substep before was shorter, else 0
    double spare; ///< growth of |w|^2 that slack allows, (m/s)^2; 0 once a surface has acted
    const mspringi_contact_material *own; ///< NULL: none. Kernels have it for whole blocks
} mspringi_bouncing_particle;

/// Twice the kinetic energy per mass, in step, with what contact may add.
static inline double mspringi_bouncing_particle_square(const mspringi_bouncing_particle *p) {
    const double wx = p->vx - p->half_x, wy = p->vy - p->half_y;
    return (wx * wx + wy * wy) + p->spare;
}

/// Largest share of a velocity that damping takes in a substep for slack to be known, and what l/h may be off by
/// rounding: scale and the share come from single precision.
#define MSPRINGI_SLACK_LOSS 0.05
#define MSPRINGI_SLACK_ROUNDING 1e-5

/// Slack of a substep. Forces acted for (l + h)/2, which is -log(keep) / (1 - keep) h / scale.
static inline double mspringi_slack_of(mspringi_damping damping) {
    if (damping.scale <= 1.0)
        return 0.0;
    const double u = 1.0 - damping.keep;
    const double series = 1.0 + u * (1.0 / 2 + u * (1.0 / 3 + u * (1.0 / 4 + u * (1.0 / 5 + u * (1.0 / 6)))));
    const double share = 2.0 * series / damping.scale - 1.0;
    return ((share < 1.0 - MSPRINGI_SLACK_ROUNDING) & (u < MSPRINGI_SLACK_LOSS)) ? 1.0 - share * share : 0.0;
}

/// Change of a velocity by acceleration alone in a substep, in which it went from `from` to `to`.
static inline double mspringi_pushed(mspringi_damping damping, double from, double to) {
    return damping.scale * (to - damping.keep * from);
}

/// Particle that has moved to (x, y) at (vx, vy), with (from_vx, from_vy) before, if there is no slack. per_length
/// is 4 h / l.
///
/// If particles move a large part of their springs' length in a substep, h |w| = s l, the integrator itself gains
/// energy from a bounce. So restitution is at most 1 - (4 s)^2. Of 300 bodies of 2 to 20 particles that fall 10 m
/// at restitution 1, 1 instead of 94 gain more energy than the free ones, at 0.5 of the substep that is stable in
/// any shape.
static inline mspringi_bouncing_particle mspringi_taut_particle_from(double x, double y, double vx, double vy,
                                                                     double from_vx, double from_vy,
                                                                     mspringi_damping damping, double h,
                                                                     double per_length) {
    mspringi_bouncing_particle p = {.x = x - h * vx,
                                    .y = y - h * vy,
                                    .vx = vx,
                                    .vy = vy,
                                    .half_x = 0.5 * mspringi_pushed(damping, from_vx, vx),
                                    .half_y = 0.5 * mspringi_pushed(damping, from_vy, vy)};
    const double most = 1.0 - per_length * per_length * mspringi_bouncing_particle_square(&p);
    p.max_restitution = most > 0.0 ? most : 0.0;
    return p;
}

/// The particle with slack.
static inline mspringi_bouncing_particle mspringi_bouncing_particle_from(double x, double y, double vx, double vy,
                                                                         double from_vx, double from_vy,
                                                                         mspringi_damping damping, double h,
                                                                         double per_length) {
    mspringi_bouncing_particle p =
        mspringi_taut_particle_from(x, y, vx, vy, from_vx, from_vy, damping, h, per_length);
    p.slack = mspringi_slack_of(damping);
    p.spare = p.slack * (p.half_x * p.half_x + p.half_y * p.half_y);
    return p;
}

/// Change of a tangential velocity by friction, at most `most`.
static inline double mspringi_clamp_friction(double along, double most) {
    const double least = -most, not_less = along < least ? least : along;
    return along > most ? most : not_less;
}

/// Let a surface act on a particle that would end more than `allowed` below it. It bounces from its present
/// position if that is fast enough to leave; else it lands on the surface. Returns 1 if the surface acts, else 0.
MSPRINGI_BOUNCE_INLINE double mspringi_bounce(double nx, double ny, double offset, double friction,
                                              double restitution, double h, double allowed,
                                              mspringi_bouncing_particle *p) {
    const double distance = nx * p->x + ny * p->y + offset;
    const double normal_speed = nx * p->vx + ny * p->vy;
    const bool acts = distance + h * normal_speed < -allowed;
    const double depth = distance < 0.0 ? distance : 0.0;
    const double half = nx * p->half_x + ny * p->half_y;
    const double inward = half - normal_speed; // in step
    const double e = restitution < p->max_restitution ? restitution : p->max_restitution;
    const double bounce_speed = e * inward + half;
    const double landing_speed = (depth - distance) / h;
    const bool bounces = (inward > 0.0) & (bounce_speed > landing_speed) & (e > MSPRINGI_MIN_RESTITUTION);
    const double target_speed = bounces ? bounce_speed : landing_speed;
    const double end_speed = target_speed > normal_speed ? target_speed : normal_speed;
    const double normal_change = end_speed - normal_speed;
    // Friction slows the particle along the surface, and speeds it up, in step, by no more than slack.
    const double tangent_speed = nx * p->vy - ny * p->vx, tangent_half = nx * p->half_y - ny * p->half_x;
    const double tangent_in_step = tangent_speed - tangent_half, moves = fabs(tangent_in_step);
    const double tangent_braked =
        tangent_in_step - mspringi_clamp_friction(tangent_speed, friction * normal_change);
    const double square = tangent_in_step * tangent_in_step + p->slack * (tangent_half * tangent_half);
    const double most = p->slack > 0.0 ? sqrt(square) : moves;
    const double tangent_end = fabs(tangent_braked) > most * MSPRINGI_GROWTH_MARGIN
                                   ? (tangent_braked > 0.0 ? most : -most)
                                   : tangent_braked;
    const double tangent_change = tangent_in_step - tangent_end;
    const double vx = p->vx + (normal_change * nx + tangent_change * ny),
                 vy = p->vy + (normal_change * ny - tangent_change * nx);
    const double x = p->x - depth * nx, y = p->y - depth * ny;
    p->vx = acts ? vx : p->vx;
    p->vy = acts ? vy : p->vy;
    p->x = acts ? x : p->x;
    p->y = acts ? y : p->y;
    p->spare = acts ? 0.0 : p->spare;
    return acts ? 1.0 : 0.0;
}

/* ----------------------------------------------------------------------------------------------- free particles */

/// A particle without springs, on a parabola.
typedef struct mspringi_free_particle {
    double x, y;
    double wx, wy;                        ///< in step with the position
    double ax, ay;                        ///< acceleration, m/s^2
    double left;                          ///< rest of the substep, s
    const mspringi_contact_material *own; ///< as in mspringi_bouncing_particle
} mspringi_free_particle;

/// As mspringi_bouncing_particle_from().
static inline mspringi_free_particle mspringi_free_particle_from(double x, double y, double vx, double vy,
                                                                 double from_vx, double from_vy,
                                                                 mspringi_damping damping, double h) {
    const double change_x = mspringi_pushed(damping, from_vx, vx), change_y = mspringi_pushed(damping, from_vy, vy);
    return (mspringi_free_particle){.x = x - h * vx,
                                    .y = y - h * vy,
                                    .wx = vx - 0.5 * change_x,
                                    .wy = vy - 0.5 * change_y,
                                    .ax = change_x / h,
                                    .ay = change_y / h,
                                    .left = h};
}

/// Parameters of a bounce.
typedef struct mspringi_bounce_params {
    double h;    ///< length of the substep, s
    double skew; ///< lag of stored velocities behind w, s: h / 2, or 0 after implicit substeps
} mspringi_bounce_params;

/// Rounding of a tangential velocity in its normal part, relative.
#define MSPRINGI_TANGENT_ROUNDING 0x1p-22

/// Distance that counts as contact, m: far below the last places of coordinates.
static inline double mspringi_flight_slop(double x, double y) {
    return 0x1p-31 * (fabs(x) + fabs(y)) + 1e-15;
}

/// Time until the particle meets a surface that it would end below, s; INFINITY if it would not.
static inline double mspringi_time_to_surface(double nx, double ny, double offset, double slop,
                                              const mspringi_free_particle *p) {
    const double distance = nx * p->x + ny * p->y + offset;
    const double speed = nx * p->wx + ny * p->wy, pull = nx * p->ax + ny * p->ay;
    const double end = distance + p->left * (speed + 0.5 * p->left * pull);
    const double above = distance > 0.0 ? distance : 0.0;
    const double square = speed * speed - 2.0 * pull * above;
    const double root = sqrt(square > 0.0 ? square : 0.0);
    const bool falls = speed <= 0.0;
    const double way = falls ? 2.0 * above : speed + root;
    const double rate = falls ? root - speed : -pull;
    const double time = way / (rate > 0.0 ? rate : 1.0);
    const double some = ((rate > 0.0) & (time > 0.0)) ? time : 0.0;
    const double before_end = some < p->left ? some : p->left;
    return end < -slop ? before_end : INFINITY;
}

/// Deflect a particle where it meets a surface after `time`. It bounces, or lies on the surface for the rest of the
/// substep: if this is the last deflection, or if the bounce would be shorter than a substep. Returns true if it
/// bounces.
///
/// At rest v = 0, so w = h a / 2: it counts for friction, not for a bounce. The normal part of a sliding velocity
/// has rounding errors. At restitution 1 these made particles bounce from rest.
static inline bool mspringi_bounce_free(double nx, double ny, double offset, double friction, double restitution,
                                        const mspringi_bounce_params *how, double time, bool is_last,
                                        mspringi_free_particle *p) {
    const double x = p->x + time * (p->wx + 0.5 * time * p->ax), y = p->y + time * (p->wy + 0.5 * time * p->ay);
    const double wx = p->wx + time * p->ax, wy = p->wy + time * p->ay, time_left = p->left - time;
    const double distance = nx * x + ny * y + offset;
    const double normal_speed = nx * wx + ny * wy, tangent_speed = nx * wy - ny * wx;
    const double normal_pull = nx * p->ax + ny * p->ay, tangent_pull = nx * p->ay - ny * p->ax;
    const double inward = normal_speed < 0.0 ? -normal_speed : 0.0,
                 pressing = normal_pull < 0.0 ? -normal_pull : 0.0;
    const double bounce_speed = restitution * inward, rest = time_left - how->skew;
    const bool is_resting =
        is_last | (bounce_speed <= 0.5 * how->h * pressing + MSPRINGI_TANGENT_ROUNDING * fabs(tangent_speed));
    const double pressed_speed = inward - rest * normal_pull;
    const double normal_change = is_resting ? (pressed_speed > 0.0 ? pressed_speed : 0.0) : bounce_speed + inward;
    const double sliding_speed = is_resting ? tangent_speed + rest * tangent_pull : tangent_speed;
    const double tangent_end = sliding_speed - mspringi_clamp_friction(sliding_speed, friction * normal_change),
                 end_speed = is_resting ? 0.0 : bounce_speed;
    p->x = x - distance * nx;
    p->y = y - distance * ny;
    p->wx = end_speed * nx - tangent_end * ny;
    p->wy = end_speed * ny + tangent_end * nx;
    p->ax = is_resting ? 0.0 : p->ax;
    p->ay = is_resting ? 0.0 : p->ay;
    p->left = is_last ? 0.0 : time_left;
    return !is_resting;
}

/// Deflections of a particle in a substep.
#define MSPRINGI_MAX_DEFLECTIONS 8

/* --------------------------------------------------------------------------------------------------------- silt */

/// Height of a field of heights. place: distance from the first one, in spacings.
MSPRINGI_BOUNCE_INLINE double mspringi_height_at(const float *heights, uint32_t count, double place) {
    const double last = (double)(count - 1), not_less = place >= 0.0 ? place : 0.0;
    const double within = not_less < last ? not_less : last;
    const int32_t knot = (int32_t)within, last_part = (int32_t)count - 2,
                  part = knot < last_part ? knot : last_part;
    const double low = (double)heights[part], high = (double)heights[part + 1];
    return low + (within - (double)part) * (high - low);
}

/// Fraction of a velocity that silt takes in a substep of implicit Euler: v' = v - h rate share v'. rate_h is rate
/// times h; share is 1 at the ground and 0 from depth above it.
static inline double mspringi_silt_damping_at(double above, double depth, double rate_h) {
    const double share = 1.0 - above / depth, some = share > 0.0 ? share : 0.0;
    const double brakes = rate_h * (some < 1.0 ? some : 1.0);
    return brakes / (1.0 + brakes);
}

/// The same where the depth varies, and may be 0.
MSPRINGI_BOUNCE_INLINE double mspringi_uneven_silt_damping_at(double above, double depth, double rate_h) {
    const bool is_deep = depth > 0.0;
    const double fraction = mspringi_silt_damping_at(above, is_deep ? depth : 1.0, rate_h);
    return is_deep ? fraction : 0.0;
}

#endif
