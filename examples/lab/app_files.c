/// @file app_files.c
/// Pictures, tables of the plots, and scripts of what was done.
///
/// SPDX-License-Identifier: MIT
#include "common/output.h"
#include "draw/png.h"
#include "lab/app.h"

#include <stdio.h>

static bool complain(const char *text) {
    fprintf(stderr, "lab: %s\n", text);
    return false;
}

bool app_write_png(const lab_raster *source, const char *folder, const char *name) {
    char path[OUTPUT_PATH_SIZE];
    draw_error error = {""};
    canvas pixels = {0};
    bool ok = output_path(path, folder, name, ".png");
    ok = ok && (canvas_make(&pixels, (uint32_t)source->width, (uint32_t)source->height, 0) ||
                complain("out of memory for a picture"));
    if (!ok)
        return false;
    for (size_t i = 0; i < (size_t)source->width * (size_t)source->height; i++)
        for (int channel = 0; channel < 3; channel++)
            pixels.rgb[3 * i + (size_t)channel] = (uint8_t)(source->pixels[i] >> (16 - 8 * channel));
    ok = png_write(&pixels, path, &error) || complain(error.text);
    canvas_free(&pixels);
    return ok;
}

// Opens a file, calls write, and closes it.
static bool write_text(const lab_app *app, const char *name, const char *ending,
                       bool (*write)(const lab_app *app, FILE *stream)) {
    char path[OUTPUT_PATH_SIZE];
    FILE *stream = output_path(path, app->options->frames, name, ending) ? fopen(path, "w") : NULL;
    if (!stream)
        return false;
    const bool ok = write(app, stream);
    return fclose(stream) == 0 && ok;
}

// A row for each sample: time, and each quantity of each side.
static bool write_table(const lab_app *app, FILE *stream) {
    static const char *const names[PROBE_KINDS] = {"bending_m", "kinetic_J", "elastic_J", "max_strain", "cost_ms"};
    const lab_series *series = &app->model.series;
    const int kinds = app->options->no_clock ? PROBE_COST : PROBE_KINDS, sides = app->model.side_count;
    fputs("seconds", stream);
    for (int kind = 0; kind < kinds; kind++)
        for (int side = 0; side < sides; side++)
            fprintf(stream, ",%s_%s", side == 0 ? "left" : "right", names[kind]);
    for (int i = 0; i < series->count; i++) {
        fprintf(stream, "\n%.6f", series->times[i]);
        for (int kind = 0; kind < kinds; kind++)
            for (int side = 0; side < sides; side++)
                fprintf(stream, ",%.9g", (double)series->values[kind][side][i]);
    }
    return fputs("\n", stream) >= 0;
}

// All that mouse and keys did until now, and where it ends.
static bool write_recording(const lab_app *app, FILE *stream) {
    char bytes[4096];
    size_t count;
    if (!app->record || fflush(app->record) != 0 || fseek(app->record, 0, SEEK_SET) != 0)
        return false;
    while ((count = fread(bytes, 1, sizeof bytes, app->record)) > 0)
        fwrite(bytes, 1, count, stream);
    const lab_action end = {.kind = ACTION_END};
    return fseek(app->record, 0, SEEK_END) == 0 && script_record(stream, app->model.frame, &end);
}

bool app_write_wanted(lab_app *app) {
    static const char *const endings[WANTED_KINDS] = {".png", ".csv", ".lab"};
    lab_model *model = &app->model;
    for (int kind = 0; kind < WANTED_KINDS; kind++) {
        char *name = model->wanted[kind];
        if (!name[0])
            continue;
        bool ok = output_make_folder(app->options->frames);
        if (kind == WANTED_PICTURE)
            ok = ok && app_write_png(&app->view.target, app->options->frames, name);
        else
            ok = ok && write_text(app, name, endings[kind], kind == WANTED_TABLE ? write_table : write_recording);
        snprintf(model->message, sizeof model->message, "%s %.100s%s %s %.100s", ok ? "written" : "cannot write",
                 name, endings[kind], ok ? "into" : "to", app->options->frames);
        name[0] = 0;
        if (!ok && app->options->headless)
            return complain(model->message);
    }
    return true;
}
