#include "store/elements.h"

static const mspringi_element_ops *const all[] = {
#define ELEMENT(table) &table,
#include "store/features.def"
    NULL};

bool mspringi_elements_have_terms(const mspring_network *network) {
    bool any = false;
    for (const mspringi_element_ops *const *ops = all; *ops && !any; ++ops)
        any = ((*ops)->add_terms || (*ops)->list_constraints) && (*ops)->is_used(network);
    return any;
}

void mspringi_elements_assemble(const mspring_network *network) {
    for (const mspringi_element_ops *const *ops = all; *ops; ++ops)
        if ((*ops)->add_terms && (*ops)->is_used(network))
            (*ops)->add_terms(network);
}

void mspringi_elements_list_constraints(mspring_network *network) {
    for (const mspringi_element_ops *const *ops = all; *ops; ++ops)
        if ((*ops)->list_constraints && (*ops)->is_used(network))
            (*ops)->list_constraints(network);
}

void mspringi_elements_add_energy(const mspring_network *network) {
    for (const mspringi_element_ops *const *ops = all; *ops; ++ops)
        if ((*ops)->add_energy && (*ops)->is_used(network))
            (*ops)->add_energy(network);
}

bool mspringi_elements_forget_energy(const mspring_network *network) {
    bool any = false;
    for (const mspringi_element_ops *const *ops = all; *ops && !any; ++ops)
        any = (*ops)->forgets_energy && (*ops)->forgets_energy(network);
    return any;
}
