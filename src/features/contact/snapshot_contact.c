/// Snapshot of the shape from which contact finds outlines. The rest of contact is a setting of the host.
#include <math.h>

#include "features/contact/contacts.h"
#include "store/sections.h"

#define ORIGIN_BYTES (2 * sizeof(double))

static size_t bytes(const mspring_network *network) {
    return ORIGIN_BYTES + 2 * sizeof(double) * network->topology.reserve.particle_end;
}

static size_t shape_size(const mspring_network *network) {
    return network->contacts ? bytes(network) : 0;
}

// NaN stands for unknown.
static void shape_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_outline *o = &network->contacts->outline;
    const double origin[] = {o->origin_x, o->origin_y};
    mspringi_put(to, origin, 2, sizeof origin[0]);
    for (mspring_id p = 0; p < network->topology.reserve.particle_end; ++p) {
        const double place[] = {o->is_known[p] ? o->shape_x[p] : NAN, o->is_known[p] ? o->shape_y[p] : NAN};
        mspringi_put(to, place, 2, sizeof place[0]);
    }
}

static const uint8_t *read_place(const uint8_t *from, double *x, double *y) {
    from = mspringi_get(from, x, 1, sizeof *x);
    return mspringi_get(from, y, 1, sizeof *y);
}

static bool is_coordinate(double value) {
    return fabs(value) <= 4.0 * MSPRING_MAX_COORDINATE;
}

static mspring_result shape_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_shape;
    double x, y;
    if (size == 0)
        return MSPRING_OK;
    mspring_result result = mspringi_section_check_size(network, section, size, bytes(network));
    if (result != MSPRING_OK)
        return result;
    from = read_place(from, &x, &y);
    if (!is_coordinate(x) || !is_coordinate(y))
        return mspringi_section_fail(network, section, "the origin is (%g, %g) m", x, y);
    for (mspring_id p = 0; p < network->topology.reserve.particle_end; ++p) {
        from = read_place(from, &x, &y);
        if (!(isnan(x) && isnan(y)) && !(is_coordinate(x) && is_coordinate(y)))
            return mspringi_section_fail(network, section, "particle %u was at (%g, %g) m", (unsigned)p, x, y);
    }
    return MSPRING_OK;
}

// A network without contact ignores the shape. One with contact keeps its own if the snapshot has none.
static void shape_load(mspring_network *network, const uint8_t *from, size_t size) {
    if (!network->contacts)
        return;
    mspringi_outline *o = &network->contacts->outline;
    double x, y;
    network->contacts->colliders.reported = UINT64_MAX; // no impulses on colliders from a step of another run
    mspringi_contact_events_reset(network->contacts);
    if (size == 0)
        return;
    from = read_place(from, &x, &y);
    o->is_found &= x == o->origin_x && y == o->origin_y; // breaking notifies otherwise
    o->origin_x = x;
    o->origin_y = y;
    for (mspring_id p = 0; p < network->topology.reserve.particle_end; ++p) {
        from = read_place(from, &x, &y);
        const uint8_t is_known = (uint8_t)(isnan(x) ? 0 : 1);
        o->is_found &= is_known == o->is_known[p] && (!is_known || (x == o->shape_x[p] && y == o->shape_y[p]));
        o->shape_x[p] = x;
        o->shape_y[p] = y;
        o->is_known[p] = is_known;
    }
}

const mspringi_section mspringi_section_shape = {"shap",     "shape of outlines", false,      shape_size,
                                                 shape_save, shape_check,         shape_load, NULL};
