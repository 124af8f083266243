/// @file action.c
/// The table of actions, and their text.
///
/// SPDX-License-Identifier: MIT
#include "lab/action.h"
#include "scenes/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef enum argument_kind {
    ARGUMENT_NONE,
    ARGUMENT_NUMBER,
    ARGUMENT_COUNT,
    ARGUMENT_CHOICE,
    ARGUMENT_TEXT
} argument_kind;

enum { MOST_CHOICES = 7 };

typedef struct argument_def {
    argument_kind kind;
    const char *name;
    double least, most;
    const char *choices[MOST_CHOICES];
    double first; // what the first choice stands for
} argument_def;

typedef struct action_def {
    const char *name, *about;
    argument_def arguments[ACTION_VALUES];
} action_def;

#define NUMBER(name, least, most)                                                                                  \
    { ARGUMENT_NUMBER, name, least, most, {NULL}, 0 }
#define COUNT(name, least, most)                                                                                   \
    { ARGUMENT_COUNT, name, least, most, {NULL}, 0 }
#define CHOICE(name, ...)                                                                                          \
    { ARGUMENT_CHOICE, name, 0, 0, {__VA_ARGS__}, 0 }
#define SIDE                                                                                                       \
    { ARGUMENT_CHOICE, "SIDE", 0, 0, {"left", "right", "both"}, SIDE_LEFT }
#define PLACE NUMBER("X", -1e9, 1e9), NUMBER("Y", -1e9, 1e9)
#define TEXT(name)                                                                                                 \
    { ARGUMENT_TEXT, name, 0, 0, {NULL}, 0 }
#define SWITCH CHOICE("WHETHER", "off", "on")

