/// Reports on a network: its error, its layout and its last step.
#include "solvers/explicit/explicit.h"
#include "store/id_pool.h"
#include "store/sleepers.h"

const char *mspring_network_error(const mspring_network *network) {
    const char *shared = network ? mspringi_shared_text(network->shared) : "";
    return shared[0] || !network ? shared : network->message.text;
}

// Ids that an addition may get.
static uint32_t room_in(const uint8_t *marks, mspring_id first, mspring_id end) {
    uint32_t room = 0;
    for (mspring_id id = first; marks && id < end; ++id)
        room += marks[id] == MSPRINGI_SPARE;
    return room;
}

mspring_result mspring_network_get_info(const mspring_network *network, mspring_network_info *info) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_network_info, info);
    if (result != MSPRING_OK)
        return result;
    const mspringi_topology *t = &network->topology;
    const mspring_network_info made = {
        .simd_level = network->kernels->level,
        .worker_count = mspringi_tasks_workers(network->tasks),
        .busy_workers = mspringi_explicit_workers(network),
        .lattice_springs = t->lattice_springs,
        .chain_springs = t->chain_springs,
        .irregular_springs = t->laid_out_count + mspringi_id_pool_added_springs(network),
        .particle_room = room_in(network->growth.particles, t->reserve.first_particle, t->reserve.particle_end),
        .spring_room = room_in(network->growth.springs, t->reserve.first_spring, t->reserve.spring_end),
        .memory_used = network->memory.used + network->tasks_memory.used,
    };
    mspringi_put_network_info(info, &made);
    return MSPRING_OK;
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
        .is_asleep = mspringi_sleepers && mspringi_sleepers->is_idle(network),
    };
    mspringi_put_step_info(info, &made);
    return MSPRING_OK;
}
