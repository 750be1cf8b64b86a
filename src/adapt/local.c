// Erosion and dilation of a window by a field: part by part of one patch.
//
// Method:  tiles beside and below each other that have one patch are a part. For each length of the patch's
//          rows a level holds the columns where a run of that length begins; an output row is the AND of
//          one shifted level row for each of the patch's rows. Dilations likewise, by OR.
// Checked: tests/test_metric.c against the operators on whole pictures.
#include "adapt/local.h"
#include "base/base.h"

#include <stdlib.h>

// Levels for all lengths of rows, with helpers where a step would be too long.
static void plan_levels(const patch *p, window_patch *w)
{
    bool wanted[WINDOW_MAX_ELEMENT + 1] = {false};
    for (int32_t k = 0; k < p->rows; k++) wanted[p->span[k][1] - p->span[k][0] + 1] = true;
    w->length[0] = 1;
    w->level_count = 1;
    for (int32_t n = 2; n <= WINDOW_MAX_ELEMENT; n++) {
        if (!wanted[n]) continue;
        for (int32_t last; (last = w->length[w->level_count - 1]) < n;)
            w->length[w->level_count++] = MIN(2 * last, n);
    }
    for (int32_t k = 0; k < p->rows; k++)
        while (w->length[w->level_of[k]] < p->span[k][1] - p->span[k][0] + 1) w->level_of[k]++;
}

static window_patch prepare(const patch *p)
{
    window_patch w = {.top = p->top, .rows = p->rows, .left = INT32_MAX};
    for (int32_t k = 0; k < p->rows; k++) w.left = MIN(w.left, p->span[k][0]);
    plan_levels(p, &w);
    for (int32_t k = 0; k < p->rows; k++) {
        int32_t length = p->span[k][1] - p->span[k][0] + 1;
        w.first[k] = p->span[k][0];
        w.row[k] = ((UINT64_C(1) << length) - 1) << (p->span[k][0] - w.left);
        w.area += length;
    }
    return w;
}

jali_status window_field_create(jali_context *ctx, const field *f, window_field *w)
{
    *w = (window_field){.f = f};
    jali_status status = ALLOCATE(ctx, w->patch, f->patches);
    for (int32_t i = 0; status == JALI_OK && i < f->patches; i++) w->patch[i] = prepare(&f->patch[i]);
    return status;
}

void window_field_free(jali_context *ctx, window_field *w)
{
    release(ctx, w->patch);
    *w = (window_field){0};
}

const window_patch *window_patch_at(const window_field *w, int32_t x, int32_t y)
{
    return &w->patch[patch_at(w->f, x, y) - w->f->patch];
}

// --- One part

// A part of a window: the rows y0 .. y1-1 of the columns set in left and right, all of one patch.
typedef struct part {
    const window_patch *p;
    int32_t y0, y1;
    uint64_t left, right;
} part;

// out = a moved by n columns to the left (bit i of out is bit i + n of a), n from -63 to 63.
VECTORISED static void move_rows(const uint64_t *l, const uint64_t *r, uint64_t *l_out, uint64_t *r_out,
                                 int32_t rows, int32_t n)
{
    int32_t m = abs(n);
    if (n == 0) {
        memcpy(l_out, l, (size_t)rows * sizeof *l);
        memcpy(r_out, r, (size_t)rows * sizeof *r);
    } else if (n > 0)
        for (int32_t k = 0; k < rows; k++) {
            l_out[k] = l[k] >> m | r[k] << (64 - m);
            r_out[k] = r[k] >> m;
        }
    else
        for (int32_t k = 0; k < rows; k++) {
            r_out[k] = r[k] << m | l[k] >> (64 - m);
            l_out[k] = l[k] << m;
        }
}

VECTORISED static void and_rows(uint64_t *l, uint64_t *r, const uint64_t *l_in, const uint64_t *r_in,
                                int32_t rows)
{
    for (int32_t k = 0; k < rows; k++) {
        l[k] &= l_in[k];
        r[k] &= r_in[k];
    }
}

VECTORISED static void or_rows(uint64_t *l, uint64_t *r, const uint64_t *l_in, const uint64_t *r_in,
                               int32_t rows)
{
    for (int32_t k = 0; k < rows; k++) {
        l[k] |= l_in[k];
        r[k] |= r_in[k];
    }
}

enum { MOST_LEVELS = 6 + WINDOW_MAX_ELEMENT / 2, TALL_ROWS = WINDOW_ROWS + WINDOW_MAX_ELEMENT };

// A part's rows and those around it that its patch reaches.
typedef struct tall_window {
    uint64_t left[TALL_ROWS], right[TALL_ROWS];
} tall_window;

// Where the runs of each level begin (erosion), or what they paint to the right of their first pixel
// (dilation).
static void make_levels(const window_patch *p, tall_window *level, int32_t rows, bool dilate)
{
    for (int32_t i = 1; i < p->level_count; i++) {
        int32_t step = p->length[i] - p->length[i - 1];
        tall_window *to = &level[i];
        const tall_window *from = &level[i - 1];
        move_rows(from->left, from->right, to->left, to->right, rows, dilate ? -step : step);
        (dilate ? or_rows : and_rows)(to->left, to->right, from->left, from->right, rows);
    }
}