static const action_def defs[ACTION_KINDS] = {
    [ACTION_SCENE] = {"scene", "take a ready scene, an image or a text network", {TEXT("SCENE")}},
    [ACTION_SIDES] = {"sides", "one network, or two of the same scene", {COUNT("COUNT", 1, 2)}},
    [ACTION_SOLVER] = {"solver",
                       "how it goes from step to step",
                       {SIDE, CHOICE("SOLVER", "explicit", "implicit", "direct")}},
    [ACTION_INTEGRATOR] = {"integrator",
                           "of the implicit solver",
                           {SIDE, CHOICE("SCHEME", "ga0", "bdf2", "euler")}},
    [ACTION_SUBSTEPS] = {"substeps",
                         "in a step; 0: as many as the library chooses",
                         {SIDE, COUNT("COUNT", 0, 1000)}},
    [ACTION_ITERATIONS] = {"iterations", "of the implicit solver", {SIDE, COUNT("COUNT", 1, 200)}},
    [ACTION_GRAVITY] = {"gravity", "m/s^2 downwards", {NUMBER("G", -100, 100)}},
    [ACTION_MASS] = {"mass", "times that of the scene", {NUMBER("FACTOR", 0.01, 100)}},
    [ACTION_STIFFNESS] = {"stiffness", "times that of the scene", {NUMBER("FACTOR", 1e-5, 1e5)}},
    [ACTION_DAMPING] = {"damping", "of the springs, times that of the scene", {NUMBER("FACTOR", 0, 100)}},
    [ACTION_DRAG] = {"drag", "damping of all motion, 1/s", {NUMBER("RATE", 0, 20)}},
    [ACTION_DT] = {"dt", "seconds in a step", {NUMBER("SECONDS", 1e-4, 0.25)}},
    [ACTION_RELATIVE] = {"relative", "stiffness as a fraction of what an explicit substep bears", {SWITCH}},
    [ACTION_BREAKING] = {"breaking", "whether springs break that are stretched too far", {SWITCH}},
    [ACTION_FLOOR] = {"floor", "whether there is one, below the scene", {SWITCH}},
    [ACTION_COLLIDE] = {"collide", "whether bodies meet each other and themselves", {SWITCH}},
    [ACTION_YIELDING] = {"yielding", "whether springs stay bent that are strained too far", {SWITCH}},
    [ACTION_GRIP] = {"grip", "how hard particles are pulled, 1/s", {NUMBER("RATE", 1, 100)}},
    [ACTION_GRAB] = {"grab", "take hold of the particles around a place", {PLACE, NUMBER("RADIUS", 0, 1e6)}},
    [ACTION_PULL] = {"pull", "them to another place", {PLACE}},
    [ACTION_DROP] = {"drop", "let them go", {{ARGUMENT_NONE, NULL, 0, 0, {NULL}, 0}}},
    [ACTION_PIN] = {"pin", "the particles around a place", {PLACE, NUMBER("RADIUS", 0, 1e6)}},
    [ACTION_UNPIN] = {"unpin", "the particles around a place", {PLACE, NUMBER("RADIUS", 0, 1e6)}},
    [ACTION_CUT] = {"cut",
                    "all springs that a line crosses",
                    {PLACE, NUMBER("X2", -1e9, 1e9), NUMBER("Y2", -1e9, 1e9)}},
    [ACTION_BLAST] = {"blast",
                      "particles away from a place",
                      {PLACE, NUMBER("RADIUS", 0, 1e6), NUMBER("SPEED", 0, 1e4)}},
    [ACTION_PROBE] = {"probe", "measure the bending at the particle that is nearest", {PLACE}},
    [ACTION_SPRING] = {"spring", "tell of the nearest one what it bears", {SIDE, PLACE, NUMBER("RADIUS", 0, 1e6)}},
    [ACTION_SETTLE] = {"settle", "go to static equilibrium", {{ARGUMENT_NONE, NULL, 0, 0, {NULL}, 0}}},
    [ACTION_PLAY] = {"play", "go on", {{ARGUMENT_NONE, NULL, 0, 0, {NULL}, 0}}},
    [ACTION_PAUSE] = {"pause", "stand still", {{ARGUMENT_NONE, NULL, 0, 0, {NULL}, 0}}},
    [ACTION_STEP] = {"step", "take so many steps while paused", {COUNT("COUNT", 1, 10000)}},
    [ACTION_SPEED] = {"speed", "steps in a frame", {COUNT("STEPS", 1, 64)}},
    [ACTION_UNDO] = {"undo", "take the last edit back", {{ARGUMENT_NONE, NULL, 0, 0, {NULL}, 0}}},
    [ACTION_RESET] = {"reset", "start the scene again", {{ARGUMENT_NONE, NULL, 0, 0, {NULL}, 0}}},
    [ACTION_COLOUR] = {"colour",
                       "what colours show",
                       {CHOICE("BY", "strain", "force", "speed", "island", "plan", "material", "bent")}},
    [ACTION_LAYOUT] = {"layout", "how two sides share the window", {CHOICE("HOW", "auto", "rows", "columns")}},
    [ACTION_TOOL] = {"tool", "what the left button does", {CHOICE("TOOL", "pull", "cut", "pin", "blast")}},
    [ACTION_PAGE] = {"page", "of the controls, in low windows", {COUNT("NUMBER", 1, 2)}},
    [ACTION_PLOTS] = {"plots", "show time series", {SWITCH}},
    [ACTION_PANEL] = {"panel", "show the controls", {SWITCH}},
    [ACTION_SCENES] = {"scenes", "show the list of scenes", {SWITCH}},
    [ACTION_HELP] = {"help", "show the keys", {SWITCH}},
    [ACTION_CAMERA] = {"camera", "look at a place, so many metres across", {PLACE, NUMBER("METRES", 1e-6, 1e9)}},
    [ACTION_FIT] = {"fit", "look at everything", {{ARGUMENT_NONE, NULL, 0, 0, {NULL}, 0}}},
    [ACTION_SCREENSHOT] = {"screenshot", "write a picture of this name", {TEXT("NAME")}},
    [ACTION_TABLE] = {"table", "write what the plots show as CSV of this name", {TEXT("NAME")}},
    [ACTION_RECORDING] = {"recording", "write what mouse and keys did as a script of this name", {TEXT("NAME")}},
    [ACTION_END] = {"end", "of the script", {{ARGUMENT_NONE, NULL, 0, 0, {NULL}, 0}}},
};

lab_action action_of(action_kind kind, double a, double b, double c, double d) {
    return (lab_action){.kind = kind, .values = {a, b, c, d}};
}

lab_action action_of_text(action_kind kind, const char *text) {
    lab_action made = {.kind = kind};
    snprintf(made.text, sizeof made.text, "%s", text);
    return made;
}

