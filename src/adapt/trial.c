// One disc on trial: what it and what goes with it change, and whether that is kept.
//
// The change is looked at in windows (window.h, and local.h where the discs vary): what a disc uncovers in
// the other tone follows from one dilation of the centres that are left (fits).
#include "adapt/trial.h"
#include "base/base.h"

// A change may leave so much of a disc's area too thin for its new tone; the finish deals with it. At 0 every
// third disc is refused and the recall of white falls by 3 points; without a limit the finish floods voids
// (black -1.5).
static const double THIN_SHARE = 0.2;

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

void draw_rest(const window_patch *disc, int32_t rows, window *rest)
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

bool try_disc(stamping *s, jali_stamp_report *report, const trial *t, double least_gain)
{
    int64_t gain = (int64_t)(least_gain * WRONG_UNITS * t->disc->area);
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

trial trial_at(const stamping *s, int32_t x, int32_t y, bool white)
{
    trial t = {x, y, white, window_patch_at(&s->side[white].local, x, y), {0}};
    int32_t solid_px = patch_at(s->side[1].disc, x, y)->size, void_px = patch_at(s->side[0].disc, x, y)->size;
    for (int32_t of = 0; of < 2; of++) t.worth[of] = axis_worth_units(s->opt, of, solid_px, void_px);
    return t;
}
