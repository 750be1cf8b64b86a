// Details of one tone: what an opening removes, sorted into types A, B and C.
//
// Source:  Binary Image Carving for 3D Printing, section 4.3, Eqs. 2 and 3.
// Method:  components of the removed pixels as runs; the ring around each (3 x 3 dilation minus itself, in
// the
//          other tone) is gathered in a window and its parts are counted as runs, in one pass. Details are
//          sorted side by side, the few large ones after the others.
// Limits:  a detail that crosses the bitmap's border has the border as part of its ring only where the
//          surroundings have the other tone.
// Checked: tests/test_adapt.c: bars, combs, rings; random pictures against the definition.
#include <jali/adapt.h>
#include "adapt/widths.h"
#include "base/base.h"

#include <math.h>

void jali_details_free(jali_context *ctx, jali_details *details)
{
    for (int32_t type = 0; type < JALI_TYPES; type++) jali_bitmap_free(ctx, &details->type[type]);
    *details = (jali_details){0};
}

// Details beyond these sizes are sorted one by one, in scratch of their own; SLOTS times the others' scratch
// is 11 MB at most.
enum { SLOTS = 16, MOST_WINDOW_WORDS = 1 << 16, MOST_RING_RUNS = 1 << 14, BAND_ROWS = 64 };

// One connected detail: its runs are order[first .. first + count - 1].
typedef struct detail {
    int32_t first, count;
    int32_t x0, y0, x1, y1;
    int32_t pixels;
    double axis_px; // on the surface
    int32_t type;
    bool touches_own; // a neighbour of its tone is no detail: it hangs on something larger
} detail;

// A run of a ring's pixels; the parts are trees of runs.
typedef struct ring_run {
    int32_t x0, x1, parent;
} ring_run;

// What it takes to sort a detail.
typedef struct scratch {
    uint64_t *window; // two planes: the detail and its ring
    ring_run *run;    // of the ring
} scratch;

typedef struct sorting {
    const jali_bitmap *picture;
    bool white, outside_solid, isolated_matters;
    const tiling *tiles;
    int32_t epsilon_px;
    components c;
    detail *detail;   // [c.count]
    int32_t *order;   // [c.run_count], runs by detail
    int32_t *row_of;  // [c.run_count]
    jali_bitmap axis; // of the removed pixels; empty where nobody needs it
    scratch slot[SLOTS];
    jali_details *details;
} sorting;

static jali_status gather_runs(jali_context *ctx, sorting *s)
{
    jali_status status;
    const components *c = &s->c;
    TRY(ALLOCATE_CLEARED(ctx, s->detail, c->count));
    TRY(ALLOCATE(ctx, s->order, c->run_count));
    TRY(ALLOCATE(ctx, s->row_of, c->run_count));
    for (int32_t i = 0; i < c->count; i++) s->detail[i].x0 = s->detail[i].y0 = INT32_MAX;
    for (int32_t y = 0; y < c->height_px; y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++) {
            detail *d = &s->detail[c->label[i]];
            d->count++;
            d->x0 = MIN(d->x0, c->span[i][0]);
            d->x1 = MAX(d->x1, c->span[i][1]);
            d->y0 = MIN(d->y0, y);
            d->y1 = y + 1;
            d->pixels += c->span[i][1] - c->span[i][0];
            s->row_of[i] = y;
        }
    for (int32_t i = 0, first = 0; i < c->count; i++) {
        s->detail[i].first = first;
        first += s->detail[i].count;
        s->detail[i].count = 0;
    }
    for (int32_t i = 0; i < c->run_count; i++) {
        detail *d = &s->detail[c->label[i]];
        s->order[d->first + d->count++] = i;
    }
done:
    return status;
}

