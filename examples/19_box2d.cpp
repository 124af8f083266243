/// @file 19_box2d.cpp
/// A wrecking ball of Box2D swings into a tower of springs: two engines, coupled both ways.
///
/// It needs Box2D 2.4 (Debian, Ubuntu: libbox2d-dev). 15_torpedo.c does the same with a body of its own.
///
/// SPDX-License-Identifier: MIT
#include <massspring/massspring.h>

#include <box2d/box2d.h>

#include <cstdint>
#include <cstdio>

extern "C" {
#include "common/show.h"
}

namespace {

constexpr int columns = 6, rows = 24, steps = 2000;
constexpr float dt = 1.0f / 400; // s, short: in a step nothing slows the ball down
constexpr double half = 2;       // m, of the ball, which is a box
const b2Vec2 pivot(-3, 34), ball(-25, 34);

/// A rod without mass holds the ball at the pivot.
b2Body *hang_ball(b2World &world) {
    b2BodyDef def;
    b2Body *const crane = world.CreateBody(&def);
    def.type = b2_dynamicBody;
    def.position = ball;
    def.linearDamping = def.angularDamping = 0.02f; // 1/s
    b2Body *const made = world.CreateBody(&def);
    b2PolygonShape box;
    box.SetAsBox(half, half);
    made->CreateFixture(&box, 3000); // kg/m^2
    b2RevoluteJointDef joint;
    joint.Initialize(crane, made, pivot);
    world.CreateJoint(&joint);
    return made;
}

mspring_result build_tower(mspring_builder *builder) {
    static std::uint16_t cells[rows][columns]; // 0 is wood, 1 is pinned wood
    mspring_material wood[2] = {mspring_material_default()};
    const mspring_result result = mspring_material_preset(wood, MSPRING_PRESET_WOOD, 1.0, dt / 5);
    wood[0].break_strain = 0.02f;
    wood[1] = wood[0];
    wood[1].particle_flags = MSPRING_PARTICLE_PINNED;
    for (int column = 0; column < columns; column++)
        cells[rows - 1][column] = 1;
    mspring_lattice_def tower = mspring_lattice_def_default();
    tower.width = columns, tower.height = rows, tower.cells = cells[0];
    tower.materials = wood, tower.material_count = 2;
    return result == MSPRING_OK ? mspring_builder_add_lattice(builder, &tower, nullptr) : result;
}

mspring_result let_meet(mspring_network *network, mspring_id *collider) {
    mspring_contact_def contact = mspring_contact_def_default();
    contact.friction = 0.4f;
    mspring_result result = mspring_network_set_contact(network, &contact);
    mspring_collider_def def = mspring_collider_def_default();
    def.kind = MSPRING_COLLIDER_BOX, def.width = def.height = 2 * half;
    def.x = ball.x, def.y = ball.y, def.friction = 0.4f;
    return result == MSPRING_OK ? mspring_network_add_collider(network, &def, collider) : result;
}

/// Box2D moves the ball, the tower feels it, and the ball what it gave.
mspring_result step_together(b2World &world, b2Body *body, mspring_network *network, mspring_id collider) {
    double x = 0, y = 0, angular = 0;
    world.Step(dt, 8, 3);
    const b2Vec2 at = body->GetPosition();
    mspring_result result = mspring_network_move_collider(network, collider, at.x, at.y, body->GetAngle());
    result = result != MSPRING_OK ? result : mspring_network_step(network, dt);
    result =
        result != MSPRING_OK ? result : mspring_network_get_collider_impulse(network, collider, &x, &y, &angular);
    body->ApplyLinearImpulseToCenter(b2Vec2(static_cast<float>(x), static_cast<float>(y)), true);
    body->ApplyAngularImpulse(static_cast<float>(angular), true);
    return result;
}

} // namespace

int main(int count, char **arguments) {
    static const double corners[] = {-half, -half, half, -half, half, half, -half, half};
    b2World world(b2Vec2(0, -9.8f));
    b2Body *const body = hang_ball(world);
    mspring_builder *builder = nullptr;
    mspring_network *network = nullptr;
    mspring_id collider = MSPRING_NONE;
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 5;
    mspring_result result = mspring_builder_create(nullptr, &builder);
    result = result != MSPRING_OK ? result : build_tower(builder);
    result = result != MSPRING_OK ? result : mspring_network_create(builder, &def, &network);
    result = result != MSPRING_OK ? result : let_meet(network, &collider);
    show shown;
    show_begin(&shown, count, arguments, "19_box2d", "A ball of Box2D hits a tower of springs.", network, 0.02);
    shown.film.corners = corners, shown.film.corner_count = 4;
    float fastest = 0;
    for (int step = 0; result == MSPRING_OK && step < steps; step++) {
        result = step_together(world, body, network, collider);
        const float speed = body->GetLinearVelocity().Length();
        fastest = speed > fastest ? speed : fastest;
        shown.film.place[0] = body->GetPosition().x;
        shown.film.place[1] = body->GetPosition().y;
        shown.film.place[2] = body->GetAngle();
        show_step(&shown, network);
    }
    std::printf("the ball came at %.1f m/s and goes on at %.1f m/s\n", static_cast<double>(fastest),
                static_cast<double>(body->GetLinearVelocity().Length()));
    return show_end(&shown, result, builder, network);
}
