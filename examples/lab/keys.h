/// @file keys.h
/// The keys and what they do, for help on the screen and on the command line.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_KEYS_H
#define LAB_KEYS_H

typedef struct key_help {
    const char *key, *about;
} key_help;

extern const key_help keys_help[];
extern const int keys_help_count;

#endif
