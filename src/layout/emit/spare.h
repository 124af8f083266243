/// @file spare.h
/// Places and slots for what is added to a network after its topology was made.
///
/// Spare particles have a slot each behind the loose ones, and the loose row ends behind the last of them that is
/// in use. Spare springs have a place each behind the irregular part's springs; nothing in the irregular part
/// itself is made for them: which slots they pull at is found out when a step begins (see store/added_springs.h).
/// So an id of the reserve has its slot or place for good, and taking it into use is a matter of some stores.
///
/// A topology that is made anew (see network/survivors.c) lays what is in use by then out as if it had always been
/// there, and has slots and places for all spare ids again.
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

/// The slot that is kept for a spare particle, and the place that is kept for a spare spring.
static inline uint32_t mspringi_spare_slot(const mspringi_topology *t, mspring_id particle) {
    return t->spare_first * MSPRINGI_WIDTH + (particle - t->reserve.first_particle);
}
static inline mspringi_spring_slot mspringi_spare_spring_slot(const mspringi_topology *t, mspring_id spring) {
    return t->chain_spring_slots + t->laid_out_count + (spring - t->reserve.first_spring);
}

static inline bool mspringi_slot_is_spare(const mspringi_topology *t, uint32_t slot) {
    return slot / MSPRINGI_WIDTH - t->spare_first < t->spare_blocks; // unsigned: slots before it are not
}

/// Give the spare springs, and so many inactive ones behind them, room among the irregular springs; then
/// records behind the irregular part's slice columns, of which one serves both ends; then let the springs with
/// spare ids that are behind the last have theirs, and note it. On error the topology is still to be destroyed.
mspring_result mspringi_spare_reserve(mspringi_topology *t, uint32_t inactive, mspringi_memory *memory,
                                      mspringi_message *message);
void mspringi_spare_enter(mspringi_topology *t);
mspring_result mspringi_spare_keep(mspringi_topology *t, mspringi_memory *memory, mspringi_message *message);

/// Put a particle into the slot that is kept for it, or take a particle out of its slot.
void mspringi_spare_put_particle(mspringi_topology *t, mspring_id particle);
void mspringi_spare_take_particle(mspringi_topology *t, mspring_id particle);

/// Put a spring into the place that is kept for it.
void mspringi_spare_put_spring(mspringi_topology *t, mspring_id spring, mspring_id a, mspring_id b);

/// Set how many ids are in use, and have the loose row end behind the last slot in use.
void mspringi_spare_count(mspringi_topology *t, uint32_t particle_count, uint32_t spring_count);

#endif
