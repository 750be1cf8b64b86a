// What of the surface is seen at samples of the picture's plane, and the view with the most room.
//
// Checked: tests/test_place_on.c.
#include "place/lay.h"

#include <math.h>

static const double VIEW_SAMPLES = 256;    // along the longer side of the object
static const double TILTS[] = {1.5, 2, 3}; // most stretch of a face that is room: as little as will do
enum { TILT_COUNT = sizeof TILTS / sizeof *TILTS };
static const double ROOM_STEP = 1.03;         // scales that are tried
static const int32_t MOST_SAMPLES = 64 << 20; // of any view

jali_status view_create(jali_context *ctx, const double low[2], const double high[2], double step_mm,
                        bool depth, view *v)
{
    jali_status status = JALI_OK;
    double columns = floor((high[0] - low[0]) / step_mm) + 1, rows = floor((high[1] - low[1]) / step_mm) + 1;
    if (!(columns * rows <= MOST_SAMPLES))
        return fail(ctx, JALI_LIMIT, "a view of %.0f x %.0f samples is too large", columns, rows);
    *v = (view){{low[0], low[1]}, step_mm, (int32_t)columns, (int32_t)rows, NULL, NULL};
    size_t count = (size_t)v->columns * (size_t)v->rows;
    TRY(ARENA(ctx, v->face, count + 1));
    if (depth) TRY(ARENA(ctx, v->nearness, count + 1));
    for (size_t i = 0; i < count; i++) v->face[i] = -1;
done:
    return status;
}

// Depth is affine on a face in a parallel view, its inverse is in a perspective.
static double nearness_of(const laid *l, int32_t vertex)
{
    return l->perspective ? 1 / l->depth[vertex] : -l->depth[vertex];
}

