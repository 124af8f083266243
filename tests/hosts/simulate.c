/// @file simulate.c
/// Hosts that live for hours. Each seed is a game; two of them live it in lockstep: one with scalar kernels, one
/// worker and memory that fails now and then, one with the best kernels and several workers. Both have the same
/// log.
///
///   hosts [--seeds FIRST COUNT] [--frames N]    games of N frames each
///   hosts --minutes M [--seeds FIRST 1]         as many games as there is time for
///   hosts --verbose SEED FRAME                  one game up to a frame, each call on a line
///   hosts --only LEVEL WORKERS FAILS ...        both games with this SIMD level, these workers, and memory that
///                                               fails so often, in per cent; -1: as usual. Use it to find out
///                                               why two games differ
///
/// The first error ends the program, which prints the seed and the frame.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "game.h"

static game_counts sum;

/// Settings of both games, if not -1. Set one after the other to find out why the games differ.
static int only_level = -1, only_workers = -1, only_fails = -1;

static game_setup setup_of(uint64_t seed, bool is_first) {
    game_setup made = is_first ? (game_setup){.level = MSPRING_SIMD_SCALAR,
                                              .workers = 1,
                                              .fails = seed % 3 ? 4 : 0,
                                              .looks_back = seed % 2}
                               : (game_setup){.level = seed % 5 ? MSPRING_SIMD_AUTO : MSPRING_SIMD_SSE2,
                                              .workers = 1 + (uint32_t)(seed % 3),
                                              .has_tasks = seed % 4 == 0};
    if (only_level >= 0)
        made.level = (mspring_simd)only_level;
    if (only_workers >= 0)
        made.workers = (uint32_t)only_workers, made.has_tasks = false;
    if (only_fails >= 0)
        made.fails = (uint32_t)only_fails;
    return made;
}

static void add(const game_counts *of) {
    sum.calls += of->calls, sum.refused += of->refused, sum.failed_allocations += of->failed_allocations;
    sum.rollbacks += of->rollbacks, sum.networks += of->networks, sum.events += of->events, sum.time += of->time;
}

static void play(uint64_t seed, uint32_t frames) {
    const game_setup first = setup_of(seed, true), second = setup_of(seed, false);
    const draws from = {.seed = seed};
    game *games[2] = {game_begin(&first, seed, from), game_begin(&second, seed, from)};
    while (games[0]->frame < frames) {
        game_frame(games[0]);
        game_frame(games[1]);
        if (games[0]->log != games[1]->log || games[0]->events_log != games[1]->events_log)
            game_fail(games[1], __FILE__, __LINE__, "the same log in both games");
    }
    add(&games[0]->counts);
    game_end(games[0]);
    game_end(games[1]);
}

// Both games in turn, to compare their lines.
static void tell(uint64_t seed, uint32_t until) {
    for (int i = 0; i < 2; i++) {
        game_setup setup = setup_of(seed, i == 0);
        setup.is_verbose = true;
        game *one = game_begin(&setup, seed, (draws){.seed = seed});
        printf("game %d\n", i);
        while (one->frame <= until)
            game_frame(one);
        game_end(one);
    }
}

int main(int count, char **arguments) {
    uint64_t first = 1, seeds = 20;
    uint32_t frames = 600;
    double minutes = 0;
    for (int i = 1; i < count; i++) {
        const char *one = arguments[i];
        if (!strcmp(one, "--seeds") && i + 2 < count)
            first = strtoull(arguments[i + 1], NULL, 10), seeds = strtoull(arguments[i + 2], NULL, 10), i += 2;
        else if (!strcmp(one, "--frames") && i + 1 < count)
            frames = (uint32_t)strtoul(arguments[++i], NULL, 10);
        else if (!strcmp(one, "--only") && i + 3 < count)
            only_level = atoi(arguments[i + 1]), only_workers = atoi(arguments[i + 2]),
            only_fails = atoi(arguments[i + 3]), i += 3;
        else if (!strcmp(one, "--minutes") && i + 1 < count)
            minutes = strtod(arguments[++i], NULL);
        else if (!strcmp(one, "--verbose") && i + 2 < count)
            return tell(strtoull(arguments[i + 1], NULL, 10), (uint32_t)strtoul(arguments[i + 2], NULL, 10)), 0;
        else
            return fprintf(stderr, "hosts: unknown option %s\n", one), 2;
    }
    const time_t begin = time(NULL);
    uint64_t seed = first;
    for (; minutes > 0 ? difftime(time(NULL), begin) < 60 * minutes : seed < first + seeds; seed++)
        play(seed, frames);
    printf(
        "%llu games, %llu networks, %.2f hours of simulated time, %llu calls, %llu refused, %llu without memory, "
        "%llu chapters played again, %llu events\n",
        (unsigned long long)(seed - first), (unsigned long long)sum.networks, sum.time / 3600,
        (unsigned long long)sum.calls, (unsigned long long)sum.refused, (unsigned long long)sum.failed_allocations,
        (unsigned long long)sum.rollbacks, (unsigned long long)sum.events);
    return 0;
}
