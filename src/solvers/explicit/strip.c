/// Sweeping a strip of rows, and what hangs on it.
#include "solvers/explicit/strip.h"

#include <math.h>
#include <string.h>

#include "base/decay.h"
#include "base/dither.h"
#include "features/contact/floor.h"
#include "solvers/explicit/flush.h"
#include "solvers/explicit/halo.h"
#include "solvers/explicit/partial_sweep.h"
#include "store/precise.h"

mspringi_substep mspringi_substep_prepare(const mspring_network *network, float h, mspringi_field base, uint32_t i,
                                          uint32_t count, uint32_t carry_number) {
    mspringi_substep substep = {
        .base = base,
        .tests = network->tested.yields && network->tested.is_swept,
        .sweep =
            {
                .x = network->state.x,
                .y = network->state.y,
                .vx = network->state.vx,
                .vy = network->state.vy,
                .low_x = network->state.low_x,
                .low_y = network->state.low_y,
                .low_vx = network->state.low_vx,
                .low_vy = network->state.low_vy,
                .grid = mspringi_rounding(&network->state),
                .inverse_mass = mspringi_active_inverse_mass(network),
                .force_x = base.x,
                .force_y = base.y,
                .lattice_springs = network->lattice_springs,
                .springs_of_block = network->shared_records.of_block,
                .cells = network->cells.swept > 0 ? network->cells.values : NULL,
                .rest_lengths = network->rest_lengths.lengths,
                .rests_of_block = network->tested.nominal ? network->tested.shared_records.of_block
                                                          : network->rest_lengths.of_block,
                .chain_springs = network->chain_springs,
                .irregular = &network->topology.irregular,
                .irregular_springs = network->irregular_springs,
                .parts = network->parts,
                .h = h,
            },
    };
    mspringi_substep_reuse(network, &substep, i, count, carry_number);
    return substep;
}

// The first substep takes velocities from the middle of the one before it to its own.
static float time_of(float lag, float h, uint32_t i) {
    return i == 0 ? 0.5f * (lag + h) : h;
}

void mspringi_sweep_set_substep(const mspring_network *network, mspringi_sweep *sweep, uint32_t i) {
    const mspring_settings *settings = &network->settings;
    const float time = time_of(network->lag, sweep->h, i), full_time = time_of(network->full_lag, sweep->h, i);
    if (time != sweep->time || full_time != sweep->gravity_time) {
        sweep->gravity_time = full_time;
        sweep->time = time;
        sweep->damping_loss = mspringi_loss(settings->global_damping, time);
        sweep->kick = mspringi_gain(settings->global_damping, time);
        sweep->gravity_kick = mspringi_gain(settings->global_damping, full_time);
        // Never -0: what is added to +0 then does not depend on the sign of a force that is 0.
        sweep->gravity_h_x = settings->gravity_x * sweep->gravity_kick + 0.0f;
        sweep->gravity_h_y = settings->gravity_y * sweep->gravity_kick + 0.0f;
    }
    const uint32_t number = network->first_substep + i;
    sweep->loss = number < network->dithered ? sweep->damping_loss + mspringi_dither(number) : sweep->damping_loss;
    sweep->flushes = number % MSPRINGI_FLUSH_PERIOD == 0;
}

void mspringi_substep_reuse(const mspring_network *network, mspringi_substep *substep, uint32_t i, uint32_t count,
                            uint32_t carry_number) {
    const mspringi_topology *t = &network->topology;
    const size_t carry_slots = (size_t)t->carry_blocks * MSPRINGI_WIDTH;
    const size_t gathered_floats =
        (size_t)mspringi_gathered_values(network) * t->irregular.slice_count * MSPRINGI_WIDTH;
    substep->look = (network->tested.substep + i) / MSPRINGI_YIELD_PERIOD;
    substep->looks = substep->tests && (network->tested.substep + i) % MSPRINGI_YIELD_PERIOD == 0;
    substep->gathered = network->gathered + i % 2 * gathered_floats;
    substep->next_gathered = i + 1 < count ? network->gathered + (i + 1) % 2 * gathered_floats : NULL;
    substep->sweep.gathered = substep->gathered;
    mspringi_sweep_set_substep(network, &substep->sweep, i);
    substep->sweep.carry_x = network->carry + 2 * carry_number * carry_slots;
    substep->sweep.carry_y = substep->sweep.carry_x + carry_slots;
}

// Pack what the irregular part sees of the nodes that are slots of a strip.
static void pack_attached(const mspring_network *network, const mspringi_strip *strip, float *gathered) {
    const mspringi_sell *irregular = &network->topology.irregular;
    const uint32_t *slots = irregular->attached_slot + strip->first_attached;
    gathered += 4 * ((size_t)irregular->own_count + strip->first_attached);
    for (uint32_t i = 0; i < strip->attached_count; ++i, gathered += 4)
        mspringi_pack_slot(network, irregular, gathered, slots[i]);
}

