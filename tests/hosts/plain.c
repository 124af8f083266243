/// @file plain.c
/// The plain list beside a network.
///
/// SPDX-License-Identifier: MIT
#include "plain.h"

#include <string.h>

// All flags of springs, for one place at a time.
static uint32_t flags[MOST_SPRINGS];

static void read_flags(const game *it, const place *p) {
    JUDGE(it, mspring_network_get_integers(p->network, MSPRING_SPRING_FLAGS, NULL, 0, p->plain->springs, flags, 1) == MSPRING_OK);
}

void place_learn(game *it, place *p) {
    plain *list = p->plain;
    memset(list, 0, sizeof *list);
    list->particles = mspring_network_count(p->network, MSPRING_PARTICLES);
    list->springs = mspring_network_count(p->network, MSPRING_SPRINGS);
    JUDGE(it, list->particles + 64 <= MOST_PARTICLES && list->springs + 64 <= MOST_SPRINGS);
    read_flags(it, p);
    JUDGE(it, mspring_network_get(p->network, MSPRING_MASS, NULL, 0, list->particles, list->mass, 1) == MSPRING_OK);
    JUDGE(it,
          mspring_network_get(p->network, MSPRING_STIFFNESS, NULL, 0, list->springs, list->stiffness, 1) == MSPRING_OK);
    JUDGE(it, mspring_network_get_columns(p->network, NULL, 0, list->springs, (const mspring_column[]){{MSPRING_END_A, 2, &list->ends[0][0]}, {MSPRING_END_B, 2, &list->ends[0][1]}}, 2) == MSPRING_OK);
    for (mspring_id i = 0; i < list->particles; i++)
        list->has_particle[i] = support_has_particle(p->network, i);
    for (mspring_id i = 0; i < list->springs; i++) {
        list->has_spring[i] = support_has_spring(p->network, i);
        list->is_broken[i] = flags[i] & MSPRING_SPRING_BROKEN;
    }
}

void place_learn_breaks(game *it, place *p) {
    plain *list = p->plain;
    read_flags(it, p);
    for (mspring_id i = 0; i < list->springs; i++) {
        const bool now = flags[i] & MSPRING_SPRING_BROKEN;
        JUDGE(it, now == list->is_broken[i] || (now && p->stepped == MSPRING_OK));
        JUDGE(it, ((flags[i] & MSPRING_SPRING_REMOVED) != 0) == !list->has_spring[i]);
        list->is_broken[i] = now;
    }
}

void plain_learn_restored(game *it, place *p) {
    read_flags(it, p);
    for (mspring_id i = 0; i < p->plain->springs; i++)
        p->plain->is_broken[i] = flags[i] & MSPRING_SPRING_BROKEN;
}

void plain_break(plain *list, mspring_id spring) {
    list->is_broken[spring] = true;
}

void plain_remove_spring(plain *list, mspring_id spring) {
    list->has_spring[spring] = false;
    list->is_broken[spring] = true;
    list->ends[spring][0] = list->ends[spring][1] = MSPRING_NONE;
    list->stiffness[spring] = 0;
}

static bool is_at(const plain *list, mspring_id spring, mspring_id particle) {
    return list->has_spring[spring] && (list->ends[spring][0] == particle || list->ends[spring][1] == particle);
}

void plain_detach(plain *list, mspring_id particle) {
    for (mspring_id i = 0; i < list->springs; i++)
        if (is_at(list, i, particle))
            list->is_broken[i] = true;
}

void plain_remove_particle(plain *list, mspring_id particle) {
    for (mspring_id i = 0; i < list->springs; i++)
        if (is_at(list, i, particle))
            plain_remove_spring(list, i);
    list->has_particle[particle] = false;
    list->mass[particle] = 0;
}

void plain_add_particle(game *it, plain *list, mspring_id particle, float mass) {
    JUDGE(it, particle < MOST_PARTICLES && !list->has_particle[particle]);
    list->has_particle[particle] = true;
    list->mass[particle] = mass;
    if (list->particles <= particle)
        list->particles = particle + 1;
}

void plain_add_spring(game *it, plain *list, mspring_id spring, const mspring_spring_def *def) {
    JUDGE(it, spring < MOST_SPRINGS && !list->has_spring[spring]);
    list->has_spring[spring] = true;
    list->is_broken[spring] = false;
    list->breaks_by_events[spring] = false;
    list->ends[spring][0] = def->a, list->ends[spring][1] = def->b;
    list->stiffness[spring] = def->stiffness;
    if (list->springs <= spring)
        list->springs = spring + 1;
}
