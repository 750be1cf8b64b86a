// A print that keeps to the widths and differs least from the drawing: discs are set where that helps most.
//
// Instead of: Algorithm 3's rounds (conflict.c), whose majority vote over whole regions floods hatchings.
// Idea:    in a print, solids and voids are unions of discs. Begin with the opening and closing of the
// drawing;
//          at a place where a detail was lost set a disc of its tone; what that leaves too thin in the other
//          tone, the pixels that no disc covers any more, goes with it. Keep the change if it lowers
//              wrong pixels + worth * lost pixels of the axes of details.
//          The best places come first: passes ask for a gain of 24 %, 8 %, then 0 of a disc's area.
//          So the owner of a conflict is whoever leaves the smaller predicted error, place by place; in a
//          hatching too fine to print every other line takes its neighbours' room.
// Speed:   the places where a disc of each tone fits are kept up to date (fits), so what a new disc uncovers
//          follows from one dilation in a small window; most places are decided by the disc's pixels alone.
// Ends:    each kept change lowers a whole number that is never negative; passes are limited besides. (On a
// curved
//          surface an axis's worth, like the discs, is that of the place.)
// Limits:  windows are 128 px: where half a disc and twice the other one pass 63 px (a working pixel far
// finer
//          than the printer needs) there is no search, only the opening and closing.
// Threads: bands of rows in two turns, even then odd; a change reaches less than half a band, so bands of one
//          turn never meet and any number of threads gives the same print.
// Dead end: a charge for the outline's length, so that a thin line prints as a line or not at all instead of
// as a row
//          of dots: at 3 px a pixel of outline the dots hardly join, and 24 runs lose 0.3 points of error.
// Figures: docs/results.md, with what each part brings.
#include <jali/adapt.h>
#include "adapt/local.h"
#include "adapt/widths.h"
#include "base/base.h"

enum { BAND_ROWS = 256, PAD_PX = 64, PASSES = 6, MAX_REACH_PX = 63, WRONG_ROUNDS = 1 };

static const double PASS_GAIN[PASSES] = {0.24, 0.08, 0, 0, 0, 0}; // of a disc's area

// A change may leave so much of a disc's area too thin for its new tone; the finish deals with it. At 0 every
// third disc is refused and the recall of white falls by 3 points; without a limit the finish floods voids
// (black -1.5).
static const double THIN_SHARE = 0.2;

// A tone's side of the search.
typedef struct tone {
    jali_bitmap axis; // of the details of this tone
    jali_bitmap open; // places of the axis that are still worth a try
    jali_bitmap fits; // centres at which the disc fits into the print's pixels of this tone
    const field *disc;
    window_field local;
    window_element fit; // flat: the disc everywhere
    window blocked; // flat: centres of the other tone's discs that meet this disc set in the window's middle
} tone;

// A disc to try.
typedef struct trial {
    int32_t x, y;
    bool white;
    const window_patch *disc;
    int64_t worth[2]; // [white], of a lost pixel of an axis here; a wrong pixel counts WRONG_UNITS
} trial;

typedef struct stamping {
    const jali_adapt_options *opt;
    jali_bitmap drawing, print; // padded by PAD_PX on each side
    tone side[2];               // [white]
    window inner,
        fits_inner;    // where a change can reach, and where it can change which discs fit; wide windows
    int32_t wide_rows; // of a window that decides which discs fit around a change
    int32_t rows;      // of a window that decides what a disc changes
    int32_t reach, fits_reach; // how far a change reaches, and how far away it changes which discs fit
    int32_t pass, turn, band_count;
    jali_stamp_report *band; // [band_count]
    widths w;
} stamping;

VECTORISED static int64_t count_window(const window *a, const window *b, int32_t rows)
{
    int64_t count = 0;
    for (int32_t k = 0; k < rows; k++)
        count +=
            __builtin_popcountll(a->left[k] & b->left[k]) + __builtin_popcountll(a->right[k] & b->right[k]);
    return count;
}

