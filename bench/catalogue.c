/// @file catalogue.c
/// The scenes of the bench: names, sizes and springs. The makers are those of the examples and tests.
///
/// SPDX-License-Identifier: MIT
#include "catalogue.h"

#include <stdio.h>
#include <string.h>

/// Springs of all scenes, as fractions of what the substep bears: half of the limit leaves room for cells of
/// unequal mass and for ropes tied to them.
#define SPRING_STIFFNESS 0.5f
#define SPRING_DAMPING 0.05f

/// A particle of the random graph has up to twice the neighbours that one of a lattice has.
#define GRAPH_FRACTION 0.4f
#define GRAPH_NEIGHBOURS 8u

/// Ropes are light next to what they hold, and long.
#define ROPE_MASS 7.0f
#define ROPE_SEGMENTS 20u

#define SEED 20250101u

/// Endings of names.
#define UNDAMPED "_undamped"
#define ROPES "_ropes_"

typedef struct entry {
    const char *name, *description;
} entry;

static const entry entries[] = {
    {"bar_80x5", "bar of 80 columns by 5 rows, pinned at the left: the small network"},
    {"bar_544x68", "bar of 544 by 68: the size of a game's ship"},
    {"bar_1800x5", "long thin bar of 1800 by 5: rows much longer than they are many"},
    {"grid_96x96", "square of 96 by 96, 36 thousand springs: fits the second-level cache"},
    {"grid_512x500", "512 by 500, a million springs (the 512 columns put the baseline at a disadvantage)"},
    {"grid_1000x1000", "1000 by 1000, 4 million springs: larger than the caches"},
    {"grid_1581x1581", "1581 by 1581, 10 million springs"},
    {"ship", "ship from an image: decks, holes, several materials"},
    {"ship_ropes_4", "the ship with 4 ropes of 20 springs between random particles"},
    {"ship_ropes_40", "the ship with 40 ropes"},
    {"ship_ropes_400", "the ship with 400 ropes"},
    {"wheel_1000x40", "ring of 1000 around by 40 deep: a lattice that is bent"},
    {"noise_400x400", "400 by 400 of which six cells of ten, at random, are filled"},
    {"rope_1000", "rope of 1000 particles between two pins"},
    {"graph_100000", "100,000 particles at random places, each joined to about 8 near ones"},
    {"robots_256", "256 equal robots of 20 particles that are no lattice"},
    {"blocks_4x256", "256 lattices of 4 by 4"},
    {"braced_6x256", "256 lattices of 6 by 6 with 20 to 40 springs across two cells"},
};

static const char *const quick[] = {"bar_80x5",      "grid_96x96", "bar_544x68", "ship",
                                    "ship_ropes_40", "rope_1000",  NULL};

static const char *const checked[] = {"bar_80x5",   "bar_80x5_undamped", "bar_544x68",
                                      "bar_1800x5", "bar_80x5_ropes_40", "wheel_200x20",
                                      "rope_1000",  "graph_10000",       NULL};

const char *const *bench_catalogue_quick(void) {
    return quick;
}

const char *const *bench_catalogue_checked(void) {
    return checked;
}

void bench_catalogue_print(void) {
    for (size_t i = 0; i < sizeof entries / sizeof *entries; i++) {
        printf("%-16s %s\n", entries[i].name, entries[i].description);
    }
    puts("\nOther sizes go by the same names: bar_CxR, grid_CxR, wheel_CxR, noise_CxR, rope_N, graph_N, robots_N, "
         "blocks_SxN,\nbraced_SxN.\n"
         "Any scene's name may end in " ROPES "N: with N ropes; and after that in " UNDAMPED
         ": springs without dampers.");
}

uint32_t bench_default_substeps(uint32_t springs) {
    return springs > 2000000u ? 16 : 40;
}

uint32_t bench_default_repeat(uint32_t springs) {
    return springs > 2000000u ? 5 : 21;
}

static scene_options spring_options(const bench_scene_settings *settings, float fraction) {
    scene_options options = scene_options_default();
    options.relative = true;
    options.stiffness = settings->stiffness >= 0.0f ? settings->stiffness : fraction * SPRING_STIFFNESS;
    options.damping = settings->damping >= 0.0f ? settings->damping : fraction * SPRING_DAMPING;
    return options;
}

static bool make_ship(const bench_scene_settings *settings, scene *out, scene_error *error) {
    const char *image = settings->image != NULL ? settings->image : BENCH_DATA_DIR "/ship.png";
    const char *table = settings->materials;
    if (table == NULL && settings->image == NULL) {
        table = BENCH_DATA_DIR "/ship_materials.csv";
    }
    scene_materials materials;
    if (!(table != NULL ? scene_materials_read(table, &materials, error)
                        : scene_materials_builtin(&materials, error))) {
        return false;
    }
    scene_options options = spring_options(settings, 1.0f);
    bool ok = scene_image(image, &materials, &options, out, error);
    scene_materials_free(&materials);
    return ok;
}

