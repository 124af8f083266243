/// @file id_pool_state.h
/// Records of added and removed ids, and of the springs at each particle (id_pool.h).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ID_POOL_STATE_H
#define MSPRINGI_ID_POOL_STATE_H

#include <massspring/massspring.h>

/// State of an id.
enum {
    MSPRINGI_GONE = 0,  ///< it was removed
    MSPRINGI_THERE = 1, ///< it names a particle or a spring
    MSPRINGI_SPARE = 2  ///< the next addition may get it
};

/// No end of a spring.
#define MSPRINGI_NO_END UINT32_MAX

/// Ids that were added and removed. The spare spring number n has the ends 2 n and 2 n + 1. The ends at a particle
/// are a linked list.
typedef struct mspringi_id_pool {
    uint8_t *particles,
        *springs;        ///< [reserve.particle_end], [reserve.spring_end] MSPRINGI_THERE, ...; NULL: all ids exist
    uint32_t *first_end; ///< [reserve.particle_end] MSPRINGI_NO_END if there is none
    uint32_t *next_end, *previous_end;         ///< [2 * spare springs]
    mspring_id *particle_of_end;               ///< [2 * spare springs]
    mspring_id lowest_particle, lowest_spring; ///< no id below is spare
} mspringi_id_pool;

/// The springs of particle p are springs[first[p]] ... springs[first[p + 1] - 1], by rising id. Spare springs are
/// in none of these lists.
typedef struct mspringi_incidence {
    uint32_t *first;   ///< [particles + 1], or NULL: not made yet
    uint32_t *springs; ///< [2 * springs]
} mspringi_incidence;

#endif
