/// Areas and angles of a network as others ask for them: builders that it is appended to, and groups.
#include "builder/builder.h"
#include "features/areas/areas.h"
#include "store/feature.h"

// True if an area or angle is added: all of its corners are, and it is intact.
static bool is_appended(const mspring_network *network, const mspring_id *ids, const mspringi_area *area) {
    for (uint32_t i = 0; i < area->count; ++i)
        if (ids[network->areas->corners[area->first + i].particle] == MSPRING_NONE)
            return false;
    return !mspringi_area_is_open(network, area);
}

mspring_result mspringi_areas_reserve_append(const mspring_network *network, const mspring_id *ids,
                                             mspring_builder *builder) {
    size_t areas = 0, corners = 0;
    for (size_t i = 0; i < mspringi_area_count(network); ++i)
        if (is_appended(network, ids, &network->areas->list[i])) {
            areas++;
            corners += network->areas->list[i].count;
        }
    return mspringi_builder_reserve_areas(builder, areas, corners);
}

void mspringi_areas_append_to(const mspring_network *network, const mspring_id *ids, mspring_builder *builder) {
    const mspringi_areas *a = network->areas;
    mspring_id corners[MSPRING_MAX_AREA_PARTICLES];
    for (size_t i = 0; i < mspringi_area_count(network); ++i) {
        if (!is_appended(network, ids, &a->list[i]))
            continue;
        for (uint32_t k = 0; k < a->list[i].count; ++k)
            corners[k] = ids[a->corners[a->list[i].first + k].particle];
        mspringi_builder_append_area(builder, a->list[i], corners, 0);
    }
}

mspring_result mspringi_areas_check_groups(mspring_network *network, const uint32_t *group_of_particle) {
    const mspringi_areas *a = network->areas;
    for (size_t i = 0; i < mspringi_area_count(network); ++i) {
        const mspringi_corner *corners = a->corners + a->list[i].first;
        for (uint32_t k = 1; k < a->list[i].count; ++k)
            if (group_of_particle[corners[k].particle] != group_of_particle[corners[0].particle])
                return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "%s %u has particles of two groups",
                                     a->list[i].is_angle ? "angle" : "area", (unsigned)a->list[i].id);
    }
    return MSPRING_OK;
}
