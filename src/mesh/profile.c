// The curve of a surface of revolution.
//
// Smooth curves are centripetal Catmull-Rom splines: they pass through the given points, follow them without
// overshooting much and have no loops within a span.
//
// Source:  Yuksel, Schaefer and Keyser, Parameterization and applications of Catmull-Rom curves, 2011;
//          evaluated by Barry and Goldman's pyramid, 1988.
// Limits:  1000 points.
// Checked: tests/test_surface.c.
#include "mesh/profile.h"

#include "base/file.h"
#include "base/number.h"

#include <math.h>

enum { SPAN_SAMPLES = 64, CIRCLE_SAMPLES = 8192, MOST_POINTS = 1000, MOST_ROWS = 100000 };

void profile_free(jali_context *ctx, profile *p)
{
    release(ctx, p->point);
    *p = (profile){0};
}

void profile_measure(profile *p)
{
    p->point[0].along_mm = 0;
    for (int32_t i = 1; i < p->point_count; i++) {
        profile_point *here = &p->point[i], *before = here - 1;
        here->along_mm = before->along_mm +
                         hypot(here->radius_mm - before->radius_mm, here->height_mm - before->height_mm);
    }
    p->point[0].corner = p->point[p->point_count - 1].corner = true;
}

jali_status profile_line(jali_context *ctx, double base_mm, double top_mm, double height_mm, profile *p)
{
    // Rows are chosen among points, so a line has as many as a curve.
    *p = (profile){.point_count = CIRCLE_SAMPLES + 1};
    jali_status status = ALLOCATE_CLEARED(ctx, p->point, p->point_count);
    if (status != JALI_OK) return status;
    for (int32_t i = 0; i < p->point_count; i++) {
        double part = (double)i / CIRCLE_SAMPLES;
        p->point[i].radius_mm = base_mm + part * (top_mm - base_mm);
        p->point[i].height_mm = part * height_mm;
    }
    profile_measure(p);
    return JALI_OK;
}

jali_status profile_half_circle(jali_context *ctx, double radius_mm, profile *p)
{
    *p = (profile){.point_count = CIRCLE_SAMPLES + 1};
    jali_status status = ALLOCATE_CLEARED(ctx, p->point, p->point_count);
    if (status != JALI_OK) return status;
    for (int32_t i = 0; i < p->point_count; i++) {
        double angle = M_PI * i / CIRCLE_SAMPLES; // from the lowest point
        p->point[i].radius_mm = radius_mm * sin(angle);
        p->point[i].height_mm = radius_mm * (1 - cos(angle));
    }
    p->point[CIRCLE_SAMPLES].radius_mm = 0;
    profile_measure(p);
    return JALI_OK;
}

// ---- smooth curves ----

// Between a and b at knots 0 and 1 of four: the parameter advances by the root of the distance.
static void spline_point(const double a[4][2], double part, double at[2])
{
    double knot[4] = {0};
    for (int i = 1; i < 4; i++)
        knot[i] = knot[i - 1] + sqrt(hypot(a[i][0] - a[i - 1][0], a[i][1] - a[i - 1][1]));
    double t = knot[1] + part * (knot[2] - knot[1]), level[4][2];
    memcpy(level, a, sizeof level);
    // Each level of the pyramid blends neighbours over the knots they reach: 1, 2, then (again) 1 span wide.
    for (int depth = 1; depth <= 3; depth++)
        for (int i = 0; i + depth < 4; i++) {
            double from = depth == 3 ? knot[1] : knot[i], to = depth == 3 ? knot[2] : knot[i + depth];
            for (int k = 0; k < 2; k++)
                level[i][k] = ((to - t) * level[i][k] + (t - from) * level[i + 1][k]) / (to - from);
        }
    memcpy(at, level[0], sizeof level[0]);
}

// The neighbour of an end or corner: its own neighbour mirrored in it.
static void mirrored(const double end[2], const double neighbour[2], double at[2])
{
    for (int k = 0; k < 2; k++) at[k] = 2 * end[k] - neighbour[k];
}

static bool same_point(const double a[2], const double b[2])
{
    return a[0] == b[0] && a[1] == b[1];
}

static void add_point(profile *p, const double at[2], bool corner)
{
    p->point[p->point_count++] = (profile_point){.radius_mm = at[0], .height_mm = at[1], .corner = corner};
}

