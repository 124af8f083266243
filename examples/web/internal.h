/// @file internal.h
/// The page's network, which its parts share.
///
/// SPDX-License-Identifier: MIT
#ifndef PAGE_INTERNAL_H
#define PAGE_INTERNAL_H

#include "page.h"

typedef struct page_state {
    mspring_network *network;
    mspring_view view;
    page_spring *springs;  ///< [spring_count]
    mspring_id *ends;      ///< [spring_count][2] particles
    float *values;         ///< [spring_count] scratch
    float *base_stiffness; ///< [spring_count] as the materials give it
    float *break_strain;   ///< [spring_count] likewise
    float *rest_length;    ///< [spring_count] as made
    float *plastic;        ///< [spring_count] how much of that has changed for good
    float yield_strain;    ///< least of the materials; 0: none yields
    bool yields;           ///< springs have yielded, or may
    uint32_t bent_count;
    mspring_id *list;      ///< [spring_count or particles] scratch
    mspring_event *events; ///< [event_capacity]
    uint32_t particle_count, spring_count, list_capacity, changes;
    // What is held, and where it is to go.
    mspring_id *held;
    float *held_mass;         ///< [particle_count]
    float *force_x, *force_y; ///< [particle_count] scratch
    uint32_t held_count;
    double hold_x, hold_y, hold_mass, total_mass;
} page_state;

extern page_state page;

/// Memory of the page, zeroed; NULL if there is none.
void *page_take(size_t size);
void page_leave(void *memory, size_t size);
/// Pass the result of a call on the network on, and keep its message for page_error().
mspring_result page_done(mspring_result result);
/// Read plastic strains again, and rest lengths after them.
void page_find_bent(void);
/// Rest length in force of a spring that is whole.
float page_rest_length(uint32_t spring);
/// Add the forces of what is held, for the next step.
void page_pull(double dt);

#endif
