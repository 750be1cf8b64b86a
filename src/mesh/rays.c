// A ray's walk down the hierarchy of boxes: eight slab tests at a time, the nearest child first.
#include "mesh/rays.h"
#include "mesh/mesh.h"

#include <math.h>

typedef struct slabs { // the ray as the box test wants it
    float from[3], inverse[3];
    bool backwards[3];
} slabs;

typedef struct shear { // the ray as the triangle test wants it: turned and sheared to run along z
    int32_t axis[3];
    double from[3], slope[2], scale;
} shear;

typedef struct entry {
    float t;
    int32_t level, node;
} entry;

static const double most_size_mm = 1e9; // float32 squares stay finite

enum { STACK = (BOX_WIDTH - 1) * BOX_LEVELS + 1 };

static slabs slabs_of(const ray *r)
{
    slabs s;
    for (int k = 0; k < 3; k++) {
        // A ray along a box's side must not give 0 * infinity.
        double along = fabs(r->along[k]) > 1e-30 ? r->along[k] : copysign(1e-30, r->along[k]);
        s.from[k] = (float)r->from[k];
        s.inverse[k] = (float)(1 / along);
        s.backwards[k] = along < 0;
    }
    return s;
}

static shear shear_of(const ray *r)
{
    shear s;
    int32_t z = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(r->along[k]) > fabs(r->along[z])) z = k;
    s.axis[0] = (z + 1) % 3;
    s.axis[1] = (z + 2) % 3;
    s.axis[2] = z;
    s.scale = 1 / r->along[z];
    for (int k = 0; k < 2; k++) s.slope[k] = r->along[s.axis[k]] * s.scale;
    for (int k = 0; k < 3; k++) s.from[k] = r->from[s.axis[k]];
    return s;
}

static inline bool meets_triangle(const shear *s, const float corner[3][3], double near, double far,
                                  double *t)
{
    double x[3], y[3], z[3];
    for (int c = 0; c < 3; c++) {
        z[c] = corner[c][s->axis[2]] - s->from[2];
        x[c] = corner[c][s->axis[0]] - s->from[0] - s->slope[0] * z[c];
        y[c] = corner[c][s->axis[1]] - s->from[1] - s->slope[1] * z[c];
    }
    // Exactly the negative of what the neighbour across the edge gets.
    double u = x[2] * y[1] - y[2] * x[1], v = x[0] * y[2] - y[0] * x[2], w = x[1] * y[0] - y[1] * x[0];
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
    double sum = u + v + w;
    if (sum == 0) return false;
    *t = (u * z[0] + v * z[1] + w * z[2]) * s->scale / sum;
    return *t > near && *t < far;
}

// Which children does the ray enter between near and far (bit i for child i), and where?
static inline unsigned enters(const box_node *node, const slabs *s, float near, float far, float *t)
{
    const float *low[3], *high[3];
    unsigned mask = 0;
    for (int k = 0; k < 3; k++) {
        low[k] = s->backwards[k] ? node->high[k] : node->low[k];
        high[k] = s->backwards[k] ? node->low[k] : node->high[k];
    }
#ifdef __SSE2__
    for (int half = 0; half < BOX_WIDTH; half += 4) {
        __m128 enter = _mm_set1_ps(near), leave = _mm_set1_ps(far);
        for (int k = 0; k < 3; k++) {
            __m128 from = _mm_set1_ps(s->from[k]), inverse = _mm_set1_ps(s->inverse[k]);
            enter = _mm_max_ps(_mm_mul_ps(_mm_sub_ps(_mm_loadu_ps(low[k] + half), from), inverse), enter);
            leave = _mm_min_ps(_mm_mul_ps(_mm_sub_ps(_mm_loadu_ps(high[k] + half), from), inverse), leave);
        }
        _mm_storeu_ps(t + half, enter);
        mask |= (unsigned)_mm_movemask_ps(_mm_cmple_ps(enter, leave)) << half;
    }
#else
    for (int i = 0; i < BOX_WIDTH; i++) {
        float enter = near, leave = far;
        for (int k = 0; k < 3; k++) {
            float a = (low[k][i] - s->from[k]) * s->inverse[k], b = (high[k][i] - s->from[k]) * s->inverse[k];
            enter = a > enter ? a : enter;
            leave = b < leave ? b : leave;
        }
        t[i] = enter;
        mask |= (unsigned)(enter <= leave) << i;
    }
#endif
    return mask;
}

// The children in `mask` go on the stack, the nearest on top.
static inline int32_t push_children(entry *stack, int32_t depth, int32_t level, int32_t node, unsigned mask,
                                    const float *t)
{
    int32_t bottom = depth;
    for (; mask; mask &= mask - 1, depth++) {
        int32_t child = __builtin_ctz(mask), i = depth;
        for (; i > bottom && stack[i - 1].t < t[child]; i--) stack[i] = stack[i - 1];
        stack[i] = (entry){t[child], level - 1, node * BOX_WIDTH + child};
    }
    return depth;
}

