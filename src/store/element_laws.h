/// @file element_laws.h
/// Elements as energies of one number each: its size, which the positions of its corners give.
///
/// With E the energy at the size q and g = dq/dx at a corner, an element has the force f g, f = -dE/dq, and the
/// stiffness c g g', c = -df/dq. The rest of the tangent is of the size of f. Stability, settling and the fine run
/// of tuning know no more of elements than their laws, and each has code for all of them. Linear systems have the
/// functions of elements.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ELEMENT_LAWS_H
#define MSPRINGI_ELEMENT_LAWS_H

#include <float.h>

#include "store/network.h"

typedef struct mspringi_vector {
    double x, y;
} mspringi_vector;

typedef struct mspringi_corner {
    mspring_id particle;
    mspring_id spring; ///< to the next corner when the element was added; MSPRING_NONE: there was none
    uint32_t slot;     ///< of the particle, since the elements were last refreshed
    float reach;       ///< length of g when the element was added
} mspringi_corner;

/// An element of a feature's.
typedef struct mspringi_element_ref {
    const struct mspringi_element_law *law;
    const void *of; ///< its feature's own record
    const mspringi_corner *corners;
    uint32_t count; ///< corners, 3 or more. Consecutive ones, and the last with the first, have sides
    uint32_t first; ///< number of its first corner among those of all
    mspring_id id;
    double damping;  ///< f decreases by this times the rate of the size
    bool is_ringed;  ///< the sides that need a spring have one
    bool owns_sides; ///< its sides need no springs when it settles
    bool is_paired;  ///< four corners; those opposite each other have opposite g
} mspringi_element_ref;

/// Positions of particles: of the corners of the element at hand, if they are gathered; else of a network, if there
/// is one; else by particle.
typedef struct mspringi_positions {
    const mspringi_vector *corners;
    const mspring_network *network;
    const double *x, *y;
    const double *moved_x, *moved_y; ///< added to x and y; NULL: nothing is
} mspringi_positions;

static inline uint32_t mspringi_slot_of_corner(const mspring_network *network, const mspringi_element_ref *e,
                                               uint32_t corner) {
    return network->topology.slot_of_particle[e->corners[corner].particle];
}

/// The way from one corner to another.
mspringi_vector mspringi_way_between(const mspringi_positions *at, mspring_id from, mspring_id to);
static inline mspringi_vector mspringi_way_of(const mspringi_positions *at, const mspringi_element_ref *e,
                                              uint32_t from, uint32_t to) {
    return at->corners
               ? (mspringi_vector){at->corners[to].x - at->corners[from].x, at->corners[to].y - at->corners[from].y}
               : mspringi_way_between(at, e->corners[from].particle, e->corners[to].particle);
}

/// Room for the positions of corners, so that each is found once: a tenth fewer instructions for cells.
typedef struct mspringi_gathered {
    mspringi_positions at;
    mspringi_vector corners[512];
} mspringi_gathered;

/// Gather the positions of an element's corners if there is room. Its laws have the same bits with them.
const mspringi_positions *mspringi_gather(mspringi_gathered *room, const mspringi_positions *all,
                                          const mspringi_element_ref *e);

/// Within what a float can be: the guard finds what is that large.
static inline float mspringi_bounded(double value) {
    const double most = (double)FLT_MAX, above = value > -most ? value : -most; // -most if it is no number
    return (float)(above < most ? above : most);
}

/// Displacements of particles: t step + t^2 curvature.
typedef struct mspringi_move {
    double t;
    const double *step_x, *step_y, *curvature_x, *curvature_y; ///< by particle
} mspringi_move;

/// By how much such a way gets another.
static inline mspringi_vector mspringi_move_of(const mspringi_move *m, const mspringi_element_ref *e, uint32_t from,
                                               uint32_t to) {
    const uint32_t a = e->corners[from].particle, b = e->corners[to].particle;
    const double t = m->t;
    return (mspringi_vector){t * ((m->step_x[b] - m->step_x[a]) + t * (m->curvature_x[b] - m->curvature_x[a])),
                             t * ((m->step_y[b] - m->step_y[a]) + t * (m->curvature_y[b] - m->curvature_y[a]))};
}

