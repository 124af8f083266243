/// Snapshot section of the implicit solver: the history and, between factorisations, the coarse matrix. The direct
/// solver saves its elimination order instead of tiles.
#include <float.h>
#include <math.h>
#include <string.h>

#include "features/contact/floor.h"
#include "solvers/implicit/implicit.h"
#include "store/sections.h"

typedef struct implicit_head {
    uint64_t fingerprint;
    double scale;
    float h;
    uint32_t restarts, integrator, iterations, coarse_period, age;
    float residual;
} implicit_head;

static void hand_head(mspringi_io *io, implicit_head *head) {
    MSPRINGI_HAND(io, head->fingerprint);
    MSPRINGI_HAND(io, head->scale);
    MSPRINGI_HAND(io, head->h);
    mspringi_hand(io, &head->restarts, 5, sizeof(uint32_t)); // and those that follow
    MSPRINGI_HAND(io, head->residual);
}

// Of what it was made for: other tiles, or another order, would give other bits.
static uint64_t fingerprint_of(const mspringi_implicit *n) {
    return n->is_direct ? n->direct.fingerprint : n->tiles.fingerprint;
}

// The age of the coarse matrix that the next substep finds. One that has constraints in it is not used again.
static uint32_t age_of(const mspring_network *network, const mspringi_implicit *n) {
    if (n->is_direct || n->has_constraints_in_coarse)
        return 0;
    return mspringi_tiles_are_outdated(&n->tiles, network, &n->seen) ? 0 : n->age;
}

static size_t coarse_values(const mspring_network *network, const mspringi_implicit *n) {
    return age_of(network, n) > 0 ? n->coarse.value_count : 0;
}

void mspringi_implicit_save(const mspring_network *network, const mspringi_implicit *n, mspringi_writer *to) {
    // A history of a motion that has ended is as good as none.
    const bool ended = n->seen.motion != network->edits.motion;
    mspringi_io io = mspringi_io_to(to);
    hand_head(&io, &(implicit_head){fingerprint_of(n), n->scale, n->history.h, ended ? 1 : n->history.restarts,
                                    (uint32_t)n->integrator, n->iterations, n->coarse_period, age_of(network, n),
                                    n->residual_share});
    if (ended)
        mspringi_put_zeros(to, n->history_size * sizeof(float));
    else
        mspringi_put(to, n->history.first.x, n->history_size, sizeof(float));
    mspringi_put(to, n->coarse.values, coarse_values(network, n), sizeof(double));
}

static mspring_result check_head(mspring_network *network, const mspringi_implicit *n, const implicit_head *head) {
    const mspringi_section *section = &mspringi_section_implicit;
    if (head->integrator != (uint32_t)n->integrator || head->fingerprint != fingerprint_of(n))
        return mspringi_section_fail(network, section,
                                     "the network has another solver or integrator, other tiles, or had other "
                                     "springs when the direct solver was chosen");
    if (!(head->scale >= DBL_MIN && head->scale <= DBL_MAX && head->h >= 0.0f && head->h <= FLT_MAX) ||
        head->restarts > MSPRINGI_RECOVERY_SUBSTEPS)
        return mspringi_section_fail(network, section, "its scale is %g, its substep %g s", head->scale,
                                     (double)head->h);
    if (!(head->residual >= 0.0f && head->residual <= 1.0f))
        return mspringi_section_fail(network, section, "its residual is %g", (double)head->residual);
    if (head->iterations < 1 || head->iterations > MSPRINGI_MOST_ITERATIONS || head->coarse_period < 1 ||
        head->coarse_period > MSPRINGI_MOST_ITERATIONS || head->age >= head->coarse_period)
        return mspringi_section_fail(
            network, section, "it has %u iterations, and a coarse matrix %u substeps old of %u",
            (unsigned)head->iterations, (unsigned)head->age, (unsigned)head->coarse_period);
    return MSPRING_OK;
}

