/// @file message.h
/// Error message of an object.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_MESSAGE_H
#define MSPRINGI_MESSAGE_H

#include <stdbool.h>
#include <string.h>

#include <massspring/massspring.h>

#include "base/format.h"

typedef struct mspringi_message {
    char text[256];
} mspringi_message;

/// Message of calls that may run concurrently. The first that fails writes it; no other changes it until it is
/// cleared. So it can be read without a lock.
typedef struct mspringi_shared_message {
    _Atomic uint32_t state; ///< MSPRINGI_MESSAGE_...
    mspringi_message message;
} mspringi_shared_message;

enum { MSPRINGI_MESSAGE_NONE = 0, MSPRINGI_MESSAGE_CLAIMED = 1, MSPRINGI_MESSAGE_WRITTEN = 2 };

/// Clear the message while no other call uses it.
void mspringi_shared_clear(mspringi_shared_message *shared);
/// Text of the message, or "".
const char *mspringi_shared_text(const mspringi_shared_message *shared);
/// Write the message, cut to fit, and return result.
mspring_result mspringi_shared_fail(mspringi_shared_message *shared, mspring_result result, const char *format, ...)
    MSPRINGI_PRINTF(3, 4);
/// Write a message that exists already.
mspring_result mspringi_shared_set(mspringi_shared_message *shared, mspring_result result,
                                   const mspringi_message *message);

/// Text of an id for %s in a message: its number, or MSPRING_NONE.
enum { MSPRINGI_ID_SIZE = 24 };
const char *mspringi_id_text(char text[MSPRINGI_ID_SIZE], mspring_id id);
#define MSPRINGI_ID(id) mspringi_id_text((char[MSPRINGI_ID_SIZE]){0}, id)

/// Clear the message on entry of a call.
static inline void mspringi_message_clear(mspringi_message *message) {
    message->text[0] = 0;
}

/// Write the message, cut to fit, and return result.
mspring_result mspringi_fail(mspringi_message *message, mspring_result result, const char *format, ...)
    MSPRINGI_PRINTF(3, 4);

/// Check a public struct by its struct_size. A later header may have a larger one: then the bytes unknown to this
/// version must be 0. The message may be NULL.
mspring_result mspringi_check_struct(mspringi_message *message, const char *name, const void *given, size_t known);

/// Check a public struct for output. Bytes unknown to this version may hold anything. NULL is
/// MSPRING_ERROR_ARGUMENT.
mspring_result mspringi_check_output(mspringi_message *message, const char *name, const void *out, size_t known);
/// Fill an output struct. Bytes unknown to this version become 0; struct_size stays.
void mspringi_put_struct(void *out, const void *made, size_t known);

/// Check that an element of an array is as large as the first. The message may be NULL.
mspring_result mspringi_check_same_size(mspringi_message *message, const void *element, size_t struct_size);

/// Check an array of output structs of equal size.
mspring_result mspringi_check_outputs(const void *array, uint32_t count, const char *name, size_t known,
                                      mspringi_message *message);

/// Fill a struct of this size with defaults; set struct_size.
mspring_result mspringi_init_struct(void *out, size_t size, const void *defaults, size_t known);

/// Element of an array of structs of struct_size bytes.
static inline const void *mspringi_element(const void *array, size_t struct_size, size_t index) {
    return (const char *)array + struct_size * index;
}
/// Size of a public struct, or of those in an array, from the first one.
static inline size_t mspringi_struct_size(const void *array) {
    uint32_t size;
    memcpy(&size, array, sizeof size);
    return size;
}

/// Check the reserved field of a public struct: later versions may use it.
mspring_result mspringi_check_reserved(mspringi_message *message, const char *name, uint32_t reserved);

#endif
