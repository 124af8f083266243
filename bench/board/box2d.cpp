/// @file box2d.cpp
/// Box2D 2.4: a body for each particle, a soft distance joint for each spring.
///
/// SPDX-License-Identifier: MIT
#include "board/methods.h"

#include <box2d/box2d.h>

#include <vector>

namespace {

struct world {
    b2World engine;
    std::vector<b2Body *> bodies;
    std::vector<b2Joint *> springs; // nullptr: between pinned ones, or broken
    explicit world(double gravity) : engine(b2Vec2(0, static_cast<float>(-gravity))) {
    }
};

bool begin(motion *r, double) {
    const model *m = r->m;
    world *w = new world(m->gravity);
    r->own = w;
    w->engine.SetAllowSleeping(false);
    for (uint32_t i = 0; i < m->particle_count; i++) {
        b2BodyDef def;
        const bool is_free = m->inverse_mass[i] > 0;
        def.type = is_free ? b2_dynamicBody : b2_staticBody;
        def.position.Set(static_cast<float>(m->x[i]), static_cast<float>(m->y[i]));
        def.fixedRotation = true;
        def.linearDamping = static_cast<float>(r->damping);
        w->bodies.push_back(w->engine.CreateBody(&def));
        if (is_free) {
            b2MassData mass;
            mass.mass = static_cast<float>(1 / m->inverse_mass[i]);
            mass.center.SetZero();
            mass.I = 0;
            w->bodies.back()->SetMassData(&mass);
        }
    }
    for (uint32_t s = 0; s < m->spring_count; s++) {
        b2DistanceJointDef def;
        w->springs.push_back(nullptr);
        if (!(m->inverse_mass[m->a[s]] > 0) && !(m->inverse_mass[m->b[s]] > 0))
            continue;
        def.bodyA = w->bodies[m->a[s]];
        def.bodyB = w->bodies[m->b[s]];
        def.length = static_cast<float>(m->rest[s]);
        def.stiffness = static_cast<float>(m->stiffness[s]);
        w->springs.back() = w->engine.CreateJoint(&def);
    }
    return true;
}

// The manual's own numbers of iterations, in each substep.
void frame(motion *r, double dt) {
    const float h = static_cast<float>(dt / r->effort);
    for (uint32_t i = 0; i < r->effort; i++)
        static_cast<world *>(r->own)->engine.Step(h, 8, 3);
}

bool cut(motion *r, const uint32_t *springs, uint32_t count, double) {
    world *w = static_cast<world *>(r->own);
    for (uint32_t i = 0; i < count; i++) {
        if (w->springs[springs[i]])
            w->engine.DestroyJoint(w->springs[springs[i]]);
        w->springs[springs[i]] = nullptr;
    }
    return true;
}

void state(const motion *r, model_state *to) {
    const std::vector<b2Body *> &bodies = static_cast<world *>(r->own)->bodies;
    for (uint32_t i = 0; i < r->m->particle_count; i++) {
        to->x[i] = bodies[i]->GetPosition().x;
        to->y[i] = bodies[i]->GetPosition().y;
        to->vx[i] = bodies[i]->GetLinearVelocity().x;
        to->vy[i] = bodies[i]->GetLinearVelocity().y;
    }
}

void end(motion *r) {
    delete static_cast<world *>(r->own);
}

} // namespace

const method board_box2d = {"Box2D, joints",     "substeps", begin,   frame, cut, state, end,
                            {1, 4, 16, 64, 256}, false,      0x8e44ad};
