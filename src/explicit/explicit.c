/// The explicit solver: symplectic Euler, row by row.
#include "explicit.h"

#include <string.h>

#include "decay.h"

/// Rows that are swept several times in one pass should stay in this much cache: half of a second-level cache of
/// today.
#define CACHE_BYTES ((size_t)512 << 10)

/// Most substeps in one pass: each needs a carry row of its own.
#define DEEPEST 16

/// What one substep of a pass works with.
typedef struct substep_work {
    mspringi_sweep sweep;
    mspringi_field base; ///< forces from outside; x NULL if there are none
    float *packed;       ///< the web's nodes before the substep
    float *next_packed;  ///< where they go after it; NULL in the last substep of a pass
} substep_work;

// Pack what the web sees of the nodes that are slots of a strip.
static void pack_attached(const mspring_network *network, const mspringi_strip *strip, float *packed) {
    const mspringi_web *web = &network->topology.web;
    const mspringi_state *state = &network->state;
    const uint32_t *slots = web->attached_slot + strip->first_attached;
    packed += 4 * ((size_t)web->own_count + strip->first_attached);
    for (uint32_t i = 0; i < strip->attached_count; ++i, packed += 4) {
        packed[0] = state->x[slots[i]];
        packed[1] = state->y[slots[i]];
        packed[2] = state->vx[slots[i]];
        packed[3] = state->vy[slots[i]];
    }
}

// Pack what the web sees of its own nodes in a span.
static void pack_span(const mspring_network *network, const mspringi_sweep *sweep, const mspringi_span *span,
                      float *packed) {
    const size_t first = span->first_slot / MSPRINGI_WIDTH;
    const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    network->kernels->pack(sweep, first, end - first, packed + (size_t)4 * span->first_record * MSPRINGI_WIDTH);
}

