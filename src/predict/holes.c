// Small round holes: the smaller, the more of them the printer closes.
//
// Model:   a hole of diameter d, on the surface, comes out hole_mm2 / d narrower, before edges grow. Where
// that is
//          more than d it closes. Slots and slits are no holes, nor is what goes on beyond the picture.
// Checked: tests/test_forward.c.
#include "predict/model.h"

#include <math.h>

// A hole counts as round while its second moment is at most this times a disc's of its area: an ellipse of 2
// to 1 has 1.25, a square 1.05, a bar of 4 to 1 2.2.
static const double ROUND_MOMENT = 1.25;

/// Sums over a component's pixels, for its area and how far it spreads.
typedef struct moments {
    double count, x, y, xx, xy, yy;
    bool at_border; // it goes on beyond the bitmap
} moments;

// Whole sums over the columns x0 .. x1-1 of a row.
static void add_run(moments *m, int32_t y, int32_t x0, int32_t x1)
{
    double n = x1 - x0, first = x0, last = x1 - 1.0;
    double x = n * (first + last) / 2;
    double xx = (last * (last + 1) * (2 * last + 1) - (first - 1) * first * (2 * first - 1)) / 6;
    m->count += n;
    m->x += x;
    m->y += n * y;
    m->xx += xx;
    m->xy += x * y;
    m->yy += n * y * (double)y;
}

// The diameter in mm of the disc that has a round hole's area on the surface; 0 for what is not round.
static double round_hole_mm(const printing *p, const moments *m)
{
    double x = m->x / m->count, y = m->y / m->count;
    const double *g = metric_at(p->tiles, (int32_t)x, (int32_t)y);
    double area = m->count * sqrt(g[0] * g[2] - g[1] * g[1]);
    double own = 1.0 / 12; // a pixel's own spread
    double spread = g[0] * (m->xx / m->count - x * x + own) + 2 * g[1] * (m->xy / m->count - x * y) +
                    g[2] * (m->yy / m->count - y * y + own);
    if (m->at_border || spread * 2 * M_PI > ROUND_MOMENT * area) return 0;
    return 2 * sqrt(area / M_PI) * p->pixel_mm;
}

// By how many pixels each hole's rim moves inwards: rim[label], 0 for none. -1: the hole closes.
static jali_status measure_holes(jali_context *ctx, const printing *p, const components *voids, int32_t *rim,
                                 int32_t *most)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    moments *hole;
    *most = 0;
    TRY(ARENA(ctx, hole, voids->count));
    memset(hole, 0, (size_t)voids->count * sizeof *hole);
    for (int32_t y = 0; y < voids->height_px; y++)
        for (int32_t i = voids->first[y]; i < voids->first[y + 1]; i++) {
            moments *m = &hole[voids->label[i]];
            const int32_t *span = voids->span[i];
            add_run(m, y, span[0], span[1]);
            m->at_border |= y == 0 || y == voids->height_px - 1 || span[0] == 0 || span[1] == voids->width_px;
        }
    for (int32_t i = 0; i < voids->count; i++) {
        double d_mm = round_hole_mm(p, &hole[i]);
        double more_mm = d_mm > 0 ? p->opt->hole_mm2 / d_mm : 0;
        rim[i] = more_mm >= d_mm && d_mm > 0 ? -1 : edge_px(p, more_mm);
        *most = MAX(*most, rim[i]);
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

static void paint_holes(const components *voids, const int32_t *rim, int32_t which, bool white,
                        jali_bitmap *dst)
{
    for (int32_t y = 0; y < voids->height_px; y++)
        for (int32_t i = voids->first[y]; i < voids->first[y + 1]; i++)
            if (rim[voids->label[i]] == which) paint_run(dst, y, voids->span[i][0], voids->span[i][1], white);
}

// Holes whose rims move equally far are done at once: those voids alone, grown into, joined with the rest.
jali_status narrow_holes(jali_context *ctx, printing *p)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    components voids = {0};
    jali_bitmap alone = {0};
    int32_t *rim, most;
    TRY(label_components(ctx, p->solid, false, 8, &voids));
    TRY(ARENA(ctx, rim, voids.count));
    TRY(measure_holes(ctx, p, &voids, rim, &most));
    paint_holes(&voids, rim, -1, true, p->solid);
    TRY(jali_bitmap_create(ctx, p->solid->width_px, p->solid->height_px, &alone));
    for (int32_t px = 1; px <= most; px++) {
        bool any = false;
        for (int32_t i = 0; i < voids.count && !any; i++) any = rim[i] == px;
        if (!any) continue;
        TRY(step(ctx, "predict", 0));
        fill(ctx, &alone, true);
        paint_holes(&voids, rim, px, false, &alone);
        TRY(move_edges(ctx, p, &alone, px, false, &p->scratch));
        combine(ctx, RULE_AND_NOT, &p->scratch, &alone, &p->scratch); // the rims
        combine(ctx, RULE_OR, p->solid, &p->scratch, p->solid);
    }
done:
    jali_bitmap_free(ctx, &alone);
    components_free(ctx, &voids);
    arena_rewind(ctx, mark);
    return status;
}
