/// The table of kinds of things.
#include "store/things.h"

static const mspringi_thing_ops *const kinds[] = {
    &mspringi_things_particles,
    &mspringi_things_springs,
#define THINGS(table) &table,
#include "store/features.def"
};

const mspringi_thing_ops *mspringi_things_of(mspring_kind kind) {
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i)
        if (kinds[i]->kind == kind)
            return kinds[i];
    return NULL;
}

uint32_t mspring_network_count(const mspring_network *network, mspring_kind kind) {
    const mspringi_thing_ops *of = mspringi_things_of(kind);
    return network && of ? of->total(network) : 0;
}
