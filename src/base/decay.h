/// @file decay.h
/// exp(-rate * h) by additions and multiplications alone, so that bits are equal everywhere.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_DECAY_H
#define MSPRINGI_DECAY_H

/// Remaining fraction of a velocity after h seconds at rate 1/s; both >= 0. Correct to about the last bit of a
/// float.
float mspringi_decay(float rate, float h);

#endif
