/// Borders, and waiting at them.
#include "solvers/explicit/stint.h"

/* ------------------------------------------------------------------------------------------------- its strips */

static void find_strips(mspringi_stint *t, uint32_t substep) {
    const mspringi_shares *shares = t->shares;
    // Kernels read a slot behind the row above, which may be the first one of the next strip.
    const uint32_t in = substep * shares->skew, out = in + shares->skew + 1;
    uint32_t *begin = &t->begin[substep], *end = &t->end[substep];
    if (!shares->are_independent) {
        *begin = mspringi_shares_begin(shares, t->share, t->pass, substep);
        *end = mspringi_shares_end(shares, t->share, t->pass, substep);
    } else if (!t->is_border) {
        *begin = shares->borders[t->share] + in;
        *end = shares->borders[t->share + 1] - out;
    } else {
        *begin = t->share == 0 ? 0 : shares->borders[t->share] - out;
        *end = t->share == shares->workers ? shares->strips : shares->borders[t->share] + in;
    }
}

void mspringi_stint_begin(mspringi_stint *t) {
    const uint32_t count = mspringi_shares_substeps(t->shares, t->pass);
    for (uint32_t i = 0; i < count; ++i)
        find_strips(t, i);
}

uint32_t mspringi_stint_halo_below(const mspringi_stint *t, uint32_t substep) {
    if (t->is_border || t->begin[substep] == 0)
        return MSPRING_NONE;
    return t->shares->are_independent ? t->share : t->share - 1;
}

uint32_t mspringi_stint_halo_above(const mspringi_stint *t, uint32_t substep) {
    if (t->shares->are_independent && !t->is_border)
        return MSPRING_NONE;
    return t->end[substep] < t->shares->strips ? t->share : MSPRING_NONE;
}

// What a share hands on to the strips that it leaves waits in its carry rows. Those of the uppermost one are free
// again when the upper end is done; the lower end, which nobody hands on to, comes after that.
uint32_t mspringi_stint_carries(const mspringi_stint *t) {
    if (!t->is_border)
        return t->share;
    return (t->share > 0 ? t->share : t->shares->workers) - 1;
}

/* -------------------------------------------------------------------------------------------------- its waits */

void mspringi_stint_say(const mspringi_stint *t, uint32_t passed) {
    if (t->progress)
        mspringi_progress_advance(&t->progress[t->share], t->passed + passed);
}

// In the last strips of the share, whose springs lead to the first ones above the border, or to what is read from
// there.
void mspringi_stint_wait_above(mspringi_stint *t, uint32_t substep, uint32_t strip) {
    const mspringi_shares *shares = t->shares;
    const uint32_t passed = t->passed + substep + 1;
    if (t->share + 1 < shares->workers && t->above < passed && strip + 2 * shares->skew >= t->end[substep])
        t->above = mspringi_progress_wait(&t->progress[t->share + 1], passed);
}

// Whether a share comes in a pass to strips that another one, which is no neighbour, had in the pass before, or
// reads beside. Where most strips sleep, borders move that far.
static bool comes_to(const mspringi_stint *t, uint32_t other) {
    const mspringi_shares *shares = t->shares;
    const uint32_t least = mspringi_shares_least(shares->skew),
                   last = mspringi_shares_substeps(shares, t->pass) - 1;
    return mspringi_shares_begin(shares, t->share, t->pass, 0) <
               mspringi_shares_end(shares, other, t->pass - 1, shares->group - 1) + least &&
           mspringi_shares_begin(shares, other, t->pass - 1, 0) <
               mspringi_shares_end(shares, t->share, t->pass, last) + least;
}

// For the worker below to have done with the last pass and, where the border above has gone up so far that strips
// which nobody waits for any more were the other's, for the one above.
void mspringi_stint_wait_last(const mspringi_stint *t) {
    const mspringi_shares *shares = t->shares;
    if (t->pass == 0 || !t->progress)
        return;
    if (t->share > 0)
        mspringi_progress_wait(&t->progress[t->share - 1], t->passed);
    if (t->share + 1 < shares->workers && mspringi_shares_end(shares, t->share, t->pass, 0) >
                                              mspringi_shares_end(shares, t->share, t->pass - 1, shares->group - 1))
        mspringi_progress_wait(&t->progress[t->share + 1], t->passed);
    for (uint32_t other = 0; other < shares->workers; ++other)
        if ((other + 1 < t->share || other > t->share + 1) && comes_to(t, other))
            mspringi_progress_wait(&t->progress[other], t->passed);
}
