/// @file check.h
/// What to say when a call of the library fails.
///
/// SPDX-License-Identifier: MIT
#ifndef COMMON_CHECK_H
#define COMMON_CHECK_H

#include <massspring/massspring.h>

#include <stdbool.h>

/// If the call failed, print to stderr what could not be done, the name of the result and the object's message.
/// @param result   made before: C does not say which argument of a call is evaluated first
/// @param message  of mspring_builder_error() or mspring_network_error(); may be ""
/// @return whether the call succeeded
bool check(mspring_result result, const char *what, const char *message);

#endif
