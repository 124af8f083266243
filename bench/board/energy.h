/// @file energy.h
/// Whether methods keep energy.
///
/// SPDX-License-Identifier: MIT
#ifndef BOARD_ENERGY_H
#define BOARD_ENERGY_H

#include <stdbool.h>

/// Let a bar swing for as long as a million explicit substeps take, print how far its energy has strayed, and draw
/// it into a folder. false: after a message.
bool energy_board(const char *folder);

#endif