static inline __attribute__((always_inline)) bool walk(const ray_scene *scene, const ray *r, bool any,
                                                       ray_hit *hit)
{
    const box_tree *tree = &scene->tree;
    const slabs s = slabs_of(r);
    const shear turned = shear_of(r);
    double far = r->far;
    bool found = false;
    entry stack[STACK];
    int32_t depth = 0;
    if (tree->level_count) stack[depth++] = (entry){(float)r->near, tree->level_count - 1, 0};
    while (depth > 0) {
        entry e = stack[--depth];
        if (e.t > far) continue;
        float t[BOX_WIDTH];
        unsigned mask = enters(&tree->node[tree->first[e.level] + e.node], &s, (float)r->near, (float)far, t);
        if (e.level > 0) {
            depth = push_children(stack, depth, e.level, e.node, mask, t);
            continue;
        }
        for (; mask; mask &= mask - 1) {
            int32_t place = e.node * BOX_WIDTH + __builtin_ctz(mask);
            double at;
            if (!meets_triangle(&turned, (const float(*)[3])scene->corner[place], r->near, far, &at))
                continue;
            if (any) return true;
            found = true;
            far = at;
            *hit = (ray_hit){at, place};
        }
    }
    return found;
}

VECTORISED bool ray_nearest(const ray_scene *scene, const ray *r, ray_hit *hit)
{
    return walk(scene, r, false, hit);
}

VECTORISED bool ray_any(const ray_scene *scene, const ray *r)
{
    return walk(scene, r, true, NULL);
}

void ray_scene_normal(const ray_scene *scene, int32_t place, double normal[3])
{
    const float(*c)[3] = (const float(*)[3])scene->corner[place];
    double u[3], v[3], length = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = (double)c[1][k] - (double)c[0][k];
        v[k] = (double)c[2][k] - (double)c[0][k];
    }
    for (int k = 0; k < 3; k++) {
        normal[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
        length += normal[k] * normal[k];
    }
    for (int k = 0; k < 3; k++) normal[k] = length > 0 ? normal[k] / sqrt(length) : 0;
}

static void measure_box(const jali_mesh *mesh, ray_scene *scene)
{
    double squared = 0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (int32_t i = 0; i < mesh->vertex_count; i++) {
            low = MIN(low, mesh->vertex[i][k]);
            high = MAX(high, mesh->vertex[i][k]);
        }
        if (mesh->vertex_count == 0) low = high = 0;
        scene->origin[k] = low + 0.5 * (high - low);
        scene->low[k] = low - scene->origin[k];
        scene->high[k] = high - scene->origin[k];
        squared += (high - low) * (high - low);
    }
    scene->size = squared > 0 ? sqrt(squared) : 1;
}

// Boxes are wider by what the rounding of a ray to float32 can move it.
static void bound(const ray_scene *scene, const jali_mesh *mesh, box *boxes)
{
    float margin = (float)(scene->size * 0x1p-21);
    for (int32_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            float x[3];
            for (int c = 0; c < 3; c++)
                x[c] = (float)(mesh->vertex[mesh->triangle[i][c]][k] - scene->origin[k]);
            boxes[i].low[k] = MIN(x[0], MIN(x[1], x[2])) - margin;
            boxes[i].high[k] = MAX(x[0], MAX(x[1], x[2])) + margin;
        }
}

jali_status ray_scene_create(jali_context *ctx, const jali_mesh *mesh, ray_scene *scene)
{
    jali_status status;
    box *boxes = NULL;
    *scene = (ray_scene){0};
    measure_box(mesh, scene);
    if (!(scene->size < most_size_mm))
        return fail(ctx, JALI_BAD_INPUT, "the model is %.3g mm large; up to %g mm are looked at", scene->size,
                    most_size_mm);
    TRY(ALLOCATE(ctx, boxes, mesh->triangle_count));
    bound(scene, mesh, boxes);
    TRY(box_tree_create(ctx, mesh->triangle_count, boxes, &scene->tree));
    TRY(ALLOCATE(ctx, scene->corner, mesh->triangle_count));
    for (int32_t i = 0; i < mesh->triangle_count; i++)
        for (int c = 0; c < 3; c++) {
            const double *at = mesh->vertex[mesh->triangle[scene->tree.item[i]][c]];
            for (int k = 0; k < 3; k++) scene->corner[i][c][k] = (float)(at[k] - scene->origin[k]);
        }
done:
    release(ctx, boxes);
    if (status != JALI_OK) ray_scene_free(ctx, scene);
    return status;
}

void ray_scene_free(jali_context *ctx, ray_scene *scene)
{
    box_tree_free(ctx, &scene->tree);
    release(ctx, scene->corner);
    *scene = (ray_scene){0};
}