// One span from point i to point i + 1, without its end.
static void add_span(profile *p, int32_t count, const double (*point)[2], int32_t i)
{
    double around[4][2];
    bool starts = i == 0 || same_point(point[i - 1], point[i]);
    bool ends = i + 2 == count || same_point(point[i + 1], point[i + 2]);
    memcpy(around[1], point[i], sizeof around[1]);
    memcpy(around[2], point[i + 1], sizeof around[2]);
    if (starts)
        mirrored(around[1], around[2], around[0]);
    else
        memcpy(around[0], point[i - 1], sizeof around[0]);
    if (ends)
        mirrored(around[2], around[1], around[3]);
    else
        memcpy(around[3], point[i + 2], sizeof around[3]);
    add_point(p, point[i], starts);
    for (int32_t s = 1; s < SPAN_SAMPLES; s++) {
        double at[2];
        spline_point((const double(*)[2])around, (double)s / SPAN_SAMPLES, at);
        add_point(p, at, false);
    }
}

static jali_status check_radii(jali_context *ctx, const char *what, const profile *p)
{
    for (int32_t i = 0; i < p->point_count; i++) {
        bool end = i == 0 || i == p->point_count - 1;
        double radius = p->point[i].radius_mm;
        if (radius < 0 || (radius == 0 && !end))
            return fail(ctx, JALI_BAD_VALUE,
                        "%s: the curve meets the axis at height %.4g mm; only its ends may", what,
                        p->point[i].height_mm);
    }
    return JALI_OK;
}

jali_status profile_through(jali_context *ctx, const char *what, int32_t count, const double (*given)[2],
                            profile *p)
{
    jali_status status;
    double(*point)[2] = NULL;
    *p = (profile){0};
    if (count < 2 || count > MOST_POINTS)
        TRY(fail(ctx, JALI_BAD_VALUE, "%s: a profile has 2 .. %d points, not %d", what, MOST_POINTS, count));
    TRY(ALLOCATE(ctx, point, count));
    bool falls = given[count - 1][1] < given[0][1];
    for (int32_t i = 0; i < count; i++) memcpy(point[i], given[falls ? count - 1 - i : i], sizeof *point);
    for (int32_t i = 0; i + 2 < count; i++)
        if (same_point(point[i], point[i + 1]) && same_point(point[i], point[i + 2]))
            TRY(fail(ctx, JALI_BAD_VALUE, "%s: the point %g, %g stands there more than twice", what,
                     point[i][0], point[i][1]));
    TRY(ALLOCATE_CLEARED(ctx, p->point, (size_t)count * SPAN_SAMPLES));
    for (int32_t i = 0; i + 1 < count; i++)
        if (!same_point(point[i], point[i + 1])) add_span(p, count, (const double(*)[2])point, i);
    add_point(p, point[count - 1], true);
    if (p->point_count < 2) TRY(fail(ctx, JALI_BAD_VALUE, "%s: all points are the same", what));
    TRY(check_radii(ctx, what, p));
    profile_measure(p);
done:
    release(ctx, point);
    if (status != JALI_OK) profile_free(ctx, p);
    return status;
}

static const char *skip_blanks(const char *at, const char *end)
{
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\r' || *at == ',')) at++;
    return at;
}

jali_status profile_read(jali_context *ctx, const char *path, profile *p)
{
    jali_status status;
    jali_bytes bytes = {0};
    double point[MOST_POINTS][2];
    int32_t count = 0, line = 0;
    *p = (profile){0};
    TRY(file_read(ctx, path, 1 << 20, &bytes));
    const char *at = (const char *)bytes.data, *end = at + bytes.size;
    while (at < end) {
        const char *line_end = memchr(at, '\n', (size_t)(end - at));
        if (!line_end) line_end = end;
        const char *words_end = memchr(at, '#', (size_t)(line_end - at));
        if (!words_end) words_end = line_end;
        line++;
        at = skip_blanks(at, words_end);
        if (at < words_end) {
            if (count == MOST_POINTS)
                TRY(fail(ctx, JALI_BAD_INPUT, "%s: more than %d points", path, MOST_POINTS));
            for (int k = 0; k < 2; k++) {
                if (!read_decimal(&at, words_end, &point[count][k]) || fabs(point[count][k]) > 1e4)
                    TRY(fail(ctx, JALI_BAD_INPUT, "%s, line %d: a radius and a height in mm are needed", path,
                             line));
                at = skip_blanks(at, words_end);
            }
            if (at < words_end)
                TRY(fail(ctx, JALI_BAD_INPUT, "%s, line %d: more than a radius and a height", path, line));
            count++;
        }
        at = line_end + (line_end < end);
    }
    TRY(profile_through(ctx, path, count, (const double(*)[2])point, p));
done:
    jali_bytes_free(ctx, &bytes);
    return status;
}

