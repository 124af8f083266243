/// @file side.c
/// Settings, steps and measurements of one network.
///
/// SPDX-License-Identifier: MIT
#include "lab/side.h"
#include "common/clock.h"
#include "scenes/internal.h"

#include <massspring/massspring.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// How many broken springs are told of between two frames; if there are more, all are looked at.
enum { EVENTS = 1 << 15 };

// Scenes that say nothing of it break at this strain.
static const float usual_break_strain = 0.2f;

/* --------------------------------------------------------------------------------------------------- complaints */

// Returns whether all went well; if not, keeps what the library says about it.
static bool accepted(lab_side *side, mspring_result result) {
    if (result == MSPRING_OK)
        return true;
    const char *detail = mspring_network_error(side->network);
    snprintf(side->complaint, sizeof side->complaint, "%s", *detail ? detail : mspring_result_string(result));
    return false;
}

/* --------------------------------------------------------------------------------------------------- settings */

static void choose(mspring_settings *settings, const lab_solver *solver) {
    settings->solver = solver->solver;
    settings->integrator = solver->integrator;
    settings->substeps = solver->substeps ? solver->substeps : MSPRING_SUBSTEPS_AUTO;
    settings->iterations = solver->iterations;
    settings->residual = 0; // exactly these: the slider shows what they do
}

bool side_set_solver(lab_side *side, const lab_solver *solver) {
    mspring_settings settings = mspring_settings_default();
    if (!accepted(side, mspring_network_get_settings(side->network, &settings)))
        return false;
    choose(&settings, solver);
    if (!accepted(side, mspring_network_set_settings(side->network, &settings)))
        return false;
    side->solver = *solver;
    side->substeps = solver->substeps ? solver->substeps : 1;
    side->complaint[0] = 0;
    side->cure = 0;
    side_start_measuring_time(side);
    return true;
}

uint32_t side_suggest_substeps(lab_side *side, double dt) {
    uint32_t substeps = 0;
    const mspring_result result = mspring_network_suggest_substeps(side->network, dt, 0.7, &substeps);
    return result == MSPRING_OK ? substeps : 0;
}

void side_start_measuring_time(lab_side *side) {
    side->measured.seconds = 0;
    side->timed_steps = 0;
}

static float *scaled(const float *values, uint32_t count, double factor) {
    float *made = malloc((count ? count : 1) * sizeof *made);
    for (uint32_t i = 0; made && i < count; i++)
        made[i] = (float)(values[i] * factor);
    return made;
}

static mspring_result set_masses(lab_side *side, double factor) {
    float *values = scaled(side->stage->mass, side->stage->particle_count, factor);
    if (!values)
        return MSPRING_ERROR_MEMORY;
    const mspring_result result =
        mspring_network_set(side->network, MSPRING_MASS, NULL, 0, side->stage->particle_count, values, 1);
    free(values);
    return result;
}

static mspring_result set_stiffnesses(lab_side *side, double factor) {
    float *values = scaled(side->stage->stiffness, side->stage->spring_count, factor);
    const mspring_result result = values ? mspring_network_set(side->network, MSPRING_STIFFNESS, NULL, 0,
                                                               side->stage->spring_count, values, 1)
                                         : MSPRING_ERROR_MEMORY;
    free(values);
    return result;
}

static mspring_result set_dampings(lab_side *side, double factor) {
    float *values = scaled(side->stage->damping, side->stage->spring_count, factor);
    const mspring_result result =
        values ? mspring_network_set(side->network, MSPRING_DAMPING, NULL, 0, side->stage->spring_count, values, 1)
               : MSPRING_ERROR_MEMORY;
    free(values);
    return result;
}

static mspring_result set_breaking(lab_side *side, bool breaking) {
    const uint32_t count = side->stage->spring_count;
    const float *given = side->stage->made.break_strain;
    float *values = malloc((count ? count : 1) * sizeof *values);
    if (!values)
        return MSPRING_ERROR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        const float strain = given ? given[i] : usual_break_strain;
        values[i] = breaking && strain > 0 ? strain : INFINITY;
    }
    const mspring_result result =
        mspring_network_set(side->network, MSPRING_BREAK_STRAIN, NULL, 0, count, values, 1);
    free(values);
    return result;
}

