/// Host functions that are called in the course of a step.
#include <math.h>
#include <stdatomic.h>

#include "base/assert.h"
#include "features/hooks/reach.h"
#include "store/feature.h"
#include "store/sleepers.h"
#include "store/stages.h"

/// Fewest slots that are worth to be handed to another worker, if the host does not say.
#define SMALLEST_RANGE 2048

/// Global damping times dt above which a speed beyond MSPRING_MAX_SPEED could be below it again by the end of the
/// step: exp(-20) is 2e-9, and at 1e24 m/s nothing overflows yet.
#define STRONG_DAMPING 20.0

/* ------------------------------------------------------------------------------------------- adding, removing */

static mspring_result check_hook(mspring_network *network, const mspring_hook_def **given, mspring_hook_def *def) {
    mspringi_message *message = &network->message;
    mspring_result result = mspringi_take_hook_def(message, given, def);
    if (result == MSPRING_OK)
        result = mspringi_check_reserved(message, "mspring_hook_def", def->reserved);
    if (result != MSPRING_OK)
        return result;
    if (def->phase < MSPRING_PHASE_BEFORE_STEP || def->phase > MSPRING_PHASE_AFTER_SUBSTEP)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the hook's phase is %d, which is none",
                             (int)def->phase);
    if (!def->fn)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the hook's function is NULL");
    if (def->flags & ~(uint32_t)(MSPRING_HOOK_CONCURRENT | MSPRING_HOOK_BELOW))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the hook's flags are 0x%x, of which some are none",
                             (unsigned)def->flags);
    if (def->period < 1)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the hook's period is 0, it must be at least 1");
    if (def->phase == MSPRING_PHASE_BEFORE_STEP && def->period != 1)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the hook's period is %u substeps, but it is called before the step: it must be 1",
                             (unsigned)def->period);
    if (mspringi_has_reach(def) && !(fabs(def->below_y) <= MSPRING_MAX_COORDINATE))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the hook's below_y is %g m, it must be -1e12 to 1e12", def->below_y);
    return MSPRING_OK;
}

// The fields that a hook adds its forces to. Those of others stay, should the last be refused.
static mspring_result reserve_fields(mspring_network *network, const mspring_hook_def *def, mspringi_field *held) {
    if (def->phase == MSPRING_PHASE_BEFORE_STEP)
        return mspringi_field_reserve(network, &network->forces.base);
    if (def->phase == MSPRING_PHASE_AFTER_SUBSTEP)
        return MSPRING_OK;
    mspring_result result = mspringi_field_reserve(network, &network->forces.driven);
    return result == MSPRING_OK && def->period > 1 ? mspringi_field_reserve(network, held) : result;
}

// Make room for one more.
static bool grow(mspring_network *network) {
    if (!network->hooks)
        network->hooks = mspringi_alloc(&network->memory, 1, sizeof *network->hooks);
    mspringi_hooks *hooks = network->hooks;
    void *list = hooks ? hooks->list : NULL;
    const bool grown =
        hooks && mspringi_grow(&network->memory, &list, &hooks->capacity, hooks->count + 1, sizeof *hooks->list);
    if (grown)
        hooks->list = list;
    return grown;
}

mspring_result mspring_network_add_hook(mspring_network *network, const mspring_hook_def *def, mspring_id *hook) {
    mspring_hook_def taken;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_hook(network, &def, &taken);
    if (result != MSPRING_OK)
        return result;
    if (!grow(network))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for hook %zu",
                             mspringi_hook_count(network));
    mspringi_hooks *hooks = network->hooks;
    mspringi_hook added = {.def = *def, .number = hooks->next_number};
    result = reserve_fields(network, def, &added.held);
    if (result != MSPRING_OK)
        return result;
    hooks->list[hooks->count++] = added;
    network->is_open = true;
    if (hook)
        *hook = hooks->next_number;
    hooks->next_number++;
    return MSPRING_OK;
}

