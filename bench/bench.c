// Times and memory of every stage and of the operators below, as a table.
//
//     bench [--sizes 1,5.8,...] [--threads N] [--against N] [--runs N] [--samples A,B] [--images FOLDER]
//           [CASE...]
//
//   --sizes    megapixels at which the samples are drawn (1,5.8); "none": the images alone
//   --threads  how many (1)
//   --against  time each case with so many threads too, run by run in turns, and print how much faster it is
//              (the case "spread" is how much the machine has to give)
//   --samples  which (girih,lettering,halftone)
//   --images   a folder of PNG files (../shared/data/images when it is there); "none": the samples alone
//   --runs     the median of at most so many (5); fewer once a case has taken 5 s
//   CASE       names from the first column; all by default
//
// Operators run on the input's own grid (--paper), the image stages on that and on the default's, the solid
// on the default's. Widths: 70 mm for 1000 px, as in docs/results.md, so the default works on 2800 x 2800 px
// where the input has 1000 x 1000; from 50 Mpixel on a working pixel is as large as an input pixel. ns a
// pixel counts the pixels of the grid that the case works on. Peak is what the case holds beyond what it
// starts from. The peer is Leptonica, one thread, when it was found at configure time.
#include "bench.h"

#include <dirent.h>
#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "raster/raster.h"
#include "base/base.h"

enum { MOST_RUNS = 100, MOST_SIZES = 16, MOST_NAMES = 64 };
static const double enough_ms = 5000;
static const double same_grid_from_px = 50e6;

typedef struct settings {
    jali_context_options context;
    int32_t against; // threads, 0 = no comparison
    int32_t runs, size_count;
    double mpixel[MOST_SIZES];
    char *samples; // comma-separated
    const char *images;
    int32_t wanted_count;
    const char *wanted[MOST_NAMES];
} settings;

static bool is_wanted(const settings *set, const bench_case *c)
{
    for (int32_t i = 0; i < set->wanted_count; i++)
        if (!strcmp(set->wanted[i], c->name)) return true;
    return set->wanted_count == 0;
}

static double pixels_of(const subject *s, const bench_case *c)
{
    if (!strncmp(c->name, "read", 4)) return (double)s->picture.width_px * s->picture.height_px;
    return (double)s->chart.width_px * s->chart.height_px;
}

// --- What the cases start from

static void subject_free(jali_context *ctx, subject *s)
{
    jali_bytes_free(ctx, &s->png);
    jali_picture_free(ctx, &s->picture);
    jali_bitmap_free(ctx, &s->drawing);
    jali_bitmap_free(ctx, &s->scratch);
    jali_bitmap_free(ctx, &s->result);
    jali_bitmap_free(ctx, &s->mask);
    jali_contours_free(ctx, &s->contours);
    jali_contours_free(ctx, &s->outline);
    jali_mesh_free(ctx, &s->mesh);
}

static jali_status prepare(jali_context *ctx, bool paper, subject *s)
{
    jali_status status;
    double width_px = s->picture.width_px;
    s->opt = jali_defaults();
    s->opt.predict = false;
    s->opt.optimise.paper = s->opt.place.paper = paper;
    s->opt.place.width_mm = 0.07 * width_px;
    if (width_px * s->picture.height_px >= same_grid_from_px) s->opt.place.width_mm = 0.025 * width_px;
    TRY(jali_place(ctx, &s->picture, 128, &s->opt.place, &s->chart, &s->drawing));
    TRY(jali_bitmap_copy(ctx, &s->drawing, &s->scratch));
    TRY(jali_bitmap_copy(ctx, &s->drawing, &s->result));
done:
    return status;
}

static jali_status prepare_solid(jali_context *ctx, subject *s)
{
    jali_status status;
    jali_optimised optimised = {0};
    TRY(jali_optimise(ctx, &s->drawing, &s->chart, &s->opt.optimise, &optimised));
    s->mask = optimised.mask;
    optimised.mask = (jali_bitmap){0};
    TRY(jali_trace(ctx, &s->mask, &s->chart, &s->opt.trace, &s->outline));
    TRY(jali_plate(ctx, &s->outline, &s->chart, &s->opt.carve, &s->contours));
    TRY(jali_carve(ctx, &s->outline, &s->chart, &s->opt.carve, &s->mesh));
done:
    jali_optimised_free(ctx, &optimised);
    return status;
}

// --- Measuring

typedef struct timing {
    double ms, against_ms, peak_mb;
} timing;

static jali_status time_run(jali_context *ctx, const bench_case *c, subject *s, double *ms)
{
    double begun = now_ms();
    jali_status status = c->run(ctx, s, c->size);
    *ms = now_ms() - begun;
    if (status != JALI_OK) fprintf(stderr, "%s of %s: %s\n", c->name, s->name, jali_message(ctx));
    return status;
}

