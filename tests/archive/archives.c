/// @file archives.c
///
/// SPDX-License-Identifier: MIT
#include "archives.h"

#include <stdlib.h>
#include <string.h>

static mspring_result MSPRING_CALL append(const void *bytes, size_t size, void *user) {
    archived *to = user;
    while (to->room < to->size + size) {
        to->room = to->room > 0 ? 2 * to->room : 4096;
        to->bytes = realloc(to->bytes, to->room);
        assert_non_null(to->bytes);
    }
    memcpy(to->bytes + to->size, bytes, size);
    to->size += size;
    return MSPRING_OK;
}

archived archives_write(const mspring_network *network) {
    archived made = {NULL, 0, 0};
    check_ok(mspring_network_write(network, append, &made));
    return made;
}

mspring_network *archives_read(const archived *from, uint32_t workers) {
    mspring_builder *builder = support_builder();
    mspring_network *network = NULL;
    mspring_network_def def = {.struct_size = sizeof def};
    uint32_t skipped = 99;
    if (mspring_builder_read(builder, from->bytes, from->size, &skipped) != MSPRING_OK)
        fail_msg("%s", mspring_builder_error(builder));
    assert_int_equal(skipped, 0);
    check_ok(mspring_builder_get_network_def(builder, &def));
    def.worker_count = workers;
    if (mspring_network_create(builder, &def, &network) != MSPRING_OK)
        fail_msg("%s", mspring_builder_error(builder));
    mspring_builder_destroy(builder);
    return network;
}

mspring_network *archives_check_same(const mspring_network *network, uint32_t workers) {
    const archived first = archives_write(network);
    mspring_network *made = archives_read(&first, workers);
    const archived second = archives_write(made);
    assert_int_equal(first.size, second.size);
    for (size_t i = 0; i < first.size; i++)
        if (first.bytes[i] != second.bytes[i])
            fail_msg("byte %zu of %zu differs", i, first.size);
    free(first.bytes);
    free(second.bytes);
    return made;
}
