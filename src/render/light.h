// Light: what a ray sees, and how bright it is there.
#ifndef RENDER_LIGHT_H
#define RENDER_LIGHT_H

#include "render/stage.h"

typedef enum material { NOTHING, OBJECT, GROUND, WALL, BULB } material;

typedef struct sight {
    material what;
    double distance; // from the eye
    vec at, normal;  // unit, on the side that is seen
    int32_t place;   // of the object's triangle in the scene
} sight;

/// What is seen from a point in a unit direction.
sight look(const stage *s, vec from, vec direction);

/// Straight from the sun or the lamp; `turn` picks the point of it that is asked.
vec direct_light(const stage *s, const sight *seen, uint32_t turn);

/// From everywhere else, by `count` rays; `turn` picks them.
vec ambient_light(const stage *s, const sight *seen, uint32_t turn, int32_t count);

/// What the eye gets: the display's red, green and blue, 0 .. 1, linear.
vec colour_of(const stage *s, const sight *seen, vec direct, vec ambient);

#endif
