/// Areas and angle springs, in a snapshot.
#include "store/angles.h"

#include <math.h>

#include "store/changed.h"
#include "store/sections.h"

#define STRONGEST 1e30f

// The next id, and how many areas there are.
#define HEAD_BYTES ((size_t)8)
// Id, kind, corners, 3 floats, a double; of each corner a particle, a spring and a float. An angle has its damping
// in place of the pressure, and its rest angle in place of the rest area.
#define AREA_BYTES ((size_t)32)
#define CORNER_BYTES ((size_t)12)
#define ANGLE_KIND 2u

// Without it there has never been an area.
static size_t areas_size(const mspring_network *network) {
    const mspringi_areas *a = &network->areas;
    return a->next_id > 0 ? HEAD_BYTES + a->count * AREA_BYTES + a->corner_count * CORNER_BYTES : 0;
}

static void areas_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_areas *a = &network->areas;
    const uint32_t head[] = {a->next_id, (uint32_t)a->count};
    mspringi_put(to, head, 2, sizeof head[0]);
    for (const mspringi_area *area = a->list; area < a->list + a->count; ++area) {
        const uint32_t numbers[] = {area->id, area->is_angle ? ANGLE_KIND : (uint32_t)area->kind, area->count};
        const float floats[] = {area->stiffness, area->is_angle ? area->damping : area->pressure, area->fill};
        mspringi_put(to, numbers, 3, sizeof numbers[0]);
        mspringi_put(to, floats, 3, sizeof floats[0]);
        mspringi_put(to, area->is_angle ? &area->rest_angle : &area->rest_area, 1, sizeof area->rest_area);
        for (const mspringi_corner *c = a->corners + area->first; c < a->corners + area->first + area->count; ++c) {
            const uint32_t ids[] = {c->particle, c->spring};
            mspringi_put(to, ids, 2, sizeof ids[0]);
            mspringi_put(to, &c->reach, 1, sizeof c->reach);
        }
    }
}

static const uint8_t *read_area(const uint8_t *from, mspringi_area *area) {
    uint32_t numbers[3];
    float floats[3];
    double rest;
    from = mspringi_get(from, numbers, 3, sizeof numbers[0]);
    from = mspringi_get(from, floats, 3, sizeof floats[0]);
    from = mspringi_get(from, &rest, 1, sizeof rest);
    if (numbers[1] == ANGLE_KIND) {
        *area = mspringi_angle_make(floats[0], floats[1], fabs(rest) <= MSPRINGI_MAX_ANGLE ? rest : 0.0);
        area->rest_angle = rest;
    } else {
        *area = (mspringi_area){.kind = numbers[1] == MSPRING_AREA_GAS ? MSPRING_AREA_GAS : MSPRING_AREA_ELASTIC,
                                .stiffness = floats[0],
                                .pressure = floats[1],
                                .fill = floats[2],
                                .rest_area = rest};
    }
    area->id = numbers[0];
    area->count = numbers[1] <= ANGLE_KIND ? numbers[2] : 0;
    return from;
}

static const uint8_t *read_corner(const uint8_t *from, mspringi_corner *corner) {
    from = mspringi_get(from, &corner->particle, 1, sizeof corner->particle);
    from = mspringi_get(from, &corner->spring, 1, sizeof corner->spring);
    return mspringi_get(from, &corner->reach, 1, sizeof corner->reach);
}

static mspring_result check_area(mspring_network *network, const mspringi_area *area) {
    const mspringi_section *section = &mspringi_section_areas;
    if (area->count < 3 || area->count > MSPRING_MAX_AREA_PARTICLES)
        return mspringi_section_fail(network, section, "area %u has %u corners", (unsigned)area->id,
                                     (unsigned)area->count);
    if (area->is_angle && !(area->count == 3 && area->damping >= 0.0f && area->damping <= STRONGEST &&
                            fabs(area->rest_angle) <= MSPRINGI_MAX_ANGLE))
        return mspringi_section_fail(network, section, "angle %u has %u corners, damping %g, rest angle %g",
                                     (unsigned)area->id, (unsigned)area->count, (double)area->damping,
                                     area->rest_angle);
    if (!(area->stiffness >= 0.0f && area->stiffness <= STRONGEST && fabsf(area->pressure) <= STRONGEST) ||
        !(area->fill >= 0.01f && area->fill <= 100.0f) ||
        !(area->rest_area >= 1e-24 && area->rest_area <= 1e24 &&
          (double)area->stiffness / area->rest_area <= (double)STRONGEST))
        return mspringi_section_fail(network, section, "area %u has stiffness %g, pressure %g, fill %g, %g m^2",
                                     (unsigned)area->id, (double)area->stiffness, (double)area->pressure,
                                     (double)area->fill, area->rest_area);
    return MSPRING_OK;
}

