/// A network that goes on where an archived one was.
#include <string.h>

#include "archive/archive_format.h"
#include "base/definitions.h"
#include "store/changed.h"
#include "store/springs.h"

/* ----------------------------------------------------------------------------------------- before the network */

static mspring_result take_def(mspring_builder *builder, const mspring_network_def *given,
                               mspring_network_def *def) {
    const mspringi_archive_head *head = &builder->archive->head;
    const mspring_network_def *own = &head->def;
    if (builder->particle_count != head->first_particle || builder->spring_count != head->first_spring ||
        builder->area_count > 0)
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT,
                             "the builder has read an archive of %u particles and %u springs, others were added",
                             (unsigned)head->first_particle, (unsigned)head->first_spring);
    if (given && (given->spare_particles != own->spare_particles || given->spare_springs != own->spare_springs ||
                  given->flags != own->flags))
        return mspringi_fail(
            &builder->message, MSPRING_ERROR_ARGUMENT,
            "spare_particles is %u, spare_springs %u, flags %#x, but the archive's are %u, %u, %#x: "
            "begin with mspring_builder_get_network_def()",
            (unsigned)given->spare_particles, (unsigned)given->spare_springs, (unsigned)given->flags,
            (unsigned)own->spare_particles, (unsigned)own->spare_springs, (unsigned)own->flags);
    *def = *own;
    if (given) {
        def->simd_level = given->simd_level;
        def->allocator = given->allocator;
        def->tasks = given->tasks;
        def->worker_count = given->worker_count;
    }
    // The direct solver finds an order of elimination, and a compact layout tiles: not before all springs are
    // there.
    if (head->is_compact || own->settings.solver == MSPRING_SOLVER_DIRECT)
        def->settings.solver = MSPRING_SOLVER_EXPLICIT;
    return MSPRING_OK;
}

static mspring_result lay_out_archived(const mspring_builder *builder, mspringi_memory *memory,
                                       mspringi_message *message, mspring_builder *placed) {
    const uint8_t *from = mspringi_archive_find(builder->archive->bytes, mspringi_plan_tag).bytes;
    *placed = *builder;
    placed->particles = mspringi_alloc_unset(memory, builder->particle_count, sizeof *placed->particles);
    if (!placed->particles)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles",
                             builder->particle_count);
    for (size_t p = 0; p < builder->particle_count; ++p) {
        int32_t place[2];
        from = mspringi_get(from, place, 2, sizeof place[0]);
        placed->particles[p] = builder->particles[p];
        placed->particles[p].x = (double)place[0];
        placed->particles[p].y = (double)place[1];
    }
    return MSPRING_OK;
}

static bool may_have_bundles(const mspring_builder *builder) {
    return builder->archive->head.may_have_bundles;
}

/* ----------------------------------------------------------------------------------------------------- messages */

static mspring_result blame(mspringi_message *message, mspring_result result, const char *chunk) {
    static const char snapshot[] = "the snapshot's ";
    const mspringi_message said = *message;
    const char *text = said.text;
    if (result == MSPRING_OK || result == MSPRING_ERROR_MEMORY || result == MSPRING_ERROR_THREAD)
        return result;
    if (chunk)
        return mspringi_fail(message, MSPRING_ERROR_SNAPSHOT, "the archive's %s: %s", chunk, text);
    if (memcmp(text, snapshot, sizeof snapshot - 1) == 0)
        text += sizeof snapshot - 1;
    return mspringi_fail(message, MSPRING_ERROR_SNAPSHOT, "the archive's %s", text);
}

/* ------------------------------------------------------------------------------------------------------- chunks */

void *mspringi_chunk_array(mspring_network *network, mspringi_io *io, size_t count, size_t width,
                           mspring_result *result) {
    if (*result != MSPRING_OK)
        return NULL;
    void *array = NULL;
    if (io->is_short || count > io->left / width)
        *result =
            mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT, "they are too short for %zu values", count);
    else if (!(array = mspringi_alloc_unset(&network->memory, count, width)))
        *result =
            mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %zu values of an archive", count);
    else
        mspringi_hand(io, array, count, width);
    return array;
}