// How the sum changes when `change` becomes white (or black). Few rows of the window change at all.
static int64_t change_in_sum(const stamping *s, const trial *t, const window *change, int32_t x0, int32_t y0)
{
    window some, w;
    int32_t first = 0, last = s->rows - 1;
    while (first < last && !(change->left[first] | change->right[first])) first++;
    while (last > first && !(change->left[last] | change->right[last])) last--;
    int32_t rows = last - first + 1;
    memcpy(some.left, change->left + first, (size_t)rows * sizeof *some.left);
    memcpy(some.right, change->right + first, (size_t)rows * sizeof *some.right);
    int64_t all = count_window(&some, &some, rows);
    window_read(&s->drawing, x0, y0 + first, rows, &w);
    int64_t right = count_window(&some, &w, rows); // white in the drawing
    window_read(&s->side[1].axis, x0, y0 + first, rows, &w);
    int64_t found = count_window(&some, &w, rows);
    window_read(&s->side[0].axis, x0, y0 + first, rows, &w);
    int64_t lost = count_window(&some, &w, rows);
    int64_t sum = WRONG_UNITS * (all - 2 * right) + t->worth[0] * lost - t->worth[1] * found;
    return t->white ? sum : -sum;
}

// Up to 57 bits of a row from column x on, by one unaligned read.
static inline uint64_t bits_from(const jali_bitmap *a, int32_t x, int32_t y)
{
    uint64_t word;
    memcpy(&word, (const char *)(a->word + (int64_t)y * a->stride) + (x >> 3), sizeof word);
    return word >> (x & 7);
}

// The change by the disc alone, without what it closes around it: a quick bound that decides most places.
VECTORISED static int64_t change_by_disc(const stamping *s, const trial *t)
{
    const window_patch *disc = t->disc;
    int64_t all = 0, right = 0, found = 0, lost = 0;
    int32_t left = t->x + disc->left, top = t->y + disc->top;
    uint64_t flip = t->white ? ~UINT64_C(0) : 0;
    for (int32_t k = 0; k < disc->rows; k++) {
        uint64_t change = (bits_from(&s->print, left, top + k) ^ flip) & disc->row[k];
        all += __builtin_popcountll(change);
        right += __builtin_popcountll(change & bits_from(&s->drawing, left, top + k));
        found += __builtin_popcountll(change & bits_from(&s->side[1].axis, left, top + k));
        lost += __builtin_popcountll(change & bits_from(&s->side[0].axis, left, top + k));
    }
    int64_t sum = WRONG_UNITS * (all - 2 * right) + t->worth[0] * lost - t->worth[1] * found;
    return t->white ? sum : -sum;
}

// Where a tone's disc fits into the window's pixels `a`, up to fits_reach from the middle.
static void fits_in(const stamping *s, bool white, const window *a, int32_t x0, int32_t y0, int32_t rows,
                    window *fits)
{
    const tone *t = &s->side[white];
    if (t->disc->which)
        local_erode(&t->local, a, x0, y0, rows, s->fits_reach, fits);
    else
        window_erode(a, rows, &t->fit, fits);
}

// What the tone's discs set on those places cover.
static void cover_by(const stamping *s, bool white, const window *fits, int32_t x0, int32_t y0, int32_t rows,
                     window *covered)
{
    const tone *t = &s->side[white];
    if (t->disc->which)
        local_dilate(&t->local, fits, x0, y0, rows, s->fits_reach, covered);
    else
        window_dilate(fits, rows, &t->fit, covered);
}

// The window's pixels of one tone, as set bits.
static void read_tone(const stamping *s, int32_t x0, int32_t y0, int32_t rows, bool white, window *w)
{
    window_read(&s->print, x0, y0, rows, w);
    if (white) return;
    for (int32_t k = 0; k < rows; k++) {
        w->left[k] = ~w->left[k];
        w->right[k] = ~w->right[k];
    }
}

// Row k of the window in which only a square around the middle counts.
static const uint64_t *inner_rows(const stamping *s, const uint64_t *row, int32_t rows)
{
    return row + (s->wide_rows - rows) / 2;
}

// All but the disc, set in the middle of a window of so many rows.
static void draw_rest(const window_patch *disc, int32_t rows, window *rest)
{
    int32_t left = WINDOW_COLUMNS / 2 + disc->left, top = rows / 2 + disc->top; // 64 / 2 < left <= 64
    for (int32_t k = 0; k < rows; k++) {
        uint64_t row = k >= top && k < top + disc->rows ? disc->row[k - top] : 0;
        rest->left[k] = left == 64 ? ~UINT64_C(0) : ~(row << left); // one column lies in the right half alone
        rest->right[k] = ~(row >> (64 - left));
    }
}

