/// Slots of particles and springs.
#include "layout/emit/layout_builder.h"
#include "layout/emit/spare.h"

#include <string.h>

static void place_particle(mspringi_topology *t, uint32_t particle, uint32_t slot) {
    t->slot_of_particle[particle] = slot;
    t->particle_of_slot[slot] = particle;
}

mspring_result mspringi_layout_builder_reserve_maps(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    const size_t slots = (size_t)t->block_count * MSPRINGI_WIDTH;
    t->slot_of_particle = mspringi_alloc(a->memory, t->reserve.particle_end, sizeof *t->slot_of_particle);
    t->particle_of_slot = mspringi_alloc_unset(a->memory, slots, sizeof *t->particle_of_slot);
    a->busy = mspringi_alloc(a->memory, t->block_count, sizeof *a->busy);
    if (!t->slot_of_particle || !t->particle_of_slot || !a->busy)
        return mspringi_layout_builder_fail(a);
    memset(t->particle_of_slot, 0xff, slots * sizeof *t->particle_of_slot);
    a->loose = t->loose_first * MSPRINGI_WIDTH;
    return MSPRING_OK;
}

void mspringi_layout_builder_assign_slots(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_topology *t = a->topology;
    const mspringi_grids *grids = &a->grids;
    for (uint32_t p = first; p < end; ++p) {
        if (a->kinds[p] == MSPRINGI_ROW_LATTICE) {
            const uint32_t column = grids->column[p];
            const uint32_t block =
                mspringi_layout_builder_find_block(a, grids->grid_of[p], grids->row[p], column / MSPRINGI_WIDTH);
            const uint32_t slot = (t->lattice_first + block) * MSPRINGI_WIDTH + column % MSPRINGI_WIDTH;
            place_particle(t, p, slot);
            mspringi_mark_busy(a->busy, slot);
        } else if (mspringi_layout_builder_is_loose(a, p)) {
            place_particle(t, p, a->loose++);
        } else if (a->kinds[p] == MSPRINGI_ROW_LOOSE && p >= t->reserve.first_particle) {
            t->slot_of_particle[p] = mspringi_spare_slot(t, p);
        }
    }
}

void mspringi_layout_builder_assign_other_slots(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    uint32_t irregular_slot = 0;
    for (uint32_t i = 0; i < a->chains.count; ++i)
        place_particle(t, a->chains.particles[i], t->chain_first * MSPRINGI_WIDTH + i);
    for (uint32_t i = 0; i < a->irregular.count; ++i) {
        irregular_slot = mspringi_layout_builder_irregular_slot(a, i, irregular_slot);
        place_particle(t, a->irregular.particles[i], t->irregular_first * MSPRINGI_WIDTH + irregular_slot);
    }
    for (mspring_id p = t->particle_count; p < t->reserve.particle_end; ++p)
        t->slot_of_particle[p] = mspringi_spare_slot(t, p);
}

mspring_result mspringi_layout_builder_begin_spring_slots(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    const uint32_t springs = t->reserve.spring_end;
    t->slot_of_spring = mspringi_alloc_unset(a->memory, springs, sizeof *t->slot_of_spring);
    if (!t->slot_of_spring)
        return mspringi_layout_builder_fail(a);
    memset(t->slot_of_spring, 0xff, springs * sizeof *t->slot_of_spring);
    for (uint32_t i = 0; i < a->chains.count; ++i)
        if (a->chains.springs[i] != MSPRING_NONE)
            t->slot_of_spring[a->chains.springs[i]] = t->lattice_spring_slots + i;
    return MSPRING_OK;
}

