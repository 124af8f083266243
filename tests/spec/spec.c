/// @file spec.c
/// Specification of the explicit solver: a plain program that gives the library's bits at every level of
/// instructions and for any number of workers. test_spec.c compares both.
///
/// **Files.** spec.h: state and input. spec.c: a step. spec_state.c: words, edits and the origin. spec_springs.c:
/// springs that change. spec_yield.c: springs that yield. spec_laws.c: areas, angles, hooks. spec_grips.c: grips.
/// spec_floor.c and spec_flight.c: the floor. spec_pace.c: automatic substeps. arrange.c and lattices.c: which springs
/// are summed by rows, an input to spec.c.
///
/// **Covered.** Springs, dampers and welds in lattices, chains and irregular parts; relative and one-way springs;
/// springs that yield or break in a step, ramps, actuators; areas, also around cells of lattices, and angle springs;
/// grips, also several on one particle; particles without springs; added particles and springs; pins; gravity; forces
/// of the host and of hooks, with a period, too; global damping; floors; MSPRING_NETWORK_PRECISE; the first kick and
/// uneven dt; MSPRING_SUBSTEPS_AUTO and _EVEN; the local origin; between steps edits of positions, velocities, masses
/// and springs, impulses and broken springs.
///
/// **Not covered.** Silt; actuators of springs that yield or are on ramps; yielding one-way and relative springs; at a
/// floor, particles whose only springs were added; new layouts, scales of inverse masses, contact, sleep, groups, the
/// guard, other solvers.
///
/// **Arithmetic.** IEEE 754, rounded to nearest even, subnormal numbers included. An operation of floats gives a
/// float, one of doubles a double. Nothing is fused; parentheses say which operation comes first, else the left one
/// does. Division and square root are correctly rounded. No function of libm is needed but fabs, floor, sqrt,
/// minimum and maximum. A zero force may have either sign: no bit depends on it.
///
/// **Order.** Each substep reads the state before it, so particles may be visited in any order. Only the order of
/// the forces on one particle matters: see add_rows() and add_others().
///
/// SPDX-License-Identifier: MIT
#include "spec.h"

#include <float.h>
#include <math.h>
#include <string.h>

/// Squared length up to which a spring has no direction and no force, m^2.
#define NO_DIRECTION 1e-37f

/// Speed that counts as none, m/s.
#define NO_SPEED 1e-30f

/* ------------------------------------------------------------------------------------------------ small numbers */

static float flushed(float speed) {
    return fabsf(speed) < NO_SPEED ? 0.0f : speed;
}

