/// Floor supports: constraints of particles that other bodies may press into the floor.
///
/// All particles lie outside the floor when contact begins, but impulses of contact may press them into it. Floor
/// and contact in turn would undo each other, and squeeze a particle between the floor and a heavy body. So the
/// sweeps visit a constraint for each particle near the surface. It bounds the velocity into the surface by the
/// gap left. Its impulse counts as the floor's.
#include <math.h>

#include "features/contact/contacts.h"
#include "features/contact/floor.h"

// Add the support of a particle by a surface, if it is within the thickness.
static void add_support(mspringi_contacts *contacts, const mspringi_line *line, uint32_t p, uint32_t slot, double x,
                        double y, double vx, double vy) {
    const mspringi_contact_material *materials = contacts->materials;
    const double gap = mspringi_distance_from_line(line, x, y);
    if (!(gap < contacts->thickness))
        return;
    contacts->supports[contacts->support_count++] = (mspringi_floor_support){
        .p = p,
        .slot = slot,
        .nx = line->nx,
        .ny = line->ny,
        .gap = gap,
        .free_speed = vx * line->nx + vy * line->ny,
        .friction = mspringi_friction_on(line, materials ? &materials[contacts->nodes.particles[p]] : NULL)};
}

void mspringi_floor_support_find(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    mspringi_floor *floor = network->floor;
    contacts->support_count = 0;
    if (!floor || contacts->constraint_count == 0)
        return;
    mspringi_floor_set_origin(floor, network->origin_x, network->origin_y);
    for (uint32_t i = 0; i < k->particle_count; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]], before = contacts->support_count;
        const double x = mspringi_x_of(&network->state, slot), y = mspringi_y_of(&network->state, slot);
        if (k->inverse_mass[i] == 0.0)
            continue;
        for (uint32_t l = 0; l < floor->plane_count && contacts->support_count < before + MSPRINGI_MAX_SUPPORTS;
             ++l)
            add_support(contacts, &floor->lines[l], i, slot, x, y, k->v[i].x, k->v[i].y);
        if (floor->heights.count > 0 && contacts->support_count < before + MSPRINGI_MAX_SUPPORTS) {
            const mspringi_line line =
                mspringi_heights_line(&floor->heights, mspringi_heights_find_part(&floor->heights, x));
            add_support(contacts, &line, i, slot, x, y, k->v[i].x, k->v[i].y);
        }
    }
}

void mspringi_floor_support_begin(const mspringi_contacts *contacts, double h) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    for (uint32_t i = 0; i < contacts->support_count; ++i) {
        mspringi_floor_support *g = &contacts->supports[i];
        const double gap = fmax(g->gap, 0.0) + k->shift_x[g->p] * g->nx + k->shift_y[g->p] * g->ny;
        g->min_speed = g->free_speed - (gap > 0.0 ? gap / h : 0.0);
        g->across = g->along = 0.0;
    }
}

void mspringi_floor_support_begin_implicit(const mspringi_contacts *contacts, double h) {
    for (uint32_t i = 0; i < contacts->support_count; ++i) {
        mspringi_floor_support *g = &contacts->supports[i];
        g->min_speed = g->free_speed - g->gap / h;
        g->across = g->along = 0.0;
    }
}

void mspringi_floor_support_sweep(const mspringi_contacts *contacts) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    for (uint32_t i = 0; i < contacts->support_count; ++i) {
        mspringi_floor_support *g = &contacts->supports[i];
        const double speed = k->v[g->p].x * g->nx + k->v[g->p].y * g->ny, sum = g->across + (g->min_speed - speed);
        const double across = sum > 0.0 ? sum : 0.0, by = across - g->across;
        g->has_moved = false;
        if (across == 0.0 && g->across == 0.0)
            continue;
        g->across = across;
        k->v[g->p].x += by * g->nx;
        k->v[g->p].y += by * g->ny;
        const double slide = k->v[g->p].y * g->nx - k->v[g->p].x * g->ny, most = g->friction * across;
        const double wanted = g->along - slide, along = wanted > most ? most : wanted < -most ? -most : wanted;
        k->v[g->p].x -= (along - g->along) * g->ny;
        k->v[g->p].y += (along - g->along) * g->nx;
        g->has_moved = by != 0.0 || along != g->along;
        g->along = along;
    }
}

void mspringi_floor_support_end(const mspring_network *network, const mspringi_contacts *contacts) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    mspringi_floor *floor = network->floor;
    for (uint32_t i = 0; i < contacts->support_count; ++i) {
        const mspringi_floor_support *g = &contacts->supports[i];
        if (g->across == 0.0)
            continue;
        floor->impulse.x[g->slot] += (float)((g->across * g->nx - g->along * g->ny) / k->inverse_mass[g->p]);
        floor->impulse.y[g->slot] += (float)((g->across * g->ny + g->along * g->nx) / k->inverse_mass[g->p]);
        floor->has_impulse = true;
    }
}
