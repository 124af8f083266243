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
        const vec gravity_x = set(glide->gravity_x), gravity_y = set(glide->gravity_y);
        vec push_x = zero(), push_y = zero();
        vec way_x = set(glide->gravity_way_x), way_y = set(glide->gravity_way_y);
        if (forced) {
            const vec ax = mul(load(s->force_x + slot), inverse_mass),
                      ay = mul(load(s->force_y + slot), inverse_mass);
            push_x = mul(ax, gain);
            push_y = mul(ay, gain);
            way_x = add(mul(ax, fall), way_x);
            way_y = add(mul(ay, fall), way_y);
        }
        const motion m = load_motion(s, slot, of);
        add_displacement(s, slot, m, choose_positive(inverse_mass, add(mul(m.vx, reach), way_x), mul(m.vx, drift)),
                         choose_positive(inverse_mass, add(mul(m.vy, reach), way_y), mul(m.vy, drift)), of);
        vec vx, vy;
        if (of & MSPRINGI_PRECISE) {
            vec low_vx = load(s->low_vx + slot), low_vy = load(s->low_vy + slot);
            vx = kicked_precisely(m.vx, &low_vx, push_x, gravity_x, glide->loss, false, inverse_mass);
            vy = kicked_precisely(m.vy, &low_vy, push_y, gravity_y, glide->loss, false, inverse_mass);
            store(s->low_vx + slot, low_vx);
            store(s->low_vy + slot, low_vy);
        } else {
            const vec change_x = forced ? add(push_x, gravity_x) : gravity_x;
            const vec change_y = forced ? add(push_y, gravity_y) : gravity_y;
            vx = choose_positive(inverse_mass, add(mul(m.vx, keep), change_x), m.vx);
            vy = choose_positive(inverse_mass, add(mul(m.vy, keep), change_y), m.vy);
        }
        store(s->vx + slot, vx);
        store(s->vy + slot, vy);
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
