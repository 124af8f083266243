/// @file ship.c
/// A ship out of cells and ropes.
///
/// SPDX-License-Identifier: MIT
#include "game/ship.h"

#include <massspring/massspring.h>

const ship_material ship_materials[SHIP_PARTS] = {
    [SHIP_HULL] = {.mass = 350, .displaced = 1000, .drag = 300, .room = 1000},
    [SHIP_MAST] = {.mass = 350, .displaced = 1000, .drag = 300, .room = 1000},
    [SHIP_ANCHOR] = {.mass = 4000, .displaced = 500, .drag = 300},
    [SHIP_ROPE] = {.mass = 30, .displaced = 20, .drag = 30, .wind = 5}, // some 2 m of it, 12 cm thick: it sinks
};

// Stiffness and damping, as fractions of what substeps bear.
static const float firmness = 0.02f, toughness = 0.03f;

static bool is_mast(int column, int row) {
    return (row < 3 && (column == 18 || column == 19)) || (row < 6 && (column == 40 || column == 41));
}

// A hull with a slanted bow and stern, a deck house, a mast on it and one before it.
static bool is_ship(int column, int row) {
    const bool hull = row >= 6 && column >= row - 6 && column < SHIP_WIDTH - (row - 6);
    const bool house = row >= 3 && row < 6 && column >= 12 && column < 26;
    return hull || house || is_mast(column, row);
}

// For the implicit solver what the fractions come to in a substep of the explicit one, between particles of a mass.
static void measure_spring(const ship_choice *choice, float mass, uint32_t *flags, float *stiffness,
                           float *damping) {
    const double h = choice->substep, half_mass = 0.5 * (double)mass;
    *flags = choice->implicit ? 0 : MSPRING_SPRING_RELATIVE;
    *stiffness = choice->implicit ? (float)((double)firmness * half_mass / (h * h)) : firmness;
    *damping = choice->implicit ? (float)((double)toughness * half_mass / h) : toughness;
}

static void add_hull(ship *made, mspring_builder *builder, const ship_choice *choice, mspring_id *ids) {
    static uint16_t cells[SHIP_HEIGHT * SHIP_WIDTH];
    mspring_material material = mspring_material_default();
    mspring_lattice_def def = mspring_lattice_def_default();
    for (int row = 0; row < SHIP_HEIGHT; row++)
        for (int column = 0; column < SHIP_WIDTH; column++)
            cells[row * SHIP_WIDTH + column] = is_ship(column, row) ? 0 : MSPRING_CELL_EMPTY;
    material.mass = ship_materials[SHIP_HULL].mass;
    measure_spring(choice, material.mass, &material.spring_flags, &material.stiffness, &material.damping);
    def.width = SHIP_WIDTH;
    def.height = SHIP_HEIGHT;
    def.y = -2;
    def.cells = cells;
    def.materials = &material;
    if (mspring_builder_add_lattice(builder, &def, ids) != MSPRING_OK)
        return;
    for (int cell = 0; cell < SHIP_WIDTH * SHIP_HEIGHT; cell++)
        if (ids[cell] != MSPRING_NONE) {
            made->part_of[ids[cell]] = is_mast(cell % SHIP_WIDTH, cell / SHIP_WIDTH) ? SHIP_MAST : SHIP_HULL;
            made->particles++;
        }
}

static void add_anchor(ship *made, mspring_builder *builder, const ship_choice *choice) {
    mspring_particle_def def = mspring_particle_def_default();
    def.x = choice->anchor_x;
    def.y = choice->anchor_y;
    def.mass = ship_materials[SHIP_ANCHOR].mass;
    mspring_builder_add_particles(builder, &def, 1, &made->anchor);
    made->part_of[made->particles++] = SHIP_ANCHOR;
}

static void add_rope(ship *made, mspring_builder *builder, const ship_choice *choice, mspring_id from,
                     mspring_id to, uint32_t segments) {
    mspring_material line = mspring_material_default();
    line.mass = ship_materials[SHIP_ROPE].mass;
    measure_spring(choice, line.mass, &line.spring_flags, &line.stiffness, &line.damping);
    mspring_rope_def def = mspring_rope_def_default();
    mspring_id first = MSPRING_NONE;
    def.from = from;
    def.to = to;
    def.segment_count = segments;
    def.material = &line;
    mspring_builder_add_rope(builder, &def, NULL, &first);
    made->first_rope = made->rope_springs == 0 ? first : made->first_rope;
    made->rope_springs += segments;
    for (uint32_t i = 1; i < segments; i++)
        made->part_of[made->particles++] = SHIP_ROPE;
}

void ship_build(ship *made, mspring_builder *builder, const ship_choice *choice) {
    static mspring_id ids[SHIP_HEIGHT][SHIP_WIDTH];
    *made = (ship){0};
    add_hull(made, builder, choice, ids[0]);
    add_anchor(made, builder, choice);
    made->mast_top = ids[0][40];
    made->brace_feet[0] = ids[6][31];
    made->brace_feet[1] = ids[6][49];
    const struct {
        mspring_id from, to;
        uint32_t segments;
    } ropes[SHIP_ROPES] = {
        {ids[0][18], ids[6][1], 10},    // the backstay, from the after mast's top to the stern
        {ids[0][19], ids[0][40], 10},   // between the masts' tops
        {ids[0][41], ids[6][62], 10},   // the forestay, to the bow
        {ids[6][63], made->anchor, 12}, // the anchor's line
    };
    for (int i = 0; i < SHIP_ROPES; i++)
        add_rope(made, builder, choice, ropes[i].from, ropes[i].to, ropes[i].segments);
}

void ship_braces(const ship *of, const ship_choice *choice, mspring_spring_def *defs) {
    for (int i = 0; i < SHIP_BRACES; i++) {
        defs[i] = mspring_spring_def_default();
        measure_spring(choice, ship_materials[SHIP_HULL].mass, &defs[i].flags, &defs[i].stiffness,
                       &defs[i].damping);
        defs[i].a = of->mast_top;
        defs[i].b = of->brace_feet[i];
    }
}

ship_part ship_part_of_spring(const ship *of, mspring_id a, mspring_id b) {
    return of->part_of[a] > of->part_of[b] ? of->part_of[a] : of->part_of[b];
}
