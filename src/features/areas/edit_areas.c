/// Definition of areas.
#include "features/areas/edit_areas.h"

#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "base/shoelace.h"
#include "features/areas/areas.h"
#include "store/changed.h"
#include "store/properties.h"

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

static mspring_result check_firmness(mspring_network *network, const mspring_area_def *def, double rest_area) {
    return (double)def->stiffness / rest_area <= (double)STRONGEST
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the area's stiffness is %g N/m for %g m^2, at most 1e30 N/m^3",
                               (double)def->stiffness, rest_area);
}

// Rest area of a definition; by default the present area of the polygon.
static mspring_result choose_rest_area(mspring_network *network, const mspring_area_def *def, const polygon *of,
                                       double *rest_area) {
    *rest_area = def->rest_area == 0.0f ? of->size : (double)def->rest_area;
    if (def->rest_area == 0.0f && of->size < 0.0)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "the polygon is inside out, with %g m^2: give a rest area", of->size);
    const mspring_result result = check_size(network, "rest area", of, *rest_area);
    return result == MSPRING_OK ? check_firmness(network, def, *rest_area) : result;
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
                                                 const mspring_id *particles, uint32_t count, mspring_id *element) {
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
    if (element)
        *element = mspringi_area_next_id(network);
    add(network, def, rest_area, ordered, count);
    return MSPRING_OK;
}

mspring_result mspring_network_add_area(mspring_network *network, const mspring_area_def *def,
                                        const mspring_id *particles, uint32_t count, mspring_id *element) {
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = add_area(network, def, particles, count, element);
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
                                                       mspring_id *first_element, uint32_t *count) {
    mspring_area_def taken;
    cell_areas cells = {.def = &taken};
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_def(network, &def, &taken);
    if (result == MSPRING_OK && def->rest_area != 0.0f)
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the cells' rest area is %g m^2, it must be 0", (double)def->rest_area);
    if (result == MSPRING_OK)
        result = mspringi_each_cell(network, take_cell, &cells);
    if (result == MSPRING_OK && cells.count > 0)
        result = mspringi_areas_check_room(network, cells.count, 4 * cells.count, 0);
    if (result == MSPRING_OK && first_element)
        *first_element = mspringi_area_next_id(network);
    if (result == MSPRING_OK && count)
        *count = (uint32_t)cells.count;
    for (size_t i = 0; result == MSPRING_OK && i < cells.count; ++i)
        add(network, def, mspringi_area_within(network, cells.corners[i], 4), cells.corners[i], 4);
    if (cells.corners)
        mspringi_free(&network->memory, cells.corners);
    return result;
}

mspring_result mspring_network_add_cell_areas(mspring_network *network, const mspring_area_def *def,
                                              mspring_id *first_element, uint32_t *count) {
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = add_cell_areas(network, def, first_element, count);
    mspringi_fp_leave(before);
    return result;
}

/* ------------------------------------------------------------------------------------------- changing, reading */