static void take_out(mspring_network *network, size_t i) {
    mspringi_hooks *hooks = network->hooks;
    MSPRINGI_ASSERT(i < hooks->count);
    mspringi_free(&network->memory, hooks->list[i].held.x);
    hooks->count--;
    for (; i < hooks->count; ++i)
        hooks->list[i] = hooks->list[i + 1];
}

mspring_result mspring_network_remove_hook(mspring_network *network, mspring_id hook) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    mspringi_hooks *hooks = network->hooks;
    size_t i = 0;
    while (i < mspringi_hook_count(network) && hooks->list[i].number != hook)
        ++i;
    if (i == mspringi_hook_count(network))
        return mspringi_fail(&network->message, MSPRING_ERROR_ID, "there is no hook %s", MSPRINGI_ID(hook));
    const mspring_hook_def removed = hooks->list[i].def;
    take_out(network, i);
    if (removed.release)
        removed.release(removed.user);
    return MSPRING_OK;
}

void mspringi_hooks_release(mspring_network *network) {
    for (size_t i = 0; i < mspringi_hook_count(network); ++i) {
        const mspring_hook_def *def = &network->hooks->list[i].def;
        if (def->release)
            def->release(def->user);
    }
}

/* --------------------------------------------------------------------------------------- layouts and copies */

mspring_result mspringi_hooks_move(mspring_network *to, const mspring_network *from) {
    const mspringi_hooks *had = from->hooks;
    mspring_result result = MSPRING_OK;
    if (!had)
        return MSPRING_OK;
    mspringi_hooks *made = to->hooks = mspringi_memory_duplicate(&to->memory, had);
    if (made)
        made->list = mspringi_memory_duplicate(&to->memory, had->list);
    if (!made || (had->list && !made->list))
        return mspringi_fail(&to->message, MSPRING_ERROR_MEMORY, "no memory for %zu hooks", had->count);
    for (size_t i = 0; result == MSPRING_OK && i < had->count; ++i) {
        made->list[i].held = (mspringi_field){NULL, NULL};
        if (had->list[i].held.x)
            result = mspringi_field_reserve(to, &made->list[i].held);
    }
    return result;
}

void mspringi_hooks_drop(const mspring_network *from, mspringi_memory *memory) {
    mspringi_hooks *hooks = from->hooks;
    if (!hooks)
        return;
    for (size_t i = 0; i < hooks->count; ++i)
        mspringi_free(memory, hooks->list[i].held.x);
    mspringi_free(memory, hooks->list);
    mspringi_free(memory, hooks);
}

void mspringi_hooks_clear(mspring_network *network) {
    while (mspringi_hook_count(network) > 0)
        take_out(network, mspringi_hook_count(network) - 1);
}

void mspringi_hooks_retain(mspring_network *network) {
    for (size_t i = 0; i < mspringi_hook_count(network);) {
        mspring_hook_def *def = &network->hooks->list[i].def;
        if (def->release && !def->retain) {
            take_out(network, i);
            continue;
        }
        if (def->retain)
            def->user = def->retain(def->user);
        ++i;
    }
}

static void relocate_fields(void *state, const mspringi_memory *from, const mspringi_memory *to) {
    const mspringi_hooks *hooks = state;
    for (size_t i = 0; i < hooks->count; ++i) {
        mspringi_field *held = &hooks->list[i].held;
        held->x = mspringi_memory_relocate(from, to, held->x);
        held->y = mspringi_memory_relocate(from, to, held->y);
    }
}

static const mspringi_array_entry arrays[] = {MSPRINGI_ARRAY_ENTRY(mspringi_hooks, list, MSPRINGI_ARRAY)};
const mspringi_feature_state mspringi_state_of_hooks = {MSPRINGI_ARRAY_TABLE(arrays), relocate_fields};

/* --------------------------------------------------------------------------------------------------- one call */

// A hook's call, divided into ranges.
typedef struct hook_call {
    const mspring_network *network;
    const mspring_hook_def *def;
    mspring_hook_args args; ///< but for range, worker, storage and result
    uint32_t slot_count, range;
    _Atomic uint64_t refused; ///< first slot of the first run that a hook refused, and what with; UINT64_MAX: none
} hook_call;

