/// @file clock.h
/// Time that only goes forward.
///
/// SPDX-License-Identifier: MIT
#ifndef COMMON_CLOCK_H
#define COMMON_CLOCK_H

/// Seconds since some moment in the past.
double clock_seconds(void);

#endif
