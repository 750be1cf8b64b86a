// jali calibrate: a printer's profile from widths measured on a printed reference board.
#include "outputs.h"
#include "base/bytes.h"
#include "base/file.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_TABLE_BYTES = 64 << 20 };

// A picture that was measured. {0} is valid and empty.
typedef struct measured_scan {
    jali_picture picture;
    jali_scan scan;
} measured_scan;

static jali_status measure_scan(jali_context *ctx, const settings *set, measured_scan *m)
{
    jali_status status;
    jali_board board = {0};
    jali_scan_options opt = {.dpi = set->dpi};
    if (!isnan(set->phi_given_mm[1]) || !isnan(set->phi_given_mm[2])) {
        jali_board_options which = set->board;
        which.phi_s_mm = set->make.optimise.phi_s_mm;
        which.phi_v_mm = set->make.optimise.phi_v_mm;
        TRY(jali_board_layout(ctx, &which, &board));
        opt.board = &board;
    }
    TRY(jali_read(ctx, set->scan, NULL, &m->picture));
    TRY(jali_scan_board(ctx, &m->picture, &opt, &m->scan));
done:
    jali_board_free(ctx, &board);
    return status;
}

static void tell_scan(const settings *set, const jali_scan *s)
{
    say(set,
        "board for phi_s %g, phi_v %g mm%s, turned by %.1f degrees%s; %.3f mm a pixel, blurred by %.3f mm",
        s->board.phi_s_mm, s->board.phi_v_mm, s->code_read ? "" : " (its code cannot be read)", s->turn_deg,
        s->mirrored ? ", seen from behind" : "", s->pixel_mm, s->blur_mm);
    if (set->dpi > 0)
        say(set, "the print is %+.2f %% along x and %+.2f %% along y against the drawing",
            100 * (s->scale[0] - 1), 100 * (s->scale[1] - 1));
}

static jali_status gather_widths(jali_context *ctx, const settings *set, measured_scan *m,
                                 jali_widths *widths)
{
    jali_status status = JALI_OK;
    jali_bytes file = {0};
    if (set->operand) {
        TRY(file_read(ctx, set->operand, MOST_TABLE_BYTES, &file));
        TRY(jali_widths_read(ctx, file.data, file.size, set->operand, widths));
    }
    if (set->measured) TRY(jali_widths_parse(ctx, set->measured, widths));
    if (set->scan) {
        TRY(measure_scan(ctx, set, m));
        TRY(jali_scan_widths(ctx, &m->scan, widths));
    }
done:
    jali_bytes_free(ctx, &file);
    return status;
}

static json_t *fitted_json(const jali_fitted *f, const char *value)
{
    if (f->kept == 0) return json_pack("{s:n, s:i, s:i}", value, "measured", f->measured, "kept", 0);
    json_t *error = f->error_mm > 0 ? json_real(f->error_mm) : json_null();
    return json_pack("{s:f, s:f, s:o, s:b, s:i, s:i}", value, f->value, "spread_mm", f->spread, "error_mm",
                     error, "doubtful", f->doubtful, "measured", f->measured, "kept", f->kept);
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

static json_t *scan_json(const jali_scan *s)
{
    return json_pack("{s:b, s:b, s:b, s:f, s:f, s:f, s:f, s:f, s:[f,f]}", "code_read", s->code_read,
                     "mirrored", s->mirrored, "dark_voids", s->dark, "turn_deg", s->turn_deg, "pixel_mm",
                     s->pixel_mm, "blur_mm", s->blur_mm, "contrast", s->contrast, "residual_mm",
                     s->residual_mm, "scale", s->scale[0], s->scale[1]);
}

// docs/calibrate.md names the keys.
static jali_status calibration_json(jali_context *ctx, const settings *set, const jali_scan *scan,
                                    const jali_widths *widths, const jali_calibration *c, jali_bytes *json)
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
    if (root && set->scan) json_object_set_new(root, "scan", scan_json(scan));
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

static const char *source_of(const settings *set)
{
    return set->scan ? name_of(set->scan) : set->operand ? name_of(set->operand) : "widths typed in";
}

static jali_status check_sources(jali_context *ctx, const settings *set)
{
    if (set->scan && (set->operand || set->measured))
        return fail(ctx, JALI_BAD_VALUE,
                    "widths come from a scan or are given: both at once would count twice");
    if (!set->scan && (set->map || set->dpi > 0))
        return fail(ctx, JALI_BAD_VALUE, "--map and --dpi belong to a scan (--scan FILE)");
    if (set->map && jali_format_of(set->map) != JALI_FORMAT_PNG)
        return fail(ctx, JALI_BAD_VALUE, "%.100s: the map of a calibration is a .png", set->map);
    return JALI_OK;
}

jali_status run_calibrate(jali_context *ctx, const settings *set)
{
    jali_status status;
    measured_scan m = {0};
    jali_widths widths = {0};
    jali_calibration c;
    jali_printer printer = set->make.printer;
    jali_bytes profile = {0}, figures = {0}, map = {0};
    output out[MOST_OUTPUTS + 2];
    int32_t count = 0;
    TRY(check_sources(ctx, set));
    TRY(gather_widths(ctx, set, &m, &widths));
    TRY(jali_calibrate(ctx, &widths, &c));
    c.corner_mm = m.scan.corner_mm;
    c.corners = m.scan.corners;
    TRY(jali_calibration_apply(ctx, &c, source_of(set), &printer));
    if (set->scan) tell_scan(set, &m.scan);
    TRY(tell(ctx, set, &c));
    name_profile(set, set->output[0], &printer);
    TRY(jali_printer_write(ctx, &printer, &profile));
    for (; count < set->output_count; count++) out[count] = (output){set->output[count], &profile};
    if (set->json) {
        TRY(calibration_json(ctx, set, &m.scan, &widths, &c, &figures));
        out[count++] = (output){set->json, &figures};
    }
    if (set->map) {
        TRY(jali_scan_map(ctx, &m.picture, &m.scan, &map));
        out[count++] = (output){set->map, &map};
    }
    TRY(write_outputs(ctx, out, count));
done:
    jali_bytes_free(ctx, &map);
    jali_bytes_free(ctx, &figures);
    jali_bytes_free(ctx, &profile);
    jali_widths_free(ctx, &widths);
    jali_scan_free(ctx, &m.scan);
    jali_picture_free(ctx, &m.picture);
    return status;
}
