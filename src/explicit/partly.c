/// Sweeping rows of which a part sleeps.
///
/// What sleeps in a block that is swept exerts forces as ever. On what else sleeps there they do nothing; but what
/// is handed on to the block to the right, or to the row above, is taken by what is swept next, wherever that is,
/// unless it is the right one. So runs of blocks are swept one by one, and what none of them will take is taken
/// away.
#include "partly.h"

#include <string.h>

void mspringi_partly_clear(const mspring_network *network, const mspringi_sweep *sweep, const mspringi_span *run) {
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

void mspringi_partly_sweep(const mspring_network *network, const mspringi_substep *substep, mspringi_row_fn sweep,
                           const mspringi_span *spans, uint32_t span_count) {
    for (const mspringi_span *span = spans; span < spans + span_count; ++span) {
        mspringi_span run[2];
        for (uint32_t at = span->first_slot; mspringi_next_swept(network, span, &at, run);) {
            sweep(&substep->sweep, run, 1);
            mspringi_partly_clear(network, &substep->sweep, run);
        }
    }
}
