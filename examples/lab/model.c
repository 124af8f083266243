/// @file model.c
/// Actions on the model, and its frames.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include "lab/model.h"
#include "scenes/internal.h"

#include <massspring/massspring.h>
#include <stdio.h>
#include <string.h>

// Networks up to this size come to rest while somebody waits.
enum { SETTLE_MOST = 20000 };

static lab_moment moment_of(const lab_model *model) {
    return (lab_moment){.settings = model->settings,
                        .solvers = {model->solvers[0], model->solvers[1]},
                        .time = model->time,
                        .probe = model->probe,
                        .side_count = model->side_count};
}

// To be called before an edit. Edits of one kind that follow each other closely, as from a slider, are one.
static void remember(lab_model *model, action_kind kind, bool joins) {
    const bool same = joins && model->undo.count > 0 && model->last_undo_kind == kind &&
                      model->frame - model->last_undo_frame < FRAMES_PER_SECOND;
    const lab_moment now = moment_of(model);
    model->last_undo_kind = kind;
    model->last_undo_frame = model->frame;
    if (!same && !undo_push(&model->undo, model->sides, &now))
        snprintf(model->message, sizeof model->message, "no memory to undo this");
}

/* ------------------------------------------------------------------------------------------------------ scenes */

static void free_sides(lab_side sides[2], int count) {
    for (int i = 0; i < count; i++)
        side_free(&sides[i]);
}

static bool make_sides(lab_side sides[2], int count, const lab_stage *stage, const lab_settings *settings,
                       const lab_solver solvers[2], scene_error *error) {
    for (int i = 0; i < count; i++)
        if (!side_make(&sides[i], stage, settings, &solvers[i], error)) {
            free_sides(sides, i);
            return false;
        }
    return true;
}

// What a new scene begins with.
static lab_settings settings_for(const lab_stage *stage) {
    return (lab_settings){.gravity = stage->gravity,
                          .mass = 1,
                          .stiffness = 1,
                          .damping = stage->has_damping ? 1 : 0,
                          .drag = 0,
                          .dt = 1.0 / FRAMES_PER_SECOND,
                          .grip = 30,
                          .breaking = stage->collides && stage->made.break_strain,
                          .has_floor = !stage->has_pins && stage->gravity > 0,
                          .collides = stage->collides,
                          .yielding = stage->yields};
}

// What is there to be bent shows its dents, until another scene comes.
static colour_choice colour_for(const lab_model *model, const lab_stage *stage) {
    if (stage->is_ready && stage->yields)
        return COLOUR_BENT;
    return model->look.colour == COLOUR_BENT ? COLOUR_STRAIN : model->look.colour;
}

static void begin_anew(lab_model *model) {
    undo_clear(&model->undo);
    model->series.count = 0;
    model->holding = false;
    model->has_spring = false;
    for (int i = 0; i < model->side_count; i++)
        side_measure(&model->sides[i], &model->settings, model->probe);
}

// Files may be stiffer than the substeps bear that did for the scene before.
static void make_stable(lab_model *model) {
    for (int i = 0; i < model->side_count; i++) {
        lab_solver solver = model->solvers[i];
        const uint32_t needed = side_suggest_substeps(&model->sides[i], model->settings.dt);
        if (solver.solver != MSPRING_SOLVER_EXPLICIT || !solver.substeps || needed <= solver.substeps ||
            needed > 1000)
            continue;
        solver.substeps = needed;
        if (side_set_solver(&model->sides[i], &solver))
            model->solvers[i] = solver;
    }
}

// While bodies touch, explicit substeps cost least. More of them show what they change.
static void choose_solvers(const lab_model *model, const lab_stage *stage, lab_solver chosen[2]) {
    for (int i = 0; i < 2; i++) {
        chosen[i] = model->solvers[i];
        if (stage->substeps > 0 && chosen[i].solver == MSPRING_SOLVER_EXPLICIT)
            chosen[i].substeps = stage->substeps;
        if ((stage->collides || stage->has_wall) && chosen[i].solver != MSPRING_SOLVER_EXPLICIT)
            chosen[i].solver = MSPRING_SOLVER_EXPLICIT, chosen[i].substeps = 60;
    }
}

