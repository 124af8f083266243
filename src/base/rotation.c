/// Cosine and sine: subtract the nearest number of quarter turns, then sum the Taylor series.
#include "base/rotation.h"

#include <math.h>

#include "base/assert.h"

/// A quarter turn in two parts. The first has 33 bits, so its products up to 2^20 are exact.
#define QUARTER_HIGH 0x1.921fb544p+0
#define QUARTER_LOW 0x1.0b4611a626331p-34

/// Last power of the series: up to a quarter of pi, the next term is below 1e-17.
#define LAST_POWER 18

mspringi_rotation mspringi_rotation_by(double angle) {
    const double quarters = floor(angle / (QUARTER_HIGH + QUARTER_LOW) + 0.5);
    const double rest = (angle - quarters * QUARTER_HIGH) - quarters * QUARTER_LOW, square = rest * rest;
    double cosine = 1.0, sine = 1.0;
    MSPRINGI_ASSERT(fabs(angle) <= MSPRINGI_MAX_ANGLE);
    for (int n = LAST_POWER; n > 0; n -= 2) {
        cosine = 1.0 - square / (double)(n * (n - 1)) * cosine;
        sine = 1.0 - square / (double)(n * (n + 1)) * sine;
    }
    sine *= rest;
    switch ((int)quarters & 3) {
    case 1:
        return (mspringi_rotation){-sine, cosine};
    case 2:
        return (mspringi_rotation){-cosine, -sine};
    case 3:
        return (mspringi_rotation){sine, -cosine};
    default:
        return (mspringi_rotation){cosine, sine};
    }
}

// With t = tan(x / 2) for a rotation by x, tan(x / 4) is t / (1 + sqrt(1 + t^2)). Halving twice leaves at most pi /
// 16 for the series.
double mspringi_angle_of(mspringi_rotation rotation) {
    const double pi = 2.0 * (QUARTER_HIGH + QUARTER_LOW), cosine = fabs(rotation.cosine);
    double tangent = rotation.sine / (cosine + 1.0), sum = 0.0;
    for (int half = 0; half < 2; ++half)
        tangent /= 1.0 + sqrt(1.0 + tangent * tangent);
    for (int n = 21; n > 0; n -= 2)
        sum = 1.0 / (double)n - tangent * tangent * sum;
    const double angle = 8.0 * tangent * sum;
    return rotation.cosine >= 0.0 ? angle : rotation.sine < 0.0 ? -pi - angle : pi - angle;
}
