// Surfaces made by formula: what their descriptions mean.
//
// Limits:  10 m a side, 4096 facets around.
// Checked: tests/test_surface.c.
#include "mesh/mesh.h"
#include "mesh/spec.h"
#include "mesh/turn.h"

#include <math.h>

static const double largest_mm = 10000, smallest_mm = 0.1;

static jali_status take_shared(jali_context *ctx, spec *s, bool may_have_floor, turned *t)
{
    static const char *const yes_or_no[] = {"no", "yes"};
    jali_status status;
    double facets = 0;
    TRY(spec_number(ctx, s, "facets", LEAST_FACETS, MOST_FACETS, &facets));
    TRY(spec_number(ctx, s, "tolerance", 0.0005, 10, &t->tolerance_mm));
    if (may_have_floor) TRY(spec_choice(ctx, s, "floor", yes_or_no, 2, &t->floor));
    TRY(spec_finish(ctx, s));
    if (facets != floor(facets))
        TRY(fail(ctx, JALI_BAD_VALUE, "%s: facets must be a whole number, not %g", s->what, facets));
    t->facets = (int32_t)facets;
done:
    return status;
}

static jali_status make_plate(jali_context *ctx, spec *s, turned *t, jali_surface *surface)
{
    jali_status status;
    double size[2] = {100, 100};
    (void)t;
    TRY(spec_number(ctx, s, "w", smallest_mm, largest_mm, &size[0]));
    TRY(spec_number(ctx, s, "h", smallest_mm, largest_mm, &size[1]));
    TRY(spec_finish(ctx, s));
    int32_t cells[2]; // nearly square, or a few at least
    for (int k = 0; k < 2; k++)
        cells[k] = (int32_t)MIN(ceil(longest_facets * size[k] / MIN(size[0], size[1])), 2000);
    int32_t columns = cells[0] + 1;
    TRY(surface_allocate(ctx, (int64_t)columns * (cells[1] + 1), 2 * (int64_t)cells[0] * cells[1], surface));
    jali_mesh *mesh = &surface->mesh;
    for (int32_t i = 0; i < mesh->vertex_count; i++) {
        mesh->vertex[i][0] = size[0] * ((double)(i % columns) / cells[0] - 0.5);
        mesh->vertex[i][1] = 0;
        mesh->vertex[i][2] = size[1] * (i / columns) / cells[1];
    }
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        int32_t cell = i / 2, v = cell / cells[0] * columns + cell % cells[0];
        const int32_t half[2][3] = {{v, v + 1, v + columns + 1}, {v, v + columns + 1, v + columns}};
        memcpy(mesh->triangle[i], half[i % 2], sizeof half[0]);
        for (int k = 0; k < 3; k++) {
            const double *at = mesh->vertex[mesh->triangle[i][k]];
            surface->uv[i][k][0] = at[0];
            surface->uv[i][k][1] = at[2];
        }
    }
done:
    return status;
}

static jali_status make_cylinder(jali_context *ctx, spec *s, turned *t, jali_surface *surface)
{
    jali_status status;
    double radius = 35, height = 70;
    TRY(spec_number(ctx, s, "r", smallest_mm, largest_mm, &radius));
    TRY(spec_number(ctx, s, "h", smallest_mm, largest_mm, &height));
    TRY(take_shared(ctx, s, true, t));
    TRY(profile_line(ctx, radius, radius, height, &t->curve));
    TRY(turn_profile(ctx, t, surface));
done:
    return status;
}

static jali_status make_cone(jali_context *ctx, spec *s, turned *t, jali_surface *surface)
{
    jali_status status;
    double base = 45, top = 30, height = 80;
    TRY(spec_number(ctx, s, "r", smallest_mm, largest_mm, &base));
    TRY(spec_number(ctx, s, "top", 0, largest_mm, &top));
    TRY(spec_number(ctx, s, "h", smallest_mm, largest_mm, &height));
    TRY(take_shared(ctx, s, true, t));
    if (top > 0 && top < smallest_mm)
        TRY(fail(ctx, JALI_BAD_VALUE, "cone: top must be 0 or at least %g, not %g", smallest_mm, top));
    TRY(profile_line(ctx, base, top, height, &t->curve));
    if (base != top) {
        t->sector = fabs(base - top) / hypot(base - top, height);
        t->cone_base_mm = base / t->sector * (base > top ? 1 : -1);
    }
    TRY(turn_profile(ctx, t, surface));
done:
    return status;
}

static jali_status make_sphere(jali_context *ctx, spec *s, turned *t, jali_surface *surface)
{
    jali_status status;
    double radius = 40;
    TRY(spec_number(ctx, s, "r", smallest_mm, largest_mm, &radius));
    TRY(take_shared(ctx, s, false, t));
    TRY(profile_half_circle(ctx, radius, &t->curve));
    TRY(turn_profile(ctx, t, surface));
done:
    return status;
}

// ---- vases ----

enum { VASE_POINTS = 12, VASES = 5 };

static const char *const vase_name[VASES] = {"classic", "bottle", "bowl", "tulip", "column"};

// Drawn by hand: radius and height in mm from the base up, a pair given twice is a corner, height 0 behind
// the first ends the list.
static const double vase_points[VASES][VASE_POINTS][2] = {
    {{34, 0}, {36, 5}, {33, 12}, {48, 48}, {57, 95}, {50, 140}, {31, 172}, {27, 184}, {38, 204}},
    {{36, 0}, {40, 6}, {40, 60}, {39, 92}, {28, 128}, {15, 152}, {13, 172}, {13, 200}, {16, 208}},
    {{30, 0}, {33, 3}, {46, 10}, {66, 30}, {77, 55}, {82, 82}},
    {{28, 0}, {40, 16}, {50, 50}, {51, 88}, {42, 128}, {40, 148}, {52, 180}},
    {{46, 0},
     {46, 10},
     {46, 10},
     {40, 22},
     {37, 60},
     {36, 100},
     {37, 140},
     {40, 178},
     {46, 190},
     {46, 190},
     {46, 200}},
};

