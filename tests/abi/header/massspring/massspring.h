/// @file massspring.h
/// libmassspring simulates two-dimensional networks of masses, springs and dampers. This is the only header to include.
///
/// A network is a set of particles with mass, joined by springs with stiffness and damping. You describe it to a
/// builder, create a network from the builder, step it by dt, and read it.
///
///     builder --create--> network (topology + state) --step--> columns, views, reports, events
///        ^---- read ---- archive <-- write --'
///
/// **The 14 functions you need**
///
///     mspring_builder_create           begin a description
///     mspring_builder_add_particles    add masses
///     mspring_builder_add_springs      join them
///     mspring_builder_add_lattice      add a grid of cells, as an image gives it
///     mspring_builder_destroy          free the description
///     mspring_network_create           make a network
///     mspring_network_step             evolve it by dt
///     mspring_network_get_positions    read where particles are
///     mspring_network_apply_force      push a particle during the next step
///     mspring_network_break_springs    break springs
///     mspring_network_set_floor        give it ground and walls
///     mspring_network_read_events      learn what broke
///     mspring_network_error            learn what was wrong with a call
///     mspring_network_destroy          free the network
///
/// **All functions by header.** Names lack mspring_ here; network_x stands for mspring_network_x.
///
///     core.h      library     version, version_string, features, result_string, init, simd_available, simd_name
///                 builder     builder_create, _destroy, _error, _forget_error, _count, _add_particles, _add_springs,
///                             _add_lattice, _add_rope, _add_mesh, _add_disc, _add_copies, _add_network,
///                             _get_particles, _get_springs, _read, _get_network_def; material_preset
///                 network     network_create, _destroy, _error, _count, _clone, _get_info, _set_settings,
///                             _get_settings
///                 step        network_step, _get_step_info, _wake
///                 forces      network_apply_force, _apply_forces, _apply_torque
///                 state       network_get_positions, _set_positions, _get_velocities, _set_velocities, _get_view,
///                             _get_state_hash
///                 properties  network_get, _set, _get_integers, _set_integers, _get_columns
///                 edits       network_break_springs, _restore_springs, _detach_particles, _add_particles,
///                             _add_springs, _remove_particles, _remove_springs, _reuse_ids, _compact
///                 events      network_reserve_events, _read_events, _update_components, _get_components
///                 measure     network_get_energy, _get_body, _get_stable_dt, _suggest_substeps
///                 find        network_nearest_particle, _nearest_spring, _particles_in_circle, _particles_in_box,
///                             _springs_in_circle, _springs_across
///                 hooks       network_add_hook, _remove_hook
///                 store       network_get_snapshot_size, _save, _load, _write
///     contact.h   floor, contact between bodies, colliders, grips
///     laws.h      areas and angle springs
///     batch.h     groups and actuators
///     lab.h       experimental, if MSPRING_EXPERIMENTAL is defined: settle, tune, jobs, strain limits, describe
///
/// massspring_gradient.h, to include beside it, has derivatives of runs.
///
/// **Which things a call is about.** Calls about many particles, springs or other things take (ids, first, count). If
/// ids is NULL, element i is the thing with the id first + i; otherwise it is ids[first + i]. If the call has no array
/// of values, or its stride is 0, count may be MSPRING_ALL: all from first on; ids is NULL then. In a range removed
/// things are left out; they read as 0, their ids and slots as MSPRING_NONE. In a list they are an error.
///
/// **Strides.** A value of element i stands at values[i * stride]: 1 for an array, 2 with y = x + 1 for one of vectors,
/// more for a field of structs. To read, a stride is at least 1. To write, 0 gives all the same value.
///
/// **Words.** A slot is an index into the arrays of a view; an id is another number. A hook is a function of yours that
/// steps call. A component is all particles that unbroken springs connect, or a lone one. An element is an area or an
/// angle spring.
///
/// **Units** are SI: metres, kilograms, seconds, newtons, N/m, N s/m. The y axis points up.
///
/// **Physics.** The explicit solver is leapfrog in substeps of length h. For a spring between the particles a and b:
///
///     d = p_b - p_a;  L = |d|;  u = d / L
///     f = (L - rest_length) * stiffness + ((v_b - v_a) . u) * damping
///     F_a += f u;  F_b -= f u
///     v(t+h/2) = v exp(-b k) + (F / m + gravity) (1 - exp(-b k)) / b;   p(t+h) = p + v(t+h/2) h
///
/// with b = global_damping; where that is 0, gravity and forces act for k. Velocities given at creation are of now;
/// those that you read or set later are half a substep old. So k = (h_previous + h) / 2, with the last explicit substep
/// before, 0 at creation. For springs k is at most what is stable in any shape, if an edit has made that less; where
/// springs are relative, k = h if h changes; with groups k = h. A spring of length 0 has no direction and exerts no
/// force. A pinned particle feels no force: it keeps the velocity that the host gives it, at first zero, and moves by
/// it. With damping, a speed below 1e-30 m/s becomes 0.
///
/// **Precision.** Positions and velocities are single precision, relative to a local origin in double precision. The
/// library moves the origin with the network. A network 10 km from the world's origin behaves as it does there. Each
/// position has a second, smaller word, so no substep rounds away what it adds. Views show the first word only.
///
/// **Many small bodies.** Put them in one network: it sweeps them side by side, several times faster than a network for
/// each. They share one local origin, settings and dt and, unless they are groups (batch.h), rejected steps.
///
/// **Same bits.** The same calls give the same state, bit for bit. SIMD level, number of workers, compiler and
/// optimisation level make no difference. This holds within one minor version (0.3.x). Compare by
/// mspring_network_get_state_hash().
///
/// **Errors.** If a function can fail, it returns a mspring_result. A failed call changes nothing and leaves
/// out-parameters alone. It sets the error message of its object, which names the fault and the place. No
/// function prints, exits or aborts. The library cannot detect one mistake: a handle that was destroyed. "Errors:"
/// lists the results other than MSPRING_OK, without the prefix MSPRING_ERROR_. ARGUMENT is always a NULL that is not
/// allowed, or a value outside its range, such as NaN. STRUCT is always a struct of an impossible size.
///
/// **Threads.** The library has no global state. "any": no rule. "shared": several threads may make such calls on one
/// object at once. "exclusive": no other call on that object may overlap. Calls on different objects may always
/// overlap. With workers (mspring_network_def), the library divides a step among threads itself. After fork() the
/// child may use its copies: its first step starts the workers again.
///
/// **Memory.** "Allocates:" says when a function allocates. A step allocates only where contact has to grow, and never
/// if its max_capacity is its capacity (mspring_contact_def).
///
/// **ABI.** Handles are opaque, and no exported function takes or returns a struct by value. Ids, counts, capacities
/// and strides are uint32_t, sizes in bytes size_t, enums signed integers of 32 bits, flags uint32_t. Reading functions
/// begin with get_ and write into your memory; those that return a number return 0 for NULL.
///
/// **Structs.** All but mspring_event, mspring_column and mspring_observation, which never change, begin with
/// struct_size. Fill one with mspring_init(), or with its inline form mspring_x_default(), whether you give it to the
/// library or the library fills it. Structs grow at the end only. A program that was built for an earlier version gives
/// shorter ones: what it does not give has its default, and what it has no room for is not written. A newer program may
/// give longer ones: what this version does not know must be 0. A field that is added later always means the same as
/// before if it is 0. Fields named reserved must be 0. Ignore flags, results and kinds of event that you do not know: a
/// result below 0 is an error.
///
/// **Frozen.** From 1.0 on, nothing in core.h, contact.h, laws.h and batch.h changes or goes: they only grow. What
/// lab.h has may change in each minor version. Programs that use it ask for exactly this one: the loader tells if there
/// is another.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_H
#define MASSSPRING_MASSSPRING_H

#include "core.h"

#include "batch.h"
#include "contact.h"
#include "laws.h"

#endif

// Outside of the guard: another header may have included this one before MSPRING_EXPERIMENTAL was defined.
#ifdef MSPRING_EXPERIMENTAL
#include "lab.h"
#endif
