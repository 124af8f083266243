/// @file methods.h
/// Methods that move a network, ours and those of others, as each is usually written.
///
/// SPDX-License-Identifier: MIT
#ifndef BOARD_METHODS_H
#define BOARD_METHODS_H

#include "board/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/// MOST_EFFORTS of a method, OURS of the methods.
enum { BOARD_MOST_METHODS = 10, MOST_EFFORTS = 6, OURS = 3 };

/// State of a method between frames.
typedef struct motion {
    const model *m;
    uint32_t effort;         ///< substeps or iterations in a frame: see the method
    double damping;          ///< 1/s: velocities decay by exp(-damping t)
    double *x, *y, *vx, *vy; ///< [particle_count]; of ours NULL
    double *old_x, *old_y;   ///< [particle_count] work space
    double *goal_x, *goal_y; ///< [particle_count] work space
    void *own;               ///< what else the method has
} motion;

typedef struct method {
    const char *name;   ///< in pictures
    const char *effort; ///< what its effort counts
    /// Make own. NULL: nothing to make. false: out of memory or refused
    bool (*begin)(motion *run, double dt);
    void (*frame)(motion *run, double dt);
    /// Springs break, whose stiffness in the model is 0 now. NULL: that is all it has to know. false: out of memory
    bool (*cut)(motion *run, const uint32_t *springs, uint32_t count, double dt);
    /// NULL: x, y, vx and vy of the motion
    void (*state)(const motion *run, model_state *to);
    void (*end)(motion *run);       ///< NULL: nothing to free
    uint32_t efforts[MOST_EFFORTS]; ///< ended by 0
    bool by_stability;              ///< efforts are in the least stable number of substeps
    uint32_t colour;                ///< 0xrrggbb, in pictures
} method;

bool motion_begin(motion *run, const method *by, const model *m, uint32_t effort, double damping, double dt);
void motion_state(const motion *run, const method *by, model_state *to);
void motion_end(motion *run, const method *by);

extern const method *const board_methods[BOARD_MOST_METHODS + 1]; ///< ours first; ended by NULL

extern const method board_ours[OURS]; ///< explicit, implicit, direct
extern const method board_precise;    ///< explicit, lengths from both words of positions
extern const method board_naive;      ///< symplectic Euler, a loop over springs
extern const method board_pbd;        ///< position-based dynamics (Mueller 2007)
extern const method board_xpbd;       ///< extended, in small steps (Macklin 2019)
extern const method board_vbd;        ///< vertex block descent with Chebyshev's acceleration (Chen 2024)
extern const method board_projective; ///< projective dynamics, its matrix factored at the start (Liu 2013)
extern const method board_box2d;      ///< Box2D 2.4: soft distance joints, where it is installed
extern const method board_chipmunk;   ///< Chipmunk 7: damped springs, where it is installed

#ifdef __cplusplus
}
#endif

#endif
