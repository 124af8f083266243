/// Search for cells.
///
/// In a lattice's rows a cell is four particles with live springs around them; sweeps can compute its area.
/// Elsewhere, also in lattices too small for rows, it is four particles that are all connected by live springs, two
/// of which cross.
#include "edits/edit_areas.h"

#include "store/areas.h"
#include "store/id_pool.h"
#include "store/springs.h"

static uint32_t slot_of(const mspring_network *network, mspring_id particle) {
    return network->topology.slot_of_particle[particle];
}

static void make_positive(const mspring_network *network, mspring_id corners[4]) {
    if (mspringi_area_within(network, corners, 4) < 0.0) {
        const mspring_id second = corners[1];
        corners[1] = corners[3];
        corners[3] = second;
    }
}

// Find the cell of rows above and on the right of a particle.
static bool find_in_rows(const mspring_network *network, mspring_id particle, mspring_id corners[4]) {
    uint32_t slots[4];
    if (!mspringi_cell_at(network, slot_of(network, particle), slots))
        return false;
    for (int i = 0; i < 4; ++i)
        corners[i] = network->topology.particle_of_slot[slots[i]];
    make_positive(network, corners);
    return true;
}

// True if a cell of rows has the same four corners.
static bool is_in_rows(const mspring_network *network, const mspring_id corners[4]) {
    for (int i = 0; i < 4; ++i) {
        mspring_id cell[4];
        int shared = 0;
        if (!find_in_rows(network, corners[i], cell))
            continue;
        for (int j = 0; j < 16; ++j)
            shared += cell[j / 4] == corners[j % 4];
        if (shared == 4)
            return true;
    }
    return false;
}

// True if the particle is on the left of the line between two others.
static bool is_left(const mspring_network *network, mspring_id from, mspring_id to, mspring_id particle) {
    const mspring_id three[3] = {from, to, particle};
    return mspringi_area_within(network, three, 3) > 0.0;
}

static bool are_crossed(const mspring_network *network, mspring_id a, mspring_id b, mspring_id c, mspring_id d) {
    return is_left(network, a, b, c) != is_left(network, a, b, d) &&
           is_left(network, c, d, a) != is_left(network, c, d, b);
}

// Order four connected particles around their cell. False if none of their springs cross.
static bool order_corners(const mspring_network *network, mspring_id corners[4]) {
    for (int other = 1; other < 4; ++other) {
        const mspring_id a = corners[0], b = corners[other], c = corners[other == 1 ? 2 : 1],
                         d = corners[other == 3 ? 2 : 3];
        if (!are_crossed(network, a, b, c, d))
            continue;
        corners[0] = a;
        corners[1] = c;
        corners[2] = b;
        corners[3] = d;
        make_positive(network, corners);
        return true;
    }
    return false;
}

/// Iterator over the particles of higher id that are connected to a particle by live springs.
typedef struct neighbours {
    mspringi_incident_springs around;
    mspring_id of;
} neighbours;

static neighbours begin(const mspring_network *network, mspring_id of) {
    return (neighbours){mspringi_incident_springs_begin(network, of), of};
}

static mspring_id next(const mspring_network *network, neighbours *n) {
    for (mspring_id s; (s = mspringi_incident_springs_next(network, &n->around)) != MSPRING_NONE;) {
        const mspringi_ends ends = mspringi_spring_ends(network, s);
        const mspring_id a = network->topology.particle_of_slot[ends.a],
                         b = network->topology.particle_of_slot[ends.b];
        const mspring_id other = a == n->of ? b : a;
        if (mspringi_spring_is_live(network, s) && other > n->of)
            return other;
    }
    return MSPRING_NONE;
}

static bool are_connected(const mspring_network *network, mspring_id low, mspring_id high) {
    neighbours n = begin(network, low);
    for (mspring_id other; (other = next(network, &n)) != MSPRING_NONE;)
        if (other == high)
            return true;
    return false;
}

// Visit cells outside of rows by their lowest two corners, which a spring connects. The third is connected to both,
// the fourth to all.
static mspring_result visit_pair(mspring_network *network, mspring_id lowest, mspring_id second,
                                 mspringi_cell_fn fn, void *user) {
    mspring_result result = MSPRING_OK;
    neighbours thirds = begin(network, second);
    for (mspring_id third; result == MSPRING_OK && (third = next(network, &thirds)) != MSPRING_NONE;) {
        neighbours fourths = begin(network, third);
        if (!are_connected(network, lowest, third))
            continue;
        for (mspring_id fourth; result == MSPRING_OK && (fourth = next(network, &fourths)) != MSPRING_NONE;) {
            mspring_id corners[4] = {lowest, second, third, fourth};
            if (are_connected(network, lowest, fourth) && are_connected(network, second, fourth) &&
                !is_in_rows(network, corners) && order_corners(network, corners))
                result = fn(network, corners, user);
        }
    }
    return result;
}

mspring_result mspringi_each_cell(mspring_network *network, mspringi_cell_fn fn, void *user) {
    mspring_result result = mspringi_incidence_reserve(network);
    for (mspring_id p = 0; result == MSPRING_OK && p < network->topology.particle_count; ++p) {
        mspring_id corners[4];
        if (!mspringi_particle_exists(network, p))
            continue;
        if (find_in_rows(network, p, corners))
            result = fn(network, corners, user);
        neighbours seconds = begin(network, p);
        for (mspring_id second; result == MSPRING_OK && (second = next(network, &seconds)) != MSPRING_NONE;)
            result = visit_pair(network, p, second, fn, user);
    }
    return result;
}
