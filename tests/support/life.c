/// @file life.c
///
/// SPDX-License-Identifier: MIT
#include "life.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

enum { MOST_AT_ONCE = 6 };

void life_begin(life *it, const recipe *made, mspring_network *network, uint32_t spare_particles,
                uint32_t spare_springs, uint64_t seed) {
    *it = (life){.network = network,
                 .seed = seed,
                 .spare_particles = spare_particles,
                 .spare_springs = spare_springs,
                 .particle_end = made->particle_count,
                 .spring_end = made->spring_count,
                 .first_spare_particle = made->particle_count,
                 .first_spare_spring = made->spring_count};
    assert_true(made->particle_count + spare_particles <= LIFE_PARTICLES);
    assert_true(made->spring_count + spare_springs <= LIFE_SPRINGS);
    for (uint32_t p = 0; p < made->particle_count; p++) {
        it->has_particle[p] = true;
        it->mass[p] = made->particles[p].mass;
        it->is_pinned[p] = made->particles[p].flags & MSPRING_PARTICLE_PINNED;
    }
    for (uint32_t s = 0; s < made->spring_count; s++) {
        it->has_spring[s] = true;
        it->springs[s].def = made->springs[s];
    }
}

static uint32_t below(life *it, uint32_t end) {
    return (uint32_t)(support_random(&it->seed) % end);
}

/* ---------------------------------------------------------------------------------------------------- choosing */

// A random id of those that are there; MSPRING_NONE if the dice miss.
static mspring_id any_particle(life *it) {
    for (int i = 0; i < 20; i++) {
        const mspring_id p = below(it, it->particle_end);
        if (it->has_particle[p]) {
            return p;
        }
    }
    return MSPRING_NONE;
}

static mspring_id any_spring(life *it) {
    for (int i = 0; i < 20; i++) {
        const mspring_id s = below(it, it->spring_end);
        if (it->has_spring[s]) {
            return s;
        }
    }
    return MSPRING_NONE;
}

static bool are_joined(const life *it, mspring_id a, mspring_id b) {
    for (mspring_id s = 0; s < it->spring_end; s++) {
        const mspring_spring_def *def = &it->springs[s].def;
        if (it->has_spring[s] && ((def->a == a && def->b == b) || (def->a == b && def->b == a))) {
            return true;
        }
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------------ adding */

static void add_particles(life *it, uint32_t count) {
    mspring_particle_def defs[MOST_AT_ONCE] = {{0}};
    mspring_id ids[MOST_AT_ONCE];
    for (uint32_t i = 0; i < count; i++) {
        const double x = support_random_between(&it->seed, -5, 30), y = support_random_between(&it->seed, 8, 16);
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &defs[i], sizeof defs[i]));
        defs[i].x = x;
        defs[i].y = y;
        defs[i].mass = (float)support_random_between(&it->seed, 1, 3);
        defs[i].vx = (float)support_random_between(&it->seed, -1, 1);
        defs[i].flags = below(it, 10) == 0 ? MSPRING_PARTICLE_PINNED : 0;
    }
    if (count > it->spare_particles - it->used_particles) {
        check_error(mspring_network_add_particles(it->network, defs, count, ids), MSPRING_ERROR_LIMIT);
        return;
    }
    check_ok(mspring_network_add_particles(it->network, defs, count, ids));
    it->used_particles += count;
    for (uint32_t i = 0; i < count; i++) {
        assert_in_range(ids[i], it->first_spare_particle, it->first_spare_particle + it->spare_particles - 1);
        assert_false(it->has_particle[ids[i]]);
        it->has_particle[ids[i]] = true;
        it->mass[ids[i]] = defs[i].mass;
        it->is_pinned[ids[i]] = defs[i].flags & MSPRING_PARTICLE_PINNED;
        it->particle_end = ids[i] >= it->particle_end ? ids[i] + 1 : it->particle_end;
    }
}

