// Carved plates under pressure against CalculiX: solids (quadratic wedges) and shells on the same geometry.
//
//     solids [--picture P] [--rows N] [--width MM] [--phi-s MM] [--phi-v MM] [--thickness MM]
//            [--across N] [--solid-across N] [--layers N] [--shells]
//
// The picture's boundary is clamped. Compared are the largest displacement, and von Mises stresses at the
// nodes of the solids' mesh, at the outer face ("face") and the largest through the thickness ("worst"), away
// from corners of the contour and from the clamp (far_from_corners); then the largest values anywhere, raw
// and as means over the discs of the report.
#include "calculix.h"
#include "fields.h"
#include "plates.h"

#include "base/base.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct solid_case {
    const char *name;
    carved_options carved;
    double thickness_mm;
    int32_t across, solid_across, layers; // elements across phi_s: ours, theirs
    bool shells;                          // S6 and S3 as well
} solid_case;

// What is compared of one plate.
typedef struct comparison {
    int32_t holes, nodes, solid_nodes;
    double moved_mm, solid_mm, shell_mm[2];
    agreement face, worst;
    double raw[2], mean[2]; // largest anywhere: ours, theirs
    double seconds, solid_seconds;
} comparison;

typedef struct work {
    jali_result carved;
    jali_sheet sheet, solid_sheet;
    jali_analysis ours;
    calculix_answer solid;
} work;

static double largest(const float *value, int32_t stride, int32_t count)
{
    double most = 0;
    for (int32_t i = 0; i < count; i++) most = fmax(most, value[(size_t)i * stride]);
    return most;
}

static jali_status compare_stresses(jali_context *ctx, const solid_case *c, const work *w, comparison *out)
{
    jali_status status;
    const jali_sheet *sheet = &w->solid_sheet;
    int32_t n = sheet->node_count, count = 0;
    double phi = c->carved.phi_s_mm;
    bool *far = NULL;
    float *mean = NULL;
    double *field[4] = {NULL};
    reader r = reader_of(&w->sheet);
    TRY(ALLOCATE(ctx, far, n));
    TRY(ALLOCATE(ctx, mean, n));
    for (int k = 0; k < 4; k++) TRY(ALLOCATE(ctx, field[k], n));
    far_from_corners(sheet, JALI_BORDER_PICTURE, phi / 2, phi / 2, fmax(phi, c->thickness_mm / 2), far);
    for (int32_t i = 0; i < n; i++) {
        if (!far[i]) continue;
        const double *at = sheet->node[i];
        field[0][count] = read_at(&r, w->ours.face_mpa[0], 3, at[0], at[1]);
        field[1][count] = w->solid.von_mises[i][0];
        field[2][count] = read_at(&r, w->ours.raw_mpa, 1, at[0], at[1]);
        field[3][count++] = w->solid.von_mises[i][1];
    }
    out->face = compare_fields(count, field[0], field[1]);
    out->worst = compare_fields(count, field[2], field[3]);
    TRY(disc_means(ctx, sheet, &w->solid.von_mises[0][1], 2, phi / 2, mean));
    out->raw[0] = w->ours.raw_stress.value;
    out->raw[1] = largest(&w->solid.von_mises[0][1], 2, n);
    out->mean[0] = w->ours.stress.value;
    out->mean[1] = largest(mean, 1, n);
done:
    reader_free(&r);
    release(ctx, far), release(ctx, mean);
    for (int k = 0; k < 4; k++) release(ctx, field[k]);
    return status;
}

static jali_status ask_calculix(jali_context *ctx, const solid_case *c, work *w, comparison *out)
{
    calculix_case peer = {.sheet = &w->solid_sheet,
                          .kind = CALCULIX_WEDGES,
                          .layers = c->layers,
                          .e_mpa = jali_analyse_defaults().material.e_mpa,
                          .nu = jali_analyse_defaults().material.nu,
                          .pressure_mpa = w->ours.pressure_mpa,
                          .held = JALI_BORDER_PICTURE};
    w->solid = calculix_run(&peer);
    if (!isfinite(w->solid.displacement_mm))
        return fail(ctx, JALI_NO_RESULT, "CalculiX gives no answer for %s", c->name);
    out->solid_mm = w->solid.displacement_mm;
    out->solid_nodes = w->solid.nodes;
    out->solid_seconds = w->solid.seconds;
    for (int k = 0; k < 2; k++) {
        out->shell_mm[k] = NAN;
        if (!c->shells) continue;
        peer.kind = k ? CALCULIX_S3 : CALCULIX_S6;
        calculix_answer shell = calculix_run(&peer);
        out->shell_mm[k] = shell.displacement_mm;
        calculix_free(&shell);
    }
    return JALI_OK;
}

