// A board's contours: one outline around solid, and voids in it that touch nowhere.
//
// Checked: tests/test_board.c, against the features' own figures.
#include "board/glyphs.h"
#include "plane/rasterise.h"

#include <math.h>

enum { CIRCLE_SIDES = 128, LATTICE = 1 << 24, MOST_CORNERS = CIRCLE_SIDES + 16 };

// Contours under construction. The first failure to grow is kept in `status`; what is cut after it is
// dropped.
typedef struct cutter {
    jali_context *ctx;
    jali_status status;
    size_t first_capacity, point_capacity;
    jali_contours *to;
} cutter;

typedef struct polygon {
    int32_t count;
    double corner[MOST_CORNERS][2];
} polygon;

static void add(polygon *p, double x, double y)
{
    p->corner[p->count][0] = x;
    p->corner[p->count++][1] = y;
}

static void put_point(cutter *c, const double at[2])
{
    jali_contours *to = c->to;
    int32_t first = to->first[to->contour_count];
    int32_t point[2] = {(int32_t)lround(at[0] / to->unit_mm), (int32_t)lround(at[1] / to->unit_mm)};
    if (to->point_count > first && memcmp(to->point[to->point_count - 1], point, sizeof point) == 0) return;
    memcpy(to->point[to->point_count++], point, sizeof point);
}

// Add a polygon that is given counter-clockwise: as it is around solid, turned around for a void.
static void put(cutter *c, const polygon *p, bool solid)
{
    jali_contours *to = c->to;
    if (c->status == JALI_OK)
        c->status = GROW(c->ctx, to->point, c->point_capacity, to->point_count + p->count);
    if (c->status == JALI_OK) c->status = GROW(c->ctx, to->first, c->first_capacity, to->contour_count + 2);
    if (c->status != JALI_OK) return;
    to->first[to->contour_count] = to->point_count;
    for (int32_t i = 0; i < p->count; i++) put_point(c, p->corner[solid ? i : p->count - 1 - i]);
    to->first[++to->contour_count] = to->point_count;
}

// A rectangle around a centre, turned by an angle whose cosine and sine are given.
static void cut_box(cutter *c, const double at[2], double along, double across, double cosine, double sine)
{
    static const double corner[4][2] = {{-.5, -.5}, {.5, -.5}, {.5, .5}, {-.5, .5}};
    polygon p = {0};
    for (int k = 0; k < 4; k++) {
        double u = corner[k][0] * along, v = corner[k][1] * across;
        add(&p, at[0] + u * cosine - v * sine, at[1] + u * sine + v * cosine);
    }
    put(c, &p, false);
}

// The radius at which a polygon's corners give it the circle's area.
static double corner_radius(double diameter)
{
    double half_side = M_PI / CIRCLE_SIDES;
    return diameter / 2 * sqrt(half_side / (sin(half_side) * cos(half_side)));
}

static void cut_disc(cutter *c, const double at[2], double diameter)
{
    polygon p = {0};
    double radius = corner_radius(diameter);
    for (int k = 0; k < CIRCLE_SIDES; k++) {
        double angle = 2 * M_PI * k / CIRCLE_SIDES;
        add(&p, at[0] + radius * cos(angle), at[1] + radius * sin(angle));
    }
    put(c, &p, false);
}

// What a diagonal bar leaves of its square window: a triangle above it and one below.
static void cut_beside_diagonal(cutter *c, const jali_board_feature *f)
{
    double a = (f->length_mm + f->width_mm) * M_SQRT1_2 / 2, leg = 2 * a - f->width_mm * M_SQRT1_2;
    for (int side = -1; side <= 1; side += 2) {
        polygon p = {0};
        double x = f->at_mm[0] - side * a, y = f->at_mm[1] + side * a; // the window's corner off the bar
        add(&p, x, y);
        add(&p, x, y - side * leg);
        add(&p, x + side * leg, y);
        put(c, &p, false);
    }
}

// The window of a pin, around the disc and its stem.
static void cut_around_pin(cutter *c, const jali_board_feature *f)
{
    polygon p = {0};
    double a = f->reach_mm, half_stem = f->beside_mm / 2, radius = corner_radius(f->width_mm);
    double x = f->at_mm[0], y = f->at_mm[1], start = asin(half_stem / radius);
    const double box[4][2] = {{half_stem, -a}, {a, -a}, {a, a}, {-a, a}};
    for (int k = 0; k < 4; k++) add(&p, x + box[k][0], y + box[k][1]);
    add(&p, x - a, y - a);
    add(&p, x - half_stem, y - a);
    // Back around the disc, clockwise, so that it stays outside the void: from the stem's left to its right.
    for (int k = 0; k <= CIRCLE_SIDES; k++) {
        double angle = 2 * M_PI - start - (2 * M_PI - 2 * start) * k / CIRCLE_SIDES - M_PI_2;
        add(&p, x + radius * cos(angle), y + radius * sin(angle));
    }
    put(c, &p, false);
}