// Find an element by id; NULL if there is none.
// Index of the first one in the list with that id or a higher one.
static size_t place_of(const mspring_network *network, mspring_id id) {
    const mspringi_areas *a = network->areas;
    size_t low = 0, high = mspringi_area_count(network);
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (a->list[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static mspringi_area *find(const mspring_network *network, mspring_id id) {
    const size_t place = place_of(network, id);
    return place < mspringi_area_count(network) && network->areas->list[place].id == id
               ? &network->areas->list[place]
               : NULL;
}

// Index of the first existing one from i on. Ids are never given again, so a range may be of billions.
static uint32_t next_existing(const mspring_network *network, const mspringi_selection *at, uint32_t i) {
    if (at->list || i >= at->count)
        return i;
    const size_t place = place_of(network, at->first + i);
    if (place == mspringi_area_count(network) || network->areas->list[place].id - at->first >= at->count)
        return at->count;
    return network->areas->list[place].id - at->first;
}

mspring_result mspring_network_remove_elements(mspring_network *network, const mspring_id *ids, mspring_id first,
                                               uint32_t count) {
    mspringi_selection at;
    const mspring_result result = mspringi_select(network, MSPRING_ELEMENTS, ids, first, count, &at);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    for (uint32_t i = next_existing(network, &at, 0); i < at.count; i = next_existing(network, &at, i + 1)) {
        mspringi_area *found = find(network, mspringi_selected(&at, i));
        if (found->count == 0)
            continue;                                                   // listed twice
        found->count = 0;                                               // without corners it is forgotten
        mspringi_area_tell(network, MSPRINGI_EDIT_REMOVED_AREA, found); // rounds
    }
    mspringi_fp_leave(before);
    mspringi_areas_forget(network);
    return MSPRING_OK;
}

mspring_result mspring_network_get_element_particles(const mspring_network *network, mspring_id element,
                                                     mspring_id *particles, uint32_t capacity, uint32_t *count) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (!count || (!particles && capacity > 0))
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT,
                                    "the place for particles, or their count, is NULL");
    const mspringi_area *found = find(network, element);
    if (!found)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ID, "there is no element %s",
                                    MSPRINGI_ID(element));
    for (uint32_t i = 0; i < found->count && i < capacity; ++i)
        particles[i] = network->areas->corners[found->first + i].particle;
    *count = found->count;
    return MSPRING_OK;
}

/* -------------------------------------------------------------------------------------------------- properties */

static uint32_t total(const mspring_network *network) {
    return mspringi_area_next_id(network);
}

static bool exists(const mspring_network *network, mspring_id id) {
    return find(network, id) != NULL;
}

static double force_of(const mspring_network *network, const mspringi_area *a) {
    return mspringi_area_element(network, a).law->force(a, mspringi_area_size(network, a));
}

static double energy_of(const mspring_network *network, const mspringi_area *a) {
    return mspringi_area_element(network, a).law->energy(a, mspringi_area_size(network, a));
}

// Numbers that an area has and an angle lacks read as 0, and the reverse.
static double get(const mspring_network *network, mspring_property property, mspring_id id) {
    const mspringi_area *a = find(network, id);
    const bool is_open = mspringi_area_is_open(network, a);
    switch (property) {
    case MSPRING_ELEMENT_STIFFNESS:
        return (double)a->stiffness;
    case MSPRING_ELEMENT_DAMPING:
        return a->is_angle ? (double)a->damping : 0.0;
    case MSPRING_PRESSURE:
        return a->is_angle ? 0.0 : (double)a->pressure;
    case MSPRING_FILL:
        return a->is_angle ? 0.0 : (double)a->fill;
    case MSPRING_REST_AREA:
        return a->is_angle ? 0.0 : a->rest_area;
    case MSPRING_REST_ANGLE:
        return a->is_angle ? a->rest_angle : 0.0;
    case MSPRING_AREA:
        return a->is_angle ? 0.0 : mspringi_area_size(network, a);
    case MSPRING_ACTIVE_PRESSURE:
        return a->is_angle || is_open ? 0.0 : force_of(network, a);
    case MSPRING_ANGLE:
        return a->is_angle ? mspringi_angles->between_arms(network, a) : 0.0;
    case MSPRING_TORQUE:
        return !a->is_angle || is_open ? 0.0 : force_of(network, a);
    default:
        return is_open ? 0.0 : energy_of(network, a);
    }
}

static uint32_t get_integer(const mspring_network *network, mspring_property property, mspring_id id) {
    const mspringi_area *a = find(network, id);
    (void)property; // MSPRING_ELEMENT_FLAGS
    return (a->is_angle ? (uint32_t)MSPRING_ELEMENT_ANGLE : (uint32_t)MSPRING_ELEMENT_AREA) |
           (mspringi_area_is_open(network, a) ? (uint32_t)MSPRING_ELEMENT_OPEN : 0u);
}

