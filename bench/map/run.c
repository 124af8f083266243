/// @file run.c
/// Running a case.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include "map/run.h"

#include <massspring/massspring.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "map/hold.h"
#include "map/precision.h"
#include "map/trade.h"
#include "scenes/internal.h"

/// Most springs times substeps of a case, so that none takes long.
static const double most_work = 1.5e6;

/// Explicit substeps up to this share of what is stable in any shape keep their energy in any motion, and longer
/// ones where no particle goes farther in a substep than this share of the shortest spring.
static const double calm_way = 0.002, calm_share = 0.2, calm_growth = 0.1;

/// What a floor may give of what can move.
static const double floor_gives = 1e-6;

/* ------------------------------------------------------------------------------------------------------ making */

static void push(const mspring_hook_args *args, void *user) {
    const map_case *what = user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        const uint32_t particle = args->particle_of_slot[slot];
        if (particle != MSPRING_NONE) {
            args->force_x[slot] += what->force_x[particle];
            args->force_y[slot] += what->force_y[particle];
        }
    }
}

static mspring_result add_limits(const map_case *what, mspring_builder *builder) {
    if (!(what->limit_strain > 0) || what->body.spring_count == 0)
        return MSPRING_OK;
    return mspring_builder_add_strain_limits(builder, NULL, 0, what->body.spring_count, (float)what->limit_strain,
                                             (float)what->limit_stiffening, NULL);
}

/// An angle where a spring follows another, with the angle that there is.
static mspring_result add_angles(const map_case *what, mspring_network *network) {
    mspring_angle_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_ANGLE_DEF, &def, sizeof def);
    const mspring_spring_def *springs = what->body.springs;
    def.stiffness = what->angle_stiffness;
    for (uint32_t i = 0; result == MSPRING_OK && i + 1 < what->body.spring_count; i++) {
        const mspring_id three[] = {springs[i].a, springs[i].b, springs[i + 1].b};
        if (springs[i].b == springs[i + 1].a && three[0] != three[2])
            result = mspring_network_add_angles(network, &def, three, 1, 3, NULL);
    }
    return result;
}

static mspring_result add_laws(const map_case *what, mspring_network *network) {
    mspring_result result = MSPRING_OK;
    if (what->area_stiffness > 0) {
        mspring_area_def def;
        result = mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def);
        def.stiffness = what->area_stiffness;
        if (result == MSPRING_OK)
            result = mspring_network_add_cell_areas(network, &def, NULL, NULL);
    }
    return result == MSPRING_OK && what->angle_stiffness > 0 ? add_angles(what, network) : result;
}

static mspring_result set_up(const map_case *what, mspring_network *network) {
    mspring_result result = add_laws(what, network);
    if (result == MSPRING_OK && what->has_floor) {
        const mspring_floor_def floor = map_case_floor(what);
        result = mspring_network_set_floor(network, &floor);
    }
    if (result == MSPRING_OK && what->first_count > 0)
        result = mspring_network_set_contact(network, &what->contact);
    if (result == MSPRING_OK && what->by_hook) {
        mspring_hook_def hook = mspring_hook_def_default();
        hook.fn = push;
        hook.user = (void *)what;
        result = mspring_network_add_hook(network, &hook, NULL);
    }
    return result;
}

mspring_network *map_make_network(const map_case *what, char text[MAP_TEXT]) {
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    if (result == MSPRING_OK)
        result = map_build_body(&what->body, builder);
    if (result == MSPRING_OK)
        result = add_limits(what, builder);
    if (result == MSPRING_OK)
        result = mspring_network_create(builder, &what->network, &network);
    if (result != MSPRING_OK) {
        snprintf(text, MAP_TEXT, "not made: %s", mspring_builder_error(builder));
    } else {
        result = set_up(what, network);
        if (result != MSPRING_OK) {
            snprintf(text, MAP_TEXT, "not set up: %s", mspring_network_error(network));
            mspring_network_destroy(network);
            network = NULL;
        }
    }
    mspring_builder_destroy(builder);
    return network;
}

