// The figures of a run as JSON, version 1. Keys are kept; new ones may come.
#include "figures.h"
#include "structure.h"
#include "base/bytes.h"

#include <stdlib.h>

static json_t *types_of(const int32_t count[JALI_TYPES])
{
    return json_pack("{s:i, s:i, s:i}", "A", count[JALI_TYPE_A], "B", count[JALI_TYPE_B], "C",
                     count[JALI_TYPE_C]);
}

static json_t *round_of(const jali_round *r)
{
    return json_pack("{s:o, s:o, s:i}", "white", types_of(r->white), "black", types_of(r->black), "conflicts",
                     r->conflicts);
}

static json_t *adapt_of(const jali_optimised *o)
{
    json_t *rounds = json_array();
    for (int32_t i = 0; i < o->round_count; i++) json_array_append_new(rounds, round_of(&o->round[i]));
    return json_pack("{s:i, s:b, s:o, s:{s:o, s:o}}", "iterations", o->round_count, "cycled", o->cycled,
                     "rounds", rounds, "residual", "white", types_of(o->residual.white), "black",
                     types_of(o->residual.black));
}

json_t *print_of(const jali_prediction *p, bool recall)
{
    json_t *print = json_pack("{s:f, s:i}", "error_rate", p->error_rate, "pieces", p->pieces);
    if (recall) {
        json_object_set_new(print, "recall_white", json_real(p->recall_white));
        json_object_set_new(print, "recall_black", json_real(p->recall_black));
    }
    return print;
}

static json_t *predict_of(const settings *set, const jali_result *r)
{
    bool recall = set->make.recall;
    if (!set->make.predict) return json_null();
    json_t *lost =
        recall && r->lost.where.width_px > 0 ? lost_of(&r->lost.white, &r->lost.black) : json_null();
    return json_pack("{s:f, s:f, s:f, s:o, s:o, s:o, s:o}", "error_rate_input", r->input_print.error_rate,
                     "error_rate_connected", r->connected_print.error_rate, "error_rate_result",
                     r->result_print.error_rate, "input", print_of(&r->input_print, recall), "connected",
                     print_of(&r->connected_print, recall), "result", print_of(&r->result_print, recall),
                     "lost", lost);
}

static json_t *mesh_of(const made *m)
{
    const jali_object *r = &m->object;
    if (!m->set[0].make.solid) return json_null();
    return json_pack("{s:i, s:i, s:i, s:b, s:b, s:I, s:f}", "vertices", r->mesh.vertex_count, "triangles",
                     r->mesh.triangle_count, "components", r->check.pieces, "watertight", r->check.closed,
                     "manifold", r->check.manifold, "self_intersections",
                     (json_int_t)r->check.intersections.count, "volume_mm3", r->check.volume_mm3);
}

static json_t *seconds_of(const made *m)
{
    json_t *seconds = json_object();
    double total = 0;
    for (int32_t i = 0; i < JALI_STAGES; i++) {
        double stage = m->object.seconds[i];
        for (int32_t k = 0; k < m->count; k++) stage += m->result[k].seconds[i];
        json_object_set_new(seconds, jali_stage_name(i), json_real(stage));
        total += stage;
    }
    json_object_set_new(seconds, "total", json_real(total));
    return seconds;
}

static json_t *promises_of(const made *m)
{
    bool printable = true;
    for (int32_t i = 0; i < m->count; i++) printable &= m->result[i].printable;
    return json_pack("{s:b, s:b, s:o, s:o}", "one_piece", m->object.one_piece, "printable", printable,
                     "closed", m->set[0].make.solid ? json_boolean(m->object.closed) : json_null(), "sound",
                     m->set[0].make.structure ? json_boolean(sound_of(m)) : json_null());
}

static json_t *nudge_of(const settings *set, const jali_nudge_report *n)
{
    if (!set->make.nudge_rounds) return json_null();
    return json_pack("{s:i, s:f, s:f, s:I}", "rounds", n->rounds, "error_rate_before", n->error_before,
                     "error_rate_after", n->error_after, "changed_px", (json_int_t)n->changed_px);
}

json_t *printer_of(const settings *set)
{
    const jali_optimise_options *phi = &set->make.optimise;
    const jali_printer *p = &set->make.printer;
    json_t *printer = json_pack("{s:f, s:f, s:f}", "phi_e_mm", phi->phi_e_mm, "phi_s_mm", phi->phi_s_mm,
                                "phi_v_mm", phi->phi_v_mm);
    if (!*p->name) return printer;
    json_t *own =
        json_pack("{s:s, s:s, s:f, s:f, s:f, s:f}", "name", p->name, "process", jali_process_name(p->process),
                  "phi_e_solid_mm", p->phi_e_solid_mm.value, "phi_e_void_mm", p->phi_e_void_mm.value,
                  "hole_mm2", p->hole_mm2.value, "corner_mm", p->corner_mm.value);
    if (own) json_object_update(own, printer);
    json_decref(printer);
    return own;
}

