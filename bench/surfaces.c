// The table of surfaces in docs/results.md: whole runs from a picture to the bytes of a 3MF, on surfaces.
//
//     surfaces [DATA_FOLDER] [--threads N] [--runs N]
//
// The paper's three objects with the pictures of the data folder, then the dense pictures that booleans choke
// on. phi 0.1 / 0.3 / 0.5 mm, walls of 2 mm. Times are medians, of whole runs and of their stages; "3MF" is
// compressing and writing. Exit 1 when a promise is not kept.
#include "bench.h"
#include "runs.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RUNS = 21 };

typedef struct timing {
    double whole, image, place, carve, check, file; // ms
} timing;

typedef struct outcome {
    int32_t triangles, contour_points, surface_triangles;
    double stretch, thinnest_mm;
    bool kept;
} outcome;

static bool run_once(jali_context *ctx, const char *data, const surface_run *r, timing *t, outcome *o)
{
    char path[1024], surface_words[1024];
    jali_picture picture = {0};
    jali_surface surface = {0};
    jali_surface_report report = {0};
    jali_result result = {0};
    jali_object object = {0};
    jali_bytes file = {0};
    jali_options opt = jali_defaults();
    opt.place.width_mm = r->width_mm;
    opt.place.placing = r->placing;
    opt.predict = false;
    snprintf(path, sizeof path, "%s/images/%s.png", data, r->picture);
    if (strncmp(r->surface, "%s", 2) == 0)
        snprintf(surface_words, sizeof surface_words, "%s%s", data, r->surface + 2);
    else
        snprintf(surface_words, sizeof surface_words, "%s", r->surface);
    double begun = now_ms();
    bool done = jali_read(ctx, path, NULL, &picture) == JALI_OK &&
                jali_surface_open(ctx, surface_words, NULL, &surface, &report) == JALI_OK;
    if (done) o->surface_triangles = surface.mesh.triangle_count;
    done = done && jali_make_on(ctx, &surface, NULL, &picture, &opt, 1, &result, &object) == JALI_OK;
    double made = now_ms();
    jali_product product = {.mesh = &object.mesh};
    done = done && jali_write_bytes(ctx, JALI_FORMAT_3MF, &product, NULL, &file) == JALI_OK;
    double end = now_ms();
    if (done) {
        const double *s = result.seconds;
        *t = (timing){.whole = end - begun,
                      .image = 1e3 * s[JALI_STAGE_OPTIMISE],
                      .place = 1e3 * s[JALI_STAGE_PLACE],
                      .carve = 1e3 *
                               (s[JALI_STAGE_TRACE] + s[JALI_STAGE_CARVE] + object.seconds[JALI_STAGE_CARVE]),
                      .check = 1e3 * object.seconds[JALI_STAGE_CHECK],
                      .file = end - made};
        o->triangles = object.mesh.triangle_count;
        o->contour_points = result.contours.point_count;
        o->stretch = result.placed.stretch[1];
        o->thinnest_mm = object.wall.thinnest_mm;
        o->kept = object.one_piece && object.closed && result.printable;
    } else {
        fprintf(stderr, "%s on %s: %s\n", r->picture, surface_words, jali_message(ctx));
    }
    jali_bytes_free(ctx, &file);
    jali_result_free(ctx, &result);
    jali_object_free(ctx, &object);
    jali_surface_report_free(ctx, &report);
    jali_surface_free(ctx, &surface);
    jali_picture_free(ctx, &picture);
    return done;
}

static double median_of(const timing *t, int32_t runs, size_t offset)
{
    double ms[MOST_RUNS];
    for (int32_t i = 0; i < runs; i++) memcpy(&ms[i], (const char *)&t[i] + offset, sizeof *ms);
    return median(ms, runs) / 1e3;
}

static void print_row(const surface_run *r, const timing *t, int32_t runs, const outcome *o, double peak_mb)
{
    const char *surface = strrchr(r->surface, '/') ? strrchr(r->surface, '/') + 1 : r->surface;
    // What the picture adds, a vertex of a contour: on both skins, so two a point.
    double added = (double)(o->triangles - 2 * o->surface_triangles) / (2.0 * o->contour_points);
    printf("| %s %.0f | %.*s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.0f | %d | %.1f | %.2f | %.2f | %s "
           "|\n",
           r->picture, r->width_mm, (int)strcspn(surface, ":,"), surface,
           median_of(t, runs, offsetof(timing, whole)), median_of(t, runs, offsetof(timing, place)),
           median_of(t, runs, offsetof(timing, image)), median_of(t, runs, offsetof(timing, carve)),
           median_of(t, runs, offsetof(timing, check)), median_of(t, runs, offsetof(timing, file)), peak_mb,
           o->triangles, added, o->stretch, o->thinnest_mm, o->kept ? "kept" : "NOT KEPT");
}

int main(int argc, char **argv)
{
    const char *data = "../shared/data";
    int32_t threads = 1, runs = 3;
    bool all_kept = true;
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--threads") == 0 && i + 1 < argc)
            threads = atoi(argv[++i]);
        else if (strcmp(argv[i], "--runs") == 0 && i + 1 < argc)
            runs = atoi(argv[++i]);
        else
            data = argv[i];
    }
    runs = runs < 1 ? 1 : runs > MOST_RUNS ? MOST_RUNS : runs;
    printf("| picture, mm | surface | s | place | image | trace, carve | check | 3MF | peak MB | triangles | "
           "added a "
           "vertex | stretch | thinnest wall, mm | promises "
           "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int32_t k = 0; k < SURFACE_RUNS; k++) {
        timing t[MOST_RUNS];
        outcome o = {0};
        double peak_mb = 0;
        bool done = true;
        for (int32_t i = 0; i < runs && done; i++) {
            jali_context_options own = jali_context_defaults();
            jali_context *ctx;
            own.threads = threads;
            if (jali_context_create(&own, &ctx) != JALI_OK) return 1;
            done = run_once(ctx, data, &surface_runs[k], &t[i], &o);
            peak_mb = (double)jali_peak_memory_bytes(ctx) / 1e6;
            jali_context_free(ctx);
        }
        if (done) print_row(&surface_runs[k], t, runs, &o, peak_mb);
        all_kept &= done && o.kept;
    }
    return all_kept ? 0 : 1;
}
