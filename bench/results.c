// The table of docs/results.md: every picture at two widths, the input, connected only, the paper's way,
// ours.
//
//     results [DATA_FOLDER] [--threads N] [--only NAME]
//
// Widths: 70 and 40 mm for 1000 px, in proportion for the others (the 24 runs that docs/results.md compares
// with); phi 0.1 / 0.3 / 0.5 mm. Exit 1 when a promise is not kept.
#include <jali/jali.h>

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct run {
    const char *name;
    double width_mm;
} run;

static const run RUNS[] = {{"calligraphy", 70}, {"calligraphy", 40}, {"dense", 70},       {"dense", 40},
                           {"halftone", 70},    {"halftone", 40},    {"islands", 70},     {"islands", 40},
                           {"lion", 70},        {"lion", 40},        {"monroe-like", 70}, {"monroe-like", 40},
                           {"ornament", 84},    {"ornament", 48},    {"plum", 105},       {"plum", 60},
                           {"portrait", 70},    {"portrait", 40},    {"scenery", 120},    {"scenery", 85},
                           {"text", 70},        {"text", 40},        {"tree", 80},        {"tree", 56}};
enum { RUN_COUNT = sizeof RUNS / sizeof *RUNS };

typedef struct column {
    double error, recall_white, recall_black;
} column;

static column column_of(const jali_prediction *p)
{
    return (column){100 * p->error_rate, 100 * p->recall_white, 100 * p->recall_black};
}

static void add(column *sum, column c)
{
    sum->error += c.error;
    sum->recall_white += c.recall_white;
    sum->recall_black += c.recall_black;
}

static void print_column(column c, double count)
{
    printf(" | %5.2f (%4.1f/%4.1f)", c.error / count, c.recall_white / count, c.recall_black / count);
}

static bool make(jali_context *ctx, jali_picture *picture, double width_mm, bool paper, jali_result *result)
{
    jali_options opt = jali_defaults();
    opt.place.width_mm = width_mm;
    opt.optimise.paper = paper;
    opt.solid = !paper;
    if (jali_make(ctx, picture, &opt, result) == JALI_OK) return true;
    fprintf(stderr, "%s\n", jali_message(ctx));
    return false;
}

static double image_seconds(const jali_result *r)
{
    return r->seconds[JALI_STAGE_PLACE] + r->seconds[JALI_STAGE_OPTIMISE];
}

int main(int argc, char **argv)
{
    mallopt(M_MMAP_THRESHOLD, 1 << 30); // as the command line does
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    const char *folder = "../shared/data/images", *only = NULL;
    jali_context_options copt = jali_context_defaults();
    copt.threads = 1;
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--threads") && i + 1 < argc)
            copt.threads = (int32_t)strtol(argv[++i], NULL, 10);
        else if (!strcmp(argv[i], "--only") && i + 1 < argc)
            only = argv[++i];
        else
            folder = argv[i];
    }
    jali_context *ctx;
    if (jali_context_create(&copt, &ctx) != JALI_OK) return 1;
    column sum[4] = {{0}};
    int count = 0, better_than_connected = 0, broken = 0;
    printf("| picture, width mm | input | connected only | --paper | default | pieces | promises | s paper, "
           "default | mesh triangles |\n"
           "|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < RUN_COUNT; i++) {
        if (only && strcmp(only, RUNS[i].name)) continue;
        char path[1024];
        snprintf(path, sizeof path, "%s/%s.png", folder, RUNS[i].name);
        jali_picture picture;
        jali_result paper, ours;
        if (jali_read(ctx, path, NULL, &picture) != JALI_OK) {
            fprintf(stderr, "%s\n", jali_message(ctx));
            return 1;
        }
        if (!make(ctx, &picture, RUNS[i].width_mm, true, &paper)) return 1;
        if (!make(ctx, &picture, RUNS[i].width_mm, false, &ours)) return 1;
        column c[4] = {column_of(&ours.input_print), column_of(&ours.connected_print),
                       column_of(&paper.result_print), column_of(&ours.result_print)};
        bool kept = ours.one_piece && ours.printable && ours.closed,
             paper_kept = paper.one_piece && paper.printable;
        printf("| %s %.0f", RUNS[i].name, RUNS[i].width_mm);
        for (int k = 0; k < 4; k++) {
            print_column(c[k], 1);
            add(&sum[k], c[k]);
        }
        printf(" | %d, %d | %s, %s | %.2f, %.2f | %d |\n", paper.result_print.pieces,
               ours.result_print.pieces, paper_kept ? "kept" : "BROKEN", kept ? "kept" : "BROKEN",
               image_seconds(&paper), image_seconds(&ours), ours.mesh.triangle_count);
        fflush(stdout);
        better_than_connected += c[3].error < c[1].error;
        broken += !kept + !paper_kept;
        count++;
        jali_result_free(ctx, &paper);
        jali_result_free(ctx, &ours);
        jali_picture_free(ctx, &picture);
    }
    printf("| mean of %d", count);
    for (int k = 0; k < 4; k++) print_column(sum[k], count);
    printf(" | | | | |\n\ndefault below connected only: %d of %d; promises broken: %d\n",
           better_than_connected, count, broken);
    jali_context_free(ctx);
    return broken > 0;
}
