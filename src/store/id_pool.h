/// @file id_pool.h
/// Particles and springs that are added to a network, and removed from it.
///
/// A removed particle keeps its slot, which is empty; a removed spring keeps its spring slot and is broken. Loops
/// over ids leave both out (mspringi_particle_exists(), mspringi_spring_exists()).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ID_POOL_H
#define MSPRINGI_ID_POOL_H

#include "store/network.h"

/// Allocate what adding and removing needs; for removing alone if the network has no spare ids.
mspring_result mspringi_id_pool_reserve(mspring_network *network);

/// Clear the slots that are empty because of what was removed or has not been added.
void mspringi_id_pool_clear_slots(const mspring_network *network);

/// Particles and springs that were added and are still there.
uint32_t mspringi_id_pool_added_particles(const mspring_network *network);
uint32_t mspringi_id_pool_added_springs(const mspring_network *network);

/// Take a particle without springs out of its slot, or a spring out of the lists of its particles. Nothing else
/// changes.
void mspringi_id_pool_take_particle(mspring_network *network, mspring_id particle);
void mspringi_id_pool_unlink(mspring_network *network, mspring_id spring);
/// Add the ends of a spare spring to the lists of these particles.
void mspringi_id_pool_link(mspring_network *network, mspring_id spring, mspring_id a, mspring_id b);

/// Set the numbers of particles and springs in the topologies, and notify.
void mspringi_id_pool_count(mspring_network *network, uint32_t particle_count, uint32_t spring_count);

/* ------------------------------------------------------------------------------------ the springs of a particle */

/// Make the lists of springs by particle, if they are not there.
mspring_result mspringi_incidence_reserve(mspring_network *network);

/// Iterator over the springs of a particle.
typedef struct mspringi_incident_springs {
    uint32_t next, end; ///< of the incidence
    uint32_t spare_end; ///< of the added springs
} mspringi_incident_springs;

mspringi_incident_springs mspringi_incident_springs_begin(const mspring_network *network, mspring_id particle);

/// Return the next existing spring, or MSPRING_NONE behind the last. It may be removed before the next call.
mspring_id mspringi_incident_springs_next(const mspring_network *network, mspringi_incident_springs *around);

/// The end of a spring beyond a particle, which is the other end. Spare springs have theirs before they have a
/// slot.
mspring_id mspringi_end_beyond(const mspring_network *network, mspring_id spring, mspring_id particle);

/// Iterator over the springs between two particles: from both ends in turn, so that it takes as long as the springs
/// of the end that has fewer. It may return a spring twice.
typedef struct mspringi_springs_between {
    mspringi_incident_springs around[2];
    mspring_id particles[2];
} mspringi_springs_between;
mspringi_springs_between mspringi_springs_between_begin(const mspring_network *network, mspring_id a, mspring_id b);
/// Return the next spring, or MSPRING_NONE behind the last.
mspring_id mspringi_springs_between_next(const mspring_network *network, mspringi_springs_between *pair);

/// The existing spring in a spring slot.
mspring_id mspringi_spring_at(const mspring_network *network, mspringi_spring_slot spring_slot);

#endif
