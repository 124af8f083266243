/// @file builder_areas.h
/// Area or angle of a builder or a network.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BUILDER_AREAS_H
#define MSPRINGI_BUILDER_AREAS_H

#include <massspring/massspring.h>

#include <stdbool.h>

#include "base/rotation.h"

/// Closed polygon of particles that resists a change of its area, see features/areas/areas.h; or an angle spring,
/// see features/angles/angles.h.
typedef struct mspringi_area {
    mspring_id id;
    mspring_area_kind kind;
    uint32_t first, count; ///< of its corners
    float stiffness, pressure, fill;
    float damping;          ///< of an angle
    bool is_angle;          ///< angle of the two arms between three corners
    bool is_open;           ///< a spring of its outline was broken when the step began
    bool is_ringed;         ///< each side of the outline, or both arms of an angle, have a spring
    uint32_t cell;          ///< index in areas.cells for the sweep, or MSPRINGI_NO_CELL
    double rest_area;       ///< 1 for an angle
    double rest_angle;      ///< rad
    mspringi_rotation rest; ///< cosine and sine of rest_angle
} mspringi_area;
#define MSPRINGI_NO_CELL UINT32_MAX

#endif
