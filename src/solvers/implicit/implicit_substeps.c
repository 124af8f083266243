/// Substeps: linear system, active set, floor, energy budget; repeated in halves if the budget is exceeded.
#include "features/contact/floor.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"
#include "stability/guard.h"

/// A substep has about forty barriers. If workers share cores, barriers become sleeps, and one worker is faster
/// (two workers on cores with a load of 10: 2.3 times, 1800x5). After a substep with more sleeps than bearable, one
/// worker takes the next ones: few at first, then twice as many each time, up to a limit. The bits are the same.
/// Few at first, because others take a core for a moment now and then. (With 64 our ship's two workers were as fast
/// as one; with 4 they are 1.3 to 1.7 times as fast.)
///
/// A sleep costs some 50 us, a product with the matrix 6 ns a slot. So a substep bears one sleep more for each
/// 64,000 slots of its products, and each further worker as many. (With 6 for all together, two workers of
/// 1200x1200 were sent home in five substeps of six, though each had a core: a barrier there waits longer than it
/// polls.)
#define BEARABLE_SLEEPS 6
#define SLOTS_OF_SLEEP 64000
#define SHORTEST_PATIENCE 4
#define LONGEST_PATIENCE 1024

// Forget the history if the host has begun a new motion; cut tiles anew where springs broke or pins changed.
static void follow_edits(mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    if (n->seen.motion != network->edits.motion)
        mspringi_implicit_forget(n);
    if (n->may_have_overflowed)
        mspringi_implicit_clear_overflow(network, n);
    mspringi_implicit_update(network, n);
    n->system.parts = network->parts;
    n->system.rest_lengths = network->rest_lengths.lengths;
    n->system.rests_of_block = network->rest_lengths.of_block;
}

// Find d = displacement + alpha direction.
static void solve(const mspringi_implicit_substep *substep, mspringi_team_member *member, mspringi_solution *to) {
    mspringi_implicit *n = mspringi_implicit_of(substep->network);
    if (member->index == 0)
        n->pass_count++;
    if (!n->is_direct) {
        mspringi_solve(substep, member, to);
        return;
    }
    mspringi_team_barrier(member);
    if (member->index == 0)
        mspringi_direct_solve(substep->network);
    mspringi_team_barrier(member);
}

// Most solutions of a substep while the active set changes.
#define MOST_PASSES 16

// True if an impact needs implicit Euler in this substep, but another integrator began it.
static bool must_begin_anew(const mspringi_implicit *n) {
    return !n->uses_euler && n->integrator != MSPRING_INTEGRATOR_EULER;
}

// Update the active set. Return true if it changed.
static bool update_active_set(mspring_network *network, float alpha, uint32_t pass) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_constraints *all = &network->constraints;
    mspringi_loose_contact_end_solution(network);
    const uint32_t changed = mspringi_constraints_update_active_set(all, n->displacement, n->direction,
                                                                    n->is_direct ? 0.0f : alpha, pass);
    n->restarts_with_euler = (changed >> MSPRINGI_CONTACT_CONSTRAINT & 1) && must_begin_anew(n) &&
                             mspringi_contact_constraint_is_active(all);
    return changed != 0;
}

// Solve with the terms of floor, grips and contact. Return false if the substep must begin again.
static bool solve_with_terms(const mspringi_implicit_substep *substep, mspringi_team_member *member,
                             mspringi_solution *solution) {
    mspring_network *network = substep->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    for (uint32_t pass = 0; pass < MOST_PASSES; ++pass) {
        if (pass > 0) {
            mspringi_predict(substep, member);
            mspringi_assemble(substep, member);
        }
        mspringi_team_barrier(member);
        if (member->index == 0)
            n->restarts_with_euler = !mspringi_constraints_add_terms(network, substep->h, pass);
        mspringi_team_barrier(member);
        if (n->restarts_with_euler)
            return false;
        solve(substep, member, solution);
        mspringi_team_barrier(member);
        if (member->index == 0) {
            const bool has_changed = update_active_set(network, solution->alpha, pass);
            n->must_solve_again = has_changed && mspringi_implicit_may_repeat(n);
            n->is_cut_off = has_changed && !n->must_solve_again;
        }
        mspringi_team_barrier(member);
        if (n->restarts_with_euler)
            return false;
        if (!n->must_solve_again)
            break;
    }
    if (member->index == 0) {
#define SYSTEM(name) mspringi_##name##_store_forces(network);
#include "store/features.def"
        mspringi_implicit_contact_store_impulses(network, substep->h);
    }
    mspringi_team_barrier(member);
    return true;
}

