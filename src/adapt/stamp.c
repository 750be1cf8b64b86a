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
// Ends:    each kept change lowers a whole number that is never negative; passes are limited besides. (On
//          curved surfaces an axis's worth, like the discs, is that of the place: there the limit ends it.)
// Limits:  windows are 128 px: where half a disc and twice the other one pass 63 px (a working pixel far
// finer
//          than the printer needs) there is no search, only the opening and closing.
// Threads: bands of rows, even ones first, then the odd ones, each a chunk after the other. A change, with
//          what decides about it, reaches less than two chunks, so a chunk waits for those near it that are
//          before it in that order, others are done side by side, and any number of threads gives the same
//          print.
// Dead end: a charge for the outline's length, so that a thin line prints as a line or not at all instead of
// as a row
//          of dots: at 3 px a pixel of outline the dots hardly join, and 24 runs lose 0.3 points of error.
// Figures: docs/results.md, with what each part brings.
#include "adapt/trial.h"
#include "base/base.h"

#include <sched.h>

enum {
    CHUNK_ROWS = 64,
    CHUNKS = 4,
    BAND_ROWS = CHUNKS * CHUNK_ROWS,
    PAD_PX = 64,
    PASSES = 6,
    MAX_REACH_PX = 63,
    WRONG_ROUNDS = 1
};

static const double PASS_GAIN[PASSES] = {0.24, 0.08, 0, 0, 0, 0}; // of a disc's area

// All places of a chunk where a detail's axis prints in the wrong tone.
static void stamp_chunk(stamping *s, int32_t band, int32_t chunk)
{
    int32_t y0 = PAD_PX + band * BAND_ROWS + chunk * CHUNK_ROWS,
            y_end = MIN(y0 + CHUNK_ROWS, s->print.height_px - PAD_PX);
    for (int32_t y = y0; y < y_end; y++)
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
                    if (!try_disc(s, &s->band[band], &t, PASS_GAIN[s->pass]))
                        s->side[white].open.word[at] &= ~(UINT64_C(1) << bit);
                }
            }
}

static void wait_for(stamping *s, int32_t band, int32_t chunks)
{
    while (band < s->band_count && atomic_load(&s->chunks_done[band]) < chunks) sched_yield();
}

// Chunks are handed out in the order of their turns: those waited for are done or at work. The first two of a
// band are out of reach of the band below, the third of all but its first chunk.
static void stamp_in_turn(void *shared, int32_t turn)
{
    stamping *s = shared;
    int32_t even = (s->band_count + 1) / 2, odd = s->band_count - even, later = turn - even * CHUNKS;
    bool is_odd = later >= 0;
    int32_t chunk = is_odd ? later / odd : turn / even,
            band = is_odd ? 2 * (later % odd) + 1 : 2 * (turn % even);
    wait_for(s, band, chunk);
    if (is_odd) {
        wait_for(s, band - 1, CHUNKS);
        wait_for(s, band + 1, chunk - 1);
    }
    stamp_chunk(s, band, chunk);
    atomic_store(&s->chunks_done[band], chunk + 1);
}

typedef struct place_job {
    jali_bitmap *axis, *open;
} place_job;

// The columns of word i that are not in the pad.
static uint64_t inside_pad(const jali_bitmap *a, int64_t i)
{
    int64_t beyond = a->width_px - PAD_PX - i * 64;
    if (i < PAD_PX / 64 || beyond <= 0) return 0;
    return beyond >= 64 ? ~UINT64_C(0) : (UINT64_C(1) << beyond) - 1;
}

// No places beyond the picture: a window around them would leave the padded bitmap. Every other one is
// opened, like the white squares of a chessboard: a disc beside the best place is nearly as good.
static void place_band(void *shared, int32_t band)
{
    const place_job *job = shared;
    const jali_bitmap *a = job->axis;
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, a->height_px); y++) {
        bool beyond = y < PAD_PX || y >= a->height_px - PAD_PX;
        uint64_t white_squares = y % 2 ? UINT64_C(0x5555555555555555) : UINT64_C(0xaaaaaaaaaaaaaaaa);
        for (int64_t i = 0, at = y * a->stride; i < a->stride; i++, at++) {
            job->axis->word[at] &= beyond ? 0 : inside_pad(a, i);
            job->open->word[at] = job->axis->word[at] & white_squares;
        }
    }
}

static void open_places(jali_context *ctx, jali_bitmap *axis, jali_bitmap *open)
{
    parallel(ctx, (axis->height_px + BAND_ROWS - 1) / BAND_ROWS, place_band, &(place_job){axis, open});
}

// Passes over the open places of both tones until one keeps nothing.
static jali_status run_passes(jali_context *ctx, stamping *s, int32_t first_pass, jali_stamp_report *total)
{
    jali_status status = JALI_OK;
    int64_t kept = -1;
    for (s->pass = first_pass; s->pass < PASSES; s->pass++) {
        TRY(step(ctx, "adapt", (double)s->pass / PASSES));
        for (int32_t i = 0; i < s->band_count; i++) s->chunks_done[i] = 0;
        parallel(ctx, s->band_count * CHUNKS, stamp_in_turn, s);
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
        open_places(ctx, &t->open, &t->open);
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
    open_places(ctx, &t->axis, &t->open);
done:
    return status;
}

static jali_status pad(jali_context *ctx, const jali_bitmap *a, bool outside, jali_bitmap *padded)
{
    jali_status status = jali_bitmap_create(ctx, a->width_px + 2 * PAD_PX, a->height_px + 2 * PAD_PX, padded);
    if (status != JALI_OK) return status;
    fill(ctx, padded, outside);
    paste(ctx, a, PAD_PX, PAD_PX, padded);
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
    TRY(ALLOCATE_CLEARED(ctx, s.chunks_done, s.band_count));
    TRY(jali_bitmap_copy(ctx, &s.drawing, &s.print));
    TRY(field_open(ctx, &s.print, &s.w.solid, true, &scratch, &s.print));
    TRY(field_close(ctx, &s.print, &s.w.hollow, true, &scratch, &s.print));
    if (large_enough) {
        TRY(find_fits(ctx, &s, &scratch));
        TRY(search(ctx, &s, &scratch, report));
    }
    TRY(jali_bitmap_create(ctx, drawing->width_px, drawing->height_px, print));
    cut_out(ctx, &s.print, PAD_PX, PAD_PX, print);
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
    release(ctx, s.chunks_done);
    return status;
}
