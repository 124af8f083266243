/// @file bindings.cpp
/// massspring.hpp (examples/bindings): all that it wraps, once.
///
/// SPDX-License-Identifier: MIT
#include "massspring.hpp"

#include <cstdio>
#include <cstring>

namespace {

int wrong = 0;

void expect(bool holds, const char *said) {
    if (!holds)
        std::printf("%s\n", said), ++wrong;
}

template <typename Call> void expect_error(mspring_result code, const char *part, Call call) {
    try {
        call();
        expect(false, part);
    } catch (const massspring::error &failure) {
        expect(failure.code == code, "another code");
        expect(std::strstr(failure.what(), part) != nullptr, failure.what());
    }
}

void add_bodies(massspring::builder &builder) {
    auto particle = mspring_particle_def_default();
    expect_error(MSPRING_ERROR_ARGUMENT, "mass", [&] {
        particle.mass = -1;
        builder.add(particle);
    });
    particle.mass = 3; // the builder goes on
    auto rope = mspring_rope_def_default();
    auto material = mspring_material_default();
    material.stiffness = 100;
    rope.from = builder.add(particle);
    particle.x = 10;
    rope.to = builder.add(particle);
    rope.segment_count = 5, rope.material = &material;
    expect(builder.add(rope).size() == 6, "the rope has other particles");
    auto lattice = mspring_lattice_def_default();
    lattice.width = 3, lattice.height = 2, lattice.y = 5, lattice.materials = &material;
    expect(builder.add(lattice).back() == 11, "the lattice has other particles");
    auto disc = mspring_disc_def_default();
    disc.x = 20, disc.material = &material;
    expect(builder.add(disc) == 12, "the disc begins elsewhere");
    const double x[] = {30, 31, 30}, y[] = {0, 0, 1};
    const std::uint32_t triangle[] = {0, 1, 2};
    auto mesh = mspring_mesh_def_default();
    mesh.vertex_count = 3, mesh.triangle_count = 1, mesh.x = x, mesh.y = y, mesh.triangles = triangle;
    mesh.material = &material;
    expect(builder.add(mesh) == 19, "the mesh begins elsewhere");
    auto spring = mspring_spring_def_default();
    spring.a = 6, spring.b = 12;
    expect(builder.add(spring) == 5 + 11 + 12 + 3, "the spring has another id");
}

void read_and_set(massspring::network &network) {
    const std::vector<mspring_id> corners{19, 20, 21};
    network.set<MSPRING_MASS>(corners, 2.5f);
    const auto masses = network.get<MSPRING_MASS>();
    expect(masses.size() == network.count(MSPRING_PARTICLES) && masses[18] == 1 && masses[21] == 2.5f, "masses");
    expect(network.get<MSPRING_MASS>(corners) == std::vector<float>(3, 2.5f), "masses of a list");
    expect(network.get<MSPRING_END_A>({0, 2}) == std::vector<std::uint32_t>({0, 2}), "ends of a range");
    std::uint32_t flags[2 * 5] = {};
    network.get(MSPRING_SPRING_FLAGS, {5, 5}, flags, 2);
    expect(flags[0] == 0, "flags");
    network.set(mspring_contact_def_default());
    network.set<MSPRING_LAYERS>({}, 6u);
    expect(network.get<MSPRING_LAYERS>(3)[0] == 6, "layers");
    const mspring_id area = network.add(mspring_area_def_default(), corners);
    expect(network.get<MSPRING_AREA>(area)[0] == 0.5f, "the area");
    auto angle = mspring_angle_def_default();
    angle.stiffness = 2;
    network.add(angle, {0, 2, 3, 4});
    expect(network.get<MSPRING_ELEMENT_STIFFNESS>() == std::vector<float>({0, 2, 2}), "stiffness of elements");
    expect(network.positions(1)[0].x == 10 && network.positions().size() == masses.size(), "positions");
    expect(network.body(corners).mass == 7.5, "the body");
    expect_error(MSPRING_ERROR_ID, "4000", [&] { network.get<MSPRING_MASS>(4000); });
}

} // namespace

int main() try {
    massspring::builder builder, other;
    add_bodies(builder);
    auto def = mspring_network_def_default();
    def.settings.gravity_y = -1;
    massspring::network network(builder, &def);
    read_and_set(network);
    auto settings = network.settings();
    expect(settings.gravity_y == -1, "gravity");
    settings.substeps = 3;
    network.set(settings);
    auto floor = mspring_floor_def_default();
    const float silt = 0.5f;
    floor.height_count = 1, floor.heights_y = -2, floor.silt_depths = &silt, floor.silt_rate = 1;
    network.set(floor);
    auto grip = mspring_grip_def_default();
    grip.particle = 1;
    network.add(grip);
    auto collider = mspring_collider_def_default();
    collider.kind = MSPRING_COLLIDER_BOX, collider.y = 100;
    network.add(collider);
    network.step(0.01);
    network.check(mspring_network_wake(network));

    other.read(network.archive());
    massspring::network again(other);
    expect(again.settings().substeps == 3, "substeps of the archive");
    network.step(0.01);
    again.step(0.01);
    expect(network.hash() == again.hash(), "the archive goes elsewhere");
    return wrong;
} catch (const std::exception &failure) {
    std::printf("%s\n", failure.what());
    return 1;
}
