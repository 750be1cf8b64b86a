// From argv to settings.
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include "cli.h"
#include "base/words.h"

enum { SENTENCE_BYTES = 512 };

settings default_settings(void);

/// Read the arguments after the verb.
///   out    sentence  what is wrong, when false comes back
bool parse_options(const verb *v, int argc, char **argv, settings *set, char sentence[SENTENCE_BYTES]);

/// Set one option of some groups by its long name, as if it stood on the command line.
///   in     text   kept, not copied; flags take "true" or "false"
bool set_option_named(const char *name, const char *text, uint32_t groups, settings *set,
                      char sentence[SENTENCE_BYTES]);

/// Fill in what follows from several options together, once all are set.
void settle_options(settings *set);

/// The options a verb takes, a line each.
void print_options(const verb *v);

#endif
