// Registration: marks -> code -> board -> map; and the map again from everything that was found.
#include "calibrate/register.h"

#include "calibrate/marks.h"
#include "calibrate/robust.h"
#include "scan/least.h"

static const double MARK_REACH = 1.45;     // of a mark's radius: there is solid around it so far at least
static const double CODE_SHARE = 0.45;     // of the way from solid to void: a void square, shrunk and blurred
static const double LEAST_CONTRAST = 0.06; // between a mark and the plate, of the whole range
enum { WORKING_PX = 2000 };                // longer side of the copy in which marks are sought

// The centre of a mark: the centre of gravity of what is nearer to its middle's level than to its
// surroundings'.
static bool centre_mark(const jali_picture *p, double radius, double at[2], double *inside, double *around)
{
    double reach = MARK_REACH * radius, sum[2] = {0}, count[2] = {0}, weight = 0, gravity[2] = {0};
    int32_t x0 = (int32_t)fmax(floor(at[0] - reach), 0), x1 = (int32_t)fmin(ceil(at[0] + reach), p->width_px);
    int32_t y0 = (int32_t)fmax(floor(at[1] - reach), 0),
            y1 = (int32_t)fmin(ceil(at[1] + reach), p->height_px);
    for (int pass = 0; pass < 2; pass++)
        for (int32_t y = y0; y < y1; y++)
            for (int32_t x = x0; x < x1; x++) {
                double far = hypot(x + 0.5 - at[0], y + 0.5 - at[1]) / radius;
                double level = p->grey[(size_t)y * (size_t)p->width_px + (size_t)x] / 255.0;
                if (far > MARK_REACH) continue;
                if (pass == 0 && (far < 0.6 || far > 1.25)) {
                    sum[far > 1] += level;
                    count[far > 1]++;
                } else if (pass == 1) {
                    double share = (level - sum[1] / count[1]) / (sum[0] / count[0] - sum[1] / count[1]);
                    share = share < 0.25 ? 0 : fmin(share, 1); // noise of the surroundings does not pull
                    weight += share;
                    gravity[0] += share * (x + 0.5);
                    gravity[1] += share * (y + 0.5);
                }
            }
    *inside = sum[0] / fmax(count[0], 1);
    *around = sum[1] / fmax(count[1], 1);
    if (!(weight > 0 && count[0] > 0 && count[1] > 0) || fabs(*inside - *around) < LEAST_CONTRAST)
        return false;
    for (int k = 0; k < 2; k++) at[k] = gravity[k] / weight;
    return true;
}

// The guess's marks at full resolution: its map anew, and the levels of both tones.
static bool settle_guess(const jali_picture *p, mark_guess *guess, double *inside, double *around)
{
    double from[JALI_BOARD_MARKS][2], to[JALI_BOARD_MARKS][2], radius[JALI_BOARD_MARKS], level[2];
    *inside = *around = 0;
    // In perspective the far marks are smaller; looked at too widely they would take in the plate's edge.
    for (int k = 0; k < JALI_BOARD_MARKS; k++) {
        jali_board_mark_share(k, from[k]);
        radius[k] = guess->radius_px * homography_scale(&guess->map, from[k]) /
                    homography_scale(&guess->map, from[0]);
    }
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < JALI_BOARD_MARKS; k++) {
            if (pass == 0) homography_apply(&guess->map, from[k], to[k]);
            if (!centre_mark(p, radius[k], to[k], &level[0], &level[1])) return false;
            *inside += level[0] / (2 * JALI_BOARD_MARKS);
            *around += level[1] / (2 * JALI_BOARD_MARKS);
        }
    return homography_of_points(JALI_BOARD_MARKS, (const double(*)[2])from, (const double(*)[2])to,
                                &guess->map);
}

