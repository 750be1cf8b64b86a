// A printed board as a scanner or a camera would show it: drawn from the features' figures by supersampling,
// with nothing of what measures it. Used by tests/test_scan_board.c and bench/calibrate.c.
#ifndef TESTS_PRINTED_H
#define TESTS_PRINTED_H

#include <jali/board.h>
#include <jali/read.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// What the printer did.
typedef struct printed {
    const jali_board *board;
    const jali_bitmap *plate; // the board as drawn, for letters and outline
    double plate_pixel_mm;
    double e_solid, e_void, phi_s, phi_v, hole_mm2, corner_mm;
    double waviness_mm; // of edges, at random
} printed;

/// How it was looked at.
typedef struct look {
    int32_t width, height;
    double px_per_mm, turn, tilt[2], aside[2]; // tilt: share by which the far side is smaller
    double lens;                               // radial distortion at the corners, share
    bool mirrored;
    double solid, through; // levels 0 .. 1 of the plate and of what is seen through it
    double light[4];       // slopes across the picture, vignetting, shadow: shares
    double blur_px, noise; // deviations, px and levels
    uint64_t seed;
} look;

static inline uint64_t look_random(uint64_t *s)
{
    *s ^= *s >> 12;
    *s ^= *s << 25;
    *s ^= *s >> 27;
    return *s * UINT64_C(2685821657736338717);
}

static inline double look_share(uint64_t *s)
{
    return (double)(look_random(s) >> 11) / 9007199254740992.0;
}

static inline bool in_round_box(double x, double y, double half_x, double half_y, double r)
{
    double dx = fabs(x) - (half_x - r), dy = fabs(y) - (half_y - r);
    if (dx > r || dy > r) return false;
    return dx <= 0 || dy <= 0 || dx * dx + dy * dy <= r * r;
}

// A small wave along an edge, its phase by place.
static inline double wave(const printed *p, double along, double where)
{
    return p->waviness_mm > 0 ? p->waviness_mm * sin(9 * along + 40 * where) : 0;
}

/// Is the plate solid at a place of a feature, (x, y) from its centre?
static inline bool feature_solid(const printed *p, const jali_board_feature *f, double x, double y)
{
    double w = f->width_mm, b = f->beside_mm, side = p->board->cell_mm * 0.8, ev = p->e_void, es = p->e_solid;
    bool flat = f->direction == JALI_BOARD_HORIZONTAL, diagonal = f->direction == JALI_BOARD_DIAGONAL;
    double u = flat       ? x
               : diagonal ? (x + y) * M_SQRT1_2
                          : y,
           v = flat       ? y
               : diagonal ? (y - x) * M_SQRT1_2
                          : x;
    double off = fabs(v) + wave(p, u, f->at_mm[0] + 2 * f->at_mm[1]);
    bool window = in_round_box(x, y, (side - ev) / 2, (side - ev) / 2, p->corner_mm);
    switch (f->kind) {
    case JALI_BOARD_VOID: return w < p->phi_v || off > (w - ev) / 2 || fabs(u) > (f->length_mm - ev) / 2;
    case JALI_BOARD_SOLID: return !window || (w >= p->phi_s && off < (w + es) / 2);
    case JALI_BOARD_SOLID_PAIR:
        if (fabs(u) > (side - ev) / 2 || fabs(v) > w / 2 + b - ev / 2) return true;
        return w >= p->phi_s && off < (w + es) / 2;
    case JALI_BOARD_VOID_PAIR:
        if (!window) return true;
        if (fabs(v) > w / 2 + b + es / 2) return false;
        return w < p->phi_v || off > (w - ev) / 2;
    case JALI_BOARD_HOLE: return hypot(x, y) > (w - ev - p->hole_mm2 / w) / 2;
    default: return !window || hypot(x, y) < (w + es) / 2 || (fabs(x) < (b + es) / 2 && y < 0);
    }
}

