/// @file environment.h
/// The memory of a module without a C library.
///
/// SPDX-License-Identifier: MIT
#ifndef ENVIRONMENT_H
#define ENVIRONMENT_H

#include <massspring/massspring.h>

/// Memory of the module, for builders, networks and the page. Blocks have sizes of powers of two; one that is freed
/// is used again for one of its size.
extern const mspring_allocator environment_allocator;

#endif
