/// Corrections that follow from the energy budget: scaled velocities, rigid motions, moves back.
#include "solvers/implicit/energy_budget.h"

#include <math.h>
#include <string.h>

#include "base/decay.h"
#include "features/contact/floor.h"
#include "solvers/implicit/implicit.h"
#include "store/elements.h"
#include "store/feature.h"
#include "store/sleepers.h"

/// Excess of elastic energy that is tolerated, as a share: rounding of solutions in single precision.
#define TOLERATED 1e-6

/// The same of m g times a coordinate, where the floor has put particles. Positions have low words: what is left is
/// the rounding of sums. Components that rest on the floor were pushed up a slope by what iterations leave when
/// this was 3e-7 (example game, 3 J in each substep).
#define PLACE_ROUNDING 1e-12

/// Rounding of a length, as a share of it: half of its square times k l^2 is energy that says nothing. Positions
/// have low words. With 1e-7 it came to a hundredth of a stiff graph's energy in 74 substeps of 32 pieces.
#define LENGTH_ROUNDING 1e-8

/// Share of its energy that a component may gain, and that is scaled out of its velocities, before the substep is
/// repeated. Scaling takes from slow motion, too, where one rope gained the energy. (A ship with rigging held at
/// its bow: without a bound, its fall came to rest in a second; with a hundredth it lost four times as much as
/// now.) The work of gravity in the substep counts, too, because bodies at rest have little other energy. (Without
/// it fragments on the floor of the example game had nine of 15 substeps taken in 32 parts, for hundredths of a
/// joule.)
#define MUCH 1e-3

/// Share of the kinetic energy below which a rigid motion is lost in the rounding of velocities of one word.
#define LOST_MOTION 1e-15

/// How far a mass centre may be from where it should be, in m and as a share of its way.
#define UNSEEN_WAY 1e-10
#define SAME_WAY 1e-6

/// Share of the floor's tolerance that what goes back may be below it.
#define SUNK 1e-6

/// How often a component goes back half its way before it stays where it was.
#define MOST_STEPS_BACK 2

typedef mspringi_budget budget_of;
typedef mspringi_component_budget component;
typedef mspringi_mass_centre centre;

static mspringi_motion motion_of(const mspring_network *network) {
    const mspringi_state s = network->state;
    return (mspringi_motion){s.x, s.y, s.vx, s.vy, s.low_x, s.low_y, s.low_vx, s.low_vy, network->inverse_mass};
}

mspringi_motion mspringi_budget_motion_before(const mspring_network *network) {
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    const float *s = budget->is_in_backup ? network->backup.x : budget->state, *weights = network->inverse_mass;
    const size_t n = mspringi_slot_count(network);
    const float *x = network->is_precise ? s + 6 * n : NULL, *y = network->is_precise ? s + 7 * n : NULL;
    return (mspringi_motion){s, s + n, s + 2 * n, s + 3 * n, s + 4 * n, s + 5 * n, x, y, weights};
}

/* ------------------------------------------------------------------------------------------------- mass centres */

centre mspringi_mass_centre_of(const component *a) {
    const double *s = a->sums, mass = s[MSPRINGI_MOMENT_MASS];
    const double x = s[MSPRINGI_MOMENT_X] / mass, y = s[MSPRINGI_MOMENT_Y] / mass;
    const double vx = s[MSPRINGI_MOMENT_PX] / mass, vy = s[MSPRINGI_MOMENT_PY] / mass;
    const double inertia = s[MSPRINGI_MOMENT_INERTIA] - mass * (x * x + y * y);
    const double kinetic = 0.5 * (s[MSPRINGI_MOMENT_KINETIC] - mass * (vx * vx + vy * vy));
    return (centre){mass,
                    x,
                    y,
                    vx,
                    vy,
                    inertia > 0.0 ? inertia : 0.0,
                    s[MSPRINGI_MOMENT_SPIN] - mass * (x * vy - y * vx),
                    kinetic > 0.0 ? kinetic : 0.0};
}

// In the frame of its pins.
static double flight_energy(const component *a, const centre *c) {
    const double vx = a->origin[2] + c->vx - a->frame_x, vy = a->origin[3] + c->vy - a->frame_y;
    return 0.5 * c->mass * (vx * vx + vy * vy);
}