// Take the centres away whose discs meet the disc on trial.
static void take_blocked(const stamping *s, const trial *t, int32_t x0, int32_t y0, window *fits)
{
    window rest, clear;
    const uint64_t *left = inner_rows(s, s->side[t->white].blocked.left, s->rows);
    const uint64_t *right = inner_rows(s, s->side[t->white].blocked.right, s->rows);
    bool flat = !s->side[t->white].disc->which;
    if (!flat) {
        draw_rest(t->disc, s->rows, &rest);
        fits_in(s, !t->white, &rest, x0, y0, s->rows, &clear);
    }
    for (int32_t k = 0; k < s->rows; k++) {
        fits->left[k] &= flat ? ~left[k] : clear.left[k];
        fits->right[k] &= flat ? ~right[k] : clear.right[k];
    }
}

// What becomes of the window when the disc is set: all pixels that change tone.
static void disc_and_after(const stamping *s, const trial *t, int32_t x0, int32_t y0, window *change)
{
    window other, fits, covered;
    const uint64_t *left = inner_rows(s, s->inner.left, s->rows),
                   *right = inner_rows(s, s->inner.right, s->rows);
    read_tone(s, x0, y0, s->rows, !t->white, &other);
    window_read(&s->side[!t->white].fits, x0, y0, s->rows, &fits);
    take_blocked(s, t, x0, y0, &fits);
    cover_by(s, !t->white, &fits, x0, y0, s->rows, &covered);
    for (int32_t k = 0; k < s->rows; k++) {
        change->left[k] = other.left[k] & ~covered.left[k] & left[k];
        change->right[k] = other.right[k] & ~covered.right[k] & right[k];
    }
}

// Whether the change leaves too many pixels that no disc of their new tone covers: they would have to go
// again. What was covered stays covered, for the tone only gains.
VECTORISED static bool leaves_thin(const stamping *s, const trial *t, const window *change)
{
    window own, fits, covered;
    int32_t first = (s->wide_rows - s->rows) / 2;
    int32_t x0 = t->x - WINDOW_COLUMNS / 2, y0 = t->y - s->wide_rows / 2;
    read_tone(s, x0, y0, s->wide_rows, t->white, &own);
    for (int32_t k = 0; k < s->rows; k++) {
        own.left[first + k] |= change->left[k];
        own.right[first + k] |= change->right[k];
    }
    fits_in(s, t->white, &own, x0, y0, s->wide_rows, &fits);
    cover_by(s, t->white, &fits, x0, y0, s->wide_rows, &covered);
    int64_t thin = 0;
    for (int32_t k = 0; k < s->rows; k++)
        thin += __builtin_popcountll(change->left[k] & ~covered.left[first + k]) +
                __builtin_popcountll(change->right[k] & ~covered.right[first + k]);
    return thin > THIN_SHARE * t->disc->area;
}

// Bring `fits` up to date around a change.
static void refresh_fits(stamping *s, int32_t x, int32_t y)
{
    int32_t x0 = x - WINDOW_COLUMNS / 2, y0 = y - s->wide_rows / 2;
    for (int32_t white = 0; white < 2; white++) {
        window pixels, fits, old;
        read_tone(s, x0, y0, s->wide_rows, white, &pixels);
        fits_in(s, white, &pixels, x0, y0, s->wide_rows, &fits);
        window_read(&s->side[white].fits, x0, y0, s->wide_rows, &old);
        for (int32_t k = 0; k < s->wide_rows; k++) {
            old.left[k] = (old.left[k] ^ fits.left[k]) & s->fits_inner.left[k];
            old.right[k] = (old.right[k] ^ fits.right[k]) & s->fits_inner.right[k];
        }
        window_flip(&s->side[white].fits, x0, y0, s->wide_rows, &old);
    }
}

