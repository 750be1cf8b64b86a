// The light of two scenes. By day a low sun with soft shadows, and a sky that is shut out by what stands
// before it; at night one lamp, and its light once reflected.
//
// Directions come from one low-discrepancy sequence (Roberts's R2); `turn` is where in it a pixel begins.
// Nothing is random, so pictures are the same everywhere.
#include "render/light.h"

static const vec stone = {0.74, 0.49, 0.29}, floor_tone = {0.80, 0.78, 0.75}, plaster = {0.60, 0.57, 0.54};
static const vec sunlight = {2.05, 1.93, 1.72}, zenith = {0.60, 0.68, 0.80}, horizon = {0.78, 0.77, 0.75};
static const vec lamplight = {1.0, 0.70, 0.36}, moonlight = {0.020, 0.026, 0.040};
static const vec backdrop = {0.79, 0.785, 0.775}, haze = {0.60, 0.66, 0.74};

static double fraction(double x)
{
    return x - floor(x);
}

// Point i of the sequence, in the unit square.
static void square_point(uint32_t i, double at[2])
{
    at[0] = fraction(0.5 + 0.7548776662466927 * i);
    at[1] = fraction(0.5 + 0.5698402909980532 * i);
}

// Two directions across a normal (Duff et al., "Building an orthonormal basis, revisited").
static void across(vec n, vec *a, vec *b)
{
    double sign = copysign(1, n.z), p = -1 / (sign + n.z), q = n.x * n.y * p;
    *a = (vec){1 + sign * n.x * n.x * p, sign * q, -sign * n.x};
    *b = (vec){q, sign + n.y * n.y * p, -n.y};
}

// Where a ray starts that leaves a surface: a hair's breadth off it.
static ray leaving(const stage *s, const sight *seen, vec direction, double far)
{
    vec from = along(seen->at, seen->normal, 2e-6 * s->scene->size);
    return (ray){{from.x, from.y, from.z}, {direction.x, direction.y, direction.z}, 0, far};
}

static void look_at_plane(vec from, vec direction, vec normal, double height, material what, sight *seen)
{
    double fall = -dot(direction, normal), above = dot(from, normal) - height;
    if (fall <= 0 || above <= 0 || above >= seen->distance * fall) return;
    *seen = (sight){what, above / fall, along(from, direction, above / fall), normal, -1};
}

static void look_at_bulb(const stage *s, vec from, vec direction, sight *seen)
{
    vec away = subtract(from, s->bulb);
    double half = dot(away, direction), rest = dot(away, away) - s->bulb_radius * s->bulb_radius;
    if (rest <= 0 || half >= 0 || half * half < rest) return;
    double t = -half - sqrt(half * half - rest);
    if (t >= seen->distance) return;
    vec at = along(from, direction, t);
    *seen = (sight){BULB, t, at, unit(subtract(at, s->bulb)), -1};
}

sight look(const stage *s, vec from, vec direction)
{
    sight seen = {.what = NOTHING, .distance = INFINITY};
    ray r = {{from.x, from.y, from.z}, {direction.x, direction.y, direction.z}, 0, INFINITY};
    ray_hit hit;
    if (ray_nearest(s->scene, &r, &hit)) {
        double n[3];
        ray_scene_normal(s->scene, hit.place, n);
        seen = (sight){OBJECT, hit.t, along(from, direction, hit.t), {n[0], n[1], n[2]}, hit.place};
        if (dot(seen.normal, direction) > 0) seen.normal = scaled(seen.normal, -1);
    }
    look_at_plane(from, direction, s->up, s->ground - 1e-5 * s->scene->size, GROUND, &seen);
    if (s->lamp) {
        look_at_plane(from, direction, s->towards, -s->wall, WALL, &seen);
        look_at_bulb(s, from, direction, &seen);
    }
    return seen;
}

static vec sunlight_on(const stage *s, const sight *seen, uint32_t turn)
{
    const double softness = 0.04; // half the sun's width, rad: nine times the true one
    vec a, b;
    double at[2];
    across(s->key, &a, &b);
    square_point(turn, at);
    double r = softness * sqrt(at[0]), angle = 2 * M_PI * at[1];
    vec direction = unit(along(along(s->key, a, r * cos(angle)), b, r * sin(angle)));
    double cosine = dot(seen->normal, direction);
    ray shadow = leaving(s, seen, direction, INFINITY);
    return cosine > 0 && !ray_any(s->scene, &shadow) ? scaled(sunlight, cosine) : (vec){0};
}

static vec lamplight_on(const stage *s, const sight *seen, uint32_t turn)
{
    double at[2];
    square_point(turn, at);
    double z = 1 - 2 * at[0], r = sqrt(1 - z * z), angle = 2 * M_PI * at[1];
    vec point = along(s->bulb, (vec){r * cos(angle), r * sin(angle), z}, 0.3 * s->bulb_radius);
    vec to = subtract(point, seen->at);
    double distance = length(to), cosine = dot(seen->normal, to) / distance;
    ray shadow = leaving(s, seen, scaled(to, 1 / distance), distance);
    if (cosine <= 0 || ray_any(s->scene, &shadow)) return (vec){0};
    return scaled(lamplight, cosine * s->power / (distance * distance));
}