// Slot whose record a lattice spring is in: that of its base. That of a south-east one lies below it, on the left
// of its tip.
static uint32_t record_slot(const mspringi_layout_builder *a, const mspringi_spring *spring, uint8_t place) {
    const mspringi_topology *t = a->topology;
    const mspring_id base = mspringi_base_at(spring, place), tip = mspringi_tip_at(spring, place);
    if (mspringi_direction_at(place) != MSPRINGI_SOUTH_EAST)
        return t->slot_of_particle[base];
    if (t->slot_of_particle[tip] % MSPRINGI_WIDTH > 0)
        return t->slot_of_particle[tip] - 1;
    const uint32_t block = mspringi_layout_builder_find_block(a, a->grids.grid_of[base], a->grids.row[tip],
                                                              a->grids.column[base] / MSPRINGI_WIDTH);
    return (t->lattice_first + block) * MSPRINGI_WIDTH + MSPRINGI_WIDTH - 1;
}

// Assign slots to lattice springs by position, to irregular ones in order of ids. Mark what is busy besides slots
// of particles: records of south-east springs, and where north-east ones hand their force to the right.
void mspringi_layout_builder_assign_spring_slots(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_topology *t = a->topology;
    mspringi_spring_slot *spring_slots = a->topology->slot_of_spring;
    for (uint32_t s = first; s < end; ++s) {
        const uint8_t place = a->grids.place[s];
        if (place == 0) {
            if (spring_slots[s] == MSPRING_NONE)
                spring_slots[s] = t->row_spring_slots + t->irregular_count++;
            continue;
        }
        const mspringi_direction direction = mspringi_direction_at(place);
        const uint32_t slot = record_slot(a, &a->builder->springs[s], place);
        if (direction >= MSPRINGI_NORTH_EAST)
            mspringi_mark_busy(a->busy, slot + (direction == MSPRINGI_NORTH_EAST));
        spring_slots[s] = ((slot / MSPRINGI_WIDTH - t->lattice_first) * MSPRINGI_DIRECTIONS + (uint32_t)direction) *
                              MSPRINGI_WIDTH +
                          slot % MSPRINGI_WIDTH;
        t->lattice_springs++;
    }
}

mspring_result mspringi_layout_builder_save_ends(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    t->laid_out_count = t->irregular_capacity = t->irregular_count;
    t->irregular_a = mspringi_alloc(a->memory, t->irregular_count, sizeof *t->irregular_a);
    t->irregular_b = mspringi_alloc(a->memory, t->irregular_count, sizeof *t->irregular_b);
    if (!t->irregular_a || !t->irregular_b)
        return mspringi_layout_builder_fail(a);
    for (uint32_t s = 0; s < t->spring_count; ++s) {
        if (t->slot_of_spring[s] < t->row_spring_slots)
            continue;
        const uint32_t i = t->slot_of_spring[s] - t->row_spring_slots;
        t->irregular_a[i] = t->slot_of_particle[a->builder->springs[s].a];
        t->irregular_b[i] = t->slot_of_particle[a->builder->springs[s].b];
    }
    return MSPRING_OK;
}

void mspringi_topology_ends(const mspringi_topology *topology, mspringi_spring_slot spring_slot, uint32_t *base,
                            uint32_t *tip) {
    if (spring_slot >= topology->row_spring_slots) {
        *base = topology->irregular_a[spring_slot - topology->row_spring_slots];
        *tip = topology->irregular_b[spring_slot - topology->row_spring_slots];
        return;
    }
    if (spring_slot >= topology->lattice_spring_slots) {
        *base = topology->chain_first * MSPRINGI_WIDTH + (spring_slot - topology->lattice_spring_slots);
        *tip = *base + 1;
        return;
    }
    const uint32_t lane = spring_slot % MSPRINGI_WIDTH,
                   block = spring_slot / (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH),
                   direction = spring_slot / MSPRINGI_WIDTH % MSPRINGI_DIRECTIONS;
    const uint32_t here = (topology->lattice_first + block) * MSPRINGI_WIDTH + lane,
                   up = topology->up_of_block[block] * MSPRINGI_WIDTH + lane;
    const bool leads_up = direction == MSPRINGI_NORTH || direction == MSPRINGI_NORTH_EAST;
    *base = direction == MSPRINGI_SOUTH_EAST ? up : here;
    *tip = (leads_up ? up : here) + (direction != MSPRINGI_NORTH);
}
