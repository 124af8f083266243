/// @file groups.h
/// Groups of particles that are judged, held and put back singly.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GROUPS_H
#define MSPRINGI_GROUPS_H

#include <stdbool.h>
#include <stdint.h>

#include <massspring/massspring.h>

/// State that groups may be reset to. Springs are in the order of mspringi_groups.springs.
typedef struct mspringi_mark {
    float *motion;  ///< [particles][mspringi_state_arrays()] in the order of a state's arrays
    float *lengths; ///< [springs][2] rest length, and the one before any flow, m
    uint8_t *live;  ///< [springs] 1: not broken
    double *origin; ///< [groups][2] origin of the positions, m
} mspringi_mark;

/// Flags of a group.
enum {
    MSPRINGI_HELD = 1,     ///< it stays where it is
    MSPRINGI_SUSPECT = 2,  ///< the last attempt brought it out of bounds
    MSPRINGI_DOUBTFUL = 4, ///< likewise to NaN, which may come from another group
    MSPRINGI_NEWLY = 8     ///< held in this step
};

typedef struct mspringi_groups {
    uint32_t count;         ///< 0: there are none
    uint32_t held;          ///< groups held
    mspring_id *first;      ///< [count + 1] first particle of each group
    uint32_t *first_spring; ///< [count + 2] first entry of each group in `springs`; the last element is scratch for
                            ///< counting
    mspring_id *springs;    ///< [springs] of each group
    mspring_id *changing;   ///< [springs] scratch for those that a reset breaks or restores
    uint32_t *of_particle;  ///< [particles] the group, or count
    uint8_t *flags;         ///< [count]
    float *velocity;        ///< [particles][4] of newly held groups, with low words, m/s
    float *active_inverse_mass; ///< [slots] inverse mass, 0 for held groups, 1/kg
    mspringi_mark start, mark;
} mspringi_groups;

#endif
