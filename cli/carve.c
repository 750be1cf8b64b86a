// jali carve PICTURE and jali adapt PICTURE: the whole pipeline, or its image stages alone; one picture on a
// plate, or one or more on a surface.
#include "layers.h"
#include "outputs.h"
#include "structure.h"
#include "base/bytes.h"

#include <stdio.h>

// The parameters that make the object again, for those who find it later.
static jali_status describe(jali_context *ctx, const settings *set, const jali_result *r, jali_bytes *text)
{
    const jali_optimise_options *printer = &set->make.optimise;
    double pixel_mm = jali_chart_pixel_mm(&r->chart);
    char words[500];
    snprintf(words, sizeof words,
             "jali %s: %.4g x %.4g mm, %s%sphi %g / %g / %g mm, frame %g mm, thickness %g mm%s%s%.100s",
             jali_version(), (r->chart.width_px - 2 * r->chart.margin_px) * pixel_mm,
             (r->chart.height_px - 2 * r->chart.margin_px) * pixel_mm, set->make.printer.name,
             *set->make.printer.name ? ", " : "", printer->phi_e_mm, printer->phi_s_mm, printer->phi_v_mm,
             set->make.place.frame_mm, set->surface ? set->wall.thickness_mm : set->make.carve.thickness_mm,
             printer->paper ? ", the paper's method" : "", set->surface ? ", surface " : "",
             set->surface ? set->surface : "");
    return bytes_append(ctx, text, words, strlen(words) + 1);
}

static jali_status make_bytes(jali_context *ctx, const made *m, const char *path, jali_bytes *bytes)
{
    jali_status status;
    const settings *set = &m->set[0];
    const jali_result *r = &m->result[0];
    jali_bytes parameters = {0};
    jali_bitmap picture = {0};
    jali_format format = strcmp(path, "-") != 0 ? jali_format_of(path)
                         : set->make.solid      ? JALI_FORMAT_3MF
                                                : JALI_FORMAT_PNG;
    jali_product product = {.pixel_mm = jali_chart_pixel_mm(&r->chart)};
    jali_write_options opt = jali_write_defaults();
    bool flat = format == JALI_FORMAT_PNG || format == JALI_FORMAT_SVG || format == JALI_FORMAT_DXF;
    if (flat && m->count > 1)
        return fail(ctx, JALI_BAD_VALUE,
                    "%s shows one picture and the job has %d; 3MF and STL are there to hold them all", path,
                    m->count);
    TRY(describe(ctx, set, r, &parameters));
    if (format == JALI_FORMAT_PNG) TRY(without_margin(ctx, &r->optimised.mask, r->chart.margin_px, &picture));
    opt.title = name_of(set->operand);
    opt.parameters = (const char *)parameters.data;
    product.mesh = &m->object.mesh;
    product.contours = &r->contours;
    product.bitmap = &picture;
    TRY(jali_write_bytes(ctx, format, &product, &opt, bytes));
done:
    jali_bitmap_free(ctx, &picture);
    jali_bytes_free(ctx, &parameters);
    return status;
}

// The bridges that were laid, as edits that would draw them again.
static jali_status bridges_json(jali_context *ctx, const made *m, jali_bytes *json)
{
    jali_status status;
    jali_edits edits = {0};
    const jali_result *r = &m->result[0];
    if (m->count > 1)
        return fail(ctx, JALI_BAD_VALUE, "%s holds the bridges of one picture, and the job has %d",
                    m->set[0].bridges, m->count);
    TRY(jali_edits_of_bridges(ctx, &r->optimised.laid, &r->chart, r->optimised.kernels_px[1], &m->picture[0],
                              &m->set[0].read, MAX(m->set[0].make.repeat, 1), &edits));
    TRY(jali_edits_write(ctx, &edits, json));
done:
    jali_edits_free(ctx, &edits);
    return status;
}

/// What is written, filled in one after the other.
typedef struct shelf {
    int32_t count;
    jali_bytes bytes[MOST_FILES];
    output out[MOST_FILES];
} shelf;

// The next place on the shelf, for a file of this name.
static jali_bytes *place_for(shelf *s, const char *path)
{
    s->out[s->count] = (output){path, &s->bytes[s->count]};
    return &s->bytes[s->count++];
}

