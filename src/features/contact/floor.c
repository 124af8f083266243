/// Definition of the floor, set by the host; its impulses in a step; and its stage, which has a step repeated if a
/// strip that was left out may have met a surface.
#include "features/contact/floor.h"

#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "builder/builder.h"
#include "store/changed.h"
#include "store/feature.h"
#include "store/selection.h"
#include "store/sleepers.h"
#include "store/stages.h"

#define SHORTEST_SPACING 1e-9
#define LONGEST_SPACING 1e9

/* ----------------------------------------------------------------------------------------------------- checking */

static mspring_result check_planes(const mspring_floor_def *def, mspringi_message *message) {
    if (def->plane_count > MSPRING_MAX_PLANES)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the floor has %u planes, it may have %u",
                             (unsigned)def->plane_count, (unsigned)MSPRING_MAX_PLANES);
    if (def->plane_count > 0 && !def->planes)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the floor's planes are NULL");
    for (uint32_t i = 0; i < def->plane_count; ++i) {
        const double *plane = def->planes + 4 * (size_t)i;
        if (!mspringi_is_coordinate(plane[0]) || !mspringi_is_coordinate(plane[1]))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "the floor's plane %u goes through (%g, %g), which is out of bounds", (unsigned)i,
                                 plane[0], plane[1]);
        const double square = plane[2] * plane[2] + plane[3] * plane[3];
        if (!(square >= 1e-200 && square <= 1e200))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "the floor's plane %u faces (%g, %g), which is no direction", (unsigned)i,
                                 plane[2], plane[3]);
    }
    return MSPRING_OK;
}

static mspring_result check_heights(const mspring_floor_def *def, mspringi_message *message) {
    if (def->height_count == 0)
        return MSPRING_OK;
    if (def->height_count > MSPRING_MAX_HEIGHTS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the floor has %u heights, it may have 0 to %u",
                             (unsigned)def->height_count, (unsigned)MSPRING_MAX_HEIGHTS);
    if (!(def->spacing >= SHORTEST_SPACING && def->spacing <= LONGEST_SPACING))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the floor's heights are %g m apart, it must be 1e-9 to 1e9", def->spacing);
    const double end = def->heights_x + def->spacing * (double)(def->height_count - 1);
    if (!mspringi_is_coordinate(def->heights_x) || !mspringi_is_coordinate(end) ||
        !mspringi_is_coordinate(def->heights_y))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the floor's heights go from (%g, %g) to x = %g, which is out of bounds",
                             def->heights_x, def->heights_y, end);
    for (uint32_t i = 0; def->heights && i < def->height_count; ++i)
        if (!mspringi_is_coordinate((double)def->heights[i]))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "height %u of the floor is %g m, which is out of bounds", (unsigned)i,
                                 (double)def->heights[i]);
    return MSPRING_OK;
}

static mspring_result check_values(const float *values, uint32_t count, const char *name, double most,
                                   mspringi_message *message) {
    for (uint32_t i = 0; values && i < count; ++i)
        if (!(values[i] >= 0.0f && (double)values[i] <= most))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the floor's %s[%u] is %g, it must be 0 to %g",
                                 name, (unsigned)i, (double)values[i], most);
    return MSPRING_OK;
}

#define MOST_RESTITUTION 1.0

static mspring_result check_silt(const mspring_floor_def *def, mspringi_message *message) {
    if (def->silt_depths && def->silt_depth != 0.0f)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the floor has silt_depths, so its silt_depth must be 0, and it is %g m",
                             (double)def->silt_depth);
    if (!(def->silt_depth >= 0.0f && (double)def->silt_depth <= MSPRING_MAX_COORDINATE))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the floor's silt_depth is %g m, it must be 0 to 1e12", (double)def->silt_depth);
    if (!(def->silt_rate >= 0.0f && def->silt_rate <= 1e6f))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the floor's silt_rate is %g/s, it must be 0 to 1e6",
                             (double)def->silt_rate);
    if (def->silt_depth > 0.0f && def->height_count == 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the floor has %g m of silt, but no heights that it could lie on: one makes level "
                             "ground",
                             (double)def->silt_depth);
    return check_values(def->silt_depths, def->height_count, "silt_depths", MSPRING_MAX_COORDINATE, message);
}

