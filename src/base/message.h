/// @file message.h
/// The error message that every object holds.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_MESSAGE_H
#define MSPRINGI_MESSAGE_H

#include <massspring/massspring.h>

#include "base/format.h"

typedef struct mspringi_message {
    char text[256];
} mspringi_message;

/// At the entry of a call.
static inline void mspringi_message_clear(mspringi_message *message) {
    message->text[0] = 0;
}

/// Write the message, cut to fit, and return result.
mspring_result mspringi_fail(mspringi_message *message, mspring_result result, const char *format, ...)
    MSPRINGI_PRINTF(3, 4);

/// Check a public struct's size against those of its first and of this version.
mspring_result mspringi_check_struct(mspringi_message *message, const char *name, size_t given, size_t first,
                                     size_t current);

/// Check the reserved field of a public struct: a later version may give it a meaning.
mspring_result mspringi_check_reserved(mspringi_message *message, const char *name, uint32_t reserved);

#endif
