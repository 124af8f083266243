/// @file decay.h
/// exp(-rate * h) by additions and multiplications alone, so that bits are equal everywhere.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_DECAY_H
#define MSPRINGI_DECAY_H

/// Remaining fraction of a velocity after h seconds at rate 1/s; both >= 0. Correct to about the last bit of a
/// float.
float mspringi_decay(float rate, float h);

/// 1 - exp(-rate h): the share of a velocity that damping takes within h. Correct to the last bit or so, small or
/// not.
float mspringi_loss(float rate, float h);

/// (1 - exp(-rate h)) / rate, s: the change of a damped velocity within h, per unit of a constant acceleration; h
/// if the rate is 0.
float mspringi_gain(float rate, float h);

/// Largest h^2 k + 2 h c at which leapfrog with this rate is stable, for a mode of stiffness k and damping c per
/// mass: the product of its kick (see mspringi_gain()) and h may be 2 (1 + exp(-rate h)) at most. 4 if the rate is
/// 0.
double mspringi_stability_bound(float rate, float h);

#endif