static jali_status scale_vase(jali_context *ctx, double radius_mm, double height_mm, profile *p)
{
    double lowest = INFINITY, highest = -INFINITY, widest = widest_mm(p);
    for (int32_t i = 0; i < p->point_count; i++) {
        lowest = MIN(lowest, p->point[i].height_mm);
        highest = MAX(highest, p->point[i].height_mm);
    }
    if (highest - lowest < smallest_mm || widest < smallest_mm)
        return fail(ctx, JALI_BAD_VALUE, "vase: the profile is less than %g mm high or wide", smallest_mm);
    double around = radius_mm > 0 ? radius_mm / widest : 0,
           up = height_mm > 0 ? height_mm / (highest - lowest) : 0;
    if (around == 0) around = up > 0 ? up : 1;
    if (up == 0) up = radius_mm > 0 ? around : 1;
    for (int32_t i = 0; i < p->point_count; i++) {
        profile_point *at = &p->point[i];
        at->radius_mm *= around;
        at->height_mm = (at->height_mm - lowest) * up;
    }
    profile_measure(p);
    return JALI_OK;
}

static jali_status draw_vase(jali_context *ctx, int32_t vase, profile *p)
{
    int32_t count = 1;
    while (count < VASE_POINTS && vase_points[vase][count][1] > 0) count++;
    return profile_through(ctx, "vase", count, vase_points[vase], p);
}

static jali_status make_vase(jali_context *ctx, spec *s, turned *t, jali_surface *surface)
{
    jali_status status;
    double radius = 0, height = 0;
    int32_t vase = 0;
    const char *file;
    char path[4097] = "";
    int length;
    t->floor = true;
    TRY(spec_choice(ctx, s, "", vase_name, VASES, &vase));
    if (spec_text(s, "profile", &file, &length)) memcpy(path, file, (size_t)length);
    TRY(spec_number(ctx, s, "h", smallest_mm, largest_mm, &height));
    TRY(spec_number(ctx, s, "r", smallest_mm, largest_mm, &radius));
    TRY(take_shared(ctx, s, true, t));
    if (path[0])
        TRY(profile_read(ctx, path, &t->curve));
    else
        TRY(draw_vase(ctx, vase, &t->curve));
    TRY(scale_vase(ctx, radius, height, &t->curve));
    TRY(turn_profile(ctx, t, surface));
done:
    return status;
}

// ---- the list ----

static const jali_surface_info infos[] = {
    {"plate", "upright and flat; w=100, h=100 mm"},
    {"cylinder", "a tube; r=35, h=70 mm, floor=no"},
    {"cone", "a cone or a part of one; r=45 at the base, top=30, h=80 mm, floor=no"},
    {"sphere", "closed; r=40 mm"},
    {"vase:classic", "a vase with a foot, a belly and a neck; h=204, r=57 mm, floor=yes"},
    {"vase:bottle", "a bottle; h=208, r=40 mm, floor=yes"},
    {"vase:bowl", "a bowl; h=82, r=82 mm, floor=yes"},
    {"vase:tulip", "a cup that opens at the lip; h=180, r=52 mm, floor=yes"},
    {"vase:column", "a column with base and capital; h=200, r=46 mm, floor=yes"},
    {"vase:profile=FILE", "turned from \"radius height\" pairs in mm, one a line; h=, r=, floor=yes"},
};

const jali_surface_info *jali_surface_list(int32_t *count)
{
    *count = sizeof infos / sizeof *infos;
    return infos;
}

static const struct {
    const char *name;
    jali_status (*make)(jali_context *ctx, spec *s, turned *t, jali_surface *surface);
} shapes[] = {{"plate", make_plate},
              {"cylinder", make_cylinder},
              {"cone", make_cone},
              {"sphere", make_sphere},
              {"vase", make_vase}};

int32_t shape_named(const char *description)
{
    size_t length = strcspn(description, ":");
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        if (strlen(shapes[i].name) == length && memcmp(shapes[i].name, description, length) == 0)
            return (int32_t)i;
    return -1;
}

jali_status jali_surface_make(jali_context *ctx, const char *description, const jali_surface_options *given,
                              jali_surface *surface)
{
    jali_status status = JALI_OK;
    jali_surface_options opt = given ? *given : jali_surface_defaults();
    size_t length = strcspn(description, ":");
    int32_t shape = shape_named(description);
    spec s;
    turned t = {.tolerance_mm = opt.tolerance_mm};
    *surface = (jali_surface){0};
    if (!(opt.tolerance_mm >= 0.0005 && opt.tolerance_mm <= 10))
        TRY(fail(ctx, JALI_BAD_VALUE, "the surface's tolerance must be 0.0005 .. 10 mm, not %g",
                 opt.tolerance_mm));
    if (shape < 0)
        TRY(fail(ctx, JALI_BAD_VALUE,
                 "there is no surface \"%.*s\"; there are plate, cylinder, cone, sphere and vase",
                 (int)MIN(length, 40), description));
    t.name = shapes[shape].name;
    TRY(spec_split(ctx, t.name, description + length + (description[length] == ':'), &s));
    TRY(shapes[shape].make(ctx, &s, &t, surface));
    mesh_round(&surface->mesh);
done:
    profile_free(ctx, &t.curve);
    if (status != JALI_OK) jali_surface_free(ctx, surface);
    return status;
}
