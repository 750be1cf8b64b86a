// Fields: which patch is set where.
#include "raster/field.h"
#include "base/base.h"

#include <math.h>

// Least and most, and how far any patch reaches.
static void measure(field *f)
{
    f->least = INT32_MAX;
    f->most = 0;
    f->left = f->right = f->above = f->below = 0;
    f->own_pixel = true;
    for (int32_t i = 0; i < f->patches; i++) {
        const patch *p = &f->patch[i];
        f->least = MIN(f->least, p->size);
        f->most = MAX(f->most, p->size);
        f->above = MAX(f->above, -p->top);
        f->below = MAX(f->below, p->top + p->rows - 1);
        f->own_pixel = f->own_pixel && p->top <= 0 && p->top + p->rows > 0 && p->span[-p->top][0] <= 0 &&
                       p->span[-p->top][1] >= 0;
        for (int32_t k = 0; k < p->rows; k++) {
            f->left = MAX(f->left, -p->span[k][0]);
            f->right = MAX(f->right, p->span[k][1]);
        }
    }
}

jali_status field_of_element(jali_context *ctx, element *e, field *f)
{
    jali_status status;
    static const tiling flat = {0};
    *f = (field){.tiles = &flat, .whole = *e};
    *e = (element){0};
    TRY(ALLOCATE_CLEARED(ctx, f->patch, 1));
    f->patches = 1;
    TRY(patch_of_element(ctx, &f->whole, f->patch));
    measure(f);
done:
    if (status != JALI_OK) field_free(ctx, f);
    return status;
}

static bool same_patch(const patch *a, const patch *b)
{
    return a->size == b->size && a->top == b->top && a->rows == b->rows &&
           memcmp(a->span, b->span, (size_t)a->rows * sizeof *a->span) == 0;
}

static uint32_t hash_of(const patch *p)
{
    uint64_t hash = UINT64_C(14695981039346656037) ^ (uint32_t)p->top;
    for (int32_t k = 0; k < p->rows; k++)
        for (int32_t side = 0; side < 2; side++)
            hash = (hash ^ (uint32_t)p->span[k][side]) * UINT64_C(1099511628211);
    return (uint32_t)(hash ^ hash >> 32);
}

jali_status field_of_patches(jali_context *ctx, const tiling *tiles, patch *each, field *f)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t *slot, slots = 2; // of a hash table: patch + 1, 0 = free
    *f = (field){.tiles = tiles};
    while (slots < 2 * tiles->kinds) slots *= 2;
    TRY(ARENA(ctx, slot, slots));
    memset(slot, 0, (size_t)slots * sizeof *slot);
    TRY(ALLOCATE(ctx, f->which, tiles->kinds));
    TRY(ALLOCATE_CLEARED(ctx, f->patch, tiles->kinds));
    for (int32_t kind = 0; kind < tiles->kinds; kind++) {
        uint32_t at = hash_of(&each[kind]) & (uint32_t)(slots - 1);
        while (slot[at] && !same_patch(&f->patch[slot[at] - 1], &each[kind]))
            at = (at + 1) & (uint32_t)(slots - 1);
        if (!slot[at]) {
            f->patch[f->patches] = each[kind];
            each[kind] = (patch){0};
            slot[at] = ++f->patches;
        }
        f->which[kind] = (uint16_t)(slot[at] - 1);
    }
    measure(f);
done:
    if (status != JALI_OK) field_free(ctx, f);
    arena_rewind(ctx, mark);
    return status;
}

jali_status field_of_discs(jali_context *ctx, const tiling *tiles, double diameter_px, double more_px,
                           bool odd, bool safely, field *f)
{
    jali_status status;
    element disc = {0};
    patch *each = NULL;
    *f = (field){0};
    if (is_flat(tiles)) {
        TRY(element_disc(ctx, diameter_px + 2 * more_px, &disc));
        TRY(field_of_element(ctx, &disc, f));
        goto done;
    }
    TRY(ALLOCATE_CLEARED(ctx, each, tiles->kinds));
    for (int32_t kind = 0; kind < tiles->kinds; kind++) {
        double safe_px = safely ? diameter_px * exp(-tiles->slack[kind]) : diameter_px;
        ellipse e = ellipse_of_disc(tiles->metric[kind], safe_px, more_px);
        TRY(patch_within(ctx, &e, odd, &each[kind]));
    }
    TRY(field_of_patches(ctx, tiles, each, f));
done:
    for (int32_t kind = 0; each && kind < tiles->kinds; kind++) patch_free(ctx, &each[kind]);
    release(ctx, each);
    element_free(ctx, &disc);
    return status;
}

void field_free(jali_context *ctx, field *f)
{
    for (int32_t i = 0; f->patch && i < f->patches; i++) patch_free(ctx, &f->patch[i]);
    element_free(ctx, &f->whole);
    release(ctx, f->patch);
    release(ctx, f->which);
    field_memory_free(ctx, f->memory);
    *f = (field){0};
}

const patch *patch_at(const field *f, int32_t x, int32_t y)
{
    const tiling *t = f->tiles;
    if (!f->which) return f->patch;
    int32_t i = MIN(MAX(x, 0) / t->tile_px, t->columns - 1), j = MIN(MAX(y, 0) / t->tile_px, t->rows - 1);
    return patch_of_tile(f, (int64_t)j * t->columns + i);
}

void paint_stroke(jali_bitmap *dst, const int32_t from[2], const int32_t to[2], const field *brush,
                  bool white)
{
    line_walk walk = walk_line(from, to);
    do paint_patch(dst, walk.x, walk.y, patch_at(brush, walk.x, walk.y), white);
    while (walk_on(&walk));
}