static bool has_constraints(const mspring_network *network) {
    bool any = false;
    (void)network; // a build may have no such feature
#define SYSTEM(name) any = any || mspringi_##name##_act(network);
#include "store/features.def"
    return any;
}

// A worker's part of a substep.
static void run_share(void *argument, uint32_t index, uint32_t worker) {
    const mspringi_implicit_substep *substep = argument;
    mspringi_team_member member = {.index = index, .count = substep->workers, .progress = substep->progress};
    (void)worker;
    mspringi_predict(substep, &member);
    mspringi_assemble(substep, &member);
    mspringi_solution solution = {0.0f, 0.0, false};
    if (!substep->network->floor && !has_constraints(substep->network) &&
        !mspringi_implicit_contact_is_near(substep->network))
        solve(substep, &member, &solution);
    else if (!solve_with_terms(substep, &member, &solution))
        return;
    mspringi_correct(substep, &member, solution.alpha);
}

static void choose_team(mspringi_implicit_substep *substep) {
    const mspring_network *network = substep->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    const bool shared = mspringi_slot_count(network) >= MSPRINGI_SMALLEST_SHARED_SLOTS && n->solo_substeps == 0;
    n->solo_substeps -= n->solo_substeps > 0;
    substep->workers = shared ? mspringi_tasks_concurrency(network->tasks) : 1;
    substep->progress = substep->workers > 1 ? mspringi_tasks_progress(network->tasks) : NULL;
}

// Choose the next substeps of one worker from the sleeps at the barriers of some products.
static void judge_team(mspringi_implicit *n, uint32_t sleeps, uint32_t workers, uint32_t products) {
    const size_t each = BEARABLE_SLEEPS + n->used_slot_end * products / SLOTS_OF_SLEEP;
    if (sleeps <= each * (workers - 1)) {
        n->solo_backoff = 0;
        return;
    }
    const uint32_t longer = n->solo_backoff > 0 ? 2 * n->solo_backoff : SHORTEST_PATIENCE;
    n->solo_backoff = longer < LONGEST_PATIENCE ? longer : LONGEST_PATIENCE;
    n->solo_substeps = n->solo_backoff;
}

static void run_team(mspringi_implicit_substep *substep) {
    mspringi_tasks *tasks = substep->progress ? substep->network->tasks : NULL;
    mspringi_implicit *n = mspringi_implicit_of(substep->network);
    mspringi_constraints_begin(&substep->network->constraints);
    n->age = n->has_constraints_in_coarse ? 0 : n->age;
    n->has_constraints_in_coarse = false;
    mspringi_integrator_prepare(substep);
    mspringi_tasks_run(tasks, substep->workers, run_share, substep);
}

// Solve a substep, by implicit Euler for a half of another, and apply the floor.
static void run_substep(mspringi_implicit_substep *substep, bool is_half) {
    mspring_network *network = substep->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    const uint32_t sleeps = mspringi_tasks_sleeps(network->tasks), products = n->product_count;
    choose_team(substep);
    n->is_half = is_half;
    n->uses_euler =
        mspringi_implicit_contact_begin(network, substep->h) || n->contact_mode == MSPRINGI_CONTACT_BY_IMPULSES;
    n->restarts_with_euler = n->is_cut_off = false;
    run_team(substep);
    if (n->restarts_with_euler) {
        n->uses_euler = true;
        run_team(substep);
    }
    n->would_be_same = mspringi_integrator_is_euler(n) &&
                       (n->is_direct || mspringi_contact_constraint_is_active(&network->constraints));
    if (substep->progress)
        judge_team(n, mspringi_tasks_sleeps(network->tasks) - sleeps, substep->workers,
                   n->product_count - products);
    if (network->floor)
        mspringi_floor_record_impulses(network, substep->h);
    mspringi_integrator_accept(substep);
    n->age = n->age + 1 < n->coarse_period ? n->age + 1 : 0;
    mspringi_implicit_contact_fix_overlaps(network, substep->base, substep->h);
    // Last: otherwise the next interval, however short, would lift particles from below the floor.
    if (network->floor)
        mspringi_floor_apply_all(network, substep->h);
}

static void take_halves(mspringi_implicit_substep *substep, uint32_t tries);

