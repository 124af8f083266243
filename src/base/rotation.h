/// @file rotation.h
/// Cosine, sine and angle by arithmetic and roots alone, so that bits are equal everywhere.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ROTATION_H
#define MSPRINGI_ROTATION_H

/// Largest angle, rad.
#define MSPRINGI_MAX_ANGLE 1e6

/// Rotation by an angle.
typedef struct mspringi_rotation {
    double cosine, sine;
} mspringi_rotation;

/// Rotation by an angle; correct to 2e-16.
/// @param angle  at most MSPRINGI_MAX_ANGLE in size
mspringi_rotation mspringi_rotation_by(double angle);

/// Angle of a rotation, -pi to pi; correct to 1e-15.
double mspringi_angle_of(mspringi_rotation rotation);

#endif