/* ---------------------------------------------------------------------------------------------------- reading */

// A line that is read word by word.
typedef struct line_reader {
    const char *line;
    size_t length, at, first_column;
    size_t word_at; // where the last word began
    action_error *error;
} line_reader;

static bool fail(line_reader *reader, const char *what, text_span word) {
    char quoted[80];
    reader->error->column = reader->first_column + reader->word_at;
    snprintf(reader->error->text, sizeof reader->error->text, "%s%s%s%s", what, word.start ? ", not \"" : "",
             word.start ? text_quote(word, quoted, sizeof quoted) : "", word.start ? "\"" : "");
    return false;
}

static bool is_space(char c) {
    return c == ' ' || c == '\t';
}

// The next word; one in double quotes may hold spaces. Returns false at the end of the line or of its first part.
static bool next_word(line_reader *reader, text_span *word) {
    while (reader->at < reader->length && is_space(reader->line[reader->at]))
        reader->at++;
    reader->word_at = reader->at;
    if (reader->at == reader->length || reader->line[reader->at] == '#')
        return false;
    const bool quoted = reader->line[reader->at] == '"';
    reader->at += quoted;
    word->start = reader->line + reader->at;
    while (reader->at < reader->length &&
           (quoted ? reader->line[reader->at] != '"' : !is_space(reader->line[reader->at])))
        reader->at++;
    word->length = (size_t)(reader->line + reader->at - word->start);
    reader->at += quoted && reader->at < reader->length;
    return true;
}

static bool is_word(text_span word, const char *text) {
    return strlen(text) == word.length && memcmp(word.start, text, word.length) == 0;
}

static bool read_choice(line_reader *reader, const argument_def *def, text_span word, double *value) {
    char wanted[160];
    int written = snprintf(wanted, sizeof wanted, "expected ");
    for (int i = 0; i < MOST_CHOICES && def->choices[i]; i++) {
        if (is_word(word, def->choices[i])) {
            *value = def->first + i;
            return true;
        }
        written +=
            snprintf(wanted + written, sizeof wanted - (size_t)written, "%s%s", i ? " or " : "", def->choices[i]);
    }
    return fail(reader, wanted, word);
}

static bool read_number(line_reader *reader, const argument_def *def, text_span word, double *value) {
    char wanted[160];
    const bool whole = def->kind == ARGUMENT_COUNT;
    if (number_parse(word, value) && *value >= def->least && *value <= def->most &&
        (!whole || *value == floor(*value)))
        return true;
    snprintf(wanted, sizeof wanted, "%s is a %snumber from %g to %g", def->name, whole ? "whole " : "", def->least,
             def->most);
    return fail(reader, wanted, word);
}

static bool read_text(line_reader *reader, text_span word, char text[ACTION_TEXT]) {
    if (word.length == 0 || word.length >= ACTION_TEXT)
        return fail(reader, "expected a name of 1 to 511 characters", (text_span){NULL, 0});
    for (size_t i = 0; i < word.length; i++)
        if ((unsigned char)word.start[i] < ' ' || word.start[i] == '"')
            return fail(reader, "a name cannot hold quotes or control characters", word);
    memcpy(text, word.start, word.length);
    text[word.length] = 0;
    return true;
}

static bool read_argument(line_reader *reader, const action_def *def, int index, lab_action *out) {
    const argument_def *argument = &def->arguments[index];
    text_span word;
    if (!next_word(reader, &word)) {
        char wanted[160];
        snprintf(wanted, sizeof wanted, "%s lacks its %s", def->name, argument->name);
        return fail(reader, wanted, (text_span){NULL, 0});
    }
    switch (argument->kind) {
    case ARGUMENT_TEXT:
        return read_text(reader, word, out->text);
    case ARGUMENT_CHOICE:
        return read_choice(reader, argument, word, &out->values[index]);
    default:
        return read_number(reader, argument, word, &out->values[index]);
    }
}

