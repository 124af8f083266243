/// The floor among the contacts: what bodies press into it.
///
/// The floor has had its turn when contact begins, so all lies outside of it. Impulses of contact may press a
/// particle into it again, and what lies between the floor and a heavy body would be squeezed, for each would undo
/// what the other did. So the sweeps have a row for each particle that is near the surface: its velocity may not
/// carry it farther than there is room. What the row gives is the floor's impulse.
#include <math.h>

#include "contact/floor.h"
#include "contact/pairs.h"

static void add(mspringi_pairs *pairs, const mspringi_line *line, uint32_t p, uint32_t slot, double x, double y,
                double vx, double vy) {
    const double room = line->nx * x + line->ny * y + line->offset;
    if (!(room < pairs->thickness))
        return;
    pairs->bearings[pairs->bearing_count++] = (mspringi_bearing){.p = p,
                                                                 .slot = slot,
                                                                 .nx = line->nx,
                                                                 .ny = line->ny,
                                                                 .room = room > 0.0 ? room : 0.0,
                                                                 .own = vx * line->nx + vy * line->ny,
                                                                 .friction = line->friction};
}

void mspringi_bearing_find(const mspring_network *network, mspringi_pairs *pairs) {
    const mspringi_active *k = &pairs->active;
    mspringi_floor *floor = network->floor;
    pairs->bearing_count = 0;
    if (!floor || pairs->touch_count == 0)
        return;
    mspringi_floor_follow(floor, network->origin_x, network->origin_y);
    for (uint32_t i = 0; i < k->own; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]], before = pairs->bearing_count;
        const double x = mspringi_x_of(&network->state, slot), y = mspringi_y_of(&network->state, slot);
        if (k->weight[i] == 0.0)
            continue;
        for (uint32_t l = 0; l < floor->plane_count && pairs->bearing_count < before + MSPRINGI_BEARINGS; ++l)
            add(pairs, &floor->lines[l], i, slot, x, y, k->v[i].x, k->v[i].y);
        if (floor->heights.count > 0 && pairs->bearing_count < before + MSPRINGI_BEARINGS) {
            const mspringi_line line =
                mspringi_heights_line(&floor->heights, mspringi_heights_part_below(&floor->heights, x));
            add(pairs, &line, i, slot, x, y, k->v[i].x, k->v[i].y);
        }
    }
}

void mspringi_bearing_begin(const mspringi_pairs *pairs, double h) {
    const mspringi_active *k = &pairs->active;
    for (uint32_t i = 0; i < pairs->bearing_count; ++i) {
        mspringi_bearing *g = &pairs->bearings[i];
        const double room = g->room + k->way_x[g->p] * g->nx + k->way_y[g->p] * g->ny;
        g->least = g->own - (room > 0.0 ? room / h : 0.0);
        g->across = g->along = 0.0;
    }
}

void mspringi_bearing_sweep(const mspringi_pairs *pairs) {
    const mspringi_active *k = &pairs->active;
    for (uint32_t i = 0; i < pairs->bearing_count; ++i) {
        mspringi_bearing *g = &pairs->bearings[i];
        const double speed = k->v[g->p].x * g->nx + k->v[g->p].y * g->ny, sum = g->across + (g->least - speed);
        const double across = sum > 0.0 ? sum : 0.0, by = across - g->across;
        if (across == 0.0 && g->across == 0.0)
            continue;
        g->across = across;
        k->v[g->p].x += by * g->nx;
        k->v[g->p].y += by * g->ny;
        const double slide = k->v[g->p].y * g->nx - k->v[g->p].x * g->ny, most = g->friction * across;
        const double wanted = g->along - slide, along = wanted > most ? most : wanted < -most ? -most : wanted;
        k->v[g->p].x -= (along - g->along) * g->ny;
        k->v[g->p].y += (along - g->along) * g->nx;
        g->along = along;
    }
}

void mspringi_bearing_end(const mspring_network *network, const mspringi_pairs *pairs) {
    const mspringi_active *k = &pairs->active;
    mspringi_floor *floor = network->floor;
    for (uint32_t i = 0; i < pairs->bearing_count; ++i) {
        const mspringi_bearing *g = &pairs->bearings[i];
        if (g->across == 0.0)
            continue;
        floor->impulse.x[g->slot] += (float)((g->across * g->nx - g->along * g->ny) / k->weight[g->p]);
        floor->impulse.y[g->slot] += (float)((g->across * g->ny + g->along * g->nx) / k->weight[g->p]);
        floor->has_impulse = true;
    }
}
