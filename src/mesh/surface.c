// Surfaces from files: read, put upright, mended; and the one door to all surfaces.
//
// Checked: tests/test_mend.c.
#include <jali/surface.h>
#include "base/bytes.h"
#include "base/file.h"
#include "mesh/mend.h"
#include "mesh/merge.h"
#include "mesh/readers.h"
#include "mesh/spec.h"
#include "mesh/turn.h"

#include <math.h>

static const double largest_mm = 10000;

jali_surface_options jali_surface_defaults(void)
{
    return (jali_surface_options){
        .tolerance_mm = 0.02, .unit_mm = 1, .up = 3, .model = jali_model_defaults()};
}

void jali_surface_free(jali_context *ctx, jali_surface *surface)
{
    jali_mesh_free(ctx, &surface->mesh);
    release(ctx, surface->uv);
    release(ctx, surface->faulty);
    *surface = (jali_surface){0};
}

void jali_surface_report_free(jali_context *ctx, jali_surface_report *report)
{
    release(ctx, report->faulty);
    *report = (jali_surface_report){0};
}

// ---- upright, in mm ----

static jali_status check_options(jali_context *ctx, const jali_surface_options *opt)
{
    if (!(opt->unit_mm >= 1e-6 && opt->unit_mm <= 1e6))
        return fail(ctx, JALI_BAD_VALUE, "the file's unit must be 1e-6 .. 1e6 mm, not %g", opt->unit_mm);
    if (opt->height_mm != 0 && !(opt->height_mm >= 0.1 && opt->height_mm <= largest_mm))
        return fail(ctx, JALI_BAD_VALUE, "the surface's height must be 0.1 .. %g mm, not %g", largest_mm,
                    opt->height_mm);
    if (!(fabs(opt->turn_degrees) <= 360))
        return fail(ctx, JALI_BAD_VALUE, "the surface's turn must be -360 .. 360 degrees, not %g",
                    opt->turn_degrees);
    if (opt->up == 0 || opt->up < -3 || opt->up > 3)
        return fail(ctx, JALI_BAD_VALUE, "the axis that points up must be 1 .. 3 or -3 .. -1, not %d",
                    opt->up);
    return JALI_OK;
}

// Turn about x or y, so that the axis points up; then about the vertical.
static void turn_point(const jali_surface_options *opt, double sine, double cosine, const double p[3],
                       double q[3])
{
    const double upright[6][3] = {
        {p[2], p[1], -p[0]}, {p[0], p[2], -p[1]}, {p[0], -p[1], -p[2]}, // -x, -y, -z
        {-p[2], p[1], p[0]}, {p[0], -p[2], p[1]}, {p[0], p[1], p[2]}};  // x, y, z
    const double *u = upright[opt->up < 0 ? -opt->up - 1 : opt->up + 2];
    q[0] = cosine * u[0] - sine * u[1];
    q[1] = sine * u[0] + cosine * u[1];
    q[2] = u[2];
}

static void bounds_of(const jali_mesh *mesh, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
        for (int32_t i = 0; i < mesh->vertex_count; i++) {
            low[k] = MIN(low[k], mesh->vertex[i][k]);
            high[k] = MAX(high[k], mesh->vertex[i][k]);
        }
    }
}