// Of several runs, the first in the order of slots counts: workers may call in any order.
static void note_refusal(hook_call *call, uint32_t first_slot, mspring_result result) {
    const uint32_t code = (uint32_t)(result < 0 ? -(int64_t)result : -(int64_t)MSPRING_ERROR_REFUSED);
    const uint64_t mine = (uint64_t)first_slot << 32 | code;
    uint64_t seen = call->refused;
    while (mine < seen && !atomic_compare_exchange_weak(&call->refused, &seen, mine))
        ;
}

static void call_run(hook_call *call, mspringi_slot_run run, uint32_t worker) {
    mspring_hook_args args = call->args;
    mspring_result result = MSPRING_OK;
    args.result = &result;
    args.first_slot = run.first;
    args.slot_count = run.end - run.first;
    args.worker = worker;
    if (call->def->storage)
        args.storage = (char *)call->def->storage + worker * call->def->storage_stride;
    call->def->fn(&args, call->def->user);
    if (result != MSPRING_OK)
        note_refusal(call, run.first, result);
}

static void call_range(void *argument, uint32_t index, uint32_t worker) {
    hook_call *call = argument;
    const uint32_t first = index * call->range;
    const uint32_t end = call->slot_count - first < call->range ? call->slot_count : first + call->range;
    mspringi_slot_run run = {first, end};
    if (!mspringi_has_reach(call->def))
        call_run(call, run, worker);
    else
        for (run.end = first; mspringi_next_below(call->network, call->def, run.end, end, &run);)
            call_run(call, run, worker);
}