static mspring_result load_chunk(mspring_network *network, const mspringi_archive *archive,
                                 const mspringi_chunk *chunk) {
    const mspringi_read_chunk found = mspringi_archive_find(archive->bytes, chunk->tag);
    if (!found.bytes)
        return MSPRING_OK;
    mspringi_io io = mspringi_io_from(found.bytes, found.size);
    mspring_result result = chunk->load(network, &io);
    if (result == MSPRING_OK && io.is_short)
        result = mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT, "they take %zu bytes, which are too few",
                               found.size);
    return blame(&network->message, result, chunk->name);
}

/* ----------------------------------------------------------------------------------------------------- sections */

static bool is_of_chunk(const mspringi_section *section) {
    bool any = false;
    for (const mspringi_chunk *const *chunk = mspringi_chunks; *chunk; ++chunk)
        any = any || (*chunk)->section == section;
    return any;
}

// A section as this network's snapshots have it. *made: free it.
static mspring_result enter(mspring_network *network, const mspringi_archive *archive,
                            const mspringi_section *section, uint8_t **made, const uint8_t **from, size_t *size) {
    const mspringi_read_chunk found = mspringi_archive_find(archive->bytes, section->tag);
    const mspringi_by_id *by = mspringi_by_id_of(section);
    *made = NULL;
    *from = found.bytes;
    *size = found.bytes ? found.size : 0;
    if (*size == 0 || !by)
        return MSPRING_OK;
    const size_t entered = mspringi_by_id_size(network, by, true, found.bytes, found.size);
    if (entered == SIZE_MAX)
        return mspringi_section_fail(network, section, "they take %zu bytes, which are too few or too many",
                                     found.size);
    const size_t own = by->enter ? mspringi_section_size(network, section) : 0;
    *made = mspringi_alloc(&network->memory, entered > own ? entered : own, 1);
    if (!*made)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to read %zu bytes of an archive",
                             found.size);
    *from = *made;
    if (!mspringi_by_id_translate(network, by, true, found.bytes, found.size, *made))
        return mspringi_section_fail(network, section, "it names particles that are not there");
    *size = by->enter ? by->enter(network, *made, entered) : entered;
    return MSPRING_OK;
}

// Load all sections but those that come with a chunk.
static mspring_result load_sections(mspring_network *network, const mspringi_archive *archive) {
    const mspringi_snapshot_header header = {.contents = MSPRING_SNAPSHOT_ALL,
                                             .parameter_fingerprint = archive->head.parameter_fingerprint};
    const bool has_solver = network->solver.ops->load != NULL;
    uint8_t *made[MSPRINGI_SECTIONS] = {NULL};
    mspringi_found in = {.size = {0}};
    mspring_result result = MSPRING_OK;
    // The network's fallback may have other tiles than the archived one, which the guard's section makes.
    mspringi_solver_destroy(&network->fallback, &network->memory);
    for (int i = 0; result == MSPRING_OK && i < MSPRINGI_SECTIONS; ++i)
        if (!is_of_chunk(mspringi_sections[i]) && (i != MSPRINGI_SECTION_implicit || has_solver))
            result = enter(network, archive, mspringi_sections[i], &made[i], &in.from[i], &in.size[i]);
    if (result == MSPRING_OK)
        result = mspringi_sections_check(network, &header, &in);
    if (result == MSPRING_OK)
        result = mspringi_sections_load(network, &header, &in);
    for (int i = 0; i < MSPRINGI_SECTIONS; ++i)
        mspringi_free(&network->memory, made[i]);
    return blame(&network->message, result, NULL);
}

static mspring_result load_section(mspring_network *network, const mspringi_archive *archive,
                                   const mspringi_section *section) {
    uint8_t *made;
    const uint8_t *from;
    size_t size;
    mspring_result result = enter(network, archive, section, &made, &from, &size);
    if (result == MSPRING_OK)
        result = section->check(network, from, size);
    if (result == MSPRING_OK)
        section->load(network, from, size);
    mspringi_free(&network->memory, made);
    return blame(&network->message, result, NULL);
}

