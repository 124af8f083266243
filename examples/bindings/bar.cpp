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
    mspring_material materials[2]; // 0 is free, 1 is pinned
    materials[0] = mspring_material_default();
    materials[0].mass = 73.4f;
    materials[0].stiffness = 6.76e7f;
    materials[1] = materials[0];
    materials[1].particle_flags = MSPRING_PARTICLE_PINNED;
    std::vector<std::uint16_t> cells(width * height);
    for (std::uint32_t row = 0; row < height; ++row)
        cells[row * width] = 1;

    auto bar = mspring_lattice_def_default();
    bar.width = width;
    bar.height = height;
    bar.cells = cells.data();
    bar.materials = materials;
    bar.material_count = 2;
    massspring::builder builder;
    const mspring_id free_end = builder.add(bar)[width - 1];

    auto def = mspring_network_def_default();
    def.settings.global_damping = 1.0f;
    massspring::network network(builder, &def);
    const double top = network.positions(free_end)[0].y;
    for (int step = 0; step < 60 * 64 * 30; ++step)
        network.step(1.0 / (64 * 30));
    std::printf("the free end has dropped by %.2f m, hash %016" PRIx64 "\n", top - network.positions(free_end)[0].y,
                network.hash());
    return 0;
} catch (const std::exception &failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
}