static jali_status compare(jali_context *ctx, const solid_case *c, comparison *out)
{
    jali_status status;
    work w = {0};
    jali_sheet_options mesh = {c->carved.phi_s_mm, c->across, false};
    jali_analyse_options opt = jali_analyse_defaults();
    opt.load.pressure_mpa = 0.001;
    opt.phi_s_mm = c->carved.phi_s_mm;
    *out = (comparison){0};
    TRY(carved_plate(ctx, &c->carved, &w.carved));
    out->holes = w.carved.contours.contour_count - 1;
    TRY(jali_sheet_plate(ctx, &w.carved.contours, &w.carved.chart, c->thickness_mm, &mesh, &w.sheet));
    mesh.across = c->solid_across;
    TRY(jali_sheet_plate(ctx, &w.carved.contours, &w.carved.chart, c->thickness_mm, &mesh, &w.solid_sheet));
    TRY(jali_analyse(ctx, &w.sheet, &opt, &w.ours));
    out->nodes = w.sheet.node_count;
    out->moved_mm = w.ours.moved.value;
    TRY(ask_calculix(ctx, c, &w, out));
    TRY(compare_stresses(ctx, c, &w, out));
done:
    calculix_free(&w.solid);
    jali_analysis_free(ctx, &w.ours);
    jali_sheet_free(ctx, &w.sheet);
    jali_sheet_free(ctx, &w.solid_sheet);
    jali_result_free(ctx, &w.carved);
    return status;
}

static void print_head(void)
{
    printf(
        "| plate | holes | narrowest strip / thickness | nodes | CalculiX's | displacement / solids | S6 / "
        "solids | S3 / solids | face: median | 95 %% | rms, %% | within 5, 10 %% | worst: median | 95 %% | "
        "rms, %% | within 5, 10 %% | largest mean | largest raw | CPU s |\n|");
    for (int i = 0; i < 19; i++) printf("---|");
    printf("\n");
}

static void print_agreement(const agreement *a)
{
    printf(" %.3f | %.3f | %.1f | %.0f, %.0f |", a->median, a->p95, 100 * a->rms, 100 * a->within5,
           100 * a->within10);
}

static void print_row(const solid_case *c, const comparison *r)
{
    printf("| %s | %d | %.3g / %.3g = %.2g | %d (%d) | %d (%d, %d) | %.3f |", c->name, r->holes,
           c->carved.phi_s_mm, c->thickness_mm, c->carved.phi_s_mm / c->thickness_mm, r->nodes, c->across,
           r->solid_nodes, c->solid_across, c->layers, r->moved_mm / r->solid_mm);
    for (int k = 0; k < 2; k++)
        isfinite(r->shell_mm[k]) ? printf(" %.3f |", r->shell_mm[k] / r->solid_mm) : printf(" |");
    print_agreement(&r->face);
    print_agreement(&r->worst);
    printf(" %.3f | %.3f | %.0f |\n", r->mean[0] / r->mean[1], r->raw[0] / r->raw[1], r->solid_seconds);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    solid_case c = {"lattice", {"lattice", 8, 0, 0.3, 0.5}, 1, 4, 4, 2, false};
    for (int i = 1; i < argc; i++) {
        bool more = i + 1 < argc;
        if (!strcmp(argv[i], "--picture") && more)
            c.name = c.carved.picture = argv[++i];
        else if (!strcmp(argv[i], "--rows") && more)
            c.carved.rows = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--width") && more)
            c.carved.width_mm = atof(argv[++i]);
        else if (!strcmp(argv[i], "--phi-s") && more)
            c.carved.phi_s_mm = atof(argv[++i]);
        else if (!strcmp(argv[i], "--phi-v") && more)
            c.carved.phi_v_mm = atof(argv[++i]);
        else if (!strcmp(argv[i], "--thickness") && more)
            c.thickness_mm = atof(argv[++i]);
        else if (!strcmp(argv[i], "--across") && more)
            c.across = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--solid-across") && more)
            c.solid_across = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--layers") && more)
            c.layers = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--shells"))
            c.shells = true;
    }
    jali_context *ctx;
    if (jali_context_create(NULL, &ctx) != JALI_OK) return 1;
    comparison result;
    print_head();
    jali_status status = compare(ctx, &c, &result);
    if (status == JALI_OK)
        print_row(&c, &result);
    else
        fprintf(stderr, "%s: %s\n", c.name, jali_message(ctx));
    jali_context_free(ctx);
    return status != JALI_OK;
}
