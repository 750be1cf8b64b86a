// Erosion and dilation in a window: the same levels as raster/morphology.c, rows side by side in vector
// registers.
#include "adapt/window.h"
#include "base/base.h"

#include <stdlib.h>

typedef struct padded {
    uint64_t above[WINDOW_MAX_ELEMENT], row[WINDOW_ROWS], below[WINDOW_MAX_ELEMENT];
} padded;

window_element window_element_of(const element *e)
{
    window_element w = {.size = e->size, .level_count = 1};
    int32_t even = e->size % 2 == 0, reach = even;
    for (int32_t i = e->rows - 1; i >= 0; i--) {
        while (reach < e->half[i]) {
            int32_t next = MIN(3 * reach + 1 - even, e->half[i]);
            w.step[w.level_count++] = next - reach;
            reach = next;
        }
        w.level_of[i] = w.level_count - 1;
    }
    return w;
}

// Whole bytes by unaligned reads, the rest by a shift: the columns asked for lie in 17 bytes.
VECTORISED static void read_rows(const char *byte, int64_t pitch, int32_t bit, int32_t rows, window *w)
{
    for (int32_t k = 0; k < rows; k++, byte += pitch) {
        uint64_t low, high, last;
        memcpy(&low, byte, sizeof low);
        memcpy(&high, byte + 8, sizeof high);
        memcpy(&last, byte + 9, sizeof last);
        w->left[k] = low >> bit | (high << 1) << (63 - bit);
        w->right[k] = bit ? high >> bit | last >> 56 << (64 - bit) : high;
    }
}

void window_read(const jali_bitmap *a, int32_t x0, int32_t y0, int32_t rows, window *w)
{
    const char *byte = (const char *)(a->word + (int64_t)y0 * a->stride) + (x0 >> 3);
    read_rows(byte, a->stride * (int64_t)sizeof *a->word, x0 & 7, rows, w);
}

void window_flip(jali_bitmap *a, int32_t x0, int32_t y0, int32_t rows, const window *change)
{
    uint64_t *word = a->word + (int64_t)y0 * a->stride + (x0 >> 6);
    int32_t bit = x0 & 63;
    for (int32_t k = 0; k < rows; k++, word += a->stride) {
        word[0] ^= change->left[k] << bit;
        word[1] ^= change->right[k] << bit;
        if (!bit) continue;
        word[1] ^= change->left[k] >> (64 - bit);
        word[2] ^= change->right[k] >> (64 - bit);
    }
}

VECTORISED static void squeeze(const padded *l, const padded *r, padded *l_out, padded *r_out, int32_t rows,
                               int32_t s)
{
    uint64_t low = (UINT64_C(1) << s) - 1, high = ~UINT64_C(0) << (64 - s); // beyond counts as set
    for (int32_t k = 0; k < rows; k++) {
        uint64_t a = l->row[k], b = r->row[k];
        l_out->row[k] = a & (a >> s | b << (64 - s)) & (a << s | low);
        r_out->row[k] = b & (b >> s | high) & (b << s | a >> (64 - s));
    }
}

// The first level of an even element: a pixel and its left neighbour, reflected its right one.
static void pair(const window *a, padded *l, padded *r, int32_t rows, bool reflect)
{
    for (int32_t k = 0; k < rows; k++) {
        uint64_t p = a->left[k], q = a->right[k];
        l->row[k] = p & (reflect ? p >> 1 | q << 63 : p << 1 | 1);
        r->row[k] = q & (reflect ? q >> 1 | UINT64_C(1) << 63 : q << 1 | p >> 63);
    }
}

VECTORISED static void and_shifted(uint64_t *out, const uint64_t *in, int32_t rows)
{
    for (int32_t k = 0; k < rows; k++) out[k] &= in[k];
}

static void shrink(const window *a, int32_t rows, const window_element *e, bool reflect, window *out)
{
    padded l[WINDOW_MAX_ELEMENT / 2 + 2], r[WINDOW_MAX_ELEMENT / 2 + 2];
    bool even = e->size % 2 == 0;
    if (even)
        pair(a, &l[0], &r[0], rows, reflect);
    else {
        memcpy(l[0].row, a->left, sizeof a->left);
        memcpy(r[0].row, a->right, sizeof a->right);
    }
    for (int32_t i = 1; i < e->level_count; i++)
        squeeze(&l[i - 1], &r[i - 1], &l[i], &r[i], rows, e->step[i]);
    for (int32_t i = 0; i < e->level_count; i++) {
        memset(l[i].above, 0xff, sizeof l[i].above);
        memset(r[i].above, 0xff, sizeof r[i].above);
        memset(l[i].row + rows, 0xff, sizeof l[i].below);
        memset(r[i].row + rows, 0xff, sizeof r[i].below);
    }
    int32_t offset = even ? (reflect ? -1 : 1) : 0, above = even ? e->size / 2 - reflect : e->size / 2;
    memset(out->left, 0xff, (size_t)rows * sizeof *out->left);
    memset(out->right, 0xff, (size_t)rows * sizeof *out->right);
    for (int32_t i = 0; i < e->size; i++) {
        int32_t dy = i - above, level = e->level_of[abs(2 * dy + offset) / 2];
        and_shifted(out->left, (const uint64_t *)&l[level] + WINDOW_MAX_ELEMENT + dy, rows);
        and_shifted(out->right, (const uint64_t *)&r[level] + WINDOW_MAX_ELEMENT + dy, rows);
    }
}

void window_erode(const window *a, int32_t rows, const window_element *e, window *fits)
{
    shrink(a, rows, e, false, fits);
}

// The complement of the eroded complement, by the reflected element. Nothing comes in from beyond the window.
void window_dilate(const window *a, int32_t rows, const window_element *e, window *painted)
{
    window rest = {0};
    for (int32_t k = 0; k < rows; k++) {
        rest.left[k] = ~a->left[k];
        rest.right[k] = ~a->right[k];
    }
    shrink(&rest, rows, e, true, painted);
    for (int32_t k = 0; k < rows; k++) {
        painted->left[k] = ~painted->left[k];
        painted->right[k] = ~painted->right[k];
    }
}
