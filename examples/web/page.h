/// @file page.h
/// What the page's script calls: one network, made from a picture's cells, and tools to handle it.
///
/// Functions return a mspring_result unless they say otherwise; page_error() tells what was wrong. Positions are
/// world coordinates in metres. Compiled natively, the same sources give the bits to compare with.
///
/// SPDX-License-Identifier: MIT
#ifndef PAGE_H
#define PAGE_H

#include <stdbool.h>

#include <massspring/massspring.h>

#if defined(__wasm__)
#define PAGE_EXPORT(name) __attribute__((export_name(#name)))
#else
#define PAGE_EXPORT(name)
#endif

/// What a cell is made of, as the script writes it.
typedef struct page_material {
    float mass, stiffness, damping, break_strain, pinned, yield_strain; ///< strains of 0: never
} page_material;

/// A rope between two cells.
typedef struct page_rope {
    uint32_t from, to, segments; ///< row * width + column
    float mass, stiffness, damping, length_ratio;
} page_rope;

/// A spring as the script draws it: slots of its ends in the view.
typedef struct page_spring {
    uint32_t a, b;
    float rest_length;
} page_spring;

/* page.c: making, stepping, looking */

/// Room for what page_make() reads: cells [height][width] of 16 bits (the top row first, 65535: empty), materials,
/// ropes. NULL if there is none.
PAGE_EXPORT(prepare) uint8_t *page_prepare(uint32_t size);
PAGE_EXPORT(make)
mspring_result page_make(uint32_t width, uint32_t height, uint32_t material_count, uint32_t rope_count);
PAGE_EXPORT(step) mspring_result page_step(double dt);
PAGE_EXPORT(error) const char *page_error(void);

PAGE_EXPORT(particles) uint32_t page_particle_count(void);
PAGE_EXPORT(slots) uint32_t page_slot_count(void);
/// [slots] positions relative to the origin; the origin; 0 where there is nothing, or a pin.
PAGE_EXPORT(x) const float *page_x(void);
PAGE_EXPORT(y) const float *page_y(void);
PAGE_EXPORT(inverse_mass) const float *page_inverse_mass(void);
PAGE_EXPORT(origin_x) double page_origin_x(void);
PAGE_EXPORT(origin_y) double page_origin_y(void);
/// [springs]; of a broken one the rest length is 0.
PAGE_EXPORT(spring_count) uint32_t page_spring_count(void);
PAGE_EXPORT(springs) const page_spring *page_springs(void);
/// Counts up when springs break, are restored or yield.
PAGE_EXPORT(changes) uint32_t page_changes(void);

PAGE_EXPORT(solver) mspring_result page_set_solver(uint32_t solver, uint32_t substeps, uint32_t iterations);
PAGE_EXPORT(gravity) mspring_result page_set_gravity(float y);
PAGE_EXPORT(damping) mspring_result page_set_damping(float rate);
/// Times what the materials give.
PAGE_EXPORT(stiffness) mspring_result page_set_stiffness(float factor);
/// Whether springs break at their materials' strain.
PAGE_EXPORT(breaking) mspring_result page_set_breaking(uint32_t on);
/* bent.c: yielding */

/// Whether springs yield: at the least yield strain of the materials, or at a usual one.
PAGE_EXPORT(yielding) mspring_result page_set_yielding(uint32_t on);
/// Take all dents back.
PAGE_EXPORT(straighten) mspring_result page_straighten(void);
/// [springs]: how much of a spring's length has changed for good; and how many are bent.
PAGE_EXPORT(plastic) const float *page_plastic(void);
PAGE_EXPORT(bent_count) uint32_t page_bent_count(void);

/* page.c again */

PAGE_EXPORT(substeps) uint32_t page_substeps(void);
/// Substeps that an explicit step of that length needs; 0 if they are too many.
PAGE_EXPORT(needed) uint32_t page_needed_substeps(double dt);
/// Force along a spring, N: above 0 it pulls. And the particle at its end 0 or 1.
PAGE_EXPORT(force) float page_spring_force(uint32_t spring);
PAGE_EXPORT(end) uint32_t page_spring_end(uint32_t spring, uint32_t which);
PAGE_EXPORT(level) const char *page_level(void);
PAGE_EXPORT(kinetic_energy) double page_kinetic_energy(void);
PAGE_EXPORT(elastic_energy) double page_elastic_energy(void);
PAGE_EXPORT(max_strain) double page_max_strain(void);
/// Half of the state's hash: the lower 32 bits, or the upper.
PAGE_EXPORT(hash) uint32_t page_hash(uint32_t upper);

/* tools.c: handling */

/// Take hold of what lies within radius of a point; returns how many particles that are.
PAGE_EXPORT(hold) uint32_t page_hold(double x, double y, double radius);
/// Where it is to go, from now on in every step.
PAGE_EXPORT(hold_to) void page_hold_to(double x, double y);
PAGE_EXPORT(let_go) void page_let_go(void);
/// Pin the particles within radius, or free them if the nearest is pinned.
PAGE_EXPORT(pin) mspring_result page_pin(double x, double y, double radius);
/// Break the springs that a line crosses.
PAGE_EXPORT(cut) mspring_result page_cut(double x, double y, double x2, double y2);
/// Push everything within radius away.
PAGE_EXPORT(blast) mspring_result page_blast(double x, double y, double radius, double speed);
PAGE_EXPORT(repair) mspring_result page_repair(void);
/// A floor at this height; below -1e11 none.
PAGE_EXPORT(floor) mspring_result page_set_floor(double height);
/// Whether bodies meet each other and themselves.
PAGE_EXPORT(collide) mspring_result page_set_collide(uint32_t on);

/* check.c: the same bits as elsewhere */

/// Step one of the scenes of check.c and leave its hash to page_check_hash(). Returns 0, or a mspring_result.
PAGE_EXPORT(check) mspring_result page_check(uint32_t scene, uint32_t steps, uint32_t level);
PAGE_EXPORT(check_hash) uint32_t page_check_hash(uint32_t upper);

#endif
