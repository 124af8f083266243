/// @file stdlib.h
/// What the library uses of stdlib.h, for a module without a C library.
///
/// SPDX-License-Identifier: MIT
#ifndef ENVIRONMENT_STDLIB_H
#define ENVIRONMENT_STDLIB_H

#define abs(x) __builtin_abs(x)

#endif
