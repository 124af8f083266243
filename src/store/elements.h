/// @file elements.h
/// Elements: forces between particles of a body, besides springs, that linear systems have in them. A table of
/// functions for each; in other solvers, a stage pushes (stages.h).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ELEMENTS_H
#define MSPRINGI_ELEMENTS_H

#include "store/network.h"

/// Functions of an element; NULL if it needs none.
typedef struct mspringi_element_ops {
    bool (*is_used)(const mspring_network *network);   ///< never NULL
    void (*add_terms)(const mspring_network *network); ///< add to each assembled system
    void (*list_constraints)(
        mspring_network *network); ///< list its constraints at the prediction, once a substep; room is reserved
    void (*add_energy)(const mspring_network *network); ///< add its energies to the components' budgets
    bool (*forgets_energy)(
        const mspring_network *network); ///< what a substep ended with is not what the next begins with
} mspringi_element_ops;

#define ELEMENT(table) extern const mspringi_element_ops table;
#include "store/features.def"

bool mspringi_elements_have_terms(const mspring_network *network);
void mspringi_elements_assemble(const mspring_network *network);
void mspringi_elements_list_constraints(mspring_network *network);
void mspringi_elements_add_energy(const mspring_network *network);
bool mspringi_elements_forget_energy(const mspring_network *network);

#endif
