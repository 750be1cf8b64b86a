// The cases: operators on the drawing, then stage after stage, then from file to file.
#include "bench.h"

#include <jali/compensate.h>
#include "base/base.h"
#include "plane/triangulation.h"
#include "raster/raster.h"

// --- The machine

enum { SPREAD_ITEMS = 64, SPREAD_WORDS = 1024, SPREAD_TIMES = 2000 };

static void spread_item(void *shared, int32_t item)
{
    uint64_t a[SPREAD_WORDS], b[SPREAD_WORDS], *sum = shared;
    for (int32_t i = 0; i < SPREAD_WORDS; i++)
        a[i] = b[i] = (uint64_t)(i + item) * UINT64_C(0x9e3779b97f4a7c15);
    for (int32_t k = 0; k < SPREAD_TIMES; k++)
        for (int32_t i = 1; i < SPREAD_WORDS; i++) b[i] ^= a[i] << 1 | a[i - 1] >> 63;
    sum[item] = b[SPREAD_WORDS - 1];
}

// Work that is spread over the threads without a rest, and stays in the first caches: what --against gives
// for it is as much as the machine has to give just now.
static jali_status run_spread(jali_context *ctx, subject *s, int32_t size)
{
    (void)s;
    (void)size;
    uint64_t sum[SPREAD_ITEMS];
    parallel(ctx, SPREAD_ITEMS, spread_item, sum);
    return JALI_OK;
}

// --- Operators

static jali_status run_and(jali_context *ctx, subject *s, int32_t size)
{
    (void)size;
    combine(ctx, RULE_AND, &s->drawing, &s->scratch, &s->result);
    return JALI_OK;
}

static jali_status run_opening(jali_context *ctx, subject *s, int32_t size, bool disc)
{
    element e = {0};
    jali_status status;
    TRY(disc ? element_disc(ctx, size, &e) : element_square(ctx, size, &e));
    TRY(open_by(ctx, &s->drawing, &e, true, &s->scratch, &s->result));
done:
    element_free(ctx, &e);
    return status;
}

static jali_status run_opening_square(jali_context *ctx, subject *s, int32_t size)
{
    return run_opening(ctx, s, size, false);
}

static jali_status run_opening_disc(jali_context *ctx, subject *s, int32_t size)
{
    return run_opening(ctx, s, size, true);
}

static jali_status run_components(jali_context *ctx, subject *s, int32_t connectivity)
{
    components pieces = {0};
    jali_status status = label_components(ctx, &s->drawing, true, connectivity, &pieces);
    components_free(ctx, &pieces);
    return status;
}

static jali_status run_axis(jali_context *ctx, subject *s, int32_t rounds)
{
    return medial_axis(ctx, &s->drawing, true, true, rounds, &s->result);
}

// --- Stages

static jali_status run_read(jali_context *ctx, subject *s, int32_t size)
{
    (void)size;
    jali_picture picture = {0};
    jali_status status = jali_read_bytes(ctx, s->png.data, s->png.size, s->name, NULL, &picture);
    jali_picture_free(ctx, &picture);
    return status;
}

static jali_status run_place(jali_context *ctx, subject *s, int32_t size)
{
    (void)size;
    jali_chart chart;
    jali_bitmap drawing = {0};
    jali_status status = jali_place(ctx, &s->picture, 128, &s->opt.place, &chart, &drawing);
    jali_bitmap_free(ctx, &drawing);
    return status;
}

static jali_status run_connect(jali_context *ctx, subject *s, int32_t metric)
{
    jali_bitmap joined = {0};
    jali_connect_options opt = {.metric = (jali_metric)metric};
    jali_status status = jali_connect(ctx, &s->drawing, &opt, &joined, NULL);
    jali_bitmap_free(ctx, &joined);
    return status;
}

static jali_status run_optimise(jali_context *ctx, subject *s, int32_t size)
{
    (void)size;
    jali_optimised optimised = {0};
    jali_status status = jali_optimise(ctx, &s->drawing, &s->chart, &s->opt.optimise, &optimised);
    jali_optimised_free(ctx, &optimised);
    return status;
}

static jali_status run_trace(jali_context *ctx, subject *s, int32_t size)
{
    (void)size;
    jali_contours outline = {0};
    jali_status status = jali_trace(ctx, &s->mask, &s->chart, &s->opt.trace, &outline);
    jali_contours_free(ctx, &outline);
    return status;
}