static void begin_component_budget(const mspring_network *network, component *a) {
    const float *const state[] = {network->state.x, network->state.y, network->state.vx, network->state.vy};
    for (size_t i = 0; i < 4; ++i)
        a->origin[i] = (double)state[i][a->first_slot];
    a->is_asleep = mspringi_slot_is_asleep(network, a->first_slot);
    a->is_driven = a->is_stopped = a->is_held = a->is_touched = a->is_rigid = false;
    a->frame_x = a->frame_y = a->push_x = a->push_y = a->push_turn = 0.0;
    a->frame_pin = MSPRING_NONE;
}

// Pins that all move alike are at rest in their own frame, where they do no work. Of others the force tells.
static void find_frames(const mspring_network *network, budget_of *budget) {
    const mspringi_state *s = &network->state;
    budget->is_driven = false;
    for (uint32_t i = 0; i < budget->pin_count; ++i) {
        const uint32_t slot = budget->pins[i];
        component *a = &budget->components[budget->of_slot[slot]];
        a->frame_pin = a->frame_pin == MSPRING_NONE ? slot : a->frame_pin;
        a->is_driven |= s->vx[slot] != s->vx[a->frame_pin] || s->vy[slot] != s->vy[a->frame_pin];
        budget->is_driven |= a->is_driven;
    }
    for (component *a = budget->components; a < budget->components + budget->count; ++a) {
        if (a->frame_pin == MSPRING_NONE || a->is_driven)
            continue;
        a->frame_x = (double)s->vx[a->frame_pin];
        a->frame_y = (double)s->vy[a->frame_pin];
    }
}

static void count_edits(const mspring_network *network, uint64_t *to) {
    const mspringi_edits *e = &network->edits;
    memcpy(to, (uint64_t[]){e->state, e->values, e->growth, e->links, e->sleep_changes, e->flows},
           MSPRINGI_BUDGET_EDITS * sizeof *to);
}

// True if elastic energy is still that after the last substep: no host may have written, and no spring varies.
static bool knows_elastic(const mspring_network *network) {
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    uint64_t now[MSPRINGI_BUDGET_EDITS];
    count_edits(network, now);
    return budget->knows_elastic && !network->is_open && !mspringi_features_vary(network) &&
           !mspringi_elements_forget_energy(network) && budget->origin_x == network->origin_x &&
           budget->origin_y == network->origin_y && memcmp(now, budget->seen, sizeof now) == 0;
}

void mspringi_budget_begin(mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    budget_of *budget = &n->budget;
    budget->is_in_backup = n->is_kept && network->backup_is_start;
    for (uint32_t i = 0; i < budget->count; ++i)
        begin_component_budget(network, &budget->components[i]);
    find_frames(network, budget);
    mspringi_budget_find_frames(network);
    mspringi_budget_sums all = {
        .network = network, .motion = motion_of(network), .knows_elastic = knows_elastic(network)};
    budget->knows_elastic = false;
    mspringi_budget_measure(&all);
    for (component *a = budget->components; a < budget->components + budget->count; ++a) {
        const centre c = mspringi_mass_centre_of(a);
        a->x = c.x;
        a->y = c.y;
        a->vx = c.vx;
        a->vy = c.vy;
        a->spin = c.spin;
        a->internal = c.kinetic + a->elastic;
        a->flight = flight_energy(a, &c);
        a->share = 1.0;
    }
}

/* ---------------------------------------------------------------------------------------------- the judgement */

/// How momenta change in a substep of h but for springs and floor: what is left of them, and for how long forces
/// act.
typedef struct outside {
    double left, seconds, h;
} outside;

static outside outside_in(const mspring_network *network, double h) {
    const double rate = (double)network->settings.global_damping, x = rate * h;
    const double left = (double)mspringi_decay(network->settings.global_damping, (float)h);
    return (outside){left, x > 0.01 ? (1.0 - left) / rate : h * (1.0 - x * (0.5 - x * (1.0 / 6.0))), h};
}

// Let the scaled velocities of a free component make up for what its momenta have changed by.
static void restore_momentum(component *a, const centre *c, double vx, double vy, double turn, double lost) {
    const double turns = c->inertia > 0.0 ? c->spin / c->inertia : 0.0;
    const double dvx = vx - c->vx, dvy = vy - c->vy, other = turn - turns;
    const double motion = c->mass * (dvx * dvx + dvy * dvy) + c->inertia * (other * other);
    a->turn = turn - a->keep * turns;
    a->add_x = (a->origin[2] + vx) - a->keep * (a->origin[2] + c->vx);
    a->add_y = (a->origin[3] + vy) - a->keep * (a->origin[3] + c->vy);
    if (a->keep == 1.0 && motion <= lost * (c->kinetic + flight_energy(a, c)))
        a->turn = a->add_x = a->add_y = 0.0;
}

