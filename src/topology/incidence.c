/// Listing springs by particle.
#include "incidence.h"

static void find_ends(const mspringi_topology *t, mspringi_place place, mspring_id ends[2]) {
    uint32_t base, tip;
    mspringi_topology_ends(t, place, &base, &tip);
    ends[0] = t->particle_of_slot[base];
    ends[1] = t->particle_of_slot[tip];
}

void mspringi_incidence_fill(const mspringi_incidence *incidence, const mspringi_topology *topology) {
    const uint32_t particles = topology->reserve.particle_end, springs = topology->reserve.first_spring;
    mspring_id ends[2];
    for (mspring_id s = 0; s < springs; ++s) {
        find_ends(topology, topology->place_of_spring[s], ends);
        incidence->first[ends[0]]++;
        incidence->first[ends[1]]++;
    }
    for (mspring_id p = 0; p < particles; ++p)
        incidence->first[p + 1] += incidence->first[p];
    // From behind, so that each particle's first is where it belongs at the end, and ids rise.
    for (mspring_id s = springs; s-- > 0;) {
        find_ends(topology, mspringi_place_of(topology, s), ends);
        incidence->springs[--incidence->first[ends[0]]] = s;
        incidence->springs[--incidence->first[ends[1]]] = s;
    }
}
