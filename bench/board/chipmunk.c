/// @file chipmunk.c
/// Chipmunk 7: a body for each particle, a damped spring without damping for each spring.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include <chipmunk/chipmunk.h>

#include "board/methods.h"

typedef struct space {
    cpSpace *engine;
    cpBody **bodies;        ///< [particle_count]
    cpConstraint **springs; ///< [spring_count]
} space;

static bool begin(motion *r, double dt) {
    const model *m = r->m;
    space *own = calloc(1, sizeof *own);
    (void)dt;
    r->own = own;
    if (!own)
        return false;
    own->engine = cpSpaceNew();
    own->bodies = calloc(m->particle_count, sizeof *own->bodies);
    own->springs = calloc(m->spring_count, sizeof *own->springs);
    if (!own->engine || !own->bodies || !own->springs)
        return false;
    cpSpaceSetGravity(own->engine, cpv(0, -m->gravity));
    cpSpaceSetDamping(own->engine, exp(-r->damping));
    cpSpaceSetIterations(own->engine, 1); // springs push once, however many there are
    for (uint32_t i = 0; i < m->particle_count; i++) {
        const bool is_free = m->inverse_mass[i] > 0;
        own->bodies[i] = is_free ? cpBodyNew(1 / m->inverse_mass[i], INFINITY) : cpBodyNewStatic();
        cpBodySetPosition(own->bodies[i], cpv(m->x[i], m->y[i]));
        cpSpaceAddBody(own->engine, own->bodies[i]);
    }
    for (uint32_t s = 0; s < m->spring_count; s++) {
        if (!(m->inverse_mass[m->a[s]] > 0) && !(m->inverse_mass[m->b[s]] > 0))
            continue;
        own->springs[s] = cpDampedSpringNew(own->bodies[m->a[s]], own->bodies[m->b[s]], cpvzero, cpvzero,
                                            m->rest[s], m->stiffness[s], 0);
        cpSpaceAddConstraint(own->engine, own->springs[s]);
    }
    return true;
}

static void frame(motion *r, double dt) {
    for (uint32_t i = 0; i < r->effort; i++)
        cpSpaceStep(((space *)r->own)->engine, dt / r->effort);
}

static void remove_spring(space *own, uint32_t spring) {
    if (own->springs[spring]) {
        cpSpaceRemoveConstraint(own->engine, own->springs[spring]);
        cpConstraintFree(own->springs[spring]);
    }
    own->springs[spring] = NULL;
}

static bool cut(motion *r, const uint32_t *springs, uint32_t count, double dt) {
    (void)dt;
    for (uint32_t i = 0; i < count; i++)
        remove_spring(r->own, springs[i]);
    return true;
}

static void state(const motion *r, model_state *to) {
    const space *own = r->own;
    for (uint32_t i = 0; i < r->m->particle_count; i++) {
        const cpVect place = cpBodyGetPosition(own->bodies[i]), velocity = cpBodyGetVelocity(own->bodies[i]);
        to->x[i] = place.x;
        to->y[i] = place.y;
        to->vx[i] = velocity.x;
        to->vy[i] = velocity.y;
    }
}

static void end(motion *r) {
    space *own = r->own;
    if (!own)
        return;
    for (uint32_t s = 0; own->springs && s < r->m->spring_count; s++)
        remove_spring(own, s);
    for (uint32_t i = 0; own->bodies && i < r->m->particle_count; i++) {
        if (own->bodies[i]) {
            cpSpaceRemoveBody(own->engine, own->bodies[i]);
            cpBodyFree(own->bodies[i]);
        }
    }
    if (own->engine)
        cpSpaceFree(own->engine);
    free(own->bodies);
    free(own->springs);
    free(own);
}

const method board_chipmunk = {.name = "Chipmunk, damped springs",
                               .effort = "substeps",
                               .begin = begin,
                               .frame = frame,
                               .cut = cut,
                               .state = state,
                               .end = end,
                               .efforts = {1, 2, 4},
                               .by_stability = true,
                               .colour = 0x0e8f8f};
