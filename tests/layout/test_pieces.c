/// @file test_pieces.c
/// A plan is the same whatever the registers that it is for, and made by as many functions for any number of
/// workers.
///
/// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/message.h"
#include "layout/topology.h"
#include "recipe.h"
#include "support.h"

static mspring_builder *builder_of(const recipe *made) {
    mspring_builder *builder = NULL;
    check_ok(mspring_builder_create(NULL, &builder));
    check_ok(mspring_builder_add_particles(builder, made->particles, made->particle_count, NULL));
    check_ok(mspring_builder_add_springs(builder, made->springs, made->spring_count, NULL));
    return builder;
}

/// A topology, and how many functions have made it.
typedef struct laid_out {
    mspringi_topology topology;
    uint32_t parts;
} laid_out;

static laid_out lay_out_for(const mspring_builder *builder, uint32_t workers, uint32_t lanes,
                            mspringi_memory *memory) {
    const mspringi_reserve reserve = {.first_particle = (uint32_t)builder->particle_count,
                                      .first_spring = (uint32_t)builder->spring_count,
                                      .particle_end = (uint32_t)builder->particle_count + 5,
                                      .spring_end = (uint32_t)builder->spring_count + 9};
    laid_out out = {.parts = 0};
    mspringi_message message = {0};
    mspringi_layout_builder *begun = NULL;
    check_ok(mspringi_topology_begin(builder, &reserve, false, true, workers, lanes, memory,
                                     &message, &begun));
    for (bool is_done = false; !is_done; out.parts++) {
        check_ok(mspringi_topology_run(begun, &is_done));
    }
    mspringi_topology_finish(begun, memory, &out.topology);
    return out;
}

static void check_same(const laid_out *a, const laid_out *b) {
    const mspringi_topology *s = &a->topology, *t = &b->topology;
    assert_int_equal(s->block_count, t->block_count);
    assert_int_equal(s->row_spring_slots, t->row_spring_slots);
    assert_int_equal(s->irregular_count, t->irregular_count);
    assert_int_equal(s->span_count, t->span_count);
    assert_int_equal(s->row_count, t->row_count);
    assert_int_equal(s->strip_count, t->strip_count);
    assert_int_equal(s->skew, t->skew);
    assert_int_equal(s->empty_run_count, t->empty_run_count);
    assert_memory_equal(s->slot_of_spring, t->slot_of_spring, s->spring_count * sizeof *s->slot_of_spring);
    assert_memory_equal(s->slot_of_particle, t->slot_of_particle,
                        s->reserve.particle_end * sizeof *s->slot_of_particle);
    assert_memory_equal(s->particle_of_slot, t->particle_of_slot,
                        (size_t)s->block_count * MSPRINGI_WIDTH * sizeof *s->particle_of_slot);
    assert_memory_equal(s->up_of_block, t->up_of_block, s->lattice_blocks * sizeof *s->up_of_block);
    assert_memory_equal(s->grid_of_row, t->grid_of_row, s->lattice_rows * sizeof *s->grid_of_row);
    assert_memory_equal(s->irregular_a, t->irregular_a, s->irregular_count * sizeof *s->irregular_a);
    assert_memory_equal(s->irregular_b, t->irregular_b, s->irregular_count * sizeof *s->irregular_b);
    for (uint32_t i = 0; i < s->span_count; i++) {
        assert_int_equal(s->spans[i].first_slot, t->spans[i].first_slot);
        assert_int_equal(s->spans[i].end_slot, t->spans[i].end_slot);
        assert_int_equal(s->spans[i].up, t->spans[i].up);
        assert_int_equal(s->spans[i].carry, t->spans[i].carry);
    }
    assert_memory_equal(s->strips, t->strips, s->strip_count * sizeof *s->strips);
    assert_memory_equal(s->empty_runs, t->empty_runs, s->empty_run_count * sizeof *s->empty_runs);
    assert_int_equal(s->irregular.slice_count, t->irregular.slice_count);
    assert_memory_equal(s->irregular.attached_slot, t->irregular.attached_slot,
                        s->irregular.attached_count * sizeof *s->irregular.attached_slot);
    assert_memory_equal(s->irregular.end_column, t->irregular.end_column,
                        (size_t)s->irregular.slice_count * (MSPRINGI_WIDTH / MSPRINGI_QUARTER) * sizeof *s->irregular.end_column);
    assert_memory_equal(s->irregular.entry, t->irregular.entry, 2 * (size_t)s->irregular_count * sizeof *s->irregular.entry);
    assert_memory_equal(s->irregular.neighbour, t->irregular.neighbour,
                        (size_t)s->irregular.first_slice_column[s->irregular.slice_count] * MSPRINGI_WIDTH * sizeof *s->irregular.neighbour);
}

