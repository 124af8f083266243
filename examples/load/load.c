/// @file load.c
/// Load a structure of another program, say what became of it, and let it down onto a floor.
///
/// SPDX-License-Identifier: MIT
#include "load/settle.h"
#include "loaders/structure.h"
#include "scenes/number.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EXIT_USAGE = 2 };

static const char *const usage =
    "Load a structure from another program's file, as particles and springs in a plane.\n"
    "\n"
    "  load [options] FILE      .truck, .trailer (Rigs of Rods), .jbeam (BeamNG), .obj (its lines),\n"
    "                           .shp, .shp2 (Floating Sandbox), or an image with --materials\n"
    "\n"
    "  --plane xy|xz|yz         which axes are seen, the second pointing up (the format's side view)\n"
    "  --merge METRES           nodes no farther apart in the plane are one (0.001)\n"
    "  --materials FILE         Floating Sandbox's materials (structural_materials.json beside the ship)\n"
    "  --substeps N             a ship's, in 1/64 s: they tell how fragile it is (40)\n"
    "  --dock                   pin a ship's lowest row, and leave out what does not stand on it\n"
    "  --part NAME              of a .jbeam with several parts\n"
    "  --no-wheels              leave wheels out (Rigs of Rods)\n"
    "  --mass KG, --stiffness N/M, --damping NS/M    of an .obj: its vertices, its lines (1, 1e5, 100)\n"
    "  --settle                 let it down onto a floor, with each solver\n"
    "  --seconds S              for so long (5)\n"
    "  --picture FILE.png       draw it; with --settle also settled: FILE_explicit.png, FILE_implicit.png\n"
    "  --write FILE.msn         as a text network, for the other examples and the bench\n";

typedef struct arguments {
    structure_options options;
    settle_request settle;
    const char *file, *picture, *write;
    bool settles, help;
} arguments;

static bool parse_value(const char *option, const char *text, double *value) {
    text_span span = {text ? text : "", text ? strlen(text) : 0};
    if (number_parse(span, value))
        return true;
    fprintf(stderr, "load: %s needs a number (load --help)\n", option);
    return false;
}

static bool parse_substeps(const char *text, uint32_t *substeps) {
    uint64_t count = 0;
    text_span span = {text ? text : "", text ? strlen(text) : 0};
    if (number_parse_count(span, &count) && count >= 1 && count <= 10000) {
        *substeps = (uint32_t)count;
        return true;
    }
    fprintf(stderr, "load: --substeps is 1 to 10000 (load --help)\n");
    return false;
}

static bool parse_plane(const char *text, structure_plane *plane) {
    for (structure_plane p = STRUCTURE_PLANE_XY; text && p <= STRUCTURE_PLANE_YZ; p++) {
        if (strcmp(text, structure_plane_name(p)) == 0) {
            *plane = p;
            return true;
        }
    }
    fprintf(stderr, "load: --plane is xy, xz or yz (load --help)\n");
    return false;
}

static bool parse_text(const char *option, const char *text, const char **value) {
    *value = text;
    if (!text)
        fprintf(stderr, "load: %s needs a value (load --help)\n", option);
    return text != NULL;
}

// An option with a value. Returns false, with a message, if it is wrong.
static bool parse_option(const char *option, const char *value, arguments *parsed) {
    const struct {
        const char *name;
        double *value;
    } numbers[] = {
        {"--merge", &parsed->options.merge_distance}, {"--mass", &parsed->options.mass},
        {"--stiffness", &parsed->options.stiffness},  {"--damping", &parsed->options.damping},
        {"--seconds", &parsed->settle.seconds},
    };
    const struct {
        const char *name;
        const char **value;
    } texts[] = {
        {"--materials", &parsed->options.materials},
        {"--part", &parsed->options.part},
        {"--picture", &parsed->picture},
        {"--write", &parsed->write},
    };
    if (strcmp(option, "--plane") == 0)
        return parse_plane(value, &parsed->options.plane);
    if (strcmp(option, "--substeps") == 0)
        return parse_substeps(value, &parsed->options.substeps);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (strcmp(option, numbers[i].name) == 0)
            return parse_value(option, value, numbers[i].value);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (strcmp(option, texts[i].name) == 0)
            return parse_text(option, value, texts[i].value);
    fprintf(stderr, "load: unknown option %s (load --help)\n", option);
    return false;
}

