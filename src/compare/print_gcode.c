// What G-code lays, seen from above.
//
// Two readings: the first finds the layers, by the heights at which plastic is laid, and how large they are;
// the second draws. Walls are counted over some layers of the middle, where no first layer is squashed and no
// skin closes: solid is what most of them cover. Filling is gathered over all layers, because skins close a
// sparse one; it lies inside the walls, so it does not move an edge.
//
// Checked: tests/test_gcode.c, fuzz/fuzz_gcode.c.
#include <jali/compare.h>
#include "base/lines.h"
#include "compare/gcode.h"
#include "compare/stroke.h"
#include "compare/votes.h"
#include "raster/raster.h"

#include <math.h>

enum {
    MOST_LAYERS = 100000, // 10 m in layers of 0.1 mm; a spiral vase has more heights
    MOST_SIDE_PX = 1 << 16,
    STEP_LINES = 1 << 14
};
static const int64_t most_px = INT64_C(1) << 31;
static const double ARC_DEVIATION_MM = 0.002;
static const double SAME_HEIGHT_MM = 1e-4;
static const double WIDEST_MM = 10; // of a stroke

typedef struct box {
    double low[2], high[2]; // empty when low > high
} box;

static const box no_box = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};

typedef struct layer {
    double z_mm;
    int64_t moves; // that lay walls
    box walls;     // around their strokes
} layer;

typedef struct gcode_drawing {
    lines in;
    jali_print_options opt;
    layer *layer; // [layer_count] by height
    size_t layer_count, layer_capacity;
    double filament_mm;
    // Of the second reading:
    bool drawing;
    int32_t current;         // layer on the sheet, or -1
    bool *chosen;            // [layer_count]
    jali_bitmap sheet, fill; // walls of one layer, filling of all
    layer_votes votes;       // of the sheets so far
    double left_mm, top_mm;  // of the bitmaps
} gcode_drawing;

// --- Layers

// The layer at a height, made when there is none.
static jali_status layer_at(jali_context *ctx, gcode_drawing *d, double z_mm, int32_t *index)
{
    size_t low = 0, high = d->layer_count;
    if (high > 0 && d->layer[high - 1].z_mm < z_mm - SAME_HEIGHT_MM) low = high; // the usual way: upwards
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (d->layer[middle].z_mm < z_mm - SAME_HEIGHT_MM)
            low = middle + 1;
        else
            high = middle;
    }
    *index = (int32_t)low;
    if (low < d->layer_count && d->layer[low].z_mm <= z_mm + SAME_HEIGHT_MM) return JALI_OK;
    if (d->drawing) return fail(ctx, JALI_IO, "%s changed while it was read", d->in.name);
    if (d->layer_count >= MOST_LAYERS)
        return fail(
            ctx, JALI_BAD_INPUT,
            "%s, line %lld: plastic is laid at more than %d heights; a print in spirals has no layers",
            d->in.name, (long long)d->in.number, MOST_LAYERS);
    jali_status status = GROW(ctx, d->layer, d->layer_capacity, d->layer_count + 1);
    if (status != JALI_OK) return status;
    memmove(d->layer + low + 1, d->layer + low, (d->layer_count - low) * sizeof *d->layer);
    d->layer[low] = (layer){.z_mm = z_mm, .walls = no_box};
    d->layer_count++;
    return JALI_OK;
}

// Keep the layers that have walls, and choose some of those between a quarter and three quarters.
static jali_status choose_layers(jali_context *ctx, gcode_drawing *d, jali_print *print)
{
    jali_status status = JALI_OK;
    int32_t count = 0, *with_walls = NULL;
    arena_mark mark = arena_here(ctx);
    TRY(ARENA(ctx, with_walls, d->layer_count + 1));
    for (size_t i = 0; i < d->layer_count; i++)
        if (d->layer[i].moves > 0) with_walls[count++] = (int32_t)i;
    if (count == 0)
        TRY(fail(ctx, JALI_BAD_INPUT,
                 "%s lays no plastic: G1 moves with X, Y and E are what an object is made of", d->in.name));
    TRY(allocate_cleared(ctx, &d->chosen, d->layer_count, sizeof *d->chosen));
    choose_middle(count, print);
    for (int32_t i = 0; i < print->looked_at; i++) d->chosen[with_walls[looked_at(print, i)]] = true;
done:
    arena_rewind(ctx, mark);
    return status;
}

// --- Widths

// A bead of width w and height h with half round sides has the area h (w - h) + pi h^2 / 4; what is fed too
// little for that height is a round thread.
static double bead_width(double area_mm2, double height_mm)
{
    double width = area_mm2 / height_mm + height_mm * (1 - M_PI / 4);
    return width >= height_mm ? width : sqrt(4 * area_mm2 / M_PI);
}

static double width_of(const gcode_drawing *d, const machine *m, const laid_move *move, int32_t layer_index)
{
    if (m->width_mm > 0) return m->width_mm;
    double height = m->height_mm;
    if (height == 0) {
        double below = layer_index > 0 ? d->layer[layer_index - 1].z_mm : 0;
        height = d->layer[layer_index].z_mm - below;
    }
    if (!(height > 0)) height = 0.2;
    double filament = d->filament_mm > 0 ? d->filament_mm : d->opt.filament_mm;
    return fmin(bead_width(move->feed_mm * M_PI * filament * filament / 4 / laid_length(move), height),
                WIDEST_MM);
}

