/// @file progress.h
/// One line on stderr that tells how far a long run has come.
///
/// SPDX-License-Identifier: MIT
#ifndef COMMON_PROGRESS_H
#define COMMON_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct progress {
    bool terminal;    ///< stderr is one: the line is written over; otherwise a new line now and then
    double last_time; ///< when it was written
    size_t length;    ///< of what stands in the line
} progress;

void progress_start(progress *made);
/// Whether it is time to write again; cheap.
bool progress_due(const progress *line);
void progress_write(progress *line, const char *text);
/// Clear the line, so that something else can be printed.
void progress_clear(progress *line);

#endif
