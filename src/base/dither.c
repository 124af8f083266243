/// Dither of velocities by a golden sequence.
#include "base/dither.h"

/// Largest d: sixteen last places of what is a little more than 1. (With 60 to 491,520 substeps a second falls of
/// ten seconds are right to 1.4e-5; with four places to 1.3e-4, without dither to 3e-2.)
#define LARGEST 0x1p-19f

float mspringi_dither(uint32_t substep) {
    // Odd multiples of half the golden ratio, less what is whole, fill the interval evenly however many are taken.
    const uint32_t fraction = (2 * (substep / 4) + 1) * 0x4f1bbcddu;
    const float scale = 0x1p-24f * LARGEST, d = (float)(int32_t)(fraction >> 8) * scale;
    return (substep ^ substep >> 1) & 1 ? -d : d;
}