bool action_read(const char *line, size_t length, size_t first_column, lab_action *out, action_error *error) {
    line_reader reader = {.line = line, .length = length, .first_column = first_column, .error = error};
    text_span word;
    if (!next_word(&reader, &word))
        return fail(&reader, "no action", (text_span){NULL, 0});
    int kind = 0;
    while (kind < ACTION_KINDS && !is_word(word, defs[kind].name))
        kind++;
    if (kind == ACTION_KINDS)
        return fail(&reader, "expected an action such as grab (lab --actions lists them)", word);
    lab_action made = {.kind = (action_kind)kind};
    for (int i = 0; i < ACTION_VALUES && defs[kind].arguments[i].kind != ARGUMENT_NONE; i++)
        if (!read_argument(&reader, &defs[kind], i, &made))
            return false;
    if (next_word(&reader, &word))
        return fail(&reader, "expected nothing more", word);
    *out = made;
    return true;
}

/* ---------------------------------------------------------------------------------------------------- writing */

const char *action_write(const lab_action *action, char buffer[ACTION_LINE]) {
    const action_def *def = &defs[action->kind];
    int length = snprintf(buffer, ACTION_LINE, "%s", def->name);
    for (int i = 0; i < ACTION_VALUES && def->arguments[i].kind != ARGUMENT_NONE; i++) {
        const argument_def *argument = &def->arguments[i];
        char *rest = buffer + length;
        const size_t room = ACTION_LINE - (size_t)length;
        if (argument->kind == ARGUMENT_TEXT)
            length += snprintf(rest, room, strpbrk(action->text, " #\t") ? " \"%s\"" : " %s", action->text);
        else if (argument->kind == ARGUMENT_CHOICE)
            length += snprintf(rest, room, " %s", argument->choices[(int)(action->values[i] - argument->first)]);
        else
            length += snprintf(rest, room, " %.9g", action->values[i]);
    }
    return buffer;
}

bool action_is_valid(const lab_action *action) {
    char line[ACTION_LINE];
    lab_action again;
    action_error error;
    if ((int)action->kind < 0 || action->kind >= ACTION_KINDS)
        return false;
    for (int i = 0; i < ACTION_VALUES && defs[action->kind].arguments[i].kind != ARGUMENT_NONE; i++) {
        const double choice = action->values[i] - defs[action->kind].arguments[i].first;
        if (defs[action->kind].arguments[i].kind == ARGUMENT_CHOICE &&
            !(choice >= 0 && choice < action_choice_count(action->kind, i)))
            return false;
    }
    action_write(action, line);
    return action_read(line, strlen(line), 1, &again, &error);
}

lab_action action_rounded(const lab_action *action) {
    lab_action made = *action, again;
    char line[ACTION_LINE];
    action_error error;
    for (int i = 0; i < ACTION_VALUES; i++) {
        const argument_def *argument = &defs[action->kind].arguments[i];
        if (argument->kind != ARGUMENT_NUMBER && argument->kind != ARGUMENT_COUNT)
            continue;
        double *value = &made.values[i];
        *value = *value >= argument->least ? *value : argument->least; // NaN too
        *value = *value > argument->most ? argument->most : *value;
        if (argument->kind == ARGUMENT_COUNT)
            *value = floor(*value + 0.5);
    }
    action_write(&made, line);
    return action_read(line, strlen(line), 1, &again, &error) ? again : made;
}

/* ------------------------------------------------------------------------------------------------- describing */

const char *action_usage(action_kind kind, char buffer[ACTION_LINE]) {
    int length = snprintf(buffer, ACTION_LINE, "%s", defs[kind].name);
    for (int i = 0; i < ACTION_VALUES && defs[kind].arguments[i].kind != ARGUMENT_NONE; i++) {
        const argument_def *argument = &defs[kind].arguments[i];
        if (argument->kind != ARGUMENT_CHOICE) {
            length += snprintf(buffer + length, ACTION_LINE - (size_t)length, " %s", argument->name);
            continue;
        }
        for (int c = 0; c < MOST_CHOICES && argument->choices[c]; c++)
            length += snprintf(buffer + length, ACTION_LINE - (size_t)length, "%s%s", c ? "|" : " ",
                               argument->choices[c]);
    }
    return buffer;
}

const char *action_about(action_kind kind) {
    return defs[kind].about;
}

const char *action_choice_name(action_kind kind, int which, int choice) {
    return defs[kind].arguments[which].choices[choice];
}

int action_choice_count(action_kind kind, int which) {
    int count = 0;
    while (count < MOST_CHOICES && defs[kind].arguments[which].choices[count])
        count++;
    return count;
}
