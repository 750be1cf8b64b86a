// Levels of both tones under uneven light. Solid is everywhere near by. Void is not: among slots the wide
// places are cells away; but the same light falls on both, so what is carried over is how much lighter void
// is than solid, and that hardly changes from place to place. Slots that are known to have printed wide
// enough show their void themselves.
#include "calibrate/levels.h"

#include "raster/raster.h"
#include "scan/least.h"

static const double PIXELS_A_CELL = 100;           // of the drawn board, in which sure places are found
static const double SAMPLES_A_CELL = 30;           // along a side
static const double NEAR_CELLS = 1, FAR_CELLS = 4; // deviations of the neighbourhood
static const double DARKEST = 0.02;                // a level that ratios are still taken of
static const double FAR_WEIGHT = 1e-3;             // of the far one
static const double STEADY = 100; // samples' worth of belief that voids are as much lighter everywhere

void levels_free(jali_context *ctx, levels *l)
{
    release(ctx, l->node);
    *l = (levels){0};
}

// Did it come out so near to what is drawn that its inside is sure?
static bool is_sure(const jali_board_feature *f, const jali_measured *m, double growth_mm)
{
    return m && m->printed && fabs(m->width_mm - f->width_mm) < growth_mm;
}

// Black where a bar is measured that may have come out as anything.
static void blot_out(const jali_board_feature *f, double pixel_mm, double margin_mm, jali_bitmap *bitmap)
{
    static const double along[4][2] = {{1, 0}, {0, 1}, {M_SQRT1_2, M_SQRT1_2}, {1, 0}};
    const double *d = along[f->direction];
    double half_length = (f->direction == JALI_BOARD_ROUND ? f->width_mm : f->length_mm) / 2 + margin_mm;
    double half_width = f->width_mm / 2, step = pixel_mm / 2;
    if (f->kind == JALI_BOARD_PIN) half_length = half_width = f->reach_mm;
    for (double u = -half_length; u <= half_length; u += step)
        for (double v = -half_width; v <= half_width; v += step) {
            int32_t x = (int32_t)((f->at_mm[0] + u * d[0] - v * d[1]) / pixel_mm);
            int32_t y = (int32_t)((f->at_mm[1] + u * d[1] + v * d[0]) / pixel_mm);
            if (x >= 0 && y >= 0 && x < bitmap->width_px && y < bitmap->height_px)
                jali_bitmap_set(bitmap, x, bitmap->height_px - 1 - y, false);
        }
}

// Sums over the samples of a block.
typedef struct block {
    double n, x, y, level;
} block;

// Where a tone is sure: drawn so, and nothing else within the margin.
static jali_status mark_sure(jali_context *ctx, const jali_board *board, const jali_measured *known,
                             const jali_bitmap *drawn, bool solid, double pixel_mm,
                             const level_margin *margin, jali_bitmap *sure)
{
    double margin_mm = margin->growth_mm + margin->edge_mm;
    jali_status status;
    jali_bitmap tone = {0};
    element disc = {0};
    TRY(jali_bitmap_copy(ctx, drawn, &tone));
    if (!solid) invert(ctx, drawn, &tone);
    for (int32_t i = 0; i < board->feature_count; i++)
        if (!is_sure(&board->feature[i], known ? &known[i] : NULL, margin->growth_mm))
            blot_out(&board->feature[i], pixel_mm, margin_mm, &tone);
    TRY(element_disc(ctx, 2 * margin_mm / pixel_mm, &disc));
    TRY(jali_bitmap_create(ctx, drawn->width_px, drawn->height_px, sure));
    TRY(erode(ctx, &tone, &disc, false, sure));
done:
    element_free(ctx, &disc);
    jali_bitmap_free(ctx, &tone);
    return status;
}

static int64_t sample(const jali_picture *p, const homography *map, const jali_bitmap *sure, double pixel_mm,
                      const levels *l, block *blocks)
{
    const int32_t stride = (int32_t)(PIXELS_A_CELL / SAMPLES_A_CELL);
    int64_t missing = 0;
    for (int32_t y = 0; y < sure->height_px; y += stride)
        for (int32_t x = 0; x < sure->width_px; x += stride) {
            if (!jali_bitmap_get(sure, x, y)) continue;
            double at[2] = {(x + 0.5) * pixel_mm, (sure->height_px - y - 0.5) * pixel_mm};
            double level = seen_at(p, map, at[0], at[1]);
            if (isnan(level)) {
                missing++;
                continue;
            }
            int32_t i = MIN((int32_t)(at[0] / l->step_mm), l->columns - 1);
            int32_t k = MIN((int32_t)(at[1] / l->step_mm), l->rows - 1);
            block *b = &blocks[k * l->columns + i];
            b->n++;
            b->x += at[0];
            b->y += at[1];
            b->level += level;
        }
    return missing;
}

