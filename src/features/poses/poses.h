/// @file poses.h
/// Where particles were when they were added, so that a body's turn can be measured (MSPRING_NETWORK_POSES).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_POSES_H
#define MSPRINGI_POSES_H

#include "store/network.h"

typedef struct mspringi_posed {
    double x, y; ///< world coordinates, m
} mspringi_posed;

typedef struct mspringi_poses {
    mspringi_posed *of_particle; ///< [particle ids]
} mspringi_poses;

/// Keep the present place of a particle, if the network keeps any.
void mspringi_pose_keep(mspring_network *network, mspring_id particle);

#endif
