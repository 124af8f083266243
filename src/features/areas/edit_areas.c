/// Definition of areas.
#include "features/areas/edit_areas.h"

#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "base/shoelace.h"
#include "features/areas/areas.h"
#include "store/changed.h"

#define STRONGEST 1e30f
#define MIN_FILL 0.01f
#define MAX_FILL 100.0f
#define MIN_AREA 1e-24
#define MAX_AREA 1e24

/// Smallest area relative to its squared perimeter: a hundred times the rounding error of corners on a line.
#define MIN_PART 1e-6

/* ------------------------------------------------------------------------------------------------------ checks */

static mspring_result check_numbers(const mspring_area_def *def, mspringi_message *message) {
    const bool is_gas = def->kind == MSPRING_AREA_GAS;
    if (is_gas && def->stiffness != 0.0f)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the area's stiffness is %g, but a gas has none",
                             (double)def->stiffness);
    const struct {
        const char *name;
        float value, least, most;
    } values[] = {{"stiffness", def->stiffness, 0.0f, STRONGEST},
                  {"pressure", def->pressure, is_gas ? 0.0f : -STRONGEST, STRONGEST},
                  {"fill", def->fill, MIN_FILL, MAX_FILL}};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i)
        if (!(values[i].value >= values[i].least && values[i].value <= values[i].most))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the area's %s is %g, it must be %g to %g",
                                 values[i].name, (double)values[i].value, (double)values[i].least,
                                 (double)values[i].most);
    return MSPRING_OK;
}

static mspring_result check_def(mspring_network *network, const mspring_area_def **given, mspring_area_def *def) {
    mspringi_message *message = &network->message;
    mspring_result result = mspringi_take_area_def(message, given, def);
    if (result == MSPRING_OK)
        result = mspringi_check_reserved(message, "mspring_area_def", def->reserved);
    if (result != MSPRING_OK)
        return result;
    if (def->kind != MSPRING_AREA_ELASTIC && def->kind != MSPRING_AREA_GAS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the area's kind is %d, which is none",
                             (int)def->kind);
    return check_numbers(def, message);
}

static double perimeter_of(const mspring_network *network, const mspring_id *particles, uint32_t count) {
    const mspringi_state *s = &network->state;
    const uint32_t *slots = network->topology.slot_of_particle;
    double sum = 0.0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t here = slots[particles[i]], next = slots[particles[i + 1 < count ? i + 1 : 0]];
        const double x = mspringi_x_of(s, next) - mspringi_x_of(s, here),
                     y = mspringi_y_of(s, next) - mspringi_y_of(s, here);
        sum += sqrt(x * x + y * y);
    }
    return sum;
}

/// Corners in the order in which the area is size.
typedef struct polygon {
    const mspring_id *particles;
    uint32_t count;
    double size; ///< m^2
} polygon;

// Check that an area, its own or a given rest area, is more than rounding: A / rest area is a factor of forces.
static mspring_result check_size(mspring_network *network, const char *what, const polygon *of, double size) {
    const double perimeter = perimeter_of(network, of->particles, of->count);
    const double least = fmax(MIN_PART * perimeter * perimeter, MIN_AREA);
    if (size >= least && size <= MAX_AREA)
        return MSPRING_OK;
    return mspringi_fail(
        &network->message, MSPRING_ERROR_ARGUMENT,
        "the %s of particles %u, %u, %u ... is %g m^2, it must be %g to 1e24: at least 1e-6 of the "
        "squared perimeter",
        what, (unsigned)of->particles[0], (unsigned)of->particles[1], (unsigned)of->particles[2], size, least);
}

// Rest area of a definition; by default the present area of the polygon.
static mspring_result choose_rest_area(mspring_network *network, const mspring_area_def *def, const polygon *of,
                                       double *rest_area) {
    *rest_area = def->rest_area == 0.0 ? of->size : def->rest_area;
    if (def->rest_area == 0.0 && of->size < 0.0)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "the polygon is inside out, with %g m^2: give a rest area", of->size);
    const mspring_result result = check_size(network, "rest area", of, *rest_area);
    if (result != MSPRING_OK)
        return result;
    return (double)def->stiffness / *rest_area <= (double)STRONGEST
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the area's stiffness is %g N/m for %g m^2, at most 1e30 N/m^3",
                               (double)def->stiffness, *rest_area);
}

