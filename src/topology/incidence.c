/// Listing springs by particle.
#include "incidence.h"

static void find_ends(const mspringi_topology *t, mspringi_place place, mspring_id ends[2]) {
    uint32_t base, tip;
    mspringi_topology_ends(t, place, &base, &tip);
    ends[0] = t->particle_of_slot[base];
    ends[1] = t->particle_of_slot[tip];
}

mspring_result mspringi_incidence_create(mspringi_incidence *incidence, const mspringi_topology *topology,
                                         mspringi_memory *memory, mspringi_message *message) {
    const uint32_t particles = topology->reserve.particle_end, springs = topology->reserve.first_spring;
    mspringi_incidence made = {mspringi_alloc(memory, (size_t)particles + 1, sizeof *made.first),
                               mspringi_alloc(memory, (size_t)2 * springs, sizeof *made.springs)};
    if (!made.first || !made.springs) {
        mspringi_incidence_destroy(&made, memory);
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to list %u springs by particle",
                             (unsigned)springs);
    }
    mspringi_place_reader reader;
    mspring_id ends[2];
    mspringi_places_begin(&reader, &topology->places, 0);
    for (mspring_id s = 0; s < springs; ++s) {
        find_ends(topology, mspringi_places_next(&reader), ends);
        made.first[ends[0]]++;
        made.first[ends[1]]++;
    }
    for (mspring_id p = 0; p < particles; ++p)
        made.first[p + 1] += made.first[p];
    // From behind, so that each particle's first is where it belongs at the end, and ids rise.
    for (mspring_id s = springs; s-- > 0;) {
        find_ends(topology, mspringi_place_of(topology, s), ends);
        made.springs[--made.first[ends[0]]] = s;
        made.springs[--made.first[ends[1]]] = s;
    }
    *incidence = made;
    return MSPRING_OK;
}

void mspringi_incidence_destroy(mspringi_incidence *incidence, mspringi_memory *memory) {
    mspringi_free(memory, incidence->first);
    mspringi_free(memory, incidence->springs);
    *incidence = (mspringi_incidence){NULL, NULL};
}