/* ------------------------------------------------------------------------------------------------------- layout */

// Have a solver without bundles, if this build has one: what is compacted then has none, whatever is chosen later.
static mspring_result leave_bundles(mspring_network *network) {
    mspring_settings solver;
    (void)mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver);
    solver.solver = MSPRING_SOLVER_IMPLICIT;
    const mspring_result result = mspring_network_set_settings(network, &solver);
    if (result == MSPRING_ERROR_MEMORY)
        return result;
    mspringi_message_clear(&network->message);
    return MSPRING_OK;
}

// Choose the archived solver where the network was created with another one, and compact it if it was.
static mspring_result lay_out_anew(mspring_network *network, const mspringi_archive_head *head) {
    const mspring_settings solver = head->def.settings;
    mspring_result result = MSPRING_OK;
    if (!head->is_compact_with_bundles)
        result = solver.solver == MSPRING_SOLVER_EXPLICIT ? leave_bundles(network)
                                                          : mspring_network_set_settings(network, &solver);
    if (result == MSPRING_OK && head->is_compact)
        result = mspring_network_compact(network);
    return result == MSPRING_OK ? mspring_network_set_settings(network, &solver) : result;
}

// Bounds that depend on what the network was created with.
static void set_bounds(mspring_network *network, const mspringi_archive_head *head) {
    network->shortest = head->shortest;
    network->shortest_set = head->shortest_set;
    network->has_welds = head->has_welds;
    network->state.grid = network->is_precise ? head->grid : 0.0f;
}

static void set_basis(mspring_network *network, const mspringi_archive_head *head) {
    if (head->basis.scale > 0.0 && network->solver.ops->set_basis)
        network->solver.ops->set_basis(network->solver.object, network, &head->basis);
}

/* --------------------------------------------------------------------------------------------------- the others */

// Settings, where the host wants others than the archive's.
static mspring_result change(mspring_network *network, const mspring_network_def *own,
                             const mspring_network_def *given) {
    return memcmp(&given->settings, &own->settings, sizeof own->settings) == 0
               ? MSPRING_OK
               : mspring_network_set_settings(network, &given->settings);
}

static mspring_result resume(mspring_network *network, const mspring_builder *builder,
                             const mspring_network_def *given) {
    const mspringi_archive *archive = builder->archive;
    const mspringi_archive_head *head = &archive->head;
    const bool is_laid_out_anew = head->is_compact || head->def.settings.solver == MSPRING_SOLVER_DIRECT;
    mspring_result result = MSPRING_OK;
    set_bounds(network, head);
    for (const mspringi_chunk *const *chunk = mspringi_chunks; result == MSPRING_OK && *chunk; ++chunk)
        if (!(*chunk)->section)
            result = load_chunk(network, archive, *chunk);
    set_basis(network, head);
    if (result == MSPRING_OK)
        result = load_sections(network, archive);
    if (result == MSPRING_OK && is_laid_out_anew)
        result = lay_out_anew(network, head);
    if (result == MSPRING_OK && is_laid_out_anew) {
        set_basis(network, head);
        result = load_sections(network, archive);
    }
    for (const mspringi_chunk *const *chunk = mspringi_chunks; result == MSPRING_OK && *chunk; ++chunk) {
        if (!(*chunk)->section)
            continue;
        result = load_chunk(network, archive, *chunk);
        if (result == MSPRING_OK)
            result = load_section(network, archive, (*chunk)->section);
    }
    set_bounds(network, head);
    network->parameter_fingerprint = head->parameter_fingerprint;
    network->next_collider = head->next_collider;
    return result == MSPRING_OK && given ? change(network, &head->def, given) : result;
}

const mspringi_archive_calls mspringi_archive_resuming = {take_def, lay_out_archived, blame, may_have_bundles,
                                                          resume};
