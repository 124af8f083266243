/// @file wrecks.h
/// A network of everything, ways to break it, and solvers to step what is left.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_WRECKS_H
#define TEST_WRECKS_H

#include <massspring/massspring.h>
#include <stdbool.h>

#include "readings.h"
#include "recipe.h"

/// Rows of every kind, springs of both kinds, dampers.
recipe wrecks_recipe(void);
/// Four substeps, gravity, global damping.
mspring_network *wrecks_network(const recipe *made, mspring_simd level, uint32_t worker_count);

/// Nine springs of ten break anywhere; those that cross one of some lines; all.
typedef enum wreck { SHATTERED, TORN, DISSOLVED, WRECKS } wreck;

bool wrecks_breaks(const recipe *made, wreck kind, mspring_id s);
void wrecks_make(mspring_network *network, const recipe *made, wreck kind);

support_plan wrecks_plan(const mspring_network *network);
/// Springs that a step sweeps.
uint32_t wrecks_swept(const mspring_network *network);

/// How the runs differ: one solver or another, with hooks or not. All have a floor.
enum { WRECKS_RUNS = 6 };

void wrecks_set_solver(mspring_network *network, mspring_solver which, mspring_integrator integrator);
void wrecks_set_up(mspring_network *network, int run);

#endif
