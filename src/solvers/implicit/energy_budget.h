/// @file energy_budget.h
/// The energy budget of implicit substeps: no component gets energy, momentum or spin from nowhere.
///
/// A substep linearises every spring once. A slack rope, a lattice that turns fast, or iterations that end too
/// early then stretch springs by more than any force has done work for. So after each substep, and after the floor
/// has acted, every component (all that live springs join) is looked at by itself:
///
///   - It is held if it has a pinned particle, if a grip holds one, or if the floor has given it an impulse in this
///     substep. Else it is free: momentum and angular momentum about its mass centre are what they were, with what
///     forces from outside and global damping have added. Where the substep has changed them otherwise, the
///     velocities get a rigid motion that makes up for it.
///   - Its room is the energy from before the substep, with the work of gravity and forces, less what its springs
///     have now and less what its momenta demand. Work of the floor does not count: it can only take energy. A free
///     component is seen from its mass centre, where gravity does no work, and one whose pins all move alike from
///     these, where they do none. Of other pins the forces on them tell their work, by more rather than less.
///   - What the floor has given a component that no pin holds is what its momentum lacks, and counts as impulse.
///   - What velocities have beyond that room is scaled out of them, about the rigid motion of a free component,
///     about its pins or rest in a held one. Momenta stay.
///   - If springs alone have a little more than the room, the component goes back towards where it was, as far as
///   it
///     must: bodies that spin and bodies that rest on the floor do so in most substeps, and pieces would not help
///     them.
///   - If a component has gained much, or going back does not help, the whole substep is taken again by implicit
///     Euler, with twice the iterations. If that does not help, two halves of it are taken, and so on,
///     MSPRINGI_MOST_HALVINGS times. The shortest piece is not refused. The next MSPRINGI_RECOVERY_SUBSTEPS are of
///     implicit Euler, too.
///
/// All sums have a fixed order, whatever the number of workers: blocks by kernels, then components in the order of
/// blocks.
///
///   budget_components.c   which components there are
///   budget_sums.c         sums before and after
///   energy_budget.c       what follows from them
///   implicit_substeps.c     substeps and their halves
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ENERGY_BUDGET_H
#define MSPRINGI_ENERGY_BUDGET_H

#include "store/network.h"

/// Times that a substep is halved; and where bodies touch. (With 5 there, too, stiff bodies overlapped in 20 of
/// 12,000 collisions by more than 0.63 of the thickness: the last piece holds them by impulses alone.)
#define MSPRINGI_MOST_HALVINGS 5u
#define MSPRINGI_MOST_HALVINGS_OF_BODIES 8u

/// Substeps of implicit Euler, at most, from one that got energy from nowhere on. Without them a falling ship with
/// rigging had to take twice as many again.
#define MSPRINGI_RECOVERY_SUBSTEPS 15u

/// Counters of edits that may change elastic energy.
#define MSPRINGI_BUDGET_EDITS 7

/// No component, and several.
#define MSPRINGI_NO_COMPONENT MSPRING_NONE
#define MSPRINGI_SEVERAL_COMPONENTS (MSPRING_NONE - 1)

/// What is summed over a run of blocks after a substep, beside its moments.
enum {
    MSPRINGI_EFFECT_X = MSPRINGI_MOMENTS, ///< forces from outside, N
    MSPRINGI_EFFECT_Y,
    MSPRINGI_EFFECT_TORQUE, ///< of these about the origin, halfway, N m
    MSPRINGI_EFFECT_WORK,   ///< of these, J
    MSPRINGI_EFFECT_TOUCH,  ///< particles that the floor has given an impulse
    MSPRINGI_EFFECTS
};

/// A component in a substep.
typedef struct mspringi_component_budget {
    uint32_t first_slot;
    bool is_pinned, is_driven, is_asleep; ///< driven: its pinned particles do not all move alike
    bool is_held;                         ///< by a grip
    bool is_touched;                      ///< by another body
    bool exceeds;                         ///< its springs alone have too much energy
    bool gains;                           ///< springs and velocities together have much too much
    double origin[4];                     ///< x, y, vx, vy of its first slot before the substep
    double sums[MSPRINGI_EFFECTS];
    double elastic, length;  ///< J, as in mspringi_elastic
    double frame_x, frame_y; ///< m/s: of its pins if they move alike, else 0
    uint32_t frame_pin;      ///< slot of one of them
    double given;            ///< work of pins that do not, J
    double pushed;           ///< work of other bodies, J
    double x, y, vx, vy;     ///< mass centre before, from the origin
    double spin;             ///< about it before, kg m^2/s
    double turned;           ///< half the angle that it would turn by as a rigid body, rad
    double internal, flight; ///< before: elastic and kinetic about it; kinetic of it, J
    double keep;             ///< new velocities are keep v + (add_x, add_y) + turn x (r - centre)
    double add_x, add_y, turn;
    double shift_x, shift_y; ///< of all positions, m
    bool is_free;            ///< neither a pin nor the floor holds it
    bool is_stopped;         ///< the floor or a collider is in its way, though it gave it no impulse
    uint32_t stop_slot;      ///< slot where the floor is; MSPRING_NONE: a collider
    double share;            ///< of its way that it goes
    double floor_impulse_x, floor_impulse_y; ///< N s that the floor has given it, but for what is counted
    uint32_t support_count;                  ///< contacts that hold it
    uint32_t second_support_slot;            ///< slot of another particle that the floor acts on
} mspringi_component_budget;

