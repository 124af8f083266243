/// Snapshot of a solver's state between steps, and of the network's precision.
#include "store/sections.h"

// A solver without such state has no section.
static void implicit_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_solver *solver = &network->solver;
    if (solver->ops->save)
        solver->ops->save(network, solver->object, to);
}

static mspring_result implicit_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_solver *solver = &network->solver;
    const bool has_one = solver->ops->check != NULL;
    if (has_one != (size > 0))
        return mspringi_section_fail(network, &mspringi_section_implicit, "it was saved %s one, the network has %s",
                                     size > 0 ? "with" : "without", has_one ? "one" : "none");
    return has_one ? solver->ops->check(network, solver->object, from, size) : MSPRING_OK;
}

static void implicit_load(mspring_network *network, const uint8_t *from, size_t size) {
    if (size > 0)
        network->solver.ops->load(network, network->solver.object, from, size);
}

const mspringi_section mspringi_section_implicit = {"impl",        "implicit solver", false,         NULL,
                                                    implicit_save, implicit_check,    implicit_load, NULL};

static uint32_t implicit_runs(const mspring_network *network, mspringi_io head, mspringi_run *runs) {
    const mspringi_solver *solver = &network->solver;
    runs[0] = (mspringi_run){MSPRINGI_BYTES, MSPRINGI_THE_REST};
    return solver->ops->runs ? solver->ops->runs(network, solver->object, head, runs) : 1;
}

static void implicit_leave(const mspring_network *network, uint8_t *section, size_t size) {
    if (network->solver.ops->leave)
        network->solver.ops->leave(network, section, size);
}

static size_t implicit_enter(const mspring_network *network, uint8_t *section, size_t size) {
    const mspringi_solver *solver = &network->solver;
    return solver->ops->enter ? solver->ops->enter(network, solver->object, section, size) : size;
}

const mspringi_by_id mspringi_by_id_implicit = {&mspringi_section_implicit, implicit_runs, implicit_leave,
                                                implicit_enter};

/* --------------------------------------------------------------------------------------------------- precision */

// 1 if low words count in the lengths of springs, else absent. Fixed at creation.
static void precision_save(const mspring_network *network, mspringi_writer *to) {
    if (network->is_precise)
        mspringi_put(to, &(uint32_t){1}, 1, sizeof(uint32_t));
}

static mspring_result precision_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_precision;
    mspringi_io io = mspringi_io_from(from, size);
    uint32_t is_precise;
    MSPRINGI_HAND(&io, is_precise);
    if (size > 0 && (io.left > 0 || is_precise != 1))
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

const mspringi_section mspringi_section_precision = {"prec",         "precision",     false,          NULL,
                                                     precision_save, precision_check, precision_load, NULL};
