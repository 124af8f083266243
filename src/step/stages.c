/// Calls of the stages of a step.
#include "store/stages.h"

// By place; NULL where a build has no stage.
static const mspringi_stage *const all[MSPRINGI_STAGES] = {
#define STAGE(place, table) [MSPRINGI_STAGE_OF_##place] = &table,
#include "store/features.def"
};

static bool cuts_substeps(const mspringi_stage *stage) {
    return stage->writes_state || stage->before_substep || stage->after_substep;
}

bool mspringi_stage_exists(int place) {
    return all[place] != NULL;
}

mspringi_stages mspringi_stages_of(const mspring_network *network) {
    mspringi_stages stages = {.count = 0};
    for (size_t i = 0; i < MSPRINGI_STAGES; ++i) {
        if (!all[i] || (all[i]->is_used && !all[i]->is_used(network)))
            continue;
        const bool is_optional = all[i]->is_quiet && !(all[i]->is_needed && all[i]->is_needed(network));
        stages.used[stages.count++] = all[i];
        stages.give_forces |= all[i]->forces && !is_optional;
        stages.move |= all[i]->moves && all[i]->moves(network);
        stages.cut_substeps |= cuts_substeps(all[i]) && !is_optional;
        stages.can_be_quiet |= all[i]->is_quiet != NULL || all[i]->must_repeat != NULL;
        stages.follow_substeps |= all[i]->after_substep != NULL;
    }
    return stages;
}

bool mspringi_stages_must_cut_step(const mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_stages *stages = attempt->stages;
    bool cut = stages->cut_substeps;
    for (size_t i = 0; stages->can_be_quiet && i < stages->count && !cut; ++i)
        cut = stages->used[i]->is_quiet && !stages->used[i]->is_quiet(network, attempt);
    return cut;
}

static bool are_forces_given(const mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_stages *stages = attempt->stages;
    bool any = stages->give_forces;
    for (size_t i = 0; stages->can_be_quiet && i < stages->count && !any; ++i)
        any = stages->used[i]->forces && stages->used[i]->is_quiet && !stages->used[i]->is_quiet(network, attempt);
    return any;
}

mspringi_field mspringi_stages_forces(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_stages *stages = attempt->stages;
    const mspringi_forces *forces = &network->forces;
    const mspringi_field none = {NULL, NULL};
    if (!are_forces_given(network, attempt))
        return forces->held_any ? forces->held : none;
    if (forces->held_any)
        mspringi_field_copy(network, forces->held, forces->base);
    else
        mspringi_field_clear(network, forces->base);
    for (size_t i = 0; i < stages->count; ++i)
        if (stages->used[i]->forces)
            stages->used[i]->forces(network, attempt, forces->base);
    return forces->base;
}

void mspringi_stages_before_step(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_stages *stages = attempt->stages;
    for (size_t i = 0; i < stages->count; ++i)
        if (stages->used[i]->before_step)
            stages->used[i]->before_step(network, attempt);
}

void mspringi_stages_forces_known(mspring_network *network, const mspringi_attempt *attempt, mspringi_field force) {
    const mspringi_stages *stages = attempt->stages;
    network->forces.known = force;
    for (size_t i = 0; i < stages->count; ++i)
        if (stages->used[i]->forces_known)
            stages->used[i]->forces_known(network, force);
}

uint32_t mspringi_stages_free_substeps(const mspring_network *network, const mspringi_attempt *attempt,
                                       uint32_t substep) {
    const mspringi_stages *stages = attempt->stages;
    uint32_t count = attempt->substeps - substep;
    for (size_t i = 0; i < stages->count; ++i) {
        const mspringi_stage *stage = stages->used[i];
        if (!stage->before_substep && !stage->after_substep)
            continue;
        const uint32_t most = stage->free_substeps ? stage->free_substeps(network, attempt, substep) : 1;
        count = most < count ? most : count;
    }
    return count;
}

mspringi_field mspringi_stages_before_substep(mspring_network *network, const mspringi_attempt *attempt,
                                              uint32_t substep, mspringi_field base, mspringi_field *outside) {
    const mspringi_stages *stages = attempt->stages;
    *outside = base;
    for (size_t i = 0; i < stages->count; ++i) {
        if (!stages->used[i]->before_substep)
            continue;
        const mspringi_field made = stages->used[i]->before_substep(network, attempt, substep, base);
        if (made.x != base.x && !stages->used[i]->is_inner)
            *outside = made;
        base = made;
    }
    return base;
}

uint32_t mspringi_stages_max_parts(mspring_network *network, const mspringi_attempt *attempt, uint32_t left) {
    const mspringi_stages *stages = attempt->stages;
    uint32_t least = left;
    for (size_t i = 0; i < stages->count; ++i) {
        const uint32_t most =
            stages->used[i]->max_parts ? stages->used[i]->max_parts(network, attempt, left) : left;
        least = most < least ? most : least;
    }
    return least;
}

void mspringi_stages_after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    const mspringi_stages *stages = attempt->stages;
    for (size_t i = 0; i < stages->count; ++i)
        if (stages->used[i]->after_substep)
            stages->used[i]->after_substep(network, attempt, substep);
}

bool mspringi_stages_must_repeat(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_stages *stages = attempt->stages;
    bool missed = false;
    for (size_t i = 0; stages->can_be_quiet && i < stages->count; ++i)
        missed |= stages->used[i]->must_repeat && stages->used[i]->must_repeat(network, attempt);
    return missed;
}

mspring_result mspringi_stages_verify(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_stages *stages = attempt->stages;
    mspring_result result = MSPRING_OK;
    for (size_t i = 0; stages->can_be_quiet && i < stages->count && result == MSPRING_OK; ++i)
        if (stages->used[i]->verify)
            result = stages->used[i]->verify(network);
    return result;
}

void mspringi_stages_after_step(mspring_network *network, const mspringi_stages *stages, double dt) {
    for (size_t i = 0; i < stages->count; ++i)
        if (stages->used[i]->after_step)
            stages->used[i]->after_step(network, dt);
}

void mspringi_stages_roll_back(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_stages *stages = attempt->stages;
    for (size_t i = stages->count; i-- > 0;)
        if (stages->used[i]->roll_back)
            stages->used[i]->roll_back(network);
}

void mspringi_stages_roll_back_sweeps(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_stages *stages = attempt->stages;
    for (size_t i = stages->count; i-- > 0;)
        if (stages->used[i]->is_swept)
            stages->used[i]->roll_back(network);
}

void mspringi_stages_undo(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_stages *stages = attempt->stages;
    for (size_t i = stages->count; i-- > 0;)
        if (stages->used[i]->undo)
            stages->used[i]->undo(network, attempt);
}
