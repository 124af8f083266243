/// @file report.h
/// What came out, for people and as CSV.
///
/// SPDX-License-Identifier: MIT
#ifndef BENDING_REPORT_H
#define BENDING_REPORT_H

#include "bending/options.h"
#include "bending/settle.h"

/// What was measured of a network's springs at the end.
typedef struct spring_measures {
    float least_stiffness, most_stiffness; ///< N/m
    float most_damping;                    ///< N s/m
    /// stiffness * substep^2 / mu: a full lattice is stable below 1
    double least_fraction, most_fraction;
    float strain;        ///< the largest, in absolute value
    mspring_id strained; ///< the spring that has it, or MSPRING_NONE
    mspring_id strained_a, strained_b;
    uint32_t broken; ///< springs beyond the strain at which their material breaks
    bool can_break;  ///< whether any spring has such a strain
} spring_measures;

/// Measure the springs. Returns false when out of memory.
bool report_measure(mspring_network *network, const scene *measured, double substep, spring_measures *measures);

void report_print_table(mspring_network *network, const scene *measured, const bending_options *options,
                        const settle_result *settled, const spring_measures *measures);
void report_print_csv_header(void);
/// One CSV line. A network that did not settle has no bending and no settling time: nan.
void report_print_csv(mspring_network *network, const scene *measured, const bending_options *options,
                      const settle_result *settled, const spring_measures *measures);

#endif