// Pack groups that lie behind one another.
static void pack_blocks(const mspring_network *network, const mspringi_sweep *sweep, size_t first_block,
                        size_t count, float *gathered) {
    if (!network->is_precise) {
        network->kernels->pack(sweep, first_block, count, gathered);
        return;
    }
    mspringi_sweep from = *sweep;
    from.vx = from.low_x;
    from.vy = from.low_y;
    network->kernels->pack(&from, first_block, count, gathered);
    if (!mspringi_packs_halves(network))
        return;
    from.x = sweep->vx;
    from.y = sweep->vy;
    network->kernels->pack(&from, first_block, count, gathered + mspringi_gathered_half(sweep->irregular));
}

// Pack what the irregular part sees of its own nodes in a span: runs of groups that somebody reads there.
static void pack_span(const mspring_network *network, const mspringi_sweep *sweep, const mspringi_span *span,
                      float *gathered) {
    const uint8_t *is_read = network->topology.irregular.is_read;
    const size_t first_block = span->first_slot / MSPRINGI_WIDTH;
    const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH - first_block + span->first_record;
    for (size_t first = span->first_record, last = first; first < end; first = ++last) {
        while (last < end && (!is_read || is_read[last]))
            ++last;
        if (last > first)
            pack_blocks(network, sweep, first_block + (first - span->first_record), last - first,
                        gathered + 4 * first * MSPRINGI_WIDTH);
    }
}

// Add what the irregular part's pull at the slots of a strip does in the substep that they have just been swept
// for. It could be among the forces that they are swept with, but then whole strips would read them for the sake of
// some slots.
static void pull_attached(const mspring_network *network, const mspringi_substep *substep,
                          const mspringi_strip *strip) {
    const mspringi_sell *irregular = &network->topology.irregular;
    const mspringi_sweep *sweep = &substep->sweep;
    const uint32_t *slots = irregular->attached_slot + strip->first_attached;
    float *pull_x = network->attached, *pull_y = network->attached + irregular->attached_count;
    mspringi_attached_kernel(network)(sweep, strip->first_attached, strip->attached_count, pull_x, pull_y);
    pull_x += strip->first_attached;
    pull_y += strip->first_attached;
    for (uint32_t i = 0; i < strip->attached_count; ++i) {
        const uint32_t slot = slots[i];
        if (!(sweep->inverse_mass[slot] > 0.0f))
            continue;
        const float change = sweep->inverse_mass[slot] * sweep->kick; // of velocity, per newton
        const float dvx = pull_x[i] * change, dvy = pull_y[i] * change;
        mspringi_push_by(&network->state, slot, dvx, dvy);
        mspringi_move_by(&network->state, slot, dvx * sweep->h, dvy * sweep->h);
    }
}

// Sweep rows that follow each other, all of one kind.
static void sweep_rows(const mspring_network *network, const mspringi_substep *substep, const mspringi_row *rows,
                       uint32_t row_count, bool is_partly) {
    const mspringi_topology *t = &network->topology;
    const mspringi_row *last = &rows[row_count - 1];
    uint32_t first_span = rows->first_span, end_span = last->first_span + last->span_count;
    const mspringi_span *spans = t->spans;
    const mspringi_sweep *sweep = &substep->sweep;
    if (rows->kind == MSPRINGI_ROW_LOOSE)
        return; // moved apart, see explicit.c
    const mspringi_row_fn sweep_spans =
        mspringi_row_kernel(network, rows->kind, substep->base.x != NULL, sweep->test != NULL);
    if (is_partly) {
        for (const mspringi_row *row = rows; row <= last; ++row)
            mspringi_partial_sweep_row(network, substep, sweep_spans, row);
        return;
    }
    if (t->trimmed_spans && first_span < t->trimmed_count) {
        spans = t->trimmed_spans;
        first_span = t->first_trimmed[first_span];
        end_span = t->first_trimmed[end_span];
    }
    sweep_spans(sweep, spans + first_span, end_span - first_span);
}

void mspringi_irregular_pack(const mspring_network *network, const mspringi_substep *substep,
                             const mspringi_span *span) {
    pack_span(network, &substep->sweep, span, substep->gathered);
}

void mspringi_irregular_pack_next(const mspring_network *network, const mspringi_substep *substep,
                                  const mspringi_span *span) {
    pack_span(network, &substep->sweep, span, substep->next_gathered);
}

void mspringi_irregular_sweep(const mspring_network *network, const mspringi_substep *substep,
                              const mspringi_span *span) {
    const mspringi_row_fn irregular =
        mspringi_row_kernel(network, MSPRINGI_ROW_IRREGULAR, substep->base.x != NULL, false);
    if (network->sleep.sleeping > 0)
        mspringi_partial_sweep_irregular(network, substep, irregular, span);
    else
        irregular(&substep->sweep, span, 1);
}

