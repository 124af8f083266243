/// @file game.h
/// A host as games are: some networks at once, frame by frame, with all that a host does between two steps. After
/// each frame it judges what it can see.
///
/// A game follows from its draws alone. Its log, a hash of all answers and states, must not depend on the
/// instruction set, on workers, on memory that fails, nor on what is taken back and done again.
///
/// SPDX-License-Identifier: MIT
#ifndef HOSTS_GAME_H
#define HOSTS_GAME_H

#include <massspring/massspring.h>

#include "allocator.h"
#include "draws.h"
#include "readings.h"

enum { PLACES = 3, MOST_PARTICLES = 2048, MOST_SPRINGS = 8192, MANY = 24, MOST_HOOKS = 4 };

/// Expected contents of a network, as plain lists.
typedef struct plain {
    uint32_t particles, springs; ///< ids
    bool has_particle[MOST_PARTICLES], has_spring[MOST_SPRINGS];
    mspring_id ends[MOST_SPRINGS][2];
    float mass[MOST_PARTICLES], stiffness[MOST_SPRINGS];
    bool is_broken[MOST_SPRINGS];        ///< according to calls and reads
    bool breaks_by_events[MOST_SPRINGS]; ///< by the events that were read
    bool knows_events;                   ///< none was dropped or lost since breaks_by_events was right
} plain;

/// Memory of a network, which may fail.
typedef struct memory {
    watched_allocator watched;
    uint64_t seed;
    uint32_t fails; ///< percent of allocations
    bool has_failed;
} memory;

/// A network and what its host keeps beside it.
typedef struct place {
    mspring_network *network; ///< NULL: none could be made
    memory *memory;
    mspring_job *job;
    plain *plain;
    mspring_id hooks[MOST_HOOKS];
    bool has_hook[MOST_HOOKS];
    mspring_result stepped; ///< how the last step went
    uint32_t failed_steps;  ///< in a row
    bool is_closed;         ///< nothing from outside acted since the last step
    double dt;              ///< of the last step
} place;

/// Settings of a game, which must not change its log.
typedef struct game_setup {
    mspring_simd level;
    uint32_t workers;
    bool has_tasks;  ///< workers are the host's
    uint32_t fails;  ///< percent of allocations that fail where memory is short
    bool looks_back; ///< compare the state before and after each call that is refused
    bool is_verbose; ///< print each call
} game_setup;

typedef struct game_counts {
    uint64_t calls, refused, failed_allocations, rollbacks, networks, events;
    double time; ///< simulated, s, of all networks
} game_counts;

typedef struct game {
    game_setup setup;
    uint64_t name; ///< the seed, to be printed
    draws from;
    uint32_t frame, chapter_end;
    int chapter;
    place places[PLACES];
    uint64_t log, events_log;
    game_counts counts;
    const char *last_act;
    int last_place;
    uint32_t log_count; ///< states in logs
} game;

/// Begin: no network yet.
game *game_begin(const game_setup *setup, uint64_t name, draws from);
/// Live for a frame: edits, a step of each network, reads; then judge.
void game_frame(game *it);
void game_end(game *it);

/// Say where it went wrong, and abort.
void game_fail(const game *it, const char *file, int line, const char *condition);
#define JUDGE(it, condition) ((condition) ? (void)0 : game_fail((it), __FILE__, __LINE__, #condition))

void game_log(uint64_t *log, const void *bytes, size_t size);

/* ------------------------------------------------------------------------------------------------- memory */

memory *memory_begin(uint64_t seed, uint32_t fails);
mspring_allocator memory_interface(memory *of);
/// Everything was freed.
void memory_end(const game *it, memory *of);

/* ------------------------------------------------------------------------------------------------- places */

/// make.c: build a network of any kind, with memory that may fail meanwhile.
void place_build(game *it, place *p);
void place_leave(game *it, place *p);
/// Read what the network consists of, as it has just been made or loaded.
void place_learn(game *it, place *p);
/// Take over what steps and hosts have broken.
void place_learn_breaks(game *it, place *p);

/* -------------------------------------------------------------------------------------------------- calls */

/// Arguments of any kind: now and then ones that no call takes.
typedef struct call {
    uint32_t pick; ///< below 65536, for variants
    uint32_t count;
    mspring_id particle, spring; ///< first ones
    mspring_id particles[MANY], springs[MANY];
    float f[MANY]; ///< 0 to 1
    double d[MANY];
} call;

/// Chapters in which a call may be repeated after a rollback, and other flags of calls.
enum {
    ACT_CALM = 1u << 0,   ///< after any snapshot; also ACT_WHOLE
    ACT_WHOLE = 1u << 1,  ///< after a whole one
    ACT_RARE = 1u << 2,   ///< it takes long
    ACT_INSIDE = 1u << 3, ///< it leaves the sum of momenta as it is
    ACT_SETUP = 1u << 4,  ///< it belongs to the start of a level
    ACT_READS = ACT_CALM | ACT_WHOLE | ACT_INSIDE
};

/// A call, which changes the plain list if it succeeds.
typedef struct act {
    const char *name;
    mspring_result (*make)(game *it, place *p, const call *c);
    uint32_t flags;
} act;

extern const act acts_state[], acts_springs[], acts_laws[], acts_contact[], acts_tools[], acts_reads[];
extern const uint32_t acts_state_count, acts_springs_count, acts_laws_count, acts_contact_count, acts_tools_count,
    acts_reads_count;

/// Make one of the calls that have all of these flags.
void game_act(game *it, place *p, uint32_t flags, bool is_hostile);
void game_step(game *it, place *p);

/* -------------------------------------------------------------------------------------------------- judges */

/// judge.c: compare everything that can be read of a place with the plain list.
void judge_place(game *it, place *p);
/// Momenta before a step, and after.
typedef struct momenta {
    double x, y, scale, mass;
    bool count;
} momenta;
momenta judge_momenta(const place *p);
void judge_step(game *it, place *p, const momenta *before);

/// queries.c: answers beside those of a pass over plain arrays.
void judge_queries(game *it, place *p, draws *from);

/// A whole snapshot.
typedef struct image {
    uint8_t *bytes;
    size_t size;
} image;
image keep(const mspring_network *network, mspring_snapshot_contents contents);
bool is_same_as(const mspring_network *network, const image *before);

/// back.c: begin a chapter that is played twice; play it once more once it is over.
void game_play_twice(game *it, mspring_snapshot_contents contents, bool by_clones);

#endif
