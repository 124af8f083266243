/// @file scene.c
/// What all scenes have in common: options, messages, names, the end.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

scene_options scene_options_default(void) {
    scene_options options = {
        .mass = SCENE_IRON_MASS,
        .stiffness = SCENE_IRON_STIFFNESS,
        .damping = 0,
        .relative = false,
        .spacing = 1,
    };
    return options;
}

scene_options scene_options_from_file(void) {
    scene_options options = scene_options_default();
    options.stiffness = -1;
    options.damping = -1;
    return options;
}

bool scene_options_check(const scene_options *options, bool from_file, scene_error *error) {
    if (!(options->mass >= 1e-30f && options->mass <= 1e30f))
        return scene_fail(error, "the mass of a particle is %g kg: give one from 1e-30 to 1e30", options->mass);
    if (!(options->spacing >= 1e-9 && options->spacing <= 1e9))
        return scene_fail(error, "the spacing is %g m: give one from 1e-9 to 1e9", options->spacing);
    if (!(options->stiffness <= 1e30f) || !isfinite(options->stiffness))
        return scene_fail(error, "the stiffness is %g: give one from 0 to 1e30", options->stiffness);
    if (!(options->damping <= 1e30f) || !isfinite(options->damping))
        return scene_fail(error, "the damping is %g: give one from 0 to 1e30", options->damping);
    if (!from_file && (options->stiffness < 0 || options->damping < 0))
        return scene_fail(error, "stiffness %g and damping %g: neither may be negative here", options->stiffness,
                          options->damping);
    return true;
}

bool scene_fail(scene_error *error, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    return false;
}

bool scene_fail_builder(scene_error *error, const char *what, const mspring_builder *builder,
                        mspring_result result) {
    const char *detail = mspring_builder_error(builder);
    return scene_fail(error, "%s: %s%s%s", what, mspring_result_string(result), *detail ? ": " : "", detail);
}

bool scene_fail_memory(scene_error *error, const char *what) {
    return scene_fail(error, "%s: out of memory; close other programs or take a smaller scene", what);
}

bool scene_start(scene *out, scene_error *error) {
    memset(out, 0, sizeof *out);
    out->probe = MSPRING_NONE;
    mspring_result result = mspring_builder_create(NULL, &out->builder);
    if (result != MSPRING_OK) {
        out->builder = NULL;
        return scene_fail(error, "cannot make a builder: %s", mspring_result_string(result));
    }
    return true;
}

void scene_name_from_path(scene *out, const char *path) {
    const char *base = path;
    for (const char *c = path; *c; c++)
        if ((*c == '/' || *c == '\\') && c[1])
            base = c + 1;
    const char *dot = strrchr(base, '.');
    size_t length = dot && dot != base ? (size_t)(dot - base) : strlen(base);
    if (length >= sizeof out->name)
        length = sizeof out->name - 1;
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)base[i];
        out->name[i] = c <= ' ' || c == 127 || strchr(",\"'/\\:*?<>|", c) ? '_' : (char)c;
    }
    out->name[length] = 0;
}

void scene_free(scene *unwanted) {
    if (!unwanted)
        return;
    mspring_builder_destroy(unwanted->builder);
    free(unwanted->break_strain);
    free(unwanted->velocity);
    memset(unwanted, 0, sizeof *unwanted);
    unwanted->probe = MSPRING_NONE;
}
