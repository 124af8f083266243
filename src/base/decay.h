/// @file decay.h
/// exp(-rate * h) from additions and multiplications alone, so that it has the same bits everywhere.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_DECAY_H
#define MSPRINGI_DECAY_H

/// What is left of a velocity after h seconds at rate 1/s; both >= 0. Correct to the last bit or so of a float.
float mspringi_decay(float rate, float h);

#endif
