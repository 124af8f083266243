/// @file strain.h
/// The strain pass: once after each step, every spring against its thresholds.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDITS_STRAIN_H
#define MSPRINGI_EDITS_STRAIN_H

#include "network/network.h"

/// Break, stress and relax springs by the strain that they have now, if any has thresholds.
void mspringi_strain_pass(mspring_network *network);

#endif
