/// @file described.h
/// Numbers out of mspring_network_describe().
///
/// SPDX-License-Identifier: MIT
#ifndef COMMON_DESCRIBED_H
#define COMMON_DESCRIBED_H

/// Room for any description.
enum { DESCRIBED_SIZE = 4096 };

/// The number in the line that begins with this name; 0 if there is none.
double described_number(const char *text, const char *name);

#endif
