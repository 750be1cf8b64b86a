// jali calibrate: a printer's profile from widths measured on a printed reference board.
#include "outputs.h"
#include "base/bytes.h"
#include "base/file.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_TABLE_BYTES = 64 << 20 };

static jali_status gather_widths(jali_context *ctx, const settings *set, jali_widths *widths)
{
    jali_status status = JALI_OK;
    jali_bytes file = {0};
    if (set->operand) {
        TRY(file_read(ctx, set->operand, MOST_TABLE_BYTES, &file));
        TRY(jali_widths_read(ctx, file.data, file.size, set->operand, widths));
    }
    if (set->measured) TRY(jali_widths_parse(ctx, set->measured, widths));
done:
    jali_bytes_free(ctx, &file);
    return status;
}

static json_t *fitted_json(const jali_fitted *f, const char *value)
{
    if (f->kept == 0) return json_pack("{s:n, s:i, s:i}", value, "measured", f->measured, "kept", 0);
    return json_pack("{s:f, s:f, s:i, s:i}", value, f->value, "spread_mm", f->spread, "measured", f->measured,
                     "kept", f->kept);
}

static json_t *limit_json(const jali_limit *l)
{
    json_t *odd = json_array();
    for (int32_t i = 0; i < MIN(l->odd_count, JALI_ODD_WIDTHS); i++)
        json_array_append_new(odd, json_real(l->odd_mm[i]));
    return json_pack("{s:o, s:b, s:o, s:o}", "value_mm", l->found ? json_real(l->value_mm) : json_null(),
                     "bounded", l->bounded, "lost_mm", l->lost_mm > 0 ? json_real(l->lost_mm) : json_null(),
                     "out_of_order_mm", odd);
}

static json_t *width_json(const jali_width *w)
{
    static const char *const direction[] = {"horizontal", "vertical", "diagonal"};
    return json_pack("{s:s, s:s?, s:f, s:o}", "kind", jali_board_kind_name(w->kind), "direction",
                     w->direction == JALI_BOARD_ROUND ? NULL : direction[w->direction], "designed_mm",
                     w->designed_mm, "measured_mm",
                     w->measured_mm > 0 ? json_real(w->measured_mm) : json_null());
}

// docs/calibrate.md names the keys.
static jali_status calibration_json(jali_context *ctx, const jali_widths *widths, const jali_calibration *c,
                                    jali_bytes *json)
{
    jali_status status = JALI_OK;
    json_t *list = json_array();
    for (size_t i = 0; i < widths->count; i++) json_array_append_new(list, width_json(&widths->width[i]));
    json_t *root = json_pack("{s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "version", 1, "phi_e_solid",
                             fitted_json(&c->phi_e_solid, "value_mm"), "phi_e_void",
                             fitted_json(&c->phi_e_void, "value_mm"), "phi_s", limit_json(&c->phi_s), "phi_v",
                             limit_json(&c->phi_v), "hole", fitted_json(&c->hole, "value_mm2"), "pin",
                             fitted_json(&c->pin, "value_mm"), "corner_mm",
                             c->corner_mm > 0 ? json_real(c->corner_mm) : json_null(), "widths", list);
    char *text = root ? json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(10)) : NULL;
    if (!text) TRY(fail(ctx, JALI_NO_MEMORY, "no memory for the figures"));
    TRY(bytes_append(ctx, json, text, strlen(text)));
    TRY(bytes_append(ctx, json, "\n", 1));
done:
    free(text);
    json_decref(root);
    return status;
}

// The profile is called as its file, without the suffix.
static void name_profile(const settings *set, const char *path, jali_printer *printer)
{
    const char *name = strcmp(path, "-") == 0 ? "measured" : name_of(path), *dot = strrchr(name, '.');
    const char *base = *set->make.printer.name ? set->make.printer.name : NULL;
    memset(printer->name, 0, sizeof printer->name);
    snprintf(printer->name, sizeof printer->name, "%.*s", (int)(dot && dot > name ? dot - name : 63), name);
    memset(printer->what, 0, sizeof printer->what);
    snprintf(printer->what, sizeof printer->what,
             base ? "measured on a reference board; the rest from %.60s" : "measured on a reference board",
             base);
}

static jali_status tell(jali_context *ctx, const settings *set, const jali_calibration *c)
{
    jali_bytes text = {0};
    jali_status status = jali_calibration_sentences(ctx, c, &text);
    if (status == JALI_OK && text.size > 1) say(set, "%.*s", (int)text.size - 1, (const char *)text.data);
    jali_bytes_free(ctx, &text);
    return status;
}

jali_status run_calibrate(jali_context *ctx, const settings *set)
{
    jali_status status;
    jali_widths widths = {0};
    jali_calibration c;
    jali_printer printer = set->make.printer;
    jali_bytes profile = {0}, figures = {0};
    output out[MOST_OUTPUTS + 1];
    int32_t count = 0;
    TRY(gather_widths(ctx, set, &widths));
    TRY(jali_calibrate(ctx, &widths, &c));
    TRY(tell(ctx, set, &c));
    TRY(jali_calibration_apply(ctx, &c, set->operand ? name_of(set->operand) : "widths typed in", &printer));
    name_profile(set, set->output[0], &printer);
    TRY(jali_printer_write(ctx, &printer, &profile));
    for (; count < set->output_count; count++) out[count] = (output){set->output[count], &profile};
    if (set->json) {
        TRY(calibration_json(ctx, &widths, &c, &figures));
        out[count++] = (output){set->json, &figures};
    }
    TRY(write_outputs(ctx, out, count));
done:
    jali_bytes_free(ctx, &figures);
    jali_bytes_free(ctx, &profile);
    jali_widths_free(ctx, &widths);
    return status;
}
