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

static double angle_size(const mspring_network *network, const mspringi_area *angle) {
    const uint32_t middle = mspringi_area_slot(network, angle, 1);
    const arm u = arm_of(network, mspringi_area_slot(network, angle, 0), middle),
              w = arm_of(network, middle, mspringi_area_slot(network, angle, 2));
    return size_by(angle, &u, &w);
}

double mspringi_angle_size_by(const mspringi_area *angle, const double u[2], const double w[2]) {
    const arm one = {u[0], u[1], u[0] * u[0] + u[1] * u[1]}, other = {w[0], w[1], w[0] * w[0] + w[1] * w[1]};
    return size_by(angle, &one, &other);
}

double mspringi_angle_torque(const mspringi_area *angle, double size) {
    return -(double)angle->stiffness * size * sqrt(fmax(1.0 - 0.25 * size * size, 0.0));
}

double mspringi_angle_stiffness(const mspringi_area *angle, double size) {
    return (double)angle->stiffness * fmax(1.0 - 0.5 * size * size, 0.0);
}

double mspringi_angle_energy(const mspringi_area *angle, double size) {
    return 0.5 * (double)angle->stiffness * size * size;
}

static mspringi_area_end angle_end_of(const mspring_network *network, const mspringi_area *angle, uint32_t corner) {
    const uint32_t middle = mspringi_area_slot(network, angle, 1);
    const uint32_t ends[2] = {mspringi_area_slot(network, angle, 0), mspringi_area_slot(network, angle, 2)};
    mspringi_area_end all[3] = {{ends[0], 0.0, 0.0}, {middle, 0.0, 0.0}, {ends[1], 0.0, 0.0}};
    const arm arms[2] = {arm_of(network, ends[0], middle), arm_of(network, middle, ends[1])};
    for (int i = 0; i < 2; ++i) {
        if (!(arms[i].square > 0.0))
            continue;
        all[2 * i].x = -arms[i].y / arms[i].square;
        all[2 * i].y = arms[i].x / arms[i].square;
        all[1].x -= all[2 * i].x;
        all[1].y -= all[2 * i].y;
    }
    return all[corner];
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

const mspringi_angle_law mspringi_law_of_angles = {
    angle_size,   mspringi_angle_size_by, mspringi_angle_torque, mspringi_angle_stiffness, mspringi_angle_energy,
    angle_end_of, push_corners,           angle_between_arms};
