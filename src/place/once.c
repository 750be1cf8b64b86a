// Does a patch cover each place of the plane once?
//
// Its faces all turn counter-clockwise and hang together, so the map to the plane is an immersion: when its
// borders neither cross themselves nor each other, their turning numbers add up to 2 less their number, so
// just one of them is an outer one, and the map is one-to-one. Crossings of borders are found exactly.
//
// Checked: tests/test_place_on.c: random textures against a search over all pairs of faces.
#include "place/patch.h"

#include "plane/snap.h"

#include <stdlib.h>

static int compare_pieces(const void *left, const void *right)
{
    const int32_t *a = left, *b = right;
    if (a[0] != b[0]) return a[0] < b[0] ? -1 : 1;
    return a[1] < b[1] ? -1 : a[1] > b[1];
}

// A place of the snapped border where two pieces run the same way, as a point of the patch; -1: there is
// none.
static int32_t runs_together(const jali_patch *patch, snapped *s)
{
    if (s->piece_count == 0) return -1;
    qsort(s->piece, (size_t)s->piece_count, sizeof *s->piece, compare_pieces);
    for (int32_t i = 1; i < s->piece_count; i++) {
        if (compare_pieces(s->piece[i - 1], s->piece[i]) != 0) continue;
        for (int32_t p = 0; p < patch->point_count; p++)
            if (s->home[p] == s->piece[i][0] || s->home[p] == s->piece[i][1]) return p;
        return 0; // a piece between two crossings, which would have been found
    }
    return -1;
}

jali_status find_overlap(jali_context *ctx, const jali_patch *patch, int32_t *point)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    sides linked = {0};
    snapped s = {0};
    int32_t(*border)[2], crossed[2], count = 0;
    *point = -1;
    TRY(sides_create(ctx, patch->point_count, patch->face_count, (const int32_t(*)[3])patch->corner,
                     &linked));
    TRY(ARENA(ctx, border, 3 * (size_t)patch->face_count + 1));
    for (int32_t i = 0; i < 3 * patch->face_count; i++) {
        int32_t side = 4 * (i / 3) + i % 3;
        if (linked.beside[side] != NO_SIDE) continue;
        border[count][0] = patch->corner[i / 3][(i + 1) % 3];
        border[count++][1] = patch->corner[i / 3][(i + 2) % 3];
    }
    TRY(snap_round(ctx, (const int32_t(*)[2])patch->point, patch->point_count, (const int32_t(*)[2])border,
                   count, count, &s, crossed));
    *point = crossed[0] >= 0 ? border[crossed[0]][0] : runs_together(patch, &s);
done:
    snapped_free(ctx, &s);
    sides_free(ctx, &linked);
    arena_rewind(ctx, mark);
    return status;
}
