/// @file groups.h
/// Groups of particles that are judged, held and put back singly.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GROUPS_H
#define MSPRINGI_GROUPS_H

#include <stdbool.h>
#include <stdint.h>

#include <massspring/massspring_batch.h>

/// What groups may be put back to. Springs are in the order of mspringi_groups.springs.
typedef struct mspringi_mark {
    float *motion;  ///< [particles][mspringi_state_arrays()] as the arrays of a state follow each other
    float *lengths; ///< [springs][2] rest length, and the one before any flow, m
    uint8_t *live;  ///< [springs] 1: not broken
    double *origin; ///< [groups][2] that positions are relative to, m
} mspringi_mark;

/// What is known of a group.
enum {
    MSPRINGI_HELD = 1,     ///< it stays where it is
    MSPRINGI_SUSPECT = 2,  ///< it is out of bounds where the last attempt has led to
    MSPRINGI_DOUBTFUL = 4, ///< so with numbers that are none, which may come from elsewhere
    MSPRINGI_NEWLY = 8     ///< held in this step
};

typedef struct mspringi_groups {
    uint32_t count;             ///< 0: there are none
    uint32_t held;              ///< of these held
    mspring_id *first;          ///< [count + 1] particles
    uint32_t *first_spring;     ///< [count + 2] of springs; the last is room for counting
    mspring_id *springs;        ///< [springs] of each group
    mspring_id *changing;       ///< [springs] room for those that a reset breaks or restores
    uint32_t *of_particle;      ///< [particles] the group, or count
    uint8_t *flags;             ///< [count]
    float *velocity;            ///< [particles][4] of groups that are held newly, with low words, m/s
    float *active_inverse_mass; ///< [slots] inverse mass, 0 of what is held
    mspringi_mark start, mark;
} mspringi_groups;

#endif