// Opens a scene on some sides, or leaves all as it is. keeps: settings, time and the state of the old networks.
static bool open_scene(lab_model *model, const char *name, bool relative, int side_count, bool keeps,
                       scene_error *error) {
    lab_stage stage;
    lab_side sides[2] = {{0}};
    if (!stage_open(&stage, name, relative, error))
        return false;
    const lab_settings settings = keeps ? model->settings : settings_for(&stage);
    lab_solver solvers[2];
    choose_solvers(model, &stage, solvers);
    // The sides keep the stage's address, which is to be the model's.
    lab_stage before = model->stage;
    model->stage = stage;
    if (!make_sides(sides, side_count, &model->stage, &settings, solvers, error)) {
        model->stage = before;
        stage_free(&stage);
        return false;
    }
    for (int i = 0; keeps && i < side_count; i++) {
        const lab_side *from = &model->sides[i < model->side_count ? i : 0];
        if (!side_copy_state(&sides[i], from))
            snprintf(model->message, sizeof model->message, "%s", sides[i].complaint);
    }
    free_sides(model->sides, model->side_count);
    if (before.particle_count > 0)
        stage_free(&before);
    memcpy(model->sides, sides, sizeof sides);
    memcpy(model->solvers, solvers, sizeof solvers);
    if (name != model->scene_name)
        snprintf(model->scene_name, sizeof model->scene_name, "%s", name);
    model->side_count = side_count;
    model->settings = settings;
    if (!keeps) {
        model->time = 0;
        model->probe = model->stage.probe;
        model->look.metres = 0;
        model->look.scenes = false;
        model->look.colour = colour_for(model, &stage);
    }
    if (!keeps && !stage.is_ready)
        make_stable(model);
    begin_anew(model);
    return true;
}

bool model_start(lab_model *made, const char *scene_name, scene_error *error) {
    memset(made, 0, sizeof *made);
    made->solvers[0] = (lab_solver){MSPRING_SOLVER_EXPLICIT, MSPRING_INTEGRATOR_EULER, 30, 15};
    made->solvers[1] = (lab_solver){MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 1, 15};
    made->look = (lab_look){.plots = true, .panel = true};
    made->speed = 1;
    made->playing = true;
    return open_scene(made, scene_name, false, 2, false, error);
}

void model_end(lab_model *unwanted) {
    undo_clear(&unwanted->undo);
    free_sides(unwanted->sides, unwanted->side_count);
    stage_free(&unwanted->stage);
}

/* ---------------------------------------------------------------------------------------------------- settings */

// Tries settings on all sides; where one refuses, all go back.
static bool set_settings(lab_model *model, const lab_settings *settings, scene_error *error) {
    for (int i = 0; i < model->side_count; i++) {
        if (side_set_settings(&model->sides[i], settings, &model->settings))
            continue;
        scene_fail(error, "%s", model->sides[i].complaint);
        for (int back = 0; back <= i; back++)
            (void)side_set_settings(&model->sides[back], &model->settings, settings);
        return false;
    }
    model->settings = *settings;
    return true;
}

static bool change_setting(lab_model *model, const lab_action *action, scene_error *error) {
    lab_settings settings = model->settings;
    double *const places[ACTION_KINDS] = {
        [ACTION_GRAVITY] = &settings.gravity,     [ACTION_MASS] = &settings.mass,
        [ACTION_STIFFNESS] = &settings.stiffness, [ACTION_DAMPING] = &settings.damping,
        [ACTION_DRAG] = &settings.drag,           [ACTION_DT] = &settings.dt,
        [ACTION_GRIP] = &settings.grip,
    };
    if (places[action->kind])
        *places[action->kind] = action->values[0];
    else if (action->kind == ACTION_BREAKING)
        settings.breaking = action->values[0] != 0;
    else if (action->kind == ACTION_COLLIDE)
        settings.collides = action->values[0] != 0;
    else if (action->kind == ACTION_YIELDING)
        settings.yielding = action->values[0] != 0;
    else
        settings.has_floor = action->values[0] != 0;
    remember(model, action->kind, true);
    return set_settings(model, &settings, error);
}

