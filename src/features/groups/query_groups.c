/// Queries about groups: their properties, and observations.
#include <math.h>

#include "base/cpu.h"
#include "features/groups/edit_groups.h"
#include "store/element_laws.h"
#include "store/id_pool.h"
#include "store/moments.h"
#include "store/properties.h"

/* -------------------------------------------------------------------------------------------------- properties */

static uint32_t total(const mspring_network *network) {
    return network->groups.count;
}

static bool exists(const mspring_network *network, mspring_id id) {
    return id < network->groups.count;
}

// Centre of mass and box, in world coordinates; 0 where all particles are removed. One pass, as learners observe
// all of it in each step.
static void measure(const mspring_network *network, uint32_t group, mspringi_group_frame *frame) {
    const mspringi_groups *g = &network->groups;
    const mspringi_state *s = &network->state;
    mspringi_moments sum = {0};
    double min_x = INFINITY, min_y = INFINITY, max_x = -INFINITY, max_y = -INFINITY;
    *frame = (mspringi_group_frame){.first = g->first[group], .end = g->first[group + 1]};
    for (mspring_id p = frame->first; p < frame->end; ++p) {
        if (!mspringi_particle_exists(network, p))
            continue;
        const uint32_t slot = network->topology.slot_of_particle[p];
        const double x = mspringi_x_of(s, slot), y = mspringi_y_of(s, slot);
        mspringi_moments_add(&sum, mspringi_moments_of(network, p));
        min_x = x < min_x ? x : min_x;
        min_y = y < min_y ? y : min_y;
        max_x = x > max_x ? x : max_x;
        max_y = y > max_y ? y : max_y;
    }
    if (!(sum.mass > 0.0))
        return;
    const double part = 1.0 / sum.mass, x = network->origin_x, y = network->origin_y;
    *frame = (mspringi_group_frame){frame->first,  frame->end, x + sum.x * part, y + sum.y * part, sum.px * part,
                                    sum.py * part, x + min_x,  y + min_y,        x + max_x,        y + max_y};
}

static double value_in(mspring_property property, const mspringi_group_frame *frame) {
    switch (property) {
    case MSPRING_GROUP_X:
        return frame->x;
    case MSPRING_GROUP_Y:
        return frame->y;
    case MSPRING_GROUP_VX:
        return frame->vx;
    case MSPRING_GROUP_VY:
        return frame->vy;
    case MSPRING_GROUP_MIN_X:
        return frame->min_x;
    case MSPRING_GROUP_MIN_Y:
        return frame->min_y;
    case MSPRING_GROUP_MAX_X:
        return frame->max_x;
    default:
        return frame->max_y;
    }
}

static double get(const mspring_network *network, mspring_property property, mspring_id id) {
    mspringi_group_frame frame;
    measure(network, id, &frame);
    return value_in(property, &frame);
}

static uint32_t get_integer(const mspring_network *network, mspring_property property, mspring_id id) {
    (void)property; // MSPRING_GROUP_FLAGS
    return network->groups.flags[id] & MSPRINGI_HELD ? MSPRING_GROUP_HELD : 0u;
}

const mspringi_thing_ops mspringi_things_groups = {.kind = MSPRING_GROUPS,
                                                   .name = "group",
                                                   .total = total,
                                                   .exists = exists,
                                                   .get = get,
                                                   .get_integer = get_integer};

void mspringi_group_find_frame(const mspring_network *network, mspring_id particle, mspringi_group_frame *frame) {
    const mspringi_groups *g = &network->groups;
    if (g->of_particle[particle] < g->count)
        measure(network, g->of_particle[particle], frame);
    else
        *frame = (mspringi_group_frame){.first = particle, .end = particle + 1};
}

/* ------------------------------------------------------------------------------------------------ observations */

static mspring_result check_observation(uint32_t count, const mspring_observation *columns, uint32_t column_count,
                                        const double *rows, uint32_t stride, mspringi_message *message) {
    if ((!columns && column_count > 0) || (!rows && count > 0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the list of %s is NULL",
                             columns ? "rows" : "columns");
    if (stride < column_count)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the stride is %u, but a row has %u columns",
                             (unsigned)stride, (unsigned)column_count);
    for (uint32_t c = 0; c < column_count; ++c) {
        const mspring_property property = columns[c].property;
        const mspring_kind kind = mspringi_kind_of(property);
        if (!mspringi_property_of(property))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "column %u: there is no property 0x%x",
                                 (unsigned)c, (unsigned)property);
        if (kind == MSPRING_GROUPS && columns[c].index != 0)
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "column %u is of the group itself: its index is %u, it must be 0", (unsigned)c,
                                 (unsigned)columns[c].index);
    }
    return MSPRING_OK;
}