// Mean level of a square around a place between the marks, `half` in shares of the pitch.
static double mean_around(const jali_picture *p, const homography *map, double place, double half)
{
    enum { STEPS = 7 };
    double first[2], second[2], a[2], b[2], sum = 0;
    jali_board_code_share(0, first);
    jali_board_code_share(1, second);
    double pitch = second[0] - first[0];
    homography_apply(map, (double[]){first[0] + place * pitch, first[1]}, a);
    homography_apply(map, (double[]){first[0] + (place + half) * pitch, first[1]}, b);
    double dx = b[0] - a[0], dy = b[1] - a[1]; // half a side along the row; across it is the same length
    for (int i = 0; i < STEPS * STEPS; i++) {
        int32_t row = i / STEPS, column = i % STEPS;
        double u = 2.0 * column / (STEPS - 1) - 1, v = 2.0 * row / (STEPS - 1) - 1;
        sum += level_at(p, a[0] + u * dx - v * dy, a[1] + u * dy + v * dx);
    }
    return sum / (STEPS * STEPS);
}

// Each bit against the solid to its left and right.
static void read_code(const jali_picture *p, const homography *map, double through, double plate,
                      bool code[JALI_BOARD_CODE_BITS])
{
    for (int32_t i = 0; i < JALI_BOARD_CODE_BITS; i++) {
        double solid = (mean_around(p, map, i - 0.5, 0.08) + mean_around(p, map, i + 0.5, 0.08)) / 2;
        code[i] = (mean_around(p, map, i, 0.1) - solid) / (through - plate) > CODE_SHARE;
    }
}

// From the board's mm to the picture.
static homography map_of_board(const jali_board *board, const homography *shares)
{
    const double *low = board->mark_mm[0], *high = board->mark_mm[2];
    double sx = 1 / (high[0] - low[0]), sy = 1 / (high[1] - low[1]);
    homography to_shares = {{sx, 0, -low[0] * sx, 0, sy, -low[1] * sy, 0, 0, 1}};
    return homography_after(shares, &to_shares);
}

static void describe(const mark_guess *guess, const homography *map, jali_scan *scan)
{
    const jali_board *b = &scan->board;
    double middle[2] = {b->width_mm / 2, b->height_mm / 2}, at[2], right[2];
    homography_apply(map, middle, at);
    homography_apply(map, (double[]){middle[0] + 1, middle[1]}, right);
    scan->turn_deg = atan2(right[1] - at[1], right[0] - at[0]) * 180 / M_PI;
    scan->pixel_mm = 1 / homography_scale(map, middle);
    scan->mirrored = guess->mirrored;
    scan->dark = guess->dark;
    scan->scale[0] = scan->scale[1] = 1;
}

jali_status find_board(jali_context *ctx, const jali_picture *picture, const jali_board *given,
                       jali_scan *scan, homography *map)
{
    jali_status status;
    grey g = {0};
    mark_guess guess[MOST_GUESSES];
    int32_t count, rounds, marked = -1;
    TRY(grey_of_picture(ctx, picture,
                        (MAX(picture->width_px, picture->height_px) + WORKING_PX - 1) / WORKING_PX, &g));
    TRY(guess_marks(ctx, &g, guess, &count, &rounds));
    for (int32_t i = 0; i < count && !scan->code_read; i++) {
        bool code[JALI_BOARD_CODE_BITS];
        double inside, around;
        if (!settle_guess(picture, &guess[i], &inside, &around)) continue;
        read_code(picture, &guess[i].map, inside, around, code);
        if (marked < 0) marked = i;
        status = jali_board_decode(ctx, code, &scan->board);
        if (status == JALI_NO_MEMORY) goto done;
        if (status != JALI_OK) continue;
        scan->code_read = true;
        marked = i;
    }
    if (marked < 0)
        TRY(fail(ctx, JALI_NO_RESULT,
                 "no reference board was found: its five round marks (%d round things there are) must all be "
                 "in the "
                 "picture, 10 pixels across at least, the odd one in line with two corners",
                 rounds));
    if (!scan->code_read && !given)
        TRY(fail(
            ctx, JALI_NO_RESULT,
            "the marks of a board were found, but its code along the lower edge cannot be read: scan it "
            "sharper, or say which board it is by --phi-s and --phi-v, as they were given to jali board"));
    if (given) {
        jali_board_free(ctx, &scan->board);
        TRY(jali_board_decode(ctx, given->code, &scan->board));
    }
    *map = map_of_board(&scan->board, &guess[marked].map);
    describe(&guess[marked], map, scan);
    status = JALI_OK;
done:
    grey_free(ctx, &g);
    return status;
}

