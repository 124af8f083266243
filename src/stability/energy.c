/// The balance of energy of implicit substeps.
#include "energy.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "contact/floor.h"
#include "implicit/implicit.h"
#include "network/springs.h"
#include "sleep/sleep.h"

/// Part of the motion that may come from nowhere.
#define TOLERATED 0.01

/// Parts of the motion: what springs outside of lattices may get before all energy is looked at, and what may come
/// from nowhere in a substep before that goes on.
#define UNSUSPICIOUS 0.004
#define HARMLESS 1e-5

/// How far a solution lowers the energy of what is linearised, its fall, is about what may come from nowhere.
/// Below CALM, a part of the motion, nearly all of it goes with the acceleration, and SPURIOUS is the part that
/// counts. As energy comes and goes with second order, the balance has to have RESERVE of the falls left then;
/// below STILL not.
#define CALM 1e-4
#define SPURIOUS 0.001
#define RESERVE 4.0
#define STILL 1e-8

/// The same that is taken out of the motion, but that more iterations are to keep from coming again.
#define NOTABLE 1e-4

/// What is left of the most motion in each substep: half in 2839.
#define FADING (4095.0 / 4096.0)

/// Rounding of displacements, as a part of the largest, and of lengths, as a part of them.
#define DISPLACEMENT_ROUNDING 2e-7
#define LENGTH_ROUNDING 1e-7

typedef mspringi_substep_of substep_of;

mspring_result mspringi_balance_create(mspringi_balance *balance, const mspring_network *network, uint32_t panels,
                                       mspringi_memory *memory, mspringi_message *message) {
    const mspringi_topology *t = &network->topology;
    const size_t slots = mspringi_slot_count(network), chunks = slots / MSPRINGI_CHUNK + 1;
    *balance = (mspringi_balance){0};
    balance->chunks = mspringi_alloc(memory, chunks * MSPRINGI_MOVE_SUMS, sizeof *balance->chunks);
    balance->panels = mspringi_alloc(memory, (size_t)panels * MSPRINGI_STRETCH_SUMS, sizeof *balance->panels);
    balance->body = mspringi_alloc(memory, slots, sizeof *balance->body);
    balance->bodies = mspringi_alloc(memory, slots / 2 + 1, sizeof *balance->bodies);
    if (!balance->chunks || !balance->panels || !balance->body || !balance->bodies) {
        mspringi_balance_destroy(balance, memory);
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the energy of %u particles",
                             (unsigned)t->particle_count);
    }
    return MSPRING_OK;
}

void mspringi_balance_count(const mspring_network *network, mspringi_implicit *n) {
    const mspringi_topology *t = &network->topology;
    const size_t loose = (size_t)t->loose_first * MSPRINGI_WIDTH, slots = mspringi_slot_count(network);
    n->balance.movable = 0;
    for (size_t slot = 0; slot < loose; ++slot)
        n->balance.movable += t->particle_of_slot[slot] != MSPRING_NONE;
    const mspringi_slots added = mspringi_loose_slots(t, &(mspringi_slots){loose, slots});
    for (size_t slot = added.first; slot < added.end; ++slot)
        n->balance.movable += mspringi_is_solved(network, n, slot);
}

void mspringi_balance_destroy(mspringi_balance *balance, mspringi_memory *memory) {
    mspringi_free(memory, balance->chunks);
    mspringi_free(memory, balance->panels);
    mspringi_free(memory, balance->body);
    mspringi_free(memory, balance->bodies);
    *balance = (mspringi_balance){0};
}

static bool has_others(const mspringi_topology *t) {
    return t->lattice_places < t->chain_places + t->leftover_count;
}

// Broken lattice springs leave ropes in the lattice.
static uint32_t count_dead(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    uint32_t live = 0;
    for (size_t word = 0; word < t->lattice_places / MSPRINGI_WIDTH; ++word)
        for (uint32_t bits = network->live[word]; bits; bits &= bits - 1)
            ++live;
    return t->lattice_springs - live;
}

bool mspringi_energy_is_watched(const mspring_network *network) {
    mspringi_balance *balance = &network->implicit->balance;
    if (network->guard_policy == MSPRING_GUARD_BOUNDS)
        return false;
    if (!balance->is_dead_known)
        balance->dead = count_dead(network);
    balance->is_dead_known = true;
    const mspringi_topology *t = &network->topology;
    return balance->dead > 0 || has_others(t) || (t->lattice_places > 0 && !network->implicit->is_direct);
}