static void erode_part(const part *t, const window *a, int32_t window_rows, window *fits)
{
    const window_patch *p = t->p;
    tall_window level[MOST_LEVELS], moved;
    int32_t from = t->y0 + p->top, rows = t->y1 - t->y0, all = rows + p->rows - 1;
    for (int32_t k = 0; k < all; k++) {
        bool inside = from + k >= 0 && from + k < window_rows;
        level[0].left[k] = inside ? a->left[from + k] : 0;
        level[0].right[k] = inside ? a->right[from + k] : 0;
    }
    make_levels(p, level, all, false);
    for (int32_t y = 0; y < rows; y++) {
        fits->left[t->y0 + y] |= t->left; // the other columns of these rows belong to other parts
        fits->right[t->y0 + y] |= t->right;
    }
    for (int32_t k = 0; k < p->rows; k++) {
        const tall_window *of = &level[p->level_of[k]];
        move_rows(of->left + k, of->right + k, moved.left, moved.right, rows, p->first[k]);
        for (int32_t y = 0; y < rows; y++) {
            fits->left[t->y0 + y] &= moved.left[y] | ~t->left;
            fits->right[t->y0 + y] &= moved.right[y] | ~t->right;
        }
    }
}

static void dilate_part(const part *t, const window *a, int32_t window_rows, window *painted)
{
    const window_patch *p = t->p;
    tall_window level[MOST_LEVELS], moved;
    int32_t rows = t->y1 - t->y0;
    uint64_t any = 0;
    for (int32_t k = 0; k < rows; k++) {
        level[0].left[k] = a->left[t->y0 + k] & t->left;
        level[0].right[k] = a->right[t->y0 + k] & t->right;
        any |= level[0].left[k] | level[0].right[k];
    }
    if (!any) return;
    make_levels(p, level, rows, true);
    for (int32_t k = 0; k < p->rows; k++) {
        const tall_window *of = &level[p->level_of[k]];
        int32_t to = t->y0 + p->top + k, skip = MAX(-to, 0), count = MIN(rows, window_rows - to) - skip;
        if (count <= 0) continue;
        move_rows(of->left + skip, of->right + skip, moved.left, moved.right, count, -p->first[k]);
        or_rows(painted->left + (to + skip), painted->right + (to + skip), moved.left, moved.right, count);
    }
}

// --- All parts of the square in the middle

// The columns x0 .. x1-1 of a window as bits.
static void set_columns(int32_t x0, int32_t x1, part *t)
{
    for (int32_t side = 0; side < 2; side++) {
        int32_t first = MAX(x0 - 64 * side, 0), end = MIN(x1 - 64 * side, 64);
        uint64_t mask = first < end ? ~UINT64_C(0) << first & ~UINT64_C(0) >> (64 - end) : 0;
        *(side ? &t->right : &t->left) = mask;
    }
}

typedef struct walk {
    const window_field *w;
    int32_t x0, y0;                     // the window's first pixel
    int32_t left, right, above, bottom; // the square, in the window
    int32_t i, j;                       // the next tile
} walk;

static walk walk_parts(const window_field *w, int32_t x0, int32_t y0, int32_t rows, int32_t half)
{
    walk k = {
        w, x0, y0, WINDOW_COLUMNS / 2 - half, WINDOW_COLUMNS / 2 + half, rows / 2 - half, rows / 2 + half,
        0, 0};
    int32_t px = w->f->tiles->tile_px;
    k.i = (x0 + k.left) / px;
    k.j = (y0 + k.above) / px;
    return k;
}

// The patches of tiles i .. end-1 of two rows of tiles are the same.
static bool same_below(const field *f, int32_t i, int32_t end, int32_t j, int32_t below)
{
    const tiling *t = f->tiles;
    if (below >= t->rows) return false;
    for (; i < end; i++)
        if (patch_of_tile(f, (int64_t)j * t->columns + i) !=
            patch_of_tile(f, (int64_t)below * t->columns + i))
            return false;
    return true;
}

// The next part of the square, tiles beside each other, row by row of tiles; whole rows of tiles that are
// alike are taken together. The square lies in the bitmap.
static bool next_part(walk *k, part *t)
{
    const field *f = k->w->f;
    const tiling *tiles = f->tiles;
    int32_t px = tiles->tile_px, first = (k->x0 + k->left) / px, last = (k->x0 + k->right - 1) / px;
    int32_t y0 = MAX(k->j * px - k->y0, k->above), below = k->j + 1;
    if (y0 >= k->bottom) return false;
    while (below * px - k->y0 < k->bottom && same_below(f, first, last + 1, k->j, below)) below++;
    int64_t row = (int64_t)k->j * tiles->columns;
    const patch *p = patch_of_tile(f, row + k->i);
    int32_t end = k->i + 1;
    while (end <= last && patch_of_tile(f, row + end) == p) end++;
    t->p = &k->w->patch[p - f->patch];
    t->y0 = y0;
    t->y1 = MIN(below * px - k->y0, k->bottom);
    set_columns(MAX(k->i * px - k->x0, k->left), MIN(end * px - k->x0, k->right), t);
    k->i = end;
    if (end > last) k->i = first, k->j = below;
    return true;
}

void local_erode(const window_field *w, const window *a, int32_t x0, int32_t y0, int32_t rows, int32_t half,
                 window *fits)
{
    part t;
    walk k = walk_parts(w, x0, y0, rows, half);
    *fits = (window){0};
    while (next_part(&k, &t)) erode_part(&t, a, rows, fits);
}

void local_dilate(const window_field *w, const window *a, int32_t x0, int32_t y0, int32_t rows, int32_t half,
                  window *painted)
{
    part t;
    walk k = walk_parts(w, x0, y0, rows, half);
    *painted = (window){0};
    while (next_part(&k, &t)) dilate_part(&t, a, rows, painted);
}
