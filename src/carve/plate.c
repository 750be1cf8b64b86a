// The outline of a plate: a rectangle with round corners, a hole to hang it by, and an ear for the hole when
// the frame is too narrow. The ear is a half disc around the hole, widened down to the plate's edge by
// fillets.
//
// Checked: tests/test_carve.c: areas against their formulas, the web around the hole.
#include "carve/plate.h"

#include <math.h>

static const double ARC_DEVIATION_MM = 0.01;

static int32_t units(double mm, const jali_chart *chart)
{
    return (int32_t)lround(mm / chart->unit_mm);
}

static jali_status check_options(jali_context *ctx, const jali_chart *chart, const jali_carve_options *opt)
{
    const struct {
        const char *name;
        double mm, least;
    } value[] = {
        {"thickness", opt->thickness_mm, chart->unit_mm},
        {"frame", opt->frame_mm, 0},
        {"corner radius", opt->corner_radius_mm, 0},
        {"hole diameter", opt->hole_diameter_mm, 0},
        {"web around the hole", opt->hole_web_mm, chart->unit_mm},
    };
    const double most = (1 << 23) * chart->unit_mm;
    for (size_t i = 0; i < sizeof value / sizeof *value; i++)
        if (!(value[i].mm >= value[i].least && value[i].mm <= most))
            return fail(ctx, JALI_BAD_VALUE, "a %s of %g mm: %g to %g mm is accepted", value[i].name,
                        value[i].mm, value[i].least, most);
    if (!chart->outside_solid &&
        (opt->frame_mm > 0 || opt->hole_diameter_mm > 0 || opt->corner_radius_mm > 0))
        return fail(ctx, JALI_BAD_VALUE,
                    "a frame, round corners or a hanging hole need a picture whose outside is solid");
    return JALI_OK;
}

// The hole's centre is as low as the picture allows, and no lower than the plate's edge when it needs an ear.
static jali_status lay_out_hole(jali_context *ctx, const jali_chart *chart, const jali_carve_options *opt,
                                plate *p)
{
    double diameter = opt->hole_diameter_mm, web = opt->hole_web_mm, unit = chart->unit_mm;
    double width_mm = (p->right - p->left) * unit, needed_mm = diameter + 2 * web;
    p->hole_radius = 0.5 * diameter / unit;
    p->hole_x = 0.5 * ((double)p->left + p->right);
    p->hole_y = p->top - 0.5 * opt->frame_mm / unit;
    if (opt->frame_mm < needed_mm) {
        double picture_top = p->top - opt->frame_mm / unit;
        p->hole_y = MAX(p->top, picture_top + (web + 0.5 * diameter) / unit);
        p->ear_radius = 0.5 * needed_mm / unit;
        p->fillet_radius = web / unit;
        needed_mm += 2 * web + 2 * opt->corner_radius_mm;
    }
    if (needed_mm > width_mm)
        return fail(
            ctx, JALI_NO_RESULT,
            "a hanging hole of %g mm with %g mm around it needs %g mm of the plate's top edge, which has "
            "%g mm: choose a smaller hole or a wider picture",
            diameter, web, needed_mm, width_mm);
    return JALI_OK;
}

jali_status lay_out_plate(jali_context *ctx, const jali_chart *chart, const jali_carve_options *opt, plate *p)
{
    *p = (plate){0};
    jali_status status = check_options(ctx, chart, opt);
    if (status != JALI_OK || !chart->outside_solid) return status;
    int32_t frame = units(opt->frame_mm, chart), margin = chart->margin_px * chart->pixel_units;
    p->left = p->bottom = margin - frame;
    p->right = chart->width_px * chart->pixel_units - margin + frame;
    p->top = chart->height_px * chart->pixel_units - margin + frame;
    p->corner = opt->corner_radius_mm / chart->unit_mm;
    int32_t shorter = MIN(p->right - p->left, p->top - p->bottom);
    if (shorter <= 0)
        return fail(ctx, JALI_BAD_VALUE, "a margin of %d px leaves nothing of %d x %d px", chart->margin_px,
                    chart->width_px, chart->height_px);
    if (2 * p->corner > shorter)
        return fail(ctx, JALI_BAD_VALUE,
                    "a corner radius of %g mm: up to %g mm, half the plate's shorter side, is accepted",
                    opt->corner_radius_mm, 0.5 * shorter * chart->unit_mm);
    if (opt->hole_diameter_mm > 0) status = lay_out_hole(ctx, chart, opt, p);
    double highest = MAX(p->top, p->hole_y + p->ear_radius);
    if (status == JALI_OK && (p->left < -(1 << 24) || p->right > 1 << 24 || highest > 1 << 24))
        return fail(ctx, JALI_LIMIT,
                    "the plate is larger than %g mm, the most on this grid: choose larger pixels",
                    (1 << 24) * chart->unit_mm);
    return status;
}

