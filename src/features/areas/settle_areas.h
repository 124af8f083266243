/// @file settle_areas.h
/// Areas that are angles in a problem of statics.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SETTLE_AREAS_H
#define MSPRINGI_SETTLE_AREAS_H

#include "analysis/settle/equilibrium.h"
#include "features/areas/areas.h"

/// Add an angle, whose pairs become edges; add its part, as mspringi_statics_ops do.
typedef struct mspringi_angle_statics {
    void (*add)(mspringi_statics *statics, const mspringi_areas *all, const mspringi_area *angle);
    double (*forces)(mspringi_statics *statics, const mspringi_area *angle);
    double (*change)(const mspringi_statics *statics, const mspringi_area *angle, double t, double *size);
    void (*stiffness)(mspringi_statics *statics, const mspringi_area *angle, bool clamped);
} mspringi_angle_statics;

#define ANGLE_STATICS(table) extern const mspringi_angle_statics table;
#include "store/features.def"

#endif
