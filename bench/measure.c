/// @file measure.c
/// Going through scenes, and measuring one against the naive step.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "modes.h"

#include <massspring/massspring.h>
void bench_complain(const char *about, const scene_error *error) {
    fprintf(stderr, "massspring-bench: %s: %s\n", about, error->text);
}

static bool make_and_visit(const char *name, bool is_file, const bench_options *options, bench_visit_fn visit,
                           void *user) {
    bench_scene subject;
    scene_error error;
    const bench_source source = {.name = name, .is_file = is_file};
    if (!bench_scene_make(&source, &options->settings, &subject, &error)) {
        bench_complain(name, &error);
        return false;
    }
    bool ok = visit(&subject, options, user);
    bench_scene_free(&subject);
    return ok;
}

bool bench_for_each_scene(const bench_options *options, const char *const *otherwise, bench_visit_fn visit,
                          void *user) {
    bool none_named = options->scene_count == 0 && options->network == NULL;
    bool ok = true;
    for (const char *const *name = none_named ? otherwise : options->scenes; *name != NULL; name++) {
        ok = make_and_visit(*name, false, options, visit, user) && ok;
    }
    if (options->network != NULL) {
        ok = make_and_visit(options->network, true, options, visit, user) && ok;
    }
    return ok;
}

// A function pointer does not fit into a void pointer everywhere.
typedef struct level_visit {
    bench_level_fn measure;
} level_visit;

static bool visit_levels(const bench_scene *subject, const bench_options *options, void *user) {
    const level_visit *to = user;
    mspring_simd levels[4];
    scene_error error;
    const int count = bench_options_levels(options, levels, &error);
    bool ok = true;
    for (int i = 0; i < count; i++) {
        ok = to->measure(subject, options, levels[i]) && ok;
    }
    return ok;
}

bool bench_for_each_level(const bench_options *options, const char *const *otherwise, bench_level_fn measure) {
    level_visit to = {measure};
    return bench_for_each_scene(options, otherwise, visit_levels, &to);
}

bool bench_measure(const bench_scene *subject, const bench_options *options, mspring_simd level,
                   bench_measurement *out, scene_error *error) {
    uint32_t springs = mspring_builder_count(subject->made.builder, MSPRING_SPRINGS);
    if (springs == 0) {
        snprintf(error->text, sizeof error->text, "the scene has no springs, and speed is measured per spring");
        return false;
    }
    uint32_t substeps = options->substeps > 0 ? options->substeps : bench_default_substeps(springs);
    uint32_t repeat = options->repeat > 0 ? options->repeat : bench_default_repeat(springs);
    bench_network network;
    if (!bench_network_create(subject->made.builder, level, options->workers, substeps, &network, error)) {
        return false;
    }
    bench_baseline baseline;
    if (!bench_baseline_create(&network, &baseline, error)) {
        bench_network_free(&network);
        return false;
    }
    if (options->sorted && !bench_baseline_sort(&baseline, error)) {
        bench_baseline_free(&baseline);
        bench_network_free(&network);
        return false;
    }
    bench_runner ours = bench_network_runner(&network);
    bench_runner naive = bench_baseline_runner(&baseline);
    bench_measurement result = {
        .particles = network.particle_count,
        .springs = network.spring_count,
        .substeps = substeps,
        .level = bench_level_of(network.network),
    };
    bool ok = bench_turns_measure(&ours, &naive, repeat, &result.turns, error) &&
              bench_network_check(&network, error) && bench_baseline_check(&baseline, error);
    if (ok) {
        result.ns = 1e9 * result.turns.first_median / ((double)springs * substeps);
        result.bytes_per_particle = (double)bench_memory_of(network.network) / network.particle_count;
        *out = result;
    }
    bench_baseline_free(&baseline);
    bench_network_free(&network);
    return ok;
}
