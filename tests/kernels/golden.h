/// @file golden.h
/// Scenes whose state hash is written down in golden/hashes.txt.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_GOLDEN_H
#define TEST_GOLDEN_H

#include <stdbool.h>

#include <massspring/massspring.h>

typedef struct golden_scene {
    const char *name;
    /// Make the network with these settings, which it may change (not the level). NULL if this build cannot.
    mspring_network *(*make)(mspring_network_def *def);
    /// What the host does before each step; NULL: nothing.
    void (*before_step)(mspring_network *network, uint32_t step);
    uint32_t substeps, steps;
    double dt;
    bool takes_long; ///< left out if MASSSPRING_TEST_SHORT_SCENES is set, where a processor is emulated, say
} golden_scene;

extern const golden_scene golden_scenes[];
extern const uint32_t golden_scene_count;

/// Run a scene at a level, by so many workers. The hash of its state, over all its steps.
uint64_t golden_run(const golden_scene *golden, mspring_simd level, uint32_t workers);

#endif
