/// @file books.c
/// Bookkeeping.
///
/// SPDX-License-Identifier: MIT
#include "game/books.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static account account_of(const mspring_network *network) {
    mspring_energy energy = mspring_energy_default();
    mspring_body all = mspring_body_default();
    if (mspring_network_get_energy(network, &energy) != MSPRING_OK ||
        mspring_network_get_body(network, NULL, 0, MSPRING_ALL, &all) != MSPRING_OK)
        abort(); // only NULL is refused
    return (account){.momentum = {all.px, all.py},
                     .angular_momentum = all.angular,
                     .energy = energy.kinetic + energy.elastic + energy.potential};
}

void books_open(books *opened, const mspring_network *network) {
    *opened = (books){.last = account_of(network)};
}

void books_edit(books *of, const mspring_network *network) {
    const account now = account_of(network);
    const double given = now.energy - of->last.energy;
    of->edits += given;
    of->energy_through += fabs(given);
    of->last = now;
}

void books_enter(books *of, const mspring_network *network, const books_step *step) {
    const account now = account_of(network);
    double impulse[2] = {0, 0}, work = 0;
    for (uint32_t i = 0; i < step->particles; i++) {
        const double x = step->force_x[i] * step->dt + (double)step->impulse_x[i];
        const double y =
            (step->force_y[i] + (double)step->mass[i] * step->gravity) * step->dt + (double)step->impulse_y[i];
        impulse[0] += x;
        impulse[1] += y;
        of->through[0] += fabs(x);
        of->through[1] += fabs(y);
        work +=
            step->force_x[i] * (step->after_x[i] - step->x[i]) + step->force_y[i] * (step->after_y[i] - step->y[i]);
    }
    for (int i = 0; i < 2; i++)
        of->missing[i] += now.momentum[i] - of->last.momentum[i] - impulse[i];
    const double lost = work - (now.energy - of->last.energy);
    of->outside += work;
    of->energy_through += fabs(work);
    if (step->ramps)
        of->ramps -= lost;
    else
        of->heat += lost;
    of->most_heat = fmax(of->most_heat, of->heat);
    of->largest_loss = fmax(of->largest_loss, of->most_heat - of->heat);
    of->last = now;
}

bool books_close(const books *of, double share) {
    const double missing_x = fabs(of->missing[0]), missing_y = fabs(of->missing[1]);
    printf("momentum: %.3g and %.3g kg m/s went through in x and y; %.2g and %.2g are missing\n", of->through[0],
           of->through[1], missing_x, missing_y);
    printf("energy:   water, wind and drag gave %.4g J, blasts, bailing and leaks %.4g J, springs that were drawn "
           "together %.4g J;\n          %.4g J went into heat, of which at most %.2g J ever came back\n",
           of->outside, of->edits, of->ramps, of->heat, of->largest_loss);
    const bool closes = missing_x <= share * of->through[0] && missing_y <= share * of->through[1];
    const bool only_heats = of->heat > 0 && of->largest_loss <= share * of->energy_through;
    if (!closes)
        fprintf(stderr, "the books of momentum do not close to %g\n", share);
    if (!only_heats)
        fprintf(stderr, "the books of energy do not close to %g of %.4g J\n", share, of->energy_through);
    return closes && only_heats;
}
