#include "features/angles/angles.h"

#include <math.h>

/// The way along an arm.
typedef struct arm {
    double x, y, square;
} arm;

static arm arm_of(const mspring_network *network, uint32_t from, uint32_t to) {
    const mspringi_state *s = &network->state;
    const double x = mspringi_x_of(s, to) - mspringi_x_of(s, from),
                 y = mspringi_y_of(s, to) - mspringi_y_of(s, from);
    return (arm){x, y, x * x + y * y};
}

// The turn from one to the other. False: there is none.
static bool turn_of(const arm *u, const arm *w, mspringi_rotation *turn) {
    const double length = sqrt(u->square) * sqrt(w->square);
    if (!(length > 0.0))
        return false;
    turn->cosine = (u->x * w->x + u->y * w->y) / length;
    turn->sine = (u->x * w->y - u->y * w->x) / length;
    return true;
}

static double size_by(const mspringi_area *angle, const arm *u, const arm *w) {
    mspringi_rotation turn;
    if (!turn_of(u, w, &turn))
        return 0.0;
    const double cosine = turn.cosine * angle->rest.cosine + turn.sine * angle->rest.sine;
    const double sine = turn.sine * angle->rest.cosine - turn.cosine * angle->rest.sine;
    const double size = cosine > 0.0 ? fabs(sine) * sqrt(2.0 / (1.0 + cosine)) : sqrt(2.0 - 2.0 * cosine);
    return sine < 0.0 ? -size : size;
}

/* --------------------------------------------------------------------------------------------------------- law */

void mspringi_angle_set_rest(mspringi_area *angle, double rest_angle) {
    angle->rest_angle = rest_angle;
    angle->rest = mspringi_rotation_by(rest_angle);
}

mspringi_area mspringi_angle_make(float stiffness, float damping, double rest_angle) {
    mspringi_area made = {
        .is_angle = true, .count = 3, .stiffness = stiffness, .damping = damping, .fill = 1.0f, .rest_area = 1.0};
    mspringi_angle_set_rest(&made, rest_angle);
    return made;
}

double mspringi_angle_size_by(const mspringi_area *angle, const double u[2], const double w[2]) {
    const arm one = {u[0], u[1], u[0] * u[0] + u[1] * u[1]}, other = {w[0], w[1], w[0] * w[0] + w[1] * w[1]};
    return size_by(angle, &one, &other);
}

double mspringi_angle_torque(const void *of, double size) {
    const mspringi_area *angle = of;
    return -(double)angle->stiffness * size * sqrt(fmax(1.0 - 0.25 * size * size, 0.0));
}

double mspringi_angle_stiffness(const void *of, double size) {
    const mspringi_area *angle = of;
    return (double)angle->stiffness * fmax(1.0 - 0.5 * size * size, 0.0);
}

double mspringi_angle_energy(const void *of, double size) {
    const mspringi_area *angle = of;
    return 0.5 * (double)angle->stiffness * size * size;
}

// By how much the end of an arm is ahead of its beginning, turning to the left, rad/s.
static double rate_of(const mspring_network *network, const arm *along, uint32_t from, uint32_t to) {
    const mspringi_state *s = &network->state;
    return ((double)(s->vy[to] - s->vy[from]) * along->x - (double)(s->vx[to] - s->vx[from]) * along->y) /
           along->square;
}

static void push_corners(const mspring_network *network, const mspringi_area *angle, double share,
                         mspringi_field field) {
    const mspringi_corner *corners = network->areas->corners + angle->first;
    const uint32_t a = corners[0].slot, b = corners[1].slot, c = corners[2].slot;
    const arm u = arm_of(network, a, b), w = arm_of(network, b, c);
    if (!(u.square > 0.0 && w.square > 0.0))
        return;
    const double rate = rate_of(network, &w, b, c) - rate_of(network, &u, a, b);
    const double torque =
        share * (mspringi_angle_torque(angle, size_by(angle, &u, &w)) - (double)angle->damping * rate);
    const float ax = mspringi_bounded(-torque * u.y / u.square), ay = mspringi_bounded(torque * u.x / u.square);
    const float cx = mspringi_bounded(-torque * w.y / w.square), cy = mspringi_bounded(torque * w.x / w.square);
    field.x[a] += ax;
    field.y[a] += ay;
    field.x[c] += cx;
    field.y[c] += cy;
    field.x[b] -= mspringi_bounded((double)ax + (double)cx);
    field.y[b] -= mspringi_bounded((double)ay + (double)cy);
}

double mspringi_angle_between(const mspring_network *network, uint32_t a, uint32_t b, uint32_t c) {
    const arm u = arm_of(network, a, b), w = arm_of(network, b, c);
    mspringi_rotation turn;
    return turn_of(&u, &w, &turn) ? mspringi_angle_of(turn) : 0.0;
}

static double angle_between_arms(const mspring_network *network, const mspringi_area *angle) {
    return mspringi_angle_between(network, mspringi_area_slot(network, angle, 0),
                                  mspringi_area_slot(network, angle, 1), mspringi_area_slot(network, angle, 2));
}

static void set_value(mspringi_area *angle, mspring_property property, float value) {
    if (property == MSPRING_ELEMENT_STIFFNESS)
        angle->stiffness = value;
    else if (property == MSPRING_ELEMENT_DAMPING)
        angle->damping = value;
    else
        mspringi_angle_set_rest(angle, (double)value);
}

/* -------------------------------------------------------------------------------------------------- as elements */