mspring_result mspringi_implicit_check(mspring_network *network, const mspringi_implicit *n, const uint8_t *from,
                                       size_t size) {
    const mspringi_section *section = &mspringi_section_implicit;
    mspringi_io io = mspringi_io_from(from, size);
    implicit_head head;
    hand_head(&io, &head);
    mspring_result result = check_head(network, n, &head);
    for (size_t i = 0; result == MSPRING_OK && i < n->history_size; ++i) {
        float value;
        MSPRINGI_HAND(&io, value);
        if (!isfinite(value))
            result = mspringi_section_fail(network, section, "its history is not finite");
    }
    // How large the coarse matrix is depends on what is broken in the snapshot.
    while (result == MSPRING_OK && head.age > 0 && io.left > 0 && !io.is_short) {
        double value;
        MSPRINGI_HAND(&io, value);
        if (!isfinite(value))
            result = mspringi_section_fail(network, section, "its coarse matrix is not finite");
    }
    return result == MSPRING_OK ? mspringi_section_end(network, section, &io) : result;
}

// Slots without particle stay where they are, and have no past for a particle that is added.
static void clear_history(const mspring_network *network, const mspringi_implicit *n) {
    float *const history = n->history.first.x;
    const size_t slots = mspringi_slot_count(network);
    for (size_t slot = 0; slot < slots; ++slot)
        for (size_t i = slot; i < n->history_size; i += slots)
            if (network->topology.particle_of_slot[slot] == MSPRING_NONE)
                history[i] = 0.0f;
}

void mspringi_implicit_load(mspring_network *network, mspringi_implicit *n, const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    implicit_head head;
    hand_head(&io, &head);
    n->scale = head.scale;
    n->history.h = head.h;
    n->history.restarts = head.restarts;
    n->iterations = head.iterations;
    n->coarse_period = head.coarse_period;
    n->residual_share = head.residual;
    n->budget.is_known = n->budget.knows_elastic = false;
    mspringi_hand(&io, n->history.first.x, n->history_size, sizeof(float));
    clear_history(network, n);
    mspringi_implicit_update(network, n);
    // The matrix of other tiles than those that follow from the rest of the snapshot would be of no use.
    n->age = io.left == n->coarse.value_count * sizeof(double) ? head.age : 0;
    if (n->age > 0)
        mspringi_hand(&io, n->coarse.values, n->coarse.value_count, sizeof(double));
    n->has_constraints_in_coarse = false;
}

/* --------------------------------------------------------------------------------------------------- archives */

uint32_t mspringi_implicit_runs(const mspring_network *network, const mspringi_implicit *n, mspringi_io io,
                                mspringi_run *runs) {
    const size_t size = io.left, slots = mspringi_slot_count(network);
    implicit_head head;
    hand_head(&io, &head);
    runs[0] = (mspringi_run){MSPRINGI_BYTES, size - io.left};
    runs[1] = (mspringi_run){MSPRINGI_FLOATS, n->history_size / slots};
    runs[2] = (mspringi_run){MSPRINGI_BYTES, MSPRINGI_THE_REST};
    return 3;
}

// The tiles matter to a matrix of theirs only.
void mspringi_implicit_leave(const mspring_network *network, uint8_t *section, size_t size) {
    mspringi_io io = mspringi_io_from(section, size);
    mspringi_writer to = mspringi_writer_begin(section, network->kernels);
    mspringi_io back = mspringi_io_to(&to);
    implicit_head head;
    hand_head(&io, &head);
    head.fingerprint = head.age > 0 ? head.fingerprint : 0;
    hand_head(&back, &head);
}

// Other tiles begin with another matrix, and another order of elimination is as good.
size_t mspringi_implicit_enter(const mspring_network *network, const mspringi_implicit *n, uint8_t *section,
                               size_t size) {
    mspringi_io io = mspringi_io_from(section, size);
    mspringi_writer to = mspringi_writer_begin(section, network->kernels);
    mspringi_io back = mspringi_io_to(&to);
    implicit_head head;
    hand_head(&io, &head);
    if (head.fingerprint == fingerprint_of(n) || io.is_short)
        return size;
    const size_t history = n->history_size * sizeof(float);
    head.fingerprint = fingerprint_of(n);
    head.age = 0;
    hand_head(&back, &head);
    return io.left > history ? size - (io.left - history) : size;
}