void mspringi_strip_pack(const mspring_network *network, const mspringi_substep *substep,
                         const mspringi_strip *strip) {
    const mspringi_topology *t = &network->topology;
    if (t->irregular.slice_count == 0)
        return;
    pack_attached(network, strip, substep->gathered);
    if (strip->assigned_span != MSPRING_NONE)
        mspringi_irregular_pack(network, substep, &t->spans[strip->assigned_span]);
}

// What a strip tests in a substep: in a look all its springs, and after one that found some of them warm as well.
static bool begin_test(const mspring_network *network, const mspringi_substep *substep, const mspringi_strip *strip,
                       mspringi_yield_test *test) {
    const mspringi_tested *p = &network->tested;
    uint8_t *warmth = &p->warmth[strip - network->topology.strips];
    if (substep->looks)
        *warmth &= (uint8_t)~MSPRINGI_WARM;
    else if (!(p->maps && *warmth & MSPRINGI_WARM))
        return false;
    *test = (mspringi_yield_test){.looks = substep->looks,
                                  .maps = p->maps,
                                  .test_low = substep->looks ? p->low : p->flow_low,
                                  .test_high = substep->looks ? p->high : p->flow_high,
                                  .low = p->low,
                                  .high = p->high,
                                  .flow_low = p->flow_low,
                                  .flow_high = p->flow_high,
                                  .nominal = p->nominal,
                                  .yield_strain = p->yield_strain,
                                  .hardening = p->hardening,
                                  .plastic_limit = p->plastic_limit,
                                  .gain = p->gain,
                                  .lattice_rests = network->rest_lengths.lengths,
                                  .chain_springs = network->chain_springs,
                                  .live = network->live,
                                  .first_chain_slot = network->topology.lattice_spring_slots,
                                  .shared_records = p->shared_records,
                                  .block_count = network->topology.lattice_blocks,
                                  .heat = p->heat,
                                  .before = p->before,
                                  .has_flowed = p->has_flowed,
                                  .warmth = warmth,
                                  .look = substep->look,
                                  .warm = p->warm,
                                  .look_of = p->look_of};
    return true;
}

static void sweep_strip(const mspring_network *network, const mspringi_substep *substep,
                        const mspringi_strip *strip, const mspringi_halo *halo) {
    const mspringi_row *rows = &network->topology.rows[strip->first_row], *last = rows + strip->row_count - 1;
    const bool is_partly = mspringi_sleep_state_of_strip(network, strip) == MSPRINGI_PARTLY_ASLEEP;
    const bool has_halo = halo && last->kind == MSPRINGI_ROW_LATTICE;
    const uint32_t row_count = strip->row_count - has_halo;
    const mspringi_span *spans = &network->topology.spans[rows->first_span];
    const uint32_t span_count = last->first_span + last->span_count - rows->first_span;
    mspringi_floor_save_velocities(network, strip, spans, span_count);
    for (uint32_t first = 0, count; first < row_count; first += count) {
        for (count = 1; first + count < row_count && rows[first + count].kind == rows[first].kind;)
            ++count;
        sweep_rows(network, substep, &rows[first], count, is_partly);
    }
    if (has_halo)
        mspringi_halo_sweep(network, halo, substep, strip);
    if (strip->attached_count > 0)
        pull_attached(network, substep, strip);
    if (network->added_springs.count > 0)
        mspringi_added_springs_pull(network, &substep->sweep, network->topology.spans[rows->first_span].first_slot,
                                    network->topology.spans[last->first_span + last->span_count - 1].end_slot);
    mspringi_floor_apply(network, strip, spans, span_count, &substep->sweep);
    if (strip->attached_count > 0 && substep->next_gathered)
        pack_attached(network, strip, substep->next_gathered);
    if (strip->assigned_span == MSPRING_NONE)
        return;
    const mspringi_span *span = &network->topology.spans[strip->assigned_span];
    mspringi_floor_save_velocities(network, strip, span, 1);
    mspringi_irregular_sweep(network, substep, span);
    if (network->added_springs.count > 0)
        mspringi_added_springs_pull(network, &substep->sweep, span->first_slot, span->end_slot);
    mspringi_floor_apply(network, strip, span, 1, &substep->sweep);
    if (substep->next_gathered)
        pack_span(network, &substep->sweep, span, substep->next_gathered);
}

void mspringi_strip_sweep(const mspring_network *network, const mspringi_substep *substep,
                          const mspringi_strip *strip, const mspringi_halo *halo) {
    mspringi_yield_test test;
    if (substep->tests && begin_test(network, substep, strip, &test)) {
        mspringi_substep tested = *substep;
        tested.sweep.test = &test;
        sweep_strip(network, &tested, strip, halo);
    } else {
        sweep_strip(network, substep, strip, halo);
    }
}

