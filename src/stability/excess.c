/// What implicit substeps have made of nothing, taken out of the motion again.
///
/// The velocities of all that hangs together are brought nearer to that of its mass centre, or to rest if a pinned
/// particle is in it or it touches a floor, all by the same factor: whatever flies apart keeps its momentum. That
/// only ever takes energy, and where integrators take some themselves there is nothing left for it.
#include "energy.h"

#include <math.h>
#include <string.h>

#include "components/roots.h"
#include "contact/floor.h"
#include "implicit/implicit.h"

/// Most of the kinetic energy beside flight that is taken in a substep; what is left then is taken in the next
/// ones.
#define MOST_TAKEN 0.5

enum { MASS, MOMENTUM_X, MOMENTUM_Y };

// Number what hangs together, in the order of the lowest slots; what hangs on nothing gets none. Returns how many
// there are. Until it has its number, a lowest slot is marked.
static uint32_t number_bodies(const mspring_network *network, uint32_t *body) {
    const uint32_t slots = (uint32_t)mspringi_slot_count(network), mark = UINT32_C(1) << 31;
    uint32_t count = 0;
    mspringi_find_roots(network, body);
    for (uint32_t slot = 0; slot < slots; ++slot)
        if ((body[slot] & ~mark) != slot)
            body[body[slot]] |= mark;
    for (uint32_t slot = 0; slot < slots; ++slot) {
        if (body[slot] & mark)
            body[slot] = count++;
        else
            body[slot] = body[slot] == slot ? MSPRING_NONE : body[body[slot]];
    }
    return count;
}

static double mass_of(const mspring_network *network, size_t slot) {
    return 1.0 / (double)network->inverse_mass[slot];
}

// Find the velocities that all bodies have in common: of those that are held, none.
static void sum_bodies(const mspring_network *network, uint32_t count) {
    const mspringi_balance *balance = &network->implicit->balance;
    const mspringi_state *s = &network->state;
    const size_t slots = mspringi_slot_count(network);
    memset(balance->bodies, 0, count * sizeof *balance->bodies);
    for (size_t slot = 0; slot < slots; ++slot) {
        if (balance->body[slot] == MSPRING_NONE)
            continue;
        double *sums = balance->bodies[balance->body[slot]];
        const double mass = network->inverse_mass[slot] > 0.0f ? mass_of(network, slot) : INFINITY;
        sums[MASS] += mass;
        sums[MOMENTUM_X] += mass < INFINITY ? mass * (double)s->vx[slot] : 0.0;
        sums[MOMENTUM_Y] += mass < INFINITY ? mass * (double)s->vy[slot] : 0.0;
    }
    const mspringi_floor *floor = network->floor;
    for (uint32_t i = 0; floor && i < floor->contact_count; ++i)
        if (balance->body[floor->contacts[i].slot] != MSPRING_NONE)
            balance->bodies[balance->body[floor->contacts[i].slot]][MASS] = INFINITY;
    for (uint32_t b = 0; b < count; ++b) {
        double *sums = balance->bodies[b];
        sums[MOMENTUM_X] /= sums[MASS];
        sums[MOMENTUM_Y] /= sums[MASS];
    }
}

// Kinetic energy beside that of the common velocities.
static double sum_motion(const mspring_network *network) {
    const mspringi_balance *balance = &network->implicit->balance;
    double sum = 0.0;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        if (balance->body[slot] == MSPRING_NONE || !(network->inverse_mass[slot] > 0.0f))
            continue;
        const double *frame = balance->bodies[balance->body[slot]];
        const double x = (double)network->state.vx[slot] - frame[MOMENTUM_X];
        const double y = (double)network->state.vy[slot] - frame[MOMENTUM_Y];
        sum += 0.5 * mass_of(network, slot) * (x * x + y * y);
    }
    return sum;
}

// Leave that factor of the velocities beside the common ones. Returns the energy that it takes, J.
static double slow_down(const mspring_network *network, double factor) {
    const mspringi_balance *balance = &network->implicit->balance;
    float *const velocities[] = {network->state.vx, network->state.vy};
    double taken = 0.0;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        if (balance->body[slot] == MSPRING_NONE || !(network->inverse_mass[slot] > 0.0f))
            continue;
        const double *frame = balance->bodies[balance->body[slot]];
        for (size_t axis = 0; axis < 2; ++axis) {
            const double before = (double)velocities[axis][slot], common = frame[MOMENTUM_X + axis];
            const float after = (float)(common + factor * (before - common));
            velocities[axis][slot] = after;
            taken += 0.5 * mass_of(network, slot) * ((before - (double)after) * (before + (double)after));
        }
    }
    return taken;
}

void mspringi_energy_settle(const mspringi_substep_of *substep) {
    const mspring_network *network = substep->network;
    mspringi_implicit *n = network->implicit;
    mspringi_ledger *ledger = &n->ledger;
    sum_bodies(network, number_bodies(network, n->balance.body));
    const double motion = sum_motion(network), share = motion > 0.0 ? n->balance.surplus / motion : 0.0;
    ledger->balance -= slow_down(network, sqrt(1.0 - (share < MOST_TAKEN ? share : MOST_TAKEN)));
    // What rounding has made where nothing moves.
    if (ledger->balance > 0.0)
        ledger->balance = ledger->balance > n->balance.rounding ? ledger->balance - n->balance.rounding : 0.0;
}