static void draw_face(const laid *l, int32_t face, double shift, view *v)
{
    double x[3], y[3], near[3] = {0};
    for (int k = 0; k < 3; k++) {
        x[k] = (l->at[face][k][0] + shift - v->low[0]) / v->step;
        y[k] = (l->at[face][k][1] - v->low[1]) / v->step;
        if (v->nearness) near[k] = nearness_of(l, l->surface->mesh.triangle[face][k]);
    }
    double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if (!(fabs(area) > 0)) return;
    double low = MAX(ceil(MIN(y[0], MIN(y[1], y[2]))), 0),
           high = MIN(MAX(y[0], MAX(y[1], y[2])), v->rows - 1);
    for (double row = low; row <= high; row++) {
        double first = INFINITY, last = -INFINITY; // where the row of samples cuts the face
        for (int k = 0; k < 3; k++) {
            int n = (k + 1) % 3;
            if ((y[k] <= row) == (y[n] <= row)) continue;
            double cut = x[k] + (row - y[k]) / (y[n] - y[k]) * (x[n] - x[k]);
            first = MIN(first, cut);
            last = MAX(last, cut);
        }
        for (double column = MAX(ceil(first), 0); column <= MIN(last, v->columns - 1); column++) {
            size_t i = (size_t)row * (size_t)v->columns + (size_t)column;
            if (v->nearness) {
                double b = ((column - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (row - y[0])) / area;
                double c = ((x[1] - x[0]) * (row - y[0]) - (column - x[0]) * (y[1] - y[0])) / area;
                double here = near[0] + b * (near[1] - near[0]) + c * (near[2] - near[0]);
                if (v->face[i] >= 0 && v->nearness[i] >= (float)here) continue;
                v->nearness[i] = (float)here;
            }
            v->face[i] = face;
        }
    }
}

void draw_faces(const laid *l, const uint8_t *only, const int32_t *turns, view *v)
{
    for (int32_t t = 0; t < l->surface->mesh.triangle_count; t++)
        if (!only || only[t]) draw_face(l, t, turns ? turns[t] * l->around_mm : 0, v);
}

// --- The view with the most room

// Sums of bad samples over all rectangles from the corner: [(rows + 1) * (columns + 1)].
static void sum_bad(const laid *l, const view *v, double tilt, int32_t *sum)
{
    int32_t width = v->columns + 1;
    memset(sum, 0, (size_t)width * sizeof *sum);
    for (int32_t y = 0; y < v->rows; y++) {
        sum[(y + 1) * width] = 0;
        for (int32_t x = 0; x < v->columns; x++) {
            size_t i = (size_t)y * (size_t)v->columns + (size_t)x;
            double g[3];
            bool bad = v->face[i] < 0 || !face_metric(l, v->face[i], g) || g[0] + g[2] > 1 + tilt * tilt;
            // A jump in depth between neighbours is an edge behind which something is hidden.
            for (int k = 0; k < 2 && !bad; k++) {
                size_t next = i + (k ? (size_t)v->columns : 1);
                if ((k ? y + 1 == v->rows : x + 1 == v->columns) || v->face[next] < 0) continue;
                bad = fabsf(v->nearness[next] - v->nearness[i]) > 2 * TILTS[TILT_COUNT - 1] * v->step;
            }
            sum[(y + 1) * width + x + 1] =
                sum[y * width + x + 1] + sum[(y + 1) * width + x] - sum[y * width + x] + bad;
        }
    }
}

// Has the picture room at a scale? The sample of its centre; of several the one nearest to the middle of the
// view.
static bool has_room(const view *v, const int32_t *sum, const double half_mm[2], double scale,
                     int32_t centre[2])
{
    int32_t hx = (int32_t)ceil(scale * half_mm[0] / v->step),
            hy = (int32_t)ceil(scale * half_mm[1] / v->step);
    int32_t width = v->columns + 1;
    double nearest = INFINITY;
    for (int32_t y = hy; y < v->rows - hy; y++)
        for (int32_t x = hx; x < v->columns - hx; x++) {
            int32_t bad = sum[(y + hy + 1) * width + x + hx + 1] - sum[(y - hy) * width + x + hx + 1] -
                          sum[(y + hy + 1) * width + x - hx] + sum[(y - hy) * width + x - hx];
            double dx = x - v->columns / 2, dy = y - v->rows / 2, away = dx * dx + dy * dy;
            if (bad > 0 || away >= nearest) continue;
            nearest = away;
            centre[0] = x, centre[1] = y;
        }
    return nearest < INFINITY;
}

// The largest scale at which the picture has room, in steps, and its centre: what has room has it at every
// smaller scale too.
static double largest_room(const view *v, const int32_t *sum, const double half_mm[2], int32_t centre[2])
{
    double least = MAX(v->step / half_mm[0], v->step / half_mm[1]);
    int32_t fits = -1, fails = 1 + (int32_t)(log(MAX(v->columns, v->rows)) / log(ROOM_STEP));
    while (fails - fits > 1) {
        int32_t middle = fits + (fails - fits) / 2, at[2];
        bool room = has_room(v, sum, half_mm, least * pow(ROOM_STEP, middle), at);
        if (room) memcpy(centre, at, sizeof at);
        *(room ? &fits : &fails) = middle;
    }
    return fits < 0 ? 0 : least * pow(ROOM_STEP, fits);
}

static jali_status room_in_view(jali_context *ctx, const jali_surface *surface, const double half_mm[2],
                                double wanted, camera *c, double *room, int *tilt)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    laid l = {0};
    view v;
    int32_t *sum, centre[2] = {0, 0};
    TRY(lay_by_camera(ctx, surface, c, &l));
    for (int32_t t = 0; t < surface->mesh.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 2; i++) {
                low[i] = MIN(low[i], l.at[t][k][i]);
                high[i] = MAX(high[i], l.at[t][k][i]);
            }
    TRY(view_create(ctx, low, high, MAX(high[0] - low[0], high[1] - low[1]) / VIEW_SAMPLES, true, &v));
    TRY(ARENA(ctx, sum, ((size_t)v.rows + 1) * ((size_t)v.columns + 1)));
    draw_faces(&l, NULL, NULL, &v);
    *room = 0;
    for (*tilt = -1; *tilt + 1 < TILT_COUNT && *room < wanted;) {
        sum_bad(&l, &v, TILTS[++*tilt], sum);
        *room = largest_room(&v, sum, half_mm, centre);
    }
    double x = low[0] + centre[0] * v.step, y = low[1] + centre[1] * v.step;
    double depth = *room > 0 ? -v.nearness[(size_t)centre[1] * (size_t)v.columns + (size_t)centre[0]] : 0;
    for (int k = 0; k < 3; k++) c->centre[k] += x * c->right[k] + y * c->up[k] + depth * c->forward[k];
done:
    laid_free(ctx, &l);
    arena_rewind(ctx, mark);
    return status;
}

static bool no_direction(const double d[3])
{
    return d[0] == 0 && d[1] == 0 && d[2] == 0;
}

jali_status find_view(jali_context *ctx, const jali_surface *surface, const jali_place_options *opt,
                      const double half_mm[2], double wanted, camera *c, double *room)
{
    jali_status status = JALI_OK;
    enum { SIDES = 8 };
    jali_camera look = opt->camera;
    bool given = !no_direction(look.direction);
    camera best = {0};
    int least_tilt = TILT_COUNT, tilt;
    *room = -1;
    for (int i = 0; i < (given ? 1 : SIDES) && (i != 1 || *room < wanted); i++) {
        // The front when it has room, else the side that has it with the least tilt, else the one that has
        // most.
        double turn = (i % 2 ? -1 : 1) * ((i + 1) / 2) * 2 * acos(-1) / SIDES, here = 0;
        if (!given)
            memcpy(look.direction,
                   (double[3]){rint(1e9 * sin(turn)) / 1e9 + 0.0, rint(1e9 * cos(turn)) / 1e9 + 0.0, 0},
                   sizeof look.direction);
        TRY(aim(ctx, &look, (double[3]){0, 0, 0}, c));
        TRY(room_in_view(ctx, surface, half_mm, wanted, c, &here, &tilt));
        bool fits = here >= wanted, fitted = *room >= wanted;
        if (fits && fitted && tilt != least_tilt ? tilt < least_tilt : here > *room) {
            *room = here;
            least_tilt = tilt;
            best = *c;
        }
    }
    *c = best;
done:
    return status;
}