static mspring_result set_floor(lab_side *side, bool has_floor) {
    const double planes[2][4] = {{0, side->stage->floor_y, 0, 1}, {side->stage->wall_x, 0, -1, 0}};
    mspring_floor_def def = mspring_floor_def_default();
    def.plane_count = side->stage->has_wall ? 2 : 1;
    def.planes = planes[0];
    def.friction = 0.6f;
    return mspring_network_set_floor(side->network, has_floor ? &def : NULL);
}

static mspring_result set_contact(lab_side *side, bool collides) {
    mspring_contact_def def = mspring_contact_def_default();
    def.friction = 0.4f;
    return mspring_network_set_contact(side->network, collides ? &def : NULL);
}

bool side_set_obstacles(lab_side *side, const lab_settings *settings, const lab_settings *before) {
    mspring_result result = MSPRING_OK;
    if (settings->has_floor != before->has_floor)
        result = set_floor(side, settings->has_floor);
    if (result == MSPRING_OK && settings->collides != before->collides)
        result = set_contact(side, settings->collides);
    return accepted(side, result);
}

static mspring_result set_surroundings(lab_side *side, const lab_settings *settings) {
    mspring_settings now = mspring_settings_default();
    const mspring_result result = mspring_network_get_settings(side->network, &now);
    now.gravity_y = (float)-settings->gravity;
    now.global_damping = (float)settings->drag;
    return result == MSPRING_OK ? mspring_network_set_settings(side->network, &now) : result;
}

bool side_set_settings(lab_side *side, const lab_settings *settings, const lab_settings *before) {
    mspring_result result = set_surroundings(side, settings);
    side->cure = 0;
    if (result == MSPRING_OK && settings->mass != before->mass)
        result = set_masses(side, settings->mass);
    if (side->stage->spring_count > 0) {
        if (result == MSPRING_OK && settings->stiffness != before->stiffness)
            result = set_stiffnesses(side, settings->stiffness);
        if (result == MSPRING_OK && settings->damping != before->damping)
            result = set_dampings(side, settings->damping);
        if (result == MSPRING_OK && settings->breaking != before->breaking)
            result = set_breaking(side, settings->breaking);
        if (result == MSPRING_OK && settings->yielding != before->yielding &&
            !side_set_yielding(side, settings->yielding))
            return false;
    }
    return accepted(side, result) && side_set_obstacles(side, settings, before);
}

/* --------------------------------------------------------------------------------------------- making, unmaking */

bool side_make(lab_side *made, const lab_stage *stage, const lab_settings *settings, const lab_solver *solver,
               scene_error *error) {
    memset(made, 0, sizeof *made);
    made->stage = stage;
    const size_t springs = stage->spring_count ? stage->spring_count : 1;
    made->strain = calloc(springs, sizeof *made->strain);
    made->broken = calloc(springs, sizeof *made->broken);
    made->plastic = calloc(springs, sizeof *made->plastic);
    made->held = malloc(stage->particle_count * sizeof *made->held);
    made->held_x = malloc(stage->particle_count * sizeof *made->held_x);
    made->held_y = malloc(stage->particle_count * sizeof *made->held_y);
    if (!made->strain || !made->broken || !made->plastic || !made->held || !made->held_x || !made->held_y) {
        side_free(made);
        return scene_fail_memory(error, "cannot make the network");
    }
    mspring_network_def def = mspring_network_def_default();
    def.flags = MSPRING_NETWORK_RESERVE_DAMPING;
    def.settings.gravity_y = (float)-settings->gravity;
    def.settings.guard = MSPRING_GUARD_GROWTH; // a side that cannot go on says why
    const mspring_result result = mspring_network_create(stage->made.builder, &def, &made->network);
    if (result != MSPRING_OK) {
        side_free(made);
        return scene_fail_builder(error, stage->made.name, stage->made.builder, result);
    }
    made->view = mspring_view_default();
    const float *velocity = stage->made.velocity;
    const lab_settings fresh = {.gravity = settings->gravity,
                                .mass = 1,
                                .stiffness = 1,
                                .damping = stage->has_damping ? 1 : 0,
                                .yielding = stage->yields};
    if ((!velocity || accepted(made, mspring_network_set_velocities(made->network, NULL, 0, stage->particle_count,
                                                                    velocity, velocity + 1, 2))) &&
        accepted(made, mspring_network_get_view(made->network, &made->view)) &&
        accepted(made, mspring_network_reserve_events(made->network, EVENTS)) && side_set_solver(made, solver) &&
        side_set_settings(made, settings, &fresh))
        return true;
    scene_fail(error, "%s: %s", stage->made.name, made->complaint);
    side_free(made);
    return false;
}

