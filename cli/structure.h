// What is said and drawn of the structure.
#ifndef CLI_STRUCTURE_H
#define CLI_STRUCTURE_H

#include "cli.h"

#include <jansson.h>

/// Carve a picture and analyse it.
jali_status analyse_picture(jali_context *ctx, const settings *set);

/// How a map of it is drawn.
jali_map_options map_of(const jali_strength *s, jali_quantity quantity);

/// Can a map be written under this name?
bool is_map(const char *path);

/// A map of a picture's structure, in the format of the path's suffix; appended.
jali_status map_bytes(jali_context *ctx, const jali_result *r, const char *path, jali_quantity quantity,
                      jali_bytes *bytes);

void tell_structure(const settings *set, const jali_strength *s);

/// The key "structure" of the figures; null without a load.
json_t *structure_of(const settings *set, const jali_strength *s);

/// The report's part; nothing without a load.
jali_status append_structure(jali_context *ctx, const settings *set, const jali_result *r, jali_bytes *html);

/// A picture in the report.
jali_status append_figure(jali_context *ctx, const jali_bytes *png, const char *title, const char *legend,
                          jali_bytes *html);

#endif
