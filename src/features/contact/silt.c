/// Silt: a soft layer above the heights that brakes what is in it.
#include "features/contact/floor.h"

double mspringi_silt_damping(const mspringi_heights *h, double x, double y, double seconds) {
    if (!mspringi_has_silt(h))
        return 0.0;
    const double place = (x - h->local_x) / h->spacing, rate_h = h->silt_rate * seconds;
    const double above = y - (h->local_y + mspringi_height_at(h->heights, h->count, place));
    return h->silt_depths
               ? mspringi_uneven_silt_damping_at(above, mspringi_height_at(h->silt_depths, h->count, place), rate_h)
               : mspringi_silt_damping_at(above, h->silt_depth, rate_h);
}

// Only the velocity: to move positions behind an implicit solver's back would stretch springs.
void mspringi_silt_brake(const mspring_network *network, size_t slot, double h) {
    const mspringi_state *s = &network->state;
    const mspringi_floor *floor = network->floor;
    const double keeps = 1.0 - mspringi_silt_damping(&floor->heights, (double)s->x[slot], (double)s->y[slot], h);
    const float vx = (float)(keeps * (double)s->vx[slot]), vy = (float)(keeps * (double)s->vy[slot]);
    const float mass = 1.0f / network->inverse_mass[slot];
    floor->impulse.x[slot] += mass * (vx - s->vx[slot]);
    floor->impulse.y[slot] += mass * (vy - s->vy[slot]);
    s->vx[slot] = vx;
    s->vy[slot] = vy;
}
