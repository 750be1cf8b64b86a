// Details of one tone: what an opening removes, sorted into types A, B and C.
//
// Source:  Binary Image Carving for 3D Printing, section 4.3, Eqs. 2 and 3.
// Method:  components of the removed pixels as runs; the ring around each (3 x 3 dilation minus itself, in
// the
//          other tone) is gathered in a window and its parts are counted as runs, in one pass.
// Limits:  a detail that crosses the bitmap's border has the border as part of its ring only where the
//          surroundings have the other tone.
// Checked: tests/test_adapt.c: bars, combs, rings; random pictures against the definition.
#include <jali/adapt.h>
#include "adapt/widths.h"
#include "base/base.h"

void jali_details_free(jali_context *ctx, jali_details *details)
{
    for (int32_t type = 0; type < JALI_TYPES; type++) jali_bitmap_free(ctx, &details->type[type]);
    *details = (jali_details){0};
}

// One connected detail: its runs are order[first .. first + count - 1].
typedef struct detail {
    int32_t first, count;
    int32_t x0, y0, x1, y1;
    int32_t pixels, axis_px;
    bool touches_own; // a neighbour of its tone is no detail: it hangs on something larger
} detail;

// A run of a ring's pixels; the parts are trees of runs.
typedef struct ring_run {
    int32_t x0, x1, parent;
} ring_run;

