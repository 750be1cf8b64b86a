// The drawing board: shapes are kept in a list and filled row by row, bands of rows in parallel.
//
// A pixel has the tone of the last shape that holds its centre. Rows visit each shape they cross once: a disc
// gives one run, a polygon the runs between its crossings.
// Checked: tests/test_sample.c: against the definition pixel by pixel, hashes of every sample.
#include "sample/draw.h"

#include <math.h>

enum { ROWS_A_BAND = 32, CURVE_PIECES = 40, SIDE = 1000 };

// Sine and cosine of an eighth turn at most, by their series; the first term left out is below 1e-17.
spot direction(double turns)
{
    double quarters = floor(turns * 4 + 0.5);
    int32_t quarter = (int32_t)(quarters - 4 * floor(quarters / 4));
    double angle = (turns - quarters / 4) * 6.28318530717958647692;
    double square = angle * angle, sine = 0, cosine = 0;
    for (int32_t k = 19; k >= 1; k -= 2) sine = 1 - sine * square / ((k + 1) * (k + 2));
    for (int32_t k = 18; k >= 0; k -= 2) cosine = 1 - cosine * square / ((k + 1) * (k + 2));
    sine *= angle;
    switch (quarter) {
    case 0: return at(cosine, sine);
    case 1: return at(-sine, cosine);
    case 2: return at(-cosine, -sine);
    default: return at(sine, -cosine);
    }
}

double length_of(spot a)
{
    return sqrt(a.x * a.x + a.y * a.y);
}

spot bezier(spot a, spot b, spot c, spot d, double f)
{
    spot ab = between(a, b, f), bc = between(b, c, f), cd = between(c, d, f);
    return between(between(ab, bc, f), between(bc, cd, f), f);
}

double next_share(board *b)
{
    b->seed = b->seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(b->seed >> 40) / (1 << 24);
}

void begin_polygon(board *b, tone t)
{
    if (b->status == JALI_OK) b->status = GROW(b->ctx, b->shape, b->shape_capacity, b->shape_count + 1);
    if (b->status != JALI_OK) return;
    b->shape[b->shape_count] = (shape){.tone = t, .first = (int32_t)b->point_count, .top = SIDE, .bottom = 0};
}

void add_point(board *b, spot p)
{
    if (b->status == JALI_OK) b->status = GROW(b->ctx, b->point, b->point_capacity, b->point_count + 1);
    if (b->status != JALI_OK) return;
    b->point[b->point_count++] = p;
}

void add_bezier(board *b, spot from, spot c1, spot c2, spot to)
{
    for (int32_t i = 1; i <= CURVE_PIECES; i++)
        add_point(b, bezier(from, c1, c2, to, (double)i / CURVE_PIECES));
}

void end_polygon(board *b)
{
    if (b->status != JALI_OK) return;
    shape *s = &b->shape[b->shape_count++];
    s->count = (int32_t)b->point_count - s->first;
    for (int32_t i = 0; i < s->count; i++) {
        s->top = MIN(s->top, b->point[s->first + i].y);
        s->bottom = MAX(s->bottom, b->point[s->first + i].y);
    }
    b->largest_polygon = MAX(b->largest_polygon, s->count);
}

void draw_disc(board *b, tone t, spot centre, double radius)
{
    begin_polygon(b, t);
    add_point(b, centre);
    end_polygon(b);
    if (b->status != JALI_OK) return;
    shape *s = &b->shape[b->shape_count - 1];
    s->radius = radius;
    s->top = centre.y - radius;
    s->bottom = centre.y + radius;
}

void draw_ring(board *b, spot centre, double radius, double width)
{
    draw_disc(b, WHITE, centre, radius + width / 2);
    draw_disc(b, BLACK, centre, radius - width / 2);
}

void draw_polygon(board *b, tone t, const spot *p, int32_t count)
{
    begin_polygon(b, t);
    for (int32_t i = 0; i < count; i++) add_point(b, p[i]);
    end_polygon(b);
}

void draw_box(board *b, tone t, double left, double top, double right, double bottom)
{
    draw_polygon(b, t, (spot[]){at(left, top), at(right, top), at(right, bottom), at(left, bottom)}, 4);
}

static spot across(spot from, spot to)
{
    spot along = minus(to, from);
    double length = length_of(along);
    return length > 0 ? at(-along.y / length, along.x / length) : at(0, 0);
}

static void draw_taper(board *b, tone t, spot from, spot to, double width_from, double width_to)
{
    spot side = across(from, to), a = times(side, width_from / 2), z = times(side, width_to / 2);
    draw_polygon(b, t, (spot[]){plus(from, a), plus(to, z), minus(to, z), minus(from, a)}, 4);
}

void draw_bar(board *b, tone t, spot from, spot to, double width)
{
    draw_taper(b, t, from, to, width, width);
}

void draw_bent_bar(board *b, tone t, spot from, spot bend, spot to, double width)
{
    spot a = across(from, bend), z = across(bend, to);
    spot corner = times(plus(a, z), width / 2 / (1 + a.x * z.x + a.y * z.y));
    a = times(a, width / 2);
    z = times(z, width / 2);
    draw_polygon(b, t,
                 (spot[]){plus(from, a), plus(bend, corner), plus(to, z), minus(to, z), minus(bend, corner),
                          minus(from, a)},
                 6);
}

