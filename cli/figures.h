// Figures as JSON: the parts that several verbs write.
#ifndef CLI_FIGURES_H
#define CLI_FIGURES_H

#include "cli.h"

#include <jansson.h>

/// The key "printer": three figures for all, and which profile they are of, if of one.
json_t *printer_of(const settings *set);

/// What is said of one predicted print.
json_t *print_of(const jali_prediction *p, bool recall);

/// What of a picture is lost, tone by tone.
json_t *lost_of(const jali_lost_tone *white, const jali_lost_tone *black);

/// Append figures as text with a line end. Takes them; NULL are figures for which there was no memory.
jali_status append_json(jali_context *ctx, json_t *figures, jali_bytes *json);

#endif