// What came of the edits by hand.
static json_t *edits_of(const settings *set, const jali_edited *e)
{
    if (!set->edits) return json_null();
    return json_pack("{s:i, s:i, s:i, s:i, s:i, s:i}", "bridges", e->count[JALI_EDIT_BRIDGE], "forbidden",
                     e->count[JALI_EDIT_FORBID], "locked", e->count[JALI_EDIT_LOCK], "left_out", e->left_out,
                     "loose", e->loose, "locked_details", e->locked_details);
}

static json_t *vector_of(const double v[3])
{
    return json_pack("[f, f, f]", v[0], v[1], v[2]);
}

// Where a picture lies on the surface.
static json_t *place_of(const jali_result *r)
{
    const jali_placed *p = &r->placed;
    bool wrapped = p->placing == JALI_PLACE_WRAP;
    return json_pack("{s:s, s:o, s:o, s:[f, f], s:f}", "placing", wrapped ? "wrap" : "project", "centre_mm",
                     vector_of(p->centre_mm), "direction", wrapped ? json_null() : vector_of(p->direction),
                     "stretch", p->stretch[0], p->stretch[1], "wall_mm", r->wall_mm);
}

static json_t *surface_of(const made *m)
{
    const settings *set = &m->set[0];
    const jali_shell_report *wall = &m->object.wall;
    if (!set->surface) return json_null();
    return json_pack("{s:s, s:f, s:f, s:o, s:i, s:i}", "name", set->surface, "thickness_mm",
                     set->wall.thickness_mm, "thinnest_mm", wall->thinnest_mm, "thinnest_at_mm",
                     vector_of(wall->thinnest_at_mm), "thinned", wall->thinned, "full_triangles",
                     wall->full_triangles);
}

// What is said of each picture. A part that could not be made leaves the whole unmade: jansson's "o" of NULL
// gives NULL.
static json_t *picture_of(const settings *set, const jali_picture *picture, const jali_result *r)
{
    double pixel_mm = jali_chart_pixel_mm(&r->chart);
    int32_t columns = r->chart.width_px - 2 * r->chart.margin_px,
            rows = r->chart.height_px - 2 * r->chart.margin_px;
    const int32_t *kernel = r->optimised.kernels_px;
    return json_pack(
        "{s:{s:i, s:i, s:i, s:i}, s:[f, f], s:[i, i], s:f, s:o, s:o, s:{s:i, s:i, s:i},"
        " s:{s:i, s:I, s:i}, s:o, s:o, s:o, s:o, s:o}",
        "input", "width_px", picture->width_px, "height_px", picture->height_px, "white_components",
        r->input_pieces, "threshold", r->threshold, "size_mm", columns * pixel_mm, rows * pixel_mm, "grid_px",
        columns, rows, "pixel_mm", pixel_mm, "place", set->surface ? place_of(r) : json_null(), "printer",
        printer_of(set), "kernels_px", "omega_c", kernel[0], "omega_w", kernel[1], "omega_b", kernel[2],
        "connect", "bridges", r->optimised.bridges, "pixels", (json_int_t)r->optimised.bridge_pixels,
        "pieces_dropped", r->optimised.pieces_dropped, "edits", edits_of(set, &r->optimised.edited), "adapt",
        adapt_of(&r->optimised), "nudge", nudge_of(set, &r->nudge), "predict", predict_of(set, r),
        "structure", structure_of(set, &r->strength));
}

static json_t *tone_of(const jali_lost_tone *tone)
{
    return json_pack("{s:i, s:i}", "parts", tone->parts, "stretches", tone->stretches);
}

json_t *lost_of(const jali_lost_tone *white, const jali_lost_tone *black)
{
    return json_pack("{s:o, s:o}", "white", tone_of(white), "black", tone_of(black));
}

// The first picture's figures stand at the top; a job lists all of them as "pictures" too.
static json_t *figures_of(jali_context *ctx, const made *m)
{
    json_t *figures = picture_of(&m->set[0], &m->picture[0], &m->result[0]);
    json_t *object = json_pack("{s:i, s:o, s:o, s:o, s:o, s:f}", "version", 1, "surface", surface_of(m),
                               "mesh", mesh_of(m), "promises", promises_of(m), "seconds", seconds_of(m),
                               "peak_memory_mb", (double)jali_peak_memory_bytes(ctx) / 1e6);
    if (figures && object && m->count > 1) {
        json_t *pictures = json_array();
        for (int32_t i = 0; i < m->count; i++)
            json_array_append_new(pictures, picture_of(&m->set[i], &m->picture[i], &m->result[i]));
        json_object_set_new(figures, "pictures", pictures);
    }
    if (object && json_object_update(object, figures) == 0) {
        json_decref(figures);
        return object;
    }
    json_decref(figures);
    json_decref(object);
    return NULL;
}

jali_status append_json(jali_context *ctx, json_t *figures, jali_bytes *json)
{
    char *text = figures ? json_dumps(figures, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    jali_status status =
        text ? bytes_print(ctx, json, "%s\n", text) : fail(ctx, JALI_NO_MEMORY, "no memory for the figures");
    free(text);
    json_decref(figures);
    return status;
}

jali_status figures_json(jali_context *ctx, const made *m, jali_bytes *json)
{
    return append_json(ctx, figures_of(ctx, m), json);
}