static jali_status run_triangulate(jali_context *ctx, subject *s, int32_t size)
{
    (void)size;
    jali_status status;
    triangulation plane = {0};
    contact met;
    const jali_contours *c = &s->contours;
    int32_t(*edge)[2] = NULL;
    TRY(ALLOCATE(ctx, edge, c->point_count));
    for (int32_t i = 0; i < c->contour_count; i++)
        for (int32_t p = c->first[i]; p < c->first[i + 1]; p++) {
            edge[p][0] = p;
            edge[p][1] = p + 1 < c->first[i + 1] ? p + 1 : c->first[i];
        }
    TRY(insert_points(ctx, &plane, (const int32_t(*)[2])c->point, c->point_count));
    TRY(insert_edges(ctx, &plane, (const int32_t(*)[2])edge, c->point_count, EDGE_CONTOUR, false, &met));
done:
    triangulation_free(ctx, &plane);
    release(ctx, edge);
    return status;
}

static jali_status run_carve(jali_context *ctx, subject *s, int32_t size)
{
    (void)size;
    jali_mesh mesh = {0};
    jali_status status = jali_carve(ctx, &s->outline, &s->chart, &s->opt.carve, &mesh);
    jali_mesh_free(ctx, &mesh);
    return status;
}

static jali_status run_check(jali_context *ctx, subject *s, int32_t size)
{
    (void)size;
    jali_check_report report;
    return jali_check(ctx, &s->mesh, NULL, &report);
}

static jali_status run_write(jali_context *ctx, subject *s, int32_t format)
{
    jali_bytes bytes = {0};
    jali_product product = {.mesh = &s->mesh, .contours = &s->contours};
    jali_status status = jali_write_bytes(ctx, (jali_format)format, &product, NULL, &bytes);
    jali_bytes_free(ctx, &bytes);
    return status;
}

static jali_status run_whole(jali_context *ctx, subject *s, int32_t format)
{
    jali_status status;
    jali_picture picture = {0};
    jali_result result = {0};
    jali_bytes bytes = {0};
    TRY(jali_read_bytes(ctx, s->png.data, s->png.size, s->name, NULL, &picture));
    TRY(jali_make(ctx, &picture, &s->opt, &result));
    jali_product product = {.mesh = &result.mesh};
    TRY(jali_write_bytes(ctx, (jali_format)format, &product, NULL, &bytes));
done:
    jali_bytes_free(ctx, &bytes);
    jali_result_free(ctx, &result);
    jali_picture_free(ctx, &picture);
    return status;
}

const bench_case bench_cases[] = {
    {"spread", run_spread, NULL, 0, ON_WORKING, false},
    {"and", run_and, peer_and, 0, ON_INPUT, false},
    {"opening-3", run_opening_square, peer_opening, 3, ON_INPUT, false},
    {"opening-7", run_opening_square, peer_opening, 7, ON_INPUT, false},
    {"opening-15", run_opening_square, peer_opening, 15, ON_INPUT, false},
    {"opening-disc-7", run_opening_disc, NULL, 7, ON_INPUT, false},
    {"opening-disc-15", run_opening_disc, NULL, 15, ON_INPUT, false},
    {"components", run_components, peer_components, 4, ON_INPUT, false},
    {"axis", run_axis, NULL, 0, ON_INPUT, false},
    {"read-png", run_read, NULL, 0, ON_INPUT, false},
    {"place", run_place, NULL, 0, ON_WORKING | ON_INPUT, false},
    {"connect", run_connect, NULL, JALI_METRIC_CITY_BLOCK, ON_WORKING | ON_INPUT, false},
    {"optimise", run_optimise, NULL, 0, ON_WORKING | ON_INPUT, false},
    {"trace", run_trace, NULL, 0, ON_WORKING, true},
    {"triangulate", run_triangulate, NULL, 0, ON_WORKING, true},
    {"carve", run_carve, NULL, 0, ON_WORKING, true},
    {"check", run_check, NULL, 0, ON_WORKING, true},
    {"write-3mf", run_write, NULL, JALI_FORMAT_3MF, ON_WORKING, true},
    {"write-svg", run_write, NULL, JALI_FORMAT_SVG, ON_WORKING, true},
    {"whole", run_whole, NULL, JALI_FORMAT_3MF, ON_WORKING | ON_INPUT, false},
};
const int32_t bench_case_count = sizeof bench_cases / sizeof *bench_cases;