typedef struct sorting {
    const jali_bitmap *picture;
    bool white, outside_solid, isolated_matters;
    int32_t epsilon_px;
    components c;
    detail *detail;   // [c.count]
    int32_t *order;   // [c.run_count], runs by detail
    int32_t *row_of;  // [c.run_count]
    uint64_t *window; // two planes of scratch: the detail and its ring
    size_t window_capacity;
    ring_run *run; // of the ring
    size_t run_capacity;
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

// The axis has no more pixels than the detail: where no detail has enough, nobody needs an axis.
static jali_status measure_axes(jali_context *ctx, sorting *s, const jali_bitmap *removed, int32_t rounds)
{
    int32_t largest = 0;
    for (int32_t i = 0; i < s->c.count; i++) largest = MAX(largest, s->detail[i].pixels);
    if (largest <= s->epsilon_px) return JALI_OK;
    jali_bitmap axis;
    jali_status status = medial_axis(ctx, removed, true, false, rounds, &axis);
    if (status != JALI_OK) return status;
    for (int32_t i = 0; i < s->c.run_count; i++)
        s->detail[s->c.label[i]].axis_px += count_run(&axis, s->row_of[i], s->c.span[i][0], s->c.span[i][1]);
    jali_bitmap_free(ctx, &axis);
    return JALI_OK;
}

// A window of the picture around a detail: one pixel of ring, one word and row of zeros around that.
typedef struct frame {
    int32_t x0, y0, words, rows;
    int64_t pitch;
} frame;

static uint64_t *plane_row(const sorting *s, const frame *f, int32_t plane, int32_t row)
{
    return s->window + ((int64_t)plane * (f->rows + 2) + row + 1) * f->pitch + 1;
}

// Plane 0: the detail. Plane 1: the pixels of the other tone around it. Also learns whether it touches its
// own.
static void draw_ring(const sorting *s, const frame *f, detail *d)
{
    memset(s->window, 0, (size_t)(2 * (f->rows + 2) * f->pitch) * sizeof *s->window);
    jali_bitmap view = {0, 0, f->pitch, s->window + f->pitch + 1};
    for (int32_t k = d->first; k < d->first + d->count; k++) {
        int32_t run = s->order[k];
        paint_run(&view, s->row_of[run] - f->y0, s->c.span[run][0] - f->x0, s->c.span[run][1] - f->x0, true);
    }
    uint64_t own = 0;
    for (int32_t y = 0; y < f->rows; y++) {
        const uint64_t *above = plane_row(s, f, 0, y - 1), *row = plane_row(s, f, 0, y),
                       *below = plane_row(s, f, 0, y + 1);
        uint64_t *ring = plane_row(s, f, 1, y);
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

// Connected parts of the ring, by its own tone's connectivity: runs row by row, joined with those of the row
// above.
static jali_status count_parts(jali_context *ctx, sorting *s, const frame *f, int32_t *parts)
{
    int32_t width = f->words * 64, above = 0, first = 0, count = 0;
    int32_t reach = s->white ? 1 : 0; // a white detail's ring is black: 8-connected
    *parts = 0;
    for (int32_t y = 0; y < f->rows; y++) {
        const uint64_t *row = plane_row(s, f, 1, y);
        for (int32_t x = next_white(row, 0, width, 0); x < width; count++) {
            jali_status status = GROW(ctx, s->run, s->run_capacity, count + 1);
            if (status != JALI_OK) return status;
            int32_t end = next_white(row, x, width, ~UINT64_C(0));
            s->run[count] = (ring_run){x, end, count};
            x = next_white(row, end, width, 0);
        }
        *parts += count - first - join_rows(s->run, above, first, count, reach);
        above = first;
        first = count;
    }
    return JALI_OK;
}

// A corner of a plate without a frame: no disc reaches into it, and nothing can be done about it.
static bool is_plates_own(const sorting *s, const detail *d)
{
    bool at_border =
        d->x0 == 0 || d->y0 == 0 || d->x1 == s->picture->width_px || d->y1 == s->picture->height_px;
    return s->white && !s->outside_solid && at_border && d->touches_own;
}

static jali_status type_of(jali_context *ctx, sorting *s, detail *d, int32_t *type)
{
    frame f = {(d->x0 - 1) & ~63, d->y0 - 1, 0, d->y1 - d->y0 + 2, 0};
    f.words = (d->x1 + 1 - f.x0 + 63) / 64;
    f.pitch = f.words + 2;
    int32_t parts;
    jali_status status = GROW(ctx, s->window, s->window_capacity, 2 * (f.rows + 2) * f.pitch);
    if (status != JALI_OK) return status;
    draw_ring(s, &f, d);
    status = count_parts(ctx, s, &f, &parts);
    if (status != JALI_OK) return status;
    if (parts > 1)
        *type = JALI_TYPE_A;
    else if (!is_plates_own(s, d) && (d->axis_px > s->epsilon_px || (s->isolated_matters && !d->touches_own)))
        *type = JALI_TYPE_B;
    else
        *type = JALI_TYPE_C;
    return JALI_OK;
}

static jali_status sort_details(jali_context *ctx, sorting *s, jali_details *details)
{
    jali_status status = JALI_OK;
    for (int32_t i = 0; i < s->c.count; i++) {
        if (i % 1024 == 0) TRY(step(ctx, "adapt", (double)i / s->c.count));
        detail *d = &s->detail[i];
        int32_t type;
        TRY(type_of(ctx, s, d, &type));
        details->count[type]++;
        for (int32_t k = d->first; k < d->first + d->count; k++) {
            int32_t run = s->order[k];
            paint_run(&details->type[type], s->row_of[run], s->c.span[run][0], s->c.span[run][1], true);
        }
    }
done:
    return status;
}

jali_status jali_adapt_details(jali_context *ctx, const jali_bitmap *picture, bool white,
                               const jali_adapt_options *opt, jali_details *details)
{
    jali_status status;
    jali_bitmap removed = {0}, scratch = {0};
    element e[2] = {0}; // [white]
    sorting s = {.picture = picture,
                 .white = white,
                 .outside_solid = opt->outside_solid,
                 .isolated_matters = opt->isolated_matters,
                 .epsilon_px = opt->epsilon_px};
    *details = (jali_details){0};
    TRY(mask_elements(ctx, opt, &e[1], &e[0]));
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, &removed));
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, &scratch));
    for (int32_t type = 0; type < JALI_TYPES; type++)
        TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, &details->type[type]));
    TRY(white ? open_by(ctx, picture, &e[1], opt->outside_solid, &scratch, &removed)
              : close_by(ctx, picture, &e[0], opt->outside_solid, &scratch, &removed));
    combine(ctx, RULE_XOR, picture, &removed, &removed);
    TRY(label_components(ctx, &removed, true, white ? 4 : 8, &s.c));
    TRY(gather_runs(ctx, &s));
    TRY(measure_axes(ctx, &s, &removed, e[white].size));
    TRY(sort_details(ctx, &s, details));
done:
    if (status != JALI_OK) jali_details_free(ctx, details);
    jali_bitmap_free(ctx, &removed);
    jali_bitmap_free(ctx, &scratch);
    element_free(ctx, &e[0]);
    element_free(ctx, &e[1]);
    components_free(ctx, &s.c);
    release(ctx, s.detail);
    release(ctx, s.order);
    release(ctx, s.row_of);
    release(ctx, s.window);
    release(ctx, s.run);
    return status;
}