static bool is_live(const mspring_network *network, mspringi_place place) {
    return network->live[place / MSPRINGI_WIDTH] >> place % MSPRINGI_WIDTH & 1;
}

/* ------------------------------------------------------------------------------------------------------- motion */

static mspringi_motion describe(const substep_of *substep, float alpha) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = network->implicit;
    const mspringi_landing *x = &substep->landing[0], *y = &substep->landing[1];
    // What springs exert is of no use any more. (It is, to particles without springs, which are not looked at.)
    return (mspringi_motion){
        .axes = {{x->position, x->low, x->velocity, x->predicted, x->start, x->solution, x->direction,
                  substep->base.x, n->residual.x},
                 {y->position, y->low, y->velocity, y->predicted, y->start, y->solution, y->direction,
                  substep->base.y, n->residual.y}},
        .mass = n->mass,
        .alpha = alpha,
        .rate = x->rate,
        .stiffness_scale = (float)n->scale,
    };
}

/// Where a slot is before the substep and after it, in a coordinate, and how fast.
typedef struct passage {
    double from, to, slow, fast;
} passage;

static passage passage_of(const mspringi_motion *m, size_t axis, size_t slot) {
    const mspringi_motion_axis *c = &m->axes[axis];
    const float d = c->solution[slot] + m->alpha * c->direction[slot], before = c->velocity[slot];
    return (passage){(double)c->position[slot] + (double)c->low[slot], c->predicted[slot] + (double)d,
                     (double)before,
                     m->mass[slot] > 0.0f ? (double)(c->start[slot] + m->rate * d) : (double)before};
}

/// A spring before the substep and after it.
typedef struct stretched {
    double stiffness, x, y, later_x, later_y; ///< from its base to its tip
    double before, after;                     ///< longer than at rest
} stretched;

static stretched stretch_of(const mspringi_motion *m, const mspringi_spring_values *s) {
    const passage ax = passage_of(m, 0, s->base), ay = passage_of(m, 1, s->base);
    const passage bx = passage_of(m, 0, s->tip), by = passage_of(m, 1, s->tip);
    const double x = bx.from - ax.from, y = by.from - ay.from, later_x = bx.to - ax.to, later_y = by.to - ay.to;
    const double rest_length = (double)s->rest_length;
    return (stretched){(double)s->stiffness,
                       x,
                       y,
                       later_x,
                       later_y,
                       sqrt(x * x + y * y) - rest_length,
                       sqrt(later_x * later_x + later_y * later_y) - rest_length};
}

static double gain_of(const stretched *s) {
    return 0.5 * s->stiffness * ((s->after - s->before) * (s->after + s->before));
}

/* ---------------------------------------------------------------------------------------- springs of their own */

// What a particle gets, less the work that is done on it, J.
static double gain_of_slot(const substep_of *substep, const mspringi_motion *m, size_t slot) {
    const mspring_network *network = substep->network;
    const double gravity[] = {(double)network->gravity_x, (double)network->gravity_y};
    const float inverse_mass = network->inverse_mass[slot];
    double sum = 0.0;
    if (!(inverse_mass > 0.0f))
        return 0.0;
    const double mass = 1.0 / (double)inverse_mass;
    for (size_t axis = 0; axis < 2; ++axis) {
        const passage p = passage_of(m, axis, slot);
        const float *force = m->axes[axis].force;
        const double work = (mass * gravity[axis] + (force ? (double)force[slot] : 0.0)) * (p.to - p.from);
        sum += 0.5 * mass * ((p.fast - p.slow) * (p.fast + p.slow)) - work;
    }
    return sum;
}

// The particles of some blocks.
static double gain_of_blocks(const substep_of *substep, const mspringi_motion *m, uint32_t first, uint32_t count) {
    double sum = 0.0;
    for (size_t slot = (size_t)first * MSPRINGI_WIDTH; slot < (size_t)(first + count) * MSPRINGI_WIDTH; ++slot)
        sum += gain_of_slot(substep, m, slot);
    return sum;
}

// All slots of loose particles that springs have been added to.
static mspringi_slots slots_added_to(const mspring_network *network) {
    const mspringi_slots all = {0, mspringi_slot_count(network)}, none = {0, 0};
    return network->implicit->is_solved ? mspringi_loose_slots(&network->topology, &all) : none;
}

