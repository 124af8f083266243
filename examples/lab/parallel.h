/// @file parallel.h
/// Two things at once.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_PARALLEL_H
#define LAB_PARALLEL_H

typedef struct lab_helper lab_helper;
typedef void (*lab_job)(void *argument);

/// Start a thread that helps. Returns NULL where there is none to be had: then all is done one after the other.
lab_helper *helper_start(void);
void helper_stop(lab_helper *unwanted);

/// Call job with each of the two arguments, on two threads if helper is not NULL. Returns when both are done.
void helper_run_both(lab_helper *helper, lab_job job, void *first, void *second);

#endif