static bool lists_spring(const mspringi_groups *g, uint32_t group, mspring_id spring) {
    uint32_t low = g->first_spring[group], high = g->first_spring[group + 1];
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (g->springs[middle] < spring)
            low = middle + 1;
        else
            high = middle;
    }
    return low < g->first_spring[group + 1] && g->springs[low] == spring;
}

// One that was removed has no ends, but stays in its group's list: indices of others do not shift.
static uint32_t group_of_spring(const mspring_network *network, mspring_id spring) {
    const mspringi_groups *g = &network->groups;
    uint32_t group = 0;
    if (mspringi_spring_exists(network, spring))
        return g->of_particle[mspringi_things_springs.get_integer(network, MSPRING_END_A, spring)];
    while (group < g->count && !lists_spring(g, group, spring))
        ++group;
    return group;
}

// The group of a thing, or the number of groups. Of elements only for those that exist.
static uint32_t group_of(const mspring_network *network, mspring_kind kind, mspring_id id) {
    const mspringi_thing_ops *of = mspringi_things_of(kind);
    if (kind == MSPRING_ACTUATORS)
        return group_of_spring(network, of->get_integer(network, MSPRING_ACTUATOR_SPRING, id));
    return network->groups.of_particle[of->first_particle ? of->first_particle(network, id) : id];
}

// Elements by what there is of them: ids are never given again, so there may be billions.
static bool are_elements_sorted(const mspring_network *network) {
    mspringi_element_walk walk = mspringi_walk_all_elements(network);
    uint32_t last = 0, count = 0;
    for (; mspringi_element_next(&walk); ++count) {
        const uint32_t group = network->groups.of_particle[walk.element.corners[0].particle];
        if (group < last || walk.element.id != count)
            return false;
        last = group;
    }
    return count == mspring_network_count(network, MSPRING_ELEMENTS);
}

// True if a kind's things come group by group, as those of copies do.
static bool is_sorted(const mspring_network *network, mspring_kind kind) {
    const mspringi_thing_ops *of = mspringi_things_of(kind);
    uint32_t last = 0;
    if (kind == MSPRING_ELEMENTS)
        return are_elements_sorted(network);
    for (mspring_id id = 0; id < of->total(network); ++id) {
        const uint32_t group = of->exists(network, id) ? group_of(network, kind, id) : 0;
        if (group < last || !of->exists(network, id))
            return false;
        last = group;
    }
    return true;
}

// The index-th thing of a group where they are sorted.
static mspring_id find_sorted(const mspring_network *network, mspring_kind kind, uint32_t group, uint32_t index) {
    mspring_id low = 0, high = mspring_network_count(network, kind);
    const mspring_id end = high;
    while (low < high) {
        const mspring_id middle = low + (high - low) / 2;
        if (group_of(network, kind, middle) < group)
            low = middle + 1;
        else
            high = middle;
    }
    return index < end - low && group_of(network, kind, low + index) == group ? low + index : MSPRING_NONE;
}

// The index-th thing of a group, in the order of ids; MSPRING_NONE if it has none. Springs of a group are listed.
static mspring_id find(const mspring_network *network, mspring_kind kind, bool sorted, uint32_t group,
                       uint32_t index) {
    const mspringi_groups *g = &network->groups;
    const mspringi_thing_ops *of = mspringi_things_of(kind);
    if (sorted)
        return find_sorted(network, kind, group, index);
    if (kind == MSPRING_PARTICLES)
        return index < g->first[group + 1] - g->first[group] ? g->first[group] + index : MSPRING_NONE;
    if (kind == MSPRING_SPRINGS)
        return index < g->first_spring[group + 1] - g->first_spring[group]
                   ? g->springs[g->first_spring[group] + index]
                   : MSPRING_NONE;
    if (kind == MSPRING_ELEMENTS) {
        mspringi_element_walk walk = mspringi_walk_all_elements(network);
        while (mspringi_element_next(&walk))
            if (g->of_particle[walk.element.corners[0].particle] == group && index-- == 0)
                return walk.element.id;
        return MSPRING_NONE;
    }
    for (mspring_id id = 0; id < of->total(network); ++id)
        if (group_of(network, kind, id) == group && index-- == 0)
            return id;
    return MSPRING_NONE;
}

// Groups are observed column by column, some at a time: what a column's property decides is decided once for all.
enum { OBSERVED = 32 };