// Try a disc; returns whether the place may be worth another try in a later pass. One that would only do harm
// is not: what others do around it seldom changes that, and it would be asked again and again.
static bool try_disc(stamping *s, jali_stamp_report *report, const trial *t)
{
    int64_t gain = (int64_t)(PASS_GAIN[s->pass] * WRONG_UNITS * t->disc->area);
    report->tried++;
    int64_t bound = change_by_disc(s, t);
    if (bound >= -gain) return bound < 0;
    window change;
    int32_t x0 = t->x - WINDOW_COLUMNS / 2, y0 = t->y - s->rows / 2;
    disc_and_after(s, t, x0, y0, &change);
    int64_t sum = change_in_sum(s, t, &change, x0, y0);
    if (sum >= -gain) return sum < 0;
    if (leaves_thin(s, t, &change)) return false;
    window_flip(&s->print, x0, y0, s->rows, &change);
    refresh_fits(s, t->x, t->y);
    if (t->white)
        report->white++;
    else
        report->black++;
    return true;
}

// On a curved surface both discs are those of the place.
static trial trial_at(const stamping *s, int32_t x, int32_t y, bool white)
{
    trial t = {x, y, white, window_patch_at(&s->side[white].local, x, y), {0}};
    int32_t solid_px = patch_at(s->side[1].disc, x, y)->size, void_px = patch_at(s->side[0].disc, x, y)->size;
    for (int32_t of = 0; of < 2; of++) t.worth[of] = axis_worth_units(s->opt, of, solid_px, void_px);
    return t;
}

// All places of a band where a detail's axis prints in the wrong tone.
static void stamp_band(void *shared, int32_t index)
{
    stamping *s = shared;
    int32_t band = 2 * index + s->turn;
    int32_t y_end = MIN(PAD_PX + (band + 1) * BAND_ROWS, s->print.height_px - PAD_PX);
    for (int32_t y = PAD_PX + band * BAND_ROWS; y < y_end; y++)
        for (int32_t i = PAD_PX / 64; i <= (s->print.width_px - PAD_PX - 1) / 64; i++)
            for (int32_t white = 0; white < 2; white++) {
                int64_t at = y * s->print.stride + i;
                uint64_t flip = white ? ~UINT64_C(0) : 0;
                // Read again after each disc: it may have brought back the next places too.
                for (uint64_t left = ~UINT64_C(0), wrong;
                     (wrong = s->side[white].open.word[at] & (s->print.word[at] ^ flip) & left) != 0;) {
                    int32_t bit = __builtin_ctzll(wrong);
                    left = bit == 63 ? 0 : ~UINT64_C(0) << (bit + 1);
                    trial t = trial_at(s, i * 64 + bit, y, white);
                    if (!try_disc(s, &s->band[band], &t))
                        s->side[white].open.word[at] &= ~(UINT64_C(1) << bit);
                }
            }
}

// No places beyond the picture: a window around them would leave the padded bitmap.
static void clear_pad(jali_bitmap *axis)
{
    for (int32_t y = 0; y < axis->height_px; y++) {
        bool beyond = y < PAD_PX || y >= axis->height_px - PAD_PX;
        paint_run(axis, y, 0, beyond ? axis->width_px : PAD_PX, false);
        paint_run(axis, y, axis->width_px - PAD_PX, axis->width_px, false);
    }
}

// Keep every other place, like the white squares of a chessboard: a disc beside the best place is nearly as
// good.
static void thin_out(jali_bitmap *places)
{
    for (int32_t y = 0; y < places->height_px; y++)
        for (int64_t i = 0; i < places->stride; i++)
            places->word[y * places->stride + i] &=
                y % 2 ? UINT64_C(0x5555555555555555) : UINT64_C(0xaaaaaaaaaaaaaaaa);
}

// Passes over the open places of both tones until one keeps nothing.
static jali_status run_passes(jali_context *ctx, stamping *s, int32_t first_pass, jali_stamp_report *total)
{
    jali_status status = JALI_OK;
    int64_t kept = -1;
    for (s->pass = first_pass; s->pass < PASSES; s->pass++) {
        TRY(step(ctx, "adapt", (double)s->pass / PASSES));
        for (s->turn = 0; s->turn < 2; s->turn++)
            parallel(ctx, (s->band_count + 1 - s->turn) / 2, stamp_band, s);
        *total = (jali_stamp_report){0};
        for (int32_t i = 0; i < s->band_count; i++) {
            total->tried += s->band[i].tried;
            total->white += s->band[i].white;
            total->black += s->band[i].black;
        }
        if (PASS_GAIN[s->pass] == 0 && total->white + total->black == kept) break;
        kept = total->white + total->black;
    }
done:
    return status;
}