// Slots in a range: whole blocks.
static uint32_t range_of(const mspring_network *network, const mspring_hook_def *def, uint32_t slot_count) {
    if (!(def->flags & MSPRING_HOOK_CONCURRENT))
        return slot_count;
    const uint32_t workers = mspringi_tasks_workers(network->tasks);
    uint32_t range = def->range_slots;
    if (range == 0)
        range = slot_count / workers > SMALLEST_RANGE ? slot_count / workers + 1 : SMALLEST_RANGE;
    return range < slot_count ? (range + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH : slot_count;
}

// A group of substeps that a hook is called for.
typedef struct hook_group {
    uint32_t substep, count;
    double seconds;
} hook_group;

static hook_group group_of(const mspringi_attempt *attempt, uint32_t substep, uint32_t count) {
    return (hook_group){substep, count, (double)attempt->h * (double)count};
}

static float bounded(float speed, float most) {
    return fabsf(speed) > most && isfinite(speed) ? (speed < 0 ? -most : most) : speed;
}

// Refuse excessive speeds that a hook has written, and that strong damping would hide at the end of the step, or
// bound them (the guard sees those that are not finite). Within it, rates of strain overflow, also of springs that
// do not exist, of which wide vectors have more: levels would differ.
static void judge_speeds(mspring_network *network, const mspringi_attempt *attempt, const mspringi_hook *hook) {
    mspringi_hooks *hooks = network->hooks;
    const mspringi_state *s = &network->state;
    const float most = (float)MSPRING_MAX_SPEED, set = network->settings.max_speed;
    if (!((double)network->settings.global_damping * attempt->dt > STRONG_DAMPING))
        return;
    for (mspring_id p = 0; p < network->topology.particle_count && hooks->refused == MSPRING_OK; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        if (!mspringi_particle_exists(network, p) || (fabsf(s->vx[slot]) <= most && fabsf(s->vy[slot]) <= most))
            continue;
        if (network->settings.guard == MSPRING_GUARD_CLAMP_BOUNDS) {
            mspringi_set_velocity(s, slot, bounded(s->vx[slot], set), bounded(s->vy[slot], set));
            network->outcome.flags |= MSPRING_STEP_PUT_BACK;
            continue;
        }
        hooks->refused = MSPRING_ERROR_UNSTABLE;
        hooks->refused_by = hook->number;
        hooks->hurled = network->outcome.particle = p;
        hooks->is_hurled = true;
    }
}

static void call_hook(mspring_network *network, const mspringi_attempt *attempt, const mspringi_hook *hook,
                      hook_group group, mspringi_field field) {
    const mspring_hook_def *def = &hook->def;
    const uint32_t slot_count = (uint32_t)mspringi_used_slots(network);
    mspringi_slot_run lowest;
    if (mspringi_has_reach(def) && !mspringi_next_below(network, def, 0, slot_count, &lowest))
        return;
    network->is_open = network->was_opened = true;
    network->guard.knows_speed = network->guard.knows_coordinate = false;
    hook_call call = {
        .network = network,
        .def = def,
        .slot_count = slot_count,
        .range = range_of(network, def, slot_count),
        .refused = UINT64_MAX,
        .args =
            {
                .struct_size = sizeof call.args,
                .phase = def->phase,
                .substep = group.substep,
                .substep_count = attempt->substeps,
                .dt = group.seconds,
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
                .slot_of_particle = network->topology.slot_of_particle,
                .network = network,
                .run_count = group.count,
            },
    };
    network->in_hook = def->flags & MSPRING_HOOK_CONCURRENT ? MSPRINGI_IN_HOOKS : MSPRINGI_IN_HOOK;
    mspringi_tasks_run(network->tasks, (slot_count + call.range - 1) / call.range, call_range, &call);
    network->in_hook = MSPRINGI_IN_NO_HOOK;
    const uint64_t refused = call.refused;
    if (refused != UINT64_MAX && network->hooks->refused == MSPRING_OK) {
        network->hooks->refused = (mspring_result)(-(int64_t)(uint32_t)refused);
        network->hooks->refused_by = hook->number;
    }
    judge_speeds(network, attempt, hook);
}

/* ------------------------------------------------------------------------------------------------ whose turn */

static bool has_any(const mspring_network *network, mspring_phase phase) {
    for (size_t i = 0; i < mspringi_hook_count(network); ++i)
        if (network->hooks->list[i].def.phase == phase)
            return true;
    return false;
}

// Whether a hook acts in this phase of the step.
static bool is_due(const mspring_network *network, const mspringi_attempt *attempt, mspringi_hook *hook,
                   mspring_phase phase) {
    return hook->def.phase == phase && !mspringi_hook_is_away(network, hook, attempt->dt);
}

static bool is_any_due(const mspring_network *network, const mspringi_attempt *attempt, mspring_phase phase) {
    for (size_t i = 0; i < mspringi_hook_count(network); ++i)
        if (is_due(network, attempt, &network->hooks->list[i], phase))
            return true;
    return false;
}

// Whether a hook is to be called in any step, or where all sleep.
static bool is_any_needed(const mspring_network *network, mspring_phase phase) {
    const uint32_t slots = (uint32_t)mspringi_used_slots(network);
    mspringi_slot_run run;
    for (size_t i = 0; i < mspringi_hook_count(network); ++i) {
        const mspring_hook_def *def = &network->hooks->list[i].def;
        if (def->phase == phase &&
            (!mspringi_has_reach(def) ||
             (mspringi_sleep_is_idle(network) && mspringi_next_below(network, def, 0, slots, &run))))
            return true;
    }
    return false;
}

// Substeps, from this one on, that can be taken until a hook of a phase is due again.
static uint32_t free_substeps(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                              mspring_phase phase) {
    uint32_t count = attempt->substeps - substep;
    for (size_t i = 0; i < mspringi_hook_count(network); ++i) {
        const uint32_t period = network->hooks->list[i].def.period;
        if (is_due(network, attempt, &network->hooks->list[i], phase) && period - substep % period < count)
            count = period - substep % period;
    }
    return count;
}

static void before_step(mspring_network *network, const mspringi_attempt *attempt, mspringi_field field) {
    const hook_group all = {0, 1, attempt->dt};
    for (size_t i = 0; i < mspringi_hook_count(network); ++i)
        if (is_due(network, attempt, &network->hooks->list[i], MSPRING_PHASE_BEFORE_STEP))
            call_hook(network, attempt, &network->hooks->list[i], all, field);
}

static void add(const mspring_network *network, mspringi_field from, mspringi_field to) {
    const size_t count = mspringi_used_slots(network);
    for (size_t i = 0; i < count; ++i)
        to.x[i] += from.x[i];
    for (size_t i = 0; i < count; ++i)
        to.y[i] += from.y[i];
}

// Call the hooks that are due before this substep, and give forces.driven anew: base (x NULL: none) and the forces
// of all hooks. If none is due, the field stays as it was; if none is in the whole step, the forces are base.
static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    bool any = false, acts = false;
    for (size_t i = 0; i < mspringi_hook_count(network); ++i) {
        mspringi_hook *hook = &network->hooks->list[i];
        const bool acts_here = is_due(network, attempt, hook, MSPRING_PHASE_BEFORE_SUBSTEP);
        acts |= acts_here;
        any |= acts_here && substep % hook->def.period == 0;
    }
    const mspringi_field driven = network->forces.driven;
    if (!any)
        return acts ? driven : base;
    if (base.x)
        mspringi_field_copy(network, base, driven);
    else
        mspringi_field_clear(network, driven);
    // A hook with a period has a field of its own, since its forces act on while others may be called again.
    const uint32_t left = attempt->substeps - substep;
    for (size_t i = 0; i < mspringi_hook_count(network); ++i) {
        mspringi_hook *hook = &network->hooks->list[i];
        if (!is_due(network, attempt, hook, MSPRING_PHASE_BEFORE_SUBSTEP))
            continue;
        if (!hook->held.x) {
            call_hook(network, attempt, hook, group_of(attempt, substep, 1), driven);
            continue;
        }
        if (substep % hook->def.period == 0) {
            mspringi_field_clear(network, hook->held);
            const uint32_t count = hook->def.period < left ? hook->def.period : left;
            call_hook(network, attempt, hook, group_of(attempt, substep, count), hook->held);
        }
        add(network, hook->held, driven);
    }
    return driven;
}

