/// @file app.c
/// Frames: actions, steps on two threads, a picture.
///
/// SPDX-License-Identifier: MIT
#include "lab/app.h"
#include "common/clock.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool complain(const char *text) {
    fprintf(stderr, "lab: %s\n", text);
    return false;
}

bool app_free(lab_app *unwanted) {
    bool ok = true;
    helper_stop(unwanted->helper);
    if (unwanted->record)
        ok = fclose(unwanted->record) == 0 || complain("cannot write the recording");
    script_free(&unwanted->script);
    view_free(&unwanted->view);
    model_end(&unwanted->model);
    return ok;
}

bool app_start(lab_app *made, const lab_options *options) {
    scene_error error = {""};
    memset(made, 0, sizeof *made);
    made->options = options;
    if (options->script && !script_read(options->script, &made->script, &error))
        return complain(error.text);
    if (!model_start(&made->model, options->scene, &error)) {
        script_free(&made->script);
        return complain(error.text);
    }
    made->helper = helper_start();
    bool ok = view_make(&made->view, options->width, options->height) || complain("out of memory for the window");
    // What mouse and keys do is kept, even where nobody has asked for it: somebody may, later.
    if (ok && options->record)
        made->record = fopen(options->record, "w+");
    else if (ok && !options->headless)
        made->record = tmpfile();
    if (ok && options->record && !made->record)
        ok = complain("cannot write the recording");
    const lab_action first = action_of_text(ACTION_SCENE, options->scene);
    if (ok && made->record)
        ok = script_record(made->record, 0, &first);
    made->view.shows_costs = !options->no_clock;
    controller_start(&made->controller, app_perform, made);
    if (!ok)
        app_free(made);
    return ok;
}

void app_perform(const lab_action *action, void *user) {
    lab_app *app = user;
    scene_error error = {""};
    const lab_action rounded = action_rounded(action);
    if (app->record && rounded.kind != ACTION_RECORDING)
        script_record(app->record, app->model.frame, &rounded);
    if (!model_do(&app->model, &rounded, &error))
        snprintf(app->model.message, sizeof app->model.message, "%.250s", error.text);
}

static bool play_script(lab_app *app) {
    scene_error error = {""};
    for (; app->script_at < app->script.count; app->script_at++) {
        const script_line *line = &app->script.lines[app->script_at];
        if (line->frame > app->model.frame)
            break;
        if (!model_do(&app->model, &line->action, &error)) {
            fprintf(stderr, "lab: %s:%u: %s\n", app->script.name, line->line, error.text);
            return false;
        }
    }
    return true;
}

bool app_script_done(const lab_app *app) {
    return app->script_at == app->script.count || app->model.ended;
}

/* ------------------------------------------------------------------------------------------------------ frames */

// What a thread does in a frame.
typedef struct side_job {
    lab_app *app;
    int side;
    uint32_t steps;
    double stepped, drawn; // seconds
} side_job;

static void play_side(void *user) {
    side_job *job = user;
    lab_app *app = job->app;
    const double begin = clock_seconds();
    model_play_side(&app->model, job->side, job->steps);
    const double stepped = clock_seconds();
    view_draw_side(&app->view, &app->model, job->side);
    job->stepped = stepped - begin;
    job->drawn = clock_seconds() - stepped;
}

static void note_costs(lab_app *app, double begin, double stepped, double end) {
    lab_costs *costs = &app->costs;
    const double seconds = end - begin, between = begin - app->last_begin;
    const bool first = app->frames == 0;
    // The first frame is the first to touch most of the memory.
    if (!first) {
        costs->frame = costs->frame > 0 ? costs->frame + 0.1 * (seconds - costs->frame) : seconds;
        costs->steps = costs->steps > 0 ? costs->steps + 0.1 * (stepped - costs->steps) : stepped;
    }
    if (!first && between > 0)
        costs->per_second = costs->per_second > 0
                                ? 1 / (1 / costs->per_second + 0.1 * (between - 1 / costs->per_second))
                                : 1 / between;
    app->late_frames += !first && between > 1.0 / 60;
    app->last_begin = begin;
    app->frames++;
    app->total_frame += seconds;
    app->longest_frame = seconds > app->longest_frame ? seconds : app->longest_frame;
    app->slow_frames += seconds > 1.0 / FRAMES_PER_SECOND;
}

bool app_frame(lab_app *app, bool show_pointer) {
    const double begin = clock_seconds();
    if (!play_script(app))
        return false;
    const uint32_t steps = model_begin_frame(&app->model);
    if (!view_begin(&app->view, &app->model))
        return complain("out of memory for the picture");
    side_job jobs[2] = {{app, 0, steps, 0, 0}, {app, 1, steps, 0, 0}};
    if (app->model.side_count == 2)
        helper_run_both(app->helper, play_side, &jobs[0], &jobs[1]);
    else
        play_side(&jobs[0]);
    for (int i = 0; i < app->model.side_count; i++) {
        // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): there are two sides at most
        app->total_stepped[i] += jobs[i].stepped;
        app->total_drawn[i] += jobs[i].drawn;
    }
    model_end_frame(&app->model, steps);
    lab_pointer pointer = {.kind = POINTER_NONE};
    if (show_pointer)
        pointer = controller_pointer(&app->controller, &app->model, &app->view);
    view_end(&app->view, &app->model, &pointer, &app->costs);
    note_costs(app, begin, fmax(jobs[0].stepped, jobs[1].stepped), clock_seconds());
    return app_write_wanted(app);
}

void app_report(const lab_app *app) {
    const lab_model *model = &app->model;
    for (int i = 0; i < model->side_count; i++) {
        const lab_side *side = &model->sides[i];
        char cost[48] = "";
        if (!app->options->no_clock)
            snprintf(cost, sizeof cost, ", %.2f ms a step", 1e3 * side->measured.seconds);
        printf("%-5s %s, %llu steps%s, bending %.6g m, %u broken\n", i == 0 ? "left" : "right",
               action_choice_name(ACTION_SOLVER, 1, side->solver.solver), (unsigned long long)side->steps, cost,
               side->measured.bending, side->broken_count);
    }
    if (!app->options->no_clock && app->frames > 0)
        printf("frames %llu, %.2f ms on average, longest %.2f ms, over %.1f ms: %u\n",
               (unsigned long long)app->frames, 1e3 * app->total_frame / (double)app->frames,
               1e3 * app->longest_frame, 1e3 / FRAMES_PER_SECOND, app->slow_frames);
    if (!app->options->no_clock && !app->options->headless && app->frames > 1)
        printf(
            "shown in %.2f ms on average, %.1f a second at last; %u came more than 16.7 ms after the one before\n",
            1e3 * app->total_shown / (double)app->frames, app->costs.per_second, app->late_frames);
    for (int i = 0; i < model->side_count && !app->options->no_clock && app->frames > 0; i++)
        printf("%-5s of a frame: %.2f ms for steps and measurements, %.2f ms for its picture\n",
               i == 0 ? "left" : "right", 1e3 * app->total_stepped[i] / (double)app->frames,
               1e3 * app->total_drawn[i] / (double)app->frames);
    printf("state after %llu frames: %016llx\n", (unsigned long long)model->frame,
           (unsigned long long)model_hash(model));
}
