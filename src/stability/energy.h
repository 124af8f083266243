/// @file energy.h
/// The balance of energy of implicit substeps.
///
/// A substep linearises every spring once. What lies across its direction is stiff only as far as the spring is
/// tense, so a slack or untensed rope moves sideways as if there were no springs; and one that is stiff is then
/// stretched by more than anything has done work for. So what a substep would make of kinetic and elastic energy is
/// summed before it lands, and compared with the work of gravity, of forces from outside, of moving pins and of the
/// floor. What cannot be explained so is added up; what is lost is taken off that, but never below nothing. If the
/// sum comes to more than a hundredth of the motion that there is, the substep is not taken, but pieces of it by
/// implicit Euler, as small as they have to be, and some of the following substeps by implicit Euler, too.
///
/// (Methods of second order have a right to some of that hundredth: of an oscillator's energy GA0 takes and gives
/// back 0.1 %.)
///
/// In lattices springs hold each other's direction, which lets no energy come up. A network that is a lattice, with
/// all its springs, is not looked at; one with ropes or other springs besides, as long as these springs, and the
/// particles that have no others, get less than 0.4 % of the motion, is not looked at but for them.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ENERGY_H
#define MSPRINGI_ENERGY_H

#include "network/network.h"

/// What is known of the energy from substep to substep, J.
typedef struct mspringi_ledger {
    double gained; ///< what has come from nowhere, less what was lost since
    double motion; ///< most kinetic and elastic energy that there was, fading
    double risen;  ///< what springs and particles outside of lattices got since all energy was looked at
    uint32_t look; ///< substeps in which all is looked at, whatever they get
    uint32_t calm; ///< substeps to come that are taken by implicit Euler
} mspringi_ledger;

/// What refuses a step.
typedef struct mspringi_gain {
    double energy, motion; ///< gain and what is known of motion, J; energy 0: there was none
    mspringi_place place;  ///< of the spring outside of lattices, or anywhere, that would have most
} mspringi_gain;

/// What is summed to know it.
typedef struct mspringi_balance {
    double *chunks;   ///< [chunks][MSPRINGI_MOVE_SUMS]
    double *panels;   ///< [panels][MSPRINGI_STRETCH_SUMS]
    uint32_t movable; ///< particles with springs
    uint32_t dead;    ///< lattice springs that are broken
    bool is_dead_known;
    bool looks; ///< the present substep is looked at as a whole
    bool fails; ///< it gains too much
} mspringi_balance;

/// Pieces of a substep at most, substeps of implicit Euler after one in pieces, and those in which all is looked
/// at.
#define MSPRINGI_MOST_PIECES 64u
#define MSPRINGI_CALM_SUBSTEPS 15u
#define MSPRINGI_LOOKS 15u

struct mspringi_substep_of;
struct mspringi_mate;

/// Allocate what the implicit solver needs for it.
mspring_result mspringi_balance_create(mspringi_balance *balance, const mspring_network *network, uint32_t panels,
                                       mspringi_memory *memory, mspringi_message *message);
/// Count the particles with springs, when the solver knows which they are.
struct mspringi_implicit;
void mspringi_balance_count(const mspring_network *network, struct mspringi_implicit *implicit);
void mspringi_balance_destroy(mspringi_balance *balance, mspringi_memory *memory);

/// Whether there is anything to look at in the coming substeps.
bool mspringi_energy_is_watched(const mspring_network *network);

/// Look at what the substep is about to make of the network, by all workers: the state is that of before, d is
/// displacement + alpha direction. Returns whether it may land.
bool mspringi_energy_look(const struct mspringi_substep_of *substep, struct mspringi_mate *mate, float alpha);

/// Refuse the step that is being taken: its last substep gains too much, in the smallest of pieces.
void mspringi_energy_give_up(const struct mspringi_substep_of *substep);

/// Fail if the present step was refused.
mspring_result mspringi_energy_verdict(mspring_network *network, double dt);

#endif