static arm arm_at(const mspringi_element_ref *e, const mspringi_positions *at, uint32_t from) {
    const mspringi_vector along = mspringi_way_of(at, e, from, from + 1);
    return (arm){along.x, along.y, along.x * along.x + along.y * along.y};
}

// Gradient of its direction at its far end.
static mspringi_vector gradient_of_arm(arm of) {
    return of.square > 0.0 ? (mspringi_vector){-of.y / of.square, of.x / of.square} : (mspringi_vector){0.0, 0.0};
}

static double angle_size(const mspringi_element_ref *e, const mspringi_positions *at) {
    const arm u = arm_at(e, at, 0), w = arm_at(e, at, 1);
    return size_by(e->of, &u, &w);
}

static mspringi_vector angle_gradient(const mspringi_element_ref *e, const mspringi_positions *at,
                                      uint32_t corner) {
    if (corner != 1)
        return gradient_of_arm(arm_at(e, at, corner / 2));
    const mspringi_vector a = gradient_of_arm(arm_at(e, at, 0)), c = gradient_of_arm(arm_at(e, at, 1));
    return (mspringi_vector){-a.x - c.x, -a.y - c.y};
}

// Turn of an arm by a move. False if its length is 0 before or after.
static bool turn_by(const arm *before, mspringi_vector by, mspringi_rotation *turn) {
    const double x = before->x + by.x, y = before->y + by.y, lengths = sqrt(before->square) * sqrt(x * x + y * y);
    if (!(lengths > 0.0))
        return false;
    turn->cosine = (before->x * x + before->y * y) / lengths;
    turn->sine = (before->x * by.y - before->y * by.x) / lengths;
    return true;
}

// With e the change of the angle: k (cos d - cos(d + e)) = k (cos d (1 - cos e) + sin d sin e). The difference of
// the energies would be lost in rounding.
static double angle_energy_change(const mspringi_element_ref *e, const mspringi_positions *at,
                                  const mspringi_move *move, double *sum) {
    const mspringi_area *angle = e->of;
    mspringi_rotation of_u, of_w;
    const arm u = arm_at(e, at, 0), w = arm_at(e, at, 1);
    const double z = size_by(angle, &u, &w), k = (double)angle->stiffness;
    if (!turn_by(&u, mspringi_move_of(move, e, 0, 1), &of_u) ||
        !turn_by(&w, mspringi_move_of(move, e, 1, 2), &of_w))
        return -mspringi_angle_energy(angle, z); // an arm would vanish: too far
    const double sine = of_w.sine * of_u.cosine - of_w.cosine * of_u.sine;
    const double cosine = of_w.cosine * of_u.cosine + of_w.sine * of_u.sine;
    const double beyond = cosine > 0.0 ? sine * sine / (1.0 + cosine) : 1.0 - cosine;
    const double torque = -mspringi_angle_torque(angle, z);
    *sum += k * beyond + fabs(torque) * (fabs(of_w.sine) + fabs(of_u.sine));
    return k * (1.0 - 0.5 * z * z) * beyond + torque * sine;
}

// Of an arm: A + S or C + S, and a part of the second derivative from its rotation.
static mspringi_side_block block_of_arm(mspringi_vector g, double k, mspringi_side_block s, double part) {
    const double across = 2.0 * part * g.x * g.y;
    return (mspringi_side_block){k * (g.x * g.x + s.xx) - across,
                                 k * (g.x * g.y + s.xy) + part * (g.x * g.x - g.y * g.y),
                                 k * (g.y * g.y + s.yy) + across};
}

static void angle_blocks(const mspringi_element_ref *e, const mspringi_positions *at, bool clamped,
                         mspringi_side_block *blocks) {
    const arm u = arm_at(e, at, 0), w = arm_at(e, at, 1);
    const mspringi_vector a = gradient_of_arm(u), c = gradient_of_arm(w);
    const double z = size_by(e->of, &u, &w), k = mspringi_angle_stiffness(e->of, z);
    const double torque = clamped ? 0.0 : mspringi_angle_torque(e->of, z);
    const mspringi_side_block s = {a.x * c.x, 0.5 * (a.x * c.y + a.y * c.x), a.y * c.y};
    blocks[0] = block_of_arm(a, k, s, torque);
    blocks[1] = block_of_arm(c, k, s, -torque);
    blocks[2] = (mspringi_side_block){-k * s.xx, -k * s.xy, -k * s.yy};
}

// Along an arm 1 / length^2.
static double angle_rest(const mspringi_element_ref *e, const mspringi_positions *at, uint32_t side) {
    if (side == 2)
        return 0.0;
    const mspringi_vector g = gradient_of_arm(arm_at(e, at, side));
    return g.x * g.x + g.y * g.y;
}

static mspringi_element_bound angle_bound(const void *of) {
    const mspringi_area *angle = of;
    return (mspringi_element_bound){(double)angle->stiffness, 0.0};
}

const mspringi_angle_law mspringi_law_of_angles = {{.size = angle_size,
                                                    .gradient = angle_gradient,
                                                    .force = mspringi_angle_torque,
                                                    .stiffness = mspringi_angle_stiffness,
                                                    .energy = mspringi_angle_energy,
                                                    .energy_change = angle_energy_change,
                                                    .blocks = angle_blocks,
                                                    .rest = angle_rest,
                                                    .bound = angle_bound},
                                                   push_corners,
                                                   angle_between_arms,
                                                   set_value};
