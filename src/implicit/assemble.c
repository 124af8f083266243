/// The linear system of a substep.
#include "implicit.h"

#include <math.h>
#include <string.h>

#include "network/springs.h"

/* ----------------------------------------------------------------------------------------------- matrix rows */

static bool is_swept(const mspringi_row *row) {
    return row->kind == MSPRINGI_ROW_LATTICE || row->kind == MSPRINGI_ROW_CHAIN;
}

// Count the rows from r on that are of one kind and can be done in one go.
static uint32_t count_alike(const mspringi_topology *t, uint32_t r) {
    uint32_t count = 1;
    while (r + count < t->row_count && t->rows[r + count].kind == t->rows[r].kind)
        ++count;
    return count;
}

static uint32_t count_spans(const mspringi_row *rows, uint32_t row_count) {
    const mspringi_row *last = &rows[row_count - 1];
    return last->first_span + last->span_count - rows->first_span;
}

static void assemble_rows(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_system_kernels *kernels = &network->kernels->system;
    const bool damped = network->parts > MSPRINGI_DAMPING;
    for (uint32_t r = 0; r < t->row_count;) {
        const mspringi_row *row = &t->rows[r];
        const uint32_t count = count_alike(t, r);
        const mspringi_assemble_fn assemble =
            row->kind == MSPRINGI_ROW_LATTICE ? kernels->assemble_lattice[damped] : kernels->assemble_chain[damped];
        if (is_swept(row))
            assemble(&network->implicit->system, t->spans + row->first_span, count_spans(row, count));
        r += count;
    }
}

/* ------------------------------------------------------------------------------------------ leftover springs */

/// One of them as it acts on its base.
typedef struct leftover {
    double force_x, force_y;
    float pull_x, pull_y, swing;
} leftover;

// As assemble_springs() of kernels/system_assemble.h.
static leftover compute_leftover(const mspringi_system *s, uint32_t base, uint32_t tip,
                                 const mspringi_spring_values *values) {
    const double dx = s->x[tip] - s->x[base], dy = s->y[tip] - s->y[base];
    const double length = sqrt(dx * dx + dy * dy), inverse = length > 0.0 ? 1.0 / length : 0.0;
    const double nx = dx * inverse, ny = dy * inverse;
    const double extension = length - (double)values->rest_length;
    const double stiffness = s->force_scale * (double)values->stiffness;
    const double damping = s->force_scale * (double)values->damping;
    const double relative = extension * inverse, tensed = mspringi_swing_share(relative);
    const double dvx = (double)s->vx[tip] - (double)s->vx[base], dvy = (double)s->vy[tip] - (double)s->vy[base];
    const double force = stiffness * extension + damping * (dvx * nx + dvy * ny);
    const double along = (stiffness - stiffness * tensed) + damping * s->damping_rate;
    const float root = sqrtf((float)along);
    return (leftover){force * nx, force * ny, root * (float)nx, root * (float)ny, (float)(stiffness * tensed)};
}

static void add_to_diagonal(const mspringi_system *s, uint32_t slot, const leftover *spring) {
    s->xx[slot] += spring->swing + spring->pull_x * spring->pull_x;
    s->xy[slot] += spring->pull_x * spring->pull_y;
    s->yy[slot] += spring->swing + spring->pull_y * spring->pull_y;
}

static float *leftover_factors(const mspringi_implicit *n, uint32_t i) {
    return n->leftover_factors + (size_t)(i / MSPRINGI_WIDTH) * MSPRINGI_FACTORS * MSPRINGI_WIDTH +
           i % MSPRINGI_WIDTH;
}

// Their values are found by spring, so the springs are gone through.
static void assemble_leftover(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_system *s = &network->implicit->system;
    if (t->leftover_count == 0)
        return;
    for (mspring_id spring = 0; spring < t->spring_count; ++spring) {
        const mspringi_place place = t->place_of_spring[spring];
        if (place < t->chain_places || mspringi_place_is_parked(t, place))
            continue;
        const mspringi_spring_values values = mspringi_spring_get(network, spring);
        const leftover l = compute_leftover(s, values.base, values.tip, &values);
        float *factors = leftover_factors(network->implicit, place - t->chain_places);
        factors[MSPRINGI_PULL_X * MSPRINGI_WIDTH] = l.pull_x;
        factors[MSPRINGI_PULL_Y * MSPRINGI_WIDTH] = l.pull_y;
        factors[MSPRINGI_SWING * MSPRINGI_WIDTH] = l.swing;
        s->force_x[values.base] += (float)l.force_x;
        s->force_y[values.base] += (float)l.force_y;
        s->force_x[values.tip] -= (float)l.force_x;
        s->force_y[values.tip] -= (float)l.force_y;
        add_to_diagonal(s, values.base, &l);
        add_to_diagonal(s, values.tip, &l);
    }
}

static void multiply_leftover(const mspring_network *network, mspringi_field from, mspringi_field to) {
    const mspringi_topology *t = &network->topology;
    for (uint32_t i = 0; i < t->leftover_count; ++i) {
        const uint32_t a = t->leftover_a[i], b = t->leftover_b[i];
        const float *factors = leftover_factors(network->implicit, i);
        const float pull_x = factors[MSPRINGI_PULL_X * MSPRINGI_WIDTH];
        const float pull_y = factors[MSPRINGI_PULL_Y * MSPRINGI_WIDTH];
        const float swing = factors[MSPRINGI_SWING * MSPRINGI_WIDTH];
        const float dx = from.x[b] - from.x[a], dy = from.y[b] - from.y[a];
        const float along = pull_x * dx + pull_y * dy;
        const float x = swing * dx + pull_x * along, y = swing * dy + pull_y * along;
        to.x[a] -= x;
        to.y[a] -= y;
        to.x[b] += x;
        to.y[b] += y;
    }
}

