// A picture of a mesh, by rays.
//
// Passes over the rows, each in parallel. First one sample a pixel: what is seen, and by a few rays the light
// that falls there. Four by four pixels share out one set of directions, so that the mean over such a window
// (of pixels that lie on the same surface) is that of sixteen times as many rays; a second, wider mean takes
// the steps out of soft shadows, a third one the spots out of what the lamp's light is reflected by. Last,
// pixels where something changes are sampled three by three; the samples take their light from the
// neighbouring pixel that lies on their surface.
//
// Limits:  facets are shaded flat; light is reflected once at night, by a constant by day.
// Checked: tests/test_render.c; docs/pictures by eye.
#include "render/light.h"

#include "mesh/mesh.h"

enum { WINDOW = 4, GRID = 3, SKY_RAYS = 4, BAND = 64, LEAST_PX = 16, MOST_PX = 8192 };

typedef struct light {
    vec direct, ambient; // from sun or lamp, from everywhere else
} light;

typedef struct canvas {
    const stage *s;
    int32_t width, height;
    int32_t ambient_rays;
    sight *seen;       // [height * width]
    light *light[2];   // [height * width] each: before and after a smoothing
    int32_t stride;    // of the smoothing, px
    bool shadows;      // are smoothed too
    int32_t first_row; // of the band
    uint8_t *rgb;
    void (*row)(const struct canvas *c, int32_t y);
} canvas;

jali_render_options jali_render_defaults(void)
{
    return (jali_render_options){.width_px = 800, .height_px = 800};
}

static vec direction_at(const canvas *c, double x, double y)
{
    return stage_direction(c->s, 2 * x / c->width - 1, 1 - 2 * y / c->height);
}

// The sixteen pixels of a window, far ones next to each other.
static uint32_t turn_of(int32_t x, int32_t y)
{
    static const uint8_t order[WINDOW * WINDOW] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
    return order[(y & 3) * WINDOW + (x & 3)];
}

static size_t index_of(const canvas *c, int32_t x, int32_t y)
{
    return (size_t)y * (size_t)c->width + (size_t)x;
}

static light light_on(const canvas *c, const sight *seen, uint32_t turn)
{
    return (light){direct_light(c->s, seen, turn), ambient_light(c->s, seen, turn, c->ambient_rays)};
}

static void sample_row(const canvas *c, int32_t y)
{
    for (int32_t x = 0; x < c->width; x++) {
        sight *seen = &c->seen[index_of(c, x, y)];
        *seen = look(c->s, c->s->eye, direction_at(c, x + 0.5, y + 0.5));
        c->light[0][index_of(c, x, y)] = light_on(c, seen, turn_of(x, y));
    }
}

// Do two sights lie on one smooth piece of surface?
static bool same_surface(const stage *s, const sight *a, const sight *b)
{
    if (a->what != b->what) return false;
    if (a->what == NOTHING || a->what == BULB) return true;
    double off = fabs(dot(subtract(b->at, a->at), a->normal));
    return dot(a->normal, b->normal) > 0.9 && off < 0.004 * s->scene->size;
}

// The mean over a window of pixels `stride` apart.
static void smooth_row(const canvas *c, int32_t y)
{
    int32_t stride = c->stride;
    for (int32_t x = 0; x < c->width; x++) {
        size_t here = index_of(c, x, y);
        light sum = {0};
        int32_t count = 0;
        for (int32_t v = y - stride; v < y + (WINDOW - 1) * stride; v += stride)
            for (int32_t u = x - stride; u < x + (WINDOW - 1) * stride; u += stride) {
                if (u < 0 || v < 0 || u >= c->width || v >= c->height) continue;
                size_t there = index_of(c, u, v);
                if (!same_surface(c->s, &c->seen[here], &c->seen[there])) continue;
                sum.direct = add(sum.direct, c->light[0][there].direct);
                sum.ambient = add(sum.ambient, c->light[0][there].ambient);
                count++;
            }
        c->light[1][here].ambient = scaled(sum.ambient, 1.0 / count);
        c->light[1][here].direct = c->shadows ? scaled(sum.direct, 1.0 / count) : c->light[0][here].direct;
    }
}

// Does what is seen change between a pixel and its neighbours?
static bool on_edge(const canvas *c, int32_t x, int32_t y)
{
    const sight *here = &c->seen[index_of(c, x, y)];
    for (int32_t v = MAX(y - 1, 0); v <= MIN(y + 1, c->height - 1); v++)
        for (int32_t u = MAX(x - 1, 0); u <= MIN(x + 1, c->width - 1); u++)
            if (!same_surface(c->s, here, &c->seen[index_of(c, u, v)])) return true;
    return false;
}