// How long a pixel of the axis is on the surface: its length along the direction in which its neighbours lie.
static double length_of_pixel(const jali_bitmap *axis, const tiling *tiles, int32_t x, int32_t y)
{
    const double *g = metric_at(tiles, x, y);
    double flat = 0, stretched = 0;
    for (int32_t dy = -1; dy <= 1; dy++)
        for (int32_t dx = -1; dx <= 1; dx++) {
            int32_t u = x + dx, v = y + dy;
            if (u < 0 || v < 0 || u >= axis->width_px || v >= axis->height_px) continue;
            if ((dx == 0 && dy == 0) || !jali_bitmap_get(axis, u, v)) continue;
            flat += dx * dx + dy * dy;
            stretched += g[0] * dx * dx + 2 * g[1] * dx * dy + g[2] * dy * dy;
        }
    return flat > 0 ? sqrt(stretched / flat) : sqrt((g[0] + g[2]) / 2);
}

static double length_of_run(const jali_bitmap *axis, const tiling *tiles, int32_t y, int32_t x0, int32_t x1)
{
    if (is_flat(tiles)) return count_run(axis, y, x0, x1);
    const uint64_t *row = axis->word + (int64_t)y * axis->stride;
    double length = 0;
    for (int32_t x = next_white(row, x0, x1, 0); x < x1; x = next_white(row, x + 1, x1, 0))
        length += length_of_pixel(axis, tiles, x, y);
    return length;
}

// The axis has no more pixels than the detail: where no detail has enough, nobody needs an axis.
static jali_status find_axes(jali_context *ctx, sorting *s, const jali_bitmap *removed, int32_t rounds)
{
    int32_t largest = 0;
    for (int32_t i = 0; i < s->c.count; i++) largest = MAX(largest, s->detail[i].pixels);
    return largest * s->tiles->most_stretch > s->epsilon_px
               ? medial_axis(ctx, removed, true, false, rounds, &s->axis)
               : JALI_OK;
}

static void measure_axis(const sorting *s, detail *d)
{
    if (!s->axis.word || d->pixels * s->tiles->most_stretch <= s->epsilon_px) return;
    for (int32_t k = d->first; k < d->first + d->count; k++) {
        int32_t run = s->order[k];
        d->axis_px += length_of_run(&s->axis, s->tiles, s->row_of[run], s->c.span[run][0], s->c.span[run][1]);
    }
}

// A window of the picture around a detail: one pixel of ring, one word and row of zeros around that.
typedef struct frame {
    int32_t x0, y0, words, rows;
    int64_t pitch;
} frame;

static frame frame_of(const detail *d)
{
    frame f = {(d->x0 - 1) & ~63, d->y0 - 1, 0, d->y1 - d->y0 + 2, 0};
    f.words = (d->x1 + 1 - f.x0 + 63) / 64;
    f.pitch = f.words + 2;
    return f;
}

static int64_t window_words(const frame *f)
{
    return 2 * (f->rows + 2) * f->pitch;
}

// A run of n pixels has n + 2 pixels of ring above it, as many below and 2 beside it: at most n + 6 runs.
static int64_t most_ring_runs(const detail *d)
{
    return d->pixels + 6 * (int64_t)d->count;
}

static bool is_large(const detail *d)
{
    frame f = frame_of(d);
    return window_words(&f) > MOST_WINDOW_WORDS || most_ring_runs(d) > MOST_RING_RUNS;
}

static uint64_t *plane_row(uint64_t *window, const frame *f, int32_t plane, int32_t row)
{
    return window + ((int64_t)plane * (f->rows + 2) + row + 1) * f->pitch + 1;
}

// Plane 0: the detail. Plane 1: the pixels of the other tone around it. Also learns whether it touches its
// own.
static void draw_ring(const sorting *s, const frame *f, detail *d, uint64_t *window)
{
    memset(window, 0, (size_t)window_words(f) * sizeof *window);
    jali_bitmap view = {0, 0, f->pitch, window + f->pitch + 1};
    for (int32_t k = d->first; k < d->first + d->count; k++) {
        int32_t run = s->order[k];
        paint_run(&view, s->row_of[run] - f->y0, s->c.span[run][0] - f->x0, s->c.span[run][1] - f->x0, true);
    }
    uint64_t own = 0;
    for (int32_t y = 0; y < f->rows; y++) {
        const uint64_t *above = plane_row(window, f, 0, y - 1), *row = plane_row(window, f, 0, y),
                       *below = plane_row(window, f, 0, y + 1);
        uint64_t *ring = plane_row(window, f, 1, y);
        for (int32_t i = 0; i < f->words; i++) {
            uint64_t here = above[i] | row[i] | below[i];
            uint64_t left = above[i - 1] | row[i - 1] | below[i - 1],
                     right = above[i + 1] | row[i + 1] | below[i + 1];
            uint64_t around = (here | here << 1 | here >> 1 | left >> 63 | right << 63) & ~row[i];
            uint64_t cross =
                (above[i] | below[i] | row[i] << 1 | row[i] >> 1 | row[i - 1] >> 63 | row[i + 1] << 63) &
                ~row[i];
            uint64_t white = window_word(s->picture, f->x0 + 64 * i, f->y0 + y, s->outside_solid);
            ring[i] = around & (s->white ? ~white : white);
            own |=
                (s->white ? cross & white : around & ~white); // white touches by edges, black by corners too
        }
    }
    d->touches_own = own != 0;
}