// Let the mass centre of a free component have gone that way: the parabola on which gravity's work is its energy.
static void move_centre(component *a, const centre *c, double way_x, double way_y) {
    const double x = way_x - (c->x - a->x), y = way_y - (c->y - a->y);
    const bool is_off =
        x * x + y * y > UNSEEN_WAY * UNSEEN_WAY + SAME_WAY * SAME_WAY * (way_x * way_x + way_y * way_y);
    a->shift_x = is_off ? x : 0.0;
    a->shift_y = is_off ? y : 0.0;
}

static double velocity_scale_of(double room, double motion) {
    return !(motion > room) ? 1.0 : room > 0.0 ? sqrt(room / motion) : 0.0;
}

/// Energies of a component, and their bounds, J.
typedef struct balance {
    double room, motion; ///< for velocities, and what they have
    double had;          ///< before, with work
    double has;          ///< now, before velocities are turned
    double fall;         ///< what gravity would give in the substep to what rests
    double rounding;
} balance;

// A component that has little too much goes back. Where it has got much, the substep is taken again. What
// velocities have beyond their room is not all from nowhere: implicit Euler leaves a body that spins with less spin
// and with motion outwards, and once it has its spin back there is no room for that.
static void judge(component *a, const balance *b) {
    const double over = b->motion - b->room, more = b->has - b->had, gain = over < more ? over : more;
    a->exceeds = b->room < -b->rounding && !(a->is_rigid && a->elastic <= a->rigid_elastic + b->rounding);
    a->gains = (gain > -b->room ? gain : -b->room) > MUCH * (b->has + b->fall) + b->rounding;
    a->keep = velocity_scale_of(b->room, b->motion);
}

double mspringi_energy_rounding(const component *a, double energy) {
    return TOLERATED * energy + 0.5 * LENGTH_ROUNDING * LENGTH_ROUNDING * a->length;
}

static void check_free(const mspring_network *network, component *a, const centre *c, const outside *o) {
    const double *s = a->sums, mass = c->mass;
    const double fx = s[MSPRINGI_EFFECT_X], fy = s[MSPRINGI_EFFECT_Y];
    const double torque = s[MSPRINGI_EFFECT_TORQUE] - 0.5 * ((a->x + c->x) * fy - (a->y + c->y) * fx);
    const double spin = c->inertia > 0.0 ? o->left * a->spin + o->seconds * torque : 0.0;
    const double vx =
        o->left * (a->origin[2] + a->vx) + o->seconds * ((double)network->settings.gravity_x + fx / mass);
    const double vy =
        o->left * (a->origin[3] + a->vy) + o->seconds * ((double)network->settings.gravity_y + fy / mass);
    const double work = s[MSPRINGI_EFFECT_WORK] - (fx * (c->x - a->x) + fy * (c->y - a->y)) +
                        0.5 * mass * (a->push_x * a->push_x + a->push_y * a->push_y);
    const double turns = c->inertia > 0.0 ? c->spin / c->inertia : 0.0;
    const double turn = c->inertia > 0.0 ? spin / c->inertia : 0.0;
    const double rest = c->kinetic - 0.5 * c->spin * turns;
    const double had = a->internal + work;
    judge(a, &(balance){.room = had - a->elastic - 0.5 * spin * turn,
                        .motion = rest,
                        .had = had,
                        .has = a->elastic + c->kinetic,
                        .fall = mspringi_gravity_energy_in_contact(network, a, mass),
                        .rounding = mspringi_energy_rounding(a, a->internal)});
    a->turned = c->inertia > 0.0 ? 0.25 * o->h * (a->spin + spin) / c->inertia : 0.0;
    a->is_free = true;
    restore_momentum(a, c, vx - a->origin[2], vy - a->origin[3], turn, network->is_precise ? 0.0 : LOST_MOTION);
    // Impulses of other bodies act from the beginning of the substep.
    const double before = a->is_touched ? 0.0 : 0.5, after = 1.0 - before;
    move_centre(a, c, o->h * (before * (a->origin[2] + a->vx) + after * vx),
                o->h * (before * (a->origin[3] + a->vy) + after * vy));
}

