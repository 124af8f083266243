/// @file energy_budget.h
/// Energy budget of implicit substeps: no component gains energy, momentum or spin that no force explains.
///
/// A substep linearises each spring once. A slack rope, a fast rotation, or iterations that end too early then
/// stretch springs by more than the work of forces. So each component is checked after the substep and the floor:
///
///   - It is held if it has a pinned particle, if a grip holds one, or if the floor gave it an impulse in this
///     substep. Else it is free: momentum, and angular momentum about its mass centre, change by outside forces and
///     global damping only. A rigid motion corrects the velocities for the rest.
///   - Its budget is the energy before the substep plus the work of gravity and forces, less the energy of its
///     springs now, less the kinetic energy that its momenta need. Work of the floor does not count: the floor only
///     takes energy. A free component is seen from its mass centre, where gravity does no work. One whose pins all
///     move alike is seen from these, and without pins from the targets of its grips
///     (features/grips/implicit_grips.c). For other pins, the forces on them give an upper bound of their work.
///   - The floor's impulse on a component without pins is the change of momentum that nothing else explains.
///   - Kinetic energy beyond the budget is scaled out of the velocities: about the rigid motion of a free
///     component, about the pins or rest in a held one. Momenta stay.
///   - If the springs alone exceed the budget by little, the component moves back towards its start, as far as
///     needed. Spinning bodies and bodies at rest on the floor do so in most substeps. Shorter substeps would not
///     help them.
///   - If the gain is large, or moving back does not help, the substep is repeated by implicit Euler with twice the
///     iterations. If that does not help, two halves are taken, and so on, MSPRINGI_MOST_HALVINGS times. The
///     shortest one is always accepted, and each one once the step has spent its work (work.c). The next
///     MSPRINGI_RECOVERY_SUBSTEPS are of implicit Euler, too.
///
/// All sums have a fixed order, whatever the number of workers: blocks by kernels, then components in the order of
/// blocks.
///
///   budget_components.c  components
///   budget_sums.c        sums before and after a substep
///   budget_contact.c     the check over all bodies in contact
///   energy_budget.c      corrections that follow
///   walls.c              colliders that stop a correction
///   implicit_substeps.c  substeps and their halves
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ENERGY_BUDGET_H
#define MSPRINGI_ENERGY_BUDGET_H

#include "store/network.h"

/// Most halvings of a substep, and most with bodies in contact. (With 5 there, too, stiff bodies overlapped in 20
/// of 12,000 collisions by more than 0.63 of the thickness: the shortest substep acts by impulses alone.)
#define MSPRINGI_MOST_HALVINGS 5u
#define MSPRINGI_MOST_HALVINGS_OF_BODIES 8u

/// Most substeps of implicit Euler after one that gained energy. Without them a falling ship with rigging needed
/// twice as many substeps again.
#define MSPRINGI_RECOVERY_SUBSTEPS 15u

/// Counters of edits that may change elastic energy.
#define MSPRINGI_BUDGET_EDITS 6

/// No component, and several.
#define MSPRINGI_NO_COMPONENT MSPRING_NONE
#define MSPRINGI_SEVERAL_COMPONENTS (MSPRING_NONE - 1)

/// Sums over a run of blocks after a substep, beside its moments.
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
    double frame_x, frame_y; ///< m/s: of its pins, or of the targets of its grips, if they move alike, else 0
    uint32_t frame_pin;      ///< slot of one of them
    double given;            ///< work of moving pins, J
    double pushed;           ///< work of other bodies, J
    double push_room;        ///< that pushing overlaps apart may still take, J
    double x, y, vx, vy;     ///< mass centre before, from the origin
    double spin;             ///< about it before, kg m^2/s
    double turned;           ///< half the angle that it would turn by as a rigid body, rad
    double internal, flight; ///< before: elastic and kinetic about it; kinetic of it, J
    double keep;             ///< new velocities are keep v + (add_x, add_y) + turn x (r - centre)
    double add_x, add_y, turn;
    double shift_x, shift_y;               ///< of all positions, m
    bool is_free;                          ///< neither a pin nor the floor holds it
    bool is_stopped;                       ///< the floor or a collider is in its way, though it gave it no impulse
    uint32_t stop_slot;                    ///< slot where the floor is; MSPRING_NONE: a collider
    double share;                          ///< share of its way back that it moves
    bool is_rigid;                         ///< contact moves it as a rigid body
    double rigid_vx, rigid_vy, rigid_turn; ///< m/s, rad/s: of that motion before impulses
    double inverse_mass, inverse_inertia;  ///< 1/kg, 1/(kg m^2): of it
    double floor_gap, radius;              ///< of it: least distance from the floor; of its particles, m
    double rigid_elastic;                  ///< energy of its springs, which keep their lengths, J
    double push_x, push_y, push_turn;      ///< m/s, rad/s: by these; 0 if it is none
    double floor_impulse_x, floor_impulse_y; ///< N s that the floor has given it, but for what is counted
    uint32_t support_count;                  ///< floor contacts that hold it
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
    bool is_known;     ///< components and pins are up to date for these edits
    uint64_t links, growth, masses;
    bool is_driven;                       ///< some component is
    uint64_t seen[MSPRINGI_BUDGET_EDITS]; ///< edits after the last substep, and the origin then
    double origin_x, origin_y;
    bool knows_elastic;               ///< elastic and length of all accounts are still those of after it
    bool is_in_backup;                ///< the state before the substep is that of before the step
    float *state;                     ///< [6][slots] before the substep, if it is not
    mspringi_field impulse;           ///< of the floor before it
    double (*runs)[MSPRINGI_EFFECTS]; ///< [blocks] at the first of each run of blocks
    mspringi_elastic *elastic;        ///< [blocks]
} mspringi_budget;

