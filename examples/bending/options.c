/// @file options.c
/// The command line of `bending`.
///
/// SPDX-License-Identifier: MIT
#include "bending/options.h"
#include "scenes/number.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <massspring/massspring.h>

static const char help[] =
    "bending: let a network settle under gravity and measure how far its probe comes down\n"
    "\n"
    "usage: bending [options] FILE\n"
    "\n"
    "FILE is an image, each pixel a particle, or a plain text network (.msn, .txt): a line `P S` with the numbers\n"
    "of particles and springs, P lines `x y mass pinned probe`, S lines `a b rest stiffness damping`. A line\n"
    "`P S relative` says that stiffness and damping are fractions. A ship of Floating Sandbox (.shp, .shp2) "
    "stands\n"
    "on its lowest row.\n"
    "Without a probe, what is measured is how far the mean of all particles comes down.\n"
    "In images #0A0A0A is pinned iron, #216CCF iron with the probe, #808090 iron, white nothing, unless\n"
    "--materials gives another table.\n"
    "\n"
    "  --materials FILE   colours: CSV with the header\n"
    "                     colour,name,mass,stiffness,damping,break_strain,pinned,probe\n"
    "                     of a ship the game's JSON (default: structural_materials.json beside it)\n"
    "  --stiffness X      of all springs, N/m (default: that of the file)\n"
    "  --damping X        of all springs, N s/m (default: that of the file)\n"
    "  --relative         stiffness and damping are fractions of what an explicit substep bears: those given by\n"
    "                     --stiffness and --damping, or each material's in the CSV file\n"
    "  --dt S             length of a step, s (default 1/64)\n"
    "  --solver NAME      explicit, implicit or direct (default explicit)\n"
    "  --substeps N       substeps in a step (default 30, of ships 40; implicit and direct 1)\n"
    "  --iterations N     of the implicit solver in a substep, at most (default 30)\n"
    "  --steps N          give up after so many steps (default 2000000)\n"
    "  --at-once          find where it rests without stepping there, by mspring_network_settle()\n"
    "  --gravity G        m/s^2, downwards (default 9.8)\n"
    "  --level L          scalar, sse2, avx2, avx512 or neon (default: the best that the CPU has)\n"
    "\n"
    "  --out FOLDER       write FOLDER/<scene>.png, .svg and _animation.png\n"
    "  --picture FILE     write a PNG picture: springs coloured by strain, the rest shape behind\n"
    "  --svg FILE         write the same as SVG\n"
    "  --animation FILE   write a moving PNG of how the network comes down\n"
    "  --csv              print one CSV line instead of the table\n"
    "  --csv-header       print the CSV header before it\n"
    "  --help\n"
    "\n"
    "Exit status: 0 if the network settled, 1 if something failed, 2 for a mistake in the arguments.\n";

#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
static bool
wrong(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fputs("bending: ", stderr);
    vfprintf(stderr, format, arguments);
    fputs("; see bending --help\n", stderr);
    va_end(arguments);
    return false;
}

static bool read_number(const char *option, const char *value, double least, double most, double *number) {
    double read = 0;
    if (!number_parse((text_span){value, strlen(value)}, &read) || !(read >= least && read <= most))
        return wrong("%s %s: give a number from %g to %g", option, value, least, most);
    *number = read;
    return true;
}

static bool read_count(const char *option, const char *value, uint64_t least, uint64_t most, uint64_t *number) {
    uint64_t read = 0;
    if (!number_parse_count((text_span){value, strlen(value)}, &read) || read < least || read > most)
        return wrong("%s %s: give a whole number from %llu to %llu", option, value, (unsigned long long)least,
                     (unsigned long long)most);
    *number = read;
    return true;
}

// The widest of this kind of CPU: levels of other kinds are not available.
static mspring_simd best_level(void) {
    mspring_simd best = MSPRING_SIMD_SCALAR;
    for (mspring_simd i = MSPRING_SIMD_SCALAR; i <= MSPRING_SIMD_WASM; i++)
        best = mspring_simd_available(i) ? i : best;
    return best;
}

static bool read_level(const char *value, mspring_simd *level) {
    for (mspring_simd i = MSPRING_SIMD_SCALAR; i <= MSPRING_SIMD_NEON; i++) {
        if (strcmp(value, mspring_simd_name(i)) != 0)
            continue;
        if (!mspring_simd_available(i))
            return wrong("--level %s: this CPU lacks it; its best is %s", value, mspring_simd_name(best_level()));
        *level = i;
        return true;
    }
    return wrong("--level %s: give scalar, sse2, avx2, avx512 or neon", value);
}

