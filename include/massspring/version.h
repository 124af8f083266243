/// @file version.h
/// Version of the libmassspring headers. The build system reads the three numbers from here.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_VERSION_H
#define MASSSPRING_VERSION_H

#define MSPRING_VERSION_MAJOR 0
#define MSPRING_VERSION_MINOR 2
#define MSPRING_VERSION_PATCH 0

/// The version as one number that can be compared: major * 1000000 + minor * 1000 + patch.
#define MSPRING_VERSION (MSPRING_VERSION_MAJOR * 1000000 + MSPRING_VERSION_MINOR * 1000 + MSPRING_VERSION_PATCH)

#endif