static mspring_result check_corner(mspring_network *network, const mspringi_area *area,
                                   const mspringi_corner *corner) {
    const mspringi_reserve *reserve = &network->topology.reserve;
    const bool is_spring = corner->spring < reserve->spring_end || corner->spring == MSPRING_NONE;
    if (corner->particle >= reserve->particle_end || !is_spring || !(corner->reach >= 0.0f))
        return mspringi_section_fail(network, &mspringi_section_areas, "area %s has particle %s and spring %s",
                                     MSPRINGI_ID(area->id), MSPRINGI_ID(corner->particle),
                                     MSPRINGI_ID(corner->spring));
    return MSPRING_OK;
}

// Check the areas of a section whose head is that; count their corners.
static mspring_result check_list(mspring_network *network, const uint8_t *from, size_t left, const uint32_t head[2],
                                 size_t *corners, size_t *angles) {
    const mspringi_section *section = &mspringi_section_areas;
    mspring_result result = MSPRING_OK;
    uint32_t least = 0;
    for (uint32_t i = 0; result == MSPRING_OK && i < head[1]; ++i) {
        mspringi_area area = {.count = 0};
        if (left < AREA_BYTES)
            return mspringi_section_fail(network, section, "there are not all of %u", (unsigned)head[1]);
        from = read_area(from, &area);
        left -= AREA_BYTES;
        result = check_area(network, &area);
        if (result == MSPRING_OK && (area.id < least || area.id >= head[0] || left < area.count * CORNER_BYTES))
            return mspringi_section_fail(network, section, "area %u is in the wrong order, or not all there",
                                         (unsigned)area.id);
        least = area.id + 1;
        for (uint32_t c = 0; result == MSPRING_OK && c < area.count; ++c) {
            mspringi_corner corner;
            from = read_corner(from, &corner);
            result = check_corner(network, &area, &corner);
        }
        left -= result == MSPRING_OK ? area.count * CORNER_BYTES : 0;
        *corners += area.count;
        *angles += area.is_angle;
    }
    return result == MSPRING_OK ? mspringi_section_check_size(network, section, left, 0) : result;
}

static mspring_result areas_check(mspring_network *network, const uint8_t *from, size_t size) {
    uint32_t head[2];
    size_t corners = 0, angles = 0;
    if (size == 0)
        return MSPRING_OK;
    if (size < HEAD_BYTES)
        return mspringi_section_fail(network, &mspringi_section_areas, "they take %zu bytes", size);
    from = mspringi_get(from, head, 2, sizeof head[0]);
    const mspring_result result = check_list(network, from, size - HEAD_BYTES, head, &corners, &angles);
    // Room for all of them, whatever is there now.
    return result == MSPRING_OK && head[1] > 0 ? mspringi_areas_reserve(network, head[1], corners, angles) : result;
}

// After the section of growth: areas with a corner that is not there are left out.
static void areas_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_areas *a = &network->areas;
    uint32_t head[2] = {0, 0};
    mspringi_areas_clear(network);
    if (size > 0)
        from = mspringi_get(from, head, 2, sizeof head[0]);
    a->next_id = head[0];
    for (uint32_t i = 0; i < head[1]; ++i) {
        mspringi_area *area = &a->list[a->count];
        bool is_whole = true;
        from = read_area(from, area);
        area->first = (uint32_t)a->corner_count;
        area->cell = MSPRINGI_NO_CELL;
        for (uint32_t c = 0; c < area->count; ++c) {
            mspringi_corner *corner = &a->corners[area->first + c];
            from = read_corner(from, corner);
            is_whole = is_whole && corner->particle < network->topology.particle_count &&
                       mspringi_particle_exists(network, corner->particle);
        }
        a->count += is_whole;
        a->angle_count += is_whole && area->is_angle;
        a->corner_count += is_whole ? area->count : 0;
    }
    network->edits.values++; // what is stable in any shape
}

const mspringi_section mspringi_section_areas = {"area",     "areas",     true,      areas_size,
                                                 areas_save, areas_check, areas_load};

/* ------------------------------------------------------------------------------------------------- rest angles */

// The host may set them before each step: frames have them, too.
static size_t rest_angles_size(const mspring_network *network) {
    size_t count = 0;
    for (size_t i = 0; i < network->areas.count; ++i)
        count += network->areas.list[i].is_angle;
    return count * sizeof(double);
}

static void rest_angles_save(const mspring_network *network, mspringi_writer *to) {
    for (size_t i = 0; i < network->areas.count; ++i)
        if (network->areas.list[i].is_angle)
            mspringi_put(to, &network->areas.list[i].rest_angle, 1, sizeof(double));
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

// After the areas, which say how many there are.
static void rest_angles_load(mspring_network *network, const uint8_t *from, size_t size) {
    size_t left = size / sizeof(double);
    for (size_t i = 0; i < network->areas.count && left > 0; ++i) {
        double value;
        if (!network->areas.list[i].is_angle)
            continue;
        from = mspringi_get(from, &value, 1, sizeof value);
        mspringi_angle_set_rest(&network->areas.list[i], value);
        --left;
    }
}

const mspringi_section mspringi_section_rest_angles = {
    "angl", "rest angles", false, rest_angles_size, rest_angles_save, rest_angles_check, rest_angles_load};