static void check_held(const mspring_network *network, component *a, const centre *c, double h) {
    const double before = a->internal + a->flight, *s = a->sums, mass = c->mass;
    // In the frame of the pins global damping is a wind.
    const double wind = (double)network->settings.global_damping, way_x = h * a->frame_x, way_y = h * a->frame_y;
    const double gx = (double)network->settings.gravity_x - wind * a->frame_x;
    const double gy = (double)network->settings.gravity_y - wind * a->frame_y;
    const double work = mass * (gx * (c->x - a->x - way_x) + gy * (c->y - a->y - way_y)) +
                        (s[MSPRINGI_EFFECT_WORK] - (s[MSPRINGI_EFFECT_X] * way_x + s[MSPRINGI_EFFECT_Y] * way_y)) +
                        a->given;
    const double radius = sqrt(c->inertia / mass), motion = c->kinetic + flight_energy(a, c);
    const double x = fabs(a->origin[0] + c->x) + radius, y = fabs(a->origin[1] + c->y) + radius;
    const double places = s[MSPRINGI_EFFECT_TOUCH] > 0.0 ? mass * (fabs(gx) * x + fabs(gy) * y) : 0.0;
    judge(a, &(balance){.room = (before + work) - a->elastic,
                        .motion = motion,
                        .had = before + work,
                        .has = a->elastic + motion,
                        .fall = 0.5 * mass * (gx * gx + gy * gy) * (h * h),
                        .rounding = mspringi_energy_rounding(a, before) + PLACE_ROUNDING * places});
    a->add_x = (1.0 - a->keep) * a->frame_x;
    a->add_y = (1.0 - a->keep) * a->frame_y;
    a->turn = 0.0;
}

// True if a position is below the floor by more than rounding. Nothing lifts a fragment at rest. (With the floor's
// own tolerance, two particles that moved back some micrometres into it were pushed up in all later substeps.)
static bool is_below_floor(const mspring_network *network, double x, double y) {
    const mspringi_floor *floor = network->floor;
    if (!floor)
        return false;
    const mspringi_bounds in = floor->clear;
    const bool is_clear =
        x >= (double)in.min_x && x <= (double)in.max_x && y >= (double)in.min_y && y <= (double)in.max_y;
    return !is_clear && mspringi_floor_distance(floor, x, y) < -SUNK * mspringi_floor_slop(x, y);
}

static void stop_at_floor(component *a, size_t slot) {
    a->is_stopped = true;
    a->stop_slot = (uint32_t)slot;
}

// Components that would be shifted into the floor or a collider stay where the substep has led them.
static void find_obstacle(const mspring_network *network, double h) {
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_motion m = motion_of(network);
    for (size_t slot = 0; network->floor && slot < mspringi_slot_count(network); ++slot) {
        if (budget->of_slot[slot] == MSPRINGI_NO_COMPONENT || !(m.inverse_mass[slot] > 0.0f))
            continue;
        component *a = &budget->components[budget->of_slot[slot]];
        if ((a->shift_x != 0.0 || a->shift_y != 0.0) &&
            is_below_floor(network, (double)m.x[slot] + (double)m.low_x[slot] + a->shift_x,
                           (double)m.y[slot] + (double)m.low_y[slot] + a->shift_y))
            stop_at_floor(a, slot);
    }
    mspringi_walls_stop_shifted(network, h);
}

static void check_component(const mspring_network *network, component *a, const outside *o) {
    const centre c = mspringi_mass_centre_of(a);
    a->exceeds = a->gains = false;
    a->keep = 1.0;
    a->add_x = a->add_y = a->turn = a->shift_x = a->shift_y = 0.0;
    a->is_free = false;
    if (a->is_asleep || !(c.mass > 0.0))
        return;
    if (a->is_pinned || a->is_held || a->is_stopped || a->sums[MSPRINGI_EFFECT_TOUCH] > 0.0)
        check_held(network, a, &c, o->h);
    else
        check_free(network, a, &c, o);
}

// Return true if any component gained much. Set exceeds if the springs of any have too much.
static bool check_all(const mspring_network *network, const outside *o, bool *exceeds) {
    budget_of *budget = &mspringi_implicit_of(network)->budget;
    component *const end = budget->components + budget->count;
    bool gains = false;
    *exceeds = false;
    for (component *a = budget->components; a < end; ++a)
        check_component(network, a, o);
    find_obstacle(network, o->h);
    for (component *a = budget->components; a < end; ++a) {
        if (a->is_free && a->is_stopped)
            check_component(network, a, o);
        *exceeds |= a->exceeds;
        gains |= a->gains;
    }
    return gains;
}