static double value_of(const mspring_network *network, mspring_property property, const mspringi_thing_ops *of,
                       mspring_id id, const mspringi_group_frame *frame) {
    if (mspringi_is_of_integers(property))
        return (double)of->get_integer(network, property, id);
    if (of == &mspringi_things_groups)
        return value_in(property, frame);
    if (property >= MSPRING_RELATIVE_X && property <= MSPRING_RELATIVE_VY)
        return mspringi_relative_value(network, property, id, frame);
    return of->get(network, property, id);
}

// Lengths, directions and strains of the springs that are there are measured together.
static void observe_measured(const mspring_network *network, mspring_property property, const mspring_id *ids,
                             uint32_t count, double *values, size_t stride) {
    mspring_id list[OBSERVED];
    float measured[OBSERVED];
    mspringi_selection there = {.list = list};
    for (uint32_t i = 0; i < count; ++i)
        if (ids[i] != MSPRING_NONE)
            list[there.count++] = ids[i];
    (void)mspring_network_get(network, property, list, 0, there.count, measured, 1);
    for (uint32_t i = 0, next = 0; i < count; ++i)
        values[i * stride] = ids[i] != MSPRING_NONE ? (double)measured[next++] : 0.0;
}

static void observe(const mspring_network *network, const mspringi_selection *groups, bool sorted,
                    const mspringi_group_frame *frames, const mspring_observation *column, double *values,
                    size_t stride) {
    const mspring_property property = column->property;
    const mspring_kind kind = mspringi_kind_of(property);
    const mspringi_thing_ops *of = mspringi_things_of(kind);
    mspring_id ids[OBSERVED];
    for (uint32_t i = 0; i < groups->count; ++i) {
        const uint32_t group = mspringi_selected(groups, i);
        const mspring_id id = kind == MSPRING_GROUPS ? group : find(network, kind, sorted, group, column->index);
        ids[i] = id != MSPRING_NONE && of->exists(network, id) ? id : MSPRING_NONE;
    }
    if (property >= MSPRING_LENGTH && property <= MSPRING_STRAIN) {
        observe_measured(network, property, ids, groups->count, values, stride);
        return;
    }
    for (uint32_t i = 0; i < groups->count; ++i)
        values[i * stride] = ids[i] != MSPRING_NONE ? value_of(network, property, of, ids[i], &frames[i]) : 0.0;
}

// Which of the kinds that no list of a group holds come group by group: elements, actuators.
static void find_sorted_kinds(const mspring_network *network, const mspring_observation *columns,
                              uint32_t column_count, bool sorted[2]) {
    bool known[2] = {false, false};
    for (uint32_t c = 0; c < column_count; ++c) {
        const mspring_kind kind = mspringi_kind_of(columns[c].property);
        const int which = kind == MSPRING_ACTUATORS;
        if ((kind != MSPRING_ACTUATORS && kind != MSPRING_ELEMENTS) || known[which] || !mspringi_things_of(kind))
            continue;
        sorted[which] = is_sorted(network, kind);
        known[which] = true;
    }
}

mspring_result mspring_network_observe_groups(const mspring_network *network, const mspring_id *ids,
                                              mspring_id first, uint32_t count, const mspring_observation *columns,
                                              uint32_t column_count, double *rows, uint32_t stride) {
    mspringi_selection at;
    mspringi_message message;
    mspring_result result =
        network ? mspringi_look_up_for(network, MSPRING_GROUPS, ids, first, count, network, network, 1, &at)
                : MSPRING_ERROR_ARGUMENT;
    if (result != MSPRING_OK)
        return result;
    result = check_observation(count, columns, column_count, rows, stride, &message);
    if (result != MSPRING_OK)
        return mspringi_shared_set(network->shared, result, &message);
    bool sorted[2] = {false, false};
    if (count > 0)
        find_sorted_kinds(network, columns, column_count, sorted);
    const mspringi_fp_state before = mspringi_fp_enter();
    for (uint32_t i = 0; i < count; i += OBSERVED) {
        mspringi_group_frame frames[OBSERVED];
        const mspringi_selection some = {at.list ? at.list + i : NULL, at.first + i,
                                         count - i < OBSERVED ? count - i : OBSERVED};
        for (uint32_t of = 0; of < some.count; ++of)
            measure(network, mspringi_selected(&some, of), &frames[of]);
        for (uint32_t c = 0; c < column_count; ++c) {
            const mspring_kind kind = mspringi_kind_of(columns[c].property);
            const bool in_order =
                (kind == MSPRING_ELEMENTS && sorted[0]) || (kind == MSPRING_ACTUATORS && sorted[1]);
            observe(network, &some, in_order, frames, &columns[c], rows + (size_t)i * stride + c, stride);
        }
    }
    mspringi_fp_leave(before);
    return MSPRING_OK;
}
