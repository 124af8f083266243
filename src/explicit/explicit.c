/// The explicit solver: symplectic Euler, row by row.
#include "explicit.h"

#include <string.h>

#include "decay.h"

/// Rows that are swept several times in one pass should stay in this much cache: half of a second-level cache of
/// today.
#define CACHE_BYTES ((size_t)512 << 10)

/// Most substeps in one pass: each needs a carry row of its own.
#define DEEPEST 16

// Pack what the web sees of its nodes.
static void pack_nodes(const mspring_network *network, const mspringi_sweep *sweep) {
    const mspringi_topology *t = &network->topology;
    network->kernels->pack(sweep, t->web_first, t->web_blocks, network->packed);
    float *packed = network->packed + (size_t)4 * t->web.own_count;
    for (uint32_t i = 0; i < t->web.attached_count && t->web.attached_slot[i] != MSPRING_NONE; ++i, packed += 4) {
        const uint32_t slot = t->web.attached_slot[i];
        packed[0] = sweep->x[slot];
        packed[1] = sweep->y[slot];
        packed[2] = sweep->vx[slot];
        packed[3] = sweep->vy[slot];
    }
}

// Put the web's pull at its attached nodes on top of base into the total field.
static void pull_attached(const mspring_network *network, const mspringi_sweep *sweep, mspringi_field base) {
    const mspringi_web *web = &network->topology.web;
    const mspringi_field total = network->forces.total;
    float *pull_x = network->attached, *pull_y = network->attached + web->attached_count;
    network->kernels->attached[network->parts > MSPRINGI_DAMPING](sweep, pull_x, pull_y);
    for (uint32_t i = 0; i < web->attached_count && web->attached_slot[i] != MSPRING_NONE; ++i) {
        const uint32_t slot = web->attached_slot[i];
        total.x[slot] = base.x ? base.x[slot] + pull_x[i] : pull_x[i];
        total.y[slot] = base.x ? base.y[slot] + pull_y[i] : pull_y[i];
    }
}

// Sweep rows that follow each other, all of one kind.
static void sweep_rows(const mspring_network *network, const mspringi_sweep *sweep, const mspringi_row *rows,
                       uint32_t row_count, bool forced) {
    const mspringi_kernels *kernels = network->kernels;
    const mspringi_span *spans = network->topology.spans + rows->first_span;
    const mspringi_row *last = &rows[row_count - 1];
    const uint32_t span_count = last->first_span + last->span_count - rows->first_span;
    const bool damped = network->parts > MSPRINGI_DAMPING;
    switch (rows->kind) {
    case MSPRINGI_ROW_LATTICE:
        kernels->lattice[damped][forced](sweep, spans, span_count);
        break;
    case MSPRINGI_ROW_CHAIN:
        kernels->chain[damped][forced](sweep, spans, span_count);
        break;
    case MSPRINGI_ROW_WEB:
        kernels->web[damped][forced](sweep, spans, span_count);
        break;
    case MSPRINGI_ROW_LOOSE:
        kernels->loose[forced](sweep, spans, span_count);
        break;
    }
}

// Sweep the rows first ... end - 1, as many as can be in one go.
static void sweep_range(const mspring_network *network, const mspringi_sweep *sweep, uint32_t first, uint32_t end,
                        bool all_forced) {
    const mspringi_row *rows = network->topology.rows;
    while (first < end) {
        uint32_t count = 1;
        while (first + count < end && rows[first + count].kind == rows[first].kind &&
               (all_forced || rows[first + count].pulled == rows[first].pulled))
            ++count;
        sweep_rows(network, sweep, &rows[first], count, all_forced || rows[first].pulled);
        first += count;
    }
}