static void after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    for (size_t i = 0; i < mspringi_hook_count(network); ++i) {
        mspringi_hook *hook = &network->hooks->list[i];
        const uint32_t group = substep % hook->def.period + 1;
        const mspringi_field none = {NULL, NULL};
        if (is_due(network, attempt, hook, MSPRING_PHASE_AFTER_SUBSTEP) &&
            (group == hook->def.period || substep + 1 == attempt->substeps))
            call_hook(network, attempt, hook, group_of(attempt, substep, group), none);
    }
}

/* --------------------------------------------------------------------------------------- what was out of reach */

static void begin(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    for (size_t i = 0; i < mspringi_hook_count(network); ++i)
        network->hooks->list[i].distance = MSPRINGI_UNKNOWN;
}

static bool must_repeat(mspring_network *network, const mspringi_attempt *attempt) {
    bool any = false;
    for (size_t i = 0; i < mspringi_hook_count(network); ++i)
        any |= network->hooks->list[i].def.phase != MSPRING_PHASE_BEFORE_STEP &&
               mspringi_hook_must_repeat(network, &network->hooks->list[i], attempt);
    return any;
}

// Fail if a hook has refused the step. All three stages ask; the first one clears it.
static mspring_result verify(mspring_network *network) {
    mspringi_hooks *hooks = network->hooks;
    const mspring_result refused = hooks->refused;
    const bool is_hurled = hooks->is_hurled;
    hooks->refused = MSPRING_OK;
    hooks->is_hurled = false;
    hooks->ends_step = refused != MSPRING_OK && !is_hurled;
    if (is_hurled)
        return mspringi_fail(&network->message, refused,
                             "unstable: hook %u gave particle %u a velocity beyond 1e15 m/s in x or y",
                             (unsigned)hooks->refused_by, (unsigned)hooks->hurled);
    return refused == MSPRING_OK ? MSPRING_OK
                                 : mspringi_fail(&network->message, refused, "hook %u has refused the step: %s",
                                                 (unsigned)hooks->refused_by, mspring_result_string(refused));
}