bool map_choose_step(map_case *what, mspring_network *network) {
    double any = INFINITY;
    if (what->share > 0 && mspring_network_get_stable_dt(network, NULL, &any) != MSPRING_OK)
        return false;
    if (any < INFINITY) {
        const double substep = what->share * any;
        while (what->network.settings.substeps > 1 && what->network.settings.substeps * substep > 0.25)
            what->network.settings.substeps /= 2;
        what->dt = fmin(0.25, what->network.settings.substeps * substep);
        if (mspring_network_set_settings(network, &what->network.settings) != MSPRING_OK)
            return false;
    }
    const double work = (double)what->network.settings.substeps * (what->body.spring_count + 10);
    if (work * what->steps > most_work && what->family < MAP_FALL)
        what->steps = (uint32_t)fmax(8, most_work / work);
    return true;
}

/* ------------------------------------------------------------------------------------------------------ running */

static bool break_springs(const map_case *what, mspring_network *network, map_watch *watch, map_judge *judge) {
    mspring_id broken[MAP_SPRINGS];
    uint32_t count = 0;
    for (mspring_id id = 0; id < what->body.spring_count; id += what->break_every)
        broken[count++] = id;
    const double before = watch->elastic;
    if ((count > 0 && mspring_network_break_springs(network, broken, 0, count) != MSPRING_OK) ||
        !map_watch_springs(watch) || !map_watch_read(watch))
        return false;
    map_judge_broken(judge, before);
    return true;
}

/// A step that is rejected has to be one that may be: not of explicit substeps that are stable in any shape.
static map_verdict judge_rejection(const map_case *what, mspring_result result, const char *reason,
                                   char text[MAP_TEXT]) {
    const bool may_be =
        what->network.settings.solver != MSPRING_SOLVER_EXPLICIT && result == MSPRING_ERROR_UNSTABLE;
    snprintf(text, MAP_TEXT, "%s: %s", mspring_result_string(result), reason);
    return may_be && strlen(reason) > 0 ? MAP_GUARDED : MAP_REJECTED;
}

static map_verdict take_step(const map_case *what, mspring_network *network, map_watch *watch, map_judge *judge,
                             char text[MAP_TEXT]) {
    mspring_result result = MSPRING_OK;
    if (what->has_forces && !what->by_hook)
        result = mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, what->body.particle_count,
                                              what->force_x, what->force_y, 1);
    if (result == MSPRING_OK)
        result = map_hold_move(watch);
    if (result == MSPRING_OK)
        result = mspring_network_step(network, what->dt);
    if (result != MSPRING_OK)
        return judge_rejection(what, result, mspring_network_error(network), text);
    watch->time += what->dt;
    watch->lag = what->network.settings.solver == MSPRING_SOLVER_EXPLICIT ? watch->substep : 0;
    if (!map_watch_read(watch)) {
        snprintf(text, MAP_TEXT, "something is not finite");
        return MAP_NOT_FINITE;
    }
    const map_verdict verdict = map_judge_step(judge, what->network.settings.substeps);
    if (verdict != MAP_HOLDS)
        snprintf(text, MAP_TEXT, "%s", judge->text);
    return verdict;
}

/// @param to_the_end  go on when energy was gained: how much it grows is wanted
static map_verdict take_steps(const map_case *what, mspring_network *network, map_judge *judge, bool to_the_end,
                              char text[MAP_TEXT]) {
    map_watch watch;
    if (!map_watch_begin(&watch, what, network, what->dt / what->network.settings.substeps)) {
        snprintf(text, MAP_TEXT, "cannot be watched: %s", mspring_network_error(network));
        return MAP_REJECTED;
    }
    map_judge_begin(judge, &watch);
    map_verdict verdict = MAP_HOLDS;
    for (uint32_t step = 1; step <= what->steps && verdict == MAP_HOLDS; step++) {
        if (step == what->break_at && !break_springs(what, network, &watch, judge)) {
            snprintf(text, MAP_TEXT, "springs cannot be broken: %s", mspring_network_error(network));
            return MAP_REJECTED;
        }
        verdict = take_step(what, network, &watch, judge, text);
        if (verdict == MAP_GAINED && to_the_end) {
            verdict = MAP_HOLDS;
        } else if (verdict != MAP_HOLDS) {
            char cause[MAP_TEXT];
            memcpy(cause, text, sizeof cause);
            snprintf(text, MAP_TEXT, "step %u of %u: %.200s", step, what->steps, cause);
        }
    }
    judge->watch = NULL;
    return verdict;
}

