// Sides of a mesh, linked through the vertex they leave.
//
// Checked: tests/test_shell.c.
#include "mesh/sides.h"

static int32_t next_of(int32_t s)
{
    return (s & 3) == 2 ? s - 2 : s + 1;
}
static int32_t last_of(int32_t s)
{
    return (s & 3) == 0 ? s + 2 : s - 1;
}

void sides_free(jali_context *ctx, sides *s)
{
    release(ctx, s->corner);
    release(ctx, s->beside);
    release(ctx, s->star);
    *s = (sides){0};
}

// The sides that leave each vertex: vertex v owns item[first[v]] .. item[first[v + 1]] - 1.
static jali_status sides_by_vertex(jali_context *ctx, int32_t vertex_count, const sides *s, int32_t **first,
                                   int32_t **item)
{
    jali_status status;
    int32_t *next;
    TRY(ARENA(ctx, *first, vertex_count + 2));
    TRY(ARENA(ctx, *item, 3 * (size_t)s->cell_count + 1));
    memset(*first, 0, (size_t)(vertex_count + 2) * sizeof **first);
    next = *first + 1;
    for (int32_t i = 0; i < 4 * s->cell_count; i++)
        if ((i & 3) != 3) next[s->corner[next_of(i)] + 1]++;
    for (int32_t v = 0; v < vertex_count; v++) next[v + 1] += next[v];
    for (int32_t i = 0; i < 4 * s->cell_count; i++)
        if ((i & 3) != 3) (*item)[next[s->corner[next_of(i)]]++] = i;
done:
    return status;
}

// The one side that runs from `from` to `to`; NO_SIDE when there is none or more than one.
static int32_t only_side(const sides *s, const int32_t *first, const int32_t *item, int32_t from, int32_t to)
{
    int32_t found = NO_SIDE;
    for (int32_t i = first[from]; i < first[from + 1]; i++) {
        if (s->corner[last_of(item[i])] != to) continue;
        if (found != NO_SIDE) return NO_SIDE;
        found = item[i];
    }
    return found;
}

jali_status sides_create(jali_context *ctx, int32_t vertex_count, int32_t triangle_count,
                         const int32_t (*triangle)[3], sides *s)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t *first, *item;
    *s = (sides){0};
    if (triangle_count >= INT32_MAX / 8)
        return fail(ctx, JALI_LIMIT, "%d triangles are more than the %d a surface may have", triangle_count,
                    INT32_MAX / 8);
    TRY(ALLOCATE(ctx, s->corner, 4 * (size_t)triangle_count + 4));
    TRY(ALLOCATE(ctx, s->beside, 4 * (size_t)triangle_count + 4));
    TRY(ALLOCATE(ctx, s->star, (size_t)vertex_count + 1));
    s->cell_count = triangle_count;
    for (int32_t v = 0; v < vertex_count; v++) s->star[v] = -1;
    for (int32_t t = 0; t < triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            s->corner[4 * t + k] = triangle[t][k];
            s->star[triangle[t][k]] = t;
        }
    TRY(sides_by_vertex(ctx, vertex_count, s, &first, &item));
    for (int32_t i = 0; i < 4 * triangle_count; i++) {
        if ((i & 3) == 3) continue;
        int32_t from = s->corner[next_of(i)], to = s->corner[last_of(i)];
        int32_t twin = only_side(s, first, item, to, from);
        s->beside[i] = twin != NO_SIDE && only_side(s, first, item, from, to) == i ? twin : NO_SIDE;
    }
done:
    arena_rewind(ctx, mark);
    if (status != JALI_OK) sides_free(ctx, s);
    return status;
}

jali_status sides_close(jali_context *ctx, int32_t vertex_count, sides *s, int32_t *stuck)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t *leaving, open = 0, cells = s->cell_count; // leaving[v]: the ghost whose border edge leaves v
    size_t corners = 4 * (size_t)cells + 4, besides = corners;
    *stuck = -1;
    for (int32_t i = 0; i < 4 * cells; i++) open += (i & 3) != 3 && s->beside[i] == NO_SIDE;
    if ((int64_t)cells + open >= INT32_MAX / 4)
        return fail(ctx, JALI_LIMIT, "the surface has too many border edges: %d", open);
    TRY(GROW(ctx, s->corner, corners, 4 * ((size_t)cells + (size_t)open) + 4));
    TRY(GROW(ctx, s->beside, besides, 4 * ((size_t)cells + (size_t)open) + 4));
    TRY(ARENA(ctx, leaving, vertex_count + 1));
    for (int32_t v = 0; v < vertex_count; v++) leaving[v] = -1;
    for (int32_t i = 0; i < 4 * cells; i++) {
        if ((i & 3) == 3 || s->beside[i] != NO_SIDE) continue;
        int32_t from = s->corner[next_of(i)], to = s->corner[last_of(i)], ghost = s->cell_count++;
        s->corner[4 * ghost] = to;
        s->corner[4 * ghost + 1] = from;
        s->corner[4 * ghost + 2] = -1;
        s->beside[i] = 4 * ghost + 2;
        s->beside[4 * ghost + 2] = i;
        if (leaving[from] >= 0) *stuck = from;
        leaving[from] = ghost;
    }
    for (int32_t g = cells; g < s->cell_count && *stuck < 0; g++) { // the border goes on from `to`
        int32_t to = s->corner[4 * g], after = leaving[to];
        if (after < 0) {
            *stuck = to;
            break;
        }
        s->beside[4 * g + 1] = 4 * after;
        s->beside[4 * after] = 4 * g + 1;
    }
done:
    arena_rewind(ctx, mark);
    return status;
}
