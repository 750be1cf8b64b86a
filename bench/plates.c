// Carved plates for the comparison with solids.
#include "plates.h"

#include "base/base.h"

#include <math.h>

enum { SAMPLE_PX = 1000, CELL_PX = 40 };

static jali_status blank(jali_context *ctx, int32_t side_px, jali_picture *picture)
{
    picture->width_px = picture->height_px = side_px;
    return ALLOCATE(ctx, picture->grey, (size_t)side_px * side_px);
}

static jali_status from_sample(jali_context *ctx, const char *name, jali_picture *picture)
{
    jali_status status;
    jali_bitmap drawn = {0};
    TRY(jali_sample(ctx, name, SAMPLE_PX, &drawn));
    TRY(blank(ctx, SAMPLE_PX, picture));
    for (int32_t i = 0; i < SAMPLE_PX * SAMPLE_PX; i++)
        picture->grey[i] = jali_bitmap_get(&drawn, i % SAMPLE_PX, i / SAMPLE_PX) ? 255 : 0;
done:
    jali_bitmap_free(ctx, &drawn);
    return status;
}

// Rows of holes, round or square with round corners, `open` of the pitch wide.
static jali_status rows_of_holes(jali_context *ctx, int32_t rows, bool square, double open,
                                 jali_picture *picture)
{
    jali_status status;
    int32_t side = rows * CELL_PX;
    double half = 0.5 * open * CELL_PX, round = square ? 0.3 * half : half;
    TRY(blank(ctx, side, picture));
    for (int32_t y = 0; y < side; y++)
        for (int32_t x = 0; x < side; x++) {
            double dx = fabs(x % CELL_PX + 0.5 - 0.5 * CELL_PX) - (half - round);
            double dy = fabs(y % CELL_PX + 0.5 - 0.5 * CELL_PX) - (half - round);
            double inside = round - (dx > 0 && dy > 0 ? hypot(dx, dy) : fmax(dx, dy)); // grey: edges between
            picture->grey[(size_t)y * side + x] = (uint8_t)lround(255 * fmin(fmax(0.5 - inside, 0), 1));
        }
done:
    return status;
}

jali_status carved_plate(jali_context *ctx, const carved_options *o, jali_result *result)
{
    jali_status status;
    jali_picture picture = {0};
    jali_options opt = jali_defaults();
    double pitch = o->phi_s_mm + o->phi_v_mm;
    bool drilled = strcmp(o->picture, "drilled") == 0, lattice = strcmp(o->picture, "lattice") == 0;
    *result = (jali_result){0};
    if (drilled || lattice)
        TRY(rows_of_holes(ctx, o->rows, lattice, o->phi_v_mm / pitch, &picture));
    else if (strpbrk(o->picture, "./"))
        TRY(jali_read(ctx, o->picture, NULL, &picture));
    else
        TRY(from_sample(ctx, o->picture, &picture));
    opt.optimise.phi_s_mm = o->phi_s_mm;
    opt.optimise.phi_v_mm = o->phi_v_mm;
    if (drilled || lattice) { // strips as wide as they are drawn: nothing is too narrow, nothing swells
        opt.optimise.phi_e_mm = 0;
        opt.optimise.phi_s_mm *= 0.7;
        opt.optimise.phi_v_mm *= 0.7;
    }
    opt.place.width_mm = o->width_mm > 0 ? o->width_mm : o->rows * pitch;
    opt.predict = opt.check = false;
    TRY(jali_make(ctx, &picture, &opt, result));
done:
    jali_picture_free(ctx, &picture);
    return status;
}