static jali_status write_everything(jali_context *ctx, const settings *set, const made *m)
{
    jali_status status = JALI_OK;
    shelf s = {0};
    int32_t layer_count;
    const layer *each = layer_list(&layer_count);
    for (int32_t i = 0; i < set->output_count; i++)
        TRY(make_bytes(ctx, m, set->output[i], place_for(&s, set->output[i])));
    if (set->json) TRY(figures_json(ctx, m, place_for(&s, set->json)));
    if (set->report) TRY(report_html(ctx, m, place_for(&s, set->report)));
    if (set->bridges) TRY(bridges_json(ctx, m, place_for(&s, set->bridges)));
    if (set->render)
        TRY(render_png(ctx, &m->object.mesh, &set->view, set->size_px, place_for(&s, set->render)));
    if (set->map) TRY(map_bytes(ctx, &m->result[0], set->map, JALI_STRESS, place_for(&s, set->map)));
    if (set->moved_map)
        TRY(map_bytes(ctx, &m->result[0], set->moved_map, JALI_DISPLACEMENT, place_for(&s, set->moved_map)));
    for (int32_t i = 0; i < layer_count; i++)
        if (set->layers >> i & 1) TRY(each[i].bytes(ctx, m, place_for(&s, each[i].name)));
    TRY(write_outputs(ctx, s.out, s.count));
done:
    for (int32_t i = 0; i < s.count; i++) jali_bytes_free(ctx, &s.bytes[i]);
    return status;
}

// A pixel of the mask as one of the picture.
static void in_picture(const jali_picture *picture, const jali_result *r, const int32_t at[2], int32_t px[2])
{
    const jali_chart *chart = &r->chart;
    px[0] = MAX(0, jali_input_column(chart, picture->width_px, at[0], 1));
    px[1] = MAX(0, jali_input_row(chart, picture->height_px, at[1], 1));
}

static void tell_edits(const settings *set, const jali_picture *picture, const jali_result *r)
{
    const jali_edited *e = &r->optimised.edited;
    int32_t px[2];
    if (!set->edits) return;
    say(set, "by hand: %d drawn, %d forbidden, %d locked", e->count[JALI_EDIT_BRIDGE],
        e->count[JALI_EDIT_FORBID], e->count[JALI_EDIT_LOCK]);
    in_picture(picture, r, e->left_out_at, px);
    if (e->left_out > 0)
        say(set,
            "%d part%s cannot be joined but through what is forbidden or locked and %s left out, the first "
            "at "
            "(%d, %d) px of the picture",
            e->left_out, e->left_out == 1 ? "" : "s", e->left_out == 1 ? "is" : "are", px[0], px[1]);
    in_picture(picture, r, e->loose_at, px);
    if (e->loose > 0)
        say(set,
            "%d locked or drawn part%s loose, for no bridge may reach %s, the first at (%d, %d) px of the "
            "picture",
            e->loose, e->loose == 1 ? " is" : "s are", e->loose == 1 ? "it" : "them", px[0], px[1]);
    if (e->locked_details > 0)
        say(set, "%d detail%s in what is locked %s below the printer's widths", e->locked_details,
            e->locked_details == 1 ? "" : "s", e->locked_details == 1 ? "is" : "are");
}

static void tell_picture(const settings *set, const jali_picture *picture, const jali_result *r)
{
    if (set->surface && r->placed.placing == JALI_PLACE_PROJECT)
        say(set, "projected around (%.4g, %.4g, %.4g) mm, seen along (%.3g, %.3g, %.3g)",
            r->placed.centre_mm[0], r->placed.centre_mm[1], r->placed.centre_mm[2], r->placed.direction[0],
            r->placed.direction[1], r->placed.direction[2]);
    if (set->surface)
        say(set, "a mm of the picture is %.3g to %.3g mm on the surface", r->placed.stretch[0],
            r->placed.stretch[1]);
    if (set->surface && r->wall_mm < set->make.optimise.phi_s_mm)
        say(set, "the wall under the picture is %.3g mm thin, less than phi_s, %g mm", r->wall_mm,
            set->make.optimise.phi_s_mm);
    say(set, "%d x %d px in %d white piece%s; %d bridge%s laid", picture->width_px, picture->height_px,
        r->input_pieces, r->input_pieces == 1 ? "" : "s", r->optimised.bridges,
        r->optimised.bridges == 1 ? "" : "s");
    tell_edits(set, picture, r);
    if (set->make.nudge_rounds)
        say(set, "nudged in %d round%s: %.2f %% of the predicted print wrong before, %.2f %% after",
            r->nudge.rounds, r->nudge.rounds == 1 ? "" : "s", 100 * r->nudge.error_before,
            100 * r->nudge.error_after);
    if (set->make.predict)
        say(set, "predicted print: %.2f %% of it wrong (%.2f %% when only connected), %d piece%s",
            100 * r->result_print.error_rate, 100 * r->connected_print.error_rate, r->result_print.pieces,
            r->result_print.pieces == 1 ? "" : "s");
    if (set->make.structure && set->make.optimise.phi_e_mm < 0)
        say(set, "the load is borne by bars as they are drawn; the kerf leaves them %g mm narrower",
            -set->make.optimise.phi_e_mm);
    tell_structure(set, &r->strength);
}