// Open the ridges of what is still wrong, for discs that are worth their pixels alone.
static jali_status open_wrong_places(jali_context *ctx, stamping *s, jali_bitmap *scratch)
{
    jali_status status = JALI_OK;
    for (int32_t white = 0; white < 2; white++) {
        tone *t = &s->side[white];
        jali_bitmap_free(ctx, &t->open);
        if (white)
            combine(ctx, RULE_AND_NOT, &s->drawing, &s->print, scratch);
        else
            combine(ctx, RULE_AND_NOT, &s->print, &s->drawing, scratch);
        TRY(medial_axis(ctx, scratch, true, false, t->disc->most, &t->open));
        clear_pad(&t->open);
        thin_out(&t->open);
    }
done:
    return status;
}

static jali_status search(jali_context *ctx, stamping *s, jali_bitmap *scratch, jali_stamp_report *total)
{
    jali_status status;
    TRY(run_passes(ctx, s, 0, total));
    for (int32_t round = 0; round < WRONG_ROUNDS; round++) {
        TRY(open_wrong_places(ctx, s, scratch));
        TRY(run_passes(ctx, s, 1, total));
    }
done:
    return status;
}

// The axis of the details: of the drawing's axis, what the opening removes.
static jali_status prepare_tone(jali_context *ctx, stamping *s, bool white, jali_bitmap *scratch)
{
    jali_status status;
    tone *t = &s->side[white];
    TRY(medial_axis(ctx, &s->drawing, white, true, t->disc->most / 2 + 1, &t->axis));
    TRY(jali_bitmap_create(ctx, s->drawing.width_px, s->drawing.height_px, &t->open));
    TRY(white ? field_open(ctx, &s->drawing, t->disc, true, scratch, &t->open)
              : field_close(ctx, &s->drawing, t->disc, true, scratch, &t->open));
    combine(ctx, RULE_XOR, &t->open, &s->drawing, &t->open);
    combine(ctx, RULE_AND, &t->axis, &t->open, &t->axis);
    clear_pad(&t->axis);
    combine(ctx, RULE_AND, &t->axis, &t->axis, &t->open);
    thin_out(&t->open);
done:
    return status;
}

static jali_status pad(jali_context *ctx, const jali_bitmap *a, bool outside, jali_bitmap *padded)
{
    jali_status status = jali_bitmap_create(ctx, a->width_px + 2 * PAD_PX, a->height_px + 2 * PAD_PX, padded);
    if (status != JALI_OK) return status;
    fill(ctx, padded, outside);
    paste(a, PAD_PX, PAD_PX, padded);
    return JALI_OK;
}

// A square of 2 half x 2 half pixels in the middle of a wide window.
static void draw_middle(const stamping *s, int32_t half, window *w)
{
    *w = (window){0};
    uint64_t side = half >= 64 ? ~UINT64_C(0) : (UINT64_C(1) << half) - 1;
    for (int32_t k = MAX(s->wide_rows / 2 - half, 0); k < MIN(s->wide_rows / 2 + half, s->wide_rows); k++) {
        w->left[k] = side << (64 - MIN(half, 64));
        w->right[k] = side;
    }
}

// Rows or columns, whichever a field's patches span more of.
static int32_t span_of(const field *f)
{
    return MAX(f->left + f->right, f->above + f->below) + 1;
}

// Where a disc in the middle meets the other tone's, when they are the same everywhere.
static void find_blocked(stamping *s, bool white)
{
    tone *t = &s->side[white];
    window rest;
    draw_rest(t->local.patch, s->wide_rows, &rest);
    window_erode(&rest, s->wide_rows, &s->side[!white].fit, &t->blocked);
    for (int32_t k = 0; k < s->wide_rows; k++) {
        t->blocked.left[k] = ~t->blocked.left[k];
        t->blocked.right[k] = ~t->blocked.right[k];
    }
}