mspring_result mspringi_check_corners(mspring_network *network, const char *what, const mspring_id *particles,
                                      uint32_t count) {
    mspringi_message *message = &network->message;
    for (uint32_t i = 0; i < count; ++i) {
        if (particles[i] >= network->topology.particle_count || !mspringi_particle_exists(network, particles[i]))
            return mspringi_fail(message, MSPRING_ERROR_ID, "the %s has particle %s, which does not exist", what,
                                 MSPRINGI_ID(particles[i]));
        const uint32_t *group = network->groups.of_particle;
        if (group && group[particles[i]] != group[particles[0]])
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the %s has particles %u and %u of two groups",
                                 what, (unsigned)particles[0], (unsigned)particles[i]);
        for (uint32_t j = 0; j < i; ++j)
            if (particles[j] == particles[i])
                return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the %s has particle %u twice", what,
                                     (unsigned)particles[i]);
    }
    return MSPRING_OK;
}

static mspring_result check_list(mspring_network *network, const mspring_id *particles, uint32_t count) {
    if (!particles || count < 3 || count > MSPRING_MAX_AREA_PARTICLES)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "the area has %u particles, it must have 3 to %u, and the list must not be NULL",
                             (unsigned)count, (unsigned)MSPRING_MAX_AREA_PARTICLES);
    return mspringi_check_corners(network, "area", particles, count);
}

/* ------------------------------------------------------------------------------------------------------ adding */

static void fill(mspringi_area *area, const mspring_area_def *def, double rest_area) {
    area->kind = def->kind;
    area->stiffness = def->stiffness;
    area->pressure = def->pressure;
    area->fill = def->fill;
    area->rest_area = rest_area;
}

// Add an area, for which memory is reserved.
static void add(mspring_network *network, const mspring_area_def *def, double rest_area,
                const mspring_id *particles, uint32_t count) {
    mspringi_area made = {.count = count};
    fill(&made, def, rest_area);
    mspringi_area_add(network, made, particles);
}

double mspringi_area_within(const mspring_network *network, const mspring_id *particles, uint32_t count) {
    const mspringi_state *s = &network->state;
    const uint32_t *slots = network->topology.slot_of_particle;
    const double x = mspringi_x_of(s, slots[particles[0]]), y = mspringi_y_of(s, slots[particles[0]]);
    mspringi_shoelace shape = {0};
    for (uint32_t i = 1; i < count; ++i)
        mspringi_shoelace_add(&shape, mspringi_x_of(s, slots[particles[i]]) - x,
                              mspringi_y_of(s, slots[particles[i]]) - y);
    return 0.5 * shape.twice;
}

static MSPRINGI_NOINLINE mspring_result add_area(mspring_network *network, const mspring_area_def *def,
                                                 const mspring_id *particles, uint32_t count, mspring_id *area) {
    mspring_area_def taken;
    mspring_id ordered[MSPRING_MAX_AREA_PARTICLES];
    double rest_area;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_def(network, &def, &taken);
    if (result == MSPRING_OK)
        result = check_list(network, particles, count);
    if (result != MSPRING_OK)
        return result;
    const double size = mspringi_area_within(network, particles, count);
    const polygon of = {particles, count, fabs(size)};
    result = check_size(network, "area", &of, of.size);
    if (result == MSPRING_OK)
        result = choose_rest_area(network, def, &of, &rest_area);
    if (result == MSPRING_OK)
        result = mspringi_areas_check_room(network, 1, count, 0);
    if (result != MSPRING_OK)
        return result;
    for (uint32_t i = 0; i < count; ++i)
        ordered[i] = particles[size > 0.0 ? i : count - 1 - i];
    if (area)
        *area = mspringi_area_next_id(network);
    add(network, def, rest_area, ordered, count);
    return MSPRING_OK;
}

mspring_result mspring_network_add_area(mspring_network *network, const mspring_area_def *def,
                                        const mspring_id *particles, uint32_t count, mspring_id *area) {
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = add_area(network, def, particles, count, area);
    mspringi_fp_leave(before);
    return result;
}

/// Definition for each cell, and the corners of all.
typedef struct cell_areas {
    const mspring_area_def *def;
    mspring_id (*corners)[4];
    size_t count, capacity;
} cell_areas;

