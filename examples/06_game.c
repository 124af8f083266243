/// @file 06_game.c
/// A game loop: a ship floats, is hit, takes water, is repaired, breaks, sinks and lies on the sea floor.
///
/// Everything that a game does to its springs is here once: a fixed step behind frames of any length, forces and
/// collisions as hooks, masses that change, springs that break by their strain, events, components, repair.
///
/// SPDX-License-Identifier: MIT
#include "common/output.h"
#include "draw/network_picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 64, HEIGHT = 12, MOST = WIDTH * HEIGHT, MOST_SPRINGS = 4 * MOST, SUBSTEPS = 40, EVENTS = 4096 };

static const double dt = 1.0 / 64;   // of a step, s
static const double duration = 60;   // s
static const double sea_floor = -30; // m; the water's surface is y = 0
static const float displaced = 1000; // kg of water in the volume of a particle
static const float hull_mass = 350;  // kg
static const float drag = 300;       // N s/m of a particle under water
static const float leak = 200;       // kg/s through each broken spring under water

typedef struct game {
    mspring_network *network;
    uint32_t particles, springs;
    float dry[MOST], wet[MOST]; // kg: masses without water and with
    uint32_t piece[MOST];       // component of each particle
    uint32_t piece_count;
    double water[MOST], size[MOST]; // by component: kg in it, particles of it
    uint32_t broken, restored, splits;
} game;

// A call that cannot fail in this program, or it is wrong.
static void must(mspring_result result, const char *what, const game *played) {
    if (result != MSPRING_OK) {
        fprintf(stderr, "%s: %s: %s\n", what, mspring_result_string(result),
                mspring_network_error(played->network));
        exit(EXIT_FAILURE);
    }
}

/* ----------------------------------------------------------------------------------------------------- the world
 */

// Before each step: what is under water is carried by the water that it displaces, and slowed by it.
static void float_hook(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->origin_y + (double)args->y[slot] >= 0 || args->particle_of_slot[slot] == MSPRING_NONE)
            continue;
        args->force_x[slot] -= drag * args->vx[slot];
        args->force_y[slot] += displaced * 9.8f - drag * args->vy[slot];
    }
}

// After every second substep: the sea floor.
static void floor_hook(const mspring_hook_args *args, void *user) {
    const float height = (float)(sea_floor - args->origin_y);
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->y[slot] >= height || args->particle_of_slot[slot] == MSPRING_NONE)
            continue;
        args->y[slot] = height;
        args->vy[slot] = args->vy[slot] < 0 ? -0.2f * args->vy[slot] : args->vy[slot];
        args->vx[slot] *= 0.9f;
    }
}

static mspring_result add_hook(mspring_network *network, mspring_phase phase, mspring_hook_fn fn, uint32_t period) {
    mspring_hook_def def;
    mspring_result result = mspring_hook_def_init(&def, sizeof def);
    def.phase = phase;
    def.fn = fn;
    def.period = period;
    def.flags = MSPRING_HOOK_CONCURRENT;
    return result == MSPRING_OK ? mspring_network_add_hook(network, &def, NULL) : result;
}

/* ------------------------------------------------------------------------------------------------------ the ship
 */

// A hull with a slanted bow and stern, a deck house and a mast.
static bool is_ship(int column, int row) {
    const bool hull = row >= 6 && column >= row - 6 && column < WIDTH - (row - 6);
    const bool house = row >= 3 && row < 6 && column >= 12 && column < 26;
    const bool mast = row < 6 && (column == 40 || column == 41);
    return hull || house || mast;
}

static mspring_result build(mspring_builder *builder) {
    static uint16_t cells[HEIGHT * WIDTH];
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++)
            cells[row * WIDTH + column] = is_ship(column, row) ? 0 : MSPRING_CELL_EMPTY;
    mspring_material hull;
    mspring_lattice_def def;
    mspring_result result = mspring_material_init(&hull, sizeof hull);
    if (result != MSPRING_OK || (result = mspring_lattice_def_init(&def, sizeof def)) != MSPRING_OK)
        return result;
    hull.mass = hull_mass;
    hull.spring_flags = MSPRING_SPRING_RELATIVE;
    hull.stiffness = 0.02f;
    hull.damping = 0.03f;
    def.width = WIDTH;
    def.height = HEIGHT;
    def.y = -2;
    def.cells = cells;
    def.materials = &hull;
    def.material_count = 1;
    return mspring_builder_add_lattice(builder, &def, NULL);
}

