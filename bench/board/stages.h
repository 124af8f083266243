/// @file stages.h
/// The networks that the board moves.
///
/// SPDX-License-Identifier: MIT
#ifndef BOARD_STAGES_H
#define BOARD_STAGES_H

#include "board/model.h"

typedef struct stage {
    const char *name, *title;
    bool (*make)(const struct stage *stage, mspring_builder **builder, mspring_id *probe);
    uint32_t columns, rows;
    float stiffness, mass;    ///< N/m of a spring, kg of a particle
    double spacing;           ///< m
    uint64_t reference_steps; ///< of the reference, in a second
    double dearest;           ///< frames that take longer are not measured, us
    bool settles;             ///< whether its sag at rest is measured, too
} stage;

enum { STAGES = 6 };
extern const stage board_stages[STAGES];

/// Make what a stage has. false: after a message.
bool stage_read(const stage *from, model *made);

#endif
