/// What goes wrong, before it is to be seen: substeps above the border (see pencil.h), and numbers out of bounds.
///
/// Up to the substep that is stable in any shape nothing needs to be looked at. Above it, the border of the shape
/// that the network has is: when the substep is another one, and when a step has changed a particle's velocity
/// twice as much as one had at the last look. A bound tells first whether it can be near at all (certificate.c). If
/// it can, the Lanczos iteration tells with certainty: what it finds is never above the largest eigenvalue, so a
/// network that is below the border is never refused. After such a change it starts from the motion itself,
/// velocities less their mean over the substeps before: of what moves smoothly next to nothing is left of that, of
/// what turns round in each substep everything, and a few iterations are enough.
#include "guard.h"

#include <math.h>
#include <string.h>

#include "explicit/decay.h"
#include "pencil.h"
#include "stability.h"
#include "tridiagonal.h"

/// Growth of the largest change of a velocity, from look to look at the border.
#define SUSPICIOUS 2.0f

/// What is left of that in each step without a look: half in 2839 steps, so that looks are rare where nothing
/// grows.
#define FADING (4095.0f / 4096.0f)

/// Change that nobody looks at, in shortest rest lengths per substep.
#define HARMLESS 1e-3

/// Iterations from no particular vector, and from the motion.
#define ITERATIONS 100
#define ITERATIONS_FROM_MOTION 12

/// Residual, as a part of the eigenvalue, at which that is good enough.
#define TOLERANCE 2e-3

/* --------------------------------------------------------------------------------------------------- bounds */

static bool is_in_bounds(const mspring_network *network, uint32_t slot) {
    const mspringi_state *s = &network->state;
    const float largest = (float)MSPRING_MAX_COORDINATE, fastest = network->max_speed;
    return fabsf(s->x[slot]) <= largest && fabsf(s->y[slot]) <= largest && fabsf(s->vx[slot]) <= fastest &&
           fabsf(s->vy[slot]) <= fastest;
}

// Name a particle that left the bounds: the first that is still a number, since what is none spreads to others.
static mspring_result check_bounds(mspring_network *network, double dt) {
    const mspringi_state *s = &network->state;
    const mspringi_topology *t = &network->topology;
    mspring_id named = MSPRING_NONE;
    for (mspring_id p = t->particle_count; p-- > 0;) {
        const uint32_t slot = t->slot_of_particle[p];
        const float sum = s->x[slot] + s->y[slot] + s->vx[slot] + s->vy[slot];
        if (!is_in_bounds(network, slot) && (sum == sum || named == MSPRING_NONE))
            named = p;
    }
    if (named == MSPRING_NONE)
        return MSPRING_OK;
    const uint32_t slot = t->slot_of_particle[named];
    const double x = network->origin_x + (double)s->x[slot], y = network->origin_y + (double)s->y[slot];
    const double vx = (double)s->vx[slot], vy = (double)s->vy[slot];
    const char *cure = "take a shorter step, more substeps or less stiffness";
    if (!isfinite(x + y + vx + vy))
        return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                             "a step of %g s (substeps: %u) would throw particle %u, perhaps with others, out of the "
                             "range of numbers: %s",
                             dt, (unsigned)network->substeps, (unsigned)named, cure);
    return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                         "a step of %g s (substeps: %u) would throw particle %u, perhaps with others, to (%g, %g) m "
                         "at (%g, %g) m/s: %s",
                         dt, (unsigned)network->substeps, (unsigned)named, x, y, vx, vy, cure);
}

/* --------------------------------------------------------------------------------------------------- the border */

/// A displacement, x and y by slot, divided by the root of the inverse mass.
typedef struct displacement {
    float *x, *y;
} displacement;

// The velocity of a slot less the mean of those before it in the last step. All of them are in the distance it
// went.
static float turning(const mspring_network *network, float v, float v_before, float x, float x_before) {
    if (network->substeps == 1)
        return v - v_before;
    const float h = network->guard.h;
    return v - (x - x_before - h * v) / (h * (float)(network->substeps - 1));
}