static bool start(game *played, mspring_builder *builder) {
    mspring_network_def def;
    float breaking[MOST_SPRINGS];
    if (mspring_network_def_init(&def, sizeof def) != MSPRING_OK || build(builder) != MSPRING_OK)
        return false;
    def.substeps = SUBSTEPS;
    def.worker_count = 2;
    if (mspring_network_create(builder, &def, &played->network) != MSPRING_OK) {
        fprintf(stderr, "cannot make the ship: %s\n", mspring_builder_error(builder));
        return false;
    }
    played->particles = mspring_network_particle_count(played->network);
    played->springs = mspring_network_spring_count(played->network);
    for (uint32_t i = 0; i < played->springs; i++)
        breaking[i] = 0.02f;
    must(mspring_network_set_break_strains(played->network, 0, played->springs, breaking), "strains", played);
    must(mspring_network_reserve_events(played->network, EVENTS), "events", played);
    must(mspring_network_get_masses(played->network, 0, played->particles, played->dry), "masses", played);
    must(add_hook(played->network, MSPRING_PHASE_BEFORE_STEP, float_hook, 1), "float hook", played);
    must(add_hook(played->network, MSPRING_PHASE_AFTER_SUBSTEP, floor_hook, 2), "floor hook", played);
    return true;
}

/* ------------------------------------------------------------------------------------------- what happens to it */

// Throw particles away from (x, y), the nearest most.
static void blast(game *played, double x, double y, double radius, double speed) {
    double px[MOST], py[MOST];
    float vx[MOST], vy[MOST];
    must(mspring_network_get_positions(played->network, 0, played->particles, px, py), "positions", played);
    must(mspring_network_get_velocities(played->network, 0, played->particles, vx, vy), "velocities", played);
    for (uint32_t i = 0; i < played->particles; i++) {
        const double dx = px[i] - x, dy = py[i] - y, distance = sqrt(dx * dx + dy * dy);
        if (distance > radius || distance == 0)
            continue;
        vx[i] += (float)(speed * (1 - distance / radius) * dx / distance);
        vy[i] += (float)(speed * (1 - distance / radius) * dy / distance);
    }
    must(mspring_network_set_velocities(played->network, 0, played->particles, vx, vy), "velocities", played);
}

// Restore every broken spring that is not torn too far, and let it pull its ends together in two seconds.
static void repair(game *played) {
    static mspring_id list[MOST_SPRINGS];
    uint32_t count = 0;
    for (mspring_id s = 0; s < played->springs; s++) {
        mspring_spring_info info = {.struct_size = sizeof info};
        must(mspring_network_get_spring(played->network, s, &info), "spring", played);
        if ((info.flags & MSPRING_SPRING_BROKEN) && info.length < 2 * info.rest_length)
            list[count++] = s;
    }
    must(mspring_network_restore_springs(played->network, list, count, 2.0), "repair", played);
}

// Water comes in through broken springs below the surface and spreads over the piece of ship that they belong to.
static void take_water(game *played) {
    double x[MOST], y[MOST];
    must(mspring_network_get_positions(played->network, 0, played->particles, x, y), "positions", played);
    for (mspring_id s = 0; s < played->springs; s++) {
        mspring_spring_info info = {.struct_size = sizeof info};
        must(mspring_network_get_spring(played->network, s, &info), "spring", played);
        if ((info.flags & MSPRING_SPRING_BROKEN) && y[info.a] < 0)
            played->water[played->piece[info.a]] += (double)leak * dt;
    }
    for (uint32_t i = 0; i < played->particles; i++) {
        const double share = played->water[played->piece[i]] / played->size[played->piece[i]];
        played->wet[i] = played->dry[i] + (float)fmin(share, (double)displaced);
    }
    must(mspring_network_set_masses(played->network, 0, played->particles, played->wet), "masses", played);
}

// Number the pieces anew; each keeps the water of its particles.
static void find_pieces(game *played) {
    uint32_t changed;
    must(mspring_network_update_components(played->network, &played->piece_count, &changed), "pieces", played);
    if (!changed)
        return;
    double water_of[MOST];
    for (uint32_t i = 0; i < played->particles; i++)
        water_of[i] = played->size[played->piece[i]] > 0
                          ? played->water[played->piece[i]] / played->size[played->piece[i]]
                          : 0;
    must(mspring_network_get_component_numbers(played->network, 0, played->particles, played->piece), "pieces",
         played);
    memset(played->water, 0, sizeof played->water);
    memset(played->size, 0, sizeof played->size);
    for (uint32_t i = 0; i < played->particles; i++) {
        played->water[played->piece[i]] += water_of[i];
        played->size[played->piece[i]] += 1;
    }
}

static void read_events(game *played) {
    static mspring_event events[EVENTS];
    uint32_t count;
    must(mspring_network_read_events(played->network, events, EVENTS, &count, NULL), "events", played);
    for (uint32_t i = 0; i < count; i++) {
        played->broken += events[i].kind == MSPRING_EVENT_BROKEN;
        played->restored += events[i].kind == MSPRING_EVENT_RESTORED;
        played->splits += events[i].kind == MSPRING_EVENT_SPLIT;
    }
}

