/// @file progress.c
/// The progress line.
///
/// SPDX-License-Identifier: MIT
#if !defined(_WIN32) && !defined(_POSIX_C_SOURCE)
#define _POSIX_C_SOURCE 200809L
#endif
#include "common/progress.h"
#include "common/clock.h"

#include <stdio.h>
#include <string.h>

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

static const double seconds_on_terminal = 0.1;
static const double seconds_elsewhere = 5;

void progress_start(progress *made) {
#ifdef _WIN32
    made->terminal = _isatty(_fileno(stderr)) != 0;
#else
    made->terminal = isatty(STDERR_FILENO) != 0;
#endif
    made->last_time = clock_seconds();
    made->length = 0;
}

bool progress_due(const progress *line) {
    return clock_seconds() - line->last_time > (line->terminal ? seconds_on_terminal : seconds_elsewhere);
}

void progress_write(progress *line, const char *text) {
    size_t length = strlen(text);
    if (line->terminal) {
        int rest = length < line->length ? (int)(line->length - length) : 0;
        fprintf(stderr, "\r%s%*s", text, rest, "");
    } else {
        fprintf(stderr, "%s\n", text);
    }
    fflush(stderr);
    line->length = length;
    line->last_time = clock_seconds();
}

void progress_clear(progress *line) {
    if (line->terminal && line->length)
        fprintf(stderr, "\r%*s\r", (int)line->length, "");
    line->length = 0;
}
