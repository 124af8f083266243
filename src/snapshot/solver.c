/// What a solver carries from step to step, in a snapshot: of the implicit ones the history and, unless it is to be
/// factored anew, the coarse matrix. The explicit one carries nothing, and the direct one has no tiles, so that the
/// hash of them is 0.
#include <float.h>
#include <math.h>
#include <string.h>

#include "contact/floor.h"
#include "implicit/implicit.h"
#include "sections.h"

typedef struct implicit_head {
    uint64_t tiles_print;
    double scale;
    float h;
    uint32_t restarts, integrator, iterations, coarse_period, age;
} implicit_head;
#define HEAD_BYTES ((size_t)40)

static size_t implicit_size_of(const mspringi_implicit *n, size_t coarse_values) {
    return HEAD_BYTES + n->history_size * sizeof(float) + coarse_values * sizeof(double);
}

// The age of the coarse matrix that the next substep finds. One that has contacts in it is not used again.
static uint32_t age_of(const mspring_network *network) {
    const mspringi_implicit *n = network->implicit;
    if (n->is_direct || (network->floor && network->floor->is_in_coarse))
        return 0;
    return mspringi_tiles_are_outdated(&n->tiles, network, &n->seen) ? 0 : n->age;
}

static size_t coarse_values(const mspring_network *network) {
    return age_of(network) > 0 ? network->implicit->coarse.value_count : 0;
}

static size_t implicit_size(const mspring_network *network) {
    return network->implicit ? implicit_size_of(network->implicit, coarse_values(network)) : 0;
}

static void implicit_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_implicit *n = network->implicit;
    // A history of a motion that has ended is as good as none.
    const bool ended = n->seen.motion != network->edits.motion;
    const uint32_t words[] = {ended ? 1 : n->history.restarts, (uint32_t)n->integrator, n->iterations,
                              n->coarse_period, age_of(network)};
    mspringi_put(to, &n->tiles.print, 1, sizeof n->tiles.print);
    mspringi_put(to, &n->scale, 1, sizeof n->scale);
    mspringi_put(to, &n->history.h, 1, sizeof n->history.h);
    mspringi_put(to, words, sizeof words / sizeof words[0], sizeof words[0]);
    if (ended)
        mspringi_put_zeros(to, n->history_size * sizeof(float));
    else
        mspringi_put(to, n->history.first.x, n->history_size, sizeof(float));
    mspringi_put(to, n->coarse.values, coarse_values(network), sizeof(double));
}

static const uint8_t *read_head(const uint8_t *from, implicit_head *head) {
    from = mspringi_get(from, &head->tiles_print, 1, sizeof head->tiles_print);
    from = mspringi_get(from, &head->scale, 1, sizeof head->scale);
    from = mspringi_get(from, &head->h, 1, sizeof head->h);
    from = mspringi_get(from, &head->restarts, 1, sizeof head->restarts);
    from = mspringi_get(from, &head->integrator, 1, sizeof head->integrator);
    from = mspringi_get(from, &head->iterations, 1, sizeof head->iterations);
    from = mspringi_get(from, &head->coarse_period, 1, sizeof head->coarse_period);
    return mspringi_get(from, &head->age, 1, sizeof head->age);
}

static mspring_result check_head(mspring_network *network, const implicit_head *head) {
    const mspringi_section *section = &mspringi_section_implicit;
    const mspringi_implicit *n = network->implicit;
    if (head->integrator != (uint32_t)n->integrator || head->tiles_print != n->tiles.print)
        return mspringi_section_fail(network, section,
                                     "the network has another solver or integrator, or other tiles");
    if (!(head->scale >= DBL_MIN && head->scale <= DBL_MAX && head->h >= 0.0f && head->h <= FLT_MAX) ||
        head->restarts > MSPRINGI_CALM_SUBSTEPS)
        return mspringi_section_fail(network, section, "its scale is %g, its substep %g s", head->scale,
                                     (double)head->h);
    if (head->iterations < 1 || head->iterations > MSPRINGI_MOST_ITERATIONS || head->coarse_period < 1 ||
        head->coarse_period > MSPRINGI_MOST_ITERATIONS || head->age >= head->coarse_period)
        return mspringi_section_fail(
            network, section, "it has %u iterations, and a coarse matrix %u substeps old of %u",
            (unsigned)head->iterations, (unsigned)head->age, (unsigned)head->coarse_period);
    return MSPRING_OK;
}