// Check a cell, and keep its corners.
static mspring_result take_cell(mspring_network *network, const mspring_id corners[4], void *user) {
    cell_areas *all = user;
    double rest_area;
    const polygon of = {corners, 4, mspringi_area_within(network, corners, 4)};
    void *list = all->corners;
    if (!mspringi_grow(&network->memory, &list, &all->capacity, all->count + 1, sizeof *all->corners))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for the corners of %zu cells",
                             all->count + 1);
    all->corners = list;
    memcpy(all->corners[all->count++], corners, sizeof *all->corners);
    return choose_rest_area(network, all->def, &of, &rest_area);
}

static MSPRINGI_NOINLINE mspring_result add_cell_areas(mspring_network *network, const mspring_area_def *def,
                                                       mspring_id *first_area, uint32_t *count) {
    mspring_area_def taken;
    cell_areas cells = {.def = &taken};
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_def(network, &def, &taken);
    if (result == MSPRING_OK && def->rest_area != 0.0)
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the cells' rest area is %g m^2, it must be 0", def->rest_area);
    if (result == MSPRING_OK)
        result = mspringi_each_cell(network, take_cell, &cells);
    if (result == MSPRING_OK && cells.count > 0)
        result = mspringi_areas_check_room(network, cells.count, 4 * cells.count, 0);
    if (result == MSPRING_OK && first_area)
        *first_area = mspringi_area_next_id(network);
    if (result == MSPRING_OK && count)
        *count = (uint32_t)cells.count;
    for (size_t i = 0; result == MSPRING_OK && i < cells.count; ++i)
        add(network, def, mspringi_area_within(network, cells.corners[i], 4), cells.corners[i], 4);
    if (cells.corners)
        mspringi_free(&network->memory, cells.corners);
    return result;
}

mspring_result mspring_network_add_cell_areas(mspring_network *network, const mspring_area_def *def,
                                              mspring_id *first_area, uint32_t *count) {
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = add_cell_areas(network, def, first_area, count);
    mspringi_fp_leave(before);
    return result;
}

/* ------------------------------------------------------------------------------------------- changing, reading */

// Find an area or angle by id; NULL if there is none.
static mspringi_area *find(const mspring_network *network, mspring_id id, bool is_angle) {
    const mspringi_areas *a = network->areas;
    size_t low = 0, high = mspringi_area_count(network);
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (a->list[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low < mspringi_area_count(network) && a->list[low].id == id && a->list[low].is_angle == is_angle
               ? &a->list[low]
               : NULL;
}

#define NONE_THERE "there is no %s %s"

static const char *name_of(bool is_angle) {
    return is_angle ? "angle" : "area";
}

mspring_result mspringi_area_find(mspring_network *network, mspring_id id, bool is_angle, mspringi_area **found) {
    *found = find(network, id, is_angle);
    return *found
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_ID, NONE_THERE, name_of(is_angle), MSPRINGI_ID(id));
}

static mspring_result enter_and_find(mspring_network *network, mspring_id id, mspringi_area **found) {
    const mspring_result result = mspringi_check_call(network);
    return result == MSPRING_OK ? mspringi_area_find(network, id, false, found) : result;
}

mspring_result mspringi_area_remove(mspring_network *network, mspring_id id, bool is_angle) {
    mspringi_area *found;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = mspringi_area_find(network, id, is_angle, &found);
    if (result != MSPRING_OK)
        return result;
    const mspringi_area had = *found;
    const mspringi_fp_state before = mspringi_fp_enter();
    mspringi_areas_drop(network, found);
    mspringi_area_tell(network, MSPRINGI_EDIT_REMOVED_AREA, &had); // rounds
    mspringi_fp_leave(before);
    return MSPRING_OK;
}

mspring_result mspring_network_remove_area(mspring_network *network, mspring_id area) {
    return mspringi_area_remove(network, area, false);
}

static MSPRINGI_NOINLINE mspring_result set_area(mspring_network *network, mspring_id area,
                                                 const mspring_area_def *def) {
    mspring_area_def taken;
    mspringi_area *found;
    mspring_id particles[MSPRING_MAX_AREA_PARTICLES];
    double rest_area = 0.0;
    mspring_result result = enter_and_find(network, area, &found);
    if (result == MSPRING_OK)
        result = check_def(network, &def, &taken);
    if (result != MSPRING_OK)
        return result;
    for (uint32_t i = 0; i < found->count; ++i)
        particles[i] = network->areas->corners[found->first + i].particle;
    const polygon of = {particles, found->count, mspringi_area_size(network, found)};
    result = choose_rest_area(network, def, &of, &rest_area);
    if (result != MSPRING_OK)
        return result;
    fill(found, def, rest_area);
    network->areas->changes++;
    mspringi_area_tell(network, MSPRINGI_EDIT_SET_AREA, found);
    return MSPRING_OK;
}

mspring_result mspring_network_set_area(mspring_network *network, mspring_id area, const mspring_area_def *def) {
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = set_area(network, area, def);
    mspringi_fp_leave(before);
    return result;
}

const mspringi_area *mspringi_area_look_up(const mspring_network *network, mspring_id id, bool is_angle) {
    const mspringi_area *found = find(network, id, is_angle);
    if (!found)
        (void)mspringi_shared_fail(network->shared, MSPRING_ERROR_ID, NONE_THERE, name_of(is_angle),
                                   MSPRINGI_ID(id));
    return found;
}

mspring_result mspring_network_get_area(const mspring_network *network, mspring_id area, mspring_area_def *def) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_area_def, def);
    if (result != MSPRING_OK)
        return result;
    const mspringi_area *found = mspringi_area_look_up(network, area, false);
    if (!found)
        return MSPRING_ERROR_ID;
    const mspring_area_def had = {.kind = found->kind,
                                  .stiffness = found->stiffness,
                                  .pressure = found->pressure,
                                  .fill = found->fill,
                                  .rest_area = found->rest_area};
    mspringi_put_area_def(def, &had);
    return MSPRING_OK;
}

