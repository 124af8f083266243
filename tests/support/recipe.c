/// @file recipe.c
///
/// SPDX-License-Identifier: MIT
#include "recipe.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "support.h"

void recipe_free(recipe *made) {
    free(made->particles);
    free(made->springs);
    *made = (recipe){0};
}

mspring_id recipe_particle(recipe *made, double x, double y, double mass, uint32_t flags) {
    if (made->particle_count == made->particle_room) {
        made->particle_room = made->particle_room * 2 + 64;
        made->particles = realloc(made->particles, made->particle_room * sizeof *made->particles);
        assert_non_null(made->particles);
    }
    mspring_particle_def *def = &made->particles[made->particle_count];
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, def, sizeof *def));
    def->x = x;
    def->y = y;
    def->mass = (float)mass;
    def->flags = flags;
    return made->particle_count++;
}

mspring_id recipe_spring(recipe *made, mspring_id a, mspring_id b, double stiffness, double damping,
                         uint32_t flags) {
    if (made->spring_count == made->spring_room) {
        made->spring_room = made->spring_room * 2 + 64;
        made->springs = realloc(made->springs, made->spring_room * sizeof *made->springs);
        assert_non_null(made->springs);
    }
    mspring_spring_def *def = &made->springs[made->spring_count];
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, def, sizeof *def));
    def->a = a;
    def->b = b;
    def->stiffness = (float)stiffness;
    def->damping = (float)damping;
    def->flags = flags;
    return made->spring_count++;
}

static mspring_id add_particle(recipe *made, double x, double y, const recipe_stuff *stuff, uint64_t *seed) {
    bool pinned = support_random_between(seed, 0, 1) < stuff->pinned;
    return recipe_particle(made, x, y, support_random_between(seed, stuff->mass[0], stuff->mass[1]),
                           pinned ? MSPRING_PARTICLE_PINNED : 0);
}

static mspring_id add_spring(recipe *made, mspring_id a, mspring_id b, const recipe_stuff *stuff, uint64_t *seed) {
    double stiffness = support_random_between(seed, stuff->stiffness[0], stuff->stiffness[1]);
    double damping = support_random_between(seed, stuff->damping[0], stuff->damping[1]);
    return recipe_spring(made, a, b, stiffness, damping, stuff->spring_flags);
}

