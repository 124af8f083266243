/// Queries about a network: its sizes, its error and its last step.
#include <math.h>

#include "store/network.h"

const char *mspring_network_error(const mspring_network *network) {
    const char *shared = network ? mspringi_shared_text(network->shared) : "";
    return shared[0] || !network ? shared : network->message.text;
}

uint32_t mspring_network_particle_count(const mspring_network *network) {
    return network ? network->topology.particle_count : 0;
}

uint32_t mspring_network_spring_count(const mspring_network *network) {
    return network ? network->topology.spring_count : 0;
}

mspring_simd mspring_network_simd_level(const mspring_network *network) {
    return network ? network->kernels->level : MSPRING_SIMD_AUTO;
}

uint32_t mspring_network_worker_count(const mspring_network *network) {
    return network ? mspringi_tasks_workers(network->tasks) : 0;
}

size_t mspring_network_memory_used(const mspring_network *network) {
    return network ? network->memory.used + network->tasks_memory.used : 0;
}

static double largest_speed(const mspring_network *network) {
    const mspringi_state *s = &network->state;
    double largest = 0.0;
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        const double vx = (double)s->vx[slot], vy = (double)s->vy[slot], square = vx * vx + vy * vy;
        if (square > largest && mspringi_particle_exists(network, p))
            largest = square;
    }
    return sqrt(largest);
}

uint32_t mspring_network_step_flags(const mspring_network *network) {
    return network ? network->steps.outcome.flags : 0;
}

mspring_result mspring_network_get_step_info(const mspring_network *network, mspring_step_info *info) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_step_info, info);
    if (result != MSPRING_OK)
        return result;
    const mspringi_steps *steps = &network->steps;
    const mspring_step_info made = {
        .result = steps->result,
        .particle = steps->outcome.particle,
        .spring = steps->outcome.spring,
        .flags = steps->outcome.flags,
        .substeps = steps->substeps,
        .step_count = steps->count,
        .fallback_count = steps->fallback_count,
        .time = steps->time,
        .time_left = steps->pace.left,
        .work = steps->outcome.work,
        .largest_speed = largest_speed(network),
    };
    mspringi_put_step_info(info, &made);
    return MSPRING_OK;
}
