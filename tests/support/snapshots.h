/// @file snapshots.h
/// Snapshots, networks that have something of everything to save, and ways to forge what was saved.
///
/// SPDX-License-Identifier: MIT
#ifndef SNAPSHOTS_H
#define SNAPSHOTS_H

#include "recipe.h"

typedef struct saved {
    uint8_t *bytes; ///< to be freed
    size_t size;
} saved;

saved snapshots_save(const mspring_network *network, mspring_snapshot_contents contents);
void snapshots_load(mspring_network *network, const saved *from);

/// Make the checksum right again.
void snapshots_renew_checksum(saved *of);

saved snapshots_copy(const saved *from);

/// Write a number as snapshots have it.
void snapshots_put_word(uint8_t *at, uint32_t word);
void snapshots_put_float(uint8_t *at, float value);
void snapshots_put_double(uint8_t *at, double value);

/// Loading it, with the checksum made right, fails with this, and changes nothing.
void snapshots_check_refused(mspring_network *network, saved *forged, const char *part);

/// Where a section's bytes are.
uint8_t *snapshots_section_of(const saved *of, const char *tag, uint64_t *size);

/// Four substeps, gravity, no damping.
mspring_network *snapshots_make(const recipe *made, mspring_simd level, uint32_t worker_count);
void snapshots_use_solver(mspring_network *network, mspring_solver kind, mspring_integrator integrator,
                          uint32_t coarse_period);

/// A network of few bytes, with something in each section but those of growth and sleep.
recipe snapshots_small_recipe(void);
mspring_network *snapshots_small_network(const recipe *made);
mspring_network *snapshots_small_guarded(const recipe *made, mspring_guard guard);

/// What the springs are like: what a frame leaves out.
void snapshots_set_up(mspring_network *network);

/// A frame of a game, which does a bit of everything, as a function of the frame's number alone.
void snapshots_run_frame(mspring_network *network, uint32_t frame);

/// Everything that can be asked, in one number.
uint64_t snapshots_look_at(const mspring_network *network);

#endif