static mspring_result check_surface(const mspring_floor_def *def, mspringi_message *message) {
    const uint32_t parts = def->height_count > 0 ? def->height_count - 1 : 0;
    if (!(def->friction >= 0.0f && (double)def->friction <= MSPRINGI_MOST_FRICTION))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the floor's friction is %g, it must be 0 to 1e6",
                             (double)def->friction);
    if (!(def->restitution >= 0.0f && (double)def->restitution <= MOST_RESTITUTION))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the floor's restitution is %g, it must be 0 to 1",
                             (double)def->restitution);
    mspring_result result =
        check_values(def->plane_frictions, def->plane_count, "plane_frictions", MSPRINGI_MOST_FRICTION, message);
    if (result == MSPRING_OK)
        result = check_values(def->plane_restitutions, def->plane_count, "plane_restitutions", MOST_RESTITUTION,
                              message);
    if (result == MSPRING_OK)
        result = check_values(def->height_frictions, parts, "height_frictions", MSPRINGI_MOST_FRICTION, message);
    if (result == MSPRING_OK)
        result = check_values(def->height_restitutions, parts, "height_restitutions", MOST_RESTITUTION, message);
    return result;
}

static mspring_result check_floor(const mspring_floor_def **given, mspring_floor_def *def,
                                  mspringi_message *message) {
    mspring_result result = mspringi_take_floor_def(message, given, def);
    if (result == MSPRING_OK)
        result =
            mspringi_check_reserved(message, "mspring_floor_def", def->reserved | (def->reserved_pointer != NULL));
    if (result != MSPRING_OK)
        return result;
    if (def->plane_count == 0 && def->height_count == 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the floor has neither planes nor heights");
    result = check_planes(def, message);
    if (result == MSPRING_OK)
        result = check_heights(def, message);
    if (result == MSPRING_OK)
        result = check_silt(def, message);
    return result == MSPRING_OK ? check_surface(def, message) : result;
}

/* ----------------------------------------------------------------------------------------------------- copying */

static uint32_t level_count(uint32_t count, uint32_t level) {
    return (uint32_t)(((uint64_t)count + ((uint64_t)1 << level) - 1) >> level);
}

// Copy the heights, and on top of them the highest of 2, of 4 and so on, until one is left: all in one block.
static bool copy_heights(mspringi_heights *to, const mspring_floor_def *def, mspringi_memory *memory) {
    size_t total = 0;
    for (uint32_t level = 0; level == 0 || level_count(to->count, level - 1) > 1; ++level)
        total += level_count(to->count, level);
    float *values = mspringi_alloc(memory, total, sizeof *values);
    if (!values)
        return false;
    to->heights = values;
    for (uint32_t i = 0; def->heights && i < to->count; ++i)
        values[i] = def->heights[i < def->height_count ? i : 0];
    for (uint32_t level = 0;; ++level) {
        const uint32_t count = level_count(to->count, level);
        to->highest[level] = values;
        values += count;
        if (count == 1)
            return true;
        for (uint32_t i = 0; i < count; i += 2) {
            const float a = to->highest[level][i], b = to->highest[level][i + 1 < count ? i + 1 : i];
            values[i / 2] = a > b ? a : b;
        }
    }
}

static bool find_normals(mspringi_heights *h, mspringi_memory *memory) {
    h->normals = mspringi_alloc(memory, 2 * ((size_t)h->count - 1), sizeof *h->normals);
    for (uint32_t i = 0; h->normals && i + 1 < h->count; ++i) {
        const double rise = (double)h->heights[i + 1] - (double)h->heights[i];
        const double length = sqrt(h->spacing * h->spacing + rise * rise);
        h->normals[2 * (size_t)i] = -rise / length;
        h->normals[2 * (size_t)i + 1] = h->spacing / length;
    }
    return h->normals != NULL;
}

static bool copy_silt(mspringi_heights *to, const mspring_floor_def *def, mspringi_memory *memory) {
    to->silt_depth = (double)def->silt_depth;
    to->silt_rate = (double)def->silt_rate;
    if (!def->silt_depths || def->height_count == 0)
        return true;
    to->silt_depths = mspringi_alloc(memory, to->count, sizeof *to->silt_depths);
    for (uint32_t i = 0; to->silt_depths && i < to->count; ++i) {
        to->silt_depths[i] = def->silt_depths[i < def->height_count ? i : 0];
        to->silt_depth = fmax(to->silt_depth, (double)to->silt_depths[i]);
    }
    return to->silt_depths != NULL;
}

// Copy an array that the host may have given. False: there is no memory for it.
static bool copy_values(float **to, const float *values, uint32_t count, mspringi_memory *memory) {
    if (!values || count == 0)
        return true;
    *to = mspringi_alloc(memory, count, sizeof **to);
    if (*to)
        memcpy(*to, values, count * sizeof **to);
    return *to != NULL;
}

static bool copy_surface(mspringi_floor *to, const mspring_floor_def *def, mspringi_memory *memory) {
    const uint32_t parts = def->height_count > 0 ? def->height_count - 1 : 0;
    mspringi_heights *heights = &to->heights;
    to->friction = heights->friction = (double)def->friction;
    to->restitution = heights->restitution = (double)def->restitution;
    return copy_silt(heights, def, memory) &&
           copy_values(&to->plane_frictions, def->plane_frictions, def->plane_count, memory) &&
           copy_values(&to->plane_restitutions, def->plane_restitutions, def->plane_count, memory) &&
           copy_values(&heights->frictions, def->height_frictions, parts, memory) &&
           copy_values(&heights->restitutions, def->height_restitutions, parts, memory);
}

static bool copy_floor(mspringi_floor *to, const mspring_floor_def *def, mspringi_memory *memory) {
    to->plane_count = def->plane_count;
    for (uint32_t i = 0; i < def->plane_count; ++i) {
        const double *plane = def->planes + 4 * (size_t)i;
        memcpy(to->given[i], plane, sizeof to->given[i]);
        const double length = sqrt(plane[2] * plane[2] + plane[3] * plane[3]);
        to->planes[i] = (mspringi_half_plane){plane[0], plane[1], plane[2] / length, plane[3] / length};
    }
    to->heights.count = def->height_count == 1 ? 2 : def->height_count; // a part between two of one height
    to->heights.given = def->height_count;
    to->heights.x = def->heights_x;
    to->heights.y = def->heights_y;
    to->heights.spacing = def->spacing;
    return copy_surface(to, def, memory) && (def->height_count == 0 || (copy_heights(&to->heights, def, memory) &&
                                                                        find_normals(&to->heights, memory)));
}

/* ------------------------------------------------------------------------------------------------------ layout */

// Free a floor that shares its definition with another. NULL is allowed.
static void free_floor_layout(mspringi_floor *floor, mspringi_memory *memory) {
    if (!floor)
        return;
    mspringi_free(memory, floor->clearances);
    mspringi_free(memory, floor->start.x);
    mspringi_free(memory, floor->before.x);
    mspringi_free(memory, floor->impulse.x);
    mspringi_free(memory, floor->previous_impulse.x);
    mspringi_free(memory, floor);
}

static void destroy_floor(mspringi_floor *floor, mspringi_memory *memory) {
    if (!floor)
        return;
    mspringi_free(memory, floor->heights.heights);
    mspringi_free(memory, floor->heights.normals);
    mspringi_free(memory, floor->heights.frictions);
    mspringi_free(memory, floor->heights.restitutions);
    mspringi_free(memory, floor->heights.silt_depths);
    mspringi_free(memory, floor->plane_frictions);
    mspringi_free(memory, floor->plane_restitutions);
    free_floor_layout(floor, memory);
}

static bool reserve_field(mspringi_field *field, size_t slots, mspringi_memory *memory) {
    field->x = mspringi_alloc(memory, 2 * slots, sizeof *field->x);
    if (field->x)
        field->y = field->x + slots;
    return field->x != NULL;
}

// Reserve the arrays by strip and by slot. False: no memory.
static bool reserve_layout(mspringi_floor *floor, mspring_network *network) {
    mspringi_memory *memory = &network->memory;
    floor->slot_count = mspringi_slot_count(network);
    const size_t marks = floor->slot_count / MSPRINGI_WIDTH / sizeof *floor->clearances + 1;
    floor->clearances = mspringi_alloc(memory, network->topology.strip_count + marks, sizeof *floor->clearances);
    floor->impulse = floor->previous_impulse = floor->start = (mspringi_field){NULL, NULL};
    floor->before = (mspringi_state){
        .x = mspringi_alloc(memory, mspringi_state_arrays(network) * floor->slot_count, sizeof *floor->before.x)};
    if (floor->before.x) {
        floor->before.y = floor->before.x + floor->slot_count;
        floor->before.vx = floor->before.y + floor->slot_count;
        floor->before.vy = floor->before.vx + floor->slot_count;
        floor->before.low_x = floor->before.vy + floor->slot_count;
        floor->before.low_y = floor->before.low_x + floor->slot_count;
        if (network->is_precise) {
            floor->before.low_vx = floor->before.low_y + floor->slot_count;
            floor->before.low_vy = floor->before.low_vx + floor->slot_count;
        }
    }
    floor->had_impulse = false;
    floor->is_near = true;
    floor->safe.reach = 0.0;
    return floor->clearances && floor->before.x && reserve_field(&floor->impulse, floor->slot_count, memory) &&
           reserve_field(&floor->previous_impulse, floor->slot_count, memory) &&
           reserve_field(&floor->start, floor->slot_count, memory);
}

// Both floors share the definition.
mspring_result mspringi_floor_move(mspring_network *to, const mspring_network *from) {
    if (!from->floor)
        return MSPRING_OK;
    mspringi_floor *made = mspringi_alloc(&to->memory, 1, sizeof *made);
    if (made)
        *made = *from->floor;
    if (!made || !reserve_layout(made, to)) {
        free_floor_layout(made, &to->memory);
        return mspringi_fail(&to->message, MSPRING_ERROR_MEMORY, "no memory for a floor");
    }
    for (mspring_id p = 0; p < to->topology.particle_count; ++p) {
        const uint32_t before = from->topology.slot_of_particle[p], now = to->topology.slot_of_particle[p];
        made->impulse.x[now] = from->floor->impulse.x[before];
        made->impulse.y[now] = from->floor->impulse.y[before];
    }
    to->floor = made;
    return MSPRING_OK;
}

void mspringi_floor_drop_layout(const mspring_network *from, mspringi_memory *memory) {
    free_floor_layout(from->floor, memory);
}

static bool has_friction(const mspringi_floor *floor) {
    const mspringi_heights *heights = &floor->heights;
    bool any = floor->friction > 0.0;
    for (uint32_t i = 0; floor->plane_frictions && i < floor->plane_count; ++i)
        any = any || floor->plane_frictions[i] > 0.0f;
    for (uint32_t i = 0; heights->frictions && i + 1 < heights->count; ++i)
        any = any || heights->frictions[i] > 0.0f;
    return any;
}

// Reserve the constraints of an implicit substep: each particle may lie on a surface, some where two meet.
static bool reserve_constraints(const mspringi_floor *floor, mspring_network *network) {
    const uint32_t surfaces = floor->plane_count + (floor->heights.count > 0);
    const size_t particles = network->topology.reserve.particle_end;
    const size_t contacts = particles + (surfaces > 1 ? mspringi_floor_max_second_contacts(particles) : 0);
    const size_t count = has_friction(floor) ? 2 * contacts : contacts;
    return mspringi_constraints_reserve(network, MSPRINGI_FLOOR_CONSTRAINT, count, count);
}

// NULL if there is no memory.
static MSPRINGI_NOINLINE mspringi_floor *make_floor(mspring_network *network, const mspring_floor_def *def) {
    mspringi_floor *made = mspringi_alloc(&network->memory, 1, sizeof *made);
    if (!made)
        return NULL;
    if (!reserve_layout(made, network) || !copy_floor(made, def, &network->memory) ||
        !reserve_constraints(made, network)) {
        destroy_floor(made, &network->memory);
        return NULL;
    }
    return made;
}

/* ------------------------------------------------------------------------------------------------- the setting */

static mspring_floor_def def_of(const mspringi_floor *floor) {
    mspring_floor_def def;
    (void)mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def);
    if (!floor)
        return def;
    def.plane_count = floor->plane_count;
    def.planes = floor->plane_count > 0 ? floor->given[0] : NULL;
    def.heights_x = floor->heights.x;
    def.heights_y = floor->heights.y;
    def.spacing = floor->heights.spacing;
    def.heights = floor->heights.count > 0 ? floor->heights.heights : NULL;
    def.height_count = floor->heights.given;
    def.friction = (float)floor->friction;
    def.restitution = (float)floor->restitution;
    def.plane_frictions = floor->plane_frictions;
    def.plane_restitutions = floor->plane_restitutions;
    def.height_frictions = floor->heights.frictions;
    def.height_restitutions = floor->heights.restitutions;
    def.silt_depths = floor->heights.silt_depths;
    def.silt_depth = def.silt_depths ? 0.0f : (float)floor->heights.silt_depth;
    def.silt_rate = (float)floor->heights.silt_rate;
    return def;
}

