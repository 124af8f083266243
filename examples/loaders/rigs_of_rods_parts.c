/// @file rigs_of_rods_parts.c
/// Masses, wheels and cameras, which Rigs of Rods makes when everything else has been read.
///
/// SPDX-License-Identifier: MIT
#include "loaders/rigs_of_rods.h"

#include <math.h>
#include <string.h>

enum { MOST_RAYS = 360 };

static const double pi = 3.14159265358979323846;

// Where the values stand in the lines of the wheel sections, counted from 0. The tyre's spring is taken, not the
// rim's.
static const struct {
    const char *section;
    size_t radius, rays, end, mass, stiffness, damping;
} wheel_columns[] = {
    {"wheels", 0, 2, 3, 9, 10, 11},          {"wheels2", 1, 3, 4, 10, 13, 14},
    {"meshwheels", 0, 3, 4, 10, 11, 12},     {"meshwheels2", 0, 3, 4, 10, 11, 12},
    {"flexbodywheels", 0, 3, 4, 10, 11, 12},
};
enum { WHEEL_SECTIONS = sizeof wheel_columns / sizeof *wheel_columns };

bool ror_is_wheel_section(const char *section) {
    for (size_t i = 0; i < WHEEL_SECTIONS; i++)
        if (strcmp(section, wheel_columns[i].section) == 0)
            return true;
    return false;
}

bool ror_read_wheel(ror_file *file, const char *section, scene_error *error) {
    const line_reader *reader = &file->reader;
    size_t kind = 0;
    while (strcmp(section, wheel_columns[kind].section) != 0)
        kind++;
    ror_wheel wheel;
    double rays = 0;
    memset(&wheel, 0, sizeof wheel);
    if (!line_number(reader, wheel_columns[kind].radius, 1e-3, 1e3, "radius, m", &wheel.radius, error) ||
        !line_number(reader, wheel_columns[kind].rays, 3, MOST_RAYS, "number of rays", &rays, error) ||
        !ror_node(file, wheel_columns[kind].end, &wheel.ends[0], error) ||
        !ror_node(file, wheel_columns[kind].end + 1, &wheel.ends[1], error) ||
        !line_number(reader, wheel_columns[kind].mass, MODEL_MIN_MASS, MODEL_MAX_VALUE, "mass, kg", &wheel.mass,
                     error) ||
        !line_number(reader, wheel_columns[kind].stiffness, 0, MODEL_MAX_VALUE, "spring, N/m", &wheel.stiffness,
                     error) ||
        !line_number(reader, wheel_columns[kind].damping, 0, MODEL_MAX_VALUE, "damping, N s/m", &wheel.damping,
                     error))
        return false;
    if (!(model_distance(file->made, wheel.ends[0], wheel.ends[1]) > 0))
        return line_fail(reader, wheel_columns[kind].end, error, "both ends of the axle are in one place");
    wheel.rays = (uint32_t)rays;
    if (!file->options->wheels)
        return true;
    void *wheels = file->wheels;
    if (!model_grow(&wheels, &file->wheel_capacity, file->wheel_count, sizeof wheel, error))
        return false;
    file->wheels = wheels;
    file->wheels[file->wheel_count++] = wheel;
    return true;
}

// The dry mass lies along the beams, half of each one's on either end; the cargo on the nodes that take it.
static void give_masses(ror_file *file) {
    model *made = file->made;
    double length = 0;
    size_t sharing = 0;
    for (size_t i = 0; i < made->beam_count; i++)
        length += model_distance(made, made->beams[i].a, made->beams[i].b);
    for (size_t i = 0; i < made->node_count; i++)
        sharing += file->loads[i].loaded && file->loads[i].weight < 0;
    for (size_t i = 0; i < made->node_count; i++) {
        const ror_load *load = &file->loads[i];
        made->nodes[i].mass = !load->loaded       ? 0
                              : load->weight >= 0 ? load->weight
                                                  : file->cargo_mass / (double)sharing;
    }
    for (size_t i = 0; length > 0 && i < made->beam_count; i++) {
        const model_beam *beam = &made->beams[i];
        double share = 0.5 * file->dry_mass * model_distance(made, beam->a, beam->b) / length;
        made->nodes[beam->a].mass += share;
        made->nodes[beam->b].mass += share;
    }
    uint32_t raised = 0;
    for (size_t i = 0; i < made->node_count; i++) {
        if (made->nodes[i].mass >= file->minimum_mass)
            continue;
        made->nodes[i].mass = file->minimum_mass;
        raised++;
    }
    if (raised)
        tally_add_text(&made->notes, "nodes raised to the least mass", raised);
}

