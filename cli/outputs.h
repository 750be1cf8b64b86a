// Output files: checked before any work is done, written when all of it is.
#ifndef CLI_OUTPUTS_H
#define CLI_OUTPUTS_H

#include "cli.h"

enum {
    OUTPUTS_BESIDE = 6, // figures, report, bridges, render, two maps
    MOST_LAYERS = 9,
    MOST_FILES = MOST_OUTPUTS + OUTPUTS_BESIDE + MOST_LAYERS
};

/// Suffixes the verb knows, no file named twice, none that exists (unless --force-overwrite), none the input.
///   out    sentence  what is wrong, when false comes back
bool check_outputs(const verb *v, const settings *set, char *sentence);

/// The suffix with its dot; for "-" the verb's first.
const char *suffix_of(const verb *v, const char *path);

/// A file to write and what shall be in it.
typedef struct output {
    const char *path;
    const jali_bytes *bytes;
} output;

/// Write all of them or none: every file is opened and filled before the first gets its name.
jali_status write_outputs(jali_context *ctx, const output *out, int32_t count);

/// A bitmap without the margin around it.
jali_status without_margin(jali_context *ctx, const jali_bitmap *mask, int32_t margin, jali_bitmap *picture);

/// Write the same bitmap to every output file of the settings.
jali_status write_bitmaps(jali_context *ctx, const settings *set, const jali_bitmap *bitmap, double pixel_mm);

#endif