// How far things reach from a disc's centre, half a pixel aside: a change, as far as the other tone's discs
// that meet the disc; the discs that decide about it, half a disc more; the pixels that decide about those,
// half again. Whether the windows are large enough for that.
static jali_status plan_windows(jali_context *ctx, stamping *s, bool *large_enough)
{
    jali_status status = JALI_OK;
    int32_t solid = span_of(s->side[1].disc), hollow = span_of(s->side[0].disc);
    int32_t large = (MAX(solid, hollow) + 1) / 2;
    s->reach = MAX((solid + 1) / 2 + hollow, (hollow + 1) / 2 + solid) + 1;
    s->fits_reach = s->reach + large;
    *large_enough = s->reach + 2 * large <= MAX_REACH_PX;
    if (!*large_enough) return JALI_OK;
    s->rows = 2 * ((s->reach + large + 3) / 4 * 4);
    s->wide_rows = MIN(2 * ((s->reach + 2 * large + 3) / 4 * 4), WINDOW_ROWS);
    draw_middle(s, s->reach, &s->inner);
    draw_middle(s, s->fits_reach, &s->fits_inner);
    for (int32_t white = 0; white < 2; white++) {
        tone *t = &s->side[white];
        TRY(window_field_create(ctx, t->disc, &t->local));
        if (!t->disc->which) t->fit = window_element_of(&t->disc->whole);
    }
    for (int32_t white = 0; white < 2; white++)
        if (!s->side[white].disc->which) find_blocked(s, white);
done:
    return status;
}

// Which discs fit into the first print.
static jali_status find_fits(jali_context *ctx, stamping *s, jali_bitmap *scratch)
{
    jali_status status;
    for (int32_t white = 0; white < 2; white++) {
        tone *t = &s->side[white];
        TRY(jali_bitmap_create(ctx, s->print.width_px, s->print.height_px, &t->fits));
        if (white)
            combine(ctx, RULE_AND, &s->print, &s->print, scratch);
        else
            invert(ctx, &s->print, scratch);
        TRY(field_erode(ctx, scratch, t->disc, white, &t->fits));
    }
done:
    return status;
}

jali_status jali_adapt_print(jali_context *ctx, const jali_bitmap *drawing, const jali_adapt_options *opt,
                             jali_bitmap *print, jali_stamp_report *report)
{
    jali_status status;
    jali_bitmap scratch = {0};
    stamping s = {.opt = opt};
    *print = (jali_bitmap){0};
    *report = (jali_stamp_report){0};
    if (!(opt->axis_worth_white >= 0 && opt->axis_worth_white <= 100 && opt->axis_worth_black >= 0 &&
          opt->axis_worth_black <= 100))
        return fail(ctx, JALI_BAD_VALUE, "axis_worth is %g for white, %g for black; 0 to 100 is accepted",
                    opt->axis_worth_white, opt->axis_worth_black);
    TRY(pad(ctx, drawing, opt->outside_solid, &s.drawing));
    TRY(printed_widths(ctx, opt, &s.drawing, PAD_PX, &s.w));
    s.side[1].disc = &s.w.solid;
    s.side[0].disc = &s.w.hollow;
    TRY(pad(ctx, drawing, opt->outside_solid, &scratch));
    TRY(prepare_tone(ctx, &s, true, &scratch));
    TRY(prepare_tone(ctx, &s, false, &scratch));
    bool large_enough;
    TRY(plan_windows(ctx, &s, &large_enough));
    s.band_count = (drawing->height_px + BAND_ROWS - 1) / BAND_ROWS;
    TRY(ALLOCATE_CLEARED(ctx, s.band, s.band_count));
    TRY(jali_bitmap_copy(ctx, &s.drawing, &s.print));
    TRY(field_open(ctx, &s.print, &s.w.solid, true, &scratch, &s.print));
    TRY(field_close(ctx, &s.print, &s.w.hollow, true, &scratch, &s.print));
    if (large_enough) {
        TRY(find_fits(ctx, &s, &scratch));
        TRY(search(ctx, &s, &scratch, report));
    }
    TRY(jali_bitmap_create(ctx, drawing->width_px, drawing->height_px, print));
    cut_out(&s.print, PAD_PX, PAD_PX, print);
done:
    if (status != JALI_OK) jali_bitmap_free(ctx, print);
    jali_bitmap_free(ctx, &scratch);
    jali_bitmap_free(ctx, &s.drawing);
    jali_bitmap_free(ctx, &s.print);
    for (int32_t i = 0; i < 2; i++) {
        jali_bitmap_free(ctx, &s.side[i].axis);
        jali_bitmap_free(ctx, &s.side[i].open);
        jali_bitmap_free(ctx, &s.side[i].fits);
        window_field_free(ctx, &s.side[i].local);
    }
    widths_free(ctx, &s.w);
    release(ctx, s.band);
    return status;
}
