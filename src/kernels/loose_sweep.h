/// @file loose_sweep.h
/// Motion of particles without springs, in the vectors of sweep.h, which includes this.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LOOSE_SWEEP_H
#define MSPRINGI_LOOSE_SWEEP_H

// Several substeps at once: see mspringi_free_motion.
MSPRINGI_INLINE void glide_slots(const mspringi_sweep *s, const mspringi_span *span,
                                 const mspringi_free_motion *glide, bool forced, mspringi_variant of) {
    const vec keep = set(glide->keep), gain = set(glide->gain), reach = set(glide->reach), fall = set(glide->fall),
              drift = set(glide->drift);
    const size_t end = end_of(span);
    for (size_t slot = first_of(span); slot < end; slot += LANES) {
        const vec inverse_mass = load(s->inverse_mass + slot);
        vec change_x = set(glide->gravity_x), change_y = set(glide->gravity_y);
        vec way_x = set(glide->gravity_way_x), way_y = set(glide->gravity_way_y);
        if (forced) {
            const vec ax = mul(load(s->force_x + slot), inverse_mass),
                      ay = mul(load(s->force_y + slot), inverse_mass);
            change_x = add(mul(ax, gain), change_x);
            change_y = add(mul(ay, gain), change_y);
            way_x = add(mul(ax, fall), way_x);
            way_y = add(mul(ay, fall), way_y);
        }
        const motion m = load_motion(s, slot, of);
        add_displacement(s, slot, m, choose_positive(inverse_mass, add(mul(m.vx, reach), way_x), mul(m.vx, drift)),
                         choose_positive(inverse_mass, add(mul(m.vy, reach), way_y), mul(m.vy, drift)), of);
        store(s->vx + slot, choose_positive(inverse_mass, add(mul(m.vx, keep), change_x), m.vx));
        store(s->vy + slot, choose_positive(inverse_mass, add(mul(m.vy, keep), change_y), m.vy));
    }
}

MSPRINGI_INLINE void loose(const mspringi_sweep *s, const mspringi_span *span, const mspringi_free_motion *glide,
                           bool forced) {
    if (s->low_vx)
        glide_slots(s, span, glide, forced, MSPRINGI_DAMPED | MSPRINGI_PRECISE);
    else
        glide_slots(s, span, glide, forced, MSPRINGI_DAMPED);
}

#endif
