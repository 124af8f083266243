/// @file clock.h
/// Monotonic clock of the system.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CLOCK_H
#define MSPRINGI_CLOCK_H

/// Clock with the signature of a host's clock: seconds since some moment; `user` is ignored. NULL if the system has
/// none.
double (*mspringi_clock(void))(void *user);

#endif