// Contexts of its own, so that the peak is the case's. Runs that are compared take turns: what else the
// machine does slows both.
static jali_status measure(const settings *set, const bench_case *c, subject *s, timing *out)
{
    jali_status status;
    jali_context *ctx = NULL, *other = NULL;
    jali_context_options against = set->context;
    against.threads = set->against;
    double took[MOST_RUNS], other_took[MOST_RUNS] = {0}, total = 0;
    int32_t count = 0;
    TRY(jali_context_create(&set->context, &ctx));
    if (set->against) TRY(jali_context_create(&against, &other));
    do {
        TRY(time_run(ctx, c, s, &took[count]));
        if (other) TRY(time_run(other, c, s, &other_took[count]));
        total += took[count] + other_took[count];
        count++;
    } while (count < set->runs && total < enough_ms);
    *out =
        (timing){median(took, count), median(other_took, count), (double)jali_peak_memory_bytes(ctx) / 1e6};
done:
    jali_context_free(other);
    jali_context_free(ctx);
    return status;
}

static void print_or_blank(bool there, double value)
{
    if (there)
        printf(" %10.3f |", value);
    else
        printf(" %10s |", "");
}

static jali_status measure_row(const settings *set, const bench_case *c, bool paper, subject *s)
{
    timing t;
    jali_status status = measure(set, c, s, &t);
    if (status != JALI_OK) return status;
    double working = (double)s->chart.width_px * s->chart.height_px;
    printf("| %-15s | %-14s | %-7s | %6.1f | %6.1f | %10.3f | %8.3f | %7.1f |", c->name, s->name,
           paper ? "--paper" : "default", 1e-6 * s->picture.width_px * s->picture.height_px, 1e-6 * working,
           t.ms, 1e6 * t.ms / pixels_of(s, c), t.peak_mb);
    double other = c->peer ? c->peer(s, c->size, MIN(set->runs, 5)) : -1;
    print_or_blank(other >= 0, other);
    if (set->against) print_or_blank(true, t.ms / t.against_ms);
    printf("\n");
    fflush(stdout);
    return JALI_OK;
}

static jali_status measure_way(jali_context *ctx, const settings *set, bool paper, subject *s)
{
    jali_status status;
    bool carved = false;
    TRY(prepare(ctx, paper, s));
    for (int32_t i = 0; i < bench_case_count; i++) {
        const bench_case *c = &bench_cases[i];
        if (!is_wanted(set, c) || !(c->grids & (paper ? ON_INPUT : ON_WORKING))) continue;
        if (c->solid && !carved) TRY(prepare_solid(ctx, s));
        carved = carved || c->solid;
        TRY(measure_row(set, c, paper, s));
    }
done:
    return status;
}

// Both ways over one PNG file in memory, which it takes.
static jali_status measure_picture(jali_context *ctx, const settings *set, const char *name, jali_bytes *png)
{
    jali_status status = JALI_OK;
    for (int32_t paper = 0; paper < 2 && status == JALI_OK; paper++) {
        subject s = {.name = name, .png = *png};
        *png = (jali_bytes){0};
        status = jali_read_bytes(ctx, s.png.data, s.png.size, name, NULL, &s.picture);
        if (status == JALI_OK) status = measure_way(ctx, set, paper, &s);
        *png = s.png;
        s.png = (jali_bytes){0};
        subject_free(ctx, &s);
    }
    jali_bytes_free(ctx, png);
    return status;
}

static jali_status measure_sample(jali_context *ctx, const settings *set, const char *name, double mpixel)
{
    jali_status status;
    jali_bitmap drawn = {0};
    jali_bytes png = {0};
    TRY(jali_sample(ctx, name, (int32_t)lround(sqrt(1e6 * mpixel)), &drawn));
    TRY(jali_bitmap_png(ctx, &drawn, 0, &png));
    jali_bitmap_free(ctx, &drawn);
    return measure_picture(ctx, set, name, &png);
done:
    jali_bitmap_free(ctx, &drawn);
    jali_bytes_free(ctx, &png);
    return status;
}

static jali_status measure_samples(jali_context *ctx, const settings *set)
{
    jali_status status = JALI_OK;
    for (int32_t i = 0; i < set->size_count; i++) {
        char *copy = strdup(set->samples), *rest = copy, *name;
        while (status == JALI_OK && (name = strsep(&rest, ",")))
            status = measure_sample(ctx, set, name, set->mpixel[i]);
        free(copy);
    }
    return status;
}