// What springs and particles outside of lattices get, J.
static double gain_outside(const substep_of *substep, const mspringi_motion *m) {
    const mspring_network *network = substep->network;
    const mspringi_topology *t = &network->topology;
    double sum = gain_of_blocks(substep, m, t->chain_first, t->chain_blocks) +
                 gain_of_blocks(substep, m, t->web_first, t->web_blocks);
    const mspringi_slots added = slots_added_to(network);
    for (size_t slot = added.first; slot < added.end; ++slot)
        if (mspringi_is_solved(network, network->implicit, slot))
            sum += gain_of_slot(substep, m, slot);
    for (mspringi_place place = t->lattice_places; place < t->chain_places + t->leftover_count; ++place) {
        if (!is_live(network, place))
            continue;
        const mspringi_spring_values values = mspringi_place_get(network, place);
        const stretched s = stretch_of(m, &values);
        sum += gain_of(&s);
    }
    return sum;
}

// Whether the whole has to be looked at.
static bool is_suspicious(const substep_of *substep, const mspringi_motion *m) {
    mspringi_implicit *n = substep->network->implicit;
    mspringi_ledger *ledger = &n->ledger;
    if (n->balance.dead > 0 || substep->network->topology.lattice_places == 0)
        return true;
    if (ledger->look == 0 && ledger->motion > 0.0) {
        const double outside = ledger->risen + gain_outside(substep, m);
        const double fall = n->fall <= CALM * ledger->motion ? SPURIOUS * n->fall : n->fall;
        const double risen = (outside > 0.0 ? outside : 0.0) + fall;
        const double rounding = LENGTH_ROUNDING * ledger->motion;
        const double reserve = n->fall > STILL * ledger->motion ? RESERVE * n->fall : -rounding;
        if (risen <= UNSUSPICIOUS * ledger->motion && ledger->balance + risen <= -reserve) {
            ledger->risen = risen;
            return false;
        }
    }
    ledger->look = ledger->look > 0 ? ledger->look - 1 : MSPRINGI_LOOKS;
    ledger->balance += ledger->risen;
    ledger->risen = 0.0;
    return true;
}

/* ---------------------------------------------------------------------------------------------------- all sums */

// What pinned ends of a spring give it: force before the substep or after it, whatever is more, times their way.
static double given_by_pins(const mspringi_motion *m, const mspringi_spring_values *values, const stretched *s) {
    const double rest_length = (double)values->rest_length;
    const double before = s->before + rest_length, after = s->after + rest_length;
    const double per_before = before > 0.0 ? 1.0 / before : 0.0, per_after = after > 0.0 ? 1.0 / after : 0.0;
    const double nx = s->x * per_before, ny = s->y * per_before;
    const double later_nx = s->later_x * per_after, later_ny = s->later_y * per_after;
    const passage ax = passage_of(m, 0, values->base), ay = passage_of(m, 1, values->base);
    const passage bx = passage_of(m, 0, values->tip), by = passage_of(m, 1, values->tip);
    const double rate = nx * (bx.slow - ax.slow) + ny * (by.slow - ay.slow);
    const double later_rate = later_nx * (bx.fast - ax.fast) + later_ny * (by.fast - ay.fast);
    const double base = m->mass[values->base] > 0.0f ? 0.0 : 1.0, tip = m->mass[values->tip] > 0.0f ? 0.0 : 1.0;
    const double x = tip * (bx.to - bx.from) - base * (ax.to - ax.from);
    const double y = tip * (by.to - by.from) - base * (ay.to - ay.from);
    const double damping = (double)values->damping;
    const double start = (s->stiffness * s->before + damping * rate) * (nx * x + ny * y);
    const double end = (s->stiffness * s->after + damping * later_rate) * (later_nx * x + later_ny * y);
    return start > end ? start : end;
}

