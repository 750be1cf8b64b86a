// What a slicer makes of the pictures (docs/compare.md): error of connected only and of optimised plates, by
// our model and by PrusaSlicer's output.
//
//     slicer [DATA_FOLDER] [--only NAME] [--runs FIRST,LAST] [--own]
//            [--maps FOLDER] [--limit SECONDS] [--sla] [--halves] [--voids MM] [--exact]
//     slicer --bars
//
// Plates are 1 mm thick: the layers of a plate are all alike. They are made for phi 0.1 / 0.3 / 0.5 mm, the
// paper's FDM and SLA printers. The slicer's output holds no physical growth; "printed" adds it (voids below
// phi_v close, edges grow by phi_e / 2). --own also makes plates for the slicer itself, with what --bars
// measures of it; --sla leaves FDM out. --halves lays connected plates of FDM as two halves that overlap: the
// slicer compares every corner of a contour with every other. --voids makes the plates for another phi_v than
// the print closes voids by; --exact closes them by phi_v itself, as if no slicer had moved their edges.
#include "slicer.h"
#include "prusa.h"
#include "runs.h"

#include "base/base.h"
#include "raster/raster.h"

#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const double PLATE_MM = 1, OVERLAP_MM = 4; // of halves: more than three walls a side

// phi_v is the width of a drawn bar that prints; what the slicer makes of that bar is off by its own
// resolution: paths are simplified to 0.0125 mm a side, screens have pixels of 47 um. So much narrower a
// sliced void still prints.
static const double slicer_slack_mm[PRUSA_PROCESSES] = {0.025, 0.025, 0.047};

// What PrusaSlicer 2.5 adds and leaves out by itself, see --bars: bars of 0.1 mm come out as well, on a
// screen of 47 um by luck.
static const double slicer_phi[PRUSA_PROCESSES][3] = {{0, 0.3, 0.15}, {0, 0.3, 0.15}, {0, 0.15, 0.15}};
static const double printer_phi[3] = {0.1, 0.3, 0.5}; // the paper's Hori Z500 (FDM) and Form 1+ (SLA)

// The small and the usual first, scenery at the end.
static const int32_t order[BENCH_RUNS] = {9,  8,  17, 16, 11, 10, 1,  0,  13, 12, 7,  6,
                                          23, 22, 21, 20, 5,  4,  15, 14, 3,  2,  19, 18};

bool tell(jali_context *ctx, jali_status status)
{
    if (status != JALI_OK) fprintf(stderr, "%s\n", jali_message(ctx));
    return status == JALI_OK;
}

static jali_options options_of(double width_mm, const double phi[3])
{
    jali_options opt = jali_defaults();
    opt.place.width_mm = width_mm;
    opt.optimise.phi_e_mm = phi[0];
    opt.optimise.phi_s_mm = phi[1];
    opt.optimise.phi_v_mm = phi[2];
    opt.carve.thickness_mm = PLATE_MM;
    opt.check = false;
    return opt;
}

jali_status carve_mask(jali_context *ctx, const jali_bitmap *mask, const jali_chart *chart, jali_mesh *mesh)
{
    jali_status status;
    jali_contours contours = {0};
    jali_carve_options carve = jali_carve_defaults();
    carve.thickness_mm = PLATE_MM;
    carve.frame_mm = FRAME_MM;
    TRY(jali_trace(ctx, mask, chart, NULL, &contours));
    TRY(jali_carve(ctx, &contours, chart, &carve, mesh));
done:
    jali_contours_free(ctx, &contours);
    return status;
}

jali_status grey_of(jali_context *ctx, const jali_bitmap *a, int32_t margin, jali_picture *grey)
{
    *grey = (jali_picture){.width_px = a->width_px - 2 * margin, .height_px = a->height_px - 2 * margin};
    jali_status status = ALLOCATE(ctx, grey->grey, (size_t)grey->width_px * (size_t)grey->height_px);
    for (int32_t y = 0; status == JALI_OK && y < grey->height_px; y++)
        for (int32_t x = 0; x < grey->width_px; x++)
            grey->grey[(size_t)y * (size_t)grey->width_px + (size_t)x] =
                jali_bitmap_get(a, x + margin, y + margin) ? 255 : 0;
    return status;
}

// The left or the right half of a plate, with some of the other; the frame is whole.
static jali_status carve_half(jali_context *ctx, const jali_bitmap *drawing, const jali_chart *chart,
                              bool right, jali_mesh *mesh)
{
    jali_status status;
    jali_bitmap half = {0};
    int32_t first = chart->margin_px, last = chart->width_px - chart->margin_px;
    int32_t middle = chart->width_px / 2, more = (int32_t)(OVERLAP_MM / 2 / jali_chart_pixel_mm(chart));
    TRY(jali_bitmap_copy(ctx, drawing, &half));
    for (int32_t y = first; y < chart->height_px - first; y++)
        paint_run(&half, y, right ? first : middle + more, right ? middle - more : last, false);
    TRY(carve_mask(ctx, &half, chart, mesh));
done:
    jali_bitmap_free(ctx, &half);
    return status;
}

