// Connectivity enforcement: the smallest solid part is joined to its nearest neighbour until one is left.
//
// Source:  Binary Image Carving for 3D Printing, section 4.1, Algorithm 2 (after Xu et al.).
// Differs: ties, which the paper leaves open, go by raster order, so that the result is the same on every
// run. Checked: tests/test_connect.c: the exact sequence of joins against a plain implementation on thousands
// of
//          small pictures.
#include <jali/connect.h>
#include "connect/search.h"
#include "base/base.h"

jali_connect_options jali_connect_defaults(void)
{
    return (jali_connect_options){.metric = JALI_METRIC_CITY_BLOCK};
}

void jali_bridges_free(jali_context *ctx, jali_bridges *bridges)
{
    release(ctx, bridges->bridge);
    *bridges = (jali_bridges){0};
}

typedef struct joining {
    jali_bitmap *solid;
    parts p;
    search s;
    int64_t pixels;
} joining;

// Join the part with the one that holds the white pixel (x, y).
static int32_t join_with(joining *j, int32_t root, int32_t x, int32_t y)
{
    return unite_parts(&j->p, root, root_of_label(&j->p, label_at(&j->p, x, y)));
}

// White neighbours of a fresh bridge pixel that belong to other parts are joined with it: at the far end the
// bridge can touch several parts at once.
static int32_t unite_neighbours(joining *j, int32_t root, int32_t x, int32_t y)
{
    static const int32_t beside[4][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}};
    for (int32_t k = 0; k < 4; k++) {
        int32_t u = x + beside[k][0], v = y + beside[k][1];
        if (u < 0 || v < 0 || u >= j->solid->width_px || v >= j->solid->height_px) continue;
        if (jali_bitmap_get(j->solid, u, v)) root = join_with(j, root, u, v);
    }
    return root;
}

static jali_status lay_pixel(jali_context *ctx, joining *j, int32_t *root, int32_t label, int32_t x,
                             int32_t y)
{
    if (jali_bitmap_get(j->solid, x, y)) {
        *root = join_with(j, *root, x, y);
        return JALI_OK;
    }
    jali_status status = part_add_pixel(ctx, &j->p, *root, label, x, y);
    if (status != JALI_OK) return status;
    jali_bitmap_set(j->solid, x, y, true);
    j->pixels++;
    *root = unite_neighbours(j, *root, x, y);
    return JALI_OK;
}

// |dx| + |dy| - 1 pixels between the ends.
static jali_status lay_path(jali_context *ctx, joining *j, int32_t root, const jali_bridge *bridge)
{
    jali_status status;
    line_walk walk = walk_line(bridge->from, bridge->to);
    while (walk_on(&walk)) TRY(lay_pixel(ctx, j, &root, bridge->part[0], walk.x, walk.y));
    TRY(queue_part(ctx, &j->p, root));
done:
    return status;
}

jali_status jali_connect(jali_context *ctx, const jali_bitmap *drawing, const jali_connect_options *given,
                         jali_bitmap *joined, jali_bridges *bridges)
{
    jali_status status;
    jali_connect_options opt = given ? *given : jali_connect_defaults();
    jali_bitmap solid = {0};
    jali_bridges laid = {0};
    size_t capacity = 0;
    joining j = {.solid = &solid};
    TRY(jali_bitmap_copy(ctx, drawing, &solid));
    TRY(parts_create(ctx, &solid, &j.p));
    int32_t parts_before = j.p.alive;
    while (j.p.alive > 1) {
        TRY(step(ctx, "connect", 1 - (double)j.p.alive / parts_before));
        int32_t root = smallest_part(&j.p);
        TRY(GROW(ctx, laid.bridge, capacity, laid.count + 1));
        jali_bridge *bridge = &laid.bridge[laid.count];
        TRY(nearest_other(ctx, &solid, &j.p, root, opt.metric, &j.s, bridge));
        bridge->part[0] = label_at(&j.p, bridge->from[0], bridge->from[1]);
        bridge->part[1] = label_at(&j.p, bridge->to[0], bridge->to[1]);
        TRY(lay_path(ctx, &j, root, bridge));
        laid.count++;
    }
    laid.pixels = j.pixels;
    if (joined == drawing) jali_bitmap_free(ctx, joined);
    *joined = solid;
    solid = (jali_bitmap){0};
    if (bridges) {
        *bridges = laid;
        laid = (jali_bridges){0};
    }
done:
    if (status != JALI_OK) {
        if (joined != drawing) *joined = (jali_bitmap){0};
        if (bridges) *bridges = (jali_bridges){0};
    }
    jali_bridges_free(ctx, &laid);
    jali_bitmap_free(ctx, &solid);
    parts_free(ctx, &j.p);
    search_free(ctx, &j.s);
    return status;
}