static mspring_result implicit_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_implicit;
    const mspringi_implicit *n = network->implicit;
    implicit_head head = {0};
    if (!n && size == 0)
        return MSPRING_OK;
    if (!n || size == 0)
        return mspringi_section_fail(network, section, "it was saved %s one, the network has %s",
                                     size > 0 ? "with" : "without", n ? "one" : "none");
    if (size < HEAD_BYTES)
        return mspringi_section_check_size(network, section, size, HEAD_BYTES);
    from = read_head(from, &head);
    mspring_result result = check_head(network, &head);
    // How large the coarse matrix is depends on what is broken in the snapshot.
    const size_t fixed = implicit_size_of(n, 0), rest = size > fixed ? size - fixed : 0;
    const size_t values = head.age > 0 ? rest / sizeof(double) : 0;
    if (result == MSPRING_OK)
        result = mspringi_section_check_size(network, section, size, implicit_size_of(n, values));
    for (size_t i = 0; result == MSPRING_OK && i < n->history_size; ++i)
        if (!isfinite(mspringi_float_at(from, i)))
            result = mspringi_section_fail(network, section, "its history is not finite");
    from += n->history_size * sizeof(float);
    for (size_t i = 0; result == MSPRING_OK && i < values; ++i) {
        double value;
        from = mspringi_get(from, &value, 1, sizeof value);
        if (!isfinite(value))
            result = mspringi_section_fail(network, section, "its coarse matrix is not finite");
    }
    return result;
}

// Slots without particle stay where they are, and have no past for a particle that is added.
static void clear_history(const mspring_network *network) {
    float *const history = network->implicit->history.first.x;
    const size_t slots = mspringi_slot_count(network);
    for (size_t slot = 0; slot < slots; ++slot)
        for (size_t i = slot; i < network->implicit->history_size; i += slots)
            if (network->topology.particle_of_slot[slot] == MSPRING_NONE)
                history[i] = 0.0f;
}

static void implicit_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_implicit *n = network->implicit;
    implicit_head head;
    if (size == 0)
        return;
    from = read_head(from, &head);
    n->scale = head.scale;
    n->history.h = head.h;
    n->history.restarts = head.restarts;
    n->iterations = head.iterations;
    n->coarse_period = head.coarse_period;
    n->budget.is_known = n->budget.knows_elastic = false;
    from = mspringi_get(from, n->history.first.x, n->history_size, sizeof(float));
    clear_history(network);
    mspringi_implicit_follow(network);
    // The matrix of other tiles than those that follow from the rest of the snapshot would be of no use.
    n->age = size == implicit_size_of(n, n->coarse.value_count) ? head.age : 0;
    if (n->age > 0)
        mspringi_get(from, n->coarse.values, n->coarse.value_count, sizeof(double));
    if (network->floor)
        network->floor->is_in_coarse = false;
}

const mspringi_section mspringi_section_implicit = {"impl",        "implicit solver", false,        implicit_size,
                                                    implicit_save, implicit_check,    implicit_load};

/* --------------------------------------------------------------------------------------------------- precision */

// There if low words count in the lengths of springs, which is the network's own for good: 1.
#define PRECISION_BYTES ((size_t)4)

static size_t precision_size(const mspring_network *network) {
    return network->is_precise ? PRECISION_BYTES : 0;
}

static void precision_save(const mspring_network *network, mspringi_writer *to) {
    const uint32_t is_precise = network->is_precise;
    mspringi_put(to, &is_precise, 1, sizeof is_precise);
}

static mspring_result precision_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_precision;
    uint32_t is_precise = 0;
    if (size == PRECISION_BYTES)
        mspringi_get(from, &is_precise, 1, sizeof is_precise);
    if (size > 0 && is_precise != 1)
        return mspringi_section_fail(network, section, "it takes %zu bytes and is %u", size, (unsigned)is_precise);
    if ((size > 0) == network->is_precise)
        return MSPRING_OK;
    return mspringi_section_fail(network, section,
                                 "it was saved %s MSPRING_NETWORK_PRECISE, the network was created %s",
                                 size > 0 ? "with" : "without", size > 0 ? "without" : "with it");
}

static void precision_load(mspring_network *network, const uint8_t *from, size_t size) {
    (void)network;
    (void)from;
    (void)size;
}

const mspringi_section mspringi_section_precision = {"prec",         "precision",     false,         precision_size,
                                                     precision_save, precision_check, precision_load};