// What leftover springs add to the sums over springs.
static void add_leftover(const mspring_network *network, const mspringi_motion *m, bool driven, double *sums) {
    const mspringi_topology *t = &network->topology;
    const mspringi_motion_axis *const cx = &m->axes[0], *const cy = &m->axes[1];
    const double scale = network->implicit->scale;
    for (uint32_t i = 0; i < t->leftover_count; ++i) {
        const uint32_t a = t->leftover_a[i], b = t->leftover_b[i];
        const size_t entry = t->web.entry[2 * (size_t)i];
        if (mspringi_slot_is_asleep(network, a) && mspringi_slot_is_asleep(network, b))
            continue;
        const float *record = network->web_springs + entry / MSPRINGI_WIDTH * MSPRINGI_WIDTH * network->parts +
                              entry % MSPRINGI_WIDTH;
        const double rest_length = (double)record[MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH];
        const double stiffness = (double)record[MSPRINGI_STIFFNESS * MSPRINGI_WIDTH], k = scale * stiffness;
        const double x = (double)(cx->position[b] - cx->position[a]) + (double)(cx->low[b] - cx->low[a]);
        const double y = (double)(cy->position[b] - cy->position[a]) + (double)(cy->low[b] - cy->low[a]);
        const double later_x = x + (double)(cx->step[b] - cx->step[a]);
        const double later_y = y + (double)(cy->step[b] - cy->step[a]);
        const double length = sqrt(x * x + y * y), before = length - rest_length;
        const double after = sqrt(later_x * later_x + later_y * later_y) - rest_length;
        sums[MSPRINGI_STRETCH_GAIN] += 0.5 * k * ((after - before) * (after + before));
        sums[MSPRINGI_STRETCH_ENERGY] += k * after * after;
        sums[MSPRINGI_STRETCH_PULL] += k * fabs(after);
        sums[MSPRINGI_STRETCH_LENGTH] += k * length * length;
        sums[MSPRINGI_STRETCH_STIFFNESS] += stiffness;
        if (driven && !(m->mass[a] > 0.0f && m->mass[b] > 0.0f)) {
            const mspringi_spring_values values = mspringi_place_get(network, t->chain_places + i);
            const stretched s = stretch_of(m, &values);
            sums[MSPRINGI_STRETCH_GIVEN] += scale * given_by_pins(m, &values, &s);
        }
    }
}

static void add_sums(double *to, const double *from, size_t count) {
    for (size_t i = 0; i < count; ++i)
        to[i] += from[i];
}

// What the floor does work for, J, as far as it gives any.
static double work_of_floor(const mspring_network *network, const mspringi_motion *m) {
    const mspringi_floor *floor = network->floor;
    double sum = 0.0;
    for (uint32_t i = 0; floor && i < floor->contact_count; ++i) {
        const mspringi_contact *c = &floor->contacts[i];
        const double x = (double)m->axes[0].step[c->slot], y = (double)m->axes[1].step[c->slot];
        const double work = c->normal * (c->nx * x + c->ny * y) + c->along * (c->ny * x - c->nx * y);
        sum += c->is_active && work > 0.0 ? work : 0.0;
    }
    return sum / network->implicit->system.force_scale;
}

// What a loose particle adds to the sums over particles: as sum_moves() of kernels/system_energy.h.
static void add_loose(const mspringi_motion *m, size_t slot, double *sums) {
    const double mass = (double)m->mass[slot];
    sums[MSPRINGI_MOVE_MASS] += mass;
    sums[MSPRINGI_MOVE_COUNT] += mass > 0.0 ? 1.0 : 0.0;
    for (size_t axis = 0; axis < 2; ++axis) {
        const mspringi_motion_axis *c = &m->axes[axis];
        const passage p = passage_of(m, axis, slot);
        const double step = p.to - p.from, size = fabs((double)(c->solution[slot] + m->alpha * c->direction[slot]));
        const double force = mass > 0.0 && c->force ? (double)c->force[slot] : 0.0,
                     way = mass > 0.0 ? 0.0 : fabs(step);
        sums[MSPRINGI_MOVE_KINETIC] += mass * (p.slow * p.slow);
        sums[MSPRINGI_MOVE_GAIN] += mass * ((p.fast - p.slow) * (p.fast + p.slow));
        sums[MSPRINGI_MOVE_MOMENTUM + axis] += mass * p.slow;
        sums[MSPRINGI_MOVE_PUSH + axis] += mass * (p.fast - p.slow);
        sums[MSPRINGI_MOVE_WAY + axis] += mass * step;
        sums[MSPRINGI_MOVE_WORK] += force * step;
        sums[MSPRINGI_MOVE_FORCE + axis] += force;
        sums[MSPRINGI_MOVE_LARGEST] = size > sums[MSPRINGI_MOVE_LARGEST] ? size : sums[MSPRINGI_MOVE_LARGEST];
        sums[MSPRINGI_MOVE_DRIVEN] = way > sums[MSPRINGI_MOVE_DRIVEN] ? way : sums[MSPRINGI_MOVE_DRIVEN];
    }
}