void draw_limb(board *b, tone t, spot from, spot to, double width_from, double width_to)
{
    draw_taper(b, t, from, to, width_from, width_to);
    draw_disc(b, t, from, width_from / 2);
    draw_disc(b, t, to, width_to / 2);
}

void draw_curve(board *b, tone t, const spot p[4], double width_from, double width_to)
{
    spot last = p[0];
    for (int32_t i = 1; i <= CURVE_PIECES; i++) {
        double f = (double)i / CURVE_PIECES, g = (double)(i - 1) / CURVE_PIECES;
        spot next = bezier(p[0], p[1], p[2], p[3], f);
        draw_limb(b, t, last, next, width_from + (width_to - width_from) * g,
                  width_from + (width_to - width_from) * f);
        last = next;
    }
}

void draw_leaf(board *b, tone t, spot from, spot to, double bulge, double bend)
{
    spot along = minus(to, from), side = at(-along.y, along.x);
    spot a = between(from, to, 0.3), z = between(from, to, 0.72);
    double out = bulge * 1.5, in = bend;
    begin_polygon(b, t);
    add_point(b, from);
    add_bezier(b, from, plus(a, times(side, out + in)), plus(z, times(side, out * 0.75 + in)), to);
    add_bezier(b, to, plus(z, times(side, in - out * 0.75)), plus(a, times(side, in - out)), from);
    end_polygon(b);
}

typedef struct crossing {
    double x;
    int32_t turn;
} crossing;

typedef struct filling {
    const board *board;
    jali_bitmap *bitmap;
    crossing *crossing; // [bands * largest_polygon]
} filling;

static void fill_run(uint64_t *row, tone t, int32_t first, int32_t end)
{
    for (int32_t x = first; x < end;) {
        int32_t count = MIN(64 - (x & 63), end - x);
        uint64_t mask = (~UINT64_C(0) >> (64 - count)) << (x & 63);
        row[x >> 6] = t == WHITE ? row[x >> 6] | mask : row[x >> 6] & ~mask;
        x += count;
    }
}

// The pixels whose centres lie in left .. right, a centre on the right end not counted.
static void fill_between(uint64_t *row, tone t, double left, double right, int32_t side_px)
{
    double scale = (double)side_px / SIDE;
    double first = ceil(left * scale - 0.5), end = ceil(right * scale - 0.5);
    if (end <= 0 || first >= side_px) return;
    fill_run(row, t, (int32_t)MAX(first, 0), (int32_t)MIN(end, side_px));
}

static int32_t cross(const spot *p, int32_t count, double y, crossing *found)
{
    int32_t crossings = 0;
    for (int32_t i = 0; i < count; i++) {
        spot a = p[i], z = p[i + 1 < count ? i + 1 : 0];
        if ((a.y <= y) == (z.y <= y)) continue;
        crossing c = {a.x + (y - a.y) * (z.x - a.x) / (z.y - a.y), a.y <= y ? 1 : -1};
        int32_t k = crossings++;
        for (; k > 0 && found[k - 1].x > c.x; k--) found[k] = found[k - 1];
        found[k] = c;
    }
    return crossings;
}

static void fill_shape(const board *b, const shape *s, double y, crossing *scratch, uint64_t *row,
                       int32_t side_px)
{
    const spot *p = &b->point[s->first];
    if (s->radius > 0) {
        double rise = y - p->y, square = s->radius * s->radius - rise * rise;
        if (square <= 0) return;
        double half = sqrt(square);
        fill_between(row, s->tone, p->x - half, p->x + half, side_px);
        return;
    }
    int32_t crossings = cross(p, s->count, y, scratch), winding = 0;
    for (int32_t i = 0; i + 1 < crossings; i++) {
        winding += scratch[i].turn;
        if (winding != 0) fill_between(row, s->tone, scratch[i].x, scratch[i + 1].x, side_px);
    }
}

static void fill_band(void *shared, int32_t index)
{
    const filling *job = shared;
    const board *b = job->board;
    int32_t side_px = job->bitmap->width_px;
    int32_t first = index * ROWS_A_BAND, end = MIN(first + ROWS_A_BAND, side_px);
    crossing *scratch = job->crossing + (size_t)index * (size_t)b->largest_polygon;
    double step_y = (double)SIDE / side_px;
    for (size_t i = 0; i < b->shape_count; i++) {
        const shape *s = &b->shape[i];
        int32_t from = MAX(first, (int32_t)MIN(MAX(floor(s->top / step_y) - 1, 0), side_px));
        int32_t to = MIN(end, (int32_t)MIN(MAX(ceil(s->bottom / step_y) + 1, 0), side_px));
        for (int32_t y = from; y < to; y++)
            fill_shape(b, s, (y + 0.5) * step_y, scratch, job->bitmap->word + y * job->bitmap->stride,
                       side_px);
    }
}

jali_status rasterise_board(board *b, jali_bitmap *bitmap)
{
    jali_status status = b->status;
    arena_mark mark = arena_here(b->ctx);
    filling job = {b, bitmap, NULL};
    int32_t bands = (bitmap->height_px + ROWS_A_BAND - 1) / ROWS_A_BAND;
    if (status != JALI_OK) return status;
    TRY(step(b->ctx, "sample", 0));
    TRY(ARENA(b->ctx, job.crossing, (size_t)bands * (size_t)b->largest_polygon));
    parallel(b->ctx, bands, fill_band, &job);
    status = step(b->ctx, "sample", 1);
done:
    arena_rewind(b->ctx, mark);
    return status;
}