static void add_spring(life *it) {
    const mspring_id a = any_particle(it), b = any_particle(it);
    const double stiffness = support_random_between(&it->seed, 20, 60);
    const double slack = support_random_between(&it->seed, 0.9, 1.1);
    mspring_spring_def def;
    mspring_id id;
    if (a == MSPRING_NONE || b == MSPRING_NONE) {
        return;
    }
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = a;
    def.b = b;
    def.stiffness = (float)stiffness;
    def.damping = 0.1f;
    if (a == b) {
        check_error(mspring_network_add_springs(it->network, &def, 1, &id),
                    it->used_springs < it->spare_springs ? MSPRING_ERROR_ARGUMENT : MSPRING_ERROR_LIMIT);
        return;
    }
    const support_point at_a = support_position(it->network, a), at_b = support_position(it->network, b);
    const double dx = at_b.x - at_a.x, dy = at_b.y - at_a.y;
    def.rest_length = (float)(slack * sqrt(dx * dx + dy * dy)) + 0.1f;
    const bool joined = are_joined(it, a, b);
    if (it->used_springs == it->spare_springs || joined) {
        check_error(mspring_network_add_springs(it->network, &def, 1, &id),
                    joined && it->used_springs < it->spare_springs ? MSPRING_ERROR_DUPLICATE : MSPRING_ERROR_LIMIT);
        return;
    }
    check_ok(mspring_network_add_springs(it->network, &def, 1, &id));
    assert_in_range(id, it->first_spare_spring, it->first_spare_spring + it->spare_springs - 1);
    assert_false(it->has_spring[id]);
    it->used_springs++;
    it->has_spring[id] = true;
    it->springs[id] = (life_spring){.def = def};
    it->spring_end = id >= it->spring_end ? id + 1 : it->spring_end;
}

void life_add(life *it, uint32_t particles, uint32_t springs) {
    if (particles > 0) {
        add_particles(it, particles);
    }
    for (uint32_t i = 0; i < springs; i++) {
        add_spring(it);
    }
}

/* ---------------------------------------------------------------------------------------------------- removing */

static void forget_spring(life *it, mspring_id s) {
    it->has_spring[s] = false;
    it->gone_springs += s >= it->first_spare_spring;
}

static void remove_spring(life *it, mspring_id s) {
    check_ok(mspring_network_remove_springs(it->network, &s, 0, 1));
    check_error(mspring_network_remove_springs(it->network, &s, 0, 1), MSPRING_ERROR_ID);
    forget_spring(it, s);
}

static void remove_particle(life *it, mspring_id p) {
    check_ok(mspring_network_remove_particles(it->network, &p, 0, 1));
    for (mspring_id s = 0; s < it->spring_end; s++) {
        if (it->has_spring[s] && (it->springs[s].def.a == p || it->springs[s].def.b == p)) {
            forget_spring(it, s);
        }
    }
    it->has_particle[p] = false;
    it->gone_particles += p >= it->first_spare_particle;
}

void life_remove(life *it) {
    const mspring_id p = any_particle(it), s = any_spring(it);
    if (s != MSPRING_NONE && below(it, 2) == 0) {
        remove_spring(it, s);
    } else if (p != MSPRING_NONE && p != 0) {
        remove_particle(it, p);
    }
}

static void recycle(life *it) {
    check_ok(mspring_network_reuse_ids(it->network));
    it->used_particles -= it->gone_particles;
    it->used_springs -= it->gone_springs;
    it->gone_particles = it->gone_springs = 0;
}

/* ---------------------------------------------------------------------------------------------------- whatever */

static void break_or_restore(life *it) {
    const mspring_id s = any_spring(it);
    if (s == MSPRING_NONE) {
        return;
    }
    if (it->springs[s].is_broken) {
        check_ok(mspring_network_restore_springs(it->network, &s, 0, 1, 0));
    } else {
        check_ok(mspring_network_break_springs(it->network, &s, 0, 1));
    }
    it->springs[s].is_broken = !it->springs[s].is_broken;
}

static void edit(life *it) {
    const mspring_id p = any_particle(it), s = any_spring(it);
    if (p == MSPRING_NONE || s == MSPRING_NONE) {
        return;
    }
    it->mass[p] = (float)support_random_between(&it->seed, 1, 3);
    it->springs[s].def.stiffness = (float)support_random_between(&it->seed, 20, 60);
    check_ok(mspring_network_set(it->network, MSPRING_MASS, &p, 0, 1, &it->mass[p], 1));
    check_ok(mspring_network_set(it->network, MSPRING_STIFFNESS, &s, 0, 1, &it->springs[s].def.stiffness, 1));
}

void life_do_something(life *it) {
    switch (below(it, 12)) {
    case 0:
    case 1:
        life_add(it, 1 + below(it, MOST_AT_ONCE), 0);
        break;
    case 2:
    case 3:
    case 4:
    case 5:
        life_add(it, 0, 1 + below(it, MOST_AT_ONCE));
        break;
    case 6:
    case 7:
        life_remove(it);
        break;
    case 8:
    case 9:
        break_or_restore(it);
        break;
    case 10:
        edit(it);
        break;
    default:
        recycle(it);
        break;
    }
}

/* ---------------------------------------------------------------------------------------------------- checking */

