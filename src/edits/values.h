/// @file values.h
/// What springs may be like.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_VALUES_H
#define MSPRINGI_VALUES_H

#include "kernels/kernels.h"

/// Whether a spring may have this stiffness, damping or rest length.
bool mspringi_is_spring_value(mspringi_part part, float value);

#endif