void side_free(lab_side *unwanted) {
    mspring_network_destroy(unwanted->network);
    free(unwanted->strain);
    free(unwanted->broken);
    free(unwanted->plastic);
    free(unwanted->held);
    free(unwanted->held_x);
    free(unwanted->held_y);
    memset(unwanted, 0, sizeof *unwanted);
}

/* ------------------------------------------------------------------------------------------------------- steps */

// A soft spring and a damper between each held particle and where it is wanted. Given once a step, such a force is
// stable as long as rate * dt is well below 1.
static void apply_held(lab_side *side, const lab_settings *settings) {
    const double rate = fmin(settings->grip, 0.5 / settings->dt);
    for (uint32_t i = 0; i < side->held_count; i++) {
        const mspring_id particle = side->held[i];
        const uint32_t slot = side->view.slot_of_particle[particle];
        const double mass = side->stage->mass[particle] * settings->mass;
        double x, y;
        side_position(side, particle, &x, &y);
        const double away_x = side->held_x[i] + side->pull_x - x, away_y = side->held_y[i] + side->pull_y - y;
        const double force_x = mass * rate * (rate * away_x - 1.4 * side->view.vx[slot]);
        const double force_y = mass * rate * (rate * away_y - 1.4 * side->view.vy[slot]);
        if (!accepted(side, mspring_network_apply_force(side->network, particle, (float)force_x, (float)force_y)))
            return;
    }
}

void side_step(lab_side *side, const lab_settings *settings) {
    // Forces given before a step that was refused are still there.
    if (!side->complaint[0])
        apply_held(side, settings);
    const double begin = clock_seconds();
    const mspring_result result = mspring_network_step(side->network, settings->dt);
    const double seconds = clock_seconds() - begin;
    if (!accepted(side, result)) {
        if (side->solver.solver == MSPRING_SOLVER_EXPLICIT && side->cure == 0)
            side->cure = side_suggest_substeps(side, settings->dt);
        return;
    }
    side->complaint[0] = 0;
    side->cure = 0;
    mspring_step_info info = mspring_step_info_default();
    if (mspring_network_get_step_info(side->network, &info) == MSPRING_OK)
        side->substeps = info.substeps;
    side->last_dt = settings->dt;
    side->steps++;
    // The origin may have moved along.
    (void)!mspring_network_get_view(side->network, &side->view);
    // The first step is not like the others: it is the first to touch the solver's memory.
    double *mean = &side->measured.seconds;
    if (side->timed_steps++ > 0)
        *mean = *mean > 0 ? *mean + 0.06 * (seconds - *mean) : seconds;
}

/* ----------------------------------------------------------------------------------------------- measurements */

void side_find_broken(lab_side *side) {
    enum { AT_ONCE = 256 };
    uint32_t flags[AT_ONCE];
    side->broken_count = 0;
    for (uint32_t i = 0; i < side->stage->spring_count; i++) {
        const uint32_t left = side->stage->spring_count - i;
        if (i % AT_ONCE == 0)
            (void)!mspring_network_get_integers(side->network, MSPRING_SPRING_FLAGS, NULL, i,
                                                left < AT_ONCE ? left : AT_ONCE, flags, 1);
        side->broken[i] = (flags[i % AT_ONCE] & MSPRING_SPRING_BROKEN) != 0;
        side->broken_count += side->broken[i];
    }
}

static void read_broken(lab_side *side) {
    enum { AT_ONCE = 256 };
    mspring_event events[AT_ONCE];
    uint32_t count = AT_ONCE;
    uint64_t lost = 0;
    while (count == AT_ONCE &&
           mspring_network_read_events(side->network, events, AT_ONCE, &count, &lost) == MSPRING_OK)
        for (uint32_t i = 0; i < count; i++)
            if (events[i].kind == MSPRING_EVENT_BROKEN && !side->broken[events[i].id]) {
                side->broken[events[i].id] = true;
                side->broken_count++;
            }
    if (lost > 0) {
        side_find_broken(side);
        (void)!mspring_network_reserve_events(side->network, EVENTS); // counts the lost ones from 0 again
    }
}