static jali_status read_whole(jali_context *ctx, const char *path, jali_bytes *bytes)
{
    FILE *file = fopen(path, "rb");
    if (!file) return fail(ctx, JALI_IO, "cannot open %s", path);
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    rewind(file);
    jali_status status = ALLOCATE(ctx, bytes->data, MAX(size, 1));
    if (status == JALI_OK) bytes->size = bytes->capacity = fread(bytes->data, 1, (size_t)size, file);
    fclose(file);
    return status;
}

static int only_png(const struct dirent *entry)
{
    size_t length = strlen(entry->d_name);
    return length > 4 && !strcmp(entry->d_name + length - 4, ".png");
}

static jali_status measure_images(jali_context *ctx, const settings *set)
{
    struct dirent **entry;
    jali_status status = JALI_OK;
    int count = scandir(set->images, &entry, only_png, alphasort);
    for (int i = 0; i < count; i++) {
        char path[4096];
        jali_bytes png = {0};
        snprintf(path, sizeof path, "%s/%s", set->images, entry[i]->d_name);
        if (status == JALI_OK) status = read_whole(ctx, path, &png);
        if (status == JALI_OK) status = measure_picture(ctx, set, entry[i]->d_name, &png);
        free(entry[i]);
    }
    if (count >= 0) free(entry);
    return status;
}

// --- The command line

static bool is_case(const char *name)
{
    for (int32_t i = 0; i < bench_case_count; i++)
        if (!strcmp(bench_cases[i].name, name)) return true;
    return false;
}

static void read_sizes(const char *text, settings *set)
{
    char *end;
    set->size_count = 0;
    while (set->size_count < MOST_SIZES) {
        double mpixel = strtod(text, &end);
        if (end == text || !(mpixel > 0 && mpixel <= 1000)) return;
        set->mpixel[set->size_count++] = mpixel;
        if (*end != ',') return;
        text = end + 1;
    }
}

static bool read_arguments(int argc, char **argv, settings *set)
{
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : "";
        if (!strcmp(argv[i], "--sizes"))
            read_sizes(value, set), i++;
        else if (!strcmp(argv[i], "--threads"))
            set->context.threads = (int32_t)strtol(value, NULL, 10), i++;
        else if (!strcmp(argv[i], "--against"))
            set->against = (int32_t)strtol(value, NULL, 10), i++;
        else if (!strcmp(argv[i], "--runs"))
            set->runs = (int32_t)strtol(value, NULL, 10), i++;
        else if (!strcmp(argv[i], "--samples"))
            set->samples = argv[++i];
        else if (!strcmp(argv[i], "--images"))
            set->images = value, i++;
        else if (is_case(argv[i]) && set->wanted_count < MOST_NAMES)
            set->wanted[set->wanted_count++] = argv[i];
        else
            return false;
    }
    return set->runs >= 1 && set->runs <= MOST_RUNS && set->samples;
}

static void print_usage(void)
{
    fprintf(
        stderr,
        "bench [--sizes 1,5.8] [--threads N] [--against N] [--runs 1..%d] [--samples A,B] [--images FOLDER] "
        "[CASE...]\ncases:",
        MOST_RUNS);
    for (int32_t i = 0; i < bench_case_count; i++) fprintf(stderr, " %s", bench_cases[i].name);
    fprintf(stderr, "\n");
}

int main(int argc, char **argv)
{
    mallopt(M_MMAP_THRESHOLD, 1 << 30); // as the command line does
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    static char samples[] = "girih,lettering,halftone";
    settings set = {.context = jali_context_defaults(),
                    .runs = 5,
                    .size_count = 2,
                    .mpixel = {1, 5.8},
                    .samples = samples,
                    .images = "../shared/data/images"};
    set.context.threads = 1;
    if (!read_arguments(argc, argv, &set)) {
        print_usage();
        return 2;
    }
    jali_context *ctx;
    if (jali_context_create(&set.context, &ctx) != JALI_OK) return 1;
    printf("jali %s, %d thread%s, median of %d\n\n", jali_version(), set.context.threads,
           set.context.threads == 1 ? "" : "s", set.runs);
    printf("| case | picture | way | Mpixel in | working | ms | ns/px | peak MB | peer ms |");
    if (set.against) printf(" times faster with %d threads |", set.against);
    printf("\n|---|---|---|---|---|---|---|---|---|%s\n", set.against ? "---|" : "");
    jali_status status = measure_samples(ctx, &set);
    if (status == JALI_OK) status = measure_images(ctx, &set);
    if (status != JALI_OK) fprintf(stderr, "%s\n", jali_message(ctx));
    jali_context_free(ctx);
    return status == JALI_OK ? 0 : 1;
}