static bool add_camera(ror_file *file, const ror_camera *camera, scene_error *error) {
    model_node node = {.mass = camera->mass};
    memcpy(node.at, camera->at, sizeof node.at);
    model_beam beam = {.a = (uint32_t)file->made->node_count,
                       .stiffness = camera->stiffness,
                       .damping = camera->damping,
                       .rest = 1};
    if (!model_add_node(file->made, &node, error))
        return false;
    for (size_t i = 0; i < sizeof camera->ends / sizeof *camera->ends; i++) {
        beam.b = camera->ends[i];
        if (!model_add_beam(file->made, &beam, error))
            return false;
    }
    return true;
}

static void cross(const double a[3], const double b[3], double result[3]) {
    for (int i = 0; i < 3; i++)
        result[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void normalise(double v[3]) {
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

// Two unit vectors across the axle, the first as far down (along y) as it goes: rings then stand on a node.
static void directions_across(const double axle[3], double down[3], double across[3]) {
    double unit[3] = {axle[0], axle[1], axle[2]};
    normalise(unit);
    const double below[3] = {0, -1, 0};
    const double ahead[3] = {1, 0, 0};
    cross(unit, fabs(unit[1]) < 0.9 ? below : ahead, across);
    normalise(across);
    cross(across, unit, down);
}

// A ring of nodes around each end of the axle, joined to both ends and to each other.
static bool add_wheel(ror_file *file, const ror_wheel *wheel, scene_error *error) {
    model *made = file->made;
    double axle[3];
    double down[3];
    double across[3];
    for (int i = 0; i < 3; i++)
        axle[i] = made->nodes[wheel->ends[1]].at[i] - made->nodes[wheel->ends[0]].at[i];
    directions_across(axle, down, across);
    const uint32_t first = (uint32_t)made->node_count;
    for (uint32_t ray = 0; ray < wheel->rays; ray++) {
        double angle = 2 * pi * ray / wheel->rays;
        for (int side = 0; side < 2; side++) {
            model_node node = {.mass = fmax(wheel->mass / (2.0 * wheel->rays), MODEL_MIN_MASS)};
            for (int i = 0; i < 3; i++)
                node.at[i] = made->nodes[wheel->ends[side]].at[i] +
                             wheel->radius * (cos(angle) * down[i] + sin(angle) * across[i]);
            if (!model_add_node(made, &node, error))
                return false;
        }
    }
    for (uint32_t ray = 0; ray < wheel->rays; ray++) {
        const uint32_t near_side = first + 2 * ray;
        const uint32_t next = first + 2 * ((ray + 1) % wheel->rays);
        const uint32_t pairs[][2] = {
            {near_side, wheel->ends[0]},     {near_side + 1, wheel->ends[1]}, {near_side, wheel->ends[1]},
            {near_side + 1, wheel->ends[0]}, {near_side, near_side + 1},      {near_side, next},
            {near_side + 1, next + 1},       {near_side, next + 1},           {near_side + 1, next},
        };
        for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
            model_beam beam = {.a = pairs[i][0],
                               .b = pairs[i][1],
                               .stiffness = wheel->stiffness,
                               .damping = wheel->damping,
                               .rest = 1};
            if (!model_add_beam(made, &beam, error))
                return false;
        }
    }
    return true;
}

bool ror_finish(ror_file *file, scene_error *error) {
    if (file->dry_mass < 0) {
        file->dry_mass = 0;
        tally_add_text(&file->made->notes, "no mass given (globals): all nodes have the least", 1);
    }
    give_masses(file);
    for (size_t i = 0; i < file->camera_count; i++)
        if (!add_camera(file, &file->cameras[i], error))
            return false;
    for (size_t i = 0; i < file->wheel_count; i++)
        if (!add_wheel(file, &file->wheels[i], error))
            return false;
    return true;
}
