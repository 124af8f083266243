/// @file id_pool.h
/// Particles and springs that are added to a network, and removed from it.
///
/// A removed particle keeps its slot, in which nothing is; a removed spring keeps its place and is broken. What
/// goes over ids leaves both out (mspringi_particle_exists(), mspringi_spring_exists()).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ID_POOL_H
#define MSPRINGI_ID_POOL_H

#include "store/network.h"

/// Allocate what adding and removing needs; all of it if the network has spare ids, else what removing does.
mspring_result mspringi_id_pool_reserve(mspring_network *network);

/// Clear the slots that are empty because of what was removed or has not been added.
void mspringi_id_pool_clear_slots(const mspring_network *network);

/// Particles and springs that were added and are still there.
uint32_t mspringi_id_pool_added_particles(const mspring_network *network);
uint32_t mspringi_id_pool_added_springs(const mspring_network *network);

/// Take a particle whose springs are gone out of its slot, or a spring out of the lists; nothing else is looked at.
void mspringi_id_pool_take_particle(mspring_network *network, mspring_id particle);
void mspringi_id_pool_unlink(mspring_network *network, mspring_id spring);
/// Let the ends of a spare spring be among those of these particles.
void mspringi_id_pool_link(mspring_network *network, mspring_id spring, mspring_id a, mspring_id b);

/// What was there and what is now: the topologies' numbers, and the edit counted.
void mspringi_id_pool_count(mspring_network *network, uint32_t particle_count, uint32_t spring_count);

/* ------------------------------------------------------------------------------------ the springs of a particle */

/// Make the lists of springs by particle, if they are not there.
mspring_result mspringi_incidence_reserve(mspring_network *network);

/// Where one is in the springs of a particle.
typedef struct mspringi_incident_springs {
    uint32_t next, end; ///< of the incidence
    uint32_t spare_end; ///< of the added springs
} mspringi_incident_springs;
mspringi_incident_springs mspringi_incident_springs_begin(const mspring_network *network, mspring_id particle);
/// The next of them that there is; MSPRING_NONE behind the last. It may be removed before the one after it is asked
/// for.
mspring_id mspringi_incident_springs_next(const mspring_network *network, mspringi_incident_springs *around);
/// The one that has this place.
mspring_id mspringi_incident_springs_find(const mspring_network *network, mspring_id particle,
                                          mspringi_spring_slot spring_slot);

#endif
