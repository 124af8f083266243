#include "features/poses/poses.h"

#include "builder/builder.h"
#include "store/feature.h"
#include "store/sections.h"

void mspringi_pose_keep(mspring_network *network, mspring_id particle) {
    const uint32_t slot = network->topology.slot_of_particle[particle];
    if (network->poses)
        network->poses->of_particle[particle] =
            (mspringi_posed){network->origin_x + mspringi_x_of(&network->state, slot),
                             network->origin_y + mspringi_y_of(&network->state, slot)};
}

mspring_result mspringi_poses_create(mspring_network *network, const mspring_builder *builder) {
    const mspringi_reserve *reserve = &network->topology.reserve;
    (void)builder;
    if (!network->keeps_poses)
        return MSPRING_OK;
    mspringi_poses *made = network->poses = mspringi_alloc(&network->memory, 1, sizeof *made);
    if (made)
        made->of_particle = mspringi_alloc(&network->memory, reserve->particle_end, sizeof *made->of_particle);
    if (!made || !made->of_particle)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for the places of %u particles",
                             (unsigned)reserve->particle_end);
    for (mspring_id p = 0; p < network->topology.particle_count; ++p)
        mspringi_pose_keep(network, p);
    return MSPRING_OK;
}

static const mspringi_array_entry arrays[] = {MSPRINGI_ARRAY_ENTRY(mspringi_poses, of_particle, MSPRINGI_ARRAY)};
const mspringi_feature_state mspringi_state_of_poses = {MSPRINGI_ARRAY_TABLE(arrays), NULL};

/* ----------------------------------------------------------------------------------------------------- snapshots
 */

// Coordinates of a position.
enum { COORDINATES = sizeof(mspringi_posed) / sizeof(double) };

static void poses_save(const mspring_network *network, mspringi_writer *to) {
    if (network->poses)
        mspringi_put(to, network->poses->of_particle, COORDINATES * (size_t)network->topology.reserve.particle_end,
                     sizeof(double));
}

static mspring_result poses_check(mspring_network *network, const uint8_t *from, size_t size) {
    const size_t count = network->poses ? network->topology.reserve.particle_end : 0;
    mspring_result result =
        mspringi_section_check_size(network, &mspringi_section_poses, size, count * sizeof(mspringi_posed));
    for (size_t i = 0; result == MSPRING_OK && i < COORDINATES * count; ++i) {
        double value;
        from = mspringi_get(from, &value, 1, sizeof value);
        if (!(fabs(value) <= 2.0 * MSPRING_MAX_COORDINATE)) // once for the origin, once from it
            result = mspringi_section_fail(network, &mspringi_section_poses, "particle %zu was at %g m",
                                           i / COORDINATES, value);
    }
    return result;
}

static void poses_load(mspring_network *network, const uint8_t *from, size_t size) {
    if (size > 0)
        (void)mspringi_get(from, network->poses->of_particle,
                           COORDINATES * (size_t)network->topology.reserve.particle_end, sizeof(double));
}

const mspringi_section mspringi_section_poses = {"pose",     "places at creation", true,       NULL,
                                                 poses_save, poses_check,          poses_load, NULL};