static void check_spring(const life *it, mspring_id s) {
    support_spring_info info;
    const mspring_spring_def *def = &it->springs[s].def;
    assert_int_equal(support_has_spring(it->network, s), it->has_spring[s]);
    if (!it->has_spring[s]) {
        check_error(support_get_spring(it->network, s, &info), MSPRING_ERROR_ID);
        return;
    }
    check_ok(support_get_spring(it->network, s, &info));
    assert_int_equal(info.a, def->a);
    assert_int_equal(info.b, def->b);
    assert_int_equal(!(info.flags & MSPRING_SPRING_BROKEN), !it->springs[s].is_broken);
    assert_true(info.nominal_stiffness == def->stiffness && info.rest_length == def->rest_length);
    assert_true(info.stiffness == (it->springs[s].is_broken ? 0.0f : def->stiffness));
}

void life_check(const life *it) {
    mspring_view view = {.struct_size = sizeof view};
    assert_int_equal(mspring_network_count(it->network, MSPRING_PARTICLES), it->particle_end);
    assert_int_equal(mspring_network_count(it->network, MSPRING_SPRINGS), it->spring_end);
    check_ok(mspring_network_get_view(it->network, &view));
    assert_int_equal(view.particle_count, it->particle_end);
    mspring_network_info info;
    check_ok(mspring_init(MSPRING_STRUCT_NETWORK_INFO, &info, sizeof info));
    check_ok(mspring_network_get_info(it->network, &info));
    assert_int_equal(info.particle_room, it->spare_particles - it->used_particles);
    assert_int_equal(info.spring_room, it->spare_springs - it->used_springs);
    // What was broken or removed may keep its place in the layout until the network is compacted.
    const uint32_t laid_out = info.lattice_springs + info.chain_springs + info.irregular_springs;
    uint32_t live = 0;
    for (mspring_id s = 0; s < it->spring_end; s++) {
        live += it->has_spring[s] && !it->springs[s].is_broken;
    }
    assert_in_range(laid_out, live, it->first_spare_spring + it->used_springs - it->gone_springs);
    uint32_t in_slots = 0, there = 0;
    for (uint32_t slot = 0; slot < view.slot_count; slot++) {
        const mspring_id p = view.particle_of_slot[slot];
        in_slots += p != MSPRING_NONE;
        if (p == MSPRING_NONE) {
            assert_true(view.inverse_mass[slot] == 0);
            continue;
        }
        assert_true(p < it->particle_end && it->has_particle[p]);
        assert_int_equal(view.slot_of_particle[p], slot);
    }
    for (mspring_id p = 0; p < it->particle_end; p++) {
        float mass, scale;
        there += it->has_particle[p];
        assert_int_equal(support_has_particle(it->network, p), it->has_particle[p]);
        check_ok(mspring_network_get(it->network, MSPRING_MASS, NULL, p, 1, &mass, 1));
        check_ok(mspring_network_get(it->network, MSPRING_INVERSE_MASS_SCALE, NULL, p, 1, &scale, 1));
        if (it->has_particle[p]) {
            assert_true(mass == it->mass[p] && scale == (it->is_pinned[p] ? 0.0f : 1.0f));
        }
    }
    assert_int_equal(in_slots, there);
    for (mspring_id s = 0; s < it->spring_end; s++) {
        check_spring(it, s);
    }
    assert_false(support_has_particle(it->network, it->particle_end));
    assert_false(support_has_spring(it->network, it->spring_end));
}

recipe life_recipe(const life *it, mspring_id *ids) {
    recipe made = {0};
    mspring_id of[LIFE_PARTICLES];
    for (mspring_id p = 0; p < it->particle_end; p++) {
        if (!it->has_particle[p]) {
            continue;
        }
        const support_point at = support_position(it->network, p), speed = support_velocity(it->network, p);
        ids[made.particle_count] = p;
        of[p] =
            recipe_particle(&made, at.x, at.y, (double)it->mass[p], it->is_pinned[p] ? MSPRING_PARTICLE_PINNED : 0);
        made.particles[of[p]].vx = (float)speed.x;
        made.particles[of[p]].vy = (float)speed.y;
    }
    for (mspring_id s = 0; s < it->spring_end; s++) {
        const mspring_spring_def *def = &it->springs[s].def;
        if (it->has_spring[s] && !it->springs[s].is_broken) {
            const mspring_id id = recipe_spring(&made, of[def->a], of[def->b], (double)def->stiffness,
                                                (double)def->damping, def->flags);
            made.springs[id].rest_length = def->rest_length;
        }
    }
    return made;
}