// --- The map anew

enum { UNKNOWNS = 8 };

// A place that was found off, along a direction.
typedef struct pull {
    double u, v, normal[2], off; // place in -1 .. 1; off in mm
} pull;

static void pull_row(const pull *p, double row[UNKNOWNS])
{
    double nx = p->normal[0], ny = p->normal[1], radial = p->u * nx + p->v * ny;
    memcpy(row,
           (double[UNKNOWNS]){nx * p->u, nx * p->v, nx, ny * p->u, ny * p->v, ny, -p->u * radial,
                              -p->v * radial},
           UNKNOWNS * sizeof *row);
}

static int32_t gather_pulls(const jali_board *b, const jali_measured *m, double half, pull *pulls)
{
    static const double normal[3][2] = {{0, 1}, {1, 0}, {-M_SQRT1_2, M_SQRT1_2}};
    int32_t count = 0;
    for (int32_t i = 0; i < b->feature_count; i++) {
        const jali_board_feature *f = &b->feature[i];
        double u = (f->at_mm[0] - b->width_mm / 2) / half, v = (f->at_mm[1] - b->height_mm / 2) / half;
        if (!m[i].printed || f->kind == JALI_BOARD_PIN) continue;
        if (f->direction != JALI_BOARD_ROUND) {
            const double *n = normal[f->direction];
            pulls[count++] = (pull){u, v, {n[0], n[1]}, m[i].off_mm[0] * n[0] + m[i].off_mm[1] * n[1]};
            continue;
        }
        for (int k = 0; k < 2; k++) pulls[count++] = (pull){u, v, {k == 0, k == 1}, m[i].off_mm[k]};
    }
    return count;
}

// Two rounds: the second without what the first leaves further off than three scales.
static bool solve_pulls(const pull *pulls, int32_t count, double half, double x[UNKNOWNS], double *rest,
                        double *residual)
{
    double bound = INFINITY;
    for (int round = 0; round < 2; round++) {
        normal_equations e = {.unknowns = UNKNOWNS};
        double row[UNKNOWNS], squares = 0;
        int32_t kept = 0;
        for (int32_t i = 0; i < count; i++) {
            pull_row(&pulls[i], row);
            if (round == 0 || rest[i] <= bound) add_equation(&e, row, pulls[i].off / half, 1);
        }
        if (!solve_normal(&e, x)) return false;
        for (int32_t i = 0; i < count; i++) {
            pull_row(&pulls[i], row);
            double left = pulls[i].off / half;
            for (int k = 0; k < UNKNOWNS; k++) left -= row[k] * x[k];
            rest[i] = rest[count + i] = fabs(left);
            if (round == 0 || rest[i] <= bound) squares += left * left, kept++;
        }
        bound = 3 * 1.4826 * median(rest + count, count) + 1e-6;
        *residual = sqrt(squares / MAX(kept, 1)) * half;
    }
    return true;
}

jali_status refine_map(jali_context *ctx, const jali_board *board, const jali_measured *feature,
                       homography *map, double *residual_mm)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    pull *pulls;
    double *rest, x[UNKNOWNS], half = MAX(board->width_mm, board->height_mm) / 2;
    homography frame = {
        {1 / half, 0, -board->width_mm / 2 / half, 0, 1 / half, -board->height_mm / 2 / half, 0, 0, 1}};
    homography back;
    TRY(ARENA(ctx, pulls, 2 * board->feature_count));
    TRY(ARENA(ctx, rest, 4 * board->feature_count));
    int32_t count = gather_pulls(board, feature, half, pulls);
    if (count >= 3 * UNKNOWNS && solve_pulls(pulls, count, half, x, rest, residual_mm)) {
        homography moved = {{1 + x[0], x[1], x[2], x[3], 1 + x[4], x[5], x[6], x[7], 1}};
        homography_inverse(&frame, &back);
        moved = homography_after(&moved, &frame);
        moved = homography_after(&back, &moved);
        *map = homography_after(map, &moved);
    }
done:
    arena_rewind(ctx, mark);
    return status;
}