mspring_id recipe_lattice(recipe *made, uint32_t width, uint32_t height, double x, double y, double spacing,
                          const recipe_stuff *stuff, uint64_t *seed) {
    mspring_id first = made->particle_count;
    mspring_id *ids = malloc((size_t)width * height * sizeof *ids);
    assert_non_null(ids);
    for (uint32_t row = 0; row < height; row++) {
        for (uint32_t column = 0; column < width; column++) {
            bool hole = support_random_between(seed, 0, 1) < stuff->holes;
            ids[row * width + column] =
                hole ? MSPRING_NONE : add_particle(made, x + column * spacing, y + row * spacing, stuff, seed);
        }
    }
    for (uint32_t row = 0; row < height; row++) {
        for (uint32_t column = 0; column < width; column++) {
            // East, north-west, north, north-east: with the same from the other side, all eight.
            const int steps[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
            for (int i = 0; i < 4; i++) {
                int64_t to_column = (int64_t)column + steps[i][0], to_row = (int64_t)row + steps[i][1];
                if (to_column < 0 || to_column >= width || to_row >= height) {
                    continue;
                }
                mspring_id a = ids[row * width + column], b = ids[to_row * width + to_column];
                if (a != MSPRING_NONE && b != MSPRING_NONE) {
                    add_spring(made, a, b, stuff, seed);
                }
            }
        }
    }
    free(ids);
    return first;
}

mspring_id recipe_rope(recipe *made, mspring_id from, mspring_id to, uint32_t segments, const recipe_stuff *stuff,
                       uint64_t *seed) {
    mspring_id first = made->particle_count, last = from;
    double x = made->particles[from].x, y = made->particles[from].y;
    double dx = made->particles[to].x - x, dy = made->particles[to].y - y;
    for (uint32_t i = 1; i < segments; i++) {
        double t = (double)i / segments;
        mspring_id next = add_particle(made, x + dx * t, y + dy * t, stuff, seed);
        add_spring(made, last, next, stuff, seed);
        last = next;
    }
    add_spring(made, last, to, stuff, seed);
    return first;
}

static bool joined(const recipe *made, mspring_id a, mspring_id b) {
    for (uint32_t i = 0; i < made->spring_count; i++) {
        const mspring_spring_def *spring = &made->springs[i];
        if ((spring->a == a && spring->b == b) || (spring->a == b && spring->b == a)) {
            return true;
        }
    }
    return false;
}

static mspring_id random_id(const recipe *made, uint64_t *seed) {
    return (mspring_id)(support_random(seed) % made->particle_count);
}

void recipe_random_springs(recipe *made, uint32_t count, const recipe_stuff *stuff, uint64_t *seed) {
    while (count > 0) {
        mspring_id a = random_id(made, seed), b = random_id(made, seed);
        if (a != b && !joined(made, a, b)) {
            add_spring(made, a, b, stuff, seed);
            count--;
        }
    }
}

void recipe_disturb(recipe *made, double distance, double speed, uint64_t *seed) {
    for (uint32_t i = 0; i < made->spring_count; i++) {
        mspring_spring_def *spring = &made->springs[i];
        if (spring->rest_length == MSPRING_REST_LENGTH_DISTANCE) {
            const mspring_particle_def *a = &made->particles[spring->a], *b = &made->particles[spring->b];
            // No hypot(): its last bit is not the same in every C library.
            double dx = b->x - a->x, dy = b->y - a->y;
            spring->rest_length = (float)sqrt(dx * dx + dy * dy);
        }
    }
    for (uint32_t i = 0; i < made->particle_count; i++) {
        mspring_particle_def *particle = &made->particles[i];
        particle->x += support_random_between(seed, -distance, distance);
        particle->y += support_random_between(seed, -distance, distance);
        if ((particle->flags & MSPRING_PARTICLE_PINNED) == 0) {
            particle->vx = (float)support_random_between(seed, -speed, speed);
            particle->vy = (float)support_random_between(seed, -speed, speed);
        }
    }
}

void recipe_shuffle(recipe *made, uint64_t *seed, mspring_id *new_ids) {
    uint32_t count = made->particle_count;
    mspring_id *old_of_new = malloc(count * sizeof *old_of_new);
    mspring_id *new_of_old = malloc(count * sizeof *new_of_old);
    mspring_particle_def *particles = malloc(count * sizeof *particles);
    assert_true(old_of_new != NULL && new_of_old != NULL && particles != NULL);
    for (uint32_t i = 0; i < count; i++) {
        old_of_new[i] = i;
    }
    for (uint32_t i = count; i > 1; i--) {
        uint32_t j = (uint32_t)(support_random(seed) % i);
        mspring_id swapped = old_of_new[i - 1];
        old_of_new[i - 1] = old_of_new[j];
        old_of_new[j] = swapped;
    }
    for (uint32_t i = 0; i < count; i++) {
        particles[i] = made->particles[old_of_new[i]];
        new_of_old[old_of_new[i]] = i;
        if (new_ids != NULL) {
            new_ids[old_of_new[i]] = i;
        }
    }
    for (uint32_t i = made->spring_count; i > 0; i--) {
        uint32_t j = (uint32_t)(support_random(seed) % i);
        mspring_spring_def spring = made->springs[j];
        made->springs[j] = made->springs[i - 1];
        mspring_id a = new_of_old[spring.a], b = new_of_old[spring.b];
        bool turn = support_random(seed) & 1;
        spring.a = turn ? b : a;
        spring.b = turn ? a : b;
        made->springs[i - 1] = spring;
    }
    free(old_of_new);
    free(new_of_old);
    free(made->particles);
    made->particles = particles;
    made->particle_room = count;
}

recipe recipe_of_shape(const recipe_shape *shape, double stiffness, double mass_ratio) {
    uint64_t seed = 21;
    const recipe_stuff stuff = {.mass = {1, mass_ratio},
                                .stiffness = {stiffness, stiffness},
                                .damping = {shape->damping, shape->damping},
                                .holes = shape->rope > 0 ? 0.1 : 0};
    const uint32_t held = shape->hangs ? MSPRING_PARTICLE_PINNED : 0;
    recipe made = {0};
    if (shape->width > 0) {
        recipe_lattice(&made, shape->width, shape->height, 0, 0, 1, &stuff, &seed);
        for (uint32_t row = 0; shape->hangs && row < shape->height; row++) {
            made.particles[row * shape->width].flags = MSPRING_PARTICLE_PINNED;
        }
    }
    for (uint32_t i = 0; i < shape->particles; i++) {
        const double x = support_random_between(&seed, 0, 30), y = support_random_between(&seed, -40, -10);
        const double mass = exp(support_random_between(&seed, 0, log(mass_ratio)));
        recipe_particle(&made, x, y, mass, 0);
    }
    recipe_random_springs(&made, shape->springs, &stuff, &seed);
    if (shape->rope > 0) {
        const mspring_id start = shape->width > 0 ? 0 : recipe_particle(&made, -70, 50, 2, MSPRING_PARTICLE_PINNED);
        const mspring_id end = recipe_particle(&made, 3, 50, 2, held);
        recipe_rope(&made, start, end, shape->rope, &stuff, &seed);
    }
    recipe_disturb(&made, 1e-3, 0.01, &seed);
    return made;
}

mspring_builder *recipe_builder(const recipe *made, const mspring_allocator *allocator) {
    mspring_builder *builder = NULL;
    check_ok(mspring_builder_create(allocator, &builder));
    mspring_result result = mspring_builder_add_particles(builder, made->particles, made->particle_count, NULL);
    if (result == MSPRING_OK && made->spring_count > 0) {
        result = mspring_builder_add_springs(builder, made->springs, made->spring_count, NULL);
    }
    if (result != MSPRING_OK) {
        print_error("%s\n", support_builder_error(builder));
    }
    check_ok(result);
    return builder;
}

mspring_network *recipe_network(const recipe *made, const mspring_network_def *def) {
    return support_network(recipe_builder(made, NULL), def);
}

mspring_network *recipe_solved(const recipe *made, const mspring_network_def *def, mspring_solver solver,
                               mspring_integrator integrator) {
    mspring_network *network = recipe_network(made, def);
    mspring_settings settings;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &settings, sizeof settings));
    settings.solver = solver;
    settings.integrator = integrator;
    check_ok(support_set_solver(network, &settings));
    return network;
}