// A plate of the picture connected at its own resolution, and nothing more; the frame is solid. The whole of
// it, then its halves if they are wanted.
static jali_status connected_plate(jali_context *ctx, const jali_bitmap *input,
                                   const jali_place_options *place, bool halves, jali_mesh mesh[3])
{
    enum { MARGIN_PX = 16 };
    jali_status status;
    jali_bitmap framed = {0}, drawing = {0};
    jali_picture grey = {0};
    jali_chart chart = {0};
    TRY(jali_bitmap_create(ctx, input->width_px + 2 * MARGIN_PX, input->height_px + 2 * MARGIN_PX, &framed));
    fill(ctx, &framed, true);
    paste(ctx, input, MARGIN_PX, MARGIN_PX, &framed);
    TRY(jali_connect(ctx, &framed, NULL, &framed, NULL));
    TRY(grey_of(ctx, &framed, MARGIN_PX, &grey));
    TRY(jali_place(ctx, &grey, 128, place, &chart, &drawing));
    TRY(carve_mask(ctx, &drawing, &chart, &mesh[0]));
    for (int i = 0; halves && i < 2; i++) TRY(carve_half(ctx, &drawing, &chart, i == 1, &mesh[1 + i]));
done:
    jali_bitmap_free(ctx, &framed);
    jali_bitmap_free(ctx, &drawing);
    jali_picture_free(ctx, &grey);
    return status;
}

// --- A table of errors

typedef struct figures {
    double error, recall_white, recall_black; // percent; error < 0: none
    int32_t pieces;
} figures;

static figures figures_of(const jali_prediction *p)
{
    return (figures){100 * p->error_rate, 100 * p->recall_white, 100 * p->recall_black, p->pieces};
}

static void write_map(jali_context *ctx, const witness *w, const jali_reference *reference,
                      const jali_bitmap *printed, const char *name, const char *kind)
{
    char path[1024];
    jali_bytes png = {0};
    FILE *file = NULL;
    if (!w->maps) return;
    snprintf(path, sizeof path, "%s/%s-%s.png", w->maps, name, kind);
    if (tell(ctx, jali_error_map(ctx, &reference->picture, printed, 4000, &png))) file = fopen(path, "wb");
    if (file) {
        fwrite(png.data, 1, png.size, file);
        fclose(file);
    }
    jali_bytes_free(ctx, &png);
}

// The slicer's output as the paper's printers would lay it: voids below phi_v close, edges grow by phi_e / 2.
// What becomes of thin solid the slicer has decided.
static jali_status grow_print(jali_context *ctx, const jali_reference *reference, const jali_comparison *c,
                              double picture_mm, double slack_mm, jali_prediction *grown)
{
    jali_status status;
    jali_bitmap part = {0};
    const jali_bitmap *picture = &reference->picture;
    jali_predict_options opt = {.picture_mm = picture_mm,
                                .phi_e_solid_mm = printer_phi[0],
                                .phi_e_void_mm = printer_phi[0],
                                .phi_s_mm = 1e-6,
                                .phi_v_mm = printer_phi[2] - slack_mm,
                                .recall = true};
    int32_t margin = (int32_t)(0.75 * FRAME_MM / picture_mm * picture->width_px);
    TRY(jali_bitmap_create(ctx, picture->width_px + 2 * margin, picture->height_px + 2 * margin, &part));
    cut_out(ctx, &c->plate, (c->plate.width_px - part.width_px) / 2, (c->plate.height_px - part.height_px) / 2,
            &part);
    TRY(jali_predict(ctx, reference, &part, margin, true, &opt, grown));
done:
    jali_bitmap_free(ctx, &part);
    return status;
}

// What the slicer makes of a plate, and what a printer makes of that.
static void slice(jali_context *ctx, const witness *w, prusa_process process, const jali_mesh *mesh,
                  int parts, const jali_reference *reference, const jali_compare_options *opt,
                  const char *name, figures *sliced, figures *printed)
{
    jali_print print = {0};
    jali_comparison c = {0};
    jali_prediction grown = {0};
    double took, pixel_mm = opt->picture_mm[0] / reference->picture.width_px;
    double slack_mm = w->exact ? 0 : slicer_slack_mm[process];
    char kind[64];
    *sliced = *printed = (figures){.error = -1};
    if (prusa_print(ctx, process, mesh, parts, w->folder, pixel_mm, w->seconds, &print, &took) &&
        tell(ctx, jali_compare(ctx, reference, &print, opt, &c)) &&
        tell(ctx, grow_print(ctx, reference, &c, opt->picture_mm[0], slack_mm, &grown))) {
        *sliced = figures_of(&c.print);
        *printed = figures_of(&grown);
        write_map(ctx, w, reference, &c.print.printed, name, prusa_name(process));
        snprintf(kind, sizeof kind, "%s-printed", prusa_name(process));
        write_map(ctx, w, reference, &grown.printed, name, kind);
    }
    jali_prediction_free(ctx, &grown);
    jali_comparison_free(ctx, &c);
    jali_print_free(ctx, &print);
}

