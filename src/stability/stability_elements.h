/// @file stability_elements.h
/// Elements, forces between particles of a body besides springs, in the stability limit.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STABILITY_ELEMENTS_H
#define MSPRINGI_STABILITY_ELEMENTS_H

#include "stability/pencil.h"
#include "stability/stability_limit.h"
#include "store/element_laws.h"

/// In any shape: add to the sums of springs' stiffness and damping by slot, in the shape that elements were added
/// in. Return the largest quotient of these sums over the elements.
void mspringi_stability_elements_sum(const mspring_network *network, float *sums, float *dampings);
double mspringi_stability_elements_largest(const mspring_network *network, const float *sums);

/// In the present shape: add to the bound, and to the image of a displacement. square: h^2, of which limit has a
/// float. Add to the quotient of a displacement.
void mspringi_stability_elements_bound(const mspring_network *network, const mspringi_stability_limit *limit);
void mspringi_stability_elements_image(const mspring_network *network, const mspringi_stability_limit *limit,
                                       double square);
void mspringi_stability_elements_quotient(const mspring_network *network, mspringi_displacement vector,
                                          mspringi_quotient *sum);

#endif
