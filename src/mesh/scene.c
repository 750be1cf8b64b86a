// Placing the objects of a 3MF; sizes are known before the walk.
#include "mesh/scene.h"

// First a, then b.
static transform after(const transform *a, const transform *b)
{
    transform c;
    for (int row = 0; row < 4; row++)
        for (int k = 0; k < 3; k++) {
            const double *r = a->m + 3 * row;
            c.m[3 * row + k] =
                r[0] * b->m[k] + r[1] * b->m[3 + k] + r[2] * b->m[6 + k] + (row == 3 ? b->m[9 + k] : 0);
        }
    return c;
}

static bool mirrors(const transform *t)
{
    const double *m = t->m;
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
               m[2] * (m[3] * m[7] - m[4] * m[6]) <
           0;
}

// Append one object's own triangles; a mirror image is turned so that outside stays outside.
static void place_object(const scene *s, const object *o, const transform *t, jali_mesh *mesh)
{
    bool turn = mirrors(t);
    for (int32_t i = 0; i < o->triangle_count; i++) {
        const int32_t *from = s->triangle[o->first_triangle + i];
        int32_t *to = mesh->triangle[mesh->triangle_count++];
        for (int k = 0; k < 3; k++) to[k] = mesh->vertex_count + from[turn ? 2 - k : k];
    }
    for (int32_t i = 0; i < o->vertex_count; i++) {
        const double *p = s->vertex[o->first_vertex + i];
        for (int k = 0; k < 3; k++)
            mesh->vertex[mesh->vertex_count][k] = (float)(s->unit_mm * (p[0] * t->m[k] + p[1] * t->m[3 + k] +
                                                                        p[2] * t->m[6 + k] + t->m[9 + k]));
        mesh->vertex_count++;
    }
}

// Walk the components below one item with a stack of our own; its depth was checked when the objects were
// read.
static void place_item(const scene *s, const placed *item, jali_mesh *mesh)
{
    struct {
        placed here;
        int32_t next;
    } stack[MAX_DEPTH + 1];
    int32_t depth = 0;
    stack[depth].here = *item;
    stack[depth++].next = 0;
    place_object(s, &s->object[item->object], &item->at, mesh);
    while (depth > 0) {
        const object *o = &s->object[stack[depth - 1].here.object];
        if (stack[depth - 1].next == o->part_count) {
            depth--;
            continue;
        }
        const placed *part = &s->part[o->first_part + stack[depth - 1].next++];
        placed below = {part->object, after(&part->at, &stack[depth - 1].here.at)};
        place_object(s, &s->object[below.object], &below.at, mesh);
        stack[depth].here = below;
        stack[depth++].next = 0;
    }
}

jali_status scene_mesh(jali_context *ctx, const scene *s, const model_file *file, jali_mesh *mesh)
{
    jali_status status;
    int64_t vertices = 0, triangles = 0, instances = 0;
    const char *name = file->name;
    if (s->item_count == 0) TRY(fail(ctx, JALI_BAD_INPUT, "%s: nothing is placed in its build", name));
    for (size_t i = 0; i < s->item_count; i++) {
        const object *o = &s->object[s->item[i].object];
        vertices += o->all_vertices;
        triangles += o->all_triangles;
        instances += o->instances;
    }
    if (triangles > file->opt.max_triangles || vertices > 3 * (int64_t)file->opt.max_triangles ||
        instances > MAX_PLACED)
        TRY(fail(ctx, JALI_LIMIT, "%s places %lld triangles in %lld parts; limits are %d and %d", name,
                 (long long)triangles, (long long)instances, file->opt.max_triangles, MAX_PLACED));
    if (triangles == 0) TRY(fail(ctx, JALI_BAD_INPUT, "%s holds no triangles", name));
    TRY(mesh_create(ctx, (int32_t)vertices, (int32_t)triangles, mesh));
    mesh->vertex_count = mesh->triangle_count = 0;
    for (size_t i = 0; i < s->item_count; i++) place_item(s, &s->item[i], mesh);
    TRY(mesh_validate(ctx, mesh)); // a transform may have passed the largest number
done:
    return status;
}