uint32_t mspringi_explicit_depth(const mspringi_topology *topology, uint32_t parts) {
    if (topology->web.attached_count > 0 || topology->lattice_rows == 0)
        return 1;
    const size_t floats_per_slot = 4 + 1 + (size_t)MSPRINGI_DIRECTIONS * parts; // state, inverse mass, springs
    const size_t slots_per_row = (size_t)topology->lattice_blocks * MSPRINGI_WIDTH / topology->lattice_rows;
    const size_t rows = CACHE_BYTES / (floats_per_slot * sizeof(float) * slots_per_row);
    const size_t depth = rows > 1 ? rows - 1 : 1;
    return (uint32_t)(depth < DEEPEST ? depth : DEEPEST);
}

// Take as many substeps as there are sweeps in one pass over the lattice rows: each substep runs one row behind the
// one before, so a row is in the cache for all of them. A row's substep needs the one before of the row itself and
// of the row above; both are done by then, and neither is further.
static void sweep_lattices(const mspring_network *network, const mspringi_sweep *sweeps, uint32_t count,
                           bool forced) {
    const mspringi_topology *t = &network->topology;
    if (count == 1) {
        sweep_range(network, &sweeps[0], 0, t->lattice_rows, forced);
        return;
    }
    for (uint32_t wave = 0; t->lattice_rows > 0 && wave < t->lattice_rows + count - 1; ++wave) {
        for (uint32_t substep = 0; substep < count && substep <= wave; ++substep) {
            const uint32_t row = wave - substep;
            if (row < t->lattice_rows)
                sweep_rows(network, &sweeps[substep], &t->rows[row], 1, forced || t->rows[row].pulled);
        }
    }
}

// Take at most network->depth substeps.
static void take_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count) {
    const mspringi_topology *t = &network->topology;
    const bool pulled = t->web.attached_count > 0;
    const mspringi_field field = pulled ? network->forces.total : base;
    const size_t carry_slots = (size_t)t->carry_blocks * MSPRINGI_WIDTH;
    mspringi_sweep sweeps[DEEPEST];
    for (uint32_t substep = 0; substep < count; ++substep) {
        float *carry = network->carry + 2 * substep * carry_slots;
        sweeps[substep] = (mspringi_sweep){
            .x = network->state.x,
            .y = network->state.y,
            .vx = network->state.vx,
            .vy = network->state.vy,
            .inverse_mass = network->inverse_mass,
            .force_x = field.x,
            .force_y = field.y,
            .carry_x = carry,
            .carry_y = carry + carry_slots,
            .lattice_springs = network->lattice_springs,
            .chain_springs = network->chain_springs,
            .web = &t->web,
            .web_springs = network->web_springs,
            .packed = network->packed,
            .parts = network->parts,
            .h = h,
            .decay = mspringi_decay(network->global_damping, h),
            // Never -0: a sum of forces may be +0 or -0, depending on what empty slots hold, and what is added to
            // +0 does not tell.
            .gravity_h_x = network->gravity_x * h + 0.0f,
            .gravity_h_y = network->gravity_y * h + 0.0f,
        };
    }
    // With a web that pulls at lattice or chain rows, count is 1; without, the kinds of row know nothing of each
    // other.
    if (pulled) {
        pack_nodes(network, &sweeps[0]);
        pull_attached(network, &sweeps[0], base);
    }
    sweep_lattices(network, sweeps, count, base.x != NULL);
    for (uint32_t substep = 0; substep < count; ++substep) {
        if (t->web.group_count > 0 && !pulled)
            pack_nodes(network, &sweeps[substep]);
        sweep_range(network, &sweeps[substep], t->lattice_rows, t->row_count, base.x != NULL);
    }
}

void mspringi_explicit_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count) {
    while (count > 0) {
        const uint32_t together = count < network->depth ? count : network->depth;
        take_substeps(network, h, base, together);
        count -= together;
    }
}

void mspringi_explicit_reset(mspring_network *network) {
    // A carry row is zero again after every substep, as there is no row above the last, unless numbers overflowed.
    memset(network->carry, 0,
           (size_t)2 * network->depth * network->topology.carry_blocks * MSPRINGI_WIDTH * sizeof *network->carry);
}