/* --------------------------------------------------------------------------------------------- violent motion */

/// How much the energy of a case grows at most, as a part of what could move.
static double growth_of(const map_case *what) {
    char text[MAP_TEXT];
    map_judge judge;
    mspring_network *network = map_make_network(what, text);
    judge.growth = 0;
    if (network != NULL)
        take_steps(what, network, &judge, true, text);
    mspring_network_destroy(network);
    return judge.growth;
}

/// What the floor has given in a substep, J: in the energy that the scheme keeps it changes w = v' - part *
/// (v_free - v) alone, where v_free is the velocity after the same substep without a floor, and part what of the
/// kick is of half a substep. Only what single particles gain counts.
static double given_by_floor(const map_watch *watch, double part, const float *from_vx, const float *from_vy,
                             const float *free_vx, const float *free_vy) {
    double given = 0;
    for (uint32_t i = 0; i < watch->count; i++) {
        const double half_x = part * ((double)free_vx[i] - (double)from_vx[i]);
        const double half_y = part * ((double)free_vy[i] - (double)from_vy[i]);
        const double before = hypot((double)free_vx[i] - half_x, (double)free_vy[i] - half_y);
        const double after = hypot((double)watch->vx[i] - half_x, (double)watch->vy[i] - half_y);
        const double rounding = 0x1p-22 * after * hypot((double)watch->vx[i], (double)watch->vy[i]);
        if (!isinf(watch->mass[i]))
            given += watch->mass[i] * fmax(0, 0.5 * (after * after - before * before) - rounding);
    }
    return given;
}

/// Take a step next to a copy without floor.
/// @return what the floor gave, J; NAN if a call failed
static double take_watched_step(const map_case *what, mspring_network *network, map_watch *watch,
                                map_judge *judge) {
    char text[MAP_TEXT];
    float from_vx[MAP_PARTICLES], from_vy[MAP_PARTICLES], free_vx[MAP_PARTICLES], free_vy[MAP_PARTICLES];
    mspring_network *twin = NULL;
    const double part = watch->substep / (watch->lag + watch->substep);
    double given = NAN;
    memcpy(from_vx, watch->vx, sizeof from_vx);
    memcpy(from_vy, watch->vy, sizeof from_vy);
    if (mspring_network_clone(network, NULL, &twin) == MSPRING_OK &&
        mspring_network_set_floor(twin, NULL) == MSPRING_OK && mspring_network_step(twin, what->dt) == MSPRING_OK &&
        mspring_network_get_velocities(twin, NULL, 0, watch->count, free_vx, free_vy, 1) == MSPRING_OK) {
        const map_verdict verdict = take_step(what, network, watch, judge, text);
        if (verdict != MAP_GUARDED && verdict != MAP_NOT_FINITE && verdict != MAP_REJECTED)
            given = given_by_floor(watch, part, from_vx, from_vy, free_vx, free_vy);
    }
    mspring_network_destroy(twin);
    return given;
}

// Whether a case gains energy, taken one substep a step, while the floor gives it none.
static bool gains_by_itself(const map_case *run) {
    char text[MAP_TEXT];
    map_case slow = *run;
    map_watch watch;
    map_judge judge;
    double given = 0;
    slow.dt /= run->network.settings.substeps;
    slow.steps *= run->network.settings.substeps;
    slow.break_at = run->break_at > 0 ? (run->break_at - 1) * run->network.settings.substeps + 1 : 0;
    slow.network.settings.substeps = 1;
    mspring_network *network = map_make_network(&slow, text);
    bool ok = network != NULL && map_watch_begin(&watch, &slow, network, slow.dt);
    if (ok)
        map_judge_begin(&judge, &watch);
    for (uint32_t step = 1; ok && step <= slow.steps; step++) {
        ok = step != slow.break_at || break_springs(&slow, network, &watch, &judge);
        given += ok ? take_watched_step(&slow, network, &watch, &judge) : 0;
        ok = ok && given <= floor_gives * judge.could;
    }
    mspring_network_destroy(network);
    return ok && judge.growth > 1e-2;
}

