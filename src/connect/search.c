// A small part grows in a window of its bounding box and a rim until it meets another; a rim that is too
// narrow is made wider.
#include "connect/search.h"
#include "base/base.h"

enum { MOST_NEAR_RIM_PX = 448, MOST_NEAR_WORDS = 1 << 14 };

static window first_window(const jali_bitmap *solid, const parts *p, int32_t root)
{
    return window_around(solid, p->box[root], FIRST_RIM_PX);
}

// Draw the part alone into the narrowest window.
static jali_status begin(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root, search *s)
{
    jali_status status;
    window first = first_window(solid, p, root);
    s->g.steps = 0;
    s->rim = FIRST_RIM_PX;
    TRY(make_room(ctx, &first, &s->g));
    TRY(make_plane(ctx, &first, &s->own));
    draw_part(p, root, &first, &s->own);
    memcpy(s->g.grown.word, s->own.word, (size_t)word_count(&first) * sizeof *s->own.word);
done:
    return status;
}

// Go on from window to window, the widest with a rim of most_rim at most; *found is false when that was all.
static jali_status go_on(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                         jali_metric metric, int32_t most_rim, search *s, jali_bridge *bridge, bool *found)
{
    jali_status status;
    int32_t longest = solid->width_px + solid->height_px;
    window first = first_window(solid, p, root), w = window_around(solid, p->box[root], s->rim);
    *found = false;
    while (!stopping(ctx)) {
        draw_picture(solid, &w, &s->g.picture);
        if (grow_until_met(ctx, &w, MIN(s->rim, longest), NULL, metric, &s->g)) {
            first_met_pixel(&w, &s->g, bridge->to);
            nearest_own(&first, &s->own, metric, s->g.steps, bridge->to, bridge->from);
            *found = true;
            return JALI_OK;
        }
        if (s->rim >= MIN(most_rim, longest)) return JALI_OK;
        window narrow = w;
        s->rim = wider_rim(s->rim);
        w = window_around(solid, p->box[root], s->rim);
        TRY(widen(ctx, &narrow, &w, &s->g));
        TRY(make_room(ctx, &w, &s->g));
    }
done:
    return status;
}

jali_status nearest_other(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                          jali_metric metric, search *s, jali_bridge *bridge)
{
    jali_status status;
    TRY(begin(ctx, solid, p, root, s));
    TRY(nearest_further(ctx, solid, p, root, metric, s, bridge));
done:
    return status;
}

jali_status nearest_further(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                            jali_metric metric, search *s, jali_bridge *bridge)
{
    bool found;
    jali_status status = go_on(ctx, solid, p, root, metric, INT32_MAX, s, bridge, &found);
    return status == JALI_OK && !found ? step(ctx, "connect", 0) : status;
}

jali_status make_room_near(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                           search *s)
{
    jali_status status;
    window first = first_window(solid, p, root), near = first;
    s->near_rim = 0;
    for (int32_t rim = FIRST_RIM_PX; rim <= MOST_NEAR_RIM_PX; rim = wider_rim(rim)) {
        window wider = window_around(solid, p->box[root], rim);
        if (word_count(&wider) > MOST_NEAR_WORDS) break;
        near = wider;
        s->near_rim = rim;
    }
    if (s->near_rim == 0) return JALI_OK;
    TRY(make_plane(ctx, &first, &s->own));
    TRY(make_planes(ctx, &near, &s->g));
done:
    return status;
}

bool nearest_near(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                  jali_metric metric, search *s, jali_bridge *bridge)
{
    bool found = false;
    return begin(ctx, solid, p, root, s) == JALI_OK &&
           go_on(ctx, solid, p, root, metric, s->near_rim, s, bridge, &found) == JALI_OK && found;
}

void search_free(jali_context *ctx, search *s)
{
    growing_free(ctx, &s->g);
    plane_free(ctx, &s->own);
    *s = (search){0};
}