// The last step's motion into the backup of the state before it.
static displacement start_from_motion(const mspring_network *network) {
    const mspringi_state *s = &network->state, *b = &network->backup;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        const float inverse_mass = network->inverse_mass[slot];
        const float root = inverse_mass > 0.0f ? 1.0f / sqrtf(inverse_mass) : 0.0f;
        b->x[slot] = root * turning(network, s->vx[slot], b->vx[slot], s->x[slot], b->x[slot]);
        b->y[slot] = root * turning(network, s->vy[slot], b->vy[slot], s->y[slot], b->y[slot]);
    }
    return (displacement){b->x, b->y};
}

static displacement start_from_noise(const mspring_network *network) {
    const mspringi_state *b = &network->backup;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        const bool moves = network->inverse_mass[slot] > 0.0f;
        b->x[slot] = moves ? (float)mspringi_noise(2 * slot) : 0.0f;
        b->y[slot] = moves ? (float)mspringi_noise(2 * slot + 1) : 0.0f;
    }
    return (displacement){b->x, b->y};
}

static double dot(const mspring_network *network, displacement a, displacement b) {
    double sum = 0.0;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot)
        sum += (double)a.x[slot] * (double)b.x[slot] + (double)a.y[slot] * (double)b.y[slot];
    return sum;
}

// a = factor a + other_factor other
static void combine(const mspring_network *network, displacement a, double factor, double other_factor,
                    displacement other) {
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        a.x[slot] = (float)(factor * (double)a.x[slot] + other_factor * (double)other.x[slot]);
        a.y[slot] = (float)(factor * (double)a.y[slot] + other_factor * (double)other.y[slot]);
    }
}

// out += (A + 2 D) in
static void add_image(const mspring_network *network, double h, displacement in, displacement out) {
    const mspringi_topology *t = &network->topology;
    mspringi_place_reader reader;
    mspringi_places_begin(&reader, &t->places, 0);
    for (mspring_id i = 0; i < t->spring_count; ++i) {
        const mspringi_place place = mspringi_places_next(&reader);
        if (!mspringi_spring_exists(network, i))
            continue;
        const mspringi_seen s = mspringi_see_spring(network, i, place);
        const uint32_t a = t->slot_of_particle[s.a], b = t->slot_of_particle[s.b];
        const double root_a = sqrt((double)network->inverse_mass[a]);
        const double root_b = sqrt((double)network->inverse_mass[b]);
        const double dx = root_b * (double)in.x[b] - root_a * (double)in.x[a];
        const double dy = root_b * (double)in.y[b] - root_a * (double)in.y[a];
        const double stiffness = h * h * s.strength.stiffness + s.strength.relative_stiffness;
        const double damping = 2.0 * (h * s.strength.damping + s.strength.relative_damping);
        const double along = (stiffness + damping) * (s.nx * dx + s.ny * dy);
        const double across = stiffness * s.across * (s.ny * dx - s.nx * dy);
        const double fx = along * s.nx + across * s.ny, fy = along * s.ny - across * s.nx;
        out.x[a] -= (float)(root_a * fx);
        out.y[a] -= (float)(root_a * fy);
        out.x[b] += (float)(root_b * fx);
        out.y[b] += (float)(root_b * fy);
    }
}