// --- Drawing

// The straight pieces of a move, one by one; false after the last.
typedef struct pieces {
    const laid_move *move;
    int32_t count, next;
} pieces;

static pieces pieces_of(const laid_move *move)
{
    pieces p = {move, 1, 0};
    if (move->turn_rad == 0) return p;
    double radius = hypot(move->from[0] - move->centre[0], move->from[1] - move->centre[1]);
    double most = 2 * acos(fmax(1 - ARC_DEVIATION_MM / radius, 0.5));
    p.count = (int32_t)fmin(fmax(ceil(fabs(move->turn_rad) / most), 1), 1e6);
    return p;
}

static void point_on(const laid_move *move, double share, double at[2])
{
    double c = cos(share * move->turn_rad), s = sin(share * move->turn_rad);
    double x = move->from[0] - move->centre[0], y = move->from[1] - move->centre[1];
    at[0] = move->centre[0] + c * x - s * y;
    at[1] = move->centre[1] + s * x + c * y;
}

static bool next_piece(pieces *p, double from[2], double to[2])
{
    if (p->next == p->count) return false;
    bool first = p->next == 0, last = ++p->next == p->count;
    if (first)
        memcpy(from, p->move->from, 2 * sizeof *from);
    else
        memcpy(from, to, 2 * sizeof *from);
    if (last)
        memcpy(to, p->move->to, 2 * sizeof *to);
    else
        point_on(p->move, (double)p->next / p->count, to);
    return true;
}

static void grow_box(box *b, const double at[2], double by)
{
    for (int k = 0; k < 2; k++) {
        b->low[k] = fmin(b->low[k], at[k] - by);
        b->high[k] = fmax(b->high[k], at[k] + by);
    }
}

static void measure_move(layer *l, const laid_move *move, double width_mm)
{
    double from[2], to[2];
    l->moves++;
    for (pieces p = pieces_of(move); next_piece(&p, from, to);) {
        grow_box(&l->walls, from, width_mm / 2);
        grow_box(&l->walls, to, width_mm / 2);
    }
}

static void draw_move(const gcode_drawing *d, const laid_move *move, double width_mm, jali_bitmap *bitmap)
{
    double from[2], to[2], pixel = d->opt.pixel_mm;
    for (pieces p = pieces_of(move); next_piece(&p, from, to);) {
        double a[2] = {(from[0] - d->left_mm) / pixel, (d->top_mm - from[1]) / pixel};
        double b[2] = {(to[0] - d->left_mm) / pixel, (d->top_mm - to[1]) / pixel};
        draw_stroke(bitmap, a, b, width_mm / pixel);
    }
}

// --- The two readings

static jali_status begin_layer(jali_context *ctx, gcode_drawing *d, int32_t index)
{
    if (d->current == index) return JALI_OK;
    if (d->current >= 0) {
        if (d->layer[d->current].moves > 0)
            return fail(
                ctx, JALI_BAD_INPUT,
                "%s, line %lld: the layer at %.3f mm is left before it is done; objects printed one after "
                "the other cannot be told apart",
                d->in.name, (long long)d->in.number, d->layer[d->current].z_mm);
        vote(ctx, &d->votes, &d->sheet);
        fill(ctx, &d->sheet, false);
    }
    d->current = index;
    return JALI_OK;
}

static jali_status take_move(jali_context *ctx, gcode_drawing *d, const machine *m, const laid_move *move)
{
    jali_status status = JALI_OK;
    int32_t index;
    if (m->kind == LAID_OTHERS) return JALI_OK;
    TRY(layer_at(ctx, d, move->z_mm, &index));
    double width_mm = width_of(d, m, move, index);
    if (!d->drawing) {
        if (m->kind == LAID_WALL) measure_move(&d->layer[index], move, width_mm);
    } else if (m->kind == LAID_FILL) {
        draw_move(d, move, width_mm, &d->fill);
    } else if (d->chosen[index]) {
        TRY(begin_layer(ctx, d, index));
        d->layer[index].moves--;
        draw_move(d, move, width_mm, &d->sheet);
    }
done:
    return status;
}

static jali_status read_moves(jali_context *ctx, gcode_drawing *d)
{
    jali_status status;
    machine m = machine_at_rest();
    laid_move move;
    bool more, lays;
    TRY(lines_rewind(ctx, &d->in));
    for (;;) {
        if (d->in.number % STEP_LINES == 0)
            TRY(step(ctx, "read", d->in.size ? (double)d->in.at / (double)d->in.size : 0));
        TRY(lines_next(ctx, &d->in, &more));
        if (!more) break;
        TRY(follow_line(ctx, &d->in, &m, &move, &lays));
        if (lays) TRY(take_move(ctx, d, &m, &move));
    }
    if (m.filament_mm > 0) d->filament_mm = m.filament_mm;
done:
    return status;
}

