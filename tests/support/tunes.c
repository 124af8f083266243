/// A clock that tests turn, and what they tune.
#include "tunes.h"

#include <string.h>

#include "support.h"

static double read_watch(void *user) {
    tunes_watch *w = user;
    return w->now += w->tick;
}

uint32_t tunes_tell(double done, void *user) {
    tunes_watch *w = user;
    w->went_back = w->went_back || done < w->done || done > 1;
    w->done = done;
    return ++w->told != w->limit;
}

mspring_tune_def tunes_def(tunes_watch *w) {
    mspring_tune_def def;
    check_ok(mspring_init(MSPRING_STRUCT_TUNE_DEF, &def, sizeof def));
    def.clock = read_watch;
    def.user = w;
    def.budget = 1e6;
    return def;
}

mspring_settings tunes_setting(mspring_solver solver, uint32_t substeps, uint32_t iterations) {
    mspring_settings def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    def.solver = solver;
    def.substeps = substeps;
    def.iterations = iterations;
    def.residual = 0;
    return def;
}

void tunes_clear(tunes_table *out) {
    memset(out, 0, sizeof *out);
    for (int i = 0; i < TUNES_MOST; i++) {
        out->rows[i].struct_size = sizeof out->rows[i];
    }
}

tunes_table tunes_run(mspring_network *network, const mspring_tune_def *def) {
    tunes_table out;
    tunes_clear(&out);
    const mspring_result result = mspring_network_tune(network, def, out.rows, TUNES_MOST, &out.count);
    if (result != MSPRING_OK) {
        print_error("%s\n", mspring_network_error(network));
    }
    check_ok(result);
    return out;
}

bool tunes_has(const mspring_tune_row *row, uint32_t flags) {
    return (row->flags & flags) == flags;
}

recipe tunes_bar_recipe(uint32_t width, uint32_t height, double stiffness, double damping, uint32_t flags) {
    recipe made = {0};
    uint64_t seed = 1;
    const recipe_stuff stuff = {.mass = {70, 70},
                                .stiffness = {stiffness, stiffness},
                                .damping = {damping, damping},
                                .spring_flags = flags};
    const mspring_id first = recipe_lattice(&made, width, height, 0, 0, 1, &stuff, &seed);
    for (uint32_t row = 0; row < height; row++) {
        made.particles[first + row * width].flags = MSPRING_PARTICLE_PINNED;
    }
    return made;
}

mspring_network *tunes_bar(double stiffness, double damping, uint32_t flags, const mspring_network_def *def) {
    recipe made = tunes_bar_recipe(14, 3, stiffness, damping, flags);
    mspring_network *network = recipe_network(&made, def);
    recipe_free(&made);
    return network;
}
