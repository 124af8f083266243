/// @file game.c
/// Frames, calls and steps.
///
/// SPDX-License-Identifier: MIT
#include "game.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

/// Chapters: frames of one kind, some of which are played twice.
enum { QUIET, BUSY, HOSTILE, TWICE_FRAME, TWICE_WHOLE, TWICE_CLONED, CHAPTERS };

void game_log(uint64_t *log, const void *bytes, size_t size) {
    for (size_t i = 0; i < size; i++)
        *log = (*log ^ ((const uint8_t *)bytes)[i]) * UINT64_C(0x100000001b3); // FNV-1a
}

void game_fail(const game *it, const char *file, int line, const char *condition) {
    const place *p = &it->places[it->last_place];
    fflush(stdout);
    fprintf(stderr, "seed %llu, frame %u, chapter %d, place %d, after %s: %s:%d: %s does not hold\n",
            (unsigned long long)it->name, it->frame, it->chapter, it->last_place,
            it->last_act ? it->last_act : "nothing", file, line, condition);
    fprintf(stderr, "level %s, %u workers; error \"%s\"\n", mspring_simd_name(it->setup.level), it->setup.workers,
            mspring_network_error(p->network));
    abort();
}

/* ------------------------------------------------------------------------------------------------- memory */

static void *MSPRING_CALL memory_alloc(size_t size, size_t alignment, void *user) {
    memory *of = user;
    if (of->fails > 0 && support_random(&of->seed) % 100 < of->fails) {
        of->has_failed = true;
        return NULL;
    }
    const mspring_allocator watched = watched_interface(&of->watched);
    return watched.alloc(size, alignment, watched.user);
}

static void MSPRING_CALL memory_free(void *bytes, size_t size, void *user) {
    memory *of = user;
    const mspring_allocator watched = watched_interface(&of->watched);
    watched.free(bytes, size, watched.user);
}

memory *memory_begin(uint64_t seed, uint32_t fails) {
    memory *made = calloc(1, sizeof *made);
    if (!made)
        abort();
    made->seed = seed;
    made->fails = fails;
    return made;
}

mspring_allocator memory_interface(memory *of) {
    return (mspring_allocator){
        .struct_size = sizeof(mspring_allocator), .alloc = memory_alloc, .free = memory_free, .user = of};
}

void memory_end(const game *it, memory *of) {
    const watched_allocator *w = &of->watched;
    JUDGE(it, w->live == 0 && w->live_bytes == 0);
    JUDGE(it, w->damaged == 0 && w->wrong_size == 0 && w->foreign == 0 && w->bad_asks == 0);
    free(of);
}

/* -------------------------------------------------------------------------------------------------- calls */

static mspring_id draw_id(draws *from, uint32_t count, bool is_hostile) {
    if (count == 0 || (is_hostile && draw_chance(from, 6))) {
        const mspring_id wrong[] = {count, count + 1, MSPRING_NONE, MSPRING_NONE - 1, 0x80000000u};
        return wrong[draw(from, COUNT_OF(wrong))];
    }
    return draw(from, count);
}

static double draw_number(draws *from, bool is_hostile) {
    static const double extremes[] = {0,    -0.0, 1e-45, 1e-38, 1e-30,    1e-6,      1e6, 1e9,   1e12,
                                      1e15, 1e30, 3e38,  -1,    INFINITY, -INFINITY, NAN, -1e30, 1e300};
    if (is_hostile && draw_chance(from, 8))
        return extremes[draw(from, COUNT_OF(extremes))];
    return draw_between(from, 0, 1);
}

static void draw_call(draws *from, const place *p, bool is_hostile, call *c) {
    c->pick = draw(from, 256);
    c->particle = draw_id(from, p->plain->particles, false);
    c->spring = draw_id(from, p->plain->springs, false);
    c->count = draw_chance(from, 70) ? draw(from, 4) : draw(from, MANY + 1);
    draws rest = draws_apart(from);
    c->pick |= draw(&rest, 256) << 8;
    if (is_hostile && draw_chance(&rest, 8))
        c->particle = draw_id(&rest, 0, true), c->spring = draw_id(&rest, 0, true);
    for (int i = 0; i < MANY; i++) {
        c->particles[i] = draw_id(&rest, p->plain->particles, is_hostile);
        c->springs[i] = draw_id(&rest, p->plain->springs, is_hostile);
        c->d[i] = draw_number(&rest, is_hostile);
        c->f[i] = (float)draw_number(&rest, is_hostile);
    }
}