/* -------------------------------------------------------------------------------------------------- the outcome */

static void shift_slots(mspring_network *network, const component *a, size_t first, size_t end) {
    const mspringi_motion m = motion_of(network);
    for (size_t slot = first; slot < end; ++slot) {
        if (!(m.inverse_mass[slot] > 0.0f))
            continue;
        mspringi_set_x(&network->state, slot, (double)m.x[slot] + (double)m.low_x[slot] + a->shift_x);
        mspringi_set_y(&network->state, slot, (double)m.y[slot] + (double)m.low_y[slot] + a->shift_y);
    }
}

static void turn_slots(mspring_network *network, const component *a, size_t first, size_t end) {
    const mspringi_motion m = motion_of(network);
    const double sums_x = a->sums[MSPRINGI_MOMENT_X], sums_y = a->sums[MSPRINGI_MOMENT_Y];
    const double mass = a->sums[MSPRINGI_MOMENT_MASS], x = sums_x / mass, y = sums_y / mass;
    const double keep = a->keep, turn = a->turn, add_x = a->add_x, add_y = a->add_y;
    const mspringi_state *s = &network->state;
    for (size_t slot = first; slot < end; ++slot) {
        const double rx = (((double)m.x[slot] - a->origin[0]) + (double)m.low_x[slot]) - x;
        const double ry = (((double)m.y[slot] - a->origin[1]) + (double)m.low_y[slot]) - y;
        if (m.inverse_mass[slot] > 0.0f)
            mspringi_set_velocity_in_full(s, slot, keep * mspringi_vx_of(s, slot) + (add_x - turn * ry),
                                          keep * mspringi_vy_of(s, slot) + (add_y + turn * rx));
    }
    if (a->shift_x != 0.0 || a->shift_y != 0.0)
        shift_slots(network, a, first, end);
}

static bool changes(const component *a) {
    return a->keep != 1.0 || a->add_x != 0.0 || a->add_y != 0.0 || a->turn != 0.0 || a->shift_x != 0.0 ||
           a->shift_y != 0.0;
}

// Give slots the velocities that they may have.
static void turn_range(void *argument, size_t first, size_t end) {
    mspring_network *network = argument;
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    for (size_t slot = first; slot < end; slot += MSPRINGI_WIDTH) {
        const uint32_t number = budget->of_block[slot / MSPRINGI_WIDTH];
        if (number < MSPRINGI_SEVERAL_COMPONENTS && changes(&budget->components[number]))
            turn_slots(network, &budget->components[number], slot, slot + MSPRINGI_WIDTH);
        for (size_t i = slot; number == MSPRINGI_SEVERAL_COMPONENTS && i < slot + MSPRINGI_WIDTH; ++i)
            if (budget->of_slot[i] != MSPRINGI_NO_COMPONENT && changes(&budget->components[budget->of_slot[i]]))
                turn_slots(network, &budget->components[budget->of_slot[i]], i, i + 1);
    }
}

static void turn_all(mspring_network *network) {
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    bool any = false;
    for (uint32_t i = 0; i < budget->count; ++i)
        any |= changes(&budget->components[i]);
    if (any)
        mspringi_tasks_run_ranges(network->tasks, mspringi_slot_count(network), MSPRINGI_WIDTH, turn_range,
                                  network);
}

// Keep where the substep has led to, in what the solver has predicted and needs no more.
static void keep_ends(const mspring_network *network) {
    const mspringi_motion m = motion_of(network);
    const mspringi_implicit *n = mspringi_implicit_of(network);
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        n->x[slot] = (double)m.x[slot] + (double)m.low_x[slot];
        n->y[slot] = (double)m.y[slot] + (double)m.low_y[slot];
    }
}

// Where a slot would be if its component had gone none of its way: of a free one, as the rigid body that it was,
// turned on, and of a pinned one along with its pins. (The rotation by twice the angle whose tangent is t is of
// length 1, whatever t.)
static void hold_place(const component *a, const centre *c, double h, double *x, double *y) {
    if (a->is_stopped)
        return;
    if (!a->is_free) {
        *x += h * a->frame_x;
        *y += h * a->frame_y;
        return;
    }
    const double t = a->turned, scale = 1.0 / (1.0 + t * t), cosine = (1.0 - t * t) * scale, sine = 2.0 * t * scale;
    const double rx = (*x - a->origin[0]) - a->x, ry = (*y - a->origin[1]) - a->y;
    *x = a->origin[0] + c->x + (cosine * rx - sine * ry);
    *y = a->origin[1] + c->y + (sine * rx + cosine * ry);
}

