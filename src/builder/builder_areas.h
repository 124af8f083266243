/// @file builder_areas.h
/// An area or an angle, as builders and networks keep it.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BUILDER_AREAS_H
#define MSPRINGI_BUILDER_AREAS_H

#include <massspring/massspring_laws.h>

#include <stdbool.h>

#include "base/rotation.h"

/// A closed polygon of particles that resists a change of its area, see store/areas.h; or an angle spring, see
/// store/angles.h.
typedef struct mspringi_area {
    mspring_id id;
    mspring_area_kind kind;
    uint32_t first, count; ///< of its corners
    float stiffness, pressure, fill;
    float damping;          ///< of an angle
    bool is_angle;          ///< of the two arms between its three corners
    bool is_open;           ///< a spring of its outline was not whole when the step began
    bool is_ringed;         ///< each side of its outline has a spring, or both arms of an angle
    uint32_t cell;          ///< where in areas.cells the sweep finds it; MSPRINGI_NO_CELL: nowhere
    double rest_area;       ///< of an angle 1
    double rest_angle;      ///< rad, and
    mspringi_rotation rest; ///< its cosine and sine
} mspringi_area;
#define MSPRINGI_NO_CELL UINT32_MAX

#endif