vec direct_light(const stage *s, const sight *seen, uint32_t turn)
{
    if (seen->what == NOTHING || seen->what == BULB) return (vec){0};
    return s->lamp ? lamplight_on(s, seen, turn) : sunlight_on(s, seen, turn);
}

static double linear_of(double byte)
{
    double v = byte / 255;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

// Between the colours of the triangle's corners, by area.
static vec painted(const stage *s, const sight *seen)
{
    const float(*c)[3] = (const float(*)[3])s->scene->corner[seen->place];
    const int32_t *vertex = s->mesh->triangle[s->scene->tree.item[seen->place]];
    vec corner[3], tone[3];
    double share[3], all = 0;
    for (int i = 0; i < 3; i++) {
        const uint8_t *rgb = s->colour[vertex[i]];
        corner[i] = (vec){c[i][0], c[i][1], c[i][2]};
        tone[i] = (vec){linear_of(rgb[0]), linear_of(rgb[1]), linear_of(rgb[2])};
    }
    for (int i = 0; i < 3; i++) {
        vec a = subtract(corner[(i + 1) % 3], seen->at), b = subtract(corner[(i + 2) % 3], seen->at);
        share[i] = length(cross(a, b));
        all += share[i];
    }
    if (!(all > 0)) return tone[0];
    vec sum = {0};
    for (int i = 0; i < 3; i++) sum = along(sum, tone[i], share[i] / all);
    return sum;
}

static vec tone_of(const stage *s, const sight *seen)
{
    if (seen->what == OBJECT) return s->colour ? painted(s, seen) : stone;
    return seen->what == GROUND ? floor_tone : plaster;
}

// What comes from a direction in which nothing stands.
static vec sky(const stage *s, vec direction)
{
    double height = dot(direction, s->up);
    if (height < 0) return mixed(horizon, scaled(floor_tone, 1.1), MIN(1, -4 * height));
    return mixed(horizon, zenith, height);
}

static vec skylight_along(const stage *s, const sight *seen, vec direction)
{
    ray r = leaving(s, seen, direction, 0.5 * s->scene->size);
    // What shuts out the sky is lit itself, a little.
    return ray_any(s->scene, &r) ? scaled(stone, 0.10) : sky(s, direction);
}

static vec reflected_along(const stage *s, const sight *seen, vec direction, uint32_t turn)
{
    ray r = leaving(s, seen, direction, INFINITY);
    sight other = look(s, (vec){r.from[0], r.from[1], r.from[2]}, direction);
    if (other.what == NOTHING || other.what == BULB) return moonlight;
    // A few rays that find the lamp's own surroundings would show as spots.
    const double most = 1.2;
    vec light = times(tone_of(s, &other), lamplight_on(s, &other, turn));
    double brightest = MAX(light.x, MAX(light.y, light.z));
    return add(brightest > most ? scaled(light, most / brightest) : light, moonlight);
}

vec ambient_light(const stage *s, const sight *seen, uint32_t turn, int32_t count)
{
    vec a, b, sum = {0};
    if (seen->what == NOTHING || seen->what == BULB) return sum;
    if (count == 0)
        return s->lamp ? moonlight
                       : mixed(scaled(floor_tone, 0.7), zenith, 0.5 + 0.5 * dot(seen->normal, s->up));
    across(seen->normal, &a, &b);
    for (int32_t i = 0; i < count; i++) {
        double at[2];
        square_point(turn + 16 * (uint32_t)i, at);
        double r = sqrt(at[0]), angle = 2 * M_PI * at[1];
        vec d = along(along(scaled(seen->normal, sqrt(1 - at[0])), a, r * cos(angle)), b, r * sin(angle));
        sum = add(sum, s->lamp ? reflected_along(s, seen, d, turn + 16 * (uint32_t)i)
                               : skylight_along(s, seen, d));
    }
    return scaled(sum, 1.0 / count);
}

// Bright light turns white instead of being cut off.
static vec developed(vec light, double exposure)
{
    return (vec){1 - exp(-exposure * light.x), 1 - exp(-exposure * light.y), 1 - exp(-exposure * light.z)};
}

vec colour_of(const stage *s, const sight *seen, vec direct, vec ambient)
{
    if (seen->what == NOTHING) return s->lamp ? (vec){0.004, 0.005, 0.008} : backdrop;
    if (seen->what == BULB) return (vec){1, 0.93, 0.78};
    vec light = times(tone_of(s, seen), add(direct, ambient));
    if (s->lamp) return developed(light, 0.9);
    vec colour = developed(light, 0.62);
    if (seen->what == OBJECT) {
        double deep = s->depth > 0 ? (seen->distance - s->near_depth) / s->depth : 0;
        return mixed(colour, times(haze, colour), 0.35 * MAX(0, MIN(deep, 1)));
    }
    // The ground fades into the backdrop away from the object.
    double away = length(subtract(seen->at, scaled(s->up, dot(seen->at, s->up)))) / s->scene->size;
    return mixed(colour, backdrop, MAX(0, MIN(1, (away - 0.5) / 1.2)));
}