static jali_status put_upright(jali_context *ctx, const char *name, const jali_surface_options *opt,
                               jali_mesh *mesh)
{
    double low[3], high[3], scale = opt->unit_mm, angle = opt->turn_degrees * M_PI / 180;
    for (int32_t i = 0; i < mesh->vertex_count; i++) {
        double upright[3];
        turn_point(opt, sin(angle), cos(angle), mesh->vertex[i], upright);
        memcpy(mesh->vertex[i], upright, sizeof upright);
    }
    bounds_of(mesh, low, high);
    if (opt->height_mm > 0) {
        if (!(high[2] > low[2]))
            return fail(ctx, JALI_BAD_VALUE, "%s is flat and cannot be scaled to a height; give its unit",
                        name);
        scale = opt->height_mm / (high[2] - low[2]);
    }
    for (int k = 0; k < 3; k++)
        if (scale * (high[k] - low[k]) > largest_mm)
            return fail(ctx, JALI_BAD_VALUE,
                        "%s is %.6g x %.6g x %.6g mm; up to %g mm a side can be carved: give its unit", name,
                        scale * (high[0] - low[0]), scale * (high[1] - low[1]), scale * (high[2] - low[2]),
                        largest_mm);
    for (int32_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            double origin = k < 2 ? 0.5 * (low[k] + high[k]) : low[k];
            mesh->vertex[i][k] = scale * (mesh->vertex[i][k] - origin);
        }
    mesh_round(mesh);
    return JALI_OK;
}

// ---- texture points ----

static double area_in_space(const jali_mesh *mesh, int32_t t)
{
    double n[3], square = 0;
    const double *a = mesh->vertex[mesh->triangle[t][0]], *b = mesh->vertex[mesh->triangle[t][1]];
    const double *c = mesh->vertex[mesh->triangle[t][2]];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        square += n[k] * n[k];
    }
    return 0.5 * sqrt(square);
}

static double area_unrolled(const double uv[3][2])
{
    return 0.5 * fabs((uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) -
                      (uv[1][1] - uv[0][1]) * (uv[2][0] - uv[0][0]));
}

