// A profile on its way from a file to a printer. Internal.
#ifndef PRINTER_PROFILE_H
#define PRINTER_PROFILE_H

#include "printer/figures.h"
#include "base/bytes.h"

#include <jansson.h>

/// A file that is built in: printers/NAME.json.
typedef struct builtin_profile {
    const char *json;
    size_t size;
} builtin_profile;

/// Made by the build (cmake/embed.cmake), in alphabetical order.
extern const int32_t builtin_count;
extern const char *const builtin_name[];         // [builtin_count]
extern const builtin_profile builtin_profiles[]; // [builtin_count]

/// Any kind of profile in our form.
///   in     name   of the file, for sentences and for a profile without a name
///   out    ours   an object; json_decref it
///   fails  JALI_BAD_INPUT, JALI_NO_MEMORY
jali_status profile_in_our_form(jali_context *ctx, const jali_bytes *file, const char *name, json_t **ours);

/// A slicer's profile in our form: its own figures, and the built-in profile it inherits the others from.
/// (import.c)
jali_status import_slicer(jali_context *ctx, const json_t *settings, const char *slicer, const char *name,
                          json_t **ours);
/// "key = value" lines, or an Orca profile, as an object of texts.
jali_status settings_of_ini(jali_context *ctx, const jali_bytes *file, const char *name, json_t **settings);
jali_status settings_of_orca(jali_context *ctx, const json_t *profile, json_t **settings);

/// What an object in our form says goes into the printer; the rest of it stays.
///   fails  JALI_BAD_INPUT (which key, what is accepted)
jali_status apply_profile(jali_context *ctx, json_t *ours, const char *name, jali_printer *printer);

#endif
