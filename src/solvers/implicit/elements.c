#include "store/elements.h"

static const mspringi_element_ops *const elements[] = {
#define ELEMENT(table) &table,
#include "store/features.def"
    NULL};
#define ELEMENT_COUNT (sizeof elements / sizeof elements[0] - 1)

bool mspringi_elements_have_terms(const mspring_network *network) {
    bool any = false;
    for (size_t i = 0; i < ELEMENT_COUNT && !any; ++i)
        any = (elements[i]->add_terms || elements[i]->list_constraints) && elements[i]->is_used(network);
    return any;
}

void mspringi_elements_stiffen(const mspring_network *network) {
    for (size_t i = 0; i < ELEMENT_COUNT; ++i)
        if (elements[i]->add_terms && elements[i]->is_used(network))
            elements[i]->add_terms(network);
}

void mspringi_elements_list_constraints(mspring_network *network) {
    for (size_t i = 0; i < ELEMENT_COUNT; ++i)
        if (elements[i]->list_constraints && elements[i]->is_used(network))
            elements[i]->list_constraints(network);
}

void mspringi_elements_add_energy(const mspring_network *network) {
    for (size_t i = 0; i < ELEMENT_COUNT; ++i)
        if (elements[i]->add_energy && elements[i]->is_used(network))
            elements[i]->add_energy(network);
}

bool mspringi_elements_forget_energy(const mspring_network *network) {
    bool any = false;
    for (size_t i = 0; i < ELEMENT_COUNT && !any; ++i)
        any = elements[i]->forgets_energy && elements[i]->forgets_energy(network);
    return any;
}
