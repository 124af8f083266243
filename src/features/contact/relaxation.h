/// @file relaxation.h
/// Push-out of overlaps that leaves no velocity: the explicit solver.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_RELAXATION_H
#define MSPRINGI_RELAXATION_H

#include "features/contact/contacts.h"

/// Set the limits of an explicit substep.
void mspringi_relaxation_set_limits(const mspring_network *network, mspringi_contacts *contacts);
/// Reduce the target speed of a constraint that pushes an overlap apart, where it is pressed together.
void mspringi_relaxation_limit_push(mspringi_contacts *contacts, mspringi_contact_constraint *t);
/// Choose the constraints that push overlaps apart in an interval of h seconds. Give them the normals at its end,
/// and target speed 0. Return true if there are any.
bool mspringi_relaxation_begin(mspringi_contacts *contacts, double h);
/// Take the velocity of push-out back from the moved nodes, and from impulses counted before.
void mspringi_relaxation_finish(mspringi_contacts *contacts);

#endif