bool mspringi_hooks_end_step(const mspring_network *network) {
    const bool ends = network->hooks && network->hooks->ends_step;
    if (ends)
        network->hooks->ends_step = false;
    return ends;
}

// A step that is repeated is looked at in every substep.
static void roll_back(mspring_network *network) {
    network->hooks->refused = MSPRING_OK;
    network->hooks->is_hurled = false;
    for (size_t i = 0; i < mspringi_hook_count(network); ++i)
        if (network->hooks->list[i].distance == MSPRINGI_AWAY)
            network->hooks->list[i].distance = MSPRINGI_CLOSE;
}

/* ------------------------------------------------------------------------------------------------------ stages */

static bool has_before_step(const mspring_network *network) {
    return has_any(network, MSPRING_PHASE_BEFORE_STEP);
}
static bool has_before_substep(const mspring_network *network) {
    return has_any(network, MSPRING_PHASE_BEFORE_SUBSTEP);
}
static bool has_after_substep(const mspring_network *network) {
    return has_any(network, MSPRING_PHASE_AFTER_SUBSTEP);
}

static bool is_before_step_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    return !is_any_due(network, attempt, MSPRING_PHASE_BEFORE_STEP);
}
static bool is_before_substep_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    return !is_any_due(network, attempt, MSPRING_PHASE_BEFORE_SUBSTEP);
}
static bool is_after_substep_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    return !is_any_due(network, attempt, MSPRING_PHASE_AFTER_SUBSTEP);
}

static bool is_before_step_needed(const mspring_network *network) {
    return is_any_needed(network, MSPRING_PHASE_BEFORE_STEP);
}
static bool is_before_substep_needed(const mspring_network *network) {
    return is_any_needed(network, MSPRING_PHASE_BEFORE_SUBSTEP);
}
static bool is_after_substep_needed(const mspring_network *network) {
    return is_any_needed(network, MSPRING_PHASE_AFTER_SUBSTEP);
}

static uint32_t free_before(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    return free_substeps(network, attempt, substep, MSPRING_PHASE_BEFORE_SUBSTEP);
}
static uint32_t free_after(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    return free_substeps(network, attempt, substep, MSPRING_PHASE_AFTER_SUBSTEP);
}

// Hooks may write to the state through the arrays that they are given.
const mspringi_stage mspringi_stage_hooks_before_step = {.is_used = has_before_step,
                                                         .writes_state = true,
                                                         .before_step = begin,
                                                         .is_quiet = is_before_step_quiet,
                                                         .is_needed = is_before_step_needed,
                                                         .forces = before_step,
                                                         .verify = verify,
                                                         .roll_back = roll_back};
const mspringi_stage mspringi_stage_hooks_before_substep = {.is_used = has_before_substep,
                                                            .writes_state = true,
                                                            .before_step = begin,
                                                            .is_quiet = is_before_substep_quiet,
                                                            .is_needed = is_before_substep_needed,
                                                            .free_substeps = free_before,
                                                            .before_substep = before_substep,
                                                            .must_repeat = must_repeat,
                                                            .verify = verify,
                                                            .roll_back = roll_back};
const mspringi_stage mspringi_stage_hooks_after_substep = {.is_used = has_after_substep,
                                                           .writes_state = true,
                                                           .before_step = begin,
                                                           .is_quiet = is_after_substep_quiet,
                                                           .is_needed = is_after_substep_needed,
                                                           .free_substeps = free_after,
                                                           .after_substep = after_substep,
                                                           .must_repeat = must_repeat,
                                                           .verify = verify,
                                                           .roll_back = roll_back};

bool mspringi_hooks_act(const mspring_network *network) {
    return mspringi_hook_count(network) > 0;
}
