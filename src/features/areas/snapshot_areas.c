/// Snapshot of areas and angle springs.
#include "features/areas/areas.h"

#include <math.h>

#include "base/assert.h"
#include "store/changed.h"
#include "store/sections.h"

#define STRONGEST 1e30f

#define ANGLE_KIND 2u

/// Saved form of an area. An angle has its damping in the place of the pressure, and its rest angle in that of the
/// rest area.
typedef struct record {
    uint32_t id, kind, count;
    float stiffness, pressure, fill;
    double rest;
} record;

static void hand_area(mspringi_io *io, record *r) {
    mspringi_hand(io, &r->id, 3, sizeof(uint32_t)); // and the next two
    mspringi_hand(io, &r->stiffness, 3, sizeof(float));
    MSPRINGI_HAND(io, r->rest);
}

static void hand_corner(mspringi_io *io, mspringi_corner *corner) {
    MSPRINGI_HAND(io, corner->particle);
    MSPRINGI_HAND(io, corner->spring);
    MSPRINGI_HAND(io, corner->reach);
}

// No section means that there never was an area.
static void areas_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_areas *a = network->areas;
    mspringi_io io = mspringi_io_to(to);
    if (!a || a->next_id == 0)
        return;
    uint32_t head[] = {a->next_id, (uint32_t)a->count};
    mspringi_hand(&io, head, 2, sizeof head[0]);
    for (const mspringi_area *area = a->list; area < a->list + a->count; ++area) {
        hand_area(&io, &(record){area->id, area->is_angle ? ANGLE_KIND : (uint32_t)area->kind, area->count,
                                 area->stiffness, area->is_angle ? area->damping : area->pressure, area->fill,
                                 area->is_angle ? area->rest_angle : area->rest_area});
        for (uint32_t c = 0; c < area->count; ++c)
            hand_corner(&io, &a->corners[area->first + c]);
    }
}

static mspringi_area read_area(mspringi_io *io) {
    mspringi_area area;
    record r;
    hand_area(io, &r);
    if (r.kind == ANGLE_KIND) {
        area = (mspringi_area){
            .is_angle = true, .stiffness = r.stiffness, .damping = r.pressure, .fill = 1.0f, .rest_area = 1.0};
        if (fabs(r.rest) <= MSPRINGI_MAX_ANGLE)
            area.rest = mspringi_rotation_by(r.rest);
        area.rest_angle = r.rest;
    } else {
        area = (mspringi_area){.kind = r.kind == MSPRING_AREA_GAS ? MSPRING_AREA_GAS : MSPRING_AREA_ELASTIC,
                               .stiffness = r.stiffness,
                               .pressure = r.pressure,
                               .fill = r.fill,
                               .rest_area = r.rest};
    }
    area.id = r.id;
    area.count = r.kind < ANGLE_KIND || (r.kind == ANGLE_KIND && mspringi_angles) ? r.count : 0;
    return area;
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

static mspring_result areas_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_areas;
    mspringi_io io = mspringi_io_from(from, size);
    mspring_result result = MSPRING_OK;
    size_t corners = 0, angles = 0;
    uint32_t head[2], least = 0;
    if (size == 0)
        return MSPRING_OK;
    mspringi_hand(&io, head, 2, sizeof head[0]);
    for (uint32_t i = 0; result == MSPRING_OK && !io.is_short && i < head[1]; ++i) {
        const mspringi_area area = read_area(&io);
        result = io.is_short ? mspringi_section_end(network, section, &io) : check_area(network, &area);
        if (result == MSPRING_OK && (area.id < least || area.id >= head[0]))
            return mspringi_section_fail(network, section, "area %u is in the wrong order", (unsigned)area.id);
        least = area.id + 1;
        for (uint32_t c = 0; result == MSPRING_OK && !io.is_short && c < area.count; ++c) {
            mspringi_corner corner;
            hand_corner(&io, &corner);
            result = check_corner(network, &area, &corner);
        }
        corners += area.count;
        angles += area.is_angle;
    }
    if (result == MSPRING_OK)
        result = mspringi_section_end(network, section, &io);
    // memory for all of them, whatever the network has now
    if (result == MSPRING_OK)
        result =
            head[1] > 0 ? mspringi_areas_reserve(network, head[1], corners, angles) : mspringi_areas_make(network);
    return result;
}

size_t mspringi_saved_angles(const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    uint32_t head[2] = {0, 0};
    size_t count = 0;
    if (size > 0)
        mspringi_hand(&io, head, 2, sizeof head[0]);
    for (uint32_t i = 0; i < head[1]; ++i) {
        const mspringi_area area = read_area(&io);
        count += area.is_angle;
        for (uint32_t c = 0; c < area.count; ++c)
            hand_corner(&io, &(mspringi_corner){0});
    }
    return count;
}

// Check that corners exist, differ, and belong to one group.
static mspring_result check_corners(mspring_network *network, const mspringi_saved *saved, uint32_t *last_of,
                                    mspringi_io *io) {
    const uint32_t *group = network->groups.of_particle;
    const mspringi_area area = read_area(io);
    mspringi_corner first = {0}, corner;
    for (uint32_t c = 0; c < area.count; ++c) {
        hand_corner(io, &corner);
        first = c == 0 ? corner : first;
        if (!mspringi_saved_has_particle(saved, corner.particle) || last_of[corner.particle] == area.id + 1 ||
            (group && group[corner.particle] != group[first.particle]))
            return mspringi_section_fail(network, &mspringi_section_areas,
                                         "area %u has particle %u twice, or it is not there or of another group",
                                         (unsigned)area.id, (unsigned)corner.particle);
        last_of[corner.particle] = area.id + 1;
    }
    return MSPRING_OK;
}

static mspring_result areas_check_against(mspring_network *network, const mspringi_saved *saved,
                                          const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    mspring_result result = MSPRING_OK;
    uint32_t head[2] = {0, 0};
    if (size > 0)
        mspringi_hand(&io, head, 2, sizeof head[0]);
    if (head[1] == 0)
        return MSPRING_OK;
    uint32_t *last_of = mspringi_alloc(&network->memory, network->topology.reserve.particle_end, sizeof *last_of);
    if (!last_of)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to compare %u areas",
                             (unsigned)head[1]);
    for (uint32_t i = 0; result == MSPRING_OK && i < head[1]; ++i)
        result = check_corners(network, saved, last_of, &io);
    mspringi_free(&network->memory, last_of);
    return result;
}

static void areas_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_areas *a = network->areas;
    mspringi_io io = mspringi_io_from(from, size);
    uint32_t head[2];
    network->edits.values++; // affects the limit in any shape
    if (!a)
        return;
    mspringi_areas_clear(network);
    mspringi_hand(&io, head, 2, sizeof head[0]);
    a->next_id = head[0];
    for (uint32_t i = 0; i < head[1]; ++i) {
        mspringi_area *area = &a->list[a->count];
        *area = read_area(&io);
        area->first = (uint32_t)a->corner_count;
        MSPRINGI_ASSERT(a->count < a->capacity && a->corner_count + area->count <= a->corner_capacity);
        area->cell = MSPRINGI_NO_CELL;
        for (uint32_t c = 0; c < area->count; ++c)
            hand_corner(&io, &a->corners[area->first + c]);
        a->count++;
        a->angle_count += area->is_angle;
        a->corner_count += area->count;
    }
}

const mspringi_section mspringi_section_areas = {"area",     "areas",     true,       NULL,
                                                 areas_save, areas_check, areas_load, areas_check_against};
