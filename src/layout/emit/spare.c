/// Slots and spring slots of particles and springs added to an existing topology.
#include "layout/emit/spare.h"

#include <string.h>

// Grow an array of old_count elements; false if memory is out.
static bool extend_array(uint32_t **array, size_t old_count, size_t count, mspringi_memory *memory) {
    uint32_t *longer = mspringi_alloc(memory, count, sizeof *longer);
    if (!longer)
        return false;
    if (old_count > 0)
        memcpy(longer, *array, old_count * sizeof *longer);
    mspringi_free(memory, *array);
    *array = longer;
    return true;
}

static bool save_slots(mspringi_topology *t, mspringi_memory *memory) {
    const uint32_t particles = mspringi_spare_particles(t), springs = mspringi_spare_springs(t);
    t->initial_particles = t->particle_count - t->reserve.first_particle;
    t->initial_slots = mspringi_alloc(memory, particles, sizeof *t->initial_slots);
    t->initial_spring_slots = mspringi_alloc(memory, springs, sizeof *t->initial_spring_slots);
    if (!t->initial_slots || !t->initial_spring_slots)
        return false;
    memcpy(t->initial_slots, t->slot_of_particle + t->reserve.first_particle, particles * sizeof *t->initial_slots);
    memcpy(t->initial_spring_slots, t->slot_of_spring + t->reserve.first_spring,
           springs * sizeof *t->initial_spring_slots);
    return true;
}

mspring_result mspringi_spare_reserve(mspringi_topology *t, uint32_t inactive, mspringi_memory *memory,
                                      mspringi_message *message) {
    const uint32_t springs = mspringi_spare_springs(t), laid_out = t->laid_out_count;
    const size_t count = (size_t)laid_out + springs + inactive;
    const uint32_t slice_columns =
        t->irregular.slice_count > 0 ? t->irregular.first_slice_column[t->irregular.slice_count] : 0;
    if ((uint64_t)t->row_spring_slots + count >= MSPRING_NONE ||
        (uint64_t)slice_columns * MSPRINGI_WIDTH + springs + inactive >= MSPRING_NONE)
        return mspringi_fail(message, MSPRING_ERROR_LIMIT, "%u springs exceed the limit of the layout",
                             (unsigned)t->spring_count);
    t->irregular_capacity = laid_out + springs;
    t->inactive_count = inactive;
    if (springs + inactive > 0 &&
        (!extend_array(&t->irregular_a, laid_out, count, memory) ||
         !extend_array(&t->irregular_b, laid_out, count, memory) ||
         !extend_array(&t->irregular.entry, (size_t)2 * (t->irregular.entry ? laid_out : 0), 2 * count, memory)))
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu springs", count);
    t->irregular_count = laid_out + (t->spring_count - t->reserve.first_spring);
    return MSPRING_OK;
}

void mspringi_spare_set_entries(mspringi_topology *t) {
    const uint32_t slice_columns =
        t->irregular.slice_count > 0 ? t->irregular.first_slice_column[t->irregular.slice_count] : 0;
    for (uint32_t i = 0; i < mspringi_spare_springs(t) + t->inactive_count; ++i) {
        uint32_t *entry = t->irregular.entry + 2 * ((size_t)t->laid_out_count + i);
        entry[0] = entry[1] = slice_columns * MSPRINGI_WIDTH + i;
    }
}

mspring_result mspringi_spare_assign_slots(mspringi_topology *t, mspringi_memory *memory,
                                           mspringi_message *message) {
    for (mspring_id s = t->spring_count > t->reserve.first_spring ? t->spring_count : t->reserve.first_spring;
         s < t->reserve.spring_end; ++s)
        t->slot_of_spring[s] = mspringi_spare_spring_slot(t, s);
    if (mspringi_spare_particles(t) + mspringi_spare_springs(t) > 0 && !save_slots(t, memory))
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for %u spare springs",
                             (unsigned)mspringi_spare_springs(t));
    return MSPRING_OK;
}

void mspringi_spare_add_particle(mspringi_topology *t, mspring_id particle) {
    const uint32_t slot = mspringi_spare_slot(t, particle);
    t->slot_of_particle[particle] = slot;
    t->particle_of_slot[slot] = particle;
}

void mspringi_spare_remove_particle(mspringi_topology *t, mspring_id particle) {
    t->particle_of_slot[t->slot_of_particle[particle]] = MSPRING_NONE;
}

void mspringi_spare_add_spring(mspringi_topology *t, mspring_id spring, mspring_id a, mspring_id b) {
    const mspringi_spring_slot spring_slot = mspringi_spare_spring_slot(t, spring);
    t->slot_of_spring[spring] = spring_slot;
    t->irregular_a[spring_slot - t->row_spring_slots] = t->slot_of_particle[a];
    t->irregular_b[spring_slot - t->row_spring_slots] = t->slot_of_particle[b];
}

void mspringi_spare_set_counts(mspringi_topology *t, uint32_t particle_count, uint32_t spring_count) {
    t->particle_count = particle_count;
    t->spring_count = spring_count;
    t->irregular_count = t->laid_out_count + (spring_count - t->reserve.first_spring);
    if (t->spare_blocks == 0)
        return;
    uint32_t slots = particle_count - t->reserve.first_particle;
    while (slots > 0 && t->particle_of_slot[t->spare_first * MSPRINGI_WIDTH + slots - 1] == MSPRING_NONE)
        --slots;
    const mspringi_row *loose = &t->rows[t->row_count - 1];
    t->spans[loose->first_span].end_slot =
        (t->spare_first + (slots + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH) * MSPRINGI_WIDTH;
}
