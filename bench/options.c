/// @file options.c
/// Reading the command line.
///
/// SPDX-License-Identifier: MIT
#include "options.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

#include "turns.h"

void bench_options_help(void) {
    puts("massspring-bench: the speed of mass-spring networks, as ratios to a naive step\n"
         "\n"
         "  massspring-bench [what] [options]\n"
         "\n"
         "What to measure (default: scenes against the naive step)\n"
         "  --features           what dampers, hooks, forces and ropes cost\n"
         "  --contact            what contact between bodies costs\n"
         "  --workers            what workers gain, next to as many threads that share nothing\n"
         "  --cores              what 2 to 64 workers would gain, simulated; two of them measured\n"
         "  --session            what a game's edits, events and measurements cost, next to its step\n"
         "  --game               a whole frame of a game: its calls, and frames in which springs break\n"
         "  --linear             what the sparse direct solver costs, in explicit substeps\n"
         "  --solvers            what steps of the implicit and the direct solver cost, in explicit substeps\n"
         "  --errors             error against time of stiff structures, at 1e7 to 1e10 N/m; takes minutes\n"
         "  --roofline           the bounds of this machine, and how near to them each scene comes\n"
         "  --map                where networks are stable, at the extremes of every setting; takes minutes\n"
         "  --frames             how long the worst step takes next to the median\n"
         "  --alarms             whether the guard refuses any of a million ordinary steps\n"
         "  --guard              what the guard costs, and what a step costs beyond its substeps\n"
         "  --spare              what a floor, spare particles and an empty hook cost a step\n"
         "  --loops              speed next to other ways to write the loop, on grids\n"
         "  --check              compare positions with those of the naive step; measures nothing\n"
         "  --list               show the scenes\n"
         "  --help               show this\n"
         "\n"
         "Scenes (default: a few that take some seconds)\n"
         "  --scene NAME         one of the list; may be given several times\n"
         "  --image FILE         make the ship scenes of this image\n"
         "  --materials FILE     its table of colours (CSV)\n"
         "  --network FILE       a network from a text file\n"
         "  --stiffness X        of all springs, as a fraction of what the substep bears (default 0.5)\n"
         "  --damping X          likewise (default 0.05); 0: springs without dampers\n"
         "\n"
         "Running\n"
         "  --solver explicit    the solver\n"
         "  --substeps N         substeps per step (default 40; from 2 million springs on 16)\n"
         "  --level LEVEL        scalar, sse2, avx2, avx512, neon, or all (default: the best)\n"
         "  --threads N          workers of the library's network (default 1; of --workers 2); the naive step has "
         "one\n"
         "  --sorted             give the naive step its particles and springs by place, not by id\n"
         "  --repeat N           pairs of samples (default 21; from 2 million springs on 5)\n"
         "\n"
         "Output (default: a table for people)\n"
         "  --csv                CSV\n"
         "  --markdown           a Markdown table\n"
         "  --out FOLDER         of --map: draw its pictures into this folder\n"
         "\n"
         "The map\n"
         "  --family NAME        of --map: only the cases of this family; of --spare: only this row; of --errors: "
         "only this scene\n"
         "  --shard I/N          of --map: every N-th part of the cases, the I-th of them, to run N at once\n"
         "  --map-case CASE      run one case, as a fault names it (family:number), and print its energies");
}

static bool read_count(const char *option, const char *text, uint32_t most, uint32_t *out, scene_error *error) {
    char *end = NULL;
    errno = 0;
    unsigned long value = strtoul(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || *end != '\0' || errno != 0 || value < 1 || value > most) {
        snprintf(error->text, sizeof error->text, "%s takes a whole number from 1 to %u, not '%.80s'", option, most,
                 text);
        return false;
    }
    *out = (uint32_t)value;
    return true;
}

static bool read_fraction(const char *option, const char *text, float *out, scene_error *error) {
    char *end = NULL;
    float value = strtof(text, &end);
    if (end == text || *end != '\0' || !(value >= 0.0f && value <= 1.0f)) {
        snprintf(error->text, sizeof error->text, "%s takes a number from 0 to 1, not '%.80s'", option, text);
        return false;
    }
    *out = value;
    return true;
}

