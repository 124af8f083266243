/// @file bar.cpp
/// The bending of a bar, in C++17: 80 x 5 particles of iron, pinned at the left end, after a minute.
///
///     c++ -std=c++17 bar.cpp -o bar $(pkg-config --cflags --libs massspring) && ./bar
///
/// SPDX-License-Identifier: MIT
#include <cinttypes>
#include <cstdio>
#include <exception>
#include <vector>

#include "massspring.hpp"

int main() try {
    const std::uint32_t width = 80, height = 5;
    std::vector<massspring::material> made(2); // 0 is free, 1 is pinned
    std::vector<mspring_material> materials;
    made[1].particle_flags = MSPRING_PARTICLE_PINNED;
    for (massspring::material &iron : made) {
        iron.mass = 73.4f;
        iron.stiffness = 6.76e7f;
        materials.push_back(iron);
    }
    std::vector<std::uint16_t> cells(width * height);
    for (std::uint32_t row = 0; row < height; ++row)
        cells[row * width] = 1;

    massspring::lattice_def bar;
    bar.width = width;
    bar.height = height;
    bar.cells = cells.data();
    bar.materials = materials.data();
    bar.material_count = 2;
    massspring::builder builder;
    const mspring_id free_end = builder.add_lattice(bar)[width - 1];

    massspring::network network(builder);
    mspring_settings settings = network.settings();
    settings.global_damping = 1.0f;
    network.set_settings(settings);
    const double top = network.position(free_end).y;
    for (int step = 0; step < 60 * 64 * 30; ++step)
        network.step(1.0 / (64 * 30));
    std::printf("the free end has dropped by %.2f m, hash %016" PRIx64 "\n", top - network.position(free_end).y,
                network.hash());
    return 0;
} catch (const std::exception &failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
}