/* ------------------------------------------------------------------------------------------------------ the loop
 */

// One step of the game, whatever the frames.
static void update(game *played, uint32_t step) {
    if (step == 5 * 64)
        blast(played, 20, -4, 8, 50);
    if (step == 8 * 64)
        repair(played);
    if (step == 15 * 64)
        blast(played, 36, -6, 12, 220);
    find_pieces(played);
    take_water(played);
    must(mspring_network_step(played->network, dt), "step", played);
    read_events(played);
}

static void print_state(game *played, double time) {
    static mspring_component pieces[MOST];
    for (uint32_t i = 0; i < played->piece_count; i++)
        pieces[i].struct_size = sizeof pieces[i];
    must(mspring_network_get_components(played->network, 0, played->piece_count, pieces), "pieces", played);
    const mspring_component *largest = pieces;
    for (uint32_t i = 1; i < played->piece_count; i++)
        if (pieces[i].particle_count > largest->particle_count)
            largest = &pieces[i];
    printf("%5.0f s %8u %8u %8u %12.0f t %10.2f m\n", time, played->broken, played->restored, played->piece_count,
           largest->mass / 1000, largest->y);
}

static bool draw(const game *played, const double *x, const double *y, const char *folder, const char *name,
                 const char *title) {
    network_shape shape = {0};
    draw_error error = {""};
    if (!network_shape_make(&shape, played->network, MSPRING_NONE, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return false;
    }
    const world_box box = {-8, sea_floor - 1, WIDTH + 8, 10};
    const network_view view = network_view_fit(&shape, box, 1200, 900, 0.03);
    figure picture;
    figure_start(&picture, view.width, view.height, 0xffffff);
    network_picture_draw(&picture, &shape, &view, x, y, title);
    const bool ok = output_figure(&picture, folder, name);
    figure_free(&picture);
    network_shape_free(&shape);
    return ok;
}

// Frames as a machine that is busy with other things has them: 7 to 30 ms, the same in every run.
static double frame_length(uint32_t frame) {
    return 0.007 + 0.023 * (double)(frame * 2654435769u >> 8) / (double)(1u << 24);
}

static bool play(game *played, const char *folder) {
    static const struct {
        double time;
        const char *name, *title;
    } pictures[] = {{4, "06_game_afloat", "Afloat"},
                    {7, "06_game_hit", "Hit"},
                    {14, "06_game_repaired", "Repaired"},
                    {20, "06_game_broken", "Broken"},
                    {59, "06_game_sunk", "Sunk"}};
    double before_x[MOST], before_y[MOST], x[MOST], y[MOST];
    size_t drawn = 0;
    uint32_t step = 0;
    double accumulated = 0, time = 0;
    printf("   time   broken restored   pieces  largest piece, its centre\n");
    for (uint32_t frame = 0; time < duration; frame++) {
        const double length = frame_length(frame);
        time += length;
        for (accumulated += length; accumulated >= dt; accumulated -= dt) {
            must(mspring_network_get_positions(played->network, 0, played->particles, before_x, before_y),
                 "positions", played);
            update(played, step++);
            if (step % (5 * 64) == 0)
                print_state(played, step * dt);
        }
        if (drawn == sizeof pictures / sizeof *pictures || time < pictures[drawn].time)
            continue;
        // What is shown lies between the last two steps.
        must(mspring_network_get_positions(played->network, 0, played->particles, x, y), "positions", played);
        for (uint32_t i = 0; i < played->particles; i++) {
            x[i] = before_x[i] + (x[i] - before_x[i]) * accumulated / dt;
            y[i] = before_y[i] + (y[i] - before_y[i]) * accumulated / dt;
        }
        if (!draw(played, x, y, folder, pictures[drawn].name, pictures[drawn].title))
            return false;
        drawn++;
    }
    uint64_t hash;
    must(mspring_network_state_hash(played->network, &hash), "hash", played);
    printf("state after %u steps: %016llx\n", step, (unsigned long long)hash);
    return true;
}

int main(int count, char **arguments) {
    static game played;
    int exit_code = EXIT_SUCCESS;
    const char *folder = output_folder_from_arguments(
        count, arguments, "06_game: a ship floats, is hit, repaired, broken, and sinks.", &exit_code);
    if (!folder)
        return exit_code;
    mspring_builder *builder = NULL;
    if (mspring_builder_create(NULL, &builder) != MSPRING_OK)
        return EXIT_FAILURE;
    bool ok = start(&played, builder);
    mspring_builder_destroy(builder);
    ok = ok && play(&played, folder);
    mspring_network_destroy(played.network);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