static const act *choose(draws *from, uint32_t flags) {
    static const act *const lists[] = {acts_state, acts_springs, acts_laws, acts_contact, acts_tools, acts_reads};
    const uint32_t counts[] = {acts_state_count,   acts_springs_count, acts_laws_count,
                               acts_contact_count, acts_tools_count,   acts_reads_count};
    for (int i = 0; i < 12; i++) {
        const uint32_t list = draw(from, COUNT_OF(lists));
        const act *one = &lists[list][draw(from, counts[list])];
        if ((one->flags & flags) == flags && (!(one->flags & ACT_RARE) || draw(from, 16) == 0))
            return one;
    }
    return NULL;
}

// A step that MSPRING_GUARD_RETRY gives up for its work raises the substeps of the next one.
static bool has_raised_substeps(const place *p, mspring_result result) {
    return result == MSPRING_ERROR_UNSTABLE && strstr(mspring_network_error(p->network), "most_work") != NULL;
}

// A call that failed for want of memory, once more with enough of it.
static mspring_result with_memory(game *it, place *p, const act *one, const call *c, double dt,
                                  const image *before) {
    p->memory->has_failed = false;
    mspring_result result = one ? one->make(it, p, c) : mspring_network_step(p->network, dt);
    if (result == MSPRING_ERROR_MEMORY && p->memory->has_failed) {
        const uint32_t fails = p->memory->fails;
        JUDGE(it, !before->bytes || is_same_as(p->network, before));
        JUDGE(it, strlen(mspring_network_error(p->network)) > 0);
        it->counts.failed_allocations++;
        p->memory->fails = 0;
        result = one ? one->make(it, p, c) : mspring_network_step(p->network, dt);
        p->memory->fails = fails;
    }
    JUDGE(it, result != MSPRING_ERROR_MEMORY);
    it->counts.calls++;
    it->counts.refused += result != MSPRING_OK;
    if (it->setup.is_verbose)
        printf("%u %d %s: %s%s%s\n", it->frame, it->last_place, it->last_act, mspring_result_string(result),
               result ? ": " : "", result ? mspring_network_error(p->network) : "");
    if (result != MSPRING_OK) {
        JUDGE(it, strlen(mspring_network_error(p->network)) > 3);
        JUDGE(it, !before->bytes || has_raised_substeps(p, result) || is_same_as(p->network, before));
    }
    game_log(&it->log, &result, sizeof result);
    return result;
}

void game_act(game *it, place *p, uint32_t flags, bool is_hostile) {
    const act *one = choose(&it->from, flags);
    call c;
    if (!one)
        return;
    draw_call(&it->from, p, is_hostile, &c);
    it->last_act = one->name;
    image before = it->setup.looks_back ? keep(p->network, MSPRING_SNAPSHOT_ALL) : (image){NULL, 0};
    const mspring_result result = with_memory(it, p, one, &c, 0, &before);
    if (result == MSPRING_OK && !(one->flags & ACT_INSIDE))
        p->is_closed = false;
    free(before.bytes);
}

/* -------------------------------------------------------------------------------------------------- steps */

// Frames of a game: even for the most part, now and then a hitch, a pause, or nonsense.
static double draw_dt(draws *from, bool is_hostile, double last) {
    static const double nonsense[] = {0, -1, NAN, INFINITY, 1e-300, 1e300, 1e-40, 10};
    const uint32_t kind = draw(from, 256);
    if (is_hostile && kind < 8)
        return nonsense[kind];
    if (kind < 160)
        return last > 0 && last < 0.05 ? last : 1.0 / 60;
    return kind < 200   ? 1.0 / 60
           : kind < 240 ? draw_between(from, 0.004, 0.034)
           : kind < 248 ? draw_between(from, 0.034, 0.25)
           : kind < 252 ? 1e-3
                        : 1e-6;
}

// Recover from steps that fail again and again: stop all motion, then start again with a new network.
static void recover(game *it, place *p) {
    const float none = 0;
    if (p->failed_steps % 2 == 0)
        JUDGE(it,
              mspring_network_set_velocities(p->network, NULL, 0, p->plain->particles, &none, &none, 0) == MSPRING_OK);
    if (p->failed_steps > 3)
        place_leave(it, p);
}

