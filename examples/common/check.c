/// @file check.c
/// Messages of failed calls.
///
/// SPDX-License-Identifier: MIT
#include "common/check.h"

#include <stdio.h>

bool check(mspring_result result, const char *what, const char *message) {
    if (result != MSPRING_OK)
        fprintf(stderr, "cannot %s: %s%s%s\n", what, mspring_result_string(result), *message ? ": " : "", message);
    return result == MSPRING_OK;
}
