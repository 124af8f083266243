/// @file bundle_sweep.h
/// Sweep of bundles: the forces of irregular(), each computed once, and summed in the same order. Included by
/// sweep.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BUNDLE_SWEEP_H
#define MSPRINGI_BUNDLE_SWEEP_H

/// Springs of a bundle's slice that are computed together.
#define BUNDLE_BATCH 2

// Forces of a bundle before they are summed: LANES values for each slice column, in order.
typedef struct pulls {
    float *x, *y;
    size_t first; ///< first slice column
} pulls;

// Compute the forces of `count` springs from a bundle's slice to slices below, for both slice columns. All roots
// and divisions precede the forces, so that more of them overlap than a reorder window would hold.
MSPRINGI_INLINE void pull_bundle(const mspringi_sweep *s, size_t slot, motion here,
                                 const mspringi_bundle_link *links, size_t count, pulls to, mspringi_variant of) {
    const size_t stride = (size_t)(of & MSPRINGI_DAMPED ? 3 : 2) * MSPRINGI_WIDTH;
    motion below[BUNDLE_BATCH];
    extent between[BUNDLE_BATCH];
    vec inverse[BUNDLE_BATCH];
    for (size_t i = 0; i < count; ++i) {
        below[i] = load_motion(s, slot + links[i].below, of);
        between[i] = spring_extent(below[i], here, of);
    }
    for (size_t i = 0; i < count; ++i)
        inverse[i] = inverse_or_zero(between[i].square);
    for (size_t i = 0; i < count; ++i) {
        const float *record = s->irregular_springs + links[i].slice_column * stride + slot % MSPRINGI_WIDTH;
        const size_t slice_column = (links[i].slice_column - to.first) * LANES,
                     back = (links[i].back - to.first) * LANES;
        const vector pull =
            spring_force(between[i], inverse[i], below[i], here, record + MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH,
                         record + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH, of);
        store(to.x + slice_column, pull.x);
        store(to.y + slice_column, pull.y);
        store(to.x + back, sub(zero(), pull.x));
        store(to.y + back, sub(zero(), pull.y));
    }
}

// Compute the springs of a slice to slices below, and move it: its other springs are done.
MSPRINGI_INLINE void sweep_slice(const mspringi_sweep *s, size_t slice, size_t slot, pulls to,
                                 mspringi_variant of) {
    const motion here = load_motion(s, slot, of);
    const uint32_t *first_link = s->irregular->first_link + (slice - s->irregular->first_bundle);
    const mspringi_bundle_link *links = s->irregular->links + first_link[0];
    size_t left = first_link[1] - first_link[0];
    for (; !(of & MSPRINGI_PRECISE) && left >= BUNDLE_BATCH; left -= BUNDLE_BATCH, links += BUNDLE_BATCH)
        pull_bundle(s, slot, here, links, BUNDLE_BATCH, to, of);
    for (; left > 0; --left, ++links)
        pull_bundle(s, slot, here, links, 1, to, of);
    vector force = {zero(), zero()};
    const size_t end = (s->irregular->first_slice_column[slice + 1] - to.first) * LANES;
    for (size_t slice_column = (s->irregular->first_slice_column[slice] - to.first) * LANES; slice_column < end;
         slice_column += LANES) {
        force.x = add(force.x, load(to.x + slice_column));
        force.y = add(force.y, load(to.y + slice_column));
    }
    move_apart(s, slot, here, force, of);
}

MSPRINGI_INLINE void bundle(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count,
                            mspringi_variant of) {
    mspringi_sweep copy = *sweep;
    copy.keep = NULL; // bundles save and measure their state separately
    copy.watch = NULL;
    const mspringi_sweep *const s = &copy;
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const pulls to = {s->carry_x, s->carry_y, s->irregular->first_slice_column[span->first_record]};
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES) {
            size_t slice = span->first_record;
            for (size_t slot = span->first_slot + lane; slot < end_of(span); slot += MSPRINGI_WIDTH)
                sweep_slice(s, slice++, slot, to, of);
        }
    }
}

#endif