mspring_result mspring_network_get_floor(const mspring_network *network, mspring_floor_def *def) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_floor_def, def);
    if (result != MSPRING_OK)
        return result;
    const mspring_floor_def had = def_of(network->floor);
    mspringi_put_floor_def(def, &had);
    return MSPRING_OK;
}

static bool are_same(const float *a, const float *b, uint32_t count) {
    return count == 0 || (!a && !b) || (a && b && memcmp(a, b, count * sizeof *a) == 0);
}

// No heights in the definition are heights of 0.
static bool are_same_heights(const float *had, const float *given, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i)
        if (had[i] != (given ? given[i] : 0.0f))
            return false;
    return true;
}

// True if a floor equals the present one.
static bool is_same(const mspringi_floor *floor, const mspring_floor_def *b) {
    if (!floor || !b)
        return !floor && !b;
    const mspring_floor_def a = def_of(floor);
    const uint32_t parts = a.height_count > 0 ? a.height_count - 1 : 0;
    return a.plane_count == b->plane_count && a.height_count == b->height_count && a.friction == b->friction &&
           a.restitution == b->restitution && a.silt_depth == b->silt_depth && a.silt_rate == b->silt_rate &&
           are_same(a.plane_frictions, b->plane_frictions, a.plane_count) &&
           are_same(a.plane_restitutions, b->plane_restitutions, a.plane_count) &&
           are_same(a.height_frictions, b->height_frictions, parts) &&
           are_same(a.height_restitutions, b->height_restitutions, parts) &&
           are_same(a.silt_depths, b->silt_depths, a.height_count) &&
           (a.plane_count == 0 || memcmp(a.planes, b->planes, a.plane_count * sizeof floor->given[0]) == 0) &&
           (a.height_count == 0 ||
            (a.heights_x == b->heights_x && a.heights_y == b->heights_y && a.spacing == b->spacing &&
             are_same_heights(a.heights, b->heights, a.height_count)));
}

