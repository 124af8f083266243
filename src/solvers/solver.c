/// The solvers that there are, and what is done to any of them.
#include "store/solver.h"

#include "features/contact/contacts.h"
#include "store/network.h"

const mspringi_solver_ops *mspringi_solver_ops_of(mspring_solver name) {
#define SOLVER(number, table)                                                                                      \
    if (name == (number))                                                                                          \
        return &table;
#include "store/solvers.def"
#undef SOLVER
    return NULL;
}

mspring_result mspringi_solver_check_name(mspring_solver name, mspringi_message *message) {
    if (mspringi_solver_ops_of(name))
        return MSPRING_OK;
    if (name == MSPRING_SOLVER_IMPLICIT || name == MSPRING_SOLVER_DIRECT)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "this build of the library has no %s solver (MASSSPRING_SOLVERS)",
                             name == MSPRING_SOLVER_IMPLICIT ? "implicit" : "direct");
    return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "solver is %d, which is none", (int)name);
}

mspring_result mspringi_solver_make(mspringi_solver *solver, mspring_network *network, const mspring_settings *def,
                                    uint32_t tile_size) {
    const mspringi_solver_ops *ops = solver->ops;
    const uint32_t sleeping = network->sleep.sleeping;
    network->sleep.sleeping = 0; // as if nothing slept: snapshots do not have sleepers that the next step wakes
    mspring_result result = ops->create ? ops->create(network, def, tile_size, &solver->object) : MSPRING_OK;
    if (result == MSPRING_OK && ops->has_implicit_contact)
        result = mspringi_contacts_reserve_implicit(network);
    if (result == MSPRING_OK && ops->has_implicit_grips && !mspringi_constraints_allocate(network))
        result = mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for the solver's constraints");
    for (bool is_done = !ops->build; result == MSPRING_OK && !is_done;)
        result = ops->build(solver->object, &is_done);
    network->sleep.sleeping = sleeping;
    if (result != MSPRING_OK && solver->object)
        mspringi_solver_destroy(solver, &network->memory);
    return result;
}

void mspringi_solver_destroy(mspringi_solver *solver, mspringi_memory *memory) {
    if (solver->ops && solver->ops->destroy)
        solver->ops->destroy(solver->object, memory);
    *solver = (mspringi_solver){0};
}

void mspringi_solver_forget(const mspringi_solver *solver) {
    if (solver->ops->forget)
        solver->ops->forget(solver->object);
}

mspringi_solver_basis mspringi_solver_get_basis(const mspringi_solver *solver) {
    if (solver->ops && solver->ops->get_basis)
        return solver->ops->get_basis(solver->object);
    return (mspringi_solver_basis){0};
}

void mspringi_solver_take_over(const mspring_network *to, const mspringi_solver *made, const mspring_network *from,
                               const mspringi_solver *had) {
    if (had->ops && had->ops->take_over)
        had->ops->take_over(to, made->object, from, had->object);
}

mspring_result mspringi_fallback_reserve(mspring_network *network, uint32_t tile_size) {
    mspringi_solver made = {mspringi_solver_ops_of(MSPRING_SOLVER_IMPLICIT), NULL};
    mspring_settings def;
    if (network->fallback.object)
        return MSPRING_OK;
    mspring_result result = mspringi_solver_check_name(MSPRING_SOLVER_IMPLICIT, &network->message);
    if (result != MSPRING_OK)
        return result;
    (void)mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def);
    def.solver = MSPRING_SOLVER_IMPLICIT;
    def.integrator = MSPRING_INTEGRATOR_EULER;
    result = mspringi_solver_make(&made, network, &def, tile_size);
    if (result == MSPRING_OK)
        network->fallback = made;
    return result;
}

/* ------------------------------------------------------------------------------------------------------- both */

void mspringi_solvers_clear_slot(const mspring_network *network, uint32_t slot) {
    const mspringi_solver *const both[] = {&network->solver, &network->fallback};
    for (size_t i = 0; i < 2; ++i)
        if (both[i]->ops && both[i]->ops->clear_slot)
            both[i]->ops->clear_slot(network, both[i]->object, slot);
}

void mspringi_solvers_clear_spring(const mspring_network *network, mspringi_spring_slot spring_slot) {
    const mspringi_solver *const both[] = {&network->solver, &network->fallback};
    for (size_t i = 0; i < 2; ++i)
        if (both[i]->ops && both[i]->ops->clear_spring)
            both[i]->ops->clear_spring(network, both[i]->object, spring_slot);
}

mspring_result mspringi_solvers_reserve(mspring_network *network) {
    const mspringi_solver *const both[] = {&network->solver, &network->fallback};
    mspring_result result = MSPRING_OK;
    for (size_t i = 0; result == MSPRING_OK && i < 2; ++i)
        if (both[i]->ops && both[i]->ops->reserve)
            result = both[i]->ops->reserve(both[i]->object, network);
    return result;
}

void mspringi_solvers_relocate(mspring_network *network, const mspringi_memory *from, const mspringi_memory *to) {
    mspringi_solver *const both[] = {&network->solver, &network->fallback};
    for (size_t i = 0; i < 2; ++i) {
        if (!both[i]->object)
            continue;
        both[i]->object = mspringi_memory_relocate(from, to, both[i]->object);
        both[i]->ops->relocate(both[i]->object, network, from, to);
    }
}