/// I/N, I from 1 to N.
static bool read_shard(const char *text, bench_options *out, scene_error *error) {
    char extra = 0;
    if (sscanf(text, "%u/%u%c", &out->shard, &out->shards, &extra) == 2 && out->shard >= 1 &&
        out->shard <= out->shards) {
        return true;
    }
    snprintf(error->text, sizeof error->text, "--shard takes I/N with I from 1 to N, not '%.80s'", text);
    return false;
}

static bool read_level(const char *text, bench_options *out, scene_error *error) {
    out->all_levels = strcmp(text, "all") == 0;
    if (out->all_levels) {
        return true;
    }
    for (mspring_simd level = MSPRING_SIMD_SCALAR; level <= MSPRING_SIMD_NEON; level++) {
        if (strcmp(text, mspring_simd_name(level)) == 0) {
            out->level = level;
            return true;
        }
    }
    snprintf(error->text, sizeof error->text, "--level takes scalar, sse2, avx2, avx512, neon or all, not '%.80s'",
             text);
    return false;
}

static bool add_scene(const char *name, bench_options *out, scene_error *error) {
    if (out->scene_count == BENCH_MAX_SCENES) {
        snprintf(error->text, sizeof error->text, "more than %d scenes: measure '%.80s' in another run",
                 BENCH_MAX_SCENES, name);
        return false;
    }
    out->scenes[out->scene_count++] = name;
    return true;
}

/// Take an option that stands alone.
static bool is_switch(const char *option, bench_options *out) {
    static const struct {
        const char *name;
        bench_mode mode;
    } modes[] = {{"--features", BENCH_FEATURES}, {"--contact", BENCH_CONTACT},
                 {"--workers", BENCH_WORKERS},   {"--session", BENCH_SESSION},
                 {"--game", BENCH_GAME},         {"--linear", BENCH_LINEAR},
                 {"--solvers", BENCH_SOLVERS},   {"--errors", BENCH_ERRORS},
                 {"--roofline", BENCH_ROOFLINE}, {"--map", BENCH_MAP},
                 {"--frames", BENCH_FRAMES},     {"--alarms", BENCH_ALARMS},
                 {"--guard", BENCH_GUARD},       {"--check", BENCH_CHECK},
                 {"--spare", BENCH_SPARE},       {"--loops", BENCH_LOOPS},
                 {"--cores", BENCH_CORES},       {"--list", BENCH_LIST},
                 {"--help", BENCH_HELP},         {"-h", BENCH_HELP}};
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
        if (strcmp(option, modes[i].name) == 0) {
            out->mode = modes[i].mode;
            return true;
        }
    }
    if (strcmp(option, "--csv") == 0) {
        out->format = BENCH_CSV;
        return true;
    }
    if (strcmp(option, "--sorted") == 0) {
        out->sorted = true;
        return true;
    }
    if (strcmp(option, "--markdown") == 0) {
        out->format = BENCH_MARKDOWN;
        return true;
    }
    return false;
}