// The light of the nearest neighbour on the same surface; rays of its own where there is none.
static light light_near(const canvas *c, int32_t x, int32_t y, const sight *seen, uint32_t turn)
{
    const light *best = NULL;
    double nearest = INFINITY;
    for (int32_t v = MAX(y - 1, 0); v <= MIN(y + 1, c->height - 1); v++)
        for (int32_t u = MAX(x - 1, 0); u <= MIN(x + 1, c->width - 1); u++) {
            const sight *other = &c->seen[index_of(c, u, v)];
            vec between = subtract(other->at, seen->at);
            if (dot(between, between) >= nearest || !same_surface(c->s, seen, other)) continue;
            best = &c->light[0][index_of(c, u, v)];
            nearest = dot(between, between);
        }
    return best ? *best : light_on(c, seen, turn);
}

static vec mean_of_samples(const canvas *c, int32_t x, int32_t y)
{
    vec sum = {0};
    uint32_t side = c->s->draft ? 2 : GRID;
    for (uint32_t i = 0; i < side * side; i++) {
        uint32_t column = i % side, row = i / side;
        vec direction = direction_at(c, x + (column + 0.5) / side, y + (row + 0.5) / side);
        sight seen = look(c->s, c->s->eye, direction);
        light l = light_near(c, x, y, &seen, turn_of(x, y) + 5 * i);
        sum = add(sum, colour_of(c->s, &seen, l.direct, l.ambient));
    }
    return scaled(sum, 1.0 / (side * side));
}

// sRGB
static uint8_t byte_of(double linear)
{
    double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
    return (uint8_t)(255 * MAX(0, MIN(v, 1)) + 0.5);
}

static void colour_row(const canvas *c, int32_t y)
{
    for (int32_t x = 0; x < c->width; x++) {
        size_t i = index_of(c, x, y);
        const light *l = &c->light[0][i];
        vec colour =
            on_edge(c, x, y) ? mean_of_samples(c, x, y) : colour_of(c->s, &c->seen[i], l->direct, l->ambient);
        c->rgb[3 * i] = byte_of(colour.x);
        c->rgb[3 * i + 1] = byte_of(colour.y);
        c->rgb[3 * i + 2] = byte_of(colour.z);
    }
}

static void row_of_band(void *shared, int32_t index)
{
    const canvas *c = shared;
    c->row(c, c->first_row + index);
}

// All rows, in bands so that a run can be stopped.
static jali_status pass(jali_context *ctx, canvas *c, void (*row)(const canvas *, int32_t), double from,
                        double to)
{
    c->row = row;
    for (c->first_row = 0; c->first_row < c->height; c->first_row += BAND) {
        jali_status status = step(ctx, "render", from + (to - from) * c->first_row / c->height);
        if (status != JALI_OK) return status;
        parallel(ctx, MIN(BAND, c->height - c->first_row), row_of_band, c);
    }
    return JALI_OK;
}

static jali_status smooth(jali_context *ctx, canvas *c, int32_t stride, bool shadows, double from, double to)
{
    c->stride = stride;
    c->shadows = shadows;
    jali_status status = pass(ctx, c, smooth_row, from, to);
    light *swap = c->light[0];
    c->light[0] = c->light[1];
    c->light[1] = swap;
    return status;
}

jali_status jali_render(jali_context *ctx, const jali_mesh *mesh, const jali_render_options *given,
                        uint8_t *rgb)
{
    jali_status status;
    jali_render_options opt = given ? *given : jali_render_defaults();
    ray_scene scene = {0};
    stage s;
    canvas c = {.s = &s, .width = opt.width_px, .height = opt.height_px, .rgb = rgb};
    if (MIN(c.width, c.height) < LEAST_PX || MAX(c.width, c.height) > MOST_PX)
        return fail(ctx, JALI_BAD_VALUE, "a picture of %d x %d px: sides are %d .. %d px", c.width, c.height,
                    LEAST_PX, MOST_PX);
    c.ambient_rays = opt.draft ? 0 : SKY_RAYS;
    TRY(mesh_validate(ctx, mesh));
    TRY(ray_scene_create(ctx, mesh, &scene));
    TRY(stage_create(ctx, &scene, mesh, &opt, &s));
    s.mesh = mesh;
    s.colour = opt.colour;
    TRY(ALLOCATE(ctx, c.seen, (size_t)c.width * (size_t)c.height));
    for (int i = 0; i < 2; i++) TRY(ALLOCATE(ctx, c.light[i], (size_t)c.width * (size_t)c.height));
    TRY(pass(ctx, &c, sample_row, 0, 0.6));
    TRY(smooth(ctx, &c, 1, true, 0.6, 0.65));
    TRY(smooth(ctx, &c, 2, true, 0.65, 0.7));
    if (opt.lamp) TRY(smooth(ctx, &c, 5, false, 0.7, 0.75));
    TRY(pass(ctx, &c, colour_row, 0.75, 1));
done:
    release(ctx, c.light[0]);
    release(ctx, c.light[1]);
    release(ctx, c.seen);
    ray_scene_free(ctx, &scene);
    return status;
}
