#include "same.h"

void same_at_all_levels(const same_scene *scene, mspring_network_def def) {
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    uint64_t hash = 0;
    for (uint32_t i = 0; i < 2 * count; i++) {
        def.simd_level = levels[i / 2];
        def.worker_count = 1 + 2 * (i % 2);
        mspring_network *network = scene->make(def);
        scene->go_on(network);
        assert_true(i == 0 || support_hash(network) == hash);
        hash = support_hash(network);
        mspring_network_destroy(network);
    }
}

static void step_both(mspring_network *one, mspring_network *other, uint32_t count) {
    support_steps(one, count, 1.0 / 64);
    support_steps(other, count, 1.0 / 64);
}

mspring_network *same_in_copies(const same_scene *scene, mspring_network_def def, double tolerance) {
    mspring_network *network = scene->make(def), *young = scene->make(def), *clone;
    mspring_job *job = NULL;
    scene->go_on(network);
    support_bring(network, young, MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_clone(network, NULL, &clone));
    support_steps(clone, 20, 1.0 / 64);
    step_both(network, young, 20);
    assert_true(support_hash(network) == support_hash(young));
    assert_true(support_hash(network) == support_hash(clone));
    support_steps(clone, 3, 1.0 / 64);
    support_bring(network, clone, MSPRING_SNAPSHOT_FRAME);
    step_both(network, clone, 5);
    assert_true(support_hash(network) == support_hash(clone));
    support_compact(clone, 0, &job);
    assert_null(job);
    step_both(network, clone, 5);
    for (mspring_id p = 0; p < mspring_network_count(network, MSPRING_PARTICLES); p += 7)
        check_near(support_position(network, p).y, support_position(clone, p).y, tolerance);
    mspring_network_destroy(young);
    mspring_network_destroy(clone);
    return network;
}
