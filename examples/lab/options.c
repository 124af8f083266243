/// @file options.c
/// The command line, read strictly.
///
/// SPDX-License-Identifier: MIT
#include "lab/options.h"
#include "lab/action.h"
#include "lab/keys.h"
#include "scenes/number.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_help(const char *program) {
    printf("usage: %s [OPTIONS] [SCENE]\n\n"
           "SCENE is ship (the default), bar, beam, bridge, net, rope, graph, ships,\n"
           "pile, jellies, an image, a ship (.shp, .shp2), a vehicle or a text network.\n\n"
           "  --headless         no window: play the script, as fast as it goes\n"
           "  --script FILE      play actions from a file (with a window, too)\n"
           "  --record FILE      write the actions of mouse and keys as such a file\n"
           "  --frames FOLDER    where pictures go (out), and, headless, all frames as numbered PNG files\n"
           "  --animation FILE   headless: one moving PNG, which browsers play\n"
           "  --every N          a frame of these after every N of the lab (4), which has 64 a second\n"
           "  --shrink N         the moving picture's size: one by 1, 2 or 4\n"
           "  --size WxH         of the window and of pictures (1280x720)\n"
           "  --no-clock         show nothing that differs from run to run\n"
           "  --stop-after N     frames, then end\n"
           "  --can-show         only say, by the exit status, whether there can be a window\n"
           "  --actions          list what scripts can do\n\n",
           program);
    for (int i = 0; i < keys_help_count; i++)
        printf("  %-20s %s\n", keys_help[i].key, keys_help[i].about);
}

static void print_actions(void) {
    char usage[ACTION_LINE];
    puts("# seconds, then one of:");
    for (int i = 0; i < ACTION_KINDS; i++)
        printf("%-48s # %s\n", action_usage((action_kind)i, usage), action_about((action_kind)i));
}

static bool read_count(const char *text, double least, double most, uint32_t *out) {
    double value;
    const text_span span = {text, strlen(text)};
    if (!number_parse(span, &value) || value < least || value > most || value != (double)(uint32_t)value)
        return false;
    *out = (uint32_t)value;
    return true;
}

static bool read_size(const char *text, int *width, int *height) {
    char first[16];
    uint32_t numbers[2];
    const char *by = strchr(text, 'x');
    if (!by || by - text >= (int)sizeof first)
        return false;
    memcpy(first, text, (size_t)(by - text));
    first[by - text] = 0;
    if (!read_count(first, 480, 8192, &numbers[0]) || !read_count(by + 1, 320, 8192, &numbers[1]))
        return false;
    *width = (int)numbers[0];
    *height = (int)numbers[1];
    return true;
}

// Reads an option that takes a value. Returns false if the value is wrong.
static bool read_valued(lab_options *made, const char *option, const char *value, bool *known) {
    *known = true;
    if (strcmp(option, "--script") == 0)
        made->script = value;
    else if (strcmp(option, "--record") == 0)
        made->record = value;
    else if (strcmp(option, "--frames") == 0)
        made->frames = value, made->every_frame = true;
    else if (strcmp(option, "--animation") == 0)
        made->animation = value;
    else if (strcmp(option, "--every") == 0)
        return read_count(value, 1, 100000, &made->every);
    else if (strcmp(option, "--shrink") == 0)
        return read_count(value, 1, 4, &made->shrink) && made->shrink != 3;
    else if (strcmp(option, "--stop-after") == 0)
        return read_count(value, 1, 1e9, &made->most_frames);
    else if (strcmp(option, "--size") == 0)
        return read_size(value, &made->width, &made->height);
    else
        *known = false;
    return true;
}

static bool complain(const char *program, const char *what, const char *about, int *exit_code) {
    fprintf(stderr, "%s: %s %s (--help)\n", program, what, about);
    *exit_code = 2;
    return false;
}

bool options_read(lab_options *made, int count, char **arguments, int *exit_code) {
    *made = (lab_options){.frames = "out", .width = 1280, .height = 720, .every = 4, .shrink = 1};
    *exit_code = EXIT_SUCCESS;
    for (int i = 1; i < count; i++) {
        const char *option = arguments[i];
        bool known = false;
        if (strcmp(option, "--help") == 0) {
            print_help(arguments[0]);
            return false;
        }
        if (strcmp(option, "--actions") == 0) {
            print_actions();
            return false;
        }
        if (strcmp(option, "--headless") == 0) {
            made->headless = true;
        } else if (strcmp(option, "--can-show") == 0) {
            made->can_show = true;
        } else if (strcmp(option, "--no-clock") == 0) {
            made->no_clock = true;
        } else if (strncmp(option, "--", 2) != 0) {
            if (made->scene)
                return complain(arguments[0], "one scene only, not also", option, exit_code);
            made->scene = option;
        } else {
            const bool good = i + 1 < count && read_valued(made, option, arguments[i + 1], &known);
            if (good && !known)
                return complain(arguments[0], "unknown option", option, exit_code);
            if (!good)
                return complain(arguments[0], "missing or wrong value of", option, exit_code);
            i++;
        }
    }
    if (made->headless && !made->script && !made->most_frames)
        return complain(arguments[0], "--headless needs", "--script or --stop-after", exit_code);
    if (!made->headless && made->animation)
        return complain(arguments[0], "--animation needs", "--headless", exit_code);
    if (!made->scene)
        made->scene = "ship";
    return true;
}