static inline bool printed_solid(const printed *p, double x, double y)
{
    const jali_board *b = p->board;
    if (x < 0 || y < 0 || x >= b->width_mm || y >= b->height_mm) return false;
    for (int i = 0; i < JALI_BOARD_MARKS; i++) {
        double d = hypot(x - b->mark_mm[i][0], y - b->mark_mm[i][1]);
        if (d < b->mark_diameter_mm) return d > (b->mark_diameter_mm - p->e_void) / 2;
    }
    double pitch = b->code_mm[1][0] - b->code_mm[0][0], k = round((x - b->code_mm[0][0]) / pitch);
    if (k >= 0 && k < JALI_BOARD_CODE_BITS && fabs(y - b->code_mm[0][1]) < pitch) {
        double half = (b->code_side_mm - p->e_void) / 2;
        return !b->code[(int)k] || !in_round_box(x - b->code_mm[(int)k][0], y - b->code_mm[0][1], half, half,
                                                 fmin(p->corner_mm, half));
    }
    double left = b->feature[0].at_mm[0] - b->cell_mm / 2;
    int32_t column = (int32_t)floor((x - left) / b->cell_mm);
    for (int32_t row = 0; column >= 0 && column < b->columns && row < b->feature_count / b->columns; row++) {
        const jali_board_feature *f = &b->feature[row * b->columns + column];
        if (fabs(y - f->at_mm[1]) < b->cell_mm / 2)
            return feature_solid(p, f, x - f->at_mm[0], y - f->at_mm[1]);
    }
    int32_t px = (int32_t)(x / p->plate_pixel_mm), py = (int32_t)(y / p->plate_pixel_mm);
    if (px >= p->plate->width_px || py >= p->plate->height_px) return false;
    return jali_bitmap_get(p->plate, px, p->plate->height_px - 1 - py);
}

/// From a place of the picture to one of the board.
static inline void look_through(const look *l, const jali_board *b, double px, double py, double at[2])
{
    double half = fmax(l->width, l->height) / 2.0, x = (px - l->width / 2.0) / half,
           y = (py - l->height / 2.0) / half;
    double r2 = x * x + y * y, bend = 1 + l->lens * r2;
    x *= bend * half;
    y *= bend * half;
    double w = 1 + l->tilt[0] * x / half + l->tilt[1] * y / half;
    x = (x / w - l->aside[0]) / l->px_per_mm;
    y = (y / w - l->aside[1]) / l->px_per_mm;
    double c = cos(l->turn), s = sin(l->turn), u = c * x + s * y, v = -s * x + c * y;
    at[0] = b->width_mm / 2 + (l->mirrored ? -u : u);
    at[1] = b->height_mm / 2 - v;
}

/// The share of a pixel that the plate covers, by 6 x 6 samples.
static inline double covered(const printed *p, const look *l, double x, double y)
{
    enum { MANY = 6 };
    double at[2];
    int sum = 0;
    for (int k = 0; k < MANY * MANY; k++) {
        look_through(l, p->board, x + (k % MANY + 0.5) / MANY, y + (k / MANY + 0.5) / MANY, at);
        sum += printed_solid(p, at[0], at[1]);
    }
    return (double)sum / (MANY * MANY);
}

// Of the corners of a row of pixels, their upper ones.
static inline void look_at_corners(const printed *p, const look *l, int32_t y, bool *solid)
{
    double at[2];
    for (int32_t x = 0; x <= l->width; x++) {
        look_through(l, p->board, x, y, at);
        solid[x] = printed_solid(p, at[0], at[1]);
    }
}

static inline void blur_lines(float *level, int32_t count, int32_t length, int64_t line, int64_t step,
                              double deviation)
{
    int32_t reach = (int32_t)ceil(4 * deviation);
    float *copy = malloc((size_t)length * sizeof *copy);
    double *weight = malloc(((size_t)reach + 1) * sizeof *weight);
    for (int32_t k = 0; k <= reach; k++) weight[k] = exp(-0.5 * k * k / (deviation * deviation));
    for (int32_t i = 0; i < count; i++) {
        float *at = level + i * line;
        for (int32_t j = 0; j < length; j++) copy[j] = at[j * step];
        for (int32_t j = 0; j < length; j++) {
            double sum = 0, all = 0;
            for (int32_t k = -reach; k <= reach; k++) {
                int32_t from = j + k < 0 ? 0 : j + k >= length ? length - 1 : j + k;
                sum += weight[abs(k)] * (double)copy[from];
                all += weight[abs(k)];
            }
            at[j * step] = (float)(sum / all);
        }
    }
    free(weight);
    free(copy);
}

