/// @file check.c
/// Invariants of every network.
///
/// SPDX-License-Identifier: MIT
#include "check.h"

#include <string.h>

#include "step/finite.h"

fuzz_saved fuzz_save(const mspring_network *network) {
    fuzz_saved saved = {NULL, 0};
    FUZZ_CHECK(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &saved.size) == MSPRING_OK);
    saved.bytes = malloc(saved.size);
    FUZZ_CHECK(saved.bytes != NULL);
    FUZZ_CHECK(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, saved.bytes, saved.size, NULL) == MSPRING_OK);
    return saved;
}

// Name the section that differs, for whoever looks into it.
static void tell_difference(const fuzz_saved *a, const fuzz_saved *b, const char *after) {
    size_t at = 0, section = 56;
    while (at < a->size && at < b->size && a->bytes[at] == b->bytes[at])
        at++;
    for (uint64_t size = 0; section + 16 <= a->size; section += 16 + (size_t)(size + 7) / 8 * 8) {
        memcpy(&size, a->bytes + section + 8, sizeof size);
        if (at < section + 16 + (size + 7) / 8 * 8)
            break;
    }
    fprintf(stderr, "after %s: %zu and %zu bytes, which differ at %zu: byte %zu of section %.4s\n", after, a->size,
            b->size, at, at - section - 16, section + 16 <= a->size ? (const char *)a->bytes + section : "none");
}

void fuzz_check_saves(const mspring_network *network, const fuzz_saved *expected, const char *after) {
    const fuzz_saved saved = fuzz_save(network);
    const bool same = saved.size == expected->size && memcmp(saved.bytes, expected->bytes, saved.size) == 0;
    if (!same)
        tell_difference(expected, &saved, after);
    FUZZ_CHECK(same);
    free(saved.bytes);
}

void fuzz_check_network(mspring_network *network) {
    const fuzz_saved saved = fuzz_save(network);
    FUZZ_CHECK(mspringi_is_finite(network));
    const mspring_result result = mspring_network_load(network, saved.bytes, saved.size);
    if (result != MSPRING_OK)
        fprintf(stderr, "%s\n", mspring_network_error(network));
    FUZZ_CHECK(result == MSPRING_OK);
    fuzz_check_saves(network, &saved, "a load");
    free(saved.bytes);
}

// Steps that are shorter and shorter, after which both networks are the same.
static void go_on(mspring_network *network, mspring_network *other) {
    for (double dt = 1e-3; dt > 1e-9; dt *= 0.01) {
        const mspring_result result = mspring_network_step(network, dt);
        FUZZ_CHECK(mspring_network_step(other, dt) == result);
    }
    const fuzz_saved saved = fuzz_save(other);
    fuzz_check_saves(network, &saved, "steps that follow a refused one");
    free(saved.bytes);
}

mspring_result fuzz_step(mspring_network *network, double dt) {
    mspring_network *before = NULL;
    const fuzz_saved saved = fuzz_save(network);
    FUZZ_CHECK(mspring_network_clone(network, NULL, &before) == MSPRING_OK);
    fuzz_check_saves(before, &saved, "cloning");
    const mspring_result result = mspring_network_step(network, dt);
    if (result != MSPRING_OK) {
        fuzz_check_saves(network, &saved, "a refused step");
        go_on(network, before);
    }
    fuzz_check_network(network);
    mspring_network_destroy(before);
    free(saved.bytes);
    return result;
}