/// Symmetric block of a stiffness matrix.
typedef struct mspringi_side_block {
    double xx, xy, yy;
} mspringi_side_block;

/// Bound of an element in the shape that it was added in: on c, and on the row sum of the rest at a corner.
typedef struct mspringi_element_bound {
    double stiffness, rest;
} mspringi_element_bound;

/// Functions of an element.
typedef struct mspringi_element_law {
    double (*size)(const mspringi_element_ref *e, const mspringi_positions *at);
    mspringi_vector (*gradient)(const mspringi_element_ref *e, const mspringi_positions *at, uint32_t corner);
    double (*force)(const void *of, double size);
    double (*stiffness)(const void *of, double size);
    double (*energy)(const void *of, double size);
    /// By how much its energy increases with a move, exact where that is little. Adds to *sum what it is summed of.
    double (*energy_change)(const mspringi_element_ref *e, const mspringi_positions *at, const mspringi_move *move,
                            double *sum);
    /// Stiffness of springs along its sides that have as much together, by sides. clamped: without what makes it
    /// indefinite.
    void (*blocks)(const mspringi_element_ref *e, const mspringi_positions *at, bool clamped,
                   mspringi_side_block *blocks);
    /// Stiffness of a spring along a side, relative to f: together they bound the rest of the tangent.
    double (*rest)(const mspringi_element_ref *e, const mspringi_positions *at, uint32_t side);
    mspringi_element_bound (*bound)(const void *of);
} mspringi_element_law;

/// A walk through elements. Open ones, of which a spring is broken, have no force.
typedef struct mspringi_element_walk {
    const mspring_network *network;
    bool has_open, is_fresh; ///< is_fresh: elements were refreshed since the last change
    uint32_t list, corners;  ///< and how many corners those before had
    size_t next;             ///< index in that list
    mspringi_element_ref element;
} mspringi_element_walk;

/// The elements of a feature.
typedef struct mspringi_element_list {
    bool (*next)(mspringi_element_walk *walk); ///< sets the element, but for its number
    void (*refresh)(mspring_network *network);
    double (*longest)(const mspring_network *network); ///< see mspringi_elements_longest()
} mspringi_element_list;

#define ELEMENTS(table) extern const mspringi_element_list table;
#include "store/features.def"

/// Begin a walk through those that are closed; go to its next element, or return false if there is none.
static inline mspringi_element_walk mspringi_walk_elements(const mspring_network *network) {
    return (mspringi_element_walk){.network = network};
}
static inline mspringi_element_walk mspringi_walk_all_elements(const mspring_network *network) {
    return (mspringi_element_walk){.network = network, .has_open = true};
}
bool mspringi_element_next(mspringi_element_walk *walk);
bool mspringi_elements_exist(const mspring_network *network);
/// Find out which ones are open, so that walks need not, and the slots of their corners.
void mspringi_elements_refresh(mspring_network *network);
/// Longest substep that is stable with the forces of those that linear systems do not have in them, s; or INFINITY.
double mspringi_elements_longest(const mspring_network *network);

/// Size and energy in the present shape.
double mspringi_element_size(const mspring_network *network, const mspringi_element_ref *e);
double mspringi_element_energy(const mspring_network *network, const mspringi_element_ref *e);

/// The sums of the weights of springs that bound an element in the shape that it was added in, N/m, added to those
/// by slot; and those of dampers that bound that of its rate, N s/m.
void mspringi_element_weigh(const mspring_network *network, const mspringi_element_ref *e, float *sums,
                            float *dampings);
/// The largest sum of such quotients, sums times inverse masses, of two corners that share a weight.
double mspringi_element_largest(const mspring_network *network, const mspringi_element_ref *e, const float *sums);

#endif