static int32_t root_of(ring_run *run, int32_t i)
{
    while (run[i].parent != i) i = run[i].parent = run[run[i].parent].parent;
    return i;
}

// Join the runs first .. second-1 of one row with those of the next, second .. end-1; returns how many parts
// fewer there are.
static int32_t join_rows(ring_run *run, int32_t first, int32_t second, int32_t end, int32_t reach)
{
    int32_t fewer = 0;
    for (int32_t i = first, j = second; i < second && j < end;) {
        if (run[i].x0 < run[j].x1 + reach && run[j].x0 < run[i].x1 + reach) {
            int32_t a = root_of(run, i), b = root_of(run, j);
            run[MAX(a, b)].parent = MIN(a, b);
            fewer += a != b;
        }
        if (run[i].x1 < run[j].x1)
            i++;
        else
            j++;
    }
    return fewer;
}

static int32_t count_ring_runs(const frame *f, uint64_t *window)
{
    int32_t count = 0;
    for (int32_t y = 0; y < f->rows; y++) {
        const uint64_t *row = plane_row(window, f, 1, y);
        for (int32_t x = next_white(row, 0, f->words * 64, 0); x < f->words * 64; count++)
            x = next_white(row, next_white(row, x, f->words * 64, ~UINT64_C(0)), f->words * 64, 0);
    }
    return count;
}

// Connected parts of the ring, by its own tone's connectivity: runs row by row, joined with those of the row
// above.
static int32_t count_parts(const sorting *s, const frame *f, uint64_t *window, ring_run *run)
{
    int32_t width = f->words * 64, above = 0, first = 0, count = 0, parts = 0;
    int32_t reach = s->white ? 1 : 0; // a white detail's ring is black: 8-connected
    for (int32_t y = 0; y < f->rows; y++) {
        const uint64_t *row = plane_row(window, f, 1, y);
        for (int32_t x = next_white(row, 0, width, 0); x < width; count++) {
            int32_t end = next_white(row, x, width, ~UINT64_C(0));
            run[count] = (ring_run){x, end, count};
            x = next_white(row, end, width, 0);
        }
        parts += count - first - join_rows(run, above, first, count, reach);
        above = first;
        first = count;
    }
    return parts;
}

// A corner of a plate without a frame: no disc reaches into it, and nothing can be done about it.
static bool is_plates_own(const sorting *s, const detail *d)
{
    bool at_border =
        d->x0 == 0 || d->y0 == 0 || d->x1 == s->picture->width_px || d->y1 == s->picture->height_px;
    return s->white && !s->outside_solid && at_border && d->touches_own;
}

static int32_t type_of(const sorting *s, const detail *d, int32_t ring_parts)
{
    if (ring_parts > 1) return JALI_TYPE_A;
    if (is_plates_own(s, d)) return JALI_TYPE_C;
    bool isolated = s->isolated_matters && !d->touches_own;
    return d->axis_px > s->epsilon_px || isolated ? JALI_TYPE_B : JALI_TYPE_C;
}

static void sort_small(void *shared, int32_t index)
{
    sorting *s = shared;
    const scratch *with = &s->slot[index];
    for (int32_t i = index; i < s->c.count; i += SLOTS) {
        detail *d = &s->detail[i];
        if (is_large(d)) continue;
        frame f = frame_of(d);
        measure_axis(s, d);
        draw_ring(s, &f, d, with->window);
        d->type = type_of(s, d, count_parts(s, &f, with->window, with->run));
    }
}

