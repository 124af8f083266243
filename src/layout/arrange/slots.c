/// Giving every particle a slot and every spring a place.
#include "layout/emit/assembly.h"
#include "layout/emit/spare.h"

#include <string.h>

static void place_particle(mspringi_topology *t, uint32_t particle, uint32_t slot) {
    t->slot_of_particle[particle] = slot;
    t->particle_of_slot[slot] = particle;
}

mspring_result mspringi_assembly_reserve_maps(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    const size_t slots = (size_t)t->block_count * MSPRINGI_WIDTH;
    t->slot_of_particle = mspringi_alloc(a->memory, t->reserve.particle_end, sizeof *t->slot_of_particle);
    t->particle_of_slot = mspringi_alloc(a->memory, slots, sizeof *t->particle_of_slot);
    if (!t->slot_of_particle || !t->particle_of_slot)
        return mspringi_assembly_fail(a);
    memset(t->particle_of_slot, 0xff, slots * sizeof *t->particle_of_slot);
    a->loose = t->loose_first * MSPRINGI_WIDTH;
    return MSPRING_OK;
}

void mspringi_assembly_assign_slots(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_topology *t = a->topology;
    const mspringi_grids *grids = &a->grids;
    for (uint32_t p = first; p < end; ++p) {
        if (a->kinds[p] == MSPRINGI_ROW_LATTICE) {
            const uint32_t block = mspringi_assembly_find_block(a, grids->grid_of[p], grids->row[p],
                                                                grids->column[p] / MSPRINGI_WIDTH);
            place_particle(t, p, (t->lattice_first + block) * MSPRINGI_WIDTH + grids->column[p] % MSPRINGI_WIDTH);
        } else if (mspringi_assembly_is_loose(a, p)) {
            place_particle(t, p, a->loose++);
        } else if (a->kinds[p] == MSPRINGI_ROW_LOOSE && p >= t->reserve.first_particle) {
            t->slot_of_particle[p] = mspringi_spare_slot(t, p);
        }
    }
}

void mspringi_assembly_assign_other_slots(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t web_place = 0;
    for (uint32_t i = 0; i < a->strands.count; ++i)
        place_particle(t, a->strands.particles[i], t->chain_first * MSPRINGI_WIDTH + i);
    for (uint32_t i = 0; i < a->web.count; ++i) {
        web_place = mspringi_assembly_web_place(a, i, web_place);
        place_particle(t, a->web.particles[i], t->web_first * MSPRINGI_WIDTH + web_place);
    }
    for (mspring_id p = t->particle_count; p < t->reserve.particle_end; ++p)
        t->slot_of_particle[p] = mspringi_spare_slot(t, p);
}

mspring_result mspringi_assembly_begin_places(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    const uint32_t springs = t->reserve.spring_end;
    t->place_of_spring = mspringi_alloc(a->memory, springs, sizeof *t->place_of_spring);
    if (!t->place_of_spring)
        return mspringi_assembly_fail(a);
    memset(t->place_of_spring, 0xff, springs * sizeof *t->place_of_spring);
    for (uint32_t i = 0; i < a->strands.count; ++i)
        if (a->strands.springs[i] != MSPRING_NONE)
            t->place_of_spring[a->strands.springs[i]] = t->lattice_places + i;
    return MSPRING_OK;
}

// In an array: lattice springs where they are, and the others one after the other.
void mspringi_assembly_assign_places(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_topology *t = a->topology;
    mspringi_place *places = a->topology->place_of_spring;
    for (uint32_t s = first; s < end; ++s) {
        mspringi_lattice_spring found;
        if (places[s] != MSPRING_NONE)
            continue;
        if (!mspringi_graph_place(&a->graph, &a->grids, s, &found)) {
            places[s] = t->chain_places + t->leftover_count++;
            continue;
        }
        // The spring's first particle is in its block, in the one to the right, or in the one above or both.
        const uint32_t grid = a->grids.grid_of[a->builder->springs[s].a];
        const uint32_t block = mspringi_assembly_find_block(a, grid, found.row, found.column / MSPRINGI_WIDTH);
        places[s] = (block * MSPRINGI_DIRECTIONS + (uint32_t)found.direction) * MSPRINGI_WIDTH +
                    found.column % MSPRINGI_WIDTH;
        t->lattice_springs++;
    }
}

mspring_result mspringi_assembly_note_ends(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    t->woven_count = t->leftover_capacity = t->leftover_count;
    t->leftover_a = mspringi_alloc(a->memory, t->leftover_count, sizeof *t->leftover_a);
    t->leftover_b = mspringi_alloc(a->memory, t->leftover_count, sizeof *t->leftover_b);
    if (!t->leftover_a || !t->leftover_b)
        return mspringi_assembly_fail(a);
    for (uint32_t s = 0; s < t->spring_count; ++s) {
        if (t->place_of_spring[s] < t->chain_places)
            continue;
        const uint32_t i = t->place_of_spring[s] - t->chain_places;
        t->leftover_a[i] = t->slot_of_particle[a->builder->springs[s].a];
        t->leftover_b[i] = t->slot_of_particle[a->builder->springs[s].b];
    }
    return MSPRING_OK;
}

void mspringi_topology_ends(const mspringi_topology *topology, mspringi_place place, uint32_t *base,
                            uint32_t *tip) {
    const uint32_t lane = place % MSPRINGI_WIDTH;
    if (place >= topology->chain_places) {
        *base = topology->leftover_a[place - topology->chain_places];
        *tip = topology->leftover_b[place - topology->chain_places];
    } else if (place >= topology->lattice_places) {
        *base = topology->chain_first * MSPRINGI_WIDTH + (place - topology->lattice_places);
        *tip = *base + 1;
    } else {
        const uint32_t block = place / (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH);
        const uint32_t here = (topology->lattice_first + block) * MSPRINGI_WIDTH + lane;
        const uint32_t up = topology->up_of_block[block] * MSPRINGI_WIDTH + lane;
        switch ((mspringi_direction)(place / MSPRINGI_WIDTH % MSPRINGI_DIRECTIONS)) {
        case MSPRINGI_NORTH:
            *base = here;
            *tip = up;
            break;
        case MSPRINGI_NORTH_EAST:
            *base = here;
            *tip = up + 1;
            break;
        case MSPRINGI_SOUTH_EAST:
            *base = up;
            *tip = here + 1;
            break;
        default:
            *base = here;
            *tip = here + 1;
            break;
        }
    }
}