// A float without its last 12 bits: its square is exact.
static float lead(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits &= 0xfffff000u;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static spec_vector add(spec_vector a, spec_vector b) {
    return (spec_vector){a.x + b.x, a.y + b.y};
}

/* ----------------------------------------------------------------------------------------------- global damping */

// 1 - exp(-x), by a series in x, or in the part x / 2^n below 1/8.
static double loss(double x) {
    double sum = 1.0;
    if (x < 0.125) {
        for (int power = 9; power >= 2; power--) {
            sum = 1.0 - x / (double)power * sum;
        }
        return x * sum;
    }
    double part = (double)(float)x;
    int squarings = 0;
    for (; part >= 0.125 && part < 104.0; squarings++) {
        part *= 0.5;
    }
    if (!(part < 104.0)) {
        return 1.0;
    }
    for (int power = 9; power >= 1; power--) {
        sum = 1.0 - part / (double)power * sum;
    }
    for (; squarings > 0; squarings--) {
        sum *= sum;
    }
    return 1.0 - (double)(float)sum;
}

// Share of a velocity that global damping takes in some time.
static float loss_in(float rate, float time) {
    return (float)loss((double)rate * (double)time);
}

// Change of velocity per acceleration in some time, s.
static float gain_in(float rate, float time) {
    return rate > 0.0f ? (float)(loss((double)rate * (double)time) / (double)rate) : time;
}

/* -------------------------------------------------------------------------------------------- force of a spring */

// The length L times the extension in a precise network: L (L - r) + (d^2 - L^2) / 2. The second term makes up for
// the rounding of the root. It is exact but for its last sums: squares of leading halves are.
static float precise_stretch(spec_vector high, spec_vector low, spec_vector d, float rest_length, float *square) {
    const float lead_x = lead(d.x), lead_y = lead(d.y);
    const float rest_x = (high.x - lead_x) + low.x, rest_y = (high.y - lead_y) + low.y;
    const float square_x = lead_x * lead_x, square_y = lead_y * lead_y;
    const float rest = rest_x * (lead_x + d.x) + rest_y * (lead_y + d.y);
    *square = (square_x + square_y) + rest;
    const float length = sqrtf(*square), lead_length = lead(length), rest_of_length = length - lead_length;
    const float larger = square_x > square_y ? square_x : square_y,
                smaller = square_x < square_y ? square_x : square_y;
    const float error =
        ((larger - lead_length * lead_length) + smaller) + (rest - rest_of_length * (lead_length + length));
    return length * (length - rest_length) + 0.5f * error;
}

float spec_square_of(const spec_network *network, uint32_t spring) {
    const spec_spring *s = &network->springs[spring];
    const spec_motion *a = &network->motions[s->a], *b = &network->motions[s->b];
    const spec_vector d = {b->place.x - a->place.x, b->place.y - a->place.y};
    const spec_vector low = {b->low_place.x - a->low_place.x, b->low_place.y - a->low_place.y};
    float square = d.x * d.x + d.y * d.y;
    if (network->is_precise) {
        (void)precise_stretch(d, low, add(d, low), s->rest_length, &square);
    }
    return square;
}

// Force of a spring on one of its ends, with d from here to there:
//     F = (k (L - r) L + c (dv . d)) / L^2 d
// That on the other is the opposite, bit for bit.
static spec_vector pull(const spec_network *network, uint32_t spring, uint32_t particle) {
    const spec_spring *s = &network->springs[spring];
    const bool acts = !s->is_broken && !s->is_slack;
    const float stiffness = acts ? s->stiffness : 0.0f, damping = acts ? s->damping : 0.0f;
    const float rest_length = s->rest_length > 0.0f ? s->rest_length : SPEC_WELD;
    const spec_motion *here = &network->before[particle], *there = &network->before[s->a == particle ? s->b : s->a];
    spec_vector d = {there->place.x - here->place.x, there->place.y - here->place.y};
    float square, force;
    if (network->is_precise) {
        const spec_vector high = d,
                          low = {there->low_place.x - here->low_place.x, there->low_place.y - here->low_place.y};
        d = add(high, low);
        force = precise_stretch(high, low, d, rest_length, &square) * stiffness;
    } else {
        square = d.x * d.x + d.y * d.y;
        const float length = sqrtf(square);
        force = (length - rest_length) * (length * stiffness);
    }
    const spec_vector dv = {there->velocity.x - here->velocity.x, there->velocity.y - here->velocity.y};
    const float rate = dv.x * d.x + dv.y * d.y;
    force = force + rate * damping;
    force = force * (square > NO_DIRECTION ? 1.0f / square : 0.0f);
    return (spec_vector){force * d.x, force * d.y};
}

/* ------------------------------------------------------------------------------------------------ order of sums */

static bool has_springs(const spec_sums *sums) {
    return sums->is_in_rows || sums->other_count > 0;
}

// A way between particles, a - b.
static spec_vector between(const spec_network *network, uint32_t a, uint32_t b) {
    const spec_motion *m = &network->before[a], *n = &network->before[b];
    const spec_vector d = {m->place.x - n->place.x, m->place.y - n->place.y};
    const spec_vector low = {m->low_place.x - n->low_place.x, m->low_place.y - n->low_place.y};
    return network->is_precise ? add(d, low) : d;
}

// Add to the force of a diagonal on one end that of the area around its cell: with the diagonals D and D', it is
// half the pressure times the other diagonal, across.
static spec_vector add_cells(const spec_network *network, uint32_t p, uint32_t corner, spec_vector force) {
    for (uint32_t k = 0; k < network->element_count; k++) {
        const spec_element *e = &network->elements[k];
        if (e->cell[0] == SPEC_NONE || e->cell[corner] != p) {
            continue;
        }
        const spec_vector up = between(network, e->cell[0], e->cell[2]), down = between(network, e->cell[1], e->cell[3]);
        const float half = e->cell_force - e->cell_decrease * (up.x * down.y - up.y * down.x);
        const spec_vector across = corner % 2 == 0 ? (spec_vector){half * down.y, -(half * down.x)}
                                                   : (spec_vector){-(half * up.y), half * up.x};
        force = corner < 2 ? add(force, across) : add(force, (spec_vector){-across.x, -across.y});
    }
    return force;
}

static spec_vector pull_from(const spec_network *network, uint32_t particle, spec_side side) {
    const uint32_t spring = network->sums[particle].rows[side];
    const spec_vector force = spring == SPEC_NONE ? (spec_vector){0.0f, 0.0f} : pull(network, spring, particle);
    switch (side) { // the corner of the cell that the particle is
    case SPEC_NORTH_EAST:
        return add_cells(network, particle, 0, force);
    case SPEC_NORTH_WEST:
        return add_cells(network, particle, 1, force);
    case SPEC_SOUTH_WEST:
        return add_cells(network, particle, 2, force);
    case SPEC_SOUTH_EAST:
        return add_cells(network, particle, 3, force);
    default:
        return force;
    }
}

// Sum of the springs in rows: those that lead south come first, then west, east, north. Pairs are added before they
// enter the sum. In the top row of a lattice, and in chains, east comes before west.
static spec_vector add_rows(const spec_network *network, uint32_t p) {
    const spec_vector east = pull_from(network, p, SPEC_EAST), west = pull_from(network, p, SPEC_WEST);
    const spec_vector north = pull_from(network, p, SPEC_NORTH), south = pull_from(network, p, SPEC_SOUTH);
    const spec_vector north_east = pull_from(network, p, SPEC_NORTH_EAST);
    const spec_vector north_west = pull_from(network, p, SPEC_NORTH_WEST);
    const spec_vector below =
        add(add(pull_from(network, p, SPEC_SOUTH_EAST), south), pull_from(network, p, SPEC_SOUTH_WEST));
    if (network->sums[p].is_top) {
        return add(add(below, east), west);
    }
    return add(add(add(below, add(west, north_west)), add(east, north)), north_east);
}

static bool is_added_to(const spec_network *network, uint32_t spring, uint32_t p) {
    const spec_spring *s = &network->springs[spring];
    return (s->a == p || s->b == p) && !s->is_broken;
}

static bool has_added(const spec_network *network, uint32_t p) {
    bool any = false;
    for (uint32_t i = network->first_added; i < network->spring_count; i++) {
        any |= is_added_to(network, i, p);
    }
    return any;
}

// Sum of the other springs, by rising number, from 0.
static spec_vector add_others(const spec_network *network, uint32_t p) {
    const spec_sums *sums = &network->sums[p];
    spec_vector force = {0.0f, 0.0f};
    for (uint32_t i = 0; i < sums->other_count; i++) {
        force = add(force, pull(network, network->others[sums->first_other + i], p));
    }
    return force;
}

// Sum of the springs that were added, likewise.
static spec_vector add_added(const spec_network *network, uint32_t p) {
    spec_vector force = {0.0f, 0.0f};
    for (uint32_t i = network->first_added; i < network->spring_count; i++) {
        force = is_added_to(network, i, p) ? add(force, pull(network, i, p)) : force;
    }
    return force;
}

/* ------------------------------------------------------------------------------------------ motion in a substep */

/// Constants of a step.
typedef struct step {
    uint32_t count;        ///< substeps
    uint32_t first, end;   ///< those that are taken together
    float h;               ///< of one, s
    float spring_lag, lag; ///< substep before the step, s, for springs and for gravity
} step;

/// Constants of a substep.
typedef struct substep {
    float h;                    ///< s
    float kick, gravity_kick;   ///< s, change of velocity per acceleration by springs and by gravity
    float damping;              ///< share of a velocity that global damping takes
    float loss;                 ///< the same with the dither of the substep
    float gravity_x, gravity_y; ///< change of velocity, m/s
    bool flushes;               ///< tiny speeds become 0
} substep;

// Velocities are scaled by 1 - d, with a d of up to 2^-19 that differs from substep to substep, so that roundings
// average out. Four substeps have +, -, - and + the same d, so nothing is left of it; fewer at the end have none.
// Precise networks do without, and those without gravity.
static float dither(const spec_network *network, uint32_t number, uint32_t count) {
    const uint32_t four = number / 4, fraction = (2 * four + 1) * 0x4f1bbcddu;
    const float d = (float)(fraction >> 8) * 0x1p-43f;
    if (network->is_precise || (network->gravity_x == 0.0f && network->gravity_y == 0.0f) || four == count / 4) {
        return 0.0f;
    }
    return number % 4 == 0 || number % 4 == 3 ? d : -d;
}

// Velocities are half a substep old: v(t - h/2) becomes v(t + h/2). So the first kick of a step lasts (lag + h) /
// 2, with lag the last substep before it, and 0 if velocities are of now. Damped and precise networks drop tiny
// speeds in every second substep, lest subnormal ones spread.
static substep substep_of(const spec_network *network, const step *all, uint32_t number) {
    const float rate = network->global_damping, h = all->h;
    const float time = number == 0 ? 0.5f * (all->spring_lag + h) : h;
    const float gravity_kick = gain_in(rate, number == 0 ? 0.5f * (all->lag + h) : h);
    return (substep){.h = h,
                     .kick = gain_in(rate, time),
                     .gravity_kick = gravity_kick,
                     .damping = loss_in(rate, time),
                     .loss = loss_in(rate, time) + dither(network, number, all->count),
                     .gravity_x = network->gravity_x * gravity_kick + 0.0f, // never -0
                     .gravity_y = network->gravity_y * gravity_kick + 0.0f,
                     .flushes = (network->is_damped || network->is_precise) && number % 2 == 0};
}

// Kick of a velocity in two words.
static void kick_precisely(float *v, float *low, float push, float gravity, float loss, bool flushes) {
    const float change = (push + (*low + gravity)) - loss * *v, sum = *v + change;
    const float to = flushes ? flushed(sum) : sum, rest = change - (to - *v);
    *low = flushes ? flushed(rest) : rest;
    *v = to;
}

// Kick of a velocity: v' = v + (F kick / m + (g kick - loss v)), in two words if the network is precise.
static void kick(const spec_network *network, const substep *now, float *v, float *low, float push, float gravity) {
    if (!network->is_precise) {
        const float to = *v + (push + (gravity - now->loss * *v));
        *v = now->flushes ? flushed(to) : to;
        return;
    }
    kick_precisely(v, low, push, gravity, now->loss, now->flushes);
}

// Kick of a particle in rows by its other springs: it comes second, after its move.
static void add_kick(const spec_network *network, float *v, float *low, float push) {
    const float change = network->is_precise ? push + *low : push, to = *v + change;
    *low = network->is_precise ? change - (to - *v) : 0.0f;
    *v = to;
}

// Kahan's compensated sum: the low word keeps what the first word can't.
static void move(const spec_network *network, float *x, float *low, float way) {
    const float whole = way + *low, to = spec_on_grid(network->grid, *x + whole);
    *low = whole - (to - *x);
    *x = to;
}

// Add a kick and a move of their own for springs that act after the move of their particle.
static void push_on(const spec_network *network, const substep *now, uint32_t p, spec_vector force) {
    const float per_force = network->inverse_masses[p] * now->kick;
    const float push_x = force.x * per_force, push_y = force.y * per_force;
    spec_motion *m = &network->motions[p];
    if (network->inverse_masses[p] > 0.0f) {
        add_kick(network, &m->velocity.x, &m->low_velocity.x, push_x);
        add_kick(network, &m->velocity.y, &m->low_velocity.y, push_y);
        move(network, &m->place.x, &m->low_place.x, push_x * now->h);
        move(network, &m->place.y, &m->low_place.y, push_y * now->h);
    }
}

static void move_particle(const spec_network *network, const substep *now, uint32_t p) {
    const spec_sums *sums = &network->sums[p];
    const float inverse_mass = network->inverse_masses[p], per_force = inverse_mass * now->kick;
    spec_motion *m = &network->motions[p];
    if (inverse_mass > 0.0f) {
        const spec_vector springs = sums->is_in_rows ? add_rows(network, p) : add_others(network, p);
        const spec_vector force = add(springs, network->fields[p]);
        kick(network, now, &m->velocity.x, &m->low_velocity.x, force.x * per_force, now->gravity_x);
        kick(network, now, &m->velocity.y, &m->low_velocity.y, force.y * per_force, now->gravity_y);
    } else {
        m->low_velocity = (spec_vector){0.0f, 0.0f}; // a pin keeps its velocity
    }
    move(network, &m->place.x, &m->low_place.x, m->velocity.x * now->h);
    move(network, &m->place.y, &m->low_place.y, m->velocity.y * now->h);
    if (sums->is_in_rows && sums->other_count > 0) {
        push_on(network, now, p, add_others(network, p));
    }
}

/// Motion of particles without springs in all substeps that are taken together: v' = keep v + (gain a + gravity), x' = x + (reach
/// v + (fall a + gravity_way)). loss: 1 - keep.
typedef struct glide {
    float keep, loss, gain, reach, fall, drift;
    spec_vector gravity, gravity_way;
} glide;

static glide glide_of(const spec_network *network, const step *all) {
    double keep = 1.0, gain = 0.0, reach = 0.0, fall = 0.0, gravity_gain = 0.0, gravity_fall = 0.0;
    const double h = (double)all->h, ax = (double)network->gravity_x, ay = (double)network->gravity_y;
    for (uint32_t i = all->first; i < all->end; i++) {
        const substep now = substep_of(network, all, i);
        keep -= (double)now.damping * keep;
        gain += (double)now.kick - (double)now.damping * gain;
        reach += keep * h;
        fall += gain * h;
        gravity_gain += (double)now.gravity_kick - (double)now.damping * gravity_gain;
        gravity_fall += gravity_gain * h;
    }
    return (glide){(float)keep,
                   (float)(1.0 - keep),
                   (float)gain,
                   (float)reach,
                   (float)fall,
                   (float)(h * (double)(all->end - all->first)),
                   {(float)(gravity_gain * ax), (float)(gravity_gain * ay)},
                   {(float)(gravity_fall * ax), (float)(gravity_fall * ay)}};
}

static void glide_along(const spec_network *network, const glide *g, uint32_t p, float *x, float *low_x, float *v,
                        float *low_v, float force, float gravity, float gravity_way) {
    const float a = force * network->inverse_masses[p];
    if (network->inverse_masses[p] > 0.0f) {
        move(network, x, low_x, *v * g->reach + (a * g->fall + gravity_way));
        if (network->is_precise) {
            kick_precisely(v, low_v, a * g->gain, gravity, g->loss, false);
        } else {
            *v = *v * g->keep + (a * g->gain + gravity);
        }
    } else {
        move(network, x, low_x, *v * g->drift);
        *low_v = 0.0f;
    }
}

static void glide_particle(const spec_network *network, const glide *g, uint32_t p) {
    spec_motion *m = &network->motions[p];
    const spec_vector force = network->fields[p];
    glide_along(network, g, p, &m->place.x, &m->low_place.x, &m->velocity.x, &m->low_velocity.x, force.x,
                g->gravity.x, g->gravity_way.x);
    glide_along(network, g, p, &m->place.y, &m->low_place.y, &m->velocity.y, &m->low_velocity.y, force.y,
                g->gravity.y, g->gravity_way.y);
}

static bool has_floor(const spec_network *network) {
    return network->plane_count > 0 || network->heights.count > 0;
}

// Let the floor act on a particle that has moved.
static void bounce(spec_network *network, const substep *now, uint32_t p) {
    const double h = (double)now->h, scale = h / (double)now->kick;
    if (!has_floor(network) || !(network->inverse_masses[p] > 0.0f)) {
        return;
    }
    const spec_bounce b = has_springs(&network->sums[p]) || has_added(network, p)
                              ? spec_touch_floor(network, p, h, 1.0 - (double)now->loss, scale)
                              : spec_fly(network, p, h, 1.0 - (double)now->damping, scale);
    if (!b.acts) {
        return;
    }
    spec_motion *m = &network->motions[p];
    spec_put_coordinate(b.x, network->grid, &m->place.x, &m->low_place.x);
    spec_put_coordinate(b.y, network->grid, &m->place.y, &m->low_place.y);
    m->velocity = (spec_vector){(float)b.vx, (float)b.vy};
    m->low_velocity = (spec_vector){0.0f, 0.0f};
}

/* --------------------------------------------------------------------------------------------------------- step */

void spec_begin(spec_network *network) {
    double longest = 0.0;
    network->shortest = INFINITY;
    network->is_damped = false;
    for (uint32_t i = 0; i < network->spring_count; i++) {
        const spec_spring *s = &network->springs[i];
        network->is_damped |= s->damping > 0.0f || (s->is_relative && s->damping_share > 0.0f);
        network->shortest =
            s->rest_length > 0.0f ? fmin(network->shortest, (double)s->rest_length) : network->shortest;
        longest = fmax(longest, (double)s->rest_length);
    }
    network->grid = network->is_precise ? spec_last_place_of((float)(2.0 * longest)) : 0.0f;
    spec_renew(network);
    network->lag = 0.0f; // velocities are of now
    network->dt = 0.0;
    network->uneven = 0;
    network->pace = (spec_pace){0};
}

static bool has_any_added(const spec_network *network) {
    bool any = false;
    for (uint32_t i = network->first_added; i < network->spring_count; i++) {
        any |= !network->springs[i].is_broken;
    }
    return any;
}

// Move a particle without springs: in all substeps at once, or one by one in a network with a hook or with added
// springs, or where the floor may act.
static void glide_through(spec_network *network, const step *all, uint32_t p) {
    const double seconds = (double)all->h * (double)(all->end - all->first);
    const bool is_near = has_floor(network) && spec_may_meet_floor(network, p, seconds);
    const bool is_cut = network->hook != NULL || has_any_added(network) || is_near;
    step part = *all;
    for (; part.first < all->end; part.first = part.end) {
        part.end = is_cut ? part.first + 1 : all->end;
        const glide g = glide_of(network, &part);
        const substep now = substep_of(network, all, part.first);
        network->before[p] = network->motions[p];
        glide_particle(network, &g, p);
        if (is_near) {
            bounce(network, &now, p);
        }
    }
}

// Take one substep with all particles that have springs. These see the state before it, whatever the order of the
// particles.
static void take_substep(spec_network *network, const step *all, uint32_t number) {
    const substep now = substep_of(network, all, number);
    const step one = {all->count, number, number + 1, all->h, all->spring_lag, all->lag};
    const glide g = glide_of(network, &one);
    spec_look(network, number);
    spec_yield(network);
    memcpy(network->before, network->motions, network->particle_count * sizeof *network->motions);
    for (uint32_t p = 0; p < network->particle_count; p++) {
        if (has_springs(&network->sums[p])) {
            move_particle(network, &now, p);
        } else if (has_added(network, p)) {
            glide_particle(network, &g, p);
        } else {
            continue;
        }
        if (has_added(network, p)) {
            push_on(network, &now, p, add_added(network, p));
        }
        bounce(network, &now, p);
    }
}

// Take substeps between which nothing else acts.
static void take_together(spec_network *network, const step *all) {
    memcpy(network->fields, network->forces, network->particle_count * sizeof *network->fields);
    spec_add_fields(network, all->first);
    for (uint32_t i = all->first; i < all->end; i++) {
        take_substep(network, all, i);
    }
    for (uint32_t p = 0; p < network->particle_count; p++) {
        if (!has_springs(&network->sums[p]) && !has_added(network, p)) {
            glide_through(network, all, p);
        }
    }
}

// After a step of a damped network: tiny speeds become 0, but -0 stays.
static void stop_creeping(const spec_network *network) {
    for (uint32_t p = 0; p < network->particle_count; p++) {
        spec_vector *v = &network->motions[p].velocity;
        v->x = v->x != 0.0f ? flushed(v->x) : v->x;
        v->y = v->y != 0.0f ? flushed(v->y) : v->y;
    }
}

// Move surfaces to local coordinates.
static void begin_floor(spec_network *network) {
    for (uint32_t i = 0; i < network->plane_count; i++) {
        spec_plane *plane = &network->planes[i];
        plane->offset = plane->nx * (network->origin_x - plane->x) + plane->ny * (network->origin_y - plane->y);
    }
    network->heights.local_x = network->heights.x - network->origin_x;
    network->heights.local_y = network->heights.y - network->origin_y;
}

uint32_t spec_step(spec_network *network, double dt) {
    double time;
    const uint32_t count = spec_choose_substeps(network, dt, &time);
    if (count == 0) {
        return 0;
    }
    // After an edit the last substep may have been too long a time for springs to act; gravity gets all of it.
    const float h = (float)(time / (double)count), any_shape = (float)fmin(network->any_shape, (double)FLT_MAX);
    step all = {count, 0, 0, h, fminf(network->lag, fmaxf(any_shape, h)), network->lag};
    if (network->has_relative && network->lag > 0.0f) {
        all.spring_lag = all.lag = h;
    }
    spec_find_cells(network);
    spec_derive_relative(network, h);
    spec_follow_ramps(network, time);
    spec_tidy(network);
    begin_floor(network);
    for (; all.first < count; all.first = all.end) {
        spec_look(network, all.first);
        all.end = all.first + spec_free_substeps(network, all.first, count);
        spec_begin_substeps(network, all.first, count);
        take_together(network, &all);
        spec_pull_grips(network, all.first, count, h);
    }
    spec_end_step(network, time);
    memset(network->forces, 0, network->particle_count * sizeof *network->forces);
    if (network->is_damped || network->global_damping > 0.0f) {
        stop_creeping(network);
    }
    network->lag = h;
    network->uneven = spec_changes_dt(network, dt) ? 600 : network->uneven > 0 ? network->uneven - 1 : 0;
    network->dt = dt;
    spec_tidy(network);
    spec_follow(network);
    return count;
}