/// Take an option with its value.
static bool read_value(const char *option, const char *value, bench_options *out, scene_error *error) {
    if (strcmp(option, "--scene") == 0) {
        return add_scene(value, out, error);
    }
    if (strcmp(option, "--image") == 0) {
        out->settings.image = value;
        return true;
    }
    if (strcmp(option, "--materials") == 0) {
        out->settings.materials = value;
        return true;
    }
    if (strcmp(option, "--network") == 0) {
        out->network = value;
        return true;
    }
    if (strcmp(option, "--out") == 0) {
        out->out = value;
        return true;
    }
    if (strcmp(option, "--family") == 0) {
        out->family = value;
        return true;
    }
    if (strcmp(option, "--map-case") == 0) {
        out->mode = BENCH_MAP_CASE;
        out->map_case = value;
        return true;
    }
    if (strcmp(option, "--shard") == 0) {
        return read_shard(value, out, error);
    }
    if (strcmp(option, "--stiffness") == 0) {
        return read_fraction(option, value, &out->settings.stiffness, error);
    }
    if (strcmp(option, "--damping") == 0) {
        return read_fraction(option, value, &out->settings.damping, error);
    }
    if (strcmp(option, "--substeps") == 0) {
        return read_count(option, value, 1000000, &out->substeps, error);
    }
    if (strcmp(option, "--repeat") == 0) {
        return read_count(option, value, BENCH_MAX_REPEAT, &out->repeat, error);
    }
    if (strcmp(option, "--level") == 0) {
        return read_level(value, out, error);
    }
    if (strcmp(option, "--solver") == 0) {
        if (strcmp(value, "explicit") == 0) {
            return true;
        }
        snprintf(error->text, sizeof error->text, "--solver takes explicit, not '%.80s'", value);
        return false;
    }
    if (strcmp(option, "--threads") == 0) {
        return read_count(option, value, MSPRING_MAX_WORKERS, &out->workers, error);
    }
    snprintf(error->text, sizeof error->text, "unknown argument '%.80s': --help shows the options", option);
    return false;
}

static bool known_with_value(const char *option) {
    static const char *const names[] = {"--scene",   "--image",    "--materials", "--network",  "--stiffness",
                                        "--damping", "--substeps", "--repeat",    "--level",    "--solver",
                                        "--threads", "--out",      "--family",    "--map-case", "--shard"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(option, names[i]) == 0) {
            return true;
        }
    }
    return false;
}

bool bench_options_read(int count, char **arguments, bench_options *out, scene_error *error) {
    bench_options options = {.level = MSPRING_SIMD_AUTO,
                             .workers = 1,
                             .shard = 1,
                             .shards = 1,
                             .settings = {.stiffness = -1.0f, .damping = -1.0f}};
    for (int i = 1; i < count; i++) {
        const char *option = arguments[i];
        if (is_switch(option, &options)) {
            continue;
        }
        if (known_with_value(option) && i + 1 == count) {
            snprintf(error->text, sizeof error->text, "%s needs a value after it: --help shows which", option);
            return false;
        }
        if (!read_value(option, i + 1 < count ? arguments[i + 1] : "", &options, error)) {
            return false;
        }
        i++;
    }
    if (options.settings.materials != NULL && options.settings.image == NULL) {
        snprintf(error->text, sizeof error->text, "--materials goes with --image, which names the image");
        return false;
    }
    if (options.scene_count == 0 && options.settings.image != NULL) {
        options.scenes[options.scene_count++] = "ship";
    }
    *out = options;
    return true;
}

/// The best level that a network will run at: the machine's, unless the environment lowers it.
static mspring_simd best_level(void) {
    mspring_simd best = MSPRING_SIMD_SCALAR;
    for (mspring_simd level = MSPRING_SIMD_SCALAR; level <= MSPRING_SIMD_WASM; level++) {
        best = mspring_simd_available(level) ? level : best;
    }
    const char *wish = getenv("MSPRING_SIMD");
    for (mspring_simd level = MSPRING_SIMD_SCALAR; wish != NULL && level < best; level++) {
        if (mspring_simd_available(level) && strcmp(wish, mspring_simd_name(level)) == 0) {
            return level;
        }
    }
    return best;
}

int bench_options_levels(const bench_options *options, mspring_simd levels[4], scene_error *error) {
    mspring_simd best = best_level();
    if (!options->all_levels) {
        levels[0] = options->level != MSPRING_SIMD_AUTO ? options->level : best;
        if (!mspring_simd_available(levels[0]) || levels[0] > best) {
            snprintf(error->text, sizeof error->text,
                     "%s is not to be had here: the best level of this machine (and of MSPRING_SIMD, if set) is %s",
                     mspring_simd_name(levels[0]), mspring_simd_name(best));
            return 0;
        }
        return 1;
    }
    int count = 0;
    for (mspring_simd level = MSPRING_SIMD_SCALAR; level <= best; level++) {
        if (mspring_simd_available(level)) {
            levels[count++] = level;
        }
    }
    return count;
}