// Note how far the loose ends of added springs move. Those of which only broken springs are left are not solved
// for, and what is there for them is needed yet.
static void step_loose(const mspring_network *network, const mspringi_motion *m) {
    const mspringi_topology *t = &network->topology;
    for (uint32_t i = t->woven_count; i < t->leftover_count; ++i) {
        const uint32_t ends[] = {t->leftover_a[i], t->leftover_b[i]};
        for (int end = 0; end < 2; ++end) {
            const size_t slot = ends[end];
            if (slot < (size_t)t->loose_first * MSPRINGI_WIDTH ||
                (m->mass[slot] > 0.0f && !mspringi_is_solved(network, network->implicit, slot)))
                continue;
            for (size_t axis = 0; axis < 2; ++axis) {
                const passage p = passage_of(m, axis, slot);
                m->axes[axis].step[slot] = (float)(p.to - p.from);
            }
        }
    }
}

// Sum up the shares of all workers.
static void gather(const substep_of *substep, const mspringi_motion *m, double *moves, double *stretches) {
    const mspring_network *network = substep->network;
    const mspringi_balance *balance = &network->implicit->balance;
    const size_t slots = (size_t)network->topology.loose_first * MSPRINGI_WIDTH;
    double largest = 0.0;
    for (size_t i = 0; i < (slots + MSPRINGI_CHUNK - 1) / MSPRINGI_CHUNK; ++i) {
        const double *chunk = balance->chunks + i * MSPRINGI_MOVE_SUMS;
        add_sums(moves, chunk, MSPRINGI_MOVE_SUMS);
        largest = chunk[MSPRINGI_MOVE_LARGEST] > largest ? chunk[MSPRINGI_MOVE_LARGEST] : largest;
    }
    moves[MSPRINGI_MOVE_LARGEST] = largest;
    const mspringi_slots added = slots_added_to(network);
    for (size_t slot = added.first; slot < added.end; ++slot)
        if (mspringi_is_solved(network, network->implicit, slot))
            add_loose(m, slot, moves);
    step_loose(network, m);
    for (size_t i = 0; i < network->implicit->panels.count; ++i)
        add_sums(stretches, balance->panels + i * MSPRINGI_STRETCH_SUMS, MSPRINGI_STRETCH_SUMS);
    add_leftover(network, m, moves[MSPRINGI_MOVE_DRIVEN] > 0.0, stretches);
}

/// What a substep comes to, J.
typedef struct result {
    double gain, motion;
    double noise;    ///< of the sums
    double rounding; ///< and of the substep itself
} result;

// All in the frame of the mass centre or, if there are pinned particles or a floor is touched, which work is done
// on the network by, in that of the world: so that flying does not count as motion that there is much of.
static result sum_up(const substep_of *substep, const mspringi_motion *m) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = network->implicit;
    double moves[MSPRINGI_MOVE_SUMS] = {0.0}, stretches[MSPRINGI_STRETCH_SUMS] = {0.0};
    gather(substep, m, moves, stretches);
    const double mass = moves[MSPRINGI_MOVE_MASS], h = (double)substep->h;
    const double per_mass = 1.0 / (double)substep->mass_scale, per_stiffness = 1.0 / n->scale;
    const double gravity[] = {(double)network->gravity_x, (double)network->gravity_y};
    const bool is_held = network->floor && network->floor->contact_count > 0;
    const bool is_free = !is_held && moves[MSPRINGI_MOVE_COUNT] == (double)n->balance.movable && mass > 0.0;
    double before = 0.5 * per_mass * moves[MSPRINGI_MOVE_KINETIC];
    double gain = 0.5 * per_mass * moves[MSPRINGI_MOVE_GAIN], work = moves[MSPRINGI_MOVE_WORK];
    for (size_t i = 0; i < 2; ++i) {
        const double momentum = per_mass * moves[MSPRINGI_MOVE_MOMENTUM + i];
        const double frame = is_free ? moves[MSPRINGI_MOVE_MOMENTUM + i] / mass : 0.0;
        before -= 0.5 * momentum * frame;
        gain -= per_mass * moves[MSPRINGI_MOVE_PUSH + i] * frame;
        work += gravity[i] * per_mass * (moves[MSPRINGI_MOVE_WAY + i] - mass * frame * h);
        work -= moves[MSPRINGI_MOVE_FORCE + i] * frame * h;
    }
    const double kinetic = before + gain, energy = 0.5 * per_stiffness * stretches[MSPRINGI_STRETCH_ENERGY];
    const double slip = DISPLACEMENT_ROUNDING * moves[MSPRINGI_MOVE_LARGEST];
    work += work_of_floor(network, m) + per_stiffness * stretches[MSPRINGI_STRETCH_GIVEN];
    gain += per_stiffness * stretches[MSPRINGI_STRETCH_GAIN];
    // What forces that are off by the rounding of lengths can do, at rest, too; of what moves; and of the sums.
    const double noise = LENGTH_ROUNDING * LENGTH_ROUNDING * per_stiffness * stretches[MSPRINGI_STRETCH_LENGTH] +
                         4.0 * LENGTH_ROUNDING * per_stiffness * sqrt(stretches[MSPRINGI_STRETCH_ERROR]) +
                         LENGTH_ROUNDING * (before + energy + fabs(work));
    return (result){
        .gain = gain - work,
        .motion = kinetic + energy,
        .noise = noise,
        .rounding = per_stiffness * stretches[MSPRINGI_STRETCH_PULL] * slip +
                    stretches[MSPRINGI_STRETCH_STIFFNESS] * slip * slip + noise,
    };
}

