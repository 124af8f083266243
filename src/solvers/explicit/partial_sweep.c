/// Sweeping rows of which a part sleeps.
///
/// What sleeps in a block that is swept exerts forces as ever. On what else sleeps there they do nothing; but what
/// is handed on to the block to the right, or to the row above, is taken by what is swept next, wherever that is,
/// unless it is the right one. So runs of blocks that do not lie side by side are swept one by one, and what none
/// of them will take is taken away.
#include "solvers/explicit/partial_sweep.h"
#include "base/assert.h"

#include <string.h>

void mspringi_partial_clear(const mspring_network *network, const mspringi_sweep *sweep, const mspringi_span *run) {
    const mspringi_topology *t = &network->topology;
    for (uint32_t block = run->first_slot / MSPRINGI_WIDTH; block * MSPRINGI_WIDTH < run->end_slot; ++block) {
        const uint32_t i = block - t->lattice_first;
        if (i >= t->lattice_blocks || network->sleep.swept[t->up_of_block[i]])
            continue;
        const size_t carry = (size_t)((int64_t)block * MSPRINGI_WIDTH + run->carry);
        memset(sweep->carry_x + carry, 0, MSPRINGI_WIDTH * sizeof *sweep->carry_x);
        memset(sweep->carry_y + carry, 0, MSPRINGI_WIDTH * sizeof *sweep->carry_y);
    }
}

mspringi_partial_cursor mspringi_partial_begin(const mspringi_span *spans, uint32_t span_count) {
    return (mspringi_partial_cursor){spans, spans + span_count, span_count > 0 ? spans->first_slot : 0};
}

static void go_on(mspringi_partial_cursor *at) {
    if (++at->span < at->end)
        at->slot = at->span->first_slot;
}

uint32_t mspringi_partial_next(const mspring_network *network, mspringi_partial_cursor *at, mspringi_span *runs) {
    uint32_t count = 0;
    while (at->span < at->end) {
        mspringi_span run[2];
        uint32_t behind = at->slot;
        if (!mspringi_next_swept(network, at->span, &behind, run)) {
            go_on(at);
            continue;
        }
        if (count > 0 && run->first_slot != runs[count - 1].end_slot)
            return count;
        MSPRINGI_ASSERT(run->first_slot >= at->span->first_slot && run->end_slot <= at->span->end_slot);
        runs[count++] = *run;
        at->slot = behind;
        if (run->end_slot < at->span->end_slot)
            return count;
        go_on(at);
    }
    return count;
}

// What is handed to the right stays within a call of sweep. So runs that lie side by side, as where the row above
// begins or ends, have to be swept in one.
void mspringi_partial_sweep_row(const mspring_network *network, const mspringi_substep *substep,
                                mspringi_row_fn sweep, const mspringi_row *row) {
    mspringi_span *runs = network->sleep.runs + row->first_span;
    mspringi_partial_cursor at = mspringi_partial_begin(&network->topology.spans[row->first_span], row->span_count);
    for (uint32_t count; (count = mspringi_partial_next(network, &at, runs)) > 0;) {
        sweep(&substep->sweep, runs, count);
        for (uint32_t i = 0; i < count; ++i)
            mspringi_partial_clear(network, &substep->sweep, &runs[i]);
    }
}

void mspringi_partial_sweep_irregular(const mspring_network *network, const mspringi_substep *substep,
                                      mspringi_row_fn sweep, const mspringi_span *span) {
    mspringi_span run[2];
    for (uint32_t at = span->first_slot; mspringi_next_swept(network, span, &at, run);)
        sweep(&substep->sweep, run, 1);
}
