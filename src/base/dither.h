/// @file dither.h
/// Dither of velocities in single precision.
///
/// v + g h is rounded to the last place of v. Where g h is a few of these places, it is rounded the same way in
/// each substep, and a fall goes wrong by percents. If velocities are scaled by 1 - d, with another d of up to
/// sixteen last places in each substep, roundings average out. Four substeps in a row have the same d with signs +
/// - - +, so neither velocities nor positions keep any of it. It costs no operation: global damping is such a
/// factor already. Without gravity there is none, so what glides keeps its velocity exactly.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_DITHER_H
#define MSPRINGI_DITHER_H

#include <stdint.h>

/// The d of a substep. Those at the end of a step that are less than four have none.
float mspringi_dither(uint32_t substep);

#endif