// Where a slot is after its component's share of the way. Returns false if it has no part in going back.
static bool restore_positions(const mspring_network *network, const mspringi_motion *before, double h, size_t slot,
                              double *x, double *y) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const budget_of *budget = &n->budget;
    if (budget->of_slot[slot] == MSPRINGI_NO_COMPONENT || !(network->inverse_mass[slot] > 0.0f))
        return false;
    const component *a = &budget->components[budget->of_slot[slot]];
    if (!a->exceeds)
        return false;
    const centre c = mspringi_mass_centre_of(a);
    *x = (double)before->x[slot] + (double)before->low_x[slot];
    *y = (double)before->y[slot] + (double)before->low_y[slot];
    hold_place(a, &c, h, x, y);
    *x += a->share * (n->x[slot] - *x);
    *y += a->share * (n->y[slot] - *y);
    return true;
}

// Let all components that have too much go back half of their way, or all of it. One that floor or collider are in
// the way of stops where it was. What the floor holds then rests: the next substep is of implicit Euler. (A body
// that spins keeps its history, as do all others in the network: a fragment of two particles that spun had the
// vibration of a bar far away damped.)
static void step_back(mspring_network *network, const mspringi_motion *before, double h, bool is_last) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    budget_of *budget = &n->budget;
    const size_t slots = mspringi_slot_count(network);
    double x, y;
    for (component *a = budget->components; a < budget->components + budget->count; ++a) {
        if (!a->exceeds)
            continue;
        a->share = is_last ? 0.0 : 0.5 * a->share;
        if (is_last && !a->is_free && n->history.restarts == 0)
            n->history.restarts = 1;
    }
    for (size_t slot = 0; network->floor && slot < slots; ++slot) {
        if (!restore_positions(network, before, h, slot, &x, &y) || !is_below_floor(network, x, y))
            continue;
        component *a = &budget->components[budget->of_slot[slot]];
        stop_at_floor(a, slot);
        a->share = 0.0;
    }
    do {
        for (size_t slot = 0; slot < slots; ++slot) {
            if (!restore_positions(network, before, h, slot, &x, &y))
                continue;
            mspringi_set_x(&network->state, slot, x);
            mspringi_set_y(&network->state, slot, y);
        }
    } while (mspringi_walls_stop_back(network, h));
}

// Find the floor's impulse on a component from its change of momentum.
static void find_floor_impulse(const mspring_network *network, component *a, const outside *o) {
    const centre c = mspringi_mass_centre_of(a);
    const double fx = a->sums[MSPRINGI_EFFECT_X], fy = a->sums[MSPRINGI_EFFECT_Y];
    const double vx = a->keep * (a->origin[2] + c.vx) + a->add_x - o->left * (a->origin[2] + a->vx);
    const double vy = a->keep * (a->origin[3] + c.vy) + a->add_y - o->left * (a->origin[3] + a->vy);
    a->floor_impulse_x = c.mass * vx - o->seconds * (c.mass * (double)network->settings.gravity_x + fx);
    a->floor_impulse_y = c.mass * vy - o->seconds * (c.mass * (double)network->settings.gravity_y + fy);
    a->support_count = 0;
    a->second_support_slot = a->is_stopped ? a->stop_slot : MSPRING_NONE;
}

// Component of an active contact's particle. NULL: none, or pinned.
static component *component_of(const mspring_network *network, const mspringi_constraint *contact) {
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    const uint32_t number = budget->of_slot[network->constraints.entries[contact->first].slot];
    component *a = number == MSPRINGI_NO_COMPONENT ? NULL : &budget->components[number];
    return a && mspringi_constraint_is_active(contact) && !a->is_pinned ? a : NULL;
}