mspring_result mspring_network_set_floor(mspring_network *network, const mspring_floor_def *def) {
    mspring_floor_def taken;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK && def)
        result = check_floor(&def, &taken, &network->message);
    if (result != MSPRING_OK || is_same(network->floor, def))
        return result;
    mspringi_floor *made = NULL;
    if (def) {
        const mspringi_fp_state before = mspringi_fp_enter();
        made = make_floor(network, def);
        mspringi_fp_leave(before);
        if (!made)
            return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for a floor of %u heights",
                                 (unsigned)def->height_count);
    }
    destroy_floor(network->floor, &network->memory);
    network->floor = made;
    mspringi_notify_change(network, MSPRINGI_CHANGED_NEW_FLOOR, 0);
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------------- impulses */

static void exchange_impulses(mspringi_floor *floor) {
    const mspringi_field impulse = floor->impulse;
    const bool has_impulse = floor->has_impulse;
    floor->impulse = floor->previous_impulse;
    floor->has_impulse = floor->had_impulse;
    floor->previous_impulse = impulse;
    floor->had_impulse = has_impulse;
}

// Keep the impulses on sleeping particles, which rest on the floor.
static void keep_impulses(const mspring_network *network) {
    mspringi_floor *floor = network->floor;
    for (size_t slot = 0; slot < mspringi_used_slots(network); ++slot) {
        if (!mspringi_slot_is_asleep(network, slot))
            continue;
        floor->impulse.x[slot] = floor->previous_impulse.x[slot];
        floor->impulse.y[slot] = floor->previous_impulse.y[slot];
    }
    floor->has_impulse = true;
}