// Take a substep of substep->h. If it exceeds the energy budget, or contact was not sound, undo it and take it
// again: once whole, by implicit Euler, unless that would be the same again; then in halves. tries: 0 at first, 1
// then, and one more with each halving.
// Contact that was not sound has no friction in the next try. In the shortest halves, and once no work is left, it
// acts by impulses, which are always sound.
static void take_substep(mspringi_implicit_substep *substep, uint32_t tries) {
    mspring_network *network = substep->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    if (network->contacts && mspringi_contact_is_rejected(network->contacts))
        return;
    const bool are_near = mspringi_implicit_contact_is_near(network), watches = substep->watches || are_near;
    const bool may_repeat = mspringi_implicit_may_repeat(n);
    const bool may_halve =
        may_repeat && tries <= (are_near ? MSPRINGI_MOST_HALVINGS_OF_BODIES : MSPRINGI_MOST_HALVINGS);
    if (tries == 0 || !may_repeat)
        n->contact_mode = may_repeat ? MSPRINGI_CONTACT_WITH_FRICTION : MSPRINGI_CONTACT_BY_IMPULSES;
    n->holds_overlaps &= tries > 0;
    if (watches)
        mspringi_budget_begin(network);
    else
        n->budget.knows_elastic = false;
    run_substep(substep, tries > 0);
    const bool is_sound =
        !(n->is_cut_off && are_near) && mspringi_implicit_contact_kept_energy(network, substep->h);
    const bool is_last = !may_halve && (is_sound || n->contact_mode == MSPRINGI_CONTACT_BY_IMPULSES);
    const bool is_thrown = may_halve && mspringi_implicit_contact_missed_pairs(network, substep->h);
    if (!watches || ((is_sound || is_last) && !is_thrown &&
                     mspringi_budget_end(network, substep->h, substep->base, may_halve))) {
#define SYSTEM(name) mspringi_##name##_count_impulses(network, substep->h);
#include "store/features.def"
        mspringi_implicit_contact_count_impulses(network, substep->h);
        return;
    }
    mspringi_budget_undo(network);
    n->history.restarts = MSPRINGI_RECOVERY_SUBSTEPS;
    n->age = 0;
    if (!is_sound || !may_halve)
        n->contact_mode = may_halve ? MSPRINGI_CONTACT_FRICTIONLESS : MSPRINGI_CONTACT_BY_IMPULSES;
    const bool changes =
        !n->would_be_same || n->holds_overlaps || n->contact_mode != MSPRINGI_CONTACT_WITH_FRICTION;
    if (!may_halve || (tries == 0 && changes))
        take_substep(substep, tries + (tries == 0));
    else
        take_halves(substep, tries + 1 + (tries == 0));
}

static void take_halves(mspringi_implicit_substep *substep, uint32_t tries) {
    mspring_network *network = substep->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    const float h = substep->h;
    substep->h = 0.5f * h;
    for (int half = 0; half < 2; ++half) {
        n->age = 0; // the coarse matrix is one of another substep
        if (network->floor)
            mspringi_floor_save_positions(network, substep->h);
        n->intervals_left += half == 0;
        take_substep(substep, tries);
        n->intervals_left -= half == 0;
    }
    n->age = 0;
    substep->h = h;
}

// Divide a substep into intervals before hard impacts on the floor or between bodies.
static void take_intervals(mspringi_implicit_substep *substep) {
    mspring_network *network = substep->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    const float h = substep->h;
    const bool has_floor = network->floor != NULL;
    if (has_floor)
        mspringi_floor_save_positions(network, h);
    const uint32_t by_floor = has_floor ? mspringi_floor_count_intervals(network, h) : 1;
    const uint32_t by_bodies = mspringi_implicit_contact_count_intervals(network, h);
    const uint32_t intervals = mspringi_implicit_limit_intervals(n, by_floor > by_bodies ? by_floor : by_bodies);
    substep->h = h / (float)intervals;
    for (uint32_t i = 0; i < intervals; ++i) {
        if (intervals > 1 && has_floor)
            mspringi_floor_save_positions(network, substep->h);
        n->intervals_left = intervals - 1 - i;
        take_substep(substep, 0);
        if (has_floor)
            mspringi_floor_end_interval(network, substep->h);
    }
    substep->h = h;
}

void mspringi_implicit_run_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count) {
    mspringi_budget_update(network);
    if (network->floor)
        mspringi_floor_save_isolated(network);
    follow_edits(network);
    if (network->tested.yields && mspringi_implicit_of(network)->history.h != h)
        mspringi_implicit_of(network)->age = 0; // a piece of a substep: the coarse matrix is one of another length
    mspringi_implicit_substep substep = {
        .network = network, .base = base, .h = h, .watches = mspringi_guard_checks_limit(network->settings.guard)};
    for (uint32_t i = 0; i < count; ++i) {
        mspringi_implicit_of(network)->most_work += mspringi_implicit_of(network)->work_rate * (double)h;
        mspringi_implicit_contact_allow_work(network);
        if (network->floor || mspringi_implicit_contact_is_near(network))
            take_intervals(&substep);
        else
            take_substep(&substep, 0);
    }
    if (network->floor)
        mspringi_floor_step_isolated(network, h, base, count);
}