static void tell(jali_context *ctx, const made *m)
{
    const settings *set = &m->set[0];
    const jali_shell_report *wall = &m->object.wall;
    double seconds = 0;
    for (int32_t i = 0; i < m->count; i++) {
        if (m->count > 1) say(set, "%s:", m->set[i].operand);
        tell_picture(&m->set[i], &m->picture[i], &m->result[i]);
        for (int32_t k = 0; k < JALI_STAGES; k++) seconds += m->result[i].seconds[k];
    }
    for (int32_t k = 0; k < JALI_STAGES; k++) seconds += m->object.seconds[k];
    if (set->surface && wall->thinned > 0)
        say(set,
            "the wall is thinner than %g mm at %d places of the surface, %.3g mm at (%.4g, %.4g, %.4g) mm",
            set->wall.thickness_mm, wall->thinned, wall->thinnest_mm, wall->thinnest_at_mm[0],
            wall->thinnest_at_mm[1], wall->thinnest_at_mm[2]);
    if (set->surface && wall->full_triangles > 0)
        say(set,
            "the wall is left full around %d triangles of the surface, where none would do, as at (%.4g, "
            "%.4g, "
            "%.4g) mm",
            wall->full_triangles, wall->full_at_mm[0], wall->full_at_mm[1], wall->full_at_mm[2]);
    if (set->surface && wall->thinned > wall->vertices / 4)
        say(set, "much of it has no room for that wall: a model that is a thin wall already is better given "
                 "by its "
                 "outer skin alone");
    if (set->make.solid && set->make.check)
        say(set, "%d triangles, %.4g cm3, %s", m->object.mesh.triangle_count,
            m->object.check.volume_mm3 / 1000, m->object.closed ? "closed and manifold" : "not a solid");
    say(set, "%.2f s, %.0f MB", seconds, (double)jali_peak_memory_bytes(ctx) / 1e6);
}

bool sound_of(const made *m)
{
    for (int32_t i = 0; i < m->count; i++)
        if (m->set[i].make.structure && !m->result[i].strength.sound) return false;
    return true;
}

static jali_status keep_promises(jali_context *ctx, const made *m)
{
    bool closed = !m->set[0].make.solid || !m->set[0].make.check || m->object.closed, printable = true;
    bool by_hand = false;
    for (int32_t i = 0; i < m->count; i++) {
        printable &= m->result[i].printable;
        by_hand |=
            m->result[i].optimised.edited.loose > 0 || m->result[i].optimised.edited.locked_details > 0;
    }
    if (m->object.one_piece && printable && closed && sound_of(m)) return JALI_OK;
    return fail(ctx, JALI_BROKEN, "done, but a promise is not kept:%s%s%s%s%s",
                m->object.one_piece ? "" : " it is not one piece;",
                printable ? "" : " some details are below the printer's widths;",
                closed ? "" : " the mesh is not a solid;", sound_of(m) ? "" : " it does not bear the load;",
                by_hand ? " what was locked or drawn by hand stays as it is;" : "");
}

// A plate is an object with one picture.
static jali_status make_plate(jali_context *ctx, made *m)
{
    jali_result *r = &m->result[0];
    jali_status status = jali_make(ctx, &m->picture[0], &m->set[0].make, r);
    if (status != JALI_OK) return status;
    m->object.mesh = r->mesh;
    m->object.check = r->check;
    m->object.one_piece = r->one_piece;
    m->object.closed = r->closed;
    r->mesh = (jali_mesh){0};
    return JALI_OK;
}

// What was wrong with a model, and what was put right.
static jali_status tell_surface(jali_context *ctx, const settings *set, const jali_surface_report *report)
{
    jali_bytes text = {0};
    jali_status status = jali_surface_sentences(ctx, report, &text);
    if (status == JALI_OK && text.size > 1) say(set, "%.*s", (int)text.size - 1, (const char *)text.data);
    jali_bytes_free(ctx, &text);
    return status;
}

