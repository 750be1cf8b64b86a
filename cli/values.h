// The values of options: what each kind takes, and into which field of the settings it goes.
#ifndef CLI_VALUES_H
#define CLI_VALUES_H

#include "options.h"

typedef enum value_kind {
    FLAG,
    FLAG_OFF,
    NUMBER,
    WHOLE,
    TEXT,
    OUTPUT,
    THRESHOLD,
    CROP,
    KERNELS,
    ROTATE,
    PROGRESS,
    PLACING,
    VECTOR,
    AT,
    CAMERA,
    MATERIAL,
    SUPPORT,
    PUSH,
    REINFORCE,
    SOLVER
} value_kind;

typedef struct option {
    const char *name, *value; // value: its name in the help; NULL = a flag
    value_kind kind;
    option_group group;
    size_t offset;
    double least, most;
    const char *unit; // may follow the number
    const char *help;
} option;

/// The options of all verbs.
const option *option_list(int32_t *count);

/// Keep a sentence; false, for handing on.
bool wrong(char sentence[SENTENCE_BYTES], const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Set an option from its value.
///   in     text      NULL for flags; kept, not copied
///   out    sentence  what is wrong, when false comes back
bool set_option(const option *o, const char *text, settings *set, char *sentence);

#endif
