/// Stage of contact between bodies: when to scan.
///
/// before_step scans. An explicit substep that is not quiet is solved in after_substep; an implicit one has contact
/// in its linear system (solvers/implicit/implicit_contact.c), and only scans there. after_step queues events.
///
/// Quiet steps and substeps, in which nothing can touch, take the path without contact. The speeds at the last scan
/// bound their number. If forces made points so fast that some could have touched, the step is repeated with a scan
/// after every substep.
#include "features/contact/contacts.h"

#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "store/sleepers.h"
#include "store/stages.h"

static bool is_used(const mspring_network *network) {
    return network->contacts != NULL;
}

// A collider moves even where all bodies sleep.
static bool moves(const mspring_network *network) {
    const mspringi_colliders *c = &network->contacts->colliders;
    for (uint32_t i = 0; i < c->count; ++i)
        if (c->list[i].is_moving)
            return true;
    return false;
}

/* ------------------------------------------------------------------------------------------------------ stage */

static void clear_touch(mspringi_contacts *contacts) {
    const uint32_t now = contacts->touch_now;
    if (contacts->has_touch[now])
        memset(contacts->touch + (size_t)now * contacts->particles, 0,
               contacts->particles * sizeof *contacts->touch);
    contacts->has_touch[now] = false;
}

// Sleepers keep what they were given when they were last awake. Particles fall asleep after this stage, so that
// those that sleep now did so in the whole step.
static void keep_touch(const mspring_network *network, mspringi_contacts *contacts) {
    const size_t last = 1 - contacts->touch_now;
    float *const now = contacts->touch + (size_t)contacts->touch_now * contacts->particles;
    for (mspring_id p = 0; p < network->topology.particle_count; ++p)
        if (mspringi_particle_exists(network, p) &&
            mspringi_slot_is_asleep(network, network->topology.slot_of_particle[p]))
            now[p] = contacts->touch[last * contacts->particles + p];
    contacts->has_touch[contacts->touch_now] = true;
}

// Begin the substeps of an attempt, or their repetition. Return true if all pairs have room.
static bool begin_substeps(mspring_network *network, uint32_t substeps) {
    mspringi_contacts *contacts = network->contacts;
    contacts->is_missed = false;
    contacts->rejection = MSPRINGI_CONTACT_SOUND;
    contacts->substeps_done = contacts->touching = 0;
    contacts->substeps_since_scan = contacts->solved_substeps = 0;
    contacts->deepest = 0.0;
    clear_touch(contacts);
    contacts->work = 0; // in repetitions, too: their number depends on the workers
    contacts->most_work = MSPRINGI_MOST_COMPARISONS;
    mspringi_colliders_begin(network, contacts, substeps);
    return mspringi_pair_list_scan(network, contacts, 0);
}

static void clear_extra_speeds(mspringi_contacts *contacts) {
    if (contacts->has_extra_speed)
        memset(contacts->extra_speed, 0,
               (contacts->particles + (size_t)contacts->colliders.point_capacity) * sizeof *contacts->extra_speed);
    contacts->has_extra_speed = false;
}

static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_contacts *contacts = network->contacts;
    mspringi_outline_update(network, contacts);
    contacts->h = attempt->h;
    contacts->dt = attempt->dt;
    contacts->is_second_try = false;
    clear_extra_speeds(contacts);
    contacts->has_sleepers = network->sleep.sleeping > 0;
    if (begin_substeps(network, attempt->substeps))
        mspringi_piles_wake(network, contacts);
    mspringi_contact_events_begin(network, contacts);
}

static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    return network->contacts->quiet_substeps >= attempt->substeps;
}

static uint32_t free_substeps(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    const uint32_t quiet = network->contacts->quiet_substeps, left = attempt->substeps - substep;
    return quiet == 0 ? 1 : quiet < left ? quiet : left;
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    mspringi_contacts *contacts = network->contacts;
    (void)attempt;
    contacts->first_substep = substep;
    if (contacts->quiet_substeps == 0) {
        mspringi_colliders_move_points(network, contacts, substep);
        mspringi_contact_begin_substep(network, contacts);
    }
    return base;
}

static void rescan(mspring_network *network, mspringi_contacts *contacts) {
    contacts->is_fresh = false;
    (void)mspringi_pair_list_scan(network, contacts, 0);
}

// Scan after `count` quiet substeps. They were missed if some pair could have touched at the speeds of now.
static void check_quiet_substeps(mspring_network *network, mspringi_contacts *contacts, uint32_t count) {
    contacts->is_fresh = false;
    (void)mspringi_pair_list_scan(network, contacts, count);
    contacts->is_missed |= contacts->nearest < contacts->thickness;
}