static jali_status sort_large(jali_context *ctx, sorting *s)
{
    jali_status status = JALI_OK;
    size_t words = 0, runs = 0;
    scratch with = {0};
    for (int32_t i = 0; i < s->c.count; i++) {
        detail *d = &s->detail[i];
        if (!is_large(d)) continue;
        frame f = frame_of(d);
        TRY(step(ctx, "adapt", (double)i / s->c.count));
        TRY(GROW(ctx, with.window, words, window_words(&f)));
        measure_axis(s, d);
        draw_ring(s, &f, d, with.window);
        TRY(GROW(ctx, with.run, runs, count_ring_runs(&f, with.window)));
        d->type = type_of(s, d, count_parts(s, &f, with.window, with.run));
    }
done:
    release(ctx, with.window);
    release(ctx, with.run);
    return status;
}

// As much scratch as the largest of the small details takes, for each slot.
static jali_status make_slots(jali_context *ctx, sorting *s)
{
    jali_status status;
    int64_t words = 0, runs = 0;
    for (int32_t i = 0; i < s->c.count; i++) {
        if (is_large(&s->detail[i])) continue;
        frame f = frame_of(&s->detail[i]);
        words = MAX(words, window_words(&f));
        runs = MAX(runs, most_ring_runs(&s->detail[i]));
    }
    for (int32_t i = 0; i < SLOTS; i++) {
        TRY(ARENA(ctx, s->slot[i].window, words));
        TRY(ARENA(ctx, s->slot[i].run, runs));
    }
done:
    return status;
}

static void paint_band(void *shared, int32_t band)
{
    const sorting *s = shared;
    const components *c = &s->c;
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, c->height_px); y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++)
            paint_run(&s->details->type[s->detail[c->label[i]].type], y, c->span[i][0], c->span[i][1], true);
}

static jali_status sort_details(jali_context *ctx, sorting *s)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    TRY(step(ctx, "adapt", 0));
    TRY(make_slots(ctx, s));
    parallel(ctx, SLOTS, sort_small, s);
    TRY(sort_large(ctx, s));
    for (int32_t i = 0; i < s->c.count; i++) s->details->count[s->detail[i].type]++;
    parallel(ctx, (s->c.height_px + BAND_ROWS - 1) / BAND_ROWS, paint_band, s);
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status jali_adapt_details(jali_context *ctx, const jali_bitmap *picture, bool white,
                               const jali_adapt_options *opt, jali_details *details)
{
    jali_status status;
    jali_bitmap removed = {0}, opened = {0};
    widths w = {0};
    sorting s = {.picture = picture,
                 .white = white,
                 .outside_solid = opt->outside_solid,
                 .isolated_matters = opt->isolated_matters,
                 .epsilon_px = opt->epsilon_px,
                 .tiles = &w.tiles,
                 .details = details};
    *details = (jali_details){0};
    TRY(mask_widths(ctx, opt, picture, 0, &w));
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, &removed));
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, &opened));
    for (int32_t type = 0; type < JALI_TYPES; type++)
        TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, &details->type[type]));
    TRY(white ? field_open(ctx, picture, &w.solid, opt->outside_solid, &opened, &removed)
              : field_close(ctx, picture, &w.hollow, opt->outside_solid, &opened, &removed));
    combine(ctx, RULE_XOR, picture, &removed, &removed);
    TRY(label_components(ctx, &removed, true, white ? 4 : 8, &s.c));
    TRY(gather_runs(ctx, &s));
    TRY(find_axes(ctx, &s, &removed, white ? w.solid.most : w.hollow.most));
    TRY(sort_details(ctx, &s));
done:
    if (status != JALI_OK) jali_details_free(ctx, details);
    jali_bitmap_free(ctx, &removed);
    jali_bitmap_free(ctx, &opened);
    widths_free(ctx, &w);
    components_free(ctx, &s.c);
    release(ctx, s.detail);
    release(ctx, s.order);
    release(ctx, s.row_of);
    jali_bitmap_free(ctx, &s.axis);
    return status;
}
