/// @file test_golden.c
/// Every scene ends in the state that golden/hashes.txt has for it: at every level, with every compiler and at
/// every optimisation level.
///
///     test_golden LEVEL golden/hashes.txt           checks
///     test_golden LEVEL golden/hashes.txt 2         checks with so many workers
///     test_golden LEVEL golden/hashes.txt --write   writes the file anew, after a change that is meant to alter
///     the
///                                                   bits; say in the commit why
///
/// SPDX-License-Identifier: MIT
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "golden.h"
#include "level.h"
#include "support.h"

static mspring_simd level;
static uint32_t workers = 1;
static const char *file_name;

/// The hash that the file has for a scene.
static bool read_hash(const char *name, uint64_t *hash) {
    char line[200], found[100];
    FILE *file = fopen(file_name, "r");
    assert_non_null(file);
    bool seen = false;
    while (!seen && fgets(line, sizeof line, file) != NULL) {
        seen = sscanf(line, "%99s %" SCNx64, found, hash) == 2 && strcmp(found, name) == 0;
    }
    fclose(file);
    return seen;
}

static void every_scene_has_its_hash(void **state) {
    (void)state;
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < golden_scene_count; i++) {
        const golden_scene *scene = &golden_scenes[i];
        if (scene->make == NULL) {
            print_message("%s: skipped, this build reads no PNG (libstb-dev)\n", scene->name);
            continue;
        }
        if (scene->takes_long && getenv("MASSSPRING_TEST_SHORT_SCENES") != NULL) {
            print_message("%s: left out, it takes long\n", scene->name);
            continue;
        }
        uint64_t expected = 0, hash = golden_run(scene, level, workers);
        bool known = read_hash(scene->name, &expected);
        if (!known || hash != expected) {
            print_error("%s at %s: %016" PRIx64 ", in the file: %016" PRIx64 "%s\n", scene->name,
                        mspring_simd_name(level), hash, expected, known ? "" : " (missing)");
            wrong++;
        }
    }
    assert_int_equal(wrong, 0);
}

static void every_hash_is_that_of_a_scene(void **state) {
    (void)state;
    char line[200], found[100];
    uint32_t count = 0;
    FILE *file = fopen(file_name, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) != NULL) {
        if (line[0] != '#' && sscanf(line, "%99s", found) == 1) {
            bool known = false;
            for (uint32_t i = 0; i < golden_scene_count; i++) {
                known = known || strcmp(golden_scenes[i].name, found) == 0;
            }
            if (!known) {
                print_error("no scene %s\n", found);
            }
            assert_true(known);
            count++;
        }
    }
    fclose(file);
    assert_int_equal(count, golden_scene_count);
}

static int write_hashes(void) {
    for (uint32_t i = 0; i < golden_scene_count; i++) {
        if (golden_scenes[i].make == NULL) {
            fprintf(stderr, "this build cannot make %s: it reads no PNG (libstb-dev)\n", golden_scenes[i].name);
            return 1;
        }
    }
    FILE *file = fopen(file_name, "w");
    if (file == NULL) {
        perror(file_name);
        return 1;
    }
    fprintf(file,
            "# State hashes of the scenes in tests/kernels/golden.c, the same at every SIMD level, with every "
            "compiler\n"
            "# and at every optimisation level. Written by: test_golden scalar tests/golden/hashes.txt --write\n");
    for (uint32_t i = 0; i < golden_scene_count; i++) {
        fprintf(file, "%s %016" PRIx64 "\n", golden_scenes[i].name, golden_run(&golden_scenes[i], level, workers));
    }
    return fclose(file) == 0 ? 0 : 1;
}

int main(int argc, char **argv) {
    level = level_from_arguments(argc, argv);
    if (argc < 3) {
        fprintf(stderr, "usage: %s LEVEL hashes.txt [--write]\n", argv[0]);
        return 2;
    }
    file_name = argv[2];
    if (argc > 3 && strcmp(argv[3], "--write") == 0) {
        return write_hashes();
    }
    workers = argc > 3 ? (uint32_t)strtoul(argv[3], NULL, 10) : 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_has_its_hash),
        cmocka_unit_test(every_hash_is_that_of_a_scene),
    };
    return cmocka_run_group_tests_name("golden", tests, NULL, NULL);
}
