/// @file definitions.h
/// What definitions have in common.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_DEFINITIONS_H
#define MSPRINGI_DEFINITIONS_H

#include <massspring/massspring.h>

/// Fraction of their stress strain below which springs relax, until the host sets another.
#define MSPRINGI_USUAL_RELAX_FRACTION 0.8f

/// The settings that a network begins with.
static inline mspring_settings mspringi_settings_of(const mspring_network_def *def) {
    return (mspring_settings){.struct_size = sizeof(mspring_settings),
                              .guard = def->guard,
                              .gravity_x = def->gravity_x,
                              .gravity_y = def->gravity_y,
                              .global_damping = def->global_damping,
                              .max_speed = def->max_speed,
                              .sleep_speed = def->sleep_speed,
                              .sleep_time = def->sleep_time,
                              .relax_fraction = MSPRINGI_USUAL_RELAX_FRACTION};
}

#endif
