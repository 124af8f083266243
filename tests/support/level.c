/// @file level.c
///
/// SPDX-License-Identifier: MIT
#include "level.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

mspring_simd level_from_arguments(int argc, char **argv) {
    for (mspring_simd level = MSPRING_SIMD_SCALAR; argc > 1 && level <= MSPRING_SIMD_WASM; level++) {
        if (strcmp(argv[1], mspring_simd_name(level)) != 0) {
            continue;
        }
        if (!mspring_simd_available(level)) {
            printf("skipped: this machine lacks %s\n", argv[1]);
            exit(LEVEL_SKIPPED);
        }
        support_set_variable("MSPRING_SIMD", NULL);
        return level;
    }
    fprintf(stderr, "usage: %s scalar|sse2|avx2|avx512|neon ...\n", argv[0]);
    exit(2);
}

mspring_simd level_lowest(void) {
    mspring_simd level = MSPRING_SIMD_SCALAR;
    while (!mspring_simd_available(level)) {
        level++;
    }
    return level;
}

void level_check(const mspring_network *network, mspring_simd level) {
    assert_string_equal(mspring_simd_name(support_simd_level(network)), mspring_simd_name(level));
}