recipe recipe_bar(uint32_t columns, uint32_t rows, double stiffness) {
    uint64_t seed = 1;
    const recipe_stuff iron = {.mass = {73.3975, 73.3975}, .stiffness = {stiffness, stiffness}};
    recipe made = {0};
    recipe_lattice(&made, columns, rows, 0, 0, 1, &iron, &seed);
    for (uint32_t row = 0; row < rows; row++) {
        made.particles[row * columns].flags = MSPRING_PARTICLE_PINNED;
    }
    return made;
}

recipe recipe_rows(uint64_t seed, uint32_t spring_flags, double least, double most) {
    const bool relative = spring_flags & MSPRING_SPRING_RELATIVE;
    const double scale = relative ? 0.01 : 1;
    const recipe_stuff stuff = {.mass = {1, 2},
                                .stiffness = {relative ? 0.1 : 500, relative ? 0.2 : 1000},
                                .damping = {scale * least, scale * most},
                                .spring_flags = spring_flags,
                                .holes = 0.1};
    recipe made = {0};
    recipe_lattice(&made, 37, 9, 0, 0, 1, &stuff, &seed);
    const mspring_id end = recipe_particle(&made, 60, 20, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 2, end, 30, &stuff, &seed);
    recipe_random_springs(&made, 12, &stuff, &seed);
    recipe_disturb(&made, 0.05, 0.5, &seed);
    return made;
}

recipe recipe_mixed(uint64_t seed) {
    const recipe_stuff relative = {.mass = {1, 2},
                                   .stiffness = {0.1, 0.2},
                                   .damping = {0, 0.1},
                                   .spring_flags = MSPRING_SPRING_RELATIVE,
                                   .pinned = 0.02,
                                   .holes = 0.2};
    const recipe_stuff absolute = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}};
    recipe made = {0};
    recipe_lattice(&made, 19, 6, 0, 0, 1, &relative, &seed);
    const mspring_id other = recipe_lattice(&made, 7, 4, 40, 0.5, 1, &absolute, &seed);
    recipe_rope(&made, 2, other, 9, &absolute, &seed);
    recipe_random_springs(&made, 8, &absolute, &seed);
    recipe_particle(&made, 5, 20, 1, 0);
    recipe_disturb(&made, 0.05, 0.5, &seed);
    return made;
}
