/// @file unit.h
/// The unit in the last place of a float.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_UNIT_H
#define MSPRINGI_UNIT_H

#include <stdint.h>
#include <string.h>

/// The unit in the last place of a value; 0 if the value is negative, below the normal numbers or not finite.
static inline double mspringi_unit_of(float value) {
    uint32_t bits;
    float power; // of two, at most the value
    memcpy(&bits, &value, sizeof bits);
    bits &= 0xff800000u;
    if (bits >= 0x7f800000u)
        return 0.0;
    memcpy(&power, &bits, sizeof power);
    return (double)power * 0x1p-23;
}

#endif