/// Step over a word at the place in a name, if it is there.
static bool take_word(const char **place, const char *word) {
    size_t length = strlen(word);
    if (strncmp(*place, word, length) != 0) {
        return false;
    }
    *place += length;
    return true;
}

/// Step over a number.
static bool take_number(const char **place, uint32_t *number) {
    const char *start = *place;
    uint32_t value = 0;
    while (**place >= '0' && **place <= '9' && value < 100000000u) {
        value = value * 10 + (uint32_t)(*(*place)++ - '0');
    }
    *number = value;
    return *place > start;
}

static bool is_pair(const char *name, const char *kind, uint32_t *columns, uint32_t *rows) {
    return take_word(&name, kind) && take_number(&name, columns) && take_word(&name, "x") &&
           take_number(&name, rows) && *name == '\0';
}

static bool is_single(const char *name, const char *kind, uint32_t *number) {
    return take_word(&name, kind) && take_number(&name, number) && *name == '\0';
}

/// Make what a name without its endings says.
static bool make_named(const char *name, const bench_scene_settings *settings, scene *out, scene_error *error) {
    uint32_t columns = 0;
    uint32_t rows = 0;
    uint32_t number = 0;
    scene_options options = spring_options(settings, 1.0f);
    if (is_pair(name, "bar_", &columns, &rows) || is_pair(name, "grid_", &columns, &rows)) {
        return scene_bar(columns, rows, &options, out, error);
    }
    if (is_pair(name, "wheel_", &columns, &rows)) {
        return scene_wheel(columns, rows, &options, out, error);
    }
    if (is_pair(name, "noise_", &columns, &rows)) {
        return bench_scene_noise(columns, rows, &options, out, error);
    }
    if (is_single(name, "rope_", &number)) {
        return scene_rope(number, &options, out, error);
    }
    if (is_single(name, "graph_", &number)) {
        options = spring_options(settings, GRAPH_FRACTION);
        return scene_random_graph(number, GRAPH_NEIGHBOURS, SEED, &options, out, error);
    }
    if (is_single(name, "robots_", &number)) {
        options = spring_options(settings, GRAPH_FRACTION);
        return bench_scene_copies(BENCH_COPIES_ROBOTS, 0, number, &options, out, error);
    }
    if (is_pair(name, "blocks_", &rows, &number)) {
        return bench_scene_copies(BENCH_COPIES_BLOCKS, rows, number, &options, out, error);
    }
    if (is_pair(name, "braced_", &rows, &number)) {
        return bench_scene_copies(BENCH_COPIES_BRACED, rows, number, &options, out, error);
    }
    if (strcmp(name, "ship") == 0) {
        return make_ship(settings, out, error);
    }
    snprintf(error->text, sizeof error->text, "there is no such scene: --list shows the names");
    return false;
}

static bool make_of_file(const char *path, const bench_scene_settings *settings, scene *out, scene_error *error) {
    scene_options options = scene_options_from_file();
    if (settings->stiffness >= 0.0f || settings->damping >= 0.0f) {
        options = spring_options(settings, 1.0f);
    }
    return scene_network_file(path, &options, out, error);
}

/// Cut the endings off a name and take over what they say.
static void read_endings(char *name, bench_scene_settings *settings) {
    char *place = strstr(name, UNDAMPED);
    if (place != NULL && place != name && strcmp(place, UNDAMPED) == 0) {
        settings->damping = 0.0f;
        *place = '\0';
    }
    uint32_t ropes = 0;
    place = strstr(name, ROPES);
    if (place != NULL && place != name && is_single(place, ROPES, &ropes)) {
        settings->ropes += ropes;
        *place = '\0';
    }
}

bool bench_scene_make(const bench_source *source, const bench_scene_settings *settings, bench_scene *out,
                      scene_error *error) {
    bench_scene result = {.source = *source};
    bench_scene_settings own = *settings;
    char base[64] = "";
    if (!source->is_file) {
        snprintf(base, sizeof base, "%s", source->name); /* a longer name is no scene's, whole or cut */
        read_endings(base, &own);
    }
    if (!(source->is_file ? make_of_file(source->name, &own, &result.made, error)
                          : make_named(base, &own, &result.made, error))) {
        return false;
    }
    scene_options options = spring_options(&own, 1.0f);
    options.mass = ROPE_MASS;
    if (own.ropes > 0 && !scene_add_ropes(&result.made, own.ropes, ROPE_SEGMENTS, SEED, &options, error)) {
        scene_free(&result.made);
        return false;
    }
    bool own_name = source->is_file || (own.image != NULL && strcmp(base, "ship") == 0);
    char ropes[32] = "";
    if (own.ropes > 0) {
        snprintf(ropes, sizeof ropes, ROPES "%u", own.ropes);
    }
    snprintf(result.label, sizeof result.label, "%s%s%s", own_name ? result.made.name : base, ropes,
             own.damping == 0.0f ? UNDAMPED : "");
    *out = result;
    return true;
}

void bench_scene_free(bench_scene *unwanted) {
    scene_free(&unwanted->made);
}
