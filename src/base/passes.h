/// @file passes.h
/// Work in a list of short functions, so that a host with one thread may pause between any two of them.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PASSES_H
#define MSPRINGI_PASSES_H

#include <stdbool.h>

#include "base/message.h"

/// Position in a list.
typedef struct mspringi_cursor {
    uint32_t pass, at; ///< next function, and begin of its next range
    bool again;        ///< set by a function that must be called again; it may set pass, too, to continue there
} mspringi_cursor;

/// Declare the type of a list's functions, name_pass, and name_run(), which calls the next one. A function is
/// called once, or for one range after another of at most `most` elements.
// NOLINTBEGIN(bugprone-macro-parentheses): of a type
#define MSPRINGI_PASSES(name, type)                                                                                \
    typedef struct name##_pass {                                                                                   \
        mspring_result (*once)(type *);                                                                            \
        mspring_result (*part)(type *, uint32_t first, uint32_t end);                                              \
        uint32_t (*count)(const type *);                                                                           \
        uint32_t max_range;                                                                                        \
    } name##_pass;                                                                                                 \
                                                                                                                   \
    static mspring_result name##_run(type *work, const name##_pass *list, mspringi_cursor *cursor) {               \
        const name##_pass *next = &list[cursor->pass];                                                             \
        const uint32_t first = cursor->at, left = next->part ? next->count(work) - first : 0;                      \
        const uint32_t end = first + (left < next->max_range ? left : next->max_range);                            \
        mspring_result result = MSPRING_OK;                                                                        \
        cursor->again = false;                                                                                     \
        cursor->at = end;                                                                                          \
        if (next->once)                                                                                            \
            result = next->once(work);                                                                             \
        else if (left > 0)                                                                                         \
            result = next->part(work, first, end);                                                                 \
        if (end == first + left && !cursor->again) {                                                               \
            cursor->pass++;                                                                                        \
            cursor->at = 0;                                                                                        \
        }                                                                                                          \
        return result;                                                                                             \
    }
// NOLINTEND(bugprone-macro-parentheses)

#define MSPRINGI_ONCE(function)                                                                                    \
    { function, NULL, NULL, 0 }
#define MSPRINGI_EACH(function, count, max_range)                                                                  \
    { NULL, function, count, max_range }

/// Number of functions in a list.
#define MSPRINGI_PASS_COUNT(list) ((uint32_t)(sizeof(list) / sizeof(list)[0]))

#endif