// ---- rows ----

// How many rows the step up to point i asks for: a circle of radius 1/k leaves its chord of length s by
// k s^2 / 8.
static double rows_of_step(const profile *p, int32_t i, double tolerance_mm, double longest_mm)
{
    const profile_point *b = &p->point[i], *a = b - 1;
    double length = b->along_mm - a->along_mm, turn = 0;
    if (!a->corner) {
        const profile_point *z = a - 1;
        double ux = a->radius_mm - z->radius_mm, uy = a->height_mm - z->height_mm;
        double vx = b->radius_mm - a->radius_mm, vy = b->height_mm - a->height_mm;
        turn = fabs(atan2(ux * vy - uy * vx, ux * vx + uy * vy));
    }
    double bent = length > 0 ? sqrt(turn / length / (8 * tolerance_mm)) * length : 0;
    return MAX(bent, length / longest_mm);
}

jali_status profile_rows(jali_context *ctx, const profile *p, double tolerance_mm, double longest_mm,
                         int32_t **row, int32_t *row_count)
{
    jali_status status;
    *row = NULL;
    *row_count = 0;
    TRY(ALLOCATE(ctx, *row, p->point_count));
    (*row)[(*row_count)++] = 0;
    for (int32_t first = 0, last; first < p->point_count - 1; first = last) {
        double all = 0, sum = 0;
        for (last = first + 1; !p->point[last].corner; last++) {
        }
        for (int32_t i = first + 1; i <= last; i++) all += rows_of_step(p, i, tolerance_mm, longest_mm);
        double rows = MAX(ceil(all - 1e-9), 1), next = 1;
        for (int32_t i = first + 1; i < last; i++) {
            sum += rows_of_step(p, i, tolerance_mm, longest_mm);
            if (sum * rows < next * all || next >= rows) continue;
            (*row)[(*row_count)++] = i;
            next = floor(sum * rows / all) + 1;
        }
        (*row)[(*row_count)++] = last;
    }
    if (*row_count > MOST_ROWS) TRY(fail(ctx, JALI_LIMIT, "more than %d rows of triangles", MOST_ROWS));
done:
    if (status != JALI_OK) {
        release(ctx, *row);
        *row = NULL;
    }
    return status;
}

static double turn_of(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Does the path a, b, d turn straight back at b?
static bool folds(const double a[2], const double b[2], const double d[2])
{
    return turn_of(a, b, d) == 0 && (b[0] - a[0]) * (d[0] - b[0]) + (b[1] - a[1]) * (d[1] - b[1]) < 0;
}

static bool segments_meet(const double a[2], const double b[2], const double c[2], const double d[2])
{
    for (int k = 0; k < 2; k++)
        if (MAX(a[k], b[k]) < MIN(c[k], d[k]) || MAX(c[k], d[k]) < MIN(a[k], b[k])) return false;
    return turn_of(a, b, c) * turn_of(a, b, d) <= 0 && turn_of(c, d, a) * turn_of(c, d, b) <= 0;
}

static void point_of_row(const profile *p, const int32_t *row, int32_t i, double at[2])
{
    at[0] = i < 0 ? 0 : p->point[row[i]].radius_mm; // -1: the middle of the floor
    at[1] = p->point[row[MAX(i, 0)]].height_mm;
}

bool profile_crosses(const profile *p, const int32_t *row, int32_t row_count, bool floor, double at_mm[2])
{
    for (int32_t i = floor ? -1 : 0; i < row_count - 1; i++) {
        double a[2], b[2], c[2], d[2];
        point_of_row(p, row, i, a);
        point_of_row(p, row, i + 1, b);
        for (int32_t j = i + 1; j < row_count - 1; j++) {
            point_of_row(p, row, j, c);
            point_of_row(p, row, j + 1, d);
            if (j == i + 1 ? !folds(a, b, d) : !segments_meet(a, b, c, d)) continue;
            for (int k = 0; k < 2; k++) at_mm[k] = 0.5 * (c[k] + d[k]);
            return true;
        }
    }
    return false;
}