// A lower bound of the largest eigenvalue, from the start in the first half of the backup on; the second half is
// the other vector that the iteration needs. Ends when it is above the bound or will not be.
static double largest_eigenvalue(const mspring_network *network, double h, displacement here, double bound,
                                 int iterations) {
    displacement next = {network->backup.vx, network->backup.vy};
    mspringi_tridiagonal t = {.size = 0};
    double weights[MSPRINGI_LANCZOS_MOST], value = 0.0, beside = sqrt(dot(network, here, here));
    if (!(beside > 0.0 && beside < INFINITY))
        return 0.0;
    combine(network, here, 1.0 / beside, 0.0, here);
    memset(next.x, 0, mspringi_slot_count(network) * sizeof *next.x);
    memset(next.y, 0, mspringi_slot_count(network) * sizeof *next.y);
    for (;;) {
        const int j = t.size++;
        add_image(network, h, here, next);
        t.diagonal[j] = dot(network, here, next);
        combine(network, next, 1.0, -t.diagonal[j], here);
        beside = t.beside[j] = sqrt(dot(network, next, next));
        value = mspringi_tridiagonal_top(&t, weights);
        const double residual = beside * fabs(weights[j]);
        const bool stays_below = t.size >= ITERATIONS_FROM_MOTION && value + residual < bound;
        if (value > bound || stays_below || residual <= TOLERANCE * value || t.size == iterations ||
            !(beside > 1e-6 * value))
            return value;
        // The one before is not needed any more but for its share in what comes next.
        combine(network, next, 1.0 / beside, 0.0, next);
        combine(network, here, -beside, 0.0, here);
        const displacement swapped = here;
        here = next;
        next = swapped;
    }
}

// Name the tightest spring, and the end of it that is more easily moved.
static mspring_result explain_border(mspring_network *network, double dt, float h) {
    const mspringi_topology *t = &network->topology;
    const mspring_id spring = mspringi_tightest_spring(network, (double)h);
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_place_of(t, spring), &base, &tip);
    const float at_base = network->inverse_mass[base], at_tip = network->inverse_mass[tip];
    const mspring_id a = t->particle_of_slot[base], b = t->particle_of_slot[tip];
    const mspring_id moved = at_base > at_tip || (at_base == at_tip && a < b) ? a : b;
    return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                         "a step of %g s (substeps: %u): motion would turn round and grow in each, as %g s are too "
                         "long for springs and masses in this shape, as for spring %u at particle %u: take a "
                         "shorter step, more substeps or less stiffness",
                         dt, (unsigned)network->substeps, (double)h, (unsigned)spring, (unsigned)moved);
}

static mspring_result look_at_border(mspring_network *network, double dt, float h, bool from_motion) {
    const double decay = (double)mspringi_decay(network->global_damping, h);
    // Vectors are floats: room for their rounding.
    const double sharp = 2.0 * (1.0 + 1.0 / decay), bound = sharp * (1.0 + 1e-4);
    const displacement start = from_motion ? start_from_motion(network) : start_from_noise(network);
    const mspringi_state *b = &network->backup;
    const double largest = mspringi_border_is_below(network, (double)h, sharp, b->vx, b->vy)
                               ? 0.0
                               : largest_eigenvalue(network, (double)h, start, bound,
                                                    from_motion ? ITERATIONS_FROM_MOTION : ITERATIONS);
    // A step keeps the state here strip by strip, which leaves what lies between strips as it is.
    memset(network->backup.x, 0, 4 * mspringi_slot_count(network) * sizeof *network->backup.x);
    if (!(largest > bound))
        return MSPRING_OK;
    return explain_border(network, dt, h);
}

/* --------------------------------------------------------------------------------------------------- the steps */

mspring_result mspringi_guard_begin(mspring_network *network, double dt, float h) {
    mspringi_guard *guard = &network->guard;
    const bool same = guard->h == h && guard->global_damping == network->global_damping;
    const bool suspicious = guard->suspicious;
    guard->watches = guard->suspicious = false;
    const bool is_same = guard->state == network->edits.state && !network->is_open;
    guard->knows_speed = is_same && guard->speed <= network->max_speed;
    guard->knows_place = is_same && guard->place <= (float)MSPRING_MAX_COORDINATE && network->substeps == 1;
    if (network->guard_policy == MSPRING_GUARD_BOUNDS || network->implicit || network->is_clamped)
        return MSPRING_OK;
    const mspringi_any_shape *any_shape = &network->any_shape;
    if (same && !suspicious &&
        (any_shape->masses != network->edits.masses || any_shape->values != network->edits.values)) {
        guard->watches = true; // edits cost nothing here; what they do to the border is seen in the velocities
        return MSPRING_OK;
    }
    mspring_result result = MSPRING_OK;
    if (same && suspicious)
        result = look_at_border(network, dt, h, true);
    mspring_id spring;
    guard->watches = (double)h > mspringi_stable_in_any_shape(network, &spring);
    if (guard->watches && !same)
        result = look_at_border(network, dt, h, false);
    if (result != MSPRING_OK) {
        guard->h = 0.0f; // next time from noise: the motion that was is gone
        return result;
    }
    guard->h = h;
    guard->global_damping = network->global_damping;
    return MSPRING_OK;
}

