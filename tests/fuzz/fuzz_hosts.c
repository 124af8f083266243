/// @file fuzz_hosts.c
/// A host of tests/hosts that takes its decisions from bytes: any calls of any function, on some networks at once,
/// with memory that fails, chapters that are played twice, and judges after each frame. The second judge is another
/// game: the same one at the best level and with several workers.
///
/// SPDX-License-Identifier: MIT
#include "fuzz.h"
#include "game.h"

enum { MOST_FRAMES = 120 };

static void play(const game_setup *setup, const uint8_t *data, size_t size, uint64_t logs[2]) {
    game *it = game_begin(setup, 0, (draws){.bytes = data, .size = size});
    while (draws_go_on(&it->from) && it->frame < MOST_FRAMES)
        game_frame(it);
    logs[0] = it->log;
    logs[1] = it->events_log;
    game_end(it);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const uint8_t none = 0;
    const uint8_t how = size > 0 ? data[0] : 0;
    const game_setup first = {.level = MSPRING_SIMD_SCALAR,
                              .workers = 1,
                              .fails = how & 1 ? 5 : 0,
                              .looks_back = true},
                     second = {.level = MSPRING_SIMD_AUTO, .workers = 1 + how / 2 % 3, .has_tasks = how & 64};
    uint64_t logs[2][2];
    size = size > 0 ? size - 1 : 0;
    data = size > 0 ? data + 1 : &none;
    play(&first, data, size, logs[0]);
    play(&second, data, size, logs[1]);
    FUZZ_CHECK(logs[0][0] == logs[1][0] && logs[0][1] == logs[1][1]);
    return 0;
}