// A row: the model; each process as printed, as sliced; as sliced from a plate that is made for the slicer.
enum {
    MODEL_CONNECTED,
    MODEL_OPTIMISED,
    PRINTED, // FDM connected, optimised, SLA connected, optimised
    SLICED = PRINTED + 4,
    OWN = SLICED + 4, // FDM, SLA
    COLUMNS = OWN + 2
};

static const char head[] =
    "| picture, width mm | our model | FDM, printed | SLA, printed | FDM, as sliced | SLA, as sliced |\n"
    "|---|---|---|---|---|---|\n";

static void print_error(const figures *f, const char *before)
{
    if (f->error < 0)
        printf("%s-", before);
    else
        printf("%s%.2f", before, f->error);
}

// "connected -> optimised (white/black -> white/black), 5 -> 1 pieces"; one piece each goes without saying.
static void print_pair(const figures *f, bool recall)
{
    print_error(f, " | ");
    print_error(f + 1, " -> ");
    if (f[0].error < 0 || f[1].error < 0) return;
    if (recall)
        printf(" (%.0f/%.0f -> %.0f/%.0f)", f[0].recall_white, f[0].recall_black, f[1].recall_white,
               f[1].recall_black);
    if (f[0].pieces != 1 || f[1].pieces != 1) printf(", %d -> %d pieces", f[0].pieces, f[1].pieces);
}

static void print_row(const bench_run *run, const figures row[COLUMNS])
{
    printf("| %s %.0f", run->name, run->width_mm);
    for (int k = 0; k < SLICED; k += 2) print_pair(row + k, true);
    for (int i = 0; i < 2; i++) {
        print_pair(row + SLICED + 2 * i, false);
        if (row[OWN + i].error >= 0) printf(", for it %.2f", row[OWN + i].error);
    }
    printf(" |\n");
    fflush(stdout);
}

static bool run_one(jali_context *ctx, const witness *w, const char *data, const bench_run *run,
                    figures row[COLUMNS])
{
    jali_status status;
    char path[1024], name[64];
    jali_picture picture = {0};
    jali_result result[3] = {{0}}; // for the printer, for FDM as sliced, for SLA as sliced
    jali_mesh connected[3] = {{0}};
    jali_reference reference = {0};
    jali_predict_options predict = jali_predict_defaults();
    const double phi[3] = {printer_phi[0], printer_phi[1], w->voids_mm};
    jali_options opt = options_of(run->width_mm, phi);
    for (int k = 0; k < COLUMNS; k++) row[k] = (figures){.error = -1};
    snprintf(path, sizeof path, "%s/%s.png", data, run->name);
    TRY(jali_read(ctx, path, NULL, &picture));
    TRY(jali_make(ctx, &picture, &opt, &result[0]));
    TRY(connected_plate(ctx, &result[0].input, &opt.place, w->halves, connected));
    const jali_chart *chart = &result[0].chart;
    double pixel_mm = jali_chart_pixel_mm(chart);
    jali_compare_options compare = {{(chart->width_px - 2 * chart->margin_px) * pixel_mm,
                                     (chart->height_px - 2 * chart->margin_px) * pixel_mm},
                                    FRAME_MM,
                                    printer_phi[1]};
    predict.picture_mm = compare.picture_mm[0];
    TRY(jali_reference_create(ctx, &result[0].input, &predict, &reference));
    row[MODEL_CONNECTED] = figures_of(&result[0].connected_print);
    row[MODEL_OPTIMISED] = figures_of(&result[0].result_print);
    for (int i = w->sla; i < 2; i++) {
        static const char *const kind[2] = {"connected", "optimised"};
        bool halves = w->halves && i == 0;
        const jali_mesh *const plate[2] = {&connected[halves], &result[0].mesh};
        prusa_process process = i == 0 ? PRUSA_FDM : PRUSA_SLA;
        figures unused;
        for (int k = 0; k < 2; k++) {
            snprintf(name, sizeof name, "%s-%.0f-%s", run->name, run->width_mm, kind[k]);
            slice(ctx, w, process, plate[k], halves && k == 0 ? 2 : 1, &reference, &compare, name,
                  &row[SLICED + 2 * i + k], &row[PRINTED + 2 * i + k]);
        }
        if (!w->own) continue;
        opt = options_of(run->width_mm, slicer_phi[process]);
        opt.predict = false;
        TRY(jali_make(ctx, &picture, &opt, &result[1 + i]));
        snprintf(name, sizeof name, "%s-%.0f-own", run->name, run->width_mm);
        slice(ctx, w, process, &result[1 + i].mesh, 1, &reference, &compare, name, &row[OWN + i], &unused);
    }
done:
    tell(ctx, status);
    jali_picture_free(ctx, &picture);
    for (int i = 0; i < 3; i++) {
        jali_result_free(ctx, &result[i]);
        jali_mesh_free(ctx, &connected[i]);
    }
    jali_reference_free(ctx, &reference);
    return status == JALI_OK;
}