static bool change_solver(lab_model *model, const lab_action *action, scene_error *error) {
    remember(model, action->kind, true);
    for (int i = 0; i < 2; i++) {
        if (!((int)action->values[0] & 1 << i))
            continue;
        lab_solver solver = model->solvers[i];
        const uint32_t value = (uint32_t)action->values[1];
        switch (action->kind) {
        case ACTION_SOLVER:
            solver.solver = (mspring_solver)value;
            // What is usual, so that a switch shows what the solvers are for.
            if (solver.solver != model->solvers[i].solver)
                solver.substeps = solver.solver == MSPRING_SOLVER_EXPLICIT ? 30 : 1;
            break;
        case ACTION_INTEGRATOR:
            solver.integrator = (mspring_integrator)value;
            break;
        case ACTION_SUBSTEPS:
            solver.substeps = value;
            break;
        default:
            solver.iterations = value;
            break;
        }
        if (i < model->side_count && !side_set_solver(&model->sides[i], &solver))
            return scene_fail(error, "%s", model->sides[i].complaint);
        model->solvers[i] = solver;
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------- edits */

static bool edit(lab_model *model, const lab_action *action, scene_error *error) {
    const double *at = action->values;
    remember(model, action->kind, false);
    model->holding = false;
    for (int i = 0; i < model->side_count; i++) {
        lab_side *side = &model->sides[i];
        side_drop(side);
        bool ok = true;
        switch (action->kind) {
        case ACTION_GRAB:
            side_grab(side, at[0], at[1], at[2]);
            break;
        case ACTION_PIN:
        case ACTION_UNPIN:
            ok = side_pin(side, at[0], at[1], at[2], action->kind == ACTION_PIN);
            break;
        case ACTION_CUT:
            ok = side_cut(side, at[0], at[1], at[2], at[3]);
            break;
        default:
            ok = side_blast(side, at[0], at[1], at[2], at[3]);
            break;
        }
        if (!ok)
            return scene_fail(error, "%s", side->complaint);
        side->complaint[0] = 0;
    }
    if (action->kind == ACTION_GRAB) {
        model->holding = true;
        model->grab_x = model->hold_x = at[0];
        model->grab_y = model->hold_y = at[1];
    }
    return true;
}

static bool pull(lab_model *model, double x, double y) {
    model->hold_x = x;
    model->hold_y = y;
    for (int i = 0; model->holding && i < model->side_count; i++)
        side_pull(&model->sides[i], x - model->grab_x, y - model->grab_y);
    return true;
}

static bool drop(lab_model *model) {
    model->holding = false;
    for (int i = 0; i < model->side_count; i++)
        side_drop(&model->sides[i]);
    return true;
}

static bool settle(lab_model *model, scene_error *error) {
    if (model->stage.particle_count > SETTLE_MOST)
        return scene_fail(error, "%u particles are too many to wait for: the most is %d",
                          model->stage.particle_count, SETTLE_MOST);
    remember(model, ACTION_SETTLE, false);
    for (int i = 0; i < model->side_count; i++) {
        lab_side *side = &model->sides[i];
        const mspring_result result = mspring_network_settle(side->network, NULL, NULL);
        if (result != MSPRING_OK)
            return scene_fail(error, "%s", mspring_network_error(side->network));
        (void)!mspring_network_get_view(side->network, &side->view);
        side->complaint[0] = 0;
    }
    return true;
}

static bool undo(lab_model *model) {
    lab_moment state;
    drop(model);
    if (model->undo.count == 0) {
        snprintf(model->message, sizeof model->message, "nothing to undo");
        return true;
    }
    if (!undo_pop(&model->undo, model->sides, &model->settings, &state))
        snprintf(model->message, sizeof model->message, "undo failed");
    model->settings = state.settings;
    memcpy(model->solvers, state.solvers, sizeof model->solvers);
    model->time = state.time;
    model->probe = state.probe;
    model->last_undo_kind = ACTION_KINDS;
    return true;
}

/* ----------------------------------------------------------------------------------------------------- actions */

static void look(lab_model *model, const lab_action *action) {
    lab_look *look = &model->look;
    const double *values = action->values;
    switch (action->kind) {
    case ACTION_COLOUR:
        look->colour = (colour_choice)values[0];
        break;
    case ACTION_LAYOUT:
        look->layout = (layout_choice)values[0];
        break;
    case ACTION_TOOL:
        look->tool = (tool_choice)values[0];
        break;
    case ACTION_PAGE:
        look->page = (int)values[0] - 1;
        break;
    case ACTION_PLOTS:
        look->plots = values[0] != 0;
        break;
    case ACTION_PANEL:
        look->panel = values[0] != 0;
        break;
    case ACTION_SCENES:
        look->scenes = values[0] != 0;
        break;
    case ACTION_HELP:
        look->help = values[0] != 0;
        break;
    case ACTION_CAMERA:
        look->x = values[0];
        look->y = values[1];
        look->metres = values[2];
        break;
    case ACTION_FIT:
        look->metres = 0;
        break;
    default:
        snprintf(model->wanted[action->kind - ACTION_SCREENSHOT], ACTION_TEXT, "%s", action->text);
        break;
    }
}

bool model_do(lab_model *model, const lab_action *action, scene_error *error) {
    const double *values = action->values;
    model->message[0] = 0;
    switch (action->kind) {
    case ACTION_SCENE:
        return open_scene(model, action->text, model->stage.relative, model->side_count, false, error);
    case ACTION_SIDES:
        return open_scene(model, model->scene_name, model->stage.relative, (int)values[0], true, error);
    case ACTION_RELATIVE:
        return open_scene(model, model->scene_name, values[0] != 0, model->side_count, true, error);
    case ACTION_RESET:
        return open_scene(model, model->scene_name, model->stage.relative, model->side_count, false, error);
    case ACTION_SOLVER:
    case ACTION_INTEGRATOR:
    case ACTION_SUBSTEPS:
    case ACTION_ITERATIONS:
        return change_solver(model, action, error);
    case ACTION_GRAVITY:
    case ACTION_MASS:
    case ACTION_STIFFNESS:
    case ACTION_DAMPING:
    case ACTION_DRAG:
    case ACTION_DT:
    case ACTION_GRIP:
    case ACTION_BREAKING:
    case ACTION_FLOOR:
    case ACTION_COLLIDE:
    case ACTION_YIELDING:
        return change_setting(model, action, error);
    case ACTION_GRAB:
    case ACTION_PIN:
    case ACTION_UNPIN:
    case ACTION_CUT:
    case ACTION_BLAST:
        return edit(model, action, error);
    case ACTION_PULL:
        return pull(model, values[0], values[1]);
    case ACTION_DROP:
        return drop(model);
    case ACTION_PROBE:
        model->probe = side_nearest(&model->sides[0], values[0], values[1]);
        model->series.count = 0;
        return true;
    case ACTION_SPRING: {
        const int side = (int)values[0] == SIDE_RIGHT && model->side_count == 2;
        model->has_spring =
            side_nearest_spring(&model->sides[side], values[1], values[2], values[3], &model->spring);
        return true;
    }
    case ACTION_SETTLE:
        return settle(model, error);
    case ACTION_PLAY:
    case ACTION_PAUSE:
        model->playing = action->kind == ACTION_PLAY;
        return true;
    case ACTION_STEP:
        model->playing = false;
        model->steps_asked = (uint32_t)values[0];
        return true;
    case ACTION_SPEED:
        model->speed = (uint32_t)values[0];
        return true;
    case ACTION_UNDO:
        return undo(model);
    case ACTION_END:
        model->ended = true;
        return true;
    default:
        look(model, action);
        return true;
    }
}

/* ------------------------------------------------------------------------------------------------------ frames */

uint32_t model_begin_frame(lab_model *model) {
    if (model->playing)
        return model->speed;
    const uint32_t steps = model->steps_asked < model->speed ? model->steps_asked : model->speed;
    model->steps_asked -= steps;
    return steps;
}

void model_play_side(lab_model *model, int side, uint32_t steps) {
    for (uint32_t i = 0; i < steps; i++)
        side_step(&model->sides[side], &model->settings);
    side_measure(&model->sides[side], &model->settings, model->probe);
}

static void note(lab_model *model) {
    lab_series *series = &model->series;
    const bool full = series->count == SERIES_LENGTH;
    if (full)
        memmove(series->times, series->times + 1, (SERIES_LENGTH - 1) * sizeof *series->times);
    series->times[full ? SERIES_LENGTH - 1 : series->count] = model->time;
    for (int i = 0; i < model->side_count; i++) {
        const lab_measures *now = &model->sides[i].measured;
        const double values[PROBE_KINDS] = {now->bending, now->kinetic, now->elastic, now->max_strain,
                                            1e3 * now->seconds};
        for (int kind = 0; kind < PROBE_KINDS; kind++) {
            float *line = series->values[kind][i];
            if (full)
                memmove(line, line + 1, (SERIES_LENGTH - 1) * sizeof *line);
            line[full ? SERIES_LENGTH - 1 : series->count] = (float)values[kind];
        }
    }
    series->count += !full;
}

void model_end_frame(lab_model *model, uint32_t steps) {
    model->time += steps * model->settings.dt;
    model->frame++;
    if (steps > 0 && model->frame % SERIES_FRAMES == 0)
        note(model);
}

uint64_t model_hash(const lab_model *model) {
    uint64_t all = 0;
    for (int i = 0; i < model->side_count; i++) {
        uint64_t hash = 0;
        (void)!mspring_network_get_state_hash(model->sides[i].network, &hash);
        all = (all ^ hash) * 0x9e3779b97f4a7c15u;
        all ^= all >> 32;
    }
    return all;
}
