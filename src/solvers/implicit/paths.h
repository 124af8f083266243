/// @file paths.h
/// Paths: ropes and other runs of particles with two springs each, condensed out of the linear system.
///
/// With C the particles of a path and E its two ends,
///
///     S = A_EE - A_EC A_CC^-1 A_CE,    b_E += -A_EC A_CC^-1 b_C,    d_C = A_CC^-1 (b_C - A_CE d_E).
///
/// (Static condensation: block elimination along the path, exact but for rounding.) Iterations have S, a 4 x 4
/// block between the ends, instead of the path. Else they would be as many as it has particles, and the masses of a
/// stiff path would be lost to rounding in single precision.
///
/// Paths are those of the layout, whatever is broken: a broken spring has no factors. In each solution they are cut
/// at particles that do not move, or that a constraint or an added spring joins to others. What lies between is a
/// *segment*.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PATHS_H
#define MSPRINGI_PATHS_H

#include "kernels/system.h"
#include "solvers/constraints/constraint_services.h"
#include "store/network.h"
#include "tasks/team.h"

/// Fewest particles of a path, and of a segment.
#define MSPRINGI_LEAST_PATH 3u

/// Particles of a path: nodes `first` to `end` - 1. Path number c has end - first + 1 springs: factors[i + c] are
/// those of the spring before node i, for i up to end.
typedef struct mspringi_path {
    uint32_t first, end;
    uint32_t ends[2];       ///< slots beyond; MSPRING_NONE: the path ends there
    uint32_t segment_count; ///< in the present solution
} mspringi_path;

/// Run of nodes that a solution eliminates: `first` to `end` - 1.
typedef struct mspringi_path_segment {
    uint32_t first, end;
    uint32_t ends[2];   ///< slots; MSPRING_NONE: nothing is there, or it does not move
    double block[4][4]; ///< S
    double lost[2][3];  ///< xx, xy, yy of the ends' springs, which their blocks lose
    double load[4];     ///< what b_E gets
} mspringi_path_segment;

/// Response of a node, A_CC^-1 (A_CE, b_C): rows x and y of five columns.
typedef struct mspringi_path_response {
    double x[5], y[5];
} mspringi_path_response;

typedef struct mspringi_paths {
    uint32_t count, node_count;
    mspringi_path *list;               ///< [count] by their lowest slots
    mspringi_path_segment *segments;   ///< those of a path begin at first / MSPRINGI_LEAST_PATH
    uint32_t *node_of_slot;            ///< [slots] MSPRING_NONE: none; NULL without paths
    uint32_t *slots;                   ///< [node_count] along the path
    uint32_t *factors;                 ///< [node_count + count] of the springs; MSPRING_NONE: there is none
    uint8_t *marks;                    ///< [node_count] bits: condensed, joined (condense.c)
    double (*held)[3];                 ///< [node_count] xx, xy, yy of constraints on a node alone
    float *mass;                       ///< [node_count] while it is 0 in the system
    double (*ups)[4];                  ///< [node_count] P^-1 times the block of the spring behind; P: the pivot
    mspringi_path_response *responses; ///< [node_count]
    bool has_marks;                    ///< marks and held are not all 0
} mspringi_paths;

/// Paths that are being found.
typedef struct mspringi_path_builder {
    const mspring_network *network;
    mspringi_memory *memory;
    mspringi_message *message;
    mspringi_paths *paths;
    uint8_t *degree;                    ///< [slots] springs, up to 3, and bits of particles that were visited
    mspringi_spring_slot (*springs)[2]; ///< [slots] the first two of them
} mspringi_path_builder;

/// Find the paths: begin, count all springs in ranges, list, then end, on failure too.
mspring_result mspringi_paths_begin(mspringi_path_builder *finding);
void mspringi_paths_count_springs(mspringi_path_builder *finding, mspring_id first, mspring_id end);
mspring_result mspringi_paths_list(mspringi_path_builder *finding);
void mspringi_paths_end(mspringi_path_builder *finding);
extern const mspringi_array_table mspringi_paths_columns;

/* condense.c: of a solution, on all members of a team; nothing without paths */

/// Turn path particles as the rotation of tiles has turned their ends, in equal steps from one to the other,
/// between barriers. (If they stay, the spring at a hull that spins has a wrong direction: hulls with a rope of
/// 2,000 particles were up to 9 times as far from the direct solver as without condensation.)
void mspringi_condense_turn(const mspring_network *network, const mspringi_prediction *prediction,
                            mspringi_team_member *member);

/// Take the paths out of an assembled system, between barriers.
void mspringi_condense(const mspring_network *network, mspringi_team_member *member);
/// Find the displacements along them, and take their directions for 0, before a barrier.
void mspringi_condense_finish(const mspring_network *network, mspringi_team_member *member, float alpha);
/// Multiply: to += S from.
void mspringi_condense_multiply(const mspring_network *network, const mspringi_product *product);
/// Add S to the coarse matrix.
void mspringi_condense_stiffen(const mspring_network *network);

#endif
