/// @file fracture.h
/// What is left of a bridge that breaks.
///
/// SPDX-License-Identifier: MIT
#ifndef BOARD_FRACTURE_H
#define BOARD_FRACTURE_H

#include <stdbool.h>

/// Let a bridge fall to pieces from 32 starts that differ by little, with each method; print how many springs
/// break, and draw into a folder how far that is from what double precision finds. false: after a message.
bool fracture_board(const char *folder);

#endif