static void after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    mspringi_contacts *contacts = network->contacts;
    const uint32_t count = substep + 1 - contacts->first_substep;
    contacts->substeps_done += count;
    MSPRINGI_ASSERT(contacts->substeps_done <= attempt->substeps);
    if (mspringi_contact_is_rejected(contacts))
        return;
    contacts->is_fresh = false;
    if (contacts->quiet_substeps > 0) {
        contacts->quiet_substeps = contacts->quiet_substeps > count ? contacts->quiet_substeps - count : 0;
        contacts->substeps_since_scan += count;
        if (contacts->quiet_substeps == 0 && contacts->substeps_done < attempt->substeps) {
            check_quiet_substeps(network, contacts, contacts->substeps_since_scan);
            contacts->substeps_since_scan = 0;
        }
        return;
    }
    contacts->solved_substeps += count;
    if (network->running->ops->has_implicit_contact || !mspringi_contact_solve_substep(network, contacts) ||
        contacts->is_second_try)
        rescan(network, contacts);
    else if (--contacts->substeps_to_refresh == 0 &&
             contacts->substeps_done < attempt->substeps) // a step begins with a scan
        (void)mspringi_pair_list_refresh(network, contacts, 0);
}

// Check the substeps since the last scan. If substeps_done is 0, all were taken at once, without after_substep().
static bool must_repeat(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_contacts *contacts = network->contacts;
    const uint32_t count = contacts->substeps_done == 0 ? attempt->substeps : contacts->substeps_since_scan;
    contacts->substeps_done = attempt->substeps;
    if (count > 0 && !mspringi_contact_is_rejected(contacts))
        check_quiet_substeps(network, contacts, count);
    else if (contacts->solved_substeps > 0 && !mspringi_contact_is_rejected(contacts))
        mspringi_pair_list_check_speeds(network, contacts);
    if (!contacts->is_missed || contacts->is_second_try || mspringi_contact_is_rejected(contacts))
        return false;
    contacts->is_second_try = true;
    return true;
}

// Particle with the most edges of the outline.
static mspring_id hub_of(const mspringi_contacts *contacts, uint32_t *edges) {
    const uint32_t *first = contacts->outline.first;
    mspring_id hub = 0;
    for (mspring_id p = 1; p < contacts->particles; ++p)
        hub = first[p + 1] - first[p] > first[hub + 1] - first[hub] ? p : hub;
    *edges = first[hub + 1] - first[hub];
    return hub;
}

static mspring_result report_work(mspring_network *network) {
    const mspringi_contacts *contacts = network->contacts;
    uint32_t edges;
    const mspring_id hub = hub_of(contacts, &edges);
    network->outcome.particle = hub;
    return mspringi_fail(&network->message, MSPRING_ERROR_LIMIT,
                         "over %.3g comparisons of outline points and edges in a step, or impulses that "
                         "take as long, as many of %u edges are near many points, or at one particle (%u at "
                         "particle %u): set contact with less thickness, take a shorter dt, or divide long springs",
                         (double)contacts->most_work, (unsigned)contacts->outline.edge_count, (unsigned)edges,
                         (unsigned)hub);
}

static mspring_result verify(mspring_network *network) {
    const mspringi_contacts *contacts = network->contacts;
    const bool lacks_pairs = contacts->rejection == MSPRINGI_CONTACT_LACKS_PAIRS;
    if (contacts->rejection == MSPRINGI_CONTACT_SOUND)
        return MSPRING_OK;
    if (contacts->rejection == MSPRINGI_CONTACT_LACKS_WORK)
        return report_work(network);
    return mspringi_fail(&network->message, MSPRING_ERROR_LIMIT,
                         "more than %u pairs of an outline point and an outline edge %s each other: set "
                         "contact with a larger max_capacity, or less thickness",
                         (unsigned)(lacks_pairs ? contacts->capacity : contacts->constraint_capacity),
                         lacks_pairs ? "are near" : "may touch");
}

// Begin anew: the state is that before the step. A step that is repeated for any stage does not call before_step()
// again, so it begins here, even after a rejection: what made another stage fail may have led to that.
static void roll_back(mspring_network *network) {
    mspringi_contacts *contacts = network->contacts;
    contacts->is_fresh = false;
    mspringi_contact_events_discard_step(contacts);
    if (network->is_to_repeat || !mspringi_contact_is_rejected(contacts)) // else the next step scans
        (void)begin_substeps(network, contacts->colliders.substeps);
}

static void after_step(mspring_network *network, double dt) {
    mspringi_contacts *contacts = network->contacts;
    (void)dt;
    contacts->is_fresh &= !(network->outcome.flags & MSPRING_STEP_PUT_BACK) && !contacts->is_second_try;
    contacts->reported_pairs = contacts->count;
    mspringi_colliders_move_points(network, contacts, contacts->colliders.substeps);
    mspringi_piles_share_stillness(network, contacts);
    if (network->sleep.sleeping > 0 && contacts->has_touch[1 - contacts->touch_now])
        keep_touch(network, contacts);
    contacts->touch_now = 1 - contacts->touch_now;
    mspringi_contact_events_finish_step(network, contacts);
    mspringi_colliders_finish_step(network, contacts);
}

const mspringi_stage mspringi_stage_contacts = {.is_used = is_used,
                                                .moves = moves,
                                                .writes_state = true,
                                                .before_step = before_step,
                                                .is_quiet = is_quiet,
                                                .free_substeps = free_substeps,
                                                .before_substep = before_substep,
                                                .after_substep = after_substep,
                                                .must_repeat = must_repeat,
                                                .verify = verify,
                                                .roll_back = roll_back,
                                                .after_step = after_step};
