// Carved plates under pressure against CalculiX: solids (quadratic wedges) and shells on the same geometry.
//
//     solids [--picture P] [--rows N] [--width MM] [--phi-s MM] [--phi-v MM] [--thickness MM]
//            [--across N] [--solid-across N] [--layers N] [--shells] [--judge]
//
// The picture's boundary is clamped. Compared are the largest displacement, and von Mises stresses at the
// nodes of the solids' mesh, at the outer face ("face") and the largest through the thickness ("worst"), away
// from corners of the contour and from the clamp (far_from_corners); then the largest values anywhere, raw
// and as means over the discs of the report. With --judge one line a mesh instead, and exit 1 when the
// displacement is off by more than 3 % or the stress by more than 5 %: the median of the means over discs,
// and their 95th percentile.
#include "calculix.h"
#include "fields.h"
#include "plates.h"

#include "base/base.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_ACROSS = 3 };

typedef struct plate_case {
    const char *name;
    carved_options carved;
    double thickness_mm;
    int32_t across[MOST_ACROSS];        // elements across phi_s, ours; 0 ends them
    int32_t solid_across, solid_layers; // theirs
    bool shells;                        // S6 and S3 as well
    bool judge;                         // pass or fail
} plate_case;

// What CalculiX says of a plate.
typedef struct judgement {
    jali_sheet sheet;
    calculix_answer solid;
    double shell_mm[2]; // S6 and S3, NAN: not asked
    float *mean_mpa;    // [node_count] of the solids' largest, over discs as ours
    bool *far;          // [node_count] away from corners and clamps
    int32_t far_count;
} judgement;

typedef struct comparison {
    int32_t nodes;
    double moved_mm;
    agreement face, worst, mean; // outer face; largest through the thickness; its means over discs
    double raw, peak;            // largest anywhere, raw and mean: ours over theirs
} comparison;

static const double PRESSURE_MPA = 0.001; // all is linear

static void judgement_free(jali_context *ctx, judgement *j)
{
    calculix_free(&j->solid);
    jali_sheet_free(ctx, &j->sheet);
    release(ctx, j->mean_mpa);
    release(ctx, j->far);
}

static jali_status ask_calculix(jali_context *ctx, const plate_case *c, const jali_result *carved,
                                judgement *j)
{
    jali_status status;
    double phi = c->carved.phi_s_mm;
    jali_sheet_options mesh = {phi, c->solid_across, false};
    jali_material pla = jali_analyse_defaults().material;
    *j = (judgement){.shell_mm = {NAN, NAN}};
    TRY(jali_sheet_plate(ctx, &carved->contours, &carved->chart, c->thickness_mm, &mesh, &j->sheet));
    TRY(ALLOCATE(ctx, j->far, j->sheet.node_count));
    TRY(ALLOCATE(ctx, j->mean_mpa, j->sheet.node_count));
    calculix_case peer = {.sheet = &j->sheet,
                          .kind = CALCULIX_WEDGES,
                          .layers = c->solid_layers,
                          .e_mpa = pla.e_mpa,
                          .nu = pla.nu,
                          .pressure_mpa = PRESSURE_MPA,
                          .held = JALI_BORDER_PICTURE};
    j->solid = calculix_run(&peer);
    if (!isfinite(j->solid.displacement_mm)) {
        status = fail(ctx, JALI_NO_RESULT, "CalculiX gives no answer for %s", c->name);
        goto done;
    }
    for (int k = 0; k < 2 && c->shells; k++) {
        peer.kind = k ? CALCULIX_S3 : CALCULIX_S6;
        calculix_answer shell = calculix_run(&peer);
        j->shell_mm[k] = shell.displacement_mm;
        calculix_free(&shell);
    }
    TRY(disc_means(ctx, &j->sheet, &j->solid.von_mises[0][1], 2, phi / 2, j->mean_mpa));
    far_from_corners(&j->sheet, JALI_BORDER_PICTURE, phi / 2, phi / 2, fmax(phi, c->thickness_mm / 2),
                     j->far);
    for (int32_t i = 0; i < j->sheet.node_count; i++) j->far_count += j->far[i];
done:
    return status;
}

static double largest(const float *value, int32_t stride, int32_t count)
{
    double most = 0;
    for (int32_t i = 0; i < count; i++) most = fmax(most, value[(size_t)i * stride]);
    return most;
}

// One of our fields and one of theirs at the nodes of theirs that count.
static jali_status compare_at_far(jali_context *ctx, const judgement *j, const reader *r, const float *ours,
                                  int32_t stride, const float *theirs, int32_t their_stride, agreement *a)
{
    jali_status status;
    int32_t count = 0;
    double *x = NULL, *y = NULL;
    TRY(ALLOCATE(ctx, x, j->far_count));
    TRY(ALLOCATE(ctx, y, j->far_count));
    for (int32_t i = 0; i < j->sheet.node_count; i++) {
        if (!j->far[i]) continue;
        x[count] = read_at(r, ours, stride, j->sheet.node[i][0], j->sheet.node[i][1]);
        y[count++] = theirs[(size_t)i * their_stride];
    }
    *a = compare_fields(count, x, y);
done:
    release(ctx, x);
    release(ctx, y);
    return status;
}