void game_step(game *it, place *p) {
    const double dt = draw_dt(&it->from, it->chapter == HOSTILE, p->dt);
    const momenta before = judge_momenta(p);
    const size_t allocations = p->memory->watched.calls;
    image state = it->setup.looks_back ? keep(p->network, MSPRING_SNAPSHOT_ALL) : (image){NULL, 0};
    it->last_act = "step";
    p->stepped = with_memory(it, p, NULL, NULL, dt, &state);
    free(state.bytes);
    place_learn_breaks(it, p);
    if (p->stepped == MSPRING_OK) {
        const bool has_grown = support_step_flags(p->network) & MSPRING_STEP_GREW;
        JUDGE(it, has_grown || p->memory->watched.calls == allocations);
        it->counts.time += dt;
        p->dt = dt;
        p->failed_steps = 0;
        judge_step(it, p, &before);
        p->is_closed = true;
    } else {
        p->failed_steps++;
        p->is_closed = false;
        recover(it, p);
    }
}

/* ------------------------------------------------------------------------------------------------- frames */

static void begin_chapter(game *it) {
    it->chapter = (int)draw(&it->from, CHAPTERS);
    it->chapter_end = it->frame + 2 + draw(&it->from, it->chapter == QUIET ? 90 : 20);
    for (int i = 0; i < PLACES; i++) {
        place *p = &it->places[i];
        it->last_place = i;
        if (p->network && draw_chance(&it->from, 4))
            place_leave(it, p);
        if (!p->network)
            place_build(it, p);
    }
    // Played here, twice: the chapter is over then.
    if (it->chapter == TWICE_CLONED)
        game_play_twice(it, MSPRING_SNAPSHOT_ALL, true);
    else if (it->chapter == TWICE_WHOLE || it->chapter == TWICE_FRAME)
        game_play_twice(it, it->chapter == TWICE_WHOLE ? MSPRING_SNAPSHOT_ALL : MSPRING_SNAPSHOT_FRAME, false);
}

static void log_place(game *it, const place *p) {
    uint64_t hash = 0;
    mspring_step_info info = {.struct_size = sizeof info};
    JUDGE(it, mspring_network_get_state_hash(p->network, &hash) == MSPRING_OK);
    JUDGE(it, mspring_network_get_step_info(p->network, &info) == MSPRING_OK);
    game_log(&it->log, &hash, sizeof hash);
    game_log(&it->log, &info.time, sizeof info.time);
    game_log(&it->log, &info.substeps, sizeof info.substeps);
    if (it->setup.is_verbose)
        printf("%u %d hash %016llx, %u substeps, flags %u, log %016llx\n", it->frame, it->last_place,
               (unsigned long long)hash, info.substeps, info.flags, (unsigned long long)it->log);
}

static void play_place(game *it, place *p) {
    static const uint32_t flags[CHAPTERS] = {
        [QUIET] = ACT_READS, [TWICE_FRAME] = ACT_CALM, [TWICE_WHOLE] = ACT_WHOLE};
    const bool is_hostile = it->chapter == HOSTILE;
    const uint32_t most = it->chapter == QUIET ? 2 : 4;
    for (uint32_t acts = draw(&it->from, most); acts > 0; acts--)
        game_act(it, p, flags[it->chapter], is_hostile);
    game_step(it, p);
    if (p->network) {
        log_place(it, p);
        judge_place(it, p);
    }
}

void game_frame(game *it) {
    if (it->frame >= it->chapter_end)
        begin_chapter(it);
    for (int i = 0; i < PLACES; i++) {
        it->last_place = i;
        if (it->places[i].network)
            play_place(it, &it->places[i]);
    }
    it->frame++;
}

game *game_begin(const game_setup *setup, uint64_t name, draws from) {
    game *it = calloc(1, sizeof *it);
    if (!it)
        abort();
    it->setup = *setup;
    it->name = name;
    it->from = from;
    for (int i = 0; i < PLACES; i++) {
        it->places[i].plain = calloc(1, sizeof(plain));
        if (!it->places[i].plain)
            abort();
    }
    return it;
}

void game_end(game *it) {
    for (int i = 0; i < PLACES; i++) {
        it->last_place = i;
        place_leave(it, &it->places[i]);
        free(it->places[i].plain);
    }
    free(it);
}
