/// @file energy.h
/// The balance of energy of implicit substeps.
///
/// A substep linearises every spring once. What lies across its direction is stiff only as far as the spring is
/// tense, so a slack or untensed rope moves sideways as if there were no springs; and one that is stiff is then
/// stretched by more than anything has done work for. So what a substep would make of kinetic and elastic energy is
/// summed before it lands, and compared with the work of gravity, of forces from outside, of moving pins and of the
/// floor. What cannot be explained so is added up, twice:
///
/// - gained: what is lost is taken off, but never below nothing. If it comes to more than a hundredth of the motion
///   that there is, the substep is not taken, but again with more iterations and, if that does not help, in pieces
///   by implicit Euler, as small as they have to be, and some of the following substeps by implicit Euler, too.
/// - balance: what is lost is taken off down to less all of the motion. So methods of second order may take energy
///   and give it back (of an oscillator's GA0 does 0.1 %), as long as it is never more than there was when the
///   motion began. Where it is, the surplus is taken out of the motion when the substep has landed (excess.c).
///
/// In lattices springs hold each other's direction, and energy comes up only where conjugate gradients end too
/// early, or tiles are turned too far: never with the direct solver, which is not looked at where the network is a
/// lattice, with all its springs. What may come up then goes with how far the solution lowers the energy of what is
/// linearised, at next to no cost. As long as that, and what ropes and other springs outside of lattices get, with
/// particles that have no others, is less than 0.4 % of the motion, and less than the balance has left, nothing
/// else is looked at.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ENERGY_H
#define MSPRINGI_ENERGY_H

#include "network/network.h"

/// What is known of the energy from substep to substep, J.
typedef struct mspringi_ledger {
    double gained;  ///< what has come from nowhere, less what was lost since
    double balance; ///< all that came and went since the motion began, as if never more than motion was lost
    double motion;  ///< most kinetic and elastic energy that there was, fading
    double risen;   ///< what may have come since all energy was looked at
    uint32_t look;  ///< substeps in which all is looked at, whatever they get
    uint32_t calm;  ///< substeps to come that are taken by implicit Euler
    uint32_t more;  ///< substeps to come that are taken with more iterations
} mspringi_ledger;

/// What refuses a step.
typedef struct mspringi_gain {
    double energy, motion; ///< gain and what is known of motion, J; energy 0: there was none
    mspringi_place place;  ///< of the spring that would have most; MSPRING_NONE: all are broken
} mspringi_gain;

/// Sums over what hangs together: its mass, 0 where it is held, and its momentum.
#define MSPRINGI_BODY_SUMS 3

/// What is summed to know it.
typedef struct mspringi_balance {
    double *chunks;                       ///< [chunks][MSPRINGI_MOVE_SUMS]
    double *panels;                       ///< [panels][MSPRINGI_STRETCH_SUMS]
    double (*bodies)[MSPRINGI_BODY_SUMS]; ///< [slots / 2] of what hangs together
    uint32_t *body;                       ///< [slots]
    double surplus;                       ///< what is to be taken out of the motion when the substep has landed, J
    double rounding;                      ///< of it
    uint32_t movable;                     ///< particles with springs
    uint32_t dead;                        ///< lattice springs that are broken
    bool is_dead_known;
    bool looks; ///< the present substep is looked at as a whole
    bool fails; ///< it gains too much
} mspringi_balance;

/// Pieces of a substep at most, substeps of implicit Euler after one in pieces, and those in which all is looked
/// at.
#define MSPRINGI_MOST_PIECES 64u
#define MSPRINGI_CALM_SUBSTEPS 15u
#define MSPRINGI_LOOKS 15u

/// Times the iterations, and substeps, that follow one whose iterations ended too early.
#define MSPRINGI_MORE_ITERATIONS 4u
#define MSPRINGI_MORE_SUBSTEPS 3u

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

/// Take what has come from nowhere out of the motion of a substep that has landed.
void mspringi_energy_settle(const struct mspringi_substep_of *substep);

/// Refuse the step that is being taken: its last substep gains too much, in the smallest of pieces.
void mspringi_energy_give_up(const struct mspringi_substep_of *substep);

/// Fail if the present step was refused.
mspring_result mspringi_energy_verdict(mspring_network *network, double dt);

#endif