// Whether a case keeps its energy with substeps of a quarter.
static bool holds_with_shorter(const map_case *run) {
    map_case finer = *run;
    finer.dt /= 4;
    finer.steps *= 4;
    finer.break_at = run->break_at > 0 ? (run->break_at - 1) * 4 + 1 : 0;
    return growth_of(&finer) <= 1e-2;
}

// What explicit substeps keep is a sum for small motion alone. In violent motion near the border it grows without
// any floor as well, by anything: how much differs by a factor of ten from one start to another of the same energy,
// so that no free swing tells how much a case may gain. But the floor must have given nothing of it.
static map_verdict judge_gain(const map_case *run, const map_judge *judge) {
    if (run->network.settings.solver != MSPRING_SOLVER_EXPLICIT || judge->quickest <= calm_way)
        return MAP_GAINED;
    if (run->share <= calm_share)
        return growth_of(run) <= calm_growth || holds_with_shorter(run) ? MAP_VIOLENT : MAP_GAINED;
    // A copy without a floor has no silt either, so what the surface gives cannot be told apart. What colliders and
    // grips give cannot, either.
    const bool is_shared = run->floor.silt_rate > 0 || run->has_wedge || run->grip_count > 0;
    const bool is_own = is_shared ? holds_with_shorter(run) : !run->has_floor || gains_by_itself(run);
    return is_own ? MAP_VIOLENT : MAP_GAINED;
}

map_verdict map_run_case(const map_case *what, char text[MAP_TEXT]) {
    map_case run = *what;
    map_judge judge;
    map_verdict verdict = MAP_REJECTED;
    text[0] = '\0';
    mspring_network *network = map_make_network(&run, text);
    if (network != NULL && !map_choose_step(&run, network)) {
        snprintf(text, MAP_TEXT, "no step: %s", mspring_network_error(network));
    } else if (network != NULL && (run.family == MAP_SUBSTEPS || run.family == MAP_ORDER)) {
        verdict = map_run_trade(&run, network, text);
    } else if (network != NULL && run.family >= MAP_FALL) {
        verdict = map_run_precision(&run, network, text);
    } else if (network != NULL) {
        verdict = take_steps(&run, network, &judge, false, text);
        if (verdict == MAP_GAINED)
            verdict = judge_gain(&run, &judge);
    }
    mspring_network_destroy(network);
    return verdict;
}

void map_print_course(const map_case *what, FILE *out) {
    map_case run = *what;
    map_watch watch;
    map_judge judge;
    char text[MAP_TEXT];
    mspring_network *network = map_make_network(&run, text);
    bool ok = network != NULL && map_choose_step(&run, network) &&
              map_watch_begin(&watch, &run, network, run.dt / run.network.settings.substeps);
    if (ok) {
        map_judge_begin(&judge, &watch);
        fprintf(out, "%u steps of %.6g s, %u substeps\n%6s %12s %12s %12s %12s %12s\n", run.steps, run.dt,
                run.network.settings.substeps, "step", "kinetic", "elastic", "potential", "shadow", "sum");
    }
    for (uint32_t step = 0; ok && step <= run.steps; step++) {
        if (step > 0 && step == run.break_at)
            ok = break_springs(&run, network, &watch, &judge);
        const map_verdict verdict = step > 0 ? take_step(&run, network, &watch, &judge, text) : MAP_HOLDS;
        if (step < 20 || step % (run.steps / 20 + 1) == 0)
            fprintf(out, "%6u %12.6g %12.6g %12.6g %12.6g %12.8g\n", step, watch.kinetic, watch.elastic,
                    watch.potential, watch.shadow, map_watch_energy(&watch));
        ok = ok && verdict != MAP_GUARDED && verdict != MAP_REJECTED;
    }
    mspring_network_destroy(network);
}
