/// @file app.h
/// Model, view and controller at work: what the window and the headless lab share.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_APP_H
#define LAB_APP_H

#include "lab/controller.h"
#include "lab/options.h"
#include "lab/parallel.h"
#include "lab/script.h"

typedef struct lab_app {
    const lab_options *options;
    lab_model model;
    lab_view view;
    lab_controller controller;
    lab_helper *helper;
    lab_script script; ///< may be empty
    size_t script_at;  ///< its next line
    FILE *record;      ///< what mouse and keys have done, or NULL
    lab_costs costs;
    double last_begin;
    bool script_failed;
    uint32_t slow_frames; ///< frames that took longer than the budget
    uint32_t late_frames; ///< frames that began more than 1/60 s after the one before
    double total_frame, longest_frame;
    double total_shown;                      ///< seconds that the display took
    double total_stepped[2], total_drawn[2]; ///< of each side's thread
    uint64_t frames;
} lab_app;

/// Start with what the options say. What goes wrong is printed.
bool app_start(lab_app *made, const lab_options *options);
bool app_free(lab_app *unwanted);

/// Do what the mouse or a key asks for: recorded, and if it fails, told in the status line.
void app_perform(const lab_action *action, void *app);

/// One frame: the script's actions that are due, steps, and the picture in view.target; show_pointer: with the
/// mouse. Returns false if a line of the script failed, which is printed.
bool app_frame(lab_app *app, bool show_pointer);
/// Whether the script has come to its end (true without one).
bool app_script_done(const lab_app *app);
/// What frames cost, and the state's hash, on standard output.
void app_report(const lab_app *app);

/* app_files.c */

/// Write the files that the last actions asked for. Returns false if that fails and nobody sees the window.
bool app_write_wanted(lab_app *app);
/// Write what the view shows as a PNG file.
bool app_write_png(const lab_raster *source, const char *folder, const char *name);

#endif
