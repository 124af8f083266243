/// @file message.h
/// The error message that every object holds.
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

/// The message of calls that may run side by side: the first of them that fails writes it, and no other touches it
/// until it is cleared. So it can be read without a lock.
typedef struct mspringi_shared_message {
    _Atomic uint32_t state; ///< MSPRINGI_MESSAGE_...
    mspringi_message message;
} mspringi_shared_message;

enum { MSPRINGI_MESSAGE_NONE = 0, MSPRINGI_MESSAGE_CLAIMED = 1, MSPRINGI_MESSAGE_WRITTEN = 2 };

/// Nobody else may be here.
void mspringi_shared_clear(mspringi_shared_message *shared);
/// The text, or "".
const char *mspringi_shared_text(const mspringi_shared_message *shared);
/// Write the message, cut to fit, and return result.
mspring_result mspringi_shared_fail(mspringi_shared_message *shared, mspring_result result, const char *format, ...)
    MSPRINGI_PRINTF(3, 4);
/// The same of one that is there already.
mspring_result mspringi_shared_take(mspringi_shared_message *shared, mspring_result result,
                                    const mspringi_message *message);

/// An id for a message, by %s: its number, or that it is MSPRING_NONE.
enum { MSPRINGI_ID_SIZE = 24 };
const char *mspringi_id_text(char text[MSPRINGI_ID_SIZE], mspring_id id);
#define MSPRINGI_ID(id) mspringi_id_text((char[MSPRINGI_ID_SIZE]){0}, id)

/// At the entry of a call.
static inline void mspringi_message_clear(mspringi_message *message) {
    message->text[0] = 0;
}

/// Write the message, cut to fit, and return result.
mspring_result mspringi_fail(mspringi_message *message, mspring_result result, const char *format, ...)
    MSPRINGI_PRINTF(3, 4);

/// Check a public struct by the struct_size that it begins with. One of a later header may be larger than this
/// library knows: then what is behind that is 0, so that it is not used. The message may be NULL.
mspring_result mspringi_check_struct(mspringi_message *message, const char *name, const void *given, size_t known);

/// The same of a struct that is to be filled: one that is larger may hold anything. NULL is
/// MSPRING_ERROR_ARGUMENT.
mspring_result mspringi_check_output(mspringi_message *message, const char *name, const void *out, size_t known);
/// Fill it. What this library does not know becomes 0; struct_size stays.
void mspringi_put_struct(void *out, const void *made, size_t known);

/// Check that an element of an array is as large as the first. The message may be NULL.
mspring_result mspringi_check_alike(mspringi_message *message, const void *element, size_t struct_size);

/// Check an array of structs that are to be filled, all of them alike.
mspring_result mspringi_check_outputs(const void *array, uint32_t count, const char *name, size_t known,
                                      mspringi_message *message);

/// Fill a struct of this size with its defaults, and struct_size with the size.
mspring_result mspringi_init_struct(void *out, size_t size, const void *defaults, size_t known);

/// An element of an array of structs that are as large as they say, all of them alike.
static inline const void *mspringi_element(const void *array, size_t struct_size, size_t index) {
    return (const char *)array + struct_size * index;
}
/// The size of these, by the first of them.
static inline size_t mspringi_struct_size(const void *array) {
    uint32_t size;
    memcpy(&size, array, sizeof size);
    return size;
}

/// Check the reserved field of a public struct: a later version may give it a meaning.
mspring_result mspringi_check_reserved(mspringi_message *message, const char *name, uint32_t reserved);

#endif
