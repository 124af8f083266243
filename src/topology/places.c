/// Finding the patterns that springs lie in.
#include "places.h"

#include <string.h>

/// Springs that a run has at least, unless they are listed: with fewer, a list of them is no longer.
#define SHORTEST_RUN 16

static uint32_t slot_of(mspringi_place place) {
    return place / (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH) * MSPRINGI_WIDTH + place % MSPRINGI_WIDTH;
}

static uint32_t direction_of(mspringi_place place) {
    return place / MSPRINGI_WIDTH % MSPRINGI_DIRECTIONS;
}

// The spring behind those from first on whose places are equally spaced.
static mspring_id end_of_spaced(const mspringi_packing *p, mspring_id first, uint32_t step) {
    mspring_id s = first + 1;
    while (s < p->count && p->of_spring[s] - p->of_spring[s - 1] == step)
        ++s;
    return s;
}

// The spring behind those from first on that go on with the pattern of the first ones; first if there is none.
static mspring_id end_of_pattern(const mspringi_packing *p, mspring_id first, uint32_t period, uint32_t step) {
    const mspringi_place *of = p->of_spring;
    mspring_id s = first + period;
    while (s < p->count && of[s] < p->lattice_places && direction_of(of[s]) == direction_of(of[s - period]) &&
           slot_of(of[s]) - slot_of(of[s - period]) == step)
        ++s;
    for (uint32_t i = 0; i < period; ++i)
        if (of[first + i] >= p->lattice_places)
            return first;
    return s;
}

// Whether the last of so many springs that a run has at least may be in one with the first ones: most often not,
// and then nobody need look at those between.
static bool may_be_spaced(const mspringi_place *of, uint32_t step) {
    return of[SHORTEST_RUN - 1] - of[0] == (SHORTEST_RUN - 1) * step;
}

static bool may_be_pattern(const mspringi_place *of, uint32_t period, uint32_t step) {
    const uint32_t turns = (SHORTEST_RUN - 1) / period;
    return direction_of(of[turns * period]) == direction_of(of[0]) &&
           slot_of(of[turns * period]) - slot_of(of[0]) == turns * step;
}

// Find the kind of run that gets furthest from first on. Returns its end.
static mspring_id find_run(const mspringi_packing *p, mspring_id first, mspringi_place_run *run) {
    const mspringi_place *of = p->of_spring;
    const uint32_t left = p->count - first;
    mspring_id furthest = first;
    if (left < SHORTEST_RUN)
        return first;
    const uint32_t spacing = of[first + 1] - of[first];
    if (may_be_spaced(of + first, spacing))
        furthest = end_of_spaced(p, first, spacing);
    *run = (mspringi_place_run){
        .first = first, .kind = MSPRINGI_RUN_SPACED, .period = 1, .step = spacing, .start = {of[first]}};
    for (uint32_t period = 1; period <= MSPRINGI_DIRECTIONS; ++period) {
        const uint32_t step = slot_of(of[first + period]) - slot_of(of[first]);
        if (!may_be_pattern(of + first, period, step))
            continue;
        const mspring_id end = end_of_pattern(p, first, period, step);
        if (end <= furthest || end - first < 2 * period)
            continue;
        furthest = end;
        *run = (mspringi_place_run){
            .first = first, .kind = MSPRINGI_RUN_PATTERN, .period = (uint16_t)period, .step = step};
        for (uint32_t i = 0; i < period; ++i)
            run->start[i] = slot_of(of[first + i]) * MSPRINGI_DIRECTIONS + direction_of(of[first + i]);
    }
    return furthest;
}

static bool append_run(mspringi_packing *p, const mspringi_place_run *run) {
    void *runs = p->runs;
    const bool grown = mspringi_grow(p->memory, &runs, &p->run_capacity, p->run_count + 1, sizeof *p->runs);
    p->runs = runs;
    if (grown)
        p->runs[p->run_count++] = *run;
    return grown;
}

static bool append_listed(mspringi_packing *p, mspring_id spring, bool begins) {
    const mspringi_place_run run = {
        .first = spring, .kind = MSPRINGI_RUN_LISTED, .period = 1, .start = {(uint32_t)p->listed_count}};
    void *listed = p->listed;
    if (begins && !append_run(p, &run))
        return false;
    const bool grown =
        mspringi_grow(p->memory, &listed, &p->listed_capacity, p->listed_count + 1, sizeof *p->listed);
    p->listed = listed;
    if (grown)
        p->listed[p->listed_count++] = p->of_spring[spring];
    return grown;
}

// A run is found in one go, however long it is.
bool mspringi_places_pack(mspringi_packing *p, mspringi_pace *pace) {
    bool ok = true;
    mspring_id s = pace->at;
    while (ok && s < p->all && pace->left > 0) {
        mspringi_place_run run = {0};
        const mspring_id end = s < p->count ? find_run(p, s, &run) : s;
        const bool is_run = end - s >= SHORTEST_RUN;
        ok = is_run ? append_run(p, &run) : append_listed(p, s, !p->in_list || s == p->count);
        p->in_list = !is_run;
        s = is_run ? end : s + 1;
        mspringi_pace_spend(
            pace, is_run ? 16 + (run.kind == MSPRINGI_RUN_SPACED ? 1 : 4) * (uint64_t)(end - run.first) : 4);
    }
    pace->at = s;
    pace->is_halfway = s < p->all;
    return ok;
}

