/// @file pass_task.h
/// What one body takes of a pass, and whom it waits for.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PASS_TASK_H
#define MSPRINGI_PASS_TASK_H

#include "solvers/explicit/partition.h"
#include "tasks/progress.h"

typedef struct mspringi_pass_task {
    const mspringi_partition *partition;
    mspringi_progress *progress; ///< [workers]; NULL if there is nobody to wait for
    uint32_t body;               ///< number of the body
    uint32_t share;              ///< that it takes or, if is_border, the border
    uint32_t pass;
    bool is_border;  ///< what independent shares have left around a border
    uint32_t passed; ///< what the worker's counter is at when the pass begins
    uint32_t above;  ///< where the counter of the worker above was last
    uint32_t begin[MSPRINGI_DEEPEST_PASS], end[MSPRINGI_DEEPEST_PASS]; ///< its strips in each substep of the pass
} mspringi_pass_task;

/// Find its strips in the pass.
void mspringi_pass_task_begin(mspringi_pass_task *task);

/// The halo below the first strip of a substep, which is to be kept, and that above the last one, or MSPRING_NONE.
uint32_t mspringi_pass_task_halo_below(const mspringi_pass_task *task, uint32_t substep);
uint32_t mspringi_pass_task_halo_above(const mspringi_pass_task *task, uint32_t substep);

/// The share whose carry rows a pass task goes on with.
uint32_t mspringi_pass_task_carry_owner(const mspringi_pass_task *task);

/// Tell the others in how many substeps of a pass this worker has left its lower border behind, and one more at the
/// end of the pass.
void mspringi_pass_task_publish(const mspringi_pass_task *task, uint32_t passed);

/// Before a strip, if there is anybody to wait for: wait for the worker above where it and this one read what the
/// other writes.
void mspringi_pass_task_wait_above(mspringi_pass_task *task, uint32_t substep, uint32_t strip);

/// Before a pass: wait for those that had its strips in the last one.
void mspringi_pass_task_wait_previous(const mspringi_pass_task *task);

#endif