// False when the texture points span no area that could be scaled.
static bool scale_texture(jali_surface *surface)
{
    double space = 0, flat = 0;
    for (int32_t t = 0; t < surface->mesh.triangle_count; t++) {
        space += area_in_space(&surface->mesh, t);
        flat += area_unrolled((const double(*)[2])surface->uv[t]);
    }
    double scale = sqrt(space / flat);
    if (!(flat > 0) || !isfinite(scale)) return false;
    for (int32_t t = 0; t < surface->mesh.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            for (int axis = 0; axis < 2; axis++) surface->uv[t][k][axis] *= scale;
    return true;
}

// ---- parts that cross ----

static bool no_worse(const jali_surface_report *now, const jali_surface_report *before)
{
    return now->intersections.count < before->intersections.count &&
           now->open_edges.count <= before->open_edges.count &&
           now->crowded_edges.count <= before->crowded_edges.count &&
           now->crowded_vertices.count <= before->crowded_vertices.count &&
           now->misdirected_edges.count <= before->misdirected_edges.count;
}

// What was found first and put right stays in the report; what is left is that of the merged surface.
static void take_merged(jali_context *ctx, jali_surface *surface, merging *merged,
                        jali_surface_report *report, jali_surface_report *found)
{
    found->shells = report->shells;
    found->open_edges = report->open_edges;
    found->crowded_edges = report->crowded_edges;
    found->crowded_vertices = report->crowded_vertices;
    found->misdirected_edges = report->misdirected_edges;
    found->intersections = report->intersections;
    found->intersections_capped = report->intersections_capped;
    found->faulty_triangles = report->faulty_triangles;
    release(ctx, found->faulty);
    found->faulty = report->faulty;
    report->faulty = NULL;
    jali_mesh_free(ctx, &surface->mesh);
    surface->mesh = merged->mesh;
    merged->mesh = (jali_mesh){0};
    release(ctx, surface->uv);
    surface->uv = merged->uv;
    merged->uv = NULL;
}

// Parts that cross become one. Each round begins with what the last one left: rounding can make new
// crossings, much smaller ones. Where it does not get better, the surface stays as it was.
static jali_status merge_parts(jali_context *ctx, jali_surface *surface, jali_surface_report *found)
{
    enum { ROUNDS = 6 };
    jali_status status = JALI_OK;
    merging merged = {0};
    jali_surface_report report = {0}, before = *found;
    bool *marked = NULL, first = true;
    if (found->intersections.count == 0 || found->intersections_capped) return JALI_OK;
    TRY(ALLOCATE_CLEARED(ctx, marked, surface->mesh.triangle_count));
    for (int32_t round = 0; round < ROUNDS && found->intersections.count > 0; round++) {
        TRY(merge_crossings(ctx, &surface->mesh, (const double(*)[3][2])surface->uv, marked, round, &merged));
        if (!merged.done) continue;
        TRY(mend(ctx, &merged.mesh, merged.uv, merged.faulty, &report));
        if (no_worse(&report, found)) {
            if (first) found->merged = before.intersections;
            first = false;
            take_merged(ctx, surface, &merged, &report, found);
            release(ctx, marked);
            marked = merged.faulty;
            merged.faulty = NULL;
        }
        jali_surface_report_free(ctx, &report);
        merging_free(ctx, &merged);
    }
done:
    release(ctx, marked);
    jali_surface_report_free(ctx, &report);
    merging_free(ctx, &merged);
    return status;
}

// ---- files ----

jali_status jali_surface_read(jali_context *ctx, const char *path, const jali_surface_options *given,
                              jali_surface *surface, jali_surface_report *report)
{
    jali_status status;
    jali_surface_options opt = given ? *given : jali_surface_defaults();
    jali_bytes bytes = {0};
    jali_surface_report found = {0};
    *surface = (jali_surface){0};
    if (report) *report = (jali_surface_report){0};
    TRY(check_options(ctx, &opt));
    TRY(file_read(ctx, path, (size_t)MIN(opt.model.max_bytes, SIZE_MAX / 4), &bytes));
    const model_file file = {(const char *)bytes.data, bytes.size, strcmp(path, "-") ? path : "stdin",
                             opt.model};
    TRY(read_any_model(ctx, &file, &surface->mesh, &surface->uv));
    jali_bytes_free(ctx, &bytes);
    found.file_vertices = surface->mesh.vertex_count;
    found.file_triangles = surface->mesh.triangle_count;
    TRY(put_upright(ctx, file.name, &opt, &surface->mesh));
    TRY(mend(ctx, &surface->mesh, surface->uv, NULL, &found));
    TRY(merge_parts(ctx, surface, &found));
    found.vertices = surface->mesh.vertex_count;
    found.triangles = surface->mesh.triangle_count;
    if (found.triangles == 0) TRY(fail(ctx, JALI_BAD_INPUT, "%s: no triangle has an area", file.name));
    if (surface->uv && (opt.untextured || !scale_texture(surface))) {
        release(ctx, surface->uv);
        surface->uv = NULL;
    }
    surface->textured = surface->uv != NULL;
done:
    jali_bytes_free(ctx, &bytes);
    if (status != JALI_OK) jali_surface_free(ctx, surface);
    if (status == JALI_OK && report)
        *report = found;
    else
        jali_surface_report_free(ctx, &found);
    return status;
}

// ---- descriptions ----

static jali_status take_keys(jali_context *ctx, const char *keys, jali_surface_options *opt)
{
    static const char *const axes[] = {"x", "y", "z", "-x", "-y", "-z"}, *const units[] = {"mm", "cm", "m",
                                                                                           "in"};
    static const double unit_mm[] = {1, 10, 1000, 25.4};
    jali_status status;
    static const char *const answers[] = {"yes", "no"};
    int32_t without = opt->untextured, axis = opt->up > 0 ? opt->up - 1 : 2 - opt->up, unit = -1;
    double scale = 1;
    spec s;
    TRY(spec_split(ctx, "a model", keys, &s));
    TRY(spec_choice(ctx, &s, "up", axes, 6, &axis));
    TRY(spec_choice(ctx, &s, "unit", units, 4, &unit));
    TRY(spec_number(ctx, &s, "scale", 1e-6, 1e6, &scale));
    TRY(spec_number(ctx, &s, "height", 0.1, largest_mm, &opt->height_mm));
    TRY(spec_number(ctx, &s, "turn", -360, 360, &opt->turn_degrees));
    TRY(spec_choice(ctx, &s, "texture", answers, 2, &without));
    TRY(spec_finish(ctx, &s));
    opt->untextured = without == 1;
    opt->up = axis < 3 ? axis + 1 : 2 - axis;
    opt->unit_mm = (unit < 0 ? opt->unit_mm : unit_mm[unit]) * scale;
done:
    return status;
}

// The whole of it may be the name of a file, else what stands before the last colon that has an = behind it.
static const char *keys_of(jali_context *ctx, const char *description)
{
    const char *colon = strrchr(description, ':');
    if (!colon || file_exists(ctx, description) || !strchr(colon, '=')) return NULL;
    return colon + 1;
}

jali_status jali_surface_open(jali_context *ctx, const char *description, const jali_surface_options *given,
                              jali_surface *surface, jali_surface_report *report)
{
    jali_status status;
    jali_surface_options opt = given ? *given : jali_surface_defaults();
    char *path = NULL;
    *surface = (jali_surface){0};
    if (report) *report = (jali_surface_report){0};
    bool like_a_file =
        strpbrk(description, "./") || file_exists(ctx, description) || strcmp(description, "-") == 0;
    if (shape_named(description) >= 0 || !like_a_file)
        return jali_surface_make(ctx, description, &opt, surface);
    const char *keys = keys_of(ctx, description);
    size_t length = keys ? (size_t)(keys - 1 - description) : strlen(description);
    if (keys) TRY(take_keys(ctx, keys, &opt));
    TRY(ALLOCATE(ctx, path, length + 1));
    memcpy(path, description, length);
    path[length] = 0;
    TRY(jali_surface_read(ctx, path, &opt, surface, report));
done:
    release(ctx, path);
    return status;
}

// ---- sentences ----

typedef struct phrase {
    const jali_finding *found;
    const char *one, *many;
} phrase;

static jali_status say(jali_context *ctx, const phrase *p, const char *before, jali_bytes *text)
{
    const double *at = p->found->at_mm;
    if (p->found->count == 0) return JALI_OK;
    return bytes_print(ctx, text, "%s%lld %s; %s at (%.6g, %.6g, %.6g) mm.\n", before,
                       (long long)p->found->count, p->found->count == 1 ? p->one : p->many,
                       p->found->count == 1 ? "it is" : "the first is", at[0], at[1], at[2]);
}

jali_status jali_surface_sentences(jali_context *ctx, const jali_surface_report *r, jali_bytes *text)
{
    jali_status status = JALI_OK;
    const phrase phrases[] = {
        {&r->degenerate_triangles, "triangle without area was dropped",
         "triangles without area were dropped"},
        {&r->repeated_triangles, "second copy of a triangle was dropped",
         "second copies of triangles were dropped"},
        {&r->turned_triangles, "triangle that faced the wrong way was turned over",
         "triangles that faced the wrong way were turned over"},
        {&r->open_edges, "edge is open", "edges are open"},
        {&r->crowded_edges, "edge is shared by more than two triangles",
         "edges are shared by more than two triangles"},
        {&r->crowded_vertices, "vertex joins parts that meet nowhere else",
         "vertices join parts that meet nowhere else"},
        {&r->misdirected_edges, "edge has sides that cannot be told apart",
         "edges have sides that cannot be told apart"},
    };
    const phrase merged = {&r->merged, "pair of triangles intersected: the parts there were made one",
                           "pairs of triangles intersected: the parts there were made one"};
    const phrase crossing = {&r->intersections, "pair of triangles intersects",
                             "pairs of triangles intersect"};
    if (r->welded_vertices > 0)
        TRY(bytes_print(ctx, text, "%d vertices at the place of another were welded to it.\n",
                        r->welded_vertices));
    for (size_t i = 0; i < sizeof phrases / sizeof *phrases; i++) TRY(say(ctx, &phrases[i], "", text));
    TRY(say(ctx, &merged, "", text));
    TRY(say(ctx, &crossing, r->intersections_capped ? "At least " : "", text));
done:
    return status;
}
