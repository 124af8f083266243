/// @file poses.h
/// Positions of particles when they were added, to measure the angle of a body (MSPRING_NETWORK_POSES).
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

/// Save the present position of a particle, if the network keeps positions.
void mspringi_pose_keep(mspring_network *network, mspring_id particle);

#endif