// Copy what has been packed to arrays that are as long as it.
static bool keep(const mspringi_packing *p, mspringi_places *to) {
    const uint32_t all = p->all;
    const uint32_t pages = (all + MSPRINGI_PLACES_PAGE - 1) / MSPRINGI_PLACES_PAGE;
    to->runs = mspringi_alloc(p->memory, p->run_count + 1, sizeof *to->runs);
    to->listed = mspringi_alloc(p->memory, p->listed_count, sizeof *to->listed);
    to->run_of_page = mspringi_alloc(p->memory, pages, sizeof *to->run_of_page);
    if (!to->runs || !to->listed || !to->run_of_page)
        return false;
    to->run_count = (uint32_t)p->run_count;
    if (p->run_count > 0)
        memcpy(to->runs, p->runs, p->run_count * sizeof *to->runs);
    if (p->listed_count > 0)
        memcpy(to->listed, p->listed, p->listed_count * sizeof *to->listed);
    to->runs[p->run_count].first = all;
    for (uint32_t page = 0, run = 0; page < pages; ++page) {
        while (page * MSPRINGI_PLACES_PAGE >= to->runs[run + 1].first)
            ++run;
        to->run_of_page[page] = run;
    }
    return true;
}

bool mspringi_places_keep(mspringi_packing *p, mspringi_places *places) {
    mspringi_places made = {0};
    const bool ok = keep(p, &made);
    mspringi_packing_destroy(p);
    if (ok)
        *places = made;
    else
        mspringi_places_destroy(&made, p->memory);
    return ok;
}

void mspringi_packing_destroy(mspringi_packing *p) {
    mspringi_free(p->memory, p->runs);
    mspringi_free(p->memory, p->listed);
    p->runs = NULL;
    p->listed = NULL;
}

bool mspringi_places_create(mspringi_places *places, const mspringi_place *of_spring, uint32_t count,
                            uint32_t fixed, mspringi_place lattice_places, mspringi_memory *memory) {
    mspringi_packing p = {
        .of_spring = of_spring, .count = fixed, .all = count, .lattice_places = lattice_places, .memory = memory};
    mspringi_pace pace = {0};
    bool ok;
    do {
        pace.left = MSPRINGI_PACE_ALL;
        ok = mspringi_places_pack(&p, &pace);
    } while (ok && pace.is_halfway);
    if (!ok)
        mspringi_packing_destroy(&p);
    return ok && mspringi_places_keep(&p, places);
}

void mspringi_places_destroy(mspringi_places *places, mspringi_memory *memory) {
    mspringi_free(memory, places->runs);
    mspringi_free(memory, places->run_of_page);
    mspringi_free(memory, places->listed);
    *places = (mspringi_places){0};
}

void mspringi_places_set(const mspringi_places *places, mspring_id spring, mspringi_place place) {
    const mspringi_place_run *run = &places->runs[places->run_count - 1];
    MSPRINGI_ASSERT(run->kind == MSPRINGI_RUN_LISTED && spring >= run->first);
    places->listed[run->start[0] + (spring - run->first)] = place;
}

// Those of a run's springs first ... first + count - 1, counted from its own first.
static void read_run(const mspringi_places *places, const mspringi_place_run *run, uint32_t first, uint32_t count,
                     mspringi_place *out) {
    if (run->kind == MSPRINGI_RUN_LISTED) {
        for (uint32_t i = 0; i < count; ++i)
            out[i] = places->listed[run->start[0] + first + i];
        return;
    }
    if (run->kind == MSPRINGI_RUN_SPACED) {
        for (uint32_t i = 0; i < count; ++i)
            out[i] = run->start[0] + (first + i) * run->step;
        return;
    }
    uint32_t turn = mspringi_turn_of(first, run->period), member = first - turn * run->period;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t code = run->start[member];
        out[i] = mspringi_lattice_place(code / MSPRINGI_DIRECTIONS + turn * run->step, code % MSPRINGI_DIRECTIONS);
        member = member + 1 < run->period ? member + 1 : 0;
        turn += member == 0;
    }
}

void mspringi_places_read(const mspringi_places *places, mspring_id first, uint32_t count, mspringi_place *out) {
    if (count == 0)
        return;
    const mspringi_place_run *run = &places->runs[places->run_of_page[first / MSPRINGI_PLACES_PAGE]];
    while (first >= run[1].first)
        ++run;
    for (uint32_t done = 0; done < count; ++run) {
        const uint32_t i = first + done - run->first, here = run[1].first - run->first - i;
        const uint32_t now = here < count - done ? here : count - done;
        read_run(places, run, i, now, out + done);
        done += now;
    }
}

void mspringi_places_refill(mspringi_place_reader *reader) {
    const uint32_t room = sizeof reader->buffer / sizeof reader->buffer[0];
    const uint32_t left = reader->places->runs[reader->places->run_count].first - reader->next;
    reader->at = 0;
    reader->filled = left < room ? left : room;
    mspringi_places_read(reader->places, reader->next, reader->filled, reader->buffer);
    reader->next += reader->filled;
}