typedef struct mspringi_budget {
    mspringi_component_budget *components; ///< [slots / 2 + 1]
    uint32_t count;
    uint32_t *of_slot;               ///< [slots]
    uint32_t *of_block, *of_springs; ///< [blocks] that all particles, or springs of the row, of a block are in
    uint32_t *pins;                  ///< [slots] those of pinned particles in components
    uint32_t pin_count;
    bool has_isolated; ///< some particles outside the loose row have no live springs
    bool is_known;     ///< which components and pins there are, for these edits
    uint64_t links, growth, grafts, masses;
    bool is_driven;                       ///< some component is
    uint64_t seen[MSPRINGI_BUDGET_EDITS]; ///< edits after the last substep, and the origin then
    double origin_x, origin_y;
    bool knows_elastic;               ///< elastic and length of all accounts are still those of after it
    float relative_h;                 ///< what relative springs were derived for then
    bool is_in_backup;                ///< the state before the substep is that of before the step
    float *state;                     ///< [6][slots] before the substep, if it is not
    mspringi_field impulse;           ///< of the floor before it
    double (*runs)[MSPRINGI_EFFECTS]; ///< [blocks] at the first of each run of blocks
    mspringi_elastic *elastic;        ///< [blocks]
} mspringi_budget;

mspring_result mspringi_budget_create(mspringi_budget *budget, mspring_network *network);
/// Set a range of the accounts to zero, of which there are slots / 2 + 1: all are to be, after it was made.
void mspringi_budget_clear(const mspringi_budget *budget, uint32_t first, uint32_t end);
extern const mspringi_array_table mspringi_budget_columns;
void mspringi_budget_destroy(mspringi_budget *budget, mspringi_memory *memory);

/// Have the components that there are. Allocates nothing.
void mspringi_budget_update(mspring_network *network);

/// Whether a slot is of no component.
static inline bool mspringi_budget_is_isolated(const mspringi_budget *budget, size_t slot) {
    return budget->of_slot[slot] == MSPRINGI_NO_COMPONENT;
}

/// Before a substep: keep what it begins with.
void mspringi_budget_begin(mspring_network *network);

/// After a substep of h seconds, and after the floor. Returns false if the substep should be taken in halves, which
/// is only if may_halve; mspringi_budget_undo() then takes it back.
bool mspringi_budget_end(mspring_network *network, float h, mspringi_field base, bool may_halve);
void mspringi_budget_undo(mspring_network *network);

/* walls.c */

/// After a substep of h: stop components whose shift would deepen their overlap with a collider.
void mspringi_walls_stop_shifted(const mspring_network *network, double h);
/// Stop components that have gone back into a collider. True if any must be placed again.
bool mspringi_walls_stop_back(const mspring_network *network, double h);

/* budget_sums.c */

/// What the workers sum up.
typedef struct mspringi_budget_sums {
    mspring_network *network;
    mspringi_motion motion, before; ///< before: where it was, after a substep
    mspringi_field base;            ///< forces from outside
    float h;                        ///< length of the substep, after it
    bool is_after;
    bool knows_elastic; ///< elastic and length are there already
    uint32_t workers;
} mspringi_budget_sums;

/// Fill in the sums, elastic and length of all accounts, and before a substep keep the state. Moving pins' work is
/// extra.
void mspringi_budget_measure(mspringi_budget_sums *sums);
void mspringi_budget_add_pin_work(const mspringi_budget_sums *sums);

/// A component about its mass centre, which is told from the origin.
typedef struct mspringi_mass_centre {
    double mass, x, y, vx, vy, inertia, spin, kinetic;
} mspringi_mass_centre;
mspringi_mass_centre mspringi_mass_centre_of(const mspringi_component_budget *component);
/// What of an energy may be rounding, J.
double mspringi_energy_rounding(const mspringi_component_budget *component, double energy);
/// Whether all that touches would have more energy together than before a substep of h, but for work from outside.
bool mspringi_implicit_contact_gained_energy(const mspring_network *network, double h, mspringi_field base);
/// What gravity would give in a substep to what touches other bodies, J. In a piece of it, however short, impulses
/// between them err as much. (Without it heaps had seven of ten substeps taken in 16 to 256 pieces, and half of
/// these without friction.)
double mspringi_gravity_energy_in_contact(const mspring_network *network,
                                          const mspringi_component_budget *component, double mass);

#endif
