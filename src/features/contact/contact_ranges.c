/// Ranges of points, pairs and constraints for the workers.
///
/// The results of a range do not depend on the others, and are joined in their order. So bits are those of one
/// worker. Each worker takes several ranges, as some take longer than others.
#include <string.h>

#include "features/contact/contacts.h"
#include "tasks/tasks.h"

/// Ranges of a share, and most shares: each has scratch.
#define RANGES_OF_SHARE 4u
#define MOST_SHARES (MSPRINGI_CONTACT_RANGES / RANGES_OF_SHARE)

// Scratch of a share: stamps, then found edges.
static size_t scratch_size(const mspringi_contacts *contacts) {
    return contacts->particles + contacts->edge_capacity + 1;
}

bool mspringi_contact_reserve_ranges(mspring_network *network, mspringi_contacts *made) {
    const uint32_t workers = mspringi_tasks_workers(network->tasks);
    made->most_shares = workers < MOST_SHARES ? workers : MOST_SHARES;
    mspringi_free(&network->memory, made->of_shares);
    made->of_shares = NULL;
    if (made->most_shares == 1)
        return true;
    made->of_shares =
        mspringi_alloc(&network->memory, (made->most_shares - 1) * scratch_size(made), sizeof *made->of_shares);
    return made->of_shares != NULL;
}

void mspringi_contact_clear_stamps(mspringi_contacts *contacts) {
    memset(contacts->stamp, 0, contacts->particles * sizeof *contacts->stamp);
    for (uint32_t i = 0; i + 1 < contacts->most_shares; ++i)
        memset(contacts->of_shares + i * scratch_size(contacts), 0,
               contacts->particles * sizeof *contacts->of_shares);
}

#if defined(MSPRINGI_THREADS)

/// Work in ranges, and what it adds to the contact.
typedef struct division {
    const mspring_network *network;
    const mspringi_contacts *contacts;
    mspringi_contact_range_fn fn;
    const void *argument;
    mspringi_contact_range *ranges;
    uint32_t shares, count; ///< of workers; ranges
    struct {
        uint64_t work;
        double fastest;
        bool has_push, is_rejected;
    } ends[MSPRINGI_CONTACT_RANGES];
} division;

static void take_range(division *all, uint32_t number, uint32_t share) {
    mspringi_contacts own = *all->contacts;
    own.stamp_of = MSPRING_NONE;
    if (share > 0) {
        own.stamp = own.of_shares + (share - 1) * scratch_size(&own);
        own.grid.found = own.stamp + own.particles;
    }
    all->fn(all->network, &own, &all->ranges[number], all->argument);
    all->ends[number].work = own.work - all->contacts->work;
    all->ends[number].fastest = own.fastest;
    all->ends[number].has_push = own.has_push;
    all->ends[number].is_rejected = mspringi_contact_is_rejected(&own);
}

static void take_ranges(void *argument, uint32_t share, uint32_t worker) {
    division *all = argument;
    (void)worker;
    for (uint32_t i = share; i < all->count; i += all->shares)
        take_range(all, i, share);
}

// Join what the ranges add to the contact. Return false if one worker would, or may, have rejected the step.
static bool join(mspringi_contacts *contacts, const division *all, uint32_t room) {
    uint64_t work = contacts->work, found = 0;
    bool is_sound = true;
    for (uint32_t i = 0; i < all->count; ++i) {
        work += all->ends[i].work;
        found += all->ranges[i].found;
        is_sound &= !all->ends[i].is_rejected;
    }
    if (!is_sound || work > contacts->most_work || found > room)
        return false;
    contacts->work = work;
    for (uint32_t i = 0; i < all->count; ++i) {
        contacts->fastest = all->ends[i].fastest > contacts->fastest ? all->ends[i].fastest : contacts->fastest;
        contacts->has_push |= all->ends[i].has_push;
    }
    return true;
}

uint32_t mspringi_contact_divide(const mspring_network *network, mspringi_contacts *contacts, uint32_t count,
                                 uint32_t least, uint32_t room, mspringi_contact_range_fn fn, const void *argument,
                                 mspringi_contact_range ranges[MSPRINGI_CONTACT_RANGES]) {
    const uint32_t workers = mspringi_tasks_workers(network->tasks),
                   most = workers < contacts->most_shares ? workers : contacts->most_shares,
                   shares = count / least < most ? count / least : most;
    if (shares > 1) {
        division all = {.network = network,
                        .contacts = contacts,
                        .fn = fn,
                        .argument = argument,
                        .ranges = ranges,
                        .shares = shares,
                        .count = shares * RANGES_OF_SHARE};
        for (uint32_t i = 0; i < all.count; ++i)
            ranges[i] = (mspringi_contact_range){.number = i,
                                                 .of = all.count,
                                                 .first = (uint32_t)((uint64_t)count * i / all.count),
                                                 .end = (uint32_t)((uint64_t)count * (i + 1) / all.count)};
        contacts->stamp_of = MSPRING_NONE;
        mspringi_tasks_run(network->tasks, shares, take_ranges, &all);
        if (join(contacts, &all, room))
            return all.count;
    }
    ranges[0] = (mspringi_contact_range){.of = 1, .end = count};
    fn(network, contacts, &ranges[0], argument);
    return 1;
}

#endif