static jali_status compare(jali_context *ctx, const plate_case *c, const jali_result *carved, int32_t across,
                           const judgement *j, comparison *out)
{
    jali_status status;
    jali_sheet sheet = {0};
    jali_analysis ours = {0};
    reader r = {0};
    jali_sheet_options mesh = {c->carved.phi_s_mm, across, false};
    jali_analyse_options opt = jali_analyse_defaults();
    opt.load.pressure_mpa = PRESSURE_MPA;
    opt.phi_s_mm = c->carved.phi_s_mm;
    *out = (comparison){0};
    TRY(jali_sheet_plate(ctx, &carved->contours, &carved->chart, c->thickness_mm, &mesh, &sheet));
    TRY(jali_analyse(ctx, &sheet, &opt, &ours));
    r = reader_of(&sheet);
    const float *theirs = j->solid.von_mises[0];
    TRY(compare_at_far(ctx, j, &r, ours.face_mpa[0], 3, theirs, 2, &out->face));
    TRY(compare_at_far(ctx, j, &r, ours.raw_mpa, 1, theirs + 1, 2, &out->worst));
    TRY(compare_at_far(ctx, j, &r, ours.mean_mpa, 1, j->mean_mpa, 1, &out->mean));
    out->nodes = sheet.node_count;
    out->moved_mm = ours.moved.value;
    out->raw = ours.raw_stress.value / largest(theirs + 1, 2, j->sheet.node_count);
    out->peak = ours.stress.value / largest(j->mean_mpa, 1, j->sheet.node_count);
done:
    reader_free(&r);
    jali_analysis_free(ctx, &ours);
    jali_sheet_free(ctx, &sheet);
    return status;
}

static void print_head(void)
{
    printf(
        "| plate | holes | strip / thickness | nodes of solids (across, layers), CPU s | our nodes (across) "
        "| displacement | S6 | S3 | face: median | 95 %% | rms, %% | worst: median | 95 %% | rms, %% | "
        "mean: median | 95 %% | rms, %% | within 5, 10 %% | largest mean | largest raw |\n|");
    for (int i = 0; i < 20; i++) printf("---|");
    printf("\n");
}

static void print_row(const plate_case *c, const jali_result *carved, int32_t across, const judgement *j,
                      const comparison *r)
{
    printf("| %s | %d | %.3g / %.3g = %.2g | %d (%d, %d), %.0f | %d (%d) | %.3f |", c->name,
           carved->contours.contour_count - 1, c->carved.phi_s_mm, c->thickness_mm,
           c->carved.phi_s_mm / c->thickness_mm, j->solid.nodes, c->solid_across, c->solid_layers,
           j->solid.seconds, r->nodes, across, r->moved_mm / j->solid.displacement_mm);
    for (int k = 0; k < 2; k++)
        isfinite(j->shell_mm[k]) ? printf(" %.3f |", j->shell_mm[k] / j->solid.displacement_mm)
                                 : printf(" |");
    const agreement *all[] = {&r->face, &r->worst, &r->mean};
    for (int k = 0; k < 3; k++)
        printf(" %.3f | %.3f | %.1f |", all[k]->median, all[k]->p95, 100 * all[k]->rms);
    printf(" %.0f, %.0f | %.3f | %.3f |\n", 100 * r->mean.within5, 100 * r->mean.within10, r->peak, r->raw);
    fflush(stdout);
}

static bool print_verdict(const plate_case *c, const judgement *j, const comparison *r)
{
    double moved = r->moved_mm / j->solid.displacement_mm;
    bool agrees =
        fabs(moved - 1) <= 0.03 && fabs(r->mean.median - 1) <= 0.05 && fabs(r->mean.p95 - 1) <= 0.05;
    printf("%-24s displacement %.3f, stress %.3f (95 %%: %.3f) of CalculiX's solids: %s\n", c->name, moved,
           r->mean.median, r->mean.p95, agrees ? "agrees" : "DIFFERS");
    return agrees;
}

static jali_status judge_plate(jali_context *ctx, const plate_case *c, bool *agrees)
{
    jali_status status;
    jali_result carved = {0};
    judgement j = {0};
    comparison r;
    TRY(carved_plate(ctx, &c->carved, &carved));
    TRY(ask_calculix(ctx, c, &carved, &j));
    for (int k = 0; k < MOST_ACROSS && c->across[k] > 0; k++) {
        TRY(compare(ctx, c, &carved, c->across[k], &j, &r));
        if (c->judge)
            *agrees = print_verdict(c, &j, &r) && *agrees;
        else
            print_row(c, &carved, c->across[k], &j, &r);
    }
done:
    judgement_free(ctx, &j);
    jali_result_free(ctx, &carved);
    return status;
}

int main(int argc, char **argv)
{
    plate_case c = {"lattice", {"lattice", 6, 0, 0.3, 1.2}, 1, {4, 8}, 4, 2, false, false};
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
        else if (!strcmp(argv[i], "--across") && more) {
            c.across[0] = atoi(argv[++i]);
            c.across[1] = 0;
        } else if (!strcmp(argv[i], "--solid-across") && more)
            c.solid_across = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--layers") && more)
            c.solid_layers = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--shells"))
            c.shells = true;
        else if (!strcmp(argv[i], "--judge"))
            c.judge = true;
    }
    jali_context *ctx;
    if (jali_context_create(NULL, &ctx) != JALI_OK) return 1;
    if (!c.judge) print_head();
    bool agrees = true;
    jali_status status = judge_plate(ctx, &c, &agrees);
    if (status != JALI_OK) fprintf(stderr, "%s: %s\n", c.name, jali_message(ctx));
    jali_context_free(ctx);
    return status != JALI_OK || !agrees;
}
