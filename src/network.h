/// @file network.h
/// What a network holds.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_NETWORK_H
#define MSPRINGI_NETWORK_H

#include "kernels/kernels.h"
#include "topology.h"

/// Two floats per slot, x and then y, in one block of memory.
typedef struct mspringi_field {
    float *x, *y;
} mspringi_field;

/// What a step changes. The four arrays lie behind one another in one block of memory, so that they can be
/// copied at once.
typedef struct mspringi_state {
    float *x, *y, *vx, *vy;
} mspringi_state;

/// Forces from outside, in N by slot. Fields that a network does not need are NULL.
typedef struct mspringi_forces {
    mspringi_field held;  ///< given by the host for the next step
    mspringi_field base;  ///< held and what hooks before the step added: where each substep starts from
    mspringi_field total; ///< base, hooks before the substep, and leftover springs
    bool held_any;        ///< held is not all zero
    bool total_clean;     ///< total is zero but for the slots of attached nodes
} mspringi_forces;

typedef struct mspringi_hook {
    mspring_phase phase;
    mspring_hook_fn fn;
    void *user;
    uint32_t number;
} mspringi_hook;

/// Stiffness and damping as fractions; stiffness < 0 for a spring that is not relative.
typedef struct mspringi_relative {
    float stiffness, damping;
} mspringi_relative;

struct mspring_network {
    mspringi_memory memory;
    mspringi_message message;
    mspringi_topology topology;
    const mspringi_kernels *kernels;

    // State.
    mspringi_state state, backup;
    double origin_x, origin_y; ///< world = origin + local
    float recentre_distance;   ///< how far the network may be from its origin until that is moved along

    // Parameters.
    float *inverse_mass; ///< [slots] 0 if pinned or empty
    float *mass;         ///< [particles]
    uint32_t parts;      ///< values per spring in the records: 2, or 3 with damping
    float *lattice_springs, *chain_springs;
    float *web_springs;
    float *packed;               ///< [nodes of the web][4]
    float *attached;             ///< forces on the attached nodes, all x and then all y
    mspringi_relative *relative; ///< [springs], or NULL if no spring is relative
    float relative_h;            ///< the substep that relative springs were derived for; 0: not yet
    uint32_t depth;              ///< substeps that may be swept in one pass over the lattice rows
    float *carry;                ///< a carry row for each of them, x and then y

    float gravity_x, gravity_y, global_damping, max_speed;
    uint32_t substeps;

    mspringi_forces forces;
    mspringi_hook *hooks;
    size_t hook_count, hook_capacity;
    uint32_t next_hook;
    bool in_hook;
};

static inline size_t mspringi_slot_count(const mspring_network *network) {
    return (size_t)network->topology.block_count * MSPRINGI_WIDTH;
}

/// Refuse NULL, and calls from inside a hook.
mspring_result mspringi_enter(mspring_network *network);

/// Refuse ranges of ids that leave the network.
mspring_result mspringi_check_range(mspring_network *network, const char *what, mspring_id first, uint32_t count,
                                    uint32_t total);

/// Allocate a field of all slots, zeroed; leaves it alone if it is there.
mspring_result mspringi_field_reserve(mspring_network *network, mspringi_field *field);

/// What a spring is like, and the slots that it joins.
typedef struct mspringi_spring_values {
    float rest_length, stiffness, damping;
    uint32_t base, tip;
} mspringi_spring_values;
mspringi_spring_values mspringi_spring_get(const mspring_network *network, mspring_id spring);
/// Set rest length, stiffness and damping, wherever the spring has records.
void mspringi_spring_set(mspring_network *network, mspring_id spring, const mspringi_spring_values *values);

/// Derive stiffness and damping of the relative springs for a substep.
void mspringi_derive_relative(mspring_network *network, float h);

/// Deepest pass over the lattice rows that is worth it for this topology.
uint32_t mspringi_explicit_depth(const mspringi_topology *topology, uint32_t parts);

/// Take count substeps of length h, all with the forces from outside that are in base (x NULL: none).
void mspringi_explicit_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count);

/// Call the hooks of a phase with the given force field (x NULL: none).
void mspringi_hooks_call(mspring_network *network, mspring_phase phase, uint32_t substep, double dt,
                         mspringi_field field);
bool mspringi_hooks_any(const mspring_network *network, mspring_phase phase);

typedef struct mspringi_box {
    double min_x, min_y, max_x, max_y;
} mspringi_box;
mspringi_box mspringi_box_empty(void);
void mspringi_box_include(mspringi_box *box, double x, double y);

/// Put the origin at the middle of the box. The positions are the caller's to set anew.
void mspringi_origin_choose(mspring_network *network, const mspringi_box *box);
/// Set a particle's world position.
void mspringi_set_position(mspring_network *network, mspring_id particle, double x, double y);
/// Move the origin along if the network has gone far from it. Exact: no particle's world position changes.
void mspringi_origin_follow(mspring_network *network);

#endif