/// The picture; free its grey levels with free().
static inline jali_picture looked_at(const printed *p, const look *l)
{
    size_t count = (size_t)l->width * (size_t)l->height;
    float *level = malloc(count * sizeof *level);
    uint64_t seed = l->seed * 2654435761u + 12345;
    jali_picture picture = {.width_px = l->width, .height_px = l->height, .grey = malloc(count)};
    // A pixel whose corners are alike is of one tone: nothing that is printed is as narrow as a pixel.
    bool *above = malloc((size_t)l->width + 1), *below = malloc((size_t)l->width + 1);
    look_at_corners(p, l, 0, below);
    for (int32_t y = 0; y < l->height; y++) {
        bool *keep = above;
        above = below;
        below = keep;
        look_at_corners(p, l, y + 1, below);
        for (int32_t x = 0; x < l->width; x++) {
            int corners = above[x] + above[x + 1] + below[x] + below[x + 1];
            double share = corners % 4 == 0 ? corners / 4 : covered(p, l, x, y);
            level[(size_t)y * (size_t)l->width + (size_t)x] =
                (float)(l->through + (l->solid - l->through) * share);
        }
    }
    free(above);
    free(below);
    if (l->blur_px > 0.05) {
        blur_lines(level, l->height, l->width, l->width, 1, l->blur_px);
        blur_lines(level, l->width, l->height, 1, l->width, l->blur_px);
    }
    for (int32_t y = 0; y < l->height; y++)
        for (int32_t x = 0; x < l->width; x++) {
            size_t i = (size_t)y * (size_t)l->width + (size_t)x;
            double u = 2.0 * x / l->width - 1, v = 2.0 * y / l->height - 1;
            double light = 1 + l->light[0] * u + l->light[1] * v - l->light[2] * (u * u + v * v) +
                           l->light[3] * sin(2 * u + 1) * cos(1.7 * v);
            double n = 0;
            for (int k = 0; k < 6; k++) n += look_share(&seed) - 0.5; // deviation sqrt(1 / 2)
            double value = (double)level[i] * light + l->noise * n * M_SQRT2;
            picture.grey[i] = (uint8_t)lround(255 * fmin(fmax(value, 0), 1));
        }
    free(level);
    return picture;
}

/// A flat-bed scan or a phone's photograph of a board, at random: turned, off the middle, light or dark.
static inline look some_look(const jali_board *b, bool photograph, double dpi, uint64_t *seed)
{
    double longer = hypot(b->width_mm, b->height_mm);
    look l = {.px_per_mm = dpi / 25.4, .seed = look_random(seed)};
    l.turn = photograph ? 2 * M_PI * look_share(seed) : (look_share(seed) - 0.5) * 0.2;
    if (!photograph && look_share(seed) < 0.5) l.turn += M_PI_2 * (double)(look_random(seed) % 4);
    l.mirrored = look_share(seed) < 0.3;
    double room = photograph ? 1.12 : 1; // a tilt brings one side nearer
    l.width = (int32_t)((room * longer + 8) * l.px_per_mm);
    l.height = (int32_t)((room * longer + 12) * l.px_per_mm);
    for (int k = 0; k < 2; k++) l.aside[k] = (look_share(seed) - 0.5) * 6 * l.px_per_mm;
    bool dark = look_share(seed) < 0.5;
    l.solid = dark ? 0.12 + 0.15 * look_share(seed) : 0.6 + 0.2 * look_share(seed);
    l.through = dark ? 0.65 + 0.2 * look_share(seed) : 0.05 + 0.2 * look_share(seed);
    l.blur_px = 0.4 + 0.8 * look_share(seed);
    l.noise = 0.004 + 0.012 * look_share(seed);
    for (int k = 0; k < 2; k++) l.light[k] = (look_share(seed) - 0.5) * (photograph ? 0.2 : 0.03);
    if (photograph) {
        for (int k = 0; k < 2; k++) l.tilt[k] = (look_share(seed) - 0.5) * 0.16;
        l.light[2] = 0.08 * look_share(seed);
        l.light[3] = 0.04 * look_share(seed);
        l.lens = (look_share(seed) - 0.5) * 0.004;
        l.blur_px += 0.5 * look_share(seed);
        l.noise *= 1.5;
    }
    return l;
}

#endif