static void begin_impulses(mspring_network *network) {
    mspringi_floor *floor = network->floor;
    exchange_impulses(floor);
    if (floor->has_impulse)
        mspringi_field_clear(network, floor->impulse);
    floor->has_impulse = false;
    if (network->sleep.sleeping > 0 && floor->had_impulse)
        keep_impulses(network);
}

void mspringi_floor_clear_slot(const mspringi_floor *floor, uint32_t slot) {
    const mspringi_field fields[] = {floor->impulse, floor->previous_impulse};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i)
        if (fields[i].x)
            fields[i].x[slot] = fields[i].y[slot] = 0.0f;
}

void mspringi_floor_roll_back(mspringi_floor *floor) {
    if (floor)
        exchange_impulses(floor);
}

float mspringi_floor_impulse_of(const mspring_network *network, uint32_t slot, int axis) {
    const mspringi_floor *floor = network->floor;
    return !floor ? 0.0f : axis == 0 ? floor->impulse.x[slot] : floor->impulse.y[slot];
}

/* ------------------------------------------------------------------------------------------------------- stage */

static bool is_used(const mspring_network *network) {
    return network->floor != NULL;
}

static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    network->floor->is_missed = network->floor->is_second_try = false;
}

// Repeat the step if a strip that was left out may have met the surface.
static bool must_repeat(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_floor *floor = network->floor;
    (void)attempt;
    if (!floor->is_missed || floor->is_second_try)
        return false;
    floor->is_second_try = true;
    return true;
}