// Whether the substep may be taken; then it is in the ledger.
static bool is_accepted(const substep_of *substep, const mspringi_motion *m) {
    mspringi_ledger *ledger = &substep->network->implicit->ledger;
    const result r = sum_up(substep, m);
    const double faded = FADING * ledger->motion, motion = r.motion > faded ? r.motion : faded;
    const double gained = ledger->gained + r.gain - r.rounding, balance = ledger->balance + r.gain;
    if (!(gained <= TOLERATED * motion && balance - r.rounding <= TOLERATED * motion && motion <= DBL_MAX))
        return false;
    ledger->gained = gained > 0.0 ? gained : 0.0;
    ledger->balance = balance > -motion ? balance : -motion;
    ledger->motion = motion;
    substep->network->implicit->balance.surplus = balance > r.noise ? balance : 0.0;
    substep->network->implicit->balance.rounding = r.rounding;
    if (r.gain - r.rounding > HARMLESS * motion)
        ledger->look = MSPRINGI_LOOKS;
    if (balance > NOTABLE * motion)
        ledger->more = MSPRINGI_MORE_SUBSTEPS;
    return true;
}

// Sum up the motion of a chunk. One in which all sleep has none, and the springs of panels that reach into it find
// that its slots have made no step.
static void look_at_chunk(const substep_of *substep, const mspringi_motion *m, size_t first, size_t end) {
    const mspring_network *network = substep->network;
    double *sums = network->implicit->balance.chunks + first / MSPRINGI_CHUNK * MSPRINGI_MOVE_SUMS;
    if (mspringi_is_any_swept(network, first / MSPRINGI_WIDTH, end / MSPRINGI_WIDTH)) {
        network->kernels->system.move(m, first, end, sums);
        return;
    }
    memset(sums, 0, MSPRINGI_MOVE_SUMS * sizeof *sums);
    for (size_t axis = 0; axis < 2; ++axis)
        memset(m->axes[axis].step + first, 0, (end - first) * sizeof *m->axes[axis].step);
}

// The same of the springs of a panel.
static void look_at_panel(const substep_of *substep, const mspringi_motion *m, size_t number, bool driven) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = network->implicit;
    const mspringi_panel *panel = &n->panels.list[number];
    double *sums = n->balance.panels + number * MSPRINGI_STRETCH_SUMS;
    if (mspringi_panel_is_asleep(network, panel))
        memset(sums, 0, MSPRINGI_STRETCH_SUMS * sizeof *sums);
    else
        network->kernels->system.stretch(&n->system, m, network->topology.spans + panel->first_span,
                                         panel->span_count, panel->is_lattice, driven, sums);
}