static void count_supports(const mspring_network *network) {
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_floor *floor = network->floor;
    for (const mspringi_constraint *c = NULL; (c = mspringi_next_floor_push(&network->constraints, c)) != NULL;) {
        component *a = component_of(network, c);
        if (a)
            a->support_count++;
    }
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        const double x = (double)floor->impulse.x[slot] - (double)budget->impulse.x[slot];
        const double y = (double)floor->impulse.y[slot] - (double)budget->impulse.y[slot];
        if (budget->of_slot[slot] == MSPRINGI_NO_COMPONENT || (x == 0.0 && y == 0.0))
            continue;
        component *a = &budget->components[budget->of_slot[slot]];
        a->floor_impulse_x -= x;
        a->floor_impulse_y -= y;
        a->second_support_slot = (uint32_t)slot;
    }
}

// Contact forces in the linear system follow from small displacements, which rounding hides in stiff networks.
// (Particles of 8 kg at 1e10 N/m: impulses of 0 or 48,000 N s instead of 4.) So contacts share the missing
// momentum.
static void balance_floor(const mspring_network *network, const outside *o) {
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_floor *floor = network->floor;
    component *const end = budget->components + budget->count;
    bool any = false;
    for (component *a = budget->components; a < end; ++a) {
        find_floor_impulse(network, a, o);
        any |= a->is_stopped || a->sums[MSPRINGI_EFFECT_TOUCH] > 0.0;
    }
    if (!any)
        return;
    count_supports(network);
    for (const mspringi_constraint *c = NULL; (c = mspringi_next_floor_push(&network->constraints, c)) != NULL;) {
        const component *a = component_of(network, c);
        const uint32_t slot = network->constraints.entries[c->first].slot;
        if (!a)
            continue;
        floor->impulse.x[slot] += (float)(a->floor_impulse_x / (double)a->support_count);
        floor->impulse.y[slot] += (float)(a->floor_impulse_y / (double)a->support_count);
    }
    for (const component *a = budget->components; a < end; ++a) {
        if (a->is_pinned || a->support_count > 0 || a->second_support_slot == MSPRING_NONE)
            continue;
        floor->impulse.x[a->second_support_slot] += (float)a->floor_impulse_x;
        floor->impulse.y[a->second_support_slot] += (float)a->floor_impulse_y;
    }
}

// The sums stay valid for the next substep if no component was shifted.
static void remember_elastic(const mspring_network *network) {
    budget_of *budget = &mspringi_implicit_of(network)->budget;
    budget->knows_elastic = true;
    for (uint32_t i = 0; i < budget->count; ++i)
        budget->knows_elastic &= budget->components[i].shift_x == 0.0 && budget->components[i].shift_y == 0.0;
    count_edits(network, budget->seen);
    budget->origin_x = network->origin_x;
    budget->origin_y = network->origin_y;
}

bool mspringi_budget_end(mspring_network *network, float h, mspringi_field base, bool may_halve) {
    mspringi_budget_sums all = {.network = network,
                                .motion = motion_of(network),
                                .before = mspringi_budget_motion_before(network),
                                .base = base,
                                .h = h,
                                .is_after = true};
    const outside o = outside_in(network, (double)h);
    for (int step = 0;; ++step) {
        bool exceeds;
        mspringi_budget_measure(&all);
        mspringi_budget_add_pin_work(&all);
        const bool gains = check_all(network, &o, &exceeds);
        if ((gains || (exceeds && step > MOST_STEPS_BACK)) && may_halve)
            return false;
        if (mspringi_implicit_contact_gained_energy(network, o.h, base) &&
            !mspringi_implicit_contact_end_vibration(network)) {
            mspringi_implicit_of(network)->holds_overlaps = true;
            return false;
        }
        if (!exceeds || step > MOST_STEPS_BACK)
            break;
        if (step == 0)
            keep_ends(network);
        step_back(network, &all.before, o.h, step == MOST_STEPS_BACK);
    }
    turn_all(network);
    if (network->floor)
        balance_floor(network, &o);
    remember_elastic(network);
    return true;
}

void mspringi_budget_undo(mspring_network *network) {
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    const size_t slots = mspringi_slot_count(network),
                 kept = budget->is_in_backup ? mspringi_used_slots(network) : slots;
    const float *before = mspringi_budget_motion_before(network).x;
    for (size_t i = 0; i < mspringi_state_arrays(network); ++i)
        memcpy(network->state.x + i * slots, before + i * slots, kept * sizeof *before);
    if (network->floor)
        memcpy(network->floor->impulse.x, budget->impulse.x, 2 * slots * sizeof *budget->impulse.x);
    mspringi_integrator_undo(network);
}