static bool parse_arguments(int count, char **words, arguments *parsed) {
    parsed->options = structure_options_default();
    parsed->settle.seconds = 5;
    for (int i = 1; i < count; i++) {
        if (strcmp(words[i], "--help") == 0 || strcmp(words[i], "-h") == 0) {
            parsed->help = true;
            return true;
        }
        if (strcmp(words[i], "--settle") == 0) {
            parsed->settles = true;
        } else if (strcmp(words[i], "--dock") == 0) {
            parsed->options.dock = true;
        } else if (strcmp(words[i], "--no-wheels") == 0) {
            parsed->options.wheels = false;
        } else if (words[i][0] == '-') {
            if (!parse_option(words[i], i + 1 < count ? words[i + 1] : NULL, parsed))
                return false;
            i++;
        } else if (parsed->file) {
            fprintf(stderr, "load: two files, %s and %s (load --help)\n", parsed->file, words[i]);
            return false;
        } else {
            parsed->file = words[i];
        }
    }
    if (!parsed->file)
        fprintf(stderr, "load: no file (load --help)\n");
    else if (!(parsed->settle.seconds > 0 && parsed->settle.seconds <= 3600))
        fprintf(stderr, "load: --seconds is more than 0 and at most 3600\n");
    else
        return true;
    return false;
}

static void print_tally(const char *title, const tally *counted) {
    if (counted->entry_count == 0)
        return;
    printf("%-10s", title);
    for (uint32_t i = 0; i < counted->entry_count; i++)
        printf("%s%s %u", i ? ", " : " ", counted->entries[i].name, counted->entries[i].count);
    printf("\n");
}

static void print_report(const char *path, const structure *loaded) {
    const structure_report *report = &loaded->report;
    printf("%s, seen in %s\n", path, structure_plane_name(report->plane));
    printf("nodes      %u, merged %u: %u particles, %.6g kg, %u pinned, %u loose\n", report->nodes,
           report->merged_nodes, loaded->particle_count, report->mass, report->pinned_particles,
           report->loose_particles);
    printf("beams      %u, dropped %u, merged %u: %u springs\n", report->beams, report->dropped_beams,
           report->merged_springs, loaded->spring_count);
    print_tally("read", &report->used);
    print_tally("ignored", &report->ignored);
    print_tally("notes", &report->notes);
}

int main(int count, char **words) {
    arguments given = {.file = NULL};
    if (!parse_arguments(count, words, &given))
        return EXIT_USAGE;
    if (given.help) {
        fputs(usage, stdout);
        return EXIT_SUCCESS;
    }
    structure loaded;
    scene_error error = {""};
    if (!structure_load(given.file, &given.options, &loaded, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return EXIT_FAILURE;
    }
    print_report(given.file, &loaded);
    bool ok = !given.write || structure_write(&loaded, given.write, &error);
    scene built;
    if (ok && (ok = structure_scene(&loaded, given.file, &built, &error))) {
        given.settle.picture = given.picture;
        given.settle.substeps = loaded.substeps;
        ok = (!given.picture || settle_draw(&built, given.picture, &error)) &&
             (!given.settles || (settle_run(&built, MSPRING_SOLVER_EXPLICIT, &given.settle, &error) &&
                                 settle_run(&built, MSPRING_SOLVER_IMPLICIT, &given.settle, &error)));
        scene_free(&built);
    }
    structure_free(&loaded);
    if (!ok)
        fprintf(stderr, "%s\n", error.text);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
