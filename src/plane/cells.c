// Which triangles are inside: the tone changes at each edge of the kinds asked for.
#include "plane/triangulation.h"

jali_status label_tones(jali_context *ctx, const triangulation *plane, uint8_t kinds, uint8_t *tone)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t *waiting, depth = 0;
    enum { UNSEEN = 2 };
    TRY(ARENA(ctx, waiting, plane->triangle_count));
    for (int32_t t = 0; t < plane->triangle_count; t++) {
        tone[t] = is_ghost(plane, t) ? 0 : UNSEEN;
        if (tone[t] == 0) waiting[depth++] = t;
    }
    while (depth > 0) {
        int32_t t = waiting[--depth];
        for (int k = 0; k < 3; k++) {
            int32_t other = plane->beside[4 * t + k] >> 2;
            if (tone[other] != UNSEEN) continue;
            tone[other] = tone[t] ^ ((plane->kind[4 * t + k] & kinds) != 0);
            waiting[depth++] = other;
        }
    }
done:
    arena_rewind(ctx, mark);
    return status;
}