// A grid around the walls of the chosen layers, their centre on the corner between its four middle pixels.
static jali_status make_room(jali_context *ctx, gcode_drawing *d)
{
    jali_status status;
    const double margin_mm = 1; // a width may turn out larger once the filament is known
    box all = no_box;
    int32_t side[2];
    for (size_t i = 0; i < d->layer_count; i++)
        if (d->chosen[i]) {
            grow_box(&all, d->layer[i].walls.low, 0);
            grow_box(&all, d->layer[i].walls.high, 0);
        }
    for (int k = 0; k < 2; k++) {
        double px = 2 * ceil(((all.high[k] - all.low[k]) / 2 + margin_mm) / d->opt.pixel_mm);
        if (!(px <= MOST_SIDE_PX))
            return fail(
                ctx, JALI_LIMIT,
                "%s: %.0f mm of print in pixels of %.3g mm are more than %d px; a coarser pixel would do",
                d->in.name, all.high[k] - all.low[k], d->opt.pixel_mm, MOST_SIDE_PX);
        side[k] = (int32_t)px;
    }
    if ((int64_t)side[0] * side[1] > most_px)
        return fail(ctx, JALI_LIMIT, "%s: a drawing of %d x %d px is too large; a coarser pixel would do",
                    d->in.name, side[0], side[1]);
    d->left_mm = (all.low[0] + all.high[0]) / 2 - 0.5 * side[0] * d->opt.pixel_mm;
    d->top_mm = (all.low[1] + all.high[1]) / 2 + 0.5 * side[1] * d->opt.pixel_mm;
    TRY(jali_bitmap_create(ctx, side[0], side[1], &d->sheet));
    TRY(jali_bitmap_create(ctx, side[0], side[1], &d->fill));
    TRY(votes_create(ctx, side[0], side[1], &d->votes));
done:
    return status;
}

// Is it another type of file, by its first bytes?
static jali_status check_type(jali_context *ctx, gcode_drawing *d)
{
    jali_status status;
    bool more;
    TRY(lines_next(ctx, &d->in, &more));
    if (!more) TRY(fail(ctx, JALI_BAD_INPUT, "%s is empty", d->in.name));
    if (strncmp(d->in.text, "GCDE", 4) == 0)
        TRY(fail(ctx, JALI_BAD_INPUT, "%s is binary G-code; have the slicer write it as text", d->in.name));
    if (strncmp(d->in.text, "PK\3\4", 4) == 0)
        TRY(fail(ctx, JALI_BAD_INPUT, "%s is an archive, no G-code; SL1 files are for --sl1", d->in.name));
done:
    return status;
}

static void drawing_free(jali_context *ctx, gcode_drawing *d)
{
    lines_close(ctx, &d->in);
    release(ctx, d->layer);
    release(ctx, d->chosen);
    jali_bitmap_free(ctx, &d->sheet);
    jali_bitmap_free(ctx, &d->fill);
    votes_free(ctx, &d->votes);
}

// `d` has its lines; everything of it is freed.
static jali_status print_lines(jali_context *ctx, gcode_drawing *d, const jali_print_options *given,
                               jali_print *print)
{
    jali_status status;
    d->opt = given ? *given : jali_print_defaults();
    d->current = -1;
    if (!(d->opt.pixel_mm >= 0.001 && d->opt.pixel_mm <= 1) ||
        !(d->opt.filament_mm > 0 && d->opt.filament_mm <= 20))
        TRY(fail(ctx, JALI_BAD_VALUE,
                 "a pixel of %g mm and a filament of %g mm: 0.001 to 1 mm and up to 20 mm are accepted",
                 d->opt.pixel_mm, d->opt.filament_mm));
    print->pixel_mm[0] = print->pixel_mm[1] = d->opt.pixel_mm;
    TRY(check_type(ctx, d));
    TRY(read_moves(ctx, d));
    TRY(choose_layers(ctx, d, print));
    TRY(make_room(ctx, d));
    d->drawing = true;
    TRY(read_moves(ctx, d));
    TRY(begin_layer(ctx, d, -1));
    TRY(votes_majority(ctx, &d->votes, &print->solid));
    combine(ctx, RULE_OR, &print->solid, &d->fill, &print->solid);
    measure_print(print);
done:
    if (status != JALI_OK) jali_print_free(ctx, print);
    drawing_free(ctx, d);
    return status;
}

jali_status jali_print_gcode(jali_context *ctx, const char *path, const jali_print_options *opt,
                             jali_print *print)
{
    gcode_drawing d = {0};
    *print = (jali_print){0};
    jali_status status = lines_open(ctx, path, &d.in);
    return status == JALI_OK ? print_lines(ctx, &d, opt, print) : status;
}

jali_status jali_print_gcode_bytes(jali_context *ctx, const void *bytes, size_t size, const char *name,
                                   const jali_print_options *opt, jali_print *print)
{
    gcode_drawing d = {0};
    *print = (jali_print){0};
    lines_of_bytes(bytes, size, name, &d.in);
    return print_lines(ctx, &d, opt, print);
}
