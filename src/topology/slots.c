/// Giving every particle a slot and every spring a place.
#include "assembly.h"
#include "spare.h"

#include <string.h>

static void place_particle(mspringi_topology *t, uint32_t particle, uint32_t slot) {
    t->slot_of_particle[particle] = slot;
    t->particle_of_slot[slot] = particle;
}

mspring_result mspringi_assembly_reserve_maps(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    const size_t slots = (size_t)t->block_count * MSPRINGI_WIDTH;
    t->slot_of_particle =
        mspringi_pace_alloc(&a->pace, a->memory, t->reserve.particle_end, sizeof *t->slot_of_particle);
    t->particle_of_slot = mspringi_pace_alloc(&a->pace, a->memory, slots, sizeof *t->particle_of_slot);
    if (!t->slot_of_particle || !t->particle_of_slot)
        return mspringi_assembly_fail(a);
    memset(t->particle_of_slot, 0xff, slots * sizeof *t->particle_of_slot);
    a->loose = t->loose_first * MSPRINGI_WIDTH;
    a->web_place = 0;
    return MSPRING_OK;
}

mspring_result mspringi_assembly_assign_slots(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    const mspringi_grids *grids = &a->grids;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->particle_count, 8, &first, &end);
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
    return MSPRING_OK;
}

mspring_result mspringi_assembly_assign_chain_slots(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, a->strands.count, 1, &first, &end);
    for (uint32_t i = first; i < end; ++i)
        place_particle(t, a->strands.particles[i], t->chain_first * MSPRINGI_WIDTH + i);
    return MSPRING_OK;
}

mspring_result mspringi_assembly_assign_web_slots(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, a->web.count, 2, &first, &end);
    for (uint32_t i = first; i < end; ++i) {
        a->web_place = mspringi_assembly_web_place(a, i, a->web_place);
        place_particle(t, a->web.particles[i], t->web_first * MSPRINGI_WIDTH + a->web_place);
    }
    return MSPRING_OK;
}

mspring_result mspringi_assembly_assign_spare_slots(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->reserve.particle_end - t->particle_count, 1, &first, &end);
    for (mspring_id p = t->particle_count + first; p < t->particle_count + end; ++p)
        t->slot_of_particle[p] = mspringi_spare_slot(t, p);
    return MSPRING_OK;
}

mspring_result mspringi_assembly_begin_places(mspringi_assembly *a) {
    const uint32_t springs = a->topology->reserve.spring_end;
    a->topology->place_of_spring =
        mspringi_pace_alloc(&a->pace, a->memory, springs, sizeof *a->topology->place_of_spring);
    if (!a->topology->place_of_spring)
        return mspringi_assembly_fail(a);
    memset(a->topology->place_of_spring, 0xff, springs * sizeof *a->topology->place_of_spring);
    return MSPRING_OK;
}

mspring_result mspringi_assembly_assign_chain_places(mspringi_assembly *a) {
    uint32_t first, end;
    mspringi_pace_take(&a->pace, a->strands.count, 1, &first, &end);
    for (uint32_t i = first; i < end; ++i)
        if (a->strands.springs[i] != MSPRING_NONE)
            a->topology->place_of_spring[a->strands.springs[i]] = a->topology->lattice_places + i;
    return MSPRING_OK;
}

// In an array: lattice springs where they are, and the others one after the other.
mspring_result mspringi_assembly_assign_places(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    mspringi_place *places = a->topology->place_of_spring;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->spring_count, 12, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        mspringi_lattice_spring found;
        if (places[s] != MSPRING_NONE)
            continue;
        if (!mspringi_grids_place(&a->grids, &a->builder->springs[s], &found)) {
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
    return MSPRING_OK;
}

mspring_result mspringi_assembly_reserve_ends(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    t->woven_count = t->leftover_capacity = t->leftover_count;
    t->leftover_a = mspringi_pace_alloc(&a->pace, a->memory, t->leftover_count, sizeof *t->leftover_a);
    t->leftover_b = mspringi_pace_alloc(&a->pace, a->memory, t->leftover_count, sizeof *t->leftover_b);
    return t->leftover_a && t->leftover_b ? MSPRING_OK : mspringi_assembly_fail(a);
}

mspring_result mspringi_assembly_note_ends(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->spring_count, 1, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        if (a->topology->place_of_spring[s] < t->chain_places)
            continue;
        const uint32_t i = a->topology->place_of_spring[s] - t->chain_places;
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