double side_spring_stiffness(const lab_side *side, const lab_settings *settings, uint32_t spring) {
    const lab_stage *stage = side->stage;
    const double nominal = stage->stiffness[spring] * settings->stiffness;
    if (!stage->relative)
        return nominal;
    const double a = stage->mass[stage->a[spring]] * settings->mass;
    const double b = stage->mass[stage->b[spring]] * settings->mass;
    const double substep = side->last_dt / side->substeps;
    return substep > 0 ? nominal * a * b / ((a + b) * substep * substep) : 0;
}

static void measure_springs(lab_side *side, const lab_settings *settings) {
    const lab_stage *stage = side->stage;
    double elastic = 0, squares = 0;
    float most = 0;
    if (mspring_network_get(side->network, MSPRING_STRAIN, NULL, 0, stage->spring_count, side->strain, 1) !=
        MSPRING_OK)
        return;
    for (uint32_t i = 0; i < stage->spring_count; i++) {
        const float strain = side->strain[i];
        const double longer = (double)strain * stage->rest[i] * (1 + (double)side->plastic[i]);
        const double stiffness = stage->relative ? side_spring_stiffness(side, settings, i) : stage->stiffness[i];
        elastic += stiffness * longer * longer;
        squares += (double)strain * strain;
        most = fabsf(strain) > most ? fabsf(strain) : most;
    }
    side->measured.elastic = 0.5 * elastic * (stage->relative ? 1 : settings->stiffness);
    side->measured.rms_strain = stage->spring_count ? sqrt(squares / stage->spring_count) : 0;
    side->measured.max_strain = most;
}

static void measure_particles(lab_side *side, const lab_settings *settings) {
    const mspring_view *view = &side->view;
    float min_x = INFINITY, min_y = INFINITY, max_x = -INFINITY, max_y = -INFINITY;
    double kinetic = 0;
    for (uint32_t i = 0; i < side->stage->particle_count; i++) {
        const uint32_t slot = view->slot_of_particle[i];
        const double vx = view->vx[slot], vy = view->vy[slot];
        if (view->inverse_mass[slot] > 0)
            kinetic += side->stage->mass[i] * (vx * vx + vy * vy);
        min_x = view->x[slot] < min_x ? view->x[slot] : min_x;
        max_x = view->x[slot] > max_x ? view->x[slot] : max_x;
        min_y = view->y[slot] < min_y ? view->y[slot] : min_y;
        max_y = view->y[slot] > max_y ? view->y[slot] : max_y;
    }
    side->measured.kinetic = 0.5 * kinetic * settings->mass;
    side->measured.min_x = view->origin_x + min_x;
    side->measured.max_x = view->origin_x + max_x;
    side->measured.min_y = view->origin_y + min_y;
    side->measured.max_y = view->origin_y + max_y;
}

void side_measure(lab_side *side, const lab_settings *settings, mspring_id probe) {
    double x, y;
    read_broken(side);
    if (settings->yielding || side->bent_count > 0)
        side_measure_bent(side);
    measure_springs(side, settings);
    measure_particles(side, settings);
    side_position(side, probe, &x, &y);
    side->measured.bending = side->stage->y[probe] - y;
}

void side_position(const lab_side *side, mspring_id particle, double *x, double *y) {
    const uint32_t slot = side->view.slot_of_particle[particle];
    *x = side->view.origin_x + side->view.x[slot];
    *y = side->view.origin_y + side->view.y[slot];
}

mspring_id side_nearest(const lab_side *side, double x, double y) {
    mspring_id nearest;
    return mspring_network_nearest_particle(side->network, x, y, INFINITY, &nearest, NULL) == MSPRING_OK ? nearest
                                                                                                         : 0;
}

bool side_nearest_spring(const lab_side *side, double x, double y, double radius, uint32_t *spring) {
    const lab_stage *stage = side->stage;
    double least = radius;
    bool found = false;
    for (uint32_t i = 0; i < stage->spring_count; i++) {
        double ax, ay, bx, by;
        side_position(side, stage->a[i], &ax, &ay);
        side_position(side, stage->b[i], &bx, &by);
        const double dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
        const double along = square > 0 ? fmin(fmax(((x - ax) * dx + (y - ay) * dy) / square, 0), 1) : 0;
        const double distance = hypot(ax + along * dx - x, ay + along * dy - y);
        if (!(distance < least))
            continue;
        least = distance;
        *spring = i;
        found = true;
    }
    return found;
}

bool side_is_pinned(const lab_side *side, mspring_id particle) {
    return side->view.inverse_mass[side->view.slot_of_particle[particle]] == 0;
}
