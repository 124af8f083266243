/// @file equilibrium.h
/// A network as a problem of statics, in double precision: energy, forces and stiffness as functions of the
/// displacements, and the search for an equilibrium.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EQUILIBRIUM_H
#define MSPRINGI_EQUILIBRIUM_H

#include "analysis/settle/settle.h"
#include "solvers/sparse/cholesky.h"
#include "store/element_laws.h"

/// Two values for each particle.
typedef struct mspringi_vectors {
    double *x, *y;
} mspringi_vectors;

/// The springs with stiffness.
typedef struct mspringi_statics_springs {
    uint32_t count, edge_count;      ///< springs; springs and, behind them, sides that elements own
    uint32_t *a, *b;                 ///< [edge_count] particles
    double *stiffness, *rest_length; ///< [count]
    double *side;                    ///< [count] 1: pulls only; -1: pushes only; 0: both
    double *x, *y; ///< [count] from a to b at the start. Kept apart from the displacements, since small differences
                   ///< of these have more exact digits than those of positions.
    double *xx, *xy, *yy; ///< [edge_count] blocks of the stiffness matrix
} mspringi_statics_springs;

/// Closed elements (settle_elements.c).
typedef struct mspringi_statics_elements {
    const mspring_network *of;
    uint32_t *sides;             ///< [corners] edge of each side
    mspringi_side_block *blocks; ///< [corners of the largest] scratch
} mspringi_statics_elements;

/// Past moves, and by how much they lowered the forces. They tell what the matrix lacks of areas: it has springs
/// along their sides, but areas resist bending, too, and their pressure turns with the sides.
enum { MSPRINGI_SECANTS = 12 };
typedef struct mspringi_secants {
    double
        *block; ///< [MSPRINGI_SECANTS][move, fall of the forces], and the last place and its forces; NULL: no areas
    double inverse[MSPRINGI_SECANTS]; ///< 1 / (move times fall)
    uint32_t count, next;
    bool has_last;
} mspringi_secants;

typedef struct mspringi_statics {
    uint32_t particle_count;
    bool *fixed;                ///< [particle_count] pinned or left floating
    mspringi_vectors start;     ///< [particle_count] positions relative to the network's origin, m
    mspringi_vectors moved;     ///< [particle_count] displacements, m
    mspringi_vectors outside;   ///< [particle_count] weight and external forces, N
    mspringi_vectors force;     ///< [particle_count] all forces, N
    mspringi_vectors step;      ///< [particle_count] Newton step, m
    mspringi_vectors curvature; ///< [particle_count] its second-order correction, m
    mspringi_vectors spare;     ///< [particle_count] scratch
    double *xx, *xy, *yy;       ///< [particle_count] diagonal blocks of the stiffness matrix
    double *scale;              ///< [particle_count] stiffness of the springs at a particle, N/m
    double *block;              ///< memory of all values by particle
    double *spring_block;       ///< memory of all values by spring
    uint32_t *end_block;
    mspringi_watcher watcher; ///< called before each iteration
    mspringi_statics_springs springs;
    mspringi_statics_elements elements;
    mspringi_secants secants;
    mspringi_cholesky_symbolic plan;
    mspringi_cholesky_double factor;
} mspringi_statics;

/// Reserve memory for particles, and springs with sides that elements own.
bool mspringi_statics_create(mspringi_statics *statics, uint32_t particle_count, uint32_t edge_count,
                             mspringi_memory *memory);
void mspringi_statics_destroy(mspringi_statics *statics, mspringi_memory *memory);

/// Find the closed elements, and count the sides that they own; add them after the springs, of a network that
/// outlives the problem.
uint32_t mspringi_statics_count_sides(mspring_network *network);
mspring_result mspringi_statics_add_elements(mspringi_statics *statics, mspring_network *network);
/// Add their part: to the forces, and return the largest; to the change of energy, whose absolute sum is *size; to
/// the stiffness.
double mspringi_statics_element_forces(mspringi_statics *statics);
double mspringi_statics_element_change(const mspringi_statics *statics, double t, double *size);
void mspringi_statics_add_element_stiffness(mspringi_statics *statics, bool clamped);

/// Analyse the stiffness matrix, after particles and springs are filled in.
mspring_result mspringi_statics_prepare(mspringi_statics *statics, mspring_simd level, mspringi_memory *memory,
                                        mspringi_message *message);

/// Unbalanced forces.
typedef struct mspringi_residual {
    double force;     ///< N, largest in x or y on a free particle
    double scale;     ///< N, largest spring or external force
    mspring_id where; ///< particle with the largest unbalanced force
} mspringi_residual;

/// Compute the forces in the present shape.
mspringi_residual mspringi_statics_forces(mspringi_statics *statics);

/// Factor the stiffness matrix in the present shape, with shift times its scale added to the diagonal. False if it
/// is not positive definite. clamped: without the negative stiffness across compressed springs, so no eigenvalue is
/// negative.
bool mspringi_statics_factor(mspringi_statics *statics, bool clamped, double shift);

/// Solve for the step that removes all forces if they are linear, and for its second-order correction (Transtrum &
/// Sethna 2012). Particles then go to moved + t step + t^2 curvature. Needs the factor.
void mspringi_statics_find_step(mspringi_statics *statics);

/// Change of energy from moved to moved + t step + t^2 curvature, J. error: bound on its rounding.
double mspringi_statics_energy_change(const mspringi_statics *statics, double t, double *error);

/// Forces times step: the energy falls by t times this for a small t.
double mspringi_statics_slope(const mspringi_statics *statics);

/// Result of a search.
typedef struct mspringi_equilibrium {
    uint32_t iterations;
    mspringi_residual residual;
    bool found;
    bool is_stable;
} mspringi_equilibrium;

/// Search for an equilibrium: Newton's method along the path above, as far as the energy falls. size: extent of the
/// network, m. tolerance: largest unbalanced force, relative to the scale of forces.
mspringi_equilibrium mspringi_statics_find_equilibrium(mspringi_statics *statics, uint32_t max_iterations,
                                                       double tolerance, double size);

#endif