// NaN, if there is one, counts as the largest, as in the kernels.
static float larger(float a, float b) {
    return b > a || b != b ? b : a;
}

mspringi_sight mspringi_sight_join(mspringi_sight a, mspringi_sight b) {
    return (mspringi_sight){larger(a.place, b.place), larger(a.speed, b.speed), larger(a.change, b.change)};
}

mspringi_sight mspringi_guard_look(const mspring_network *network, size_t first, size_t end) {
    const mspringi_largest_fn largest = network->kernels->largest;
    const mspringi_state *s = &network->state, *b = &network->backup;
    const bool watches = network->guard.watches;
    const size_t count = end - first;
    const mspringi_largest vx = largest(s->vx + first, watches ? b->vx + first : NULL, count);
    const mspringi_largest vy = largest(s->vy + first, watches ? b->vy + first : NULL, count);
    return (mspringi_sight){
        larger(largest(s->x + first, NULL, count).value, largest(s->y + first, NULL, count).value),
        larger(vx.value, vy.value), larger(vx.change, vy.change)};
}

// Change that is as good as none, m/s.
static float calm_change(const mspring_network *network, float h) {
    const double harmless = HARMLESS * network->shortest / (double)h;
    return harmless < 1e15 ? (float)harmless : 1e15f;
}

// Whether the largest change of a velocity in a step is more than usual.
static void judge_change(mspring_network *network, float h, float change) {
    mspringi_guard *guard = &network->guard;
    guard->suspicious = change > SUSPICIOUS * fmaxf(guard->peak, calm_change(network, h));
    guard->peak = guard->suspicious ? change : guard->peak * FADING;
}

// What no speed is above after a step. Where changes are watched speeds are not (see sweep.h for what either
// takes), as no particle is faster than the fastest was before by more than the largest change; with room for
// rounding.
static float bound_speed(const mspring_network *network, mspringi_sight sight) {
    const mspringi_guard *guard = &network->guard;
    if (!(guard->watches && guard->knows_speed))
        return sight.speed;
    const float bound = (guard->speed + sight.change) * (1.0f + 1e-6f);
    return bound <= network->max_speed ? bound
                                       : mspringi_guard_look(network, 0, mspringi_slot_count(network)).speed;
}

// What no coordinate is above after a step. One substep takes none further than by the speed at its end, unless
// a floor does: then all of it has been looked at.
static float bound_place(const mspring_network *network, float h, float speed, mspringi_sight sight) {
    const mspringi_guard *guard = &network->guard;
    if (!guard->knows_place)
        return sight.place;
    const float bound = larger(sight.place, (guard->place + h * speed) * (1.0f + 1e-6f));
    return bound <= (float)MSPRING_MAX_COORDINATE
               ? bound
               : mspringi_guard_look(network, 0, mspringi_slot_count(network)).place;
}

mspring_result mspringi_guard_end(mspring_network *network, double dt, float h, mspringi_sight sight) {
    mspringi_guard *guard = &network->guard;
    const float speed = bound_speed(network, sight), place = bound_place(network, h, speed, sight);
    if (!(place <= (float)MSPRING_MAX_COORDINATE && speed <= network->max_speed)) {
        const mspring_result result = check_bounds(network, dt);
        if (result != MSPRING_OK)
            return result;
    }
    if (guard->watches)
        judge_change(network, h, sight.change);
    // What sleeps is not seen, and an implicit solver's step may yet be refused.
    guard->speed = network->implicit ? INFINITY : larger(speed, network->sleep.speed);
    guard->place = network->implicit || network->sleep.sleeping > 0 ? INFINITY : place;
    guard->state = network->edits.state;
    return MSPRING_OK;
}