// A step begins without impulses, but for those on what sleeps.
static void forces_known(mspring_network *network, mspringi_field force) {
    (void)force;
    if (!mspringi_sleep_is_whole(network))
        begin_impulses(network);
}

static void roll_back(mspring_network *network) {
    if (!mspringi_sleep_is_whole(network))
        mspringi_floor_roll_back(network->floor);
}

const mspringi_stage mspringi_stage_floor = {.is_used = is_used,
                                             .before_step = before_step,
                                             .forces_known = forces_known,
                                             .must_repeat = must_repeat,
                                             .roll_back = roll_back};

#define RELOCATE(pointer) ((pointer) = mspringi_memory_relocate(from, to, (pointer)))

static void relocate_floor(void *state, const mspringi_memory *from, const mspringi_memory *to) {
    mspringi_floor *floor = state;
    mspringi_state *before = &floor->before;
    RELOCATE(floor->heights.heights);
    RELOCATE(floor->heights.normals);
    RELOCATE(floor->heights.frictions);
    RELOCATE(floor->heights.restitutions);
    RELOCATE(floor->heights.silt_depths);
    RELOCATE(floor->plane_frictions);
    RELOCATE(floor->plane_restitutions);
    for (uint32_t i = 0; i < MSPRINGI_HEIGHT_LEVELS; ++i)
        RELOCATE(floor->heights.highest[i]);
    RELOCATE(floor->clearances);
    RELOCATE(floor->start.x);
    RELOCATE(floor->start.y);
    RELOCATE(before->x);
    RELOCATE(before->y);
    RELOCATE(before->vx);
    RELOCATE(before->vy);
    RELOCATE(before->low_x);
    RELOCATE(before->low_y);
    RELOCATE(before->low_vx);
    RELOCATE(before->low_vy);
    RELOCATE(floor->impulse.x);
    RELOCATE(floor->impulse.y);
    RELOCATE(floor->previous_impulse.x);
    RELOCATE(floor->previous_impulse.y);
}

#undef RELOCATE

const mspringi_feature_state mspringi_state_of_floor = {{NULL, 0}, relocate_floor};
