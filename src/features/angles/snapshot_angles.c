/// Snapshot of rest angles, which are no parameters.
#include "features/angles/angles.h"
#include "store/sections.h"

// In frames, too, since the host may set them before each step.
static void rest_angles_save(const mspring_network *network, mspringi_writer *to) {
    for (size_t i = 0; i < mspringi_area_count(network); ++i)
        if (network->areas->list[i].is_angle)
            mspringi_put(to, &network->areas->list[i].rest_angle, 1, sizeof(double));
}

static mspring_result rest_angles_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_rest_angles;
    for (size_t i = 0; i < size / sizeof(double); ++i) {
        double value;
        from = mspringi_get(from, &value, 1, sizeof value);
        if (!(fabs(value) <= MSPRINGI_MAX_ANGLE))
            return mspringi_section_fail(network, section, "one is %g rad", value);
    }
    return mspringi_section_check_size(network, section, size % sizeof(double), 0);
}

static mspring_result rest_angles_check_against(mspring_network *network, const mspringi_saved *saved,
                                                const uint8_t *from, size_t size) {
    const uint8_t *areas;
    size_t areas_size, count = network->areas ? network->areas->angle_count : 0;
    (void)from;
    if (mspringi_saved_section(saved, &mspringi_section_areas, &areas, &areas_size))
        count = mspringi_saved_angles(areas, areas_size);
    return mspringi_section_check_size(network, &mspringi_section_rest_angles, size, count * sizeof(double));
}

// Load after the areas, which have their number.
static void rest_angles_load(mspring_network *network, const uint8_t *from, size_t size) {
    size_t left = size / sizeof(double);
    for (size_t i = 0; i < mspringi_area_count(network) && left > 0; ++i) {
        double value;
        if (!network->areas->list[i].is_angle)
            continue;
        from = mspringi_get(from, &value, 1, sizeof value);
        mspringi_angle_set_rest(&network->areas->list[i], value);
        --left;
    }
}

const mspringi_section mspringi_section_rest_angles = {"angl",
                                                       "rest angles",
                                                       false,
                                                       NULL,
                                                       rest_angles_save,
                                                       rest_angles_check,
                                                       rest_angles_load,
                                                       rest_angles_check_against};
