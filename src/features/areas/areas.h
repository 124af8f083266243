/// @file areas.h
/// Areas: closed polygons of particles with a pressure inside.
///
/// With A the area (shoelace formula), a = A / A0, k the stiffness, f the fill:
///
///     elastic  p = P + k (f - a)        E = k A0 (f - a)^2 / 2 + P A0 (f - a)
///     gas      p = P f / a              E = -P f A0 ln(a / f);  below a = 1 / 20 p stays what it is there
///     force    p g,  g = dA/dx: half the vector from the corner before to the corner behind, turned outwards
///     tangent  c g g',  c = -dp/dA;  the other part, of the size of p, only where a bound counts it
///
/// An elastic area of four corners that a lattice row's sweep has in its registers is computed there: with both
/// diagonals D, D' of the cell, A = D x D' / 2, and the forces act along pairs that the diagonals join (kernels/).
///
/// Angle springs are in the same list, and have the same functions (features/angles/).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_AREAS_H
#define MSPRINGI_AREAS_H

#include <math.h>

#include "builder/builder_areas.h"
#include "store/element_laws.h"

/// Counters of edits, see mspringi_edits.
typedef struct mspringi_areas_seen {
    uint64_t changes, links, growth, layouts, masses;
} mspringi_areas_seen;

/// All of them.
typedef struct mspringi_areas {
    mspringi_area *list; ///< [count] in the order of ids
    size_t count, capacity;
    mspringi_corner *corners; ///< [corner_count] of the first area, of the second, and so on
    size_t corner_count, corner_capacity;
    size_t angle_count; ///< areas in the list that are angles
    mspring_id next_id;
    uint64_t changes; ///< times that any was edited

    // What follows from these, the springs and the layout; see mspringi_areas_refresh().
    mspringi_areas_seen seen;
    uint32_t unswept;      ///< closed areas that the explicit solver's sweeps do not have in them
    uint32_t unringed;     ///< and those without springs all around
    uint32_t hinge_count;  ///< closed angles with springs along both arms
    double longest;        ///< substep that is stable with forces of these alone, s
    double longest_of_all; ///< and with those of all
} mspringi_areas;

/// The list, empty at first.
mspring_result mspringi_areas_make(mspring_network *network);
/// Room for so many more areas and corners, and for what steps need of them; some of the areas are angles.
mspring_result mspringi_areas_reserve(mspring_network *network, size_t areas, size_t corners, size_t angles);

/// Add one to the list, for which there is room: its corners in the order in which its area is positive. Its rest
/// area is set.
void mspringi_areas_append(mspring_network *network, const mspringi_area *area, const mspring_id *particles);
/// Take those out of the list that lack a corner, or have none.
void mspringi_areas_forget(mspring_network *network);
/// There is none any more; after mspringi_areas_make().
void mspringi_areas_clear(mspring_network *network);

/// Find out which areas are open, which ones sweeps have in them, and the substep that they are stable with.
void mspringi_areas_refresh(mspring_network *network);

/// The slots of a lattice's cell, in their order around it: here, to the right, above that, above. False: there is
/// none at this slot.
bool mspringi_cell_at(const mspring_network *network, uint32_t slot, uint32_t corners[4]);

/// Areas and angles in the list.
static inline size_t mspringi_area_count(const mspring_network *network) {
    return network->areas ? network->areas->count : 0;
}

/// The id that the next area or angle gets.
static inline mspring_id mspringi_area_next_id(const mspring_network *network) {
    return network->areas ? network->areas->next_id : 0;
}

/* ------------------------------------------------------------------------------------------------------- edits */

/// Reserve room for so many more.
mspring_result mspringi_areas_check_room(mspring_network *network, size_t areas, size_t corners, size_t angles);

/// Give one the next id and add it: there is room, and all has been checked.
void mspringi_area_add(mspring_network *network, mspringi_area made, const mspring_id *particles);
/// Add those of a builder to a network that is made of it.
mspring_result mspringi_areas_of_builder(mspring_network *network, const mspring_builder *builder);
/// Angles in a section of a snapshot that has been checked.
size_t mspringi_saved_angles(const uint8_t *from, size_t size);
/// Tell that one is another from now on.
void mspringi_area_tell(mspring_network *network, uint32_t edit, const mspringi_area *area);

/* ---------------------------------------------------------------------------------------------------- one area */

bool mspringi_area_is_open(const mspring_network *network, const mspringi_area *area);
/// A, m^2.
double mspringi_area_size(const mspring_network *network, const mspringi_area *area);
/// p, and c, in N/m and N/m^3, by A; of no angle.
double mspringi_area_pressure(const void *area, double size);
double mspringi_area_stiffness(const void *area, double size);
double mspringi_area_energy(const void *area, double size);
/// The area or angle as an element, but for its number.
mspringi_element_ref mspringi_area_element(const mspring_network *network, const mspringi_area *area);

static inline uint32_t mspringi_area_slot(const mspring_network *network, const mspringi_area *area,
                                          uint32_t corner) {
    return network->topology.slot_of_particle[network->areas->corners[area->first + corner].particle];
}

/// Add the forces of an area, or a share of them, to a field.
void mspringi_area_push(const mspring_network *network, const mspringi_area *area, double share,
                        mspringi_field field);

/// The laws of an area and of an angle, and functions of these names where the area is an angle.
extern const mspringi_element_law mspringi_law_of_areas;
typedef struct mspringi_angle_law {
    mspringi_element_law of_element;
    void (*push)(const mspring_network *network, const mspringi_area *angle, double share, mspringi_field field);
    double (*between_arms)(const mspring_network *network, const mspringi_area *angle); ///< rad
    void (*set)(mspringi_area *angle, mspring_property property, float value); ///< stiffness, damping, rest angle
} mspringi_angle_law;

#define ANGLES(table) extern const mspringi_angle_law table;
#include "store/features.def"

/// NULL: a build without angles, so no area is one.
extern const mspringi_angle_law *const mspringi_angles;

#endif