static jali_status make_surface(jali_context *ctx, const settings *set, made *m)
{
    jali_status status;
    jali_surface surface = {0};
    jali_surface_report report = {0};
    jali_options *opt = NULL;
    TRY(ALLOCATE(ctx, opt, m->count));
    TRY(jali_surface_open(ctx, set->surface, NULL, &surface, &report));
    surface.faulty = report.faulty;
    report.faulty = NULL;
    TRY(tell_surface(ctx, set, &report));
    for (int32_t i = 0; i < m->count; i++) {
        opt[i] = m->set[i].make;
        if (opt[i].place.placing == JALI_PLACE_AUTO &&
            report.file_triangles > 0) // its texture is no unrolling
            opt[i].place.placing = JALI_PLACE_PROJECT;
    }
    TRY(jali_make_on(ctx, &surface, &set->wall, m->picture, opt, m->count, m->result, &m->object));
done:
    jali_surface_report_free(ctx, &report);
    jali_surface_free(ctx, &surface);
    release(ctx, opt);
    return status;
}

static void made_free(jali_context *ctx, made *m)
{
    for (int32_t i = 0; i < m->count; i++) {
        if (m->result) jali_result_free(ctx, &m->result[i]);
        if (m->picture) jali_picture_free(ctx, &m->picture[i]);
        if (m->edits) jali_edits_free(ctx, &m->edits[i]);
    }
    release(ctx, m->result);
    release(ctx, m->picture);
    release(ctx, m->edits);
    release(ctx, m->set);
    jali_object_free(ctx, &m->object);
    *m = (made){0};
}

// A picture and what was laid down on it by hand.
static jali_status load_with_edits(jali_context *ctx, settings *set, jali_picture *picture, jali_edits *edits)
{
    jali_status status;
    TRY(load_picture(ctx, set, picture));
    if (!set->edits) return JALI_OK;
    TRY(jali_edits_read(ctx, set->edits, edits));
    TRY(jali_edits_follow(ctx, &set->read, picture->file_px, edits));
    set->make.optimise.edits = edits;
done:
    return status;
}

// One picture from the command line, or those of a job.
static jali_status collect(jali_context *ctx, settings *set, bool solid, job *j, made *m)
{
    jali_status status = JALI_OK;
    if (set->job) TRY(load_job(ctx, set, j));
    m->count = set->job ? j->count : 1;
    TRY(ALLOCATE(ctx, m->set, m->count));
    TRY(ALLOCATE_CLEARED(ctx, m->picture, m->count));
    TRY(ALLOCATE_CLEARED(ctx, m->edits, m->count));
    TRY(ALLOCATE_CLEARED(ctx, m->result, m->count));
    for (int32_t i = 0; i < m->count; i++) {
        m->set[i] = set->job ? j->each[i] : *set;
        m->set[i].surface = set->surface;
        m->set[i].wall = set->wall;
        m->set[i].make.solid = solid;
        m->set[i].make.optimise.details = set->report || set->json || layers_need_details(set->layers);
        TRY(load_with_edits(ctx, &m->set[i], &m->picture[i], &m->edits[i]));
    }
done:
    if (status != JALI_OK && !m->set) m->count = 0;
    return status;
}

static jali_status make(jali_context *ctx, const settings *given, bool solid)
{
    jali_status status;
    settings set = *given;
    made m = {0};
    job j = {0};
    bool on_surface;
    TRY(collect(ctx, &set, solid, &j, &m));
    on_surface = set.surface && strcmp(set.surface, "plate") != 0;
    if (!on_surface)
        for (int32_t i = 0; i < m.count; i++) m.set[i].surface = NULL;
    if (!on_surface && m.count > 1)
        TRY(fail(ctx, JALI_BAD_VALUE, "a plate takes one picture; several need a surface"));
    TRY(on_surface ? make_surface(ctx, &set, &m) : make_plate(ctx, &m));
    TRY(write_everything(ctx, &set, &m));
    tell(ctx, &m);
    status = keep_promises(ctx, &m);
done:
    made_free(ctx, &m);
    job_free(ctx, &j);
    return status;
}

jali_status run_carve(jali_context *ctx, const settings *set)
{
    return make(ctx, set, true);
}

// As it is: no connectors, no matter whether it holds.
jali_status analyse_picture(jali_context *ctx, const settings *given)
{
    settings set = *given;
    set.make.strengthen.reinforce.rule = JALI_REINFORCE_NONE;
    set.make.check = false;
    return make(ctx, &set, true);
}

jali_status run_adapt(jali_context *ctx, const settings *set)
{
    return make(ctx, set, false);
}
