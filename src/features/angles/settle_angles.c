/// Angle springs in a problem of statics.
///
/// With g the gradient of the angle at each end, p and q the displacements of both ends relative to the middle, an
/// angle adds
///
///     (g_a . p + g_c . q)^2 = p' (A + S) p + q' (C + S) q - (p - q)' S (p - q),
///     A = g_a g_a',  C = g_c g_c',  S = (g_a g_c' + g_c g_a') / 2
///
/// times its stiffness to the energy. So it is three blocks between pairs of its particles, which have edges of
/// their own in the matrix. Blocks are symmetric, so the antisymmetric part of g_a g_c' is omitted. It scales with
/// the square of the angle's sine: strongly bent beams take more iterations. Forces and energies are exact.
#include "features/angles/angles.h"

#include <math.h>

#include "analysis/settle/equilibrium.h"

static void add_edges(mspringi_statics *statics, const mspringi_areas *all, const mspringi_area *angle) {
    mspringi_statics_springs *s = &statics->springs;
    const mspringi_corner *corners = all->corners + angle->first;
    for (uint32_t pair = 0; pair < 3; ++pair) {
        const uint32_t edge = s->edge_count++;
        s->a[edge] = corners[pair].particle;
        s->b[edge] = corners[(pair + 1) % 3].particle;
        statics->areas.sides[angle->first + pair] = edge;
    }
}

/// Arm in the present shape, and the gradient of its direction at the far end.
typedef struct arm {
    double along[2], x, y;
    uint32_t from, to;
} arm;

static arm arm_of(const mspringi_statics *s, const mspringi_area *angle, uint32_t which) {
    const uint32_t edge = s->areas.sides[angle->first + which];
    const uint32_t a = s->springs.a[edge], b = s->springs.b[edge];
    const double x = (s->start.x[b] - s->start.x[a]) + (s->moved.x[b] - s->moved.x[a]);
    const double y = (s->start.y[b] - s->start.y[a]) + (s->moved.y[b] - s->moved.y[a]);
    const double square = x * x + y * y, inverse = square > 0.0 ? 1.0 / square : 0.0;
    return (arm){{x, y}, -y * inverse, x * inverse, a, b};
}

static double push_particle(mspringi_statics *statics, uint32_t p, double x, double y) {
    statics->force.x[p] += x;
    statics->force.y[p] += y;
    return fmax(fabs(x), fabs(y));
}

static double add_forces(mspringi_statics *statics, const mspringi_area *angle) {
    const arm u = arm_of(statics, angle, 0), w = arm_of(statics, angle, 1);
    const double torque = mspringi_angle_torque(angle, mspringi_angle_size_by(angle, u.along, w.along));
    const double at_a = push_particle(statics, u.from, torque * u.x, torque * u.y);
    const double at_b = push_particle(statics, u.to, -torque * (u.x + w.x), -torque * (u.y + w.y));
    return fmax(fmax(at_a, at_b), push_particle(statics, w.to, torque * w.x, torque * w.y));
}

/* --------------------------------------------------------------------------------------------- change of energy */

// Rotation of an arm along the path. False if its length is 0 before or after.
static bool rotation_of(const mspringi_statics *s, const arm *of, double t, mspringi_rotation *rotation) {
    const uint32_t a = of->from, b = of->to;
    const double dx = t * ((s->step.x[b] - s->step.x[a]) + t * (s->curvature.x[b] - s->curvature.x[a]));
    const double dy = t * ((s->step.y[b] - s->step.y[a]) + t * (s->curvature.y[b] - s->curvature.y[a]));
    const double x = of->along[0], y = of->along[1], to_x = x + dx, to_y = y + dy;
    const double lengths = sqrt(x * x + y * y) * sqrt(to_x * to_x + to_y * to_y);
    if (!(lengths > 0.0))
        return false;
    *rotation = (mspringi_rotation){.cosine = (x * to_x + y * to_y) / lengths, .sine = (x * dy - y * dx) / lengths};
    return true;
}

// With e the change of the angle: k (cos d - cos(d + e)) = k (cos d (1 - cos e) + sin d sin e). The difference of
// the energies would be lost in rounding.
static double energy_change(const mspringi_statics *statics, const mspringi_area *angle, double t, double *size) {
    const arm u = arm_of(statics, angle, 0), w = arm_of(statics, angle, 1);
    const double z = mspringi_angle_size_by(angle, u.along, w.along), k = (double)angle->stiffness;
    mspringi_rotation of_u, of_w;
    if (!rotation_of(statics, &u, t, &of_u) || !rotation_of(statics, &w, t, &of_w))
        return -mspringi_angle_energy(angle, z); // an arm would vanish: too far
    const double sine = of_w.sine * of_u.cosine - of_w.cosine * of_u.sine;
    const double cosine = of_w.cosine * of_u.cosine + of_w.sine * of_u.sine;
    const double beyond = cosine > 0.0 ? sine * sine / (1.0 + cosine) : 1.0 - cosine;
    const double torque = -mspringi_angle_torque(angle, z);
    *size += k * beyond + fabs(torque) * (fabs(of_w.sine) + fabs(of_u.sine));
    return k * (1.0 - 0.5 * z * z) * beyond + torque * sine;
}

/* ---------------------------------------------------------------------------------------------------- stiffness */

static void add_block(mspringi_statics *statics, uint32_t edge, double xx, double xy, double yy) {
    mspringi_statics_springs *s = &statics->springs;
    for (int end = 0; end < 2; ++end) {
        const uint32_t p = end ? s->b[edge] : s->a[edge];
        statics->xx[p] += xx;
        statics->xy[p] += xy;
        statics->yy[p] += yy;
        statics->scale[p] += 0.5 * (fabs(xx) + fabs(yy));
    }
    s->xx[edge] -= xx;
    s->xy[edge] -= xy;
    s->yy[edge] -= yy;
}

// Add the blocks of an arm: A + S or C + S, and a part of the second derivative from its rotation.
static void add_arm(mspringi_statics *statics, uint32_t edge, const arm *of, double k, const double s[3],
                    double part) {
    const double across = 2.0 * part * of->x * of->y;
    add_block(statics, edge, k * (of->x * of->x + s[0]) - across,
              k * (of->x * of->y + s[1]) + part * (of->x * of->x - of->y * of->y),
              k * (of->y * of->y + s[2]) + across);
}

static void add_stiffness(mspringi_statics *statics, const mspringi_area *angle, bool clamped) {
    const arm u = arm_of(statics, angle, 0), w = arm_of(statics, angle, 1);
    const uint32_t *edges = statics->areas.sides + angle->first;
    const double z = mspringi_angle_size_by(angle, u.along, w.along), k = mspringi_angle_stiffness(angle, z);
    const double torque = clamped ? 0.0 : mspringi_angle_torque(angle, z);
    const double s[3] = {u.x * w.x, 0.5 * (u.x * w.y + u.y * w.x), u.y * w.y};
    add_arm(statics, edges[0], &u, k, s, torque);
    add_arm(statics, edges[1], &w, k, s, -torque);
    add_block(statics, edges[2], -k * s[0], -k * s[1], -k * s[2]);
}

const mspringi_angle_statics mspringi_statics_of_angles = {add_edges, add_forces, energy_change, add_stiffness};