// Voids of given widths side by side across a window, with solid between them: bars and pairs.
static void cut_strips(cutter *c, const jali_board_feature *f, const double *strip, int32_t count)
{
    bool upright = f->direction == JALI_BOARD_VERTICAL;
    double from = 0;
    for (int32_t i = 0; i < count; i++) from -= strip[i] / 2;
    for (int32_t i = 0; i < count; from += strip[i++]) {
        double offset = from + strip[i] / 2;
        double at[2] = {f->at_mm[0] + (upright ? offset : 0), f->at_mm[1] + (upright ? 0 : offset)};
        if (i % 2 == 0) cut_box(c, at, f->length_mm, strip[i], upright ? 0 : 1, upright ? 1 : 0);
    }
}

static void cut_feature(cutter *c, const jali_board_feature *f)
{
    double w = f->width_mm, b = f->beside_mm, rest = (f->length_mm - w) / 2;
    switch (f->kind) {
    case JALI_BOARD_VOID:
        if (f->direction == JALI_BOARD_DIAGONAL)
            cut_box(c, f->at_mm, f->length_mm, w, M_SQRT1_2, M_SQRT1_2);
        else
            cut_strips(c, f, &w, 1);
        break;
    case JALI_BOARD_SOLID:
        if (f->direction == JALI_BOARD_DIAGONAL)
            cut_beside_diagonal(c, f);
        else
            cut_strips(c, f, (double[]){rest, w, rest}, 3);
        break;
    case JALI_BOARD_SOLID_PAIR: cut_strips(c, f, (double[]){b, w, b}, 3); break;
    case JALI_BOARD_VOID_PAIR: cut_strips(c, f, (double[]){rest - b, b, w, b, rest - b}, 5); break;
    case JALI_BOARD_HOLE: cut_disc(c, f->at_mm, w); break;
    default: cut_around_pin(c, f);
    }
}

static void cut_label(cutter *c, const jali_board *board, const jali_board_label *l)
{
    double along = 0;
    stroke_outline outline[STROKES];
    for (const char *letter = l->text; *letter; along += letter_advance(board, *letter++)) {
        int32_t count = draw_letter(board, *letter, outline);
        for (int32_t i = 0; i < count; i++) {
            polygon p = {0};
            for (int32_t k = 0; k < outline[i].count; k++) {
                double u = along + outline[i].corner[k][0], v = outline[i].corner[k][1];
                add(&p, l->at_mm[0] + (l->upwards ? -v : u), l->at_mm[1] + (l->upwards ? u : v));
            }
            put(c, &p, false);
        }
    }
}

static void draw_outline(cutter *c, const jali_board *board)
{
    enum { QUARTER = 16 };
    polygon p = {0};
    double radius = board->mark_mm[0][0] / 2;
    for (int corner = 0; corner < 4; corner++)
        for (int k = 0; k <= QUARTER; k++) {
            double angle = M_PI_2 * (corner + 2 + (double)k / QUARTER);
            double x = corner == 0 || corner == 3 ? radius : board->width_mm - radius;
            double y = corner < 2 ? radius : board->height_mm - radius;
            add(&p, x + radius * cos(angle), y + radius * sin(angle));
        }
    put(c, &p, true);
}

// The finest power of two on which the board has less than 2^24 units (docs/decisions/0001).
static double finest_unit(const jali_board *board)
{
    double unit = 1, extent = MAX(MAX(board->width_mm, board->height_mm), board->thickness_mm);
    while (extent < unit / 2 * LATTICE) unit /= 2;
    return unit;
}

jali_status jali_board_contours(jali_context *ctx, const jali_board *board, jali_contours *contours)
{
    cutter c = {.ctx = ctx, .to = contours};
    *contours = (jali_contours){.unit_mm = finest_unit(board)};
    draw_outline(&c, board);
    for (int32_t i = 0; i < JALI_BOARD_MARKS; i++) cut_disc(&c, board->mark_mm[i], board->mark_diameter_mm);
    for (int32_t i = 0; i < JALI_BOARD_CODE_BITS; i++)
        if (board->code[i]) cut_box(&c, board->code_mm[i], board->code_side_mm, board->code_side_mm, 1, 0);
    for (int32_t i = 0; i < board->label_count; i++) cut_label(&c, board, &board->label[i]);
    for (int32_t i = 0; i < board->feature_count; i++) cut_feature(&c, &board->feature[i]);
    if (c.status != JALI_OK) jali_contours_free(ctx, contours);
    return c.status;
}

jali_status jali_board_bitmap(jali_context *ctx, const jali_board *board, double *pixel_mm,
                              jali_bitmap *bitmap)
{
    jali_status status;
    jali_contours contours = {0};
    *bitmap = (jali_bitmap){0};
    if (!(*pixel_mm >= 0.002 && *pixel_mm <= 10))
        return fail(ctx, JALI_BAD_VALUE, "a board's pixel of %g mm: 0.002 to 10 mm is accepted", *pixel_mm);
    TRY(jali_board_contours(ctx, board, &contours));
    jali_chart chart = {.unit_mm = contours.unit_mm,
                        .pixel_units = 2 * (int32_t)lround(*pixel_mm / contours.unit_mm / 2)};
    *pixel_mm = chart.pixel_units * chart.unit_mm;
    chart.width_px = (int32_t)lround(board->width_mm / *pixel_mm);
    chart.height_px = (int32_t)lround(board->height_mm / *pixel_mm);
    TRY(rasterise(ctx, &contours, &chart, bitmap));
done:
    jali_contours_free(ctx, &contours);
    return status;
}
