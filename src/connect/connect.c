// Connectivity enforcement: the smallest solid part is joined to its nearest neighbour until one is left.
//
// Source:  Binary Image Carving for 3D Printing, section 4.1, Algorithm 2 (after Xu et al.).
// Differs: ties, which the paper leaves open, go by raster order, so that the result is the same on every
// run. Checked: tests/test_connect.c: the exact sequence of joins against a plain implementation on thousands
// of
//          small pictures.
#include <jali/connect.h>
#include "connect/ahead.h"
#include "connect/detour.h"
#include "base/base.h"

jali_connect_options jali_connect_defaults(void)
{
    return (jali_connect_options){.metric = JALI_METRIC_CITY_BLOCK};
}

void jali_bridges_free(jali_context *ctx, jali_bridges *bridges)
{
    release(ctx, bridges->bridge);
    release(ctx, bridges->via);
    *bridges = (jali_bridges){0};
}

typedef struct joining {
    jali_bitmap *solid;
    parts p;
    ahead a;
    detour d;
    jali_bridges laid;
    size_t capacity, via_capacity;
} joining;

// Join the part with the one that holds the white pixel (x, y).
static int32_t join_with(joining *j, int32_t root, int32_t x, int32_t y)
{
    return unite_parts(&j->p, root, root_of_label(&j->p, label_at(&j->p, x, y)));
}

// White neighbours of a fresh bridge pixel that belong to other parts are joined with it: at the far end the
// bridge can touch several parts at once. The pixel before it is its own part's.
static int32_t unite_neighbours(joining *j, int32_t root, int32_t x, int32_t y, const int32_t before[2])
{
    static const int32_t beside[4][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}};
    for (int32_t k = 0; k < 4; k++) {
        int32_t u = x + beside[k][0], v = y + beside[k][1];
        if (u == before[0] && v == before[1]) continue;
        if (u < 0 || v < 0 || u >= j->solid->width_px || v >= j->solid->height_px) continue;
        if (jali_bitmap_get(j->solid, u, v)) root = join_with(j, root, u, v);
    }
    return root;
}

static jali_status lay_pixel(jali_context *ctx, joining *j, int32_t *root, int32_t label, int32_t x,
                             int32_t y, const int32_t before[2])
{
    if (jali_bitmap_get(j->solid, x, y)) {
        *root = join_with(j, *root, x, y);
        return JALI_OK;
    }
    jali_status status = part_add_pixel(ctx, &j->p, *root, label, x, y);
    if (status != JALI_OK) return status;
    jali_bitmap_set(j->solid, x, y, true);
    j->laid.pixels++;
    *root = unite_neighbours(j, *root, x, y, before);
    return JALI_OK;
}

// |dx| + |dy| - 1 pixels between the ends of each leg.
static jali_status lay_path(jali_context *ctx, joining *j, int32_t root, int32_t bridge)
{
    jali_status status;
    int32_t from[2], to[2], label = j->laid.bridge[bridge].part[0];
    const int32_t *first = j->laid.bridge[bridge].from;
    int32_t before[2] = {first[0], first[1]};
    for (int32_t leg = 0; jali_bridge_leg(&j->laid, bridge, leg, from, to); leg++) {
        line_walk walk = walk_line(from, to);
        while (walk_on(&walk)) {
            TRY(lay_pixel(ctx, j, &root, label, walk.x, walk.y, before));
            before[0] = walk.x;
            before[1] = walk.y;
        }
    }
    TRY(queue_part(ctx, &j->p, root));
done:
    return status;
}

// Keep the corners of the way that was found.
static jali_status keep_corners(jali_context *ctx, joining *j, jali_bridge *bridge)
{
    jali_bridges *laid = &j->laid;
    jali_status status = GROW(ctx, laid->via, j->via_capacity, laid->via_count + j->d.corner_count);
    if (status != JALI_OK) return status;
    bridge->via_first = laid->via_count;
    bridge->via_count = j->d.corner_count;
    for (int32_t i = 0; i < j->d.corner_count; i++, laid->via_count++)
        memcpy(laid->via[laid->via_count], j->d.corner[i], sizeof *laid->via);
    return JALI_OK;
}

// The nearest other part, straight, or around what is blocked: no way around is shorter than one through it.
static jali_status find_way(jali_context *ctx, joining *j, const jali_connect_options *opt, int32_t root,
                            jali_bridge *bridge, bool *found)
{
    jali_status status;
    *found = true;
    *bridge = (jali_bridge){0};
    TRY(nearest_in_turn(&j->a, root, &j->laid, bridge));
    if (!opt->blocked || line_is_free(j->solid, opt->blocked, bridge->from, bridge->to)) return JALI_OK;
    TRY(find_detour(ctx, j->solid, opt->blocked, &j->p, root, opt->metric, &j->d, bridge, found));
    if (*found) TRY(keep_corners(ctx, j, bridge));
done:
    return status;
}

// Give a part a bridge; one that no way leads from is not asked again.
static jali_status join_part(jali_context *ctx, joining *j, const jali_connect_options *opt, int32_t root)
{
    jali_status status;
    bool found;
    TRY(GROW(ctx, j->laid.bridge, j->capacity, j->laid.count + 1));
    jali_bridge *bridge = &j->laid.bridge[j->laid.count];
    TRY(find_way(ctx, j, opt, root, bridge, &found));
    if (!found) {
        j->laid.stranded++;
        return JALI_OK;
    }
    bridge->part[0] = label_at(&j->p, bridge->from[0], bridge->from[1]);
    bridge->part[1] = label_at(&j->p, bridge->to[0], bridge->to[1]);
    TRY(lay_path(ctx, j, root, j->laid.count));
    j->laid.count++;
done:
    return status;
}

jali_status jali_connect(jali_context *ctx, const jali_bitmap *drawing, const jali_connect_options *given,
                         jali_bitmap *joined, jali_bridges *bridges)
{
    jali_status status;
    jali_connect_options opt = given ? *given : jali_connect_defaults();
    jali_bitmap solid = {0};
    joining j = {.solid = &solid};
    ahead_create(ctx, &solid, &j.p, opt.metric, &j.a);
    TRY(jali_bitmap_copy(ctx, drawing, &solid));
    TRY(parts_create(ctx, &solid, &j.p));
    int32_t parts_before = j.p.alive;
    for (int32_t root; j.p.alive - j.laid.stranded > 1 && smallest_part(&j.p, &root);) {
        TRY(step(ctx, "connect", 1 - (double)j.p.alive / parts_before));
        TRY(join_part(ctx, &j, &opt, root));
    }
    if (joined == drawing) jali_bitmap_free(ctx, joined);
    *joined = solid;
    solid = (jali_bitmap){0};
    if (bridges) {
        *bridges = j.laid;
        j.laid = (jali_bridges){0};
    }
done:
    if (status != JALI_OK) {
        if (joined != drawing) *joined = (jali_bitmap){0};
        if (bridges) *bridges = (jali_bridges){0};
    }
    jali_bridges_free(ctx, &j.laid);
    jali_bitmap_free(ctx, &solid);
    parts_free(ctx, &j.p);
    ahead_free(&j.a);
    detour_free(ctx, &j.d);
    return status;
}
