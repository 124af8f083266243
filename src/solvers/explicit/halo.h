/// @file halo.h
/// Where the strips of one worker end and those of the next begin.
///
/// With each substep the border moves up by the skew, so that the worker above finds all that it reads as it left
/// it, and waits for nobody. It is ahead of the one below, which still needs the first row above the border as it
/// was: that is kept in the halo, once for each substep of a pass. The forces of the last row below it computes
/// itself, on a copy, to have what that row hands on to its first.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_HALO_H
#define MSPRINGI_HALO_H

#include "solvers/explicit/strip.h"

/// One border in one substep of a pass.
typedef struct mspringi_halo {
    uint32_t border, substep;
} mspringi_halo;

/// Make room for the halos between as many workers as the network has. On error all is as it was.
mspring_result mspringi_halos_reserve(mspring_network *network);
void mspringi_halos_free(const mspringi_halos *halos, mspringi_memory *memory);

/// Before the worker above sweeps its first strip: keep what the worker below needs of that, and put what the row
/// below hands on into the substep's carry row.
void mspringi_halo_keep(const mspring_network *network, const mspringi_halo *halo, const mspringi_substep *substep,
                        const mspringi_strip *strip);

/// Sweep the last row of the last strip below, as part of that, after the worker above has kept the halo.
void mspringi_halo_sweep(const mspring_network *network, const mspringi_halo *halo, const mspringi_substep *substep,
                         const mspringi_strip *strip);

#endif