bool mspringi_energy_look(const substep_of *substep, mspringi_mate *mate, float alpha) {
    const mspring_network *network = substep->network;
    mspringi_implicit *n = network->implicit;
    mspringi_balance *balance = &n->balance;
    const mspringi_motion motion = describe(substep, alpha);
    mspringi_meet(mate);
    if (mate->index == 0) {
        balance->looks = is_suspicious(substep, &motion);
        balance->fails = false;
        balance->surplus = 0.0;
    }
    mspringi_meet(mate);
    if (!balance->looks)
        return true;
    const size_t end = (size_t)network->topology.loose_first * MSPRINGI_WIDTH;
    const mspringi_slots slots = mspringi_slots_of(network, mate);
    for (size_t first = slots.first; first < slots.end && first < end; first += MSPRINGI_CHUNK) {
        const size_t chunk = first + MSPRINGI_CHUNK, least = chunk < slots.end ? chunk : slots.end;
        look_at_chunk(substep, &motion, first, least < end ? least : end);
    }
    mspringi_meet(mate);
    bool driven = false;
    for (size_t i = 0; i < (end + MSPRINGI_CHUNK - 1) / MSPRINGI_CHUNK; ++i)
        driven |= balance->chunks[i * MSPRINGI_MOVE_SUMS + MSPRINGI_MOVE_DRIVEN] > 0.0;
    for (size_t i = mspringi_share_of(mate, n->panels.count); i < mspringi_share_end(mate, n->panels.count); ++i)
        look_at_panel(substep, &motion, i, driven);
    mspringi_meet(mate);
    if (mate->index == 0)
        balance->fails = !is_accepted(substep, &motion);
    mspringi_meet(mate);
    return !balance->fails;
}

/* --------------------------------------------------------------------------------------------------- giving up */

void mspringi_energy_give_up(const substep_of *substep) {
    const mspring_network *network = substep->network;
    const mspringi_topology *t = &network->topology;
    mspringi_implicit *n = network->implicit;
    const mspringi_motion motion = describe(substep, n->alpha);
    const result r = sum_up(substep, &motion);
    double most = -1.0;
    n->gain =
        (mspringi_gain){.energy = n->ledger.gained + r.gain, .motion = n->ledger.motion, .place = MSPRING_NONE};
    for (mspringi_place place = 0; place < t->chain_places + t->leftover_count; ++place) {
        if (!is_live(network, place))
            continue;
        const mspringi_spring_values values = mspringi_place_get(network, place);
        const stretched s = stretch_of(&motion, &values);
        const double energy = s.stiffness * s.after * s.after;
        n->gain.place = energy > most ? place : n->gain.place;
        most = energy > most ? energy : most;
    }
    // Whatever it was, it was something.
    if (!(n->gain.energy > 0.0))
        n->gain.energy = INFINITY;
}

// The spring that lies at a place.
static mspring_id find_spring(const mspringi_topology *t, mspringi_place place) {
    mspringi_place_reader reader;
    mspring_id spring = 0;
    mspringi_places_begin(&reader, &t->places, 0);
    while (spring + 1 < t->spring_count && mspringi_places_next(&reader) != place)
        ++spring;
    return spring;
}

mspring_result mspringi_energy_verdict(mspring_network *network, double dt) {
    const mspringi_topology *t = &network->topology;
    if (!network->implicit || !(network->implicit->gain.energy > 0.0))
        return MSPRING_OK;
    const mspringi_gain gain = network->implicit->gain;
    if (gain.place == MSPRING_NONE)
        return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                             "a step of %g s (substeps: %u): energy would grow by %g J that nothing has added, "
                             "though all springs are broken: take a shorter step or more substeps",
                             dt, (unsigned)network->substeps, gain.energy);
    uint32_t base, tip;
    mspringi_topology_ends(t, gain.place, &base, &tip);
    const mspring_id spring = find_spring(t, gain.place);
    const mspring_id a = t->particle_of_slot[base], b = t->particle_of_slot[tip];
    return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                         "a step of %g s (substeps: %u): energy would grow by %g J that nothing has added, where "
                         "motion and springs have up to %g J; springs are too stiff to be followed so far, "
                         "even in %u pieces of a substep, as is spring %u between particles %u and %u: take a "
                         "shorter step, more substeps or less stiffness",
                         dt, (unsigned)network->substeps, gain.energy, gain.motion, (unsigned)MSPRINGI_MOST_PIECES,
                         (unsigned)spring, (unsigned)(a < b ? a : b), (unsigned)(a < b ? b : a));
}