/// When it is done must not depend on the number of workers, or networks that are compacted between steps on one
/// thread would not move alike.
static void workers_change_no_division(void **state) {
    (void)state;
    uint64_t seed = 3;
    const recipe_stuff solid = {.mass = {1, 1}, .stiffness = {100, 100}};
    for (int hung = 0; hung < 2; hung++) { // whether something hangs on the lattice: strips are by workers if not
        recipe made = {0};
        const mspring_id first = recipe_lattice(&made, 120, 60, 0, 0, 1, &solid, &seed);
        if (hung) {
            recipe_rope(&made, first, first + 60, 40, &solid, &seed);
        }
        mspring_builder *builder = builder_of(&made);
        mspringi_memory memory;
        mspringi_message message = {0};
        check_ok(mspringi_memory_init(&memory, NULL, &message));
        const laid_out one = lay_out_for(builder, 1, MSPRINGI_WIDTH, &memory);
        const laid_out seven = lay_out_for(builder, 7, MSPRINGI_WIDTH, &memory);
        assert_int_equal(one.parts, seven.parts);
        assert_true(one.parts > 50);
        mspringi_free_all(&memory);
        mspring_builder_destroy(builder);
        recipe_free(&made);
    }
}

/// Mark what has to be swept: particles, the slots that have springs, and those that hand on springs' forces.
static void mark_busy(const laid_out *plan, uint8_t *busy) {
    const mspringi_topology *t = &plan->topology;
    for (uint32_t slot = 0; slot < t->chain_first * MSPRINGI_WIDTH; slot++) {
        busy[slot] = t->particle_of_slot[slot] != MSPRING_NONE;
    }
    for (uint32_t s = 0; s < t->spring_count; s++) {
        const mspringi_spring_slot place = t->slot_of_spring[s];
        if (place < t->lattice_spring_slots) {
            const uint32_t row = place / MSPRINGI_WIDTH, direction = row % MSPRINGI_DIRECTIONS;
            const uint32_t slot =
                (t->lattice_first + row / MSPRINGI_DIRECTIONS) * MSPRINGI_WIDTH + place % MSPRINGI_WIDTH;
            busy[slot] = 1;
            busy[slot + 1] |= direction == MSPRINGI_NORTH_EAST;
        }
    }
}

/// Registers of the lattices that hold nothing are not swept, all others once, at the places they have anyway.
static void check_tight(const laid_out *plan, uint32_t lanes, const uint8_t *busy, uint8_t *swept) {
    const mspringi_topology *t = &plan->topology;
    for (uint32_t s = 0; s < t->trimmed_count; s++) {
        const mspringi_span *span = &t->spans[s];
        for (uint32_t i = t->first_trimmed[s]; i < t->first_trimmed[s + 1]; i++) {
            const mspringi_span *tight = &t->trimmed_spans[i];
            assert_true(tight->first_slot >= span->first_slot && tight->end_slot <= span->end_slot);
            assert_int_equal(tight->up, span->up);
            assert_int_equal(tight->carry, span->carry);
            assert_int_equal(tight->first_record - span->first_record,
                             tight->first_slot / MSPRINGI_WIDTH - span->first_slot / MSPRINGI_WIDTH);
            for (uint32_t slot = tight->first_slot / lanes * lanes; slot < tight->end_slot; slot += lanes) {
                assert_false(swept[slot]);
                memset(swept + slot, 1, lanes);
                assert_non_null(memchr(busy + slot, 1, lanes));
            }
        }
    }
    for (uint32_t slot = 0; slot < t->chain_first * MSPRINGI_WIDTH; slot++) {
        assert_true(swept[slot] || !busy[slot]);
    }
}

static void empty_registers_are_left_out(void **state) {
    (void)state;
    uint64_t seed = 5;
    const recipe_stuff holey = {.mass = {1, 1}, .stiffness = {100, 100}, .holes = 0.5};
    recipe made = {0};
    recipe_lattice(&made, 200, 60, 0, 0, 1, &holey, &seed);
    mspring_builder *builder = builder_of(&made);
    mspringi_memory memory;
    mspringi_message message = {0};
    check_ok(mspringi_memory_init(&memory, NULL, &message));
    const laid_out whole = lay_out_for(builder, 1, MSPRINGI_WIDTH, &memory);
    assert_null(whole.topology.trimmed_spans);
    const size_t slots = (size_t)whole.topology.block_count * MSPRINGI_WIDTH;
    uint8_t *busy = calloc(slots, 1);
    assert_non_null(busy);
    mark_busy(&whole, busy);
    for (uint32_t lanes = 4; lanes <= 8; lanes *= 2) {
        const laid_out plan = lay_out_for(builder, 1, lanes, &memory);
        uint8_t *swept = calloc(slots, 1);
        assert_non_null(swept);
        check_same(&whole, &plan);
        assert_int_equal(plan.parts, whole.parts);
        assert_non_null(plan.topology.trimmed_spans);
        check_tight(&plan, lanes, busy, swept);
        free(swept);
    }
    free(busy);
    mspringi_free_all(&memory);
    mspring_builder_destroy(builder);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(workers_change_no_division),
        cmocka_unit_test(empty_registers_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