/* -------------------------------------------------------------------------------------- before and after a step */

// Slots first to end - 1, in whole blocks.
static void keep_slots(const mspring_network *network, size_t first, size_t end) {
    const mspringi_state *from = &network->state, *to = &network->backup;
    const size_t size = (end - first) * sizeof *from->x;
    memcpy(to->x + first, from->x + first, size);
    memcpy(to->y + first, from->y + first, size);
    memcpy(to->vx + first, from->vx + first, size);
    memcpy(to->vy + first, from->vy + first, size);
    memcpy(to->low_x + first, from->low_x + first, size);
    memcpy(to->low_y + first, from->low_y + first, size);
    if (!from->low_vx)
        return;
    memcpy(to->low_vx + first, from->low_vx + first, size);
    memcpy(to->low_vy + first, from->low_vy + first, size);
}

static mspringi_extrema look_at_slots(const mspring_network *network, size_t first, size_t end) {
    mspringi_flush_to_zero(network, first, end);
    return mspringi_guard_extrema(network, first, end);
}

static size_t first_block_slot(const mspringi_span *span) {
    return span->first_slot / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
}

static size_t end_block_slot(const mspringi_span *span) {
    return ((size_t)span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
}

// The spans of rows that follow each other lie behind one another.
static size_t first_row_slot(const mspring_network *network, const mspringi_strip *strip) {
    const mspringi_topology *t = &network->topology;
    return first_block_slot(&t->spans[t->rows[strip->first_row].first_span]);
}

static size_t end_row_slot(const mspring_network *network, const mspringi_strip *strip) {
    const mspringi_topology *t = &network->topology;
    const mspringi_row *last = &t->rows[strip->first_row + strip->row_count - 1];
    return end_block_slot(&t->spans[last->first_span + last->span_count - 1]);
}

void mspringi_span_save_state(const mspring_network *network, const mspringi_span *span) {
    keep_slots(network, first_block_slot(span), end_block_slot(span));
}

mspringi_extrema mspringi_span_extrema(const mspring_network *network, const mspringi_span *span) {
    return look_at_slots(network, first_block_slot(span), end_block_slot(span));
}

void mspringi_substep_save_state(const mspring_network *network, mspringi_substep *substep) {
    substep->sweep.keep = network->backup.x;
}

void mspringi_substep_track_extrema(const mspring_network *network, mspringi_substep *substep,
                                    mspringi_extrema_lanes *watch) {
    substep->sweep.watch = watch;
    substep->sweep.before = network->guard.watches ? network->backup.vx : NULL;
    substep->sweep.watches_coordinate = !network->guard.knows_coordinate;
    substep->sweep.watches_speed = !(network->guard.watches && network->guard.knows_speed);
}

mspringi_extrema_lanes *mspringi_extrema_in_buffer(mspringi_extrema_buffer *room) {
    const size_t bytes = sizeof(float) * MSPRINGI_WIDTH, over = (uintptr_t)room->values % bytes;
    return (mspringi_extrema_lanes *)(void *)(room->values + (bytes - over) % bytes / sizeof(float));
}

// What the irregular part has pulled at after the slots of the strip were swept.
static mspringi_extrema look_at_attached(const mspring_network *network, const mspringi_strip *strip) {
    const mspringi_state *s = &network->state, *b = &network->backup;
    const uint32_t *slots = network->topology.irregular.attached_slot + strip->first_attached;
    mspringi_extrema extrema = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < strip->attached_count; ++i) {
        const uint32_t slot = slots[i];
        const float change_x = fabsf(s->vx[slot] - b->vx[slot]), change_y = fabsf(s->vy[slot] - b->vy[slot]);
        extrema =
            mspringi_extrema_join(extrema, (mspringi_extrema){fabsf(s->x[slot]), fabsf(s->vx[slot]), change_x});
        extrema =
            mspringi_extrema_join(extrema, (mspringi_extrema){fabsf(s->y[slot]), fabsf(s->vy[slot]), change_y});
    }
    return extrema;
}

mspringi_extrema mspringi_strip_end(const mspring_network *network, const mspringi_strip *strip) {
    mspringi_flush_to_zero(network, first_row_slot(network, strip), end_row_slot(network, strip));
    if (strip->assigned_span != MSPRING_NONE) {
        const mspringi_span *span = &network->topology.spans[strip->assigned_span];
        mspringi_flush_to_zero(network, first_block_slot(span), end_block_slot(span));
    }
    return strip->attached_count > 0 ? look_at_attached(network, strip) : (mspringi_extrema){0.0f, 0.0f, 0.0f};
}
