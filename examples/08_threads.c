/// @file 08_threads.c
/// A host's own threads step a network: lent by one function, and the bits stay the same whatever their number.
///
/// SPDX-License-Identifier: MIT
#include "common/check.h"
#include "common/clock.h"
#include "common/thread_pool.h"

#include <massspring/massspring.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum { COLUMNS = 400, ROWS = 100, STEPS = 64, MOST_THREADS = 4 };

// A bar that hangs on its left end, 79,000 springs: enough for a step to be worth dividing.
static void add_bar(mspring_builder *builder) {
    static uint16_t cells[ROWS][COLUMNS];
    mspring_material iron[2]; // 0 is free, 1 is pinned
    for (int i = 0; i < 2; i++) {
        iron[i] = mspring_material_default();
        iron[i].mass = 70.0f;
        iron[i].stiffness = 3e7f;
        iron[i].damping = 500.0f;
    }
    iron[1].particle_flags = MSPRING_PARTICLE_PINNED;
    for (int row = 0; row < ROWS; row++)
        cells[row][0] = 1;
    mspring_lattice_def bar = mspring_lattice_def_default();
    bar.width = COLUMNS;
    bar.height = ROWS;
    bar.cells = cells[0];
    bar.materials = iron;
    bar.material_count = 2;
    mspring_builder_add_lattice(builder, &bar, NULL);
}

// A second of it, with the threads of a pool: milliseconds for a step, and the hash of what comes out.
static bool run(mspring_builder *builder, thread_pool *pool, double *milliseconds, uint64_t *hash) {
    const mspring_tasks tasks = thread_pool_tasks(pool);
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 20;
    def.tasks = &tasks; // without it, worker_count gives the network threads of the library's
    mspring_network *network = NULL;
    mspring_result result = mspring_network_create(builder, &def, &network);
    if (!check(result, "make the network", mspring_builder_error(builder)))
        return false;
    const double begun = clock_seconds();
    for (int step = 0; result == MSPRING_OK && step < STEPS; step++)
        result = mspring_network_step(network, 1.0 / 64);
    *milliseconds = (clock_seconds() - begun) * 1e3 / STEPS;
    if (result == MSPRING_OK)
        result = mspring_network_get_state_hash(network, hash);
    const bool ok = check(result, "step", mspring_network_error(network));
    mspring_network_destroy(network);
    return ok;
}

int main(void) {
    mspring_builder *builder = NULL;
    const mspring_result result = mspring_builder_create(NULL, &builder);
    if (!check(result, "make a builder", ""))
        return EXIT_FAILURE;
    add_bar(builder); // if this failed, no network could be made
    uint64_t first_hash = 0;
    bool ok = true, same = true;
    for (uint32_t threads = 1; ok && threads <= MOST_THREADS; threads++) {
        // It stands for the job system of an engine; what the library wants of that is one parallel-for.
        thread_pool *pool = thread_pool_create(threads);
        double milliseconds = 0.0;
        uint64_t hash = 0;
        ok = pool && run(builder, pool, &milliseconds, &hash);
        if (ok)
            printf("%u thread%s   %6.2f ms a step   lent %4llu times   state %016llx\n", (unsigned)threads,
                   threads == 1 ? " " : "s", milliseconds, (unsigned long long)thread_pool_runs(pool),
                   (unsigned long long)hash);
        else if (!pool)
            fprintf(stderr, "cannot start %u threads\n", (unsigned)threads);
        first_hash = threads == 1 ? hash : first_hash;
        same = same && hash == first_hash;
        thread_pool_destroy(pool);
    }
    mspring_builder_destroy(builder);
    if (ok && !same)
        fprintf(stderr, "the states differ, which they must not\n");
    return ok && same ? EXIT_SUCCESS : EXIT_FAILURE;
}