// A contour under construction; point NULL: count only.
typedef struct pen {
    int32_t (*point)[2], count;
    double unit_mm;
} pen;

static void draw_point(pen *to, double x, double y)
{
    int32_t at[2] = {(int32_t)lround(x), (int32_t)lround(y)};
    if (to->point) memcpy(to->point[to->count], at, sizeof at);
    to->count++;
}

// From one angle to another (radians), either way round, both ends included.
static void draw_arc(pen *to, double x, double y, double radius, double start, double end)
{
    double share = ARC_DEVIATION_MM / (radius * to->unit_mm);
    double most = share < 0.5 ? 2 * acos(1 - share) : 2; // a deviation of half the radius is coarse enough
    int steps = (int)MAX(ceil(fabs(end - start) / most), 1);
    for (int i = 0; i <= steps; i++) {
        double angle = start + (end - start) * i / steps;
        draw_point(to, x + radius * cos(angle), y + radius * sin(angle));
    }
}

static void draw_corner(pen *to, double x, double y, double radius, int quarter)
{
    if (radius < 1)
        draw_point(to, x, y);
    else {
        double cx = x + (quarter == 0 || quarter == 3 ? -radius : radius),
               cy = y + (quarter < 2 ? -radius : radius);
        draw_arc(to, cx, cy, radius, quarter * M_PI_2, (quarter + 1) * M_PI_2);
    }
}

// Along the top edge from right to left. A fillet is tangent to the edge and to the half disc, or to its
// upright side when the disc stands higher than the fillet.
static void draw_ear(pen *to, const plate *p)
{
    double fillet = p->fillet_radius, drop = p->top + fillet - p->hole_y; // fillet centre above the hole's
    double aside = p->ear_radius + fillet, angle = 0;
    if (drop > 0) {
        angle = asin(MIN(drop / aside, 1));
        aside *= cos(angle);
    }
    double fillet_y = p->top + fillet;
    draw_arc(to, p->hole_x + aside, fillet_y, fillet, 1.5 * M_PI, M_PI + angle);
    draw_arc(to, p->hole_x, p->hole_y, p->ear_radius, angle, M_PI - angle);
    draw_arc(to, p->hole_x - aside, fillet_y, fillet, -angle, -M_PI_2);
}

static void draw_outline(pen *to, const plate *p)
{
    draw_corner(to, p->right, p->top, p->corner, 0);
    if (p->ear_radius > 0) draw_ear(to, p);
    draw_corner(to, p->left, p->top, p->corner, 1);
    draw_corner(to, p->left, p->bottom, p->corner, 2);
    draw_corner(to, p->right, p->bottom, p->corner, 3);
}

static void draw_hole(pen *to, const plate *p)
{
    if (p->hole_radius > 0) draw_arc(to, p->hole_x, p->hole_y, p->hole_radius, 2 * M_PI, 0);
}

// Drop points equal to their predecessor around the contour; returns how many stay.
static int32_t drop_repeats(int32_t (*point)[2], int32_t count)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        const int32_t *before = kept > 0 ? point[kept - 1] : point[count - 1];
        if (before[0] != point[i][0] || before[1] != point[i][1])
            memmove(point[kept++], point[i], sizeof point[0]);
    }
    return kept;
}

jali_status draw_plate(jali_context *ctx, const plate *p, double unit_mm, jali_contours *contours)
{
    jali_status status;
    pen outline = {.unit_mm = unit_mm}, hole = outline;
    *contours = (jali_contours){.unit_mm = unit_mm};
    draw_outline(&outline, p);
    draw_hole(&hole, p);
    TRY(ALLOCATE_CLEARED(ctx, contours->first, 3));
    TRY(ALLOCATE(ctx, contours->point, outline.count + hole.count));
    outline = (pen){.point = contours->point, .unit_mm = unit_mm};
    draw_outline(&outline, p);
    contours->contour_count = 1;
    contours->point_count = contours->first[1] = drop_repeats(contours->point, outline.count);
    hole = (pen){.point = contours->point + contours->point_count, .unit_mm = unit_mm};
    draw_hole(&hole, p);
    if (hole.count > 0) {
        contours->point_count += drop_repeats(hole.point, hole.count);
        contours->first[++contours->contour_count] = contours->point_count;
    }
done:
    if (status != JALI_OK) jali_contours_free(ctx, contours);
    return status;
}
