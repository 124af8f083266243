/// @file rotation.h
/// Cosine, sine and angle from arithmetic and roots alone, so that they have the same bits everywhere.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ROTATION_H
#define MSPRINGI_ROTATION_H

/// Angles may be this large, rad.
#define MSPRINGI_MAX_ANGLE 1e6

/// A rotation by an angle.
typedef struct mspringi_rotation {
    double cosine, sine;
} mspringi_rotation;

/// Correct to 2e-16.
/// @param angle  at most MSPRINGI_MAX_ANGLE in size
mspringi_rotation mspringi_turn_by(double angle);

/// The angle of a rotation, -pi to pi; correct to 1e-15.
double mspringi_angle_of(mspringi_rotation rotation);

#endif
