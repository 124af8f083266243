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

/// Prefix the message of a failure with the index of the element that failed.
mspring_result mspringi_prefix(mspringi_message *message, mspring_result result, const char *what, size_t index);

/// Check the reserved field of a public struct: later versions may use it.
mspring_result mspringi_check_reserved(mspringi_message *message, const char *name, uint32_t reserved);

#endif