// Put the web's pull at the slots of a strip on top of base into the total field.
static void pull_attached(const mspring_network *network, const substep_work *substep,
                          const mspringi_strip *strip) {
    const mspringi_web *web = &network->topology.web;
    const mspringi_field total = network->forces.total, base = substep->base;
    const uint32_t *slots = web->attached_slot + strip->first_attached;
    float *pull_x = network->attached, *pull_y = network->attached + web->attached_count;
    network->kernels->attached[network->parts > MSPRINGI_DAMPING](&substep->sweep, strip->first_attached,
                                                                  strip->attached_count, pull_x, pull_y);
    pull_x += strip->first_attached;
    pull_y += strip->first_attached;
    for (uint32_t i = 0; i < strip->attached_count; ++i) {
        total.x[slots[i]] = base.x ? base.x[slots[i]] + pull_x[i] : pull_x[i];
        total.y[slots[i]] = base.x ? base.y[slots[i]] + pull_y[i] : pull_y[i];
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

// Sweep a strip with everything that hangs on it.
static void sweep_strip(const mspring_network *network, const substep_work *substep, const mspringi_strip *strip) {
    const mspringi_row *rows = &network->topology.rows[strip->first_row];
    const bool based = substep->base.x != NULL;
    if (strip->attached_count > 0)
        pull_attached(network, substep, strip);
    for (uint32_t first = 0, count; first < strip->row_count; first += count) {
        for (count = 1; first + count < strip->row_count && rows[first + count].kind == rows[first].kind;)
            ++count;
        sweep_rows(network, &substep->sweep, &rows[first], count, based || strip->attached_count > 0);
    }
    if (strip->attached_count > 0 && substep->next_packed)
        pack_attached(network, strip, substep->next_packed);
    if (strip->home_span == MSPRING_NONE)
        return;
    const mspringi_span *span = &network->topology.spans[strip->home_span];
    network->kernels->web[network->parts > MSPRINGI_DAMPING][based](&substep->sweep, span, 1);
    if (substep->next_packed)
        pack_span(network, &substep->sweep, span, substep->next_packed);
}

uint32_t mspringi_explicit_depth(const mspringi_topology *topology, uint32_t parts) {
    if (topology->wave_rows == 0)
        return 1;
    const size_t floats_per_slot = 4 + 1 + (size_t)MSPRINGI_DIRECTIONS * parts; // state, inverse mass, springs
    const size_t slots = (size_t)topology->lattice_blocks * MSPRINGI_WIDTH;
    const size_t rows = CACHE_BYTES / (floats_per_slot * sizeof(float)) * topology->lattice_rows / slots;
    const size_t strips = rows * topology->wave_strips / topology->wave_rows;
    const size_t depth = strips > topology->lag ? (strips - 1) / topology->lag : 1;
    return (uint32_t)(depth < DEEPEST ? depth : DEEPEST);
}

// Take several substeps in one pass over the wave's strips: each runs lag strips behind the one before, so a strip
// is in the cache for all of them. A strip's substep needs the one before of the strip itself, of the row above,
// and of the other ends of leftover springs: all are done by then, and none is further.
static void sweep_wave(const mspring_network *network, const substep_work *substeps, uint32_t count) {
    const mspringi_topology *t = &network->topology;
    const uint32_t fronts = t->wave_strips > 0 ? t->wave_strips + (count - 1) * t->lag : 0;
    for (uint32_t front = 0; front < fronts; ++front)
        for (uint32_t i = 0; i < count && i * t->lag <= front; ++i)
            if (front - i * t->lag < t->wave_strips)
                sweep_strip(network, &substeps[i], &t->strips[front - i * t->lag]);
}

// Pack the web's nodes that the strips first ... end - 1 have.
static void pack_nodes(const mspring_network *network, const substep_work *substep, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &network->topology;
    for (uint32_t s = first; t->web.group_count > 0 && s < end; ++s) {
        const mspringi_strip *strip = &t->strips[s];
        pack_attached(network, strip, substep->packed);
        if (strip->home_span != MSPRING_NONE)
            pack_span(network, &substep->sweep, &t->spans[strip->home_span], substep->packed);
        if (t->rows[strip->first_row].kind == MSPRINGI_ROW_WEB)
            pack_span(network, &substep->sweep, &t->spans[t->rows[strip->first_row].first_span], substep->packed);
    }
}

// Substep i of a pass of count.
static substep_work prepare(const mspring_network *network, float h, mspringi_field base, uint32_t i,
                            uint32_t count) {
    const mspringi_topology *t = &network->topology;
    const mspringi_field field = t->web.attached_count > 0 ? network->forces.total : base;
    const size_t carry_slots = (size_t)t->carry_blocks * MSPRINGI_WIDTH;
    const size_t packed_floats = (size_t)4 * t->web.group_count * MSPRINGI_WIDTH;
    float *carry = network->carry + 2 * i * carry_slots;
    return (substep_work){
        .base = base,
        .packed = network->packed + i % 2 * packed_floats,
        .next_packed = i + 1 < count ? network->packed + (i + 1) % 2 * packed_floats : NULL,
        .sweep =
            {
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
                .packed = network->packed + i % 2 * packed_floats,
                .parts = network->parts,
                .h = h,
                .decay = mspringi_decay(network->global_damping, h),
                // Never -0: a sum of forces may be +0 or -0, depending on what empty slots hold, and what is added
                // to +0 does not tell.
                .gravity_h_x = network->gravity_x * h + 0.0f,
                .gravity_h_y = network->gravity_y * h + 0.0f,
            },
    };
}

// Take at most network->depth substeps. The wave's strips know nothing of the others, nor they of the wave's.
static void take_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count) {
    const mspringi_topology *t = &network->topology;
    substep_work substeps[DEEPEST];
    substeps[0] = prepare(network, h, base, 0, count);
    for (uint32_t i = 1; i < count; ++i)
        substeps[i] = prepare(network, h, base, i, count);
    pack_nodes(network, &substeps[0], 0, t->wave_strips);
    sweep_wave(network, substeps, count);
    for (uint32_t i = 0; i < count; ++i) {
        substeps[i].next_packed = NULL; // for these strips, all is packed at the start of each substep
        pack_nodes(network, &substeps[i], t->wave_strips, t->strip_count);
        for (uint32_t s = t->wave_strips; s < t->strip_count; ++s)
            sweep_strip(network, &substeps[i], &t->strips[s]);
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