mspring_result mspringi_budget_create(mspringi_budget *budget, mspring_network *network);
/// Set a range of the components' budgets to zero. All slots / 2 + 1 of them need it after creation.
void mspringi_budget_clear(const mspringi_budget *budget, uint32_t first, uint32_t end);
extern const mspringi_array_table mspringi_budget_columns;
void mspringi_budget_destroy(mspringi_budget *budget, mspringi_memory *memory);

/// Update the components. Allocates nothing.
void mspringi_budget_update(mspring_network *network);

/// True if a slot lies in no component.
static inline bool mspringi_budget_is_isolated(const mspringi_budget *budget, size_t slot) {
    return budget->of_slot[slot] == MSPRINGI_NO_COMPONENT;
}

/// See the energies of components without pins in the frames that features give them.
void mspringi_budget_find_frames(const mspring_network *network);

/// Save the state before a substep.
void mspringi_budget_begin(mspring_network *network);

/// The state before the substep.
mspringi_motion mspringi_budget_motion_before(const mspring_network *network);

/// Apply the budget after a substep of h seconds and the floor. Return false if the substep should be halved, only
/// with may_halve. Then mspringi_budget_undo() takes it back.
bool mspringi_budget_end(mspring_network *network, float h, mspringi_field base, bool may_halve);
void mspringi_budget_undo(mspring_network *network);

/* walls.c */

/// After a substep of h: stop components whose shift would deepen their overlap with a collider.
void mspringi_walls_stop_shifted(const mspring_network *network, double h);
/// Stop components that have gone back into a collider. True if any must be placed again.
bool mspringi_walls_stop_back(const mspring_network *network, double h);

/* budget_sums.c */

/// Arguments of the workers' sums.
typedef struct mspringi_budget_sums {
    mspring_network *network;
    mspringi_motion motion, before; ///< before: where it was, after a substep
    mspringi_field base;            ///< forces from outside
    float h;                        ///< length of the substep, after it
    bool is_after;
    bool knows_elastic; ///< elastic and length are up to date
    uint32_t workers;
} mspringi_budget_sums;

/// Compute sums, elastic and length of all components, and save the state before a substep. The work of moving pins
/// is separate.
void mspringi_budget_measure(mspringi_budget_sums *sums);
/// Add the forces from outside to the sums of the state before, with its places. The next measurement begins anew.
void mspringi_budget_add_forces(const mspringi_budget_sums *sums);
void mspringi_budget_add_pin_work(const mspringi_budget_sums *sums);

/// Motion of a component about its mass centre. Positions are from the component's origin.
typedef struct mspringi_mass_centre {
    double mass, x, y, vx, vy, inertia, spin, kinetic;
} mspringi_mass_centre;
mspringi_mass_centre mspringi_mass_centre_of(const mspringi_component_budget *component);
/// Rounding of an energy, J.
double mspringi_energy_rounding(const mspringi_component_budget *component, double energy);
/// True if all bodies in contact gained energy in a substep of h, beyond the work from outside.
bool mspringi_implicit_contact_gained_energy(const mspring_network *network, double h, mspringi_field base);
/// Let bodies in contact keep no motion but that of rigid ones, if contact acts by impulses alone; false: it does
/// not.
bool mspringi_implicit_contact_end_vibration(const mspring_network *network);
/// Work of gravity in a substep on a component in contact, J. Impulses between bodies err as much in an interval,
/// however short. (Without it heaps had seven of ten substeps taken in 16 to 256 intervals, and half of these
/// without friction.)
double mspringi_gravity_energy_in_contact(const mspring_network *network,
                                          const mspringi_component_budget *component, double mass);

#endif
