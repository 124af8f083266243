/// @file main.c
/// The page's checks, natively: a line for each, as tests/web/check.js and the page itself write them.
///
/// SPDX-License-Identifier: MIT
#include "web/page.h"

#include <stdio.h>

int main(void) {
    static const struct { uint32_t scene, steps; } checks[] = {{0, 64}, {0, 1000}, {1, 1000}, {2, 200}, {3, 100},
                                                                {4, 300}, {5, 200}};
    for (size_t i = 0; i < sizeof checks / sizeof *checks; i++) {
        for (int level = MSPRING_SIMD_SCALAR; level >= MSPRING_SIMD_AUTO; level--) {
            if (page_check(checks[i].scene, checks[i].steps, (uint32_t)level) != MSPRING_OK)
                return 1;
            printf("check %u %u %s %08x%08x\n", checks[i].scene, checks[i].steps, level ? "scalar" : "best",
                   page_check_hash(1), page_check_hash(0));
        }
    }
    return 0;
}
