/// @file clock.h
/// Time that only goes forward, where the system has it.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CLOCK_H
#define MSPRINGI_CLOCK_H

/// A clock as hosts give one: seconds since some moment, user is not looked at. NULL: there is none here.
double (*mspringi_clock(void))(void *user);

#endif