mspring_result mspring_network_get_area_info(const mspring_network *network, mspring_id area,
                                             mspring_area_info *info) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_area_info, info);
    if (result != MSPRING_OK)
        return result;
    const mspringi_area *found = mspringi_area_look_up(network, area, false);
    if (!found)
        return MSPRING_ERROR_ID;
    const bool is_open = mspringi_area_is_open(network, found);
    const double size = mspringi_area_size(network, found);
    const mspring_area_info made = {.particle_count = found->count,
                                    .is_open = is_open,
                                    .area = size,
                                    .pressure = is_open ? 0.0 : mspringi_area_pressure(found, size),
                                    .energy = is_open ? 0.0 : mspringi_area_energy(found, size)};
    mspringi_put_area_info(info, &made);
    return MSPRING_OK;
}

mspring_result mspring_network_get_area_particles(const mspring_network *network, mspring_id area,
                                                  mspring_id *particles, uint32_t capacity, uint32_t *count) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (!count || (!particles && capacity > 0))
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT,
                                    "the place for particles, or their count, is NULL");
    const mspringi_area *found = mspringi_area_look_up(network, area, false);
    if (!found)
        return MSPRING_ERROR_ID;
    for (uint32_t i = 0; i < found->count && i < capacity; ++i)
        particles[i] = network->areas->corners[found->first + i].particle;
    *count = found->count;
    return MSPRING_OK;
}

mspring_result mspringi_areas_measure(const mspring_network *network, bool is_angle, mspring_id *ids, double *sizes,
                                      double *pressures, uint32_t capacity, uint32_t *count) {
    uint32_t found = 0;
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (!count)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the place for the count is NULL");
    for (size_t i = 0; i < mspringi_area_count(network); ++i) {
        const mspringi_area *a = &network->areas->list[i];
        if (a->is_angle != is_angle || found++ >= capacity)
            continue;
        const double size = mspringi_area_size(network, a);
        if (ids)
            ids[found - 1] = a->id;
        if (sizes)
            sizes[found - 1] = is_angle ? mspringi_angles->between_arms(network, a) : size;
        if (pressures)
            pressures[found - 1] =
                mspringi_area_is_open(network, a) ? 0.0 : mspringi_area_element(network, a).law->force(a, size);
    }
    *count = found;
    return MSPRING_OK;
}

mspring_result mspring_network_get_areas(const mspring_network *network, mspring_id *ids, double *areas,
                                         double *pressures, uint32_t capacity, uint32_t *count) {
    return mspringi_areas_measure(network, false, ids, areas, pressures, capacity, count);
}
