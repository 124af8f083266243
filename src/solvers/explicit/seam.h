/// @file seam.h
/// Where the strips of one worker end and those of the next begin.
///
/// With each substep the border moves up by the lag, so that the worker above finds all that it reads as it left
/// it, and waits for nobody. It is ahead of the one below, which still needs the first row above the border as it
/// was: that is kept in the seam, once for each substep of a pass. The forces of the last row below it computes
/// itself, on a copy, to have what that row hands on to its first.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SEAM_H
#define MSPRINGI_SEAM_H

#include "solvers/explicit/strip.h"

/// One border in one substep of a pass.
typedef struct mspringi_seam {
    uint32_t border, substep;
} mspringi_seam;

/// Make room for the seams between as many workers as the network has. On error all is as it was.
mspring_result mspringi_seams_reserve(mspring_network *network);
void mspringi_seams_free(const mspringi_seams *seams, mspringi_memory *memory);

/// Before the worker above sweeps its first strip: keep what the worker below needs of that, and put what the row
/// below hands on into the substep's carry row.
void mspringi_seam_keep(const mspring_network *network, const mspringi_seam *seam, const mspringi_substep *substep,
                        const mspringi_strip *strip);

/// Sweep the last row of the last strip below, as part of that, after the worker above has kept the seam.
void mspringi_seam_sweep(const mspring_network *network, const mspringi_seam *seam, const mspringi_substep *substep,
                         const mspringi_strip *strip);

#endif
