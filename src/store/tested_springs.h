/// @file tested_springs.h
/// Lengths that steps test springs by, and rest lengths before any flow.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TESTED_SPRINGS_H
#define MSPRINGI_TESTED_SPRINGS_H

#include "kernels/kernels.h"
#include "kernels/shared_records.h"

/// Springs that the sweeps of rows test, by spring slot; NULL as long as none yields. See
/// features/yield/yielding.c, which alone makes and fills these.
typedef struct mspringi_tested {
    float *yield_strain, *hardening, *plastic_limit;
    float *nominal;              ///< rest length before any flow, m; the one in force is among the spring's values
    float *low, *high;           ///< squares of the lengths between which the spring is cold, m^2
    float *flow_low, *flow_high; ///< of those between which it does not flow
    float *before;               ///< rest length before the step, where it has changed in it
    float *gain;                 ///< 1 / (1 + hardening)
    float *heat;                 ///< what flow has dissipated in the step, J
    mspringi_shared_records shared_records; ///< lattice blocks with the same rest lengths and bounds
    uint16_t
        *has_flowed; ///< [spring slots / MSPRINGI_WIDTH] a bit for each: its rest length has changed in the step
    uint16_t
        *warm; ///< [spring slots / MSPRINGI_WIDTH] a bit for each: it was warm in look number look_of of the step
    uint32_t *look_of;         ///< [spring slots / MSPRINGI_WIDTH]
    mspringi_strain_hit *hits; ///< [spring slots / MSPRINGI_WIDTH] springs that were warm at the last look
    float *ahead;              ///< [2 slots] x and y where particles would be at the end of a substep
    uint8_t *warmth;           ///< [strips] MSPRINGI_WARM, ...
    uint32_t substep;          ///< of the step, the first of those that are being taken
    bool is_swept;             ///< the sweeps of rows test their springs
    bool maps;                 ///< ... and map them; else they only find out whether any is warm
    bool yields;               ///< a yield strain has been finite: there is something to save
    bool is_bent;              ///< some rest length may be another than the nominal one
} mspringi_tested;

#endif