static bool read_solver(const char *value, mspring_solver *solver) {
    static const char *const names[] = {"explicit", "implicit", "direct"};
    for (mspring_solver i = MSPRING_SOLVER_EXPLICIT; i <= MSPRING_SOLVER_DIRECT; i++) {
        if (strcmp(value, names[i]) != 0)
            continue;
        *solver = i;
        return true;
    }
    return wrong("--solver %s: give explicit, implicit or direct", value);
}

// Options without a value. Returns false if it is none of them.
static bool read_flag(const char *option, bending_options *options) {
    if (strcmp(option, "--relative") == 0)
        options->scene.relative = true;
    else if (strcmp(option, "--at-once") == 0)
        options->at_once = true;
    else if (strcmp(option, "--csv") == 0)
        options->csv = true;
    else if (strcmp(option, "--csv-header") == 0)
        options->csv = options->csv_header = true;
    else
        return false;
    return true;
}

// Options whose value is a path. Returns NULL if it is none of them.
static const char **find_path(const char *option, bending_options *options) {
    if (strcmp(option, "--materials") == 0)
        return &options->materials;
    if (strcmp(option, "--picture") == 0)
        return &options->picture;
    if (strcmp(option, "--svg") == 0)
        return &options->svg;
    if (strcmp(option, "--animation") == 0)
        return &options->animation;
    if (strcmp(option, "--out") == 0)
        return &options->folder;
    return NULL;
}

static bool is_number_option(const char *option) {
    static const char *const names[] = {"--stiffness", "--damping", "--dt",     "--substeps",  "--steps",
                                        "--gravity",   "--level",   "--solver", "--iterations"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(option, names[i]) == 0)
            return true;
    return false;
}

static bool read_value(const char *option, const char *value, bending_options *options) {
    double number = 0;
    uint64_t count = 0;
    bool ok = true;
    if (strcmp(option, "--level") == 0) {
        ok = read_level(value, &options->level);
    } else if (strcmp(option, "--solver") == 0) {
        ok = read_solver(value, &options->solver);
    } else if (strcmp(option, "--iterations") == 0) {
        ok = read_count(option, value, 1, 10000, &count);
        options->iterations = (uint32_t)count;
    } else if (strcmp(option, "--substeps") == 0) {
        ok = read_count(option, value, 1, 1000000, &count);
        options->substeps = (uint32_t)count;
    } else if (strcmp(option, "--steps") == 0) {
        ok = read_count(option, value, 1, 1000000000000, &options->steps);
    } else if (strcmp(option, "--dt") == 0) {
        ok = read_number(option, value, 1e-12, 1e6, &options->dt);
    } else if (strcmp(option, "--gravity") == 0) {
        ok = read_number(option, value, -1e6, 1e6, &number);
        options->gravity = (float)number;
    } else if (strcmp(option, "--stiffness") == 0) {
        ok = read_number(option, value, 0, 1e30, &number);
        options->scene.stiffness = (float)number;
    } else {
        ok = read_number(option, value, 0, 1e30, &number);
        options->scene.damping = (float)number;
    }
    return ok;
}

static bool read_arguments(int count, char **arguments, bending_options *options) {
    for (int i = 1; i < count; i++) {
        const char *argument = arguments[i];
        if (strncmp(argument, "--", 2) != 0) {
            if (options->input)
                return wrong("two files given, %s and %s: give one", options->input, argument);
            options->input = argument;
            continue;
        }
        if (read_flag(argument, options))
            continue;
        const char **path = find_path(argument, options);
        if (!path && !is_number_option(argument))
            return wrong("there is no option %s", argument);
        if (++i == count)
            return wrong("%s needs a value after it", argument);
        if (path)
            *path = arguments[i];
        else if (!read_value(argument, arguments[i], options))
            return false;
    }
    if (!options->input)
        return wrong("no file given: give an image or a network, such as examples/data/bar_80x5.png");
    if (options->scene.relative && options->scene.stiffness < 0 && !options->materials)
        return wrong("--relative needs --stiffness with a fraction such as 0.5, or --materials with a table of "
                     "fractions");
    if (options->iterations > 0 && options->solver != MSPRING_SOLVER_IMPLICIT)
        return wrong("--iterations is of the implicit solver: add --solver implicit");
    if (options->at_once && options->solver != MSPRING_SOLVER_EXPLICIT)
        return wrong("--at-once steps with no solver: leave --solver out");
    return true;
}

options_outcome options_read(int count, char **arguments, bending_options *options) {
    *options = (bending_options){
        .scene = scene_options_from_file(),
        .dt = 1.0 / 64,
        .steps = 2000000,
        .gravity = 9.8f,
        .level = MSPRING_SIMD_AUTO,
    };
    for (int i = 1; i < count; i++) {
        if (strcmp(arguments[i], "--help") == 0) {
            fputs(help, stdout);
            return OPTIONS_HELP;
        }
    }
    return read_arguments(count, arguments, options) ? OPTIONS_OK : OPTIONS_WRONG;
}
