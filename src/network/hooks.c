/// Host functions that are called in the course of a step.
#include "hooks.h"

mspring_result mspring_network_add_hook(mspring_network *network, mspring_phase phase, mspring_hook_fn fn,
                                        void *user, uint32_t *hook) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    if (phase < MSPRING_PHASE_BEFORE_STEP || phase > MSPRING_PHASE_AFTER_SUBSTEP)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "phase is %d, which is none", (int)phase);
    if (!fn)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "hook function is NULL");

    mspringi_forces *forces = &network->forces;
    if (phase == MSPRING_PHASE_BEFORE_SUBSTEP)
        result = mspringi_field_reserve(network, &forces->total);
    if (result == MSPRING_OK && phase == MSPRING_PHASE_BEFORE_STEP)
        result = mspringi_field_reserve(network, &forces->base);
    void *hooks = network->hooks;
    if (result == MSPRING_OK && !mspringi_grow(&network->memory, &hooks, &network->hook_capacity,
                                               network->hook_count + 1, sizeof *network->hooks))
        result =
            mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for hook %zu", network->hook_count);
    network->hooks = hooks;
    if (result != MSPRING_OK)
        return result;
    network->hooks[network->hook_count++] =
        (mspringi_hook){.phase = phase, .fn = fn, .user = user, .number = network->next_hook};
    network->is_open = true;
    if (hook)
        *hook = network->next_hook;
    network->next_hook++;
    return MSPRING_OK;
}

mspring_result mspring_network_remove_hook(mspring_network *network, uint32_t hook) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    size_t i = 0;
    while (i < network->hook_count && network->hooks[i].number != hook)
        ++i;
    if (i == network->hook_count)
        return mspringi_fail(&network->message, MSPRING_ERROR_ID, "there is no hook %u", (unsigned)hook);
    network->hook_count--;
    for (; i < network->hook_count; ++i)
        network->hooks[i] = network->hooks[i + 1];
    return MSPRING_OK;
}

bool mspringi_hooks_any(const mspring_network *network, mspring_phase phase) {
    for (size_t i = 0; i < network->hook_count; ++i)
        if (network->hooks[i].phase == phase)
            return true;
    return false;
}

void mspringi_hooks_call(mspring_network *network, mspring_phase phase, uint32_t substep, double dt,
                         mspringi_field field) {
    for (size_t i = 0; i < network->hook_count; ++i) {
        const mspringi_hook *hook = &network->hooks[i];
        if (hook->phase != phase)
            continue;
        const mspring_hook_args args = {
            .struct_size = sizeof args,
            .phase = phase,
            .substep = substep,
            .substep_count = network->substeps,
            .first_slot = 0,
            .slot_count = (uint32_t)mspringi_slot_count(network),
            .dt = dt,
            .origin_x = network->origin_x,
            .origin_y = network->origin_y,
            .x = network->state.x,
            .y = network->state.y,
            .vx = network->state.vx,
            .vy = network->state.vy,
            .force_x = field.x,
            .force_y = field.y,
            .inverse_mass = network->inverse_mass,
            .particle_of_slot = network->topology.particle_of_slot,
        };
        network->in_hook = true;
        hook->fn(&args, hook->user);
        network->in_hook = false;
    }
}