/* ---------------------------------------------------------------------------------------------------- masses */

static mspringi_scheme scheme_now(const mspringi_implicit *n) {
    return mspringi_scheme_of(n->history.restarts ? MSPRING_INTEGRATOR_EULER : n->integrator);
}

// What global damping multiplies masses by.
static double heavier_by(const mspring_network *network, mspringi_scheme scheme, float h) {
    return 1.0 + scheme.force_share * scheme.velocity_share * (double)h * (double)network->global_damping;
}

void mspringi_weigh(mspring_network *network, float h) {
    mspringi_implicit *n = network->implicit;
    const size_t slots = mspringi_slot_count(network);
    const float *inverse_mass = network->inverse_mass;
    const float scale = (float)(n->scale * heavier_by(network, scheme_now(n), h));
    for (size_t i = 0; i < slots; ++i) {
        const float mass = scale / inverse_mass[i];
        n->mass[i] = inverse_mass[i] > 0.0f ? mass : 0.0f;
    }
}

/* --------------------------------------------------------------------------------------------- right-hand side */

/// What comes on the springs' force, in a coordinate.
typedef struct outside {
    const float *force;          ///< from outside, N; NULL: none
    const float *velocity;       ///< v*
    const float *turned;         ///< by how much x* is turned on
    const float *first, *second; ///< history of BDF2, or NULL
    float force_share, velocity_share, turned_share, first_share, second_share;
    float shift; ///< gravity's
} outside;

// The springs' force is in residual already. The whole is 0 where d is.
static void add_outside(size_t slots, const float *mass, const outside *o, float *restrict residual) {
    const outside copy = *o;
    for (size_t i = 0; i < slots; ++i) {
        float shift = copy.shift + copy.velocity[i] * copy.velocity_share - copy.turned[i] * copy.turned_share;
        if (copy.second)
            shift = shift + (copy.first[i] * copy.first_share + copy.second[i] * copy.second_share);
        float sum = residual[i] + mass[i] * shift;
        if (copy.force)
            sum = sum + copy.force[i] * copy.force_share;
        residual[i] = mass[i] > 0.0f ? sum : 0.0f;
    }
}

/* --------------------------------------------------------------------------------------------------- the whole */

void mspringi_assemble(mspring_network *network, float h, mspringi_field base) {
    mspringi_implicit *n = network->implicit;
    const size_t slots = mspringi_slot_count(network);
    const mspringi_topology *t = &network->topology;
    const mspringi_history *history = &n->history;
    const bool restarts = history->restarts;
    const mspringi_scheme scheme = scheme_now(n);
    const double c = scheme.force_share * (double)h * (double)h;
    n->system.force_scale = n->scale * c;
    n->system.damping_rate = scheme.velocity_share / (double)h;
    n->system.parts = network->parts;
    n->system.rest_lengths = network->rests.lengths;
    n->system.rests_of_block = network->rests.of_block;
    const double heavier = heavier_by(network, scheme, h);

    // Rows write these; the slots of other rows begin at nothing.
    const size_t swept = (size_t)t->web_first * MSPRINGI_WIDTH, others = slots - swept;
    memset(n->residual.x + swept, 0, others * sizeof *n->residual.x);
    memset(n->residual.y + swept, 0, others * sizeof *n->residual.y);
    memset(n->system.xx + swept, 0, others * sizeof *n->system.xx);
    memset(n->system.xy + swept, 0, others * sizeof *n->system.xy);
    memset(n->system.yy + swept, 0, others * sizeof *n->system.yy);
    assemble_rows(network);
    assemble_leftover(network);

    const bool two = n->integrator == MSPRING_INTEGRATOR_BDF2 && !restarts;
    outside o = {.force = base.x,
                 .velocity = n->velocity.x,
                 .turned = n->scaled.x,
                 .first = history->first.x,
                 .second = two ? history->second.x : NULL,
                 .force_share = (float)n->system.force_scale,
                 .velocity_share = (float)(-c * (double)network->global_damping / heavier),
                 .turned_share = (float)(1.0 / heavier),
                 .first_share = (float)(1.0 / 3.0 / heavier),
                 .second_share = (float)(2.0 / 9.0 * (double)h / heavier),
                 .shift = (float)(c * (double)network->gravity_x / heavier)};
    add_outside(slots, n->mass, &o, n->residual.x);
    o.force = base.y;
    o.velocity = n->velocity.y;
    o.turned = n->scaled.y;
    o.first = history->first.y;
    o.second = two ? history->second.y : NULL;
    o.shift = (float)(c * (double)network->gravity_y / heavier);
    add_outside(slots, n->mass, &o, n->residual.y);
}

void mspringi_multiply(const mspring_network *network, mspringi_field from, mspringi_field to) {
    const mspringi_topology *t = &network->topology;
    const mspringi_implicit *n = network->implicit;
    const mspringi_system_kernels *kernels = &network->kernels->system;
    for (uint32_t r = 0; r < t->row_count;) {
        const mspringi_row *row = &t->rows[r];
        const uint32_t count = count_alike(t, r);
        const mspringi_multiply_fn multiply =
            row->kind == MSPRINGI_ROW_LATTICE ? kernels->multiply_lattice : kernels->multiply_chain;
        if (is_swept(row))
            multiply(&n->system, t->spans + row->first_span, count_spans(row, count), from.x, from.y, to.x, to.y);
        r += count;
    }
    const size_t slots = mspringi_slot_count(network);
    for (size_t i = (size_t)t->web_first * MSPRINGI_WIDTH; i < slots; ++i) {
        to.x[i] = n->mass[i] * from.x[i];
        to.y[i] = n->mass[i] * from.y[i];
    }
    multiply_leftover(network, from, to);
}
