/// @file plain.h
/// Changes of the plain list beside a network.
///
/// SPDX-License-Identifier: MIT
#ifndef HOSTS_PLAIN_H
#define HOSTS_PLAIN_H

#include "game.h"

void plain_break(plain *list, mspring_id spring);
void plain_detach(plain *list, mspring_id particle);
void plain_remove_spring(plain *list, mspring_id spring);
void plain_remove_particle(plain *list, mspring_id particle);
/// Add what the library has added: under an id that nothing has.
void plain_add_particle(game *it, plain *list, mspring_id particle, float mass);
void plain_add_spring(game *it, plain *list, mspring_id spring, const mspring_spring_def *def);
/// Take over which springs are broken, after a call that may restore any.
void plain_learn_restored(game *it, place *p);

#endif