// The plane through the neighbourhood, at the node.
static double level_of_node(const levels *l, const block *blocks, double x, double y, double steady,
                            double cell_mm)
{
    normal_equations e = {.unknowns = 3};
    double fit[3], sum = 0, weights = 0;
    for (int32_t i = 0; i < l->columns * l->rows; i++) {
        const block *b = &blocks[i];
        if (b->n == 0) continue;
        double dx = b->x / b->n - x, dy = b->y / b->n - y, far2 = (dx * dx + dy * dy) / (cell_mm * cell_mm);
        double weight = b->n * (exp(-far2 / (2 * NEAR_CELLS * NEAR_CELLS)) +
                                FAR_WEIGHT * exp(-far2 / (2 * FAR_CELLS * FAR_CELLS)));
        add_equation(&e, (double[]){1, dx / cell_mm, dy / cell_mm}, b->level / b->n, weight);
        sum += weight * b->level / b->n;
        weights += weight;
    }
    add_equation(&e, (double[]){0, 1, 0}, 0, steady);
    add_equation(&e, (double[]){0, 0, 1}, 0, steady);
    return solve_normal(&e, fit) ? fit[0] : weights > 0 ? sum / weights : NAN;
}

// Voids' levels as multiples of solid's, which is known by now.
static void take_ratios(const levels *l, block *blocks)
{
    for (int32_t i = 0; i < l->columns * l->rows; i++) {
        double level[2];
        if (blocks[i].n == 0) continue;
        levels_at(l, blocks[i].x / blocks[i].n, blocks[i].y / blocks[i].n, level);
        blocks[i].level /= fmax(level[0], DARKEST);
    }
}

static void fit_nodes(levels *l, const block *blocks, int tone, double cell_mm)
{
    for (int32_t k = 0; k < l->rows; k++)
        for (int32_t i = 0; i < l->columns; i++) {
            double *node = l->node[k * l->columns + i];
            double x = (i + 0.5) * l->step_mm, y = (k + 0.5) * l->step_mm;
            double fit = level_of_node(l, blocks, x, y, tone == 0 ? 0 : STEADY, cell_mm);
            node[tone] = tone == 0 ? fit : fit * fmax(node[0], DARKEST);
        }
}

jali_status learn_levels(jali_context *ctx, const jali_picture *picture, const jali_board *board,
                         const jali_measured *known, const homography *map, const level_margin *margin,
                         levels *l)
{
    jali_status status;
    jali_bitmap drawn = {0}, sure = {0};
    block *blocks = NULL;
    double pixel_mm = board->cell_mm / PIXELS_A_CELL;
    *l = (levels){.step_mm = board->cell_mm / 2};
    l->columns = (int32_t)ceil(board->width_mm / l->step_mm);
    l->rows = (int32_t)ceil(board->height_mm / l->step_mm);
    TRY(jali_board_bitmap(ctx, board, &pixel_mm, &drawn));
    TRY(ALLOCATE_CLEARED(ctx, l->node, l->columns * l->rows));
    for (int tone = 0; tone < 2; tone++) {
        TRY(step(ctx, "calibrate", 0.3 + 0.1 * tone));
        release(ctx, blocks);
        blocks = NULL;
        TRY(ALLOCATE_CLEARED(ctx, blocks, l->columns * l->rows));
        jali_bitmap_free(ctx, &sure);
        TRY(mark_sure(ctx, board, known, &drawn, tone == 0, pixel_mm, margin, &sure));
        if (sample(picture, map, &sure, pixel_mm, l, blocks) > 0)
            TRY(fail(ctx, JALI_NO_RESULT, "a part of the board is not in the picture: all of it must be"));
        if (tone == 1) take_ratios(l, blocks);
        fit_nodes(l, blocks, tone, board->cell_mm);
    }
done:
    release(ctx, blocks);
    jali_bitmap_free(ctx, &sure);
    jali_bitmap_free(ctx, &drawn);
    if (status != JALI_OK) levels_free(ctx, l);
    return status;
}

void levels_at(const levels *l, double x_mm, double y_mm, double level[2])
{
    double x = fmin(fmax(x_mm / l->step_mm - 0.5, 0), l->columns - 1.001);
    double y = fmin(fmax(y_mm / l->step_mm - 0.5, 0), l->rows - 1.001);
    int32_t i = (int32_t)x, k = (int32_t)y;
    for (int tone = 0; tone < 2; tone++) {
        const double(*n)[2] = (const double(*)[2])l->node + k * l->columns + i;
        double u = x - i, v = y - k;
        level[tone] = (1 - v) * ((1 - u) * n[0][tone] + u * n[1][tone]) +
                      v * ((1 - u) * n[l->columns][tone] + u * n[l->columns + 1][tone]);
    }
}
