/// @file back.c
/// Chapters that are played twice, from a snapshot or from clones. Both times have the same log.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "game.h"

typedef struct past {
    place places[PLACES];
    mspring_network *clones[PLACES];
    memory *memories[PLACES]; ///< of the clones
    plain *plains[PLACES];
    image saved[PLACES];
    uint64_t generations[PLACES];
    draws from;
    uint64_t log, events_log;
    uint32_t frame, chapter_end;
} past;

image keep(const mspring_network *network, mspring_snapshot_contents contents) {
    image made = {NULL, 0};
    if (mspring_network_get_snapshot_size(network, contents, &made.size) != MSPRING_OK)
        abort();
    made.bytes = malloc(made.size);
    if (!made.bytes || mspring_network_save(network, contents, made.bytes, made.size, NULL) != MSPRING_OK)
        abort();
    return made;
}

// The section that differs, for whoever looks into it.
static void tell_difference(const image *a, const image *b) {
    size_t at = 0, section = 56;
    uint64_t size = 0;
    while (at < a->size && at < b->size && a->bytes[at] == b->bytes[at])
        at++;
    while (section + 16 <= a->size) {
        memcpy(&size, a->bytes + section + 8, sizeof size);
        if (at < section + 16 + (size + 7) / 8 * 8)
            break;
        section += 16 + (size_t)(size + 7) / 8 * 8;
    }
    fprintf(stderr, "%zu and %zu bytes differ at %zu: byte %td of section %.4s\n", a->size, b->size, at,
            (ptrdiff_t)at - (ptrdiff_t)section - 16,
            section + 4 <= a->size ? (const char *)a->bytes + section : "none");
}

bool is_same_as(const mspring_network *network, const image *before) {
    const image now = keep(network, MSPRING_SNAPSHOT_ALL);
    const bool same = now.size == before->size && memcmp(now.bytes, before->bytes, now.size) == 0;
    if (!same)
        tell_difference(before, &now);
    free(now.bytes);
    return same;
}

static uint64_t generation_of(const game *it, const place *p) {
    mspring_view view = {.struct_size = sizeof view};
    JUDGE(it, mspring_network_get_view(p->network, &view) == MSPRING_OK);
    return view.layout_generation;
}

// Snapshots lack events that wait.
static void read_all_events(game *it, place *p) {
    mspring_event events[64];
    uint32_t count = 1;
    while (count > 0)
        JUDGE(it, mspring_network_read_events(p->network, events, 64, &count, NULL) == MSPRING_OK);
    p->plain->knows_events = false;
}

static mspring_network *clone_of(game *it, const place *p, memory *of) {
    mspring_clone_def def;
    mspring_network *made = NULL;
    const mspring_allocator allocator = memory_interface(of);
    JUDGE(it, mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def) == MSPRING_OK);
    def.copy_hooks = 1;
    def.allocator = &allocator;
    def.worker_count = it->setup.workers;
    mspring_result result = mspring_network_clone(p->network, &def, &made);
    if (result == MSPRING_ERROR_MEMORY && of->has_failed) {
        JUDGE(it, of->watched.live == 0 && !made);
        it->counts.failed_allocations++;
        of->fails = 0;
        result = mspring_network_clone(p->network, &def, &made);
        of->fails = p->memory->fails;
    }
    JUDGE(it, result == MSPRING_OK);
    const image before = keep(p->network, MSPRING_SNAPSHOT_ALL);
    JUDGE(it, is_same_as(made, &before));
    free(before.bytes);
    return made;
}

static void remember(game *it, past *then, mspring_snapshot_contents contents, bool by_clones) {
    *then = (past){.from = it->from,
                   .log = it->log,
                   .events_log = it->events_log,
                   .frame = it->frame,
                   .chapter_end = it->chapter_end};
    for (int i = 0; i < PLACES; i++) {
        place *p = &it->places[i];
        it->last_place = i;
        it->last_act = "remember";
        if (!p->network)
            continue;
        mspring_job_destroy(p->job);
        p->job = NULL;
        if (!by_clones)
            read_all_events(it, p);
        then->places[i] = *p;
        then->plains[i] = malloc(sizeof(plain));
        if (!then->plains[i])
            abort();
        *then->plains[i] = *p->plain;
        then->memories[i] = memory_begin(p->memory->seed, p->memory->fails);
        then->clones[i] = clone_of(it, p, then->memories[i]);
        then->saved[i] = keep(p->network, contents);
        then->generations[i] = generation_of(it, p);
    }
}

// Load, if the layout is the one of then; else go on with the clone.
static bool load(game *it, place *p, const image *saved) {
    const uint32_t fails = p->memory->fails;
    mspring_result result = mspring_network_load(p->network, saved->bytes, saved->size);
    if (result == MSPRING_ERROR_MEMORY) {
        p->memory->fails = 0;
        result = mspring_network_load(p->network, saved->bytes, saved->size);
        p->memory->fails = fails;
    }
    JUDGE(it, result == MSPRING_OK || result == MSPRING_ERROR_SNAPSHOT);
    return result == MSPRING_OK;
}

static void go_back(game *it, past *then, bool by_clones) {
    it->from = then->from;
    it->log = then->log;
    it->events_log = then->events_log;
    it->frame = then->frame;
    it->chapter_end = then->chapter_end;
    for (int i = 0; i < PLACES; i++) {
        place *p = &it->places[i], *old = &then->places[i];
        it->last_place = i;
        it->last_act = "go back";
        if (!old->network)
            continue;
        const bool is_there = p->network == old->network;
        const bool is_same = is_there && !by_clones && old->stepped == MSPRING_OK;
        if (is_same && load(it, p, &then->saved[i])) {
            mspring_network_destroy(then->clones[i]);
            memory_end(it, then->memories[i]);
        } else {
            JUDGE(it, !is_same || generation_of(it, p) != then->generations[i]);
            plain *list = p->plain;
            if (p->network)
                place_leave(it, p);
            *p = *old;
            p->plain = list;
            p->network = then->clones[i];
            p->memory = then->memories[i];
        }
        mspring_network *network = p->network;
        memory *of = p->memory;
        plain *list = p->plain;
        *p = *old;
        p->network = network;
        p->memory = of;
        p->plain = list;
        *p->plain = *then->plains[i];
        free(then->plains[i]);
        free(then->saved[i].bytes);
    }
}

void game_play_twice(game *it, mspring_snapshot_contents contents, bool by_clones) {
    past then;
    remember(it, &then, contents, by_clones);
    while (it->frame < it->chapter_end)
        game_frame(it);
    const uint64_t log = it->log, events_log = it->events_log;
    go_back(it, &then, by_clones);
    while (it->frame < it->chapter_end)
        game_frame(it);
    it->last_act = "playing again";
    JUDGE(it, it->log == log);
    JUDGE(it, !by_clones || it->events_log == events_log);
    it->counts.rollbacks++;
}
