/// @file breaking.h
/// Springs that break and are made whole again.
///
/// A broken spring keeps its place and has stiffness and damping 0 there, so a step goes on as before; what it had
/// is kept aside (relative springs have their fractions anyway).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BREAKING_H
#define MSPRINGI_BREAKING_H

#include "store/network.h"

/// Allocate what breaking needs, if it is not there yet.
mspring_result mspringi_breaking_reserve(mspring_network *network);

/// Let a spring that is not live be so. Its values are the caller's to set.
void mspringi_spring_come_live(mspring_network *network, mspring_id spring);

/// Break one spring; after mspringi_breaking_reserve(). False: it was broken.
bool mspringi_spring_break(mspring_network *network, mspring_id spring);

/// Restore one spring. False: it was whole.
bool mspringi_spring_restore(mspring_network *network, mspring_id spring);

#endif
