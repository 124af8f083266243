/// @file floor_support.h
/// Floor below bodies in contact.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FLOOR_SUPPORT_H
#define MSPRINGI_FLOOR_SUPPORT_H

#include <stdbool.h>
#include <stdint.h>

/// Floor support: constraint of a particle that other bodies may press into the floor.
typedef struct mspringi_floor_support {
    uint32_t p, slot; ///< dense number and slot of the particle
    double nx, ny, friction;
    double gap;           ///< distance to the surface at the end of the substep, without impulses of contact, m
    double free_speed;    ///< speed away from the surface without contact, m/s
    double min_speed;     ///< lower bound of that speed with contact, m/s
    double across, along; ///< accumulated changes of normal and tangential speed, m/s
    bool has_moved;       ///< the last sweep changed the velocity
} mspringi_floor_support;

/// Most supports of a particle: two where surfaces meet.
#define MSPRINGI_MAX_SUPPORTS 2u

#endif
