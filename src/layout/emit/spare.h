/// @file spare.h
/// Slots and spring slots of particles and springs added to an existing topology.
///
/// Each spare particle has a slot behind the loose ones; the loose row ends behind the last one in use. Each spare
/// spring has a spring slot behind the irregular springs, but no slice column: store/added_springs.h finds its
/// nodes when a step begins. So every spare id keeps its slot, and using it takes a few stores.
///
/// A new layout (network/survivors.c) treats the ids in use as its own, and has slots for all spare ids again.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SPARE_H
#define MSPRINGI_SPARE_H

#include "layout/topology.h"

static inline uint32_t mspringi_spare_particles(const mspringi_topology *t) {
    return t->reserve.particle_end - t->reserve.first_particle;
}

static inline uint32_t mspringi_spare_springs(const mspringi_topology *t) {
    return t->reserve.spring_end - t->reserve.first_spring;
}

/// Slots reserved for a spare particle and a spare spring.
static inline uint32_t mspringi_spare_slot(const mspringi_topology *t, mspring_id particle) {
    return t->spare_first * MSPRINGI_WIDTH + (particle - t->reserve.first_particle);
}
static inline mspringi_spring_slot mspringi_spare_spring_slot(const mspringi_topology *t, mspring_id spring) {
    return t->row_spring_slots + t->laid_out_count + (spring - t->reserve.first_spring);
}

static inline bool mspringi_slot_is_spare(const mspringi_topology *t, uint32_t slot) {
    return slot / MSPRINGI_WIDTH - t->spare_first < t->spare_blocks; // unsigned: false also for earlier slots
}

/// Make room for spare springs, then `inactive` ones, behind the irregular springs. Give them records behind the
/// slice columns, one for both ends. Then give unused spare springs their slots, and save the layout. After an
/// error the topology must still be destroyed.
mspring_result mspringi_spare_reserve(mspringi_topology *t, uint32_t inactive, mspringi_memory *memory,
                                      mspringi_message *message);
void mspringi_spare_set_entries(mspringi_topology *t);
mspring_result mspringi_spare_assign_slots(mspringi_topology *t, mspringi_memory *memory,
                                           mspringi_message *message);

/// Put a particle into its reserved slot, or take it out of its slot.
void mspringi_spare_add_particle(mspringi_topology *t, mspring_id particle);
void mspringi_spare_remove_particle(mspringi_topology *t, mspring_id particle);

/// Put a spring into its reserved slot.
void mspringi_spare_add_spring(mspringi_topology *t, mspring_id spring, mspring_id a, mspring_id b);

/// Set the ids in use, and end the loose row behind the last used slot.
void mspringi_spare_set_counts(mspringi_topology *t, uint32_t particle_count, uint32_t spring_count);

#endif