// Choose the rest area that a value asks for.
static mspring_result rest_area_by(mspring_network *network, const mspringi_area *of, const mspring_area_def *def,
                                   double *rest_area) {
    mspring_id particles[MSPRING_MAX_AREA_PARTICLES];
    for (uint32_t i = 0; i < of->count; ++i)
        particles[i] = network->areas->corners[of->first + i].particle;
    const polygon shape = {particles, of->count, mspringi_area_size(network, of)};
    return choose_rest_area(network, def, &shape, rest_area);
}

// Give an area another value, or only check it.
static mspring_result change(mspring_network *network, mspringi_area *of, mspring_property property, float value,
                             bool is_tried) {
    mspring_area_def def = {
        .kind = of->kind, .stiffness = of->stiffness, .pressure = of->pressure, .fill = of->fill};
    double rest_area = of->rest_area;
    if (property == MSPRING_ELEMENT_STIFFNESS)
        def.stiffness = value;
    else if (property == MSPRING_PRESSURE)
        def.pressure = value;
    else if (property == MSPRING_FILL)
        def.fill = value;
    else
        def.rest_area = value;
    mspring_result result = check_numbers(&def, &network->message);
    if (result == MSPRING_OK)
        result = property == MSPRING_REST_AREA ? rest_area_by(network, of, &def, &rest_area)
                                               : check_firmness(network, &def, rest_area);
    if (result == MSPRING_OK && !is_tried)
        fill(of, &def, rest_area);
    return result;
}

static mspring_result set_one(mspring_network *network, mspringi_area *found, mspring_property property,
                              float value, bool is_tried) {
    const bool of_angles = property == MSPRING_REST_ANGLE || property == MSPRING_ELEMENT_DAMPING;
    if (property != MSPRING_ELEMENT_STIFFNESS && found->is_angle != of_angles)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "element %u is an %s, which has no %s",
                             (unsigned)found->id, found->is_angle ? "angle" : "area",
                             mspringi_property_of(property)->name);
    if (!found->is_angle)
        return change(network, found, property, value, is_tried);
    if (!is_tried)
        mspringi_angles->set(found, property, value);
    return MSPRING_OK;
}

static bool all_have(const mspring_network *network, const mspringi_selection *at, const mspringi_values *values) {
    for (uint32_t i = next_existing(network, at, 0); i < at->count; i = next_existing(network, at, i + 1))
        if ((float)get(network, values->property, mspringi_selected(at, i)) != values->first[i * values->stride])
            return false;
    return true;
}

// All are checked before any is set. Rest angles are no edit; frames hold them.
static mspring_result set(mspring_network *network, const mspringi_selection *at, const mspringi_values *values) {
    const mspring_property property = values->property;
    bool any = false;
    if (all_have(network, at, values))
        return MSPRING_OK;
    for (int pass = 0; pass < 2; ++pass)
        for (uint32_t i = next_existing(network, at, 0); i < at->count; i = next_existing(network, at, i + 1)) {
            mspringi_area *found = find(network, mspringi_selected(at, i));
            const float value = values->first[i * values->stride];
            const mspring_result result = set_one(network, found, property, value, pass == 0);
            if (result != MSPRING_OK)
                return result;
            any = true;
            if (pass == 1 && property != MSPRING_REST_ANGLE)
                mspringi_area_tell(network, MSPRINGI_EDIT_SET_AREA, found);
        }
    if (any && property == MSPRING_REST_ANGLE)
        mspringi_notify_change(network, MSPRINGI_CHANGED_REST_ANGLES, 0);
    else if (any)
        network->areas->changes++;
    return MSPRING_OK;
}

static mspring_id first_particle(const mspring_network *network, mspring_id id) {
    return network->areas->corners[find(network, id)->first].particle;
}

const mspringi_thing_ops mspringi_things_elements = {.kind = MSPRING_ELEMENTS,
                                                     .name = "element",
                                                     .total = total,
                                                     .exists = exists,
                                                     .get = get,
                                                     .get_integer = get_integer,
                                                     .set = set,
                                                     .first_particle = first_particle};
