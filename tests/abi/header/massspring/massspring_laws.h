/// @file massspring_laws.h
/// A name of version 0.2, for this version only: include massspring.h instead. The guide migrate.md has the changes.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_LAWS_H
#define MASSSPRING_MASSSPRING_LAWS_H

#if defined(__GNUC__) || defined(_MSC_VER)
#pragma message("massspring_laws.h is a name of version 0.2: include massspring.h")
#endif
#include "massspring.h"

#endif
