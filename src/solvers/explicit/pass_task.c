/// Borders, and waiting at them.
#include "solvers/explicit/pass_task.h"

/* ------------------------------------------------------------------------------------------------- its strips */

static void find_strips(mspringi_pass_task *t, uint32_t substep) {
    const mspringi_partition *partition = t->partition;
    // Kernels read a slot behind the row above, which may be the first one of the next strip.
    const uint32_t in = substep * partition->skew, out = in + partition->skew + 1;
    uint32_t *begin = &t->begin[substep], *end = &t->end[substep];
    if (!partition->are_independent) {
        *begin = mspringi_partition_first_strip(partition, t->share, t->pass, substep);
        *end = mspringi_partition_end_strip(partition, t->share, t->pass, substep);
    } else if (!t->is_border) {
        *begin = partition->borders[t->share] + in;
        *end = partition->borders[t->share + 1] - out;
    } else {
        *begin = t->share == 0 ? 0 : partition->borders[t->share] - out;
        *end = t->share == partition->workers ? partition->strips : partition->borders[t->share] + in;
    }
}

void mspringi_pass_task_begin(mspringi_pass_task *t) {
    const uint32_t count = mspringi_partition_substeps(t->partition, t->pass);
    for (uint32_t i = 0; i < count; ++i)
        find_strips(t, i);
}

uint32_t mspringi_pass_task_halo_below(const mspringi_pass_task *t, uint32_t substep) {
    if (t->is_border || t->begin[substep] == 0)
        return MSPRING_NONE;
    return t->partition->are_independent ? t->share : t->share - 1;
}

uint32_t mspringi_pass_task_halo_above(const mspringi_pass_task *t, uint32_t substep) {
    if (t->partition->are_independent && !t->is_border)
        return MSPRING_NONE;
    return t->end[substep] < t->partition->strips ? t->share : MSPRING_NONE;
}

// What a share hands on to the strips that it leaves waits in its carry rows. Those of the uppermost one are free
// again when the upper end is done; the lower end, which nobody hands on to, comes after that.
uint32_t mspringi_pass_task_carry_owner(const mspringi_pass_task *t) {
    if (!t->is_border)
        return t->share;
    return (t->share > 0 ? t->share : t->partition->workers) - 1;
}

/* -------------------------------------------------------------------------------------------------- its waits */

void mspringi_pass_task_publish(const mspringi_pass_task *t, uint32_t passed) {
    if (t->progress)
        mspringi_progress_advance(&t->progress[t->share], t->passed + passed);
}

// In the last strips of the share, whose springs lead to the first ones above the border, or to what is read from
// there.
void mspringi_pass_task_wait_above(mspringi_pass_task *t, uint32_t substep, uint32_t strip) {
    const mspringi_partition *partition = t->partition;
    const uint32_t passed = t->passed + substep + 1;
    if (t->share + 1 < partition->workers && t->above < passed && strip + 2 * partition->skew >= t->end[substep])
        t->above = mspringi_progress_wait(&t->progress[t->share + 1], passed);
}

// Whether a share comes in a pass to strips that another one, which is no neighbour, had in the pass before, or
// reads beside. Where most strips sleep, borders move that far.
static bool comes_to(const mspringi_pass_task *t, uint32_t other) {
    const mspringi_partition *partition = t->partition;
    const uint32_t least = mspringi_partition_min_strips(partition->skew),
                   last = mspringi_partition_substeps(partition, t->pass) - 1;
    return mspringi_partition_first_strip(partition, t->share, t->pass, 0) <
               mspringi_partition_end_strip(partition, other, t->pass - 1, partition->group - 1) + least &&
           mspringi_partition_first_strip(partition, other, t->pass - 1, 0) <
               mspringi_partition_end_strip(partition, t->share, t->pass, last) + least;
}

// For the worker below to have done with the last pass and, where the border above has gone up so far that strips
// which nobody waits for any more were the other's, for the one above.
void mspringi_pass_task_wait_previous(const mspringi_pass_task *t) {
    const mspringi_partition *partition = t->partition;
    if (t->pass == 0 || !t->progress)
        return;
    if (t->share > 0)
        mspringi_progress_wait(&t->progress[t->share - 1], t->passed);
    if (t->share + 1 < partition->workers &&
        mspringi_partition_end_strip(partition, t->share, t->pass, 0) >
            mspringi_partition_end_strip(partition, t->share, t->pass - 1, partition->group - 1))
        mspringi_progress_wait(&t->progress[t->share + 1], t->passed);
    for (uint32_t other = 0; other < partition->workers; ++other)
        if ((other + 1 < t->share || other > t->share + 1) && comes_to(t, other))
            mspringi_progress_wait(&t->progress[other], t->passed);
}
