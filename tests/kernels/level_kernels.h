/// @file level_kernels.h
/// The kernels that a program tests.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_LEVEL_KERNELS_H
#define TEST_LEVEL_KERNELS_H

#include <stdio.h>
#include <stdlib.h>

#include "kernels/kernels.h"
#include "level.h"

/// The kernels of the level that is the first argument. Ends the program with 1 if this build lacks them.
static inline const mspringi_kernels *level_kernels(int argc, char **argv) {
    const mspring_simd level = level_from_arguments(argc, argv);
    const mspringi_kernels *kernels = mspringi_kernels_of(level);
    if (kernels->level != level) {
        fprintf(stderr, "the kernels of %s were not built\n", mspring_simd_name(level));
        exit(1);
    }
    return kernels;
}

#endif
