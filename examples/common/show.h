/// @file show.h
/// A small program's moving picture, from its arguments to the file.
///
/// SPDX-License-Identifier: MIT
#ifndef COMMON_SHOW_H
#define COMMON_SHOW_H

#include "draw/film.h"

typedef struct show {
    const char *name, *about;
    const char *folder; ///< NULL: there is nothing to draw, and exit_code says whether that is right
    int exit_code;
    bool is_ok; ///< false: something went wrong, and stderr says what
    network_shape shape;
    struct film film; // C++, too, reads it so
} show;

/// Read a program's arguments, --out FOLDER or --help, and begin a film of its network. show_end() the show.
/// @param about         a sentence on the program, for --help and above the picture
/// @param network       NULL where it could not be made: there is nothing to film then
/// @param strain_limit  strain at both ends of the colours; 0: what suits the last frame
void show_begin(show *made, int count, char **arguments, const char *name, const char *about,
                const mspring_network *network, double strain_limit);

/// Film the network as it is now. To be called after each step.
void show_step(show *target, const mspring_network *network);

/// Write the film to FOLDER/name.png, or print why a call on the builder or the network failed. Destroy all three.
/// @param result  of the program's calls: the first error, or MSPRING_OK
/// @return the program's exit code
int show_end(show *ended, mspring_result result, mspring_builder *builder, mspring_network *network);

#endif
