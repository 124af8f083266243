/// A solver: forward Euler in double precision, whose object is the forces of a substep.
#include <math.h>
#include <string.h>

#include "store/network.h"
#include "store/springs.h"

typedef struct euler {
    double *forces; ///< [2][slots]
} euler;

static mspring_result create(mspring_network *network, const mspring_settings *def, uint32_t tile_size,
                             void **object) {
    euler *made = mspringi_alloc(&network->memory, 1, sizeof *made);
    (void)def;
    (void)tile_size;
    if (made)
        made->forces = mspringi_alloc(&network->memory, 2 * mspringi_slot_count(network), sizeof *made->forces);
    if (!made || !made->forces) {
        mspringi_free(&network->memory, made);
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for forces");
    }
    *object = made;
    return MSPRING_OK;
}

static void get_def(const void *object, mspring_settings *def) {
    (void)object;
    (void)def; // nothing but the kind
}

static void destroy(void *object, mspringi_memory *memory) {
    euler *of = object;
    if (of)
        mspringi_free(memory, of->forces);
    mspringi_free(memory, of);
}

static void relocate(void *object, const mspring_network *network, const mspringi_memory *from,
                     const mspringi_memory *to) {
    euler *of = object;
    (void)network;
    of->forces = mspringi_memory_relocate(from, to, of->forces);
}

static void add_spring(const mspring_network *network, mspring_id spring, double *x, double *y) {
    const mspringi_spring_values values = mspringi_spring_get(network, spring);
    const mspringi_state *s = &network->state;
    const uint32_t a = values.base, b = values.tip;
    const double dx = mspringi_x_of(s, b) - mspringi_x_of(s, a), dy = mspringi_y_of(s, b) - mspringi_y_of(s, a);
    const double length = sqrt(dx * dx + dy * dy), inverse = length > 0.0 ? 1.0 / length : 0.0;
    const double rate =
        (((double)s->vx[b] - (double)s->vx[a]) * dx + ((double)s->vy[b] - (double)s->vy[a]) * dy) * inverse;
    const double pull =
        ((double)values.stiffness * (length - (double)values.rest_length) + (double)values.damping * rate) *
        inverse;
    x[a] += pull * dx;
    y[a] += pull * dy;
    x[b] -= pull * dx;
    y[b] -= pull * dy;
}

static void substeps(mspring_network *network, void *object, float h, mspringi_field base, uint32_t count) {
    const size_t slots = mspringi_slot_count(network);
    const mspringi_state *s = &network->state;
    double *const x = ((euler *)object)->forces, *const y = x + slots;
    const double step = (double)h;
    for (; count > 0; --count) {
        memset(x, 0, 2 * slots * sizeof *x);
        for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring)
            add_spring(network, spring, x, y);
        for (size_t slot = 0; slot < slots; ++slot) {
            const double inverse_mass = (double)network->inverse_mass[slot];
            if (!(inverse_mass > 0.0))
                continue;
            const double force_x = x[slot] + (base.x ? (double)base.x[slot] : 0.0);
            const double force_y = y[slot] + (base.x ? (double)base.y[slot] : 0.0);
            mspringi_set_x(s, slot, mspringi_x_of(s, slot) + step * (double)s->vx[slot]);
            mspringi_set_y(s, slot, mspringi_y_of(s, slot) + step * (double)s->vy[slot]);
            s->vx[slot] += (float)(step * (force_x * inverse_mass + (double)network->settings.gravity_x));
            s->vy[slot] += (float)(step * (force_y * inverse_mass + (double)network->settings.gravity_y));
        }
    }
}

// A floor would let those of the loose row fly past it.
static bool is_isolated(const mspring_network *network, const void *object, size_t slot) {
    (void)object;
    return slot / MSPRINGI_WIDTH >= network->topology.loose_first;
}

const mspringi_solver_ops house_euler_ops = {
    .create = create,
    .get_def = get_def,
    .destroy = destroy,
    .relocate = relocate,
    .substeps = substeps,
    .is_isolated = is_isolated,
};