static void print_means(const figures (*row)[COLUMNS], int32_t count)
{
    static const struct {
        const char *what;
        int connected, optimised;
    } pair[] = {{"our model", MODEL_CONNECTED, MODEL_OPTIMISED},
                {"FDM, printed", PRINTED, PRINTED + 1},
                {"SLA, printed", PRINTED + 2, PRINTED + 3},
                {"FDM, as sliced", SLICED, SLICED + 1},
                {"FDM, as sliced, the plate for it", SLICED, OWN},
                {"SLA, as sliced", SLICED + 2, SLICED + 3},
                {"SLA, as sliced, the plate for it", SLICED + 2, OWN + 1}};
    printf("\n| judged by | runs | connected only, mean | optimised, mean | optimised below connected |\n"
           "|---|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
        double sum[2] = {0, 0};
        int32_t better = 0, runs = 0;
        for (int32_t r = 0; r < count; r++) {
            double a = row[r][pair[i].connected].error, b = row[r][pair[i].optimised].error;
            if (a < 0 || b < 0) continue;
            sum[0] += a;
            sum[1] += b;
            better += b < a;
            runs++;
        }
        if (runs > 0)
            printf("| %s | %d | %.2f | %.2f | %d of %d |\n", pair[i].what, runs, sum[0] / runs, sum[1] / runs,
                   better, runs);
    }
}

static void remove_folder(const witness *w)
{
    static const char *const name[] = {"plate.stl", "plate-2.stl", "plate.gcode", "plate.sl1"};
    char path[128];
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        snprintf(path, sizeof path, "%s/%s", w->folder, name[i]);
        remove(path);
    }
    rmdir(w->folder);
}

int main(int argc, char **argv)
{
    mallopt(M_MMAP_THRESHOLD, 1 << 30); // as the command line does
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    const char *data = "../shared/data/images", *only = NULL;
    int32_t first = 0, last = BENCH_RUNS - 1, count = 0;
    bool bars = false;
    witness w = {.seconds = 900, .voids_mm = printer_phi[2], .folder = "/tmp/jali-slicer-XXXXXX"};
    figures row[BENCH_RUNS][COLUMNS];
    jali_context *ctx;
    jali_context_options copt = jali_context_defaults();
    copt.threads = 1;
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--only") && i + 1 < argc)
            only = argv[++i];
        else if (!strcmp(argv[i], "--maps") && i + 1 < argc)
            w.maps = argv[++i];
        else if (!strcmp(argv[i], "--limit") && i + 1 < argc)
            w.seconds = strtod(argv[++i], NULL);
        else if (!strcmp(argv[i], "--runs") && i + 1 < argc)
            sscanf(argv[++i], "%d,%d", &first, &last);
        else if (!strcmp(argv[i], "--voids") && i + 1 < argc)
            w.voids_mm = strtod(argv[++i], NULL);
        else if (!strcmp(argv[i], "--halves"))
            w.halves = true;
        else if (!strcmp(argv[i], "--exact"))
            w.exact = true;
        else if (!strcmp(argv[i], "--own"))
            w.own = true;
        else if (!strcmp(argv[i], "--sla"))
            w.sla = true;
        else if (!strcmp(argv[i], "--bars"))
            bars = true;
        else
            data = argv[i];
    }
    if (!mkdtemp(w.folder) || jali_context_create(&copt, &ctx) != JALI_OK) return 1;
    if (bars) {
        int failed = run_bars(ctx, &w);
        remove_folder(&w);
        return failed;
    }
    printf("%s", head);
    for (int32_t i = MAX(first, 0); i <= MIN(last, BENCH_RUNS - 1); i++) {
        const bench_run *run = &bench_runs[order[i]];
        if (only && strcmp(only, run->name)) continue;
        if (!run_one(ctx, &w, data, run, row[count])) return 1;
        print_row(run, row[count]);
        count++;
    }
    print_means((const figures(*)[COLUMNS])row, count);
    remove_folder(&w);
    jali_context_free(ctx);
    return 0;
}
