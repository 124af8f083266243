/// @file clock.h
/// Time that only goes forward.
///
/// SPDX-License-Identifier: MIT
#ifndef COMMON_CLOCK_H
#define COMMON_CLOCK_H

/// Seconds since some moment in the past.
double clock_seconds(void);

/// Seconds that this thread has had a processor for, where the system tells; else clock_seconds(). What others do
/// on the machine hardly matters to it.
double clock_processor_seconds(void);

#endif
