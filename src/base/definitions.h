/// @file definitions.h
/// Parts that definitions have in common.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_DEFINITIONS_H
#define MSPRINGI_DEFINITIONS_H

#include <massspring/massspring.h>

/// Default of mspring_settings.most_work.
#define MSPRINGI_MOST_WORK 4u

/// Default of mspring_settings.residual.
#define MSPRINGI_RESIDUAL 0.01f

#endif
