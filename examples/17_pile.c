/// @file 17_pile.c
/// Five hundred fragments fall into a pit, pile up and fall asleep.
///
/// SPDX-License-Identifier: MIT
#include "common/progress.h"
#include "common/show.h"
#include "scenes/scene.h"

#include <massspring/massspring.h>
#include <stdio.h>

enum { FRAGMENTS = 500, STEPS = 64 * 40, FILMED = 64 * 8 };

int main(int count, char **arguments) {
    const double dt = 1.0 / 64; // s
    scene_options options = scene_options_default();
    options.damping = 4000; // N s/m
    scene pile;
    scene_error error;
    if (!scene_pile(FRAGMENTS, &options, &pile, &error)) {
        fprintf(stderr, "17_pile: %s\n", error.text);
        return 1;
    }
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 40, def.settings.global_damping = 0.5f;  // 1/s
    def.settings.sleep_speed = 0.1f, def.settings.sleep_time = 0.5f; // m/s, s
    mspring_network *network = NULL;
    mspring_result result = mspring_network_create(pile.builder, &def, &network);
    mspring_contact_def contact = mspring_contact_def_default();
    contact.flags = 0; // a fragment is too firm to meet itself
    contact.friction = 0.5f;
    result = result ? result : mspring_network_set_contact(network, &contact);
    show shown;
    show_begin(&shown, count, arguments, "17_pile", "Fragments pile up.", network, 0.02);
    progress line;
    progress_start(&line);
    int step = 0;
    mspring_step_info info = mspring_step_info_default();
    for (; !result && step < STEPS && !info.is_asleep; step++) {
        result = mspring_network_step(network, dt);
        mspring_network_get_step_info(network, &info);
        if (step < FILMED)
            show_step(&shown, network);
        if (progress_due(&line)) {
            char text[40];
            snprintf(text, sizeof text, "second %.0f of at most %d", step * dt, STEPS / 64);
            progress_write(&line, text);
        }
    }
    progress_clear(&line);
    printf("%d fragments %s after %.1f s\n", FRAGMENTS, step < STEPS ? "are asleep" : "still move", step * dt);
    const int code = show_end(&shown, result, pile.builder, network);
    pile.builder = NULL; // the show is over for both
    scene_free(&pile);
    return code;
}
