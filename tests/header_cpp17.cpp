// The public header alone, as strict C++17, linked with the C library: the extern "C" block is complete.
// SPDX-License-Identifier: MIT
#include <massspring/massspring.h>

int main() {
    mspring_builder *builder = nullptr;
    mspring_network *network = nullptr;
    const mspring_particle_def particle = mspring_particle_def_default();
    bool ok = mspring_builder_create(nullptr, &builder) == MSPRING_OK &&
              mspring_builder_add_particles(builder, &particle, 1, nullptr) == MSPRING_OK &&
              mspring_network_create(builder, nullptr, &network) == MSPRING_OK &&
              mspring_network_step(network, 0.015625) == MSPRING_OK;
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    return ok ? 0 : 1;
}
