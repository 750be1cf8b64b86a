// The plain samples: one rule each, made to be hard in one way each.
#include "sample/samples.h"

#include <math.h>

static const spot middle = {500, 500};
static const double golden_turns = 0.38196601125010515; // 1 - 1 / golden ratio

// Loose seeds at equal areas along the golden angle, larger towards the rim.
void draw_sunflower(board *b)
{
    enum { SEEDS = 620 };
    draw_box(b, WHITE, 0, 0, 1000, 1000);
    draw_disc(b, BLACK, middle, 462);
    for (int32_t i = 0; i < SEEDS; i++) {
        double share = sqrt((i + 0.5) / SEEDS);
        spot place = polar(middle, 448 * share, golden_turns * i);
        draw_disc(b, WHITE, place, 7 + 7 * share);
        draw_disc(b, BLACK, place, 1.5 + 4.5 * share * share);
    }
}

void draw_spiral(board *b)
{
    enum { ARMS = 6, PIECES = 160, BEADS = 15 };
    draw_box(b, WHITE, 0, 0, 1000, 1000);
    draw_disc(b, BLACK, middle, 455);
    for (int32_t arm = 0; arm < ARMS; arm++) {
        spot last = polar(middle, 510, (double)arm / ARMS);
        double width = 74;
        for (int32_t i = 1; i <= PIECES; i++) {
            double f = (double)i / PIECES, radius = 510 * (1 - f) * (1 - f) + 46 * f;
            double next_width = 74 * (1 - f) * (1 - f) + 7;
            spot next = polar(middle, radius, (double)arm / ARMS + 0.62 * f * (1 + 0.7 * f));
            draw_limb(b, WHITE, last, next, width, next_width);
            last = next;
            width = next_width;
        }
        for (int32_t i = 0; i < BEADS; i++) {
            double f = (i + 1.6) / (BEADS + 2), radius = 510 * (1 - f) * (1 - f) + 46 * f;
            draw_disc(b, WHITE, polar(middle, radius, (arm + 0.5) / ARMS + 0.62 * f * (1 + 0.7 * f)),
                      25 * (1 - f) * (1 - f) + 3);
        }
    }
    draw_disc(b, WHITE, middle, 52);
    draw_disc(b, BLACK, middle, 34);
    draw_disc(b, WHITE, middle, 17);
}

void draw_rings(board *b)
{
    draw_box(b, WHITE, 0, 0, 1000, 1000);
    draw_disc(b, BLACK, middle, 468);
    for (int32_t i = 0; i < 6; i++) draw_ring(b, middle, 430 - 74 * i, 34 - 3 * i);
    for (int32_t i = 0; i < 5; i++) {
        int32_t dots = 40 - 7 * i;
        for (int32_t k = 0; k < dots; k++)
            draw_disc(b, WHITE, polar(middle, 393 - 74 * i, (k + 0.5 * (i % 2)) / dots), 9 - i);
    }
    draw_disc(b, WHITE, middle, 26);
}

// Dots on a lattice turned by an eighth, larger where a ball lit from the upper left is darker.
void draw_halftone(board *b)
{
    enum { HALF = 54 };
    const double pitch = 13.2;
    draw_box(b, WHITE, 0, 0, 1000, 1000);
    for (int32_t v = -HALF; v <= HALF; v++)
        for (int32_t u = -HALF; u <= HALF; u++) {
            spot place = plus(middle, times(at(u - v, u + v), pitch * 0.70710678118654752));
            if (place.x < 24 || place.x > 976 || place.y < 24 || place.y > 976) continue;
            spot off = times(minus(place, middle), 1 / 360.0);
            double square = off.x * off.x + off.y * off.y, dark = 0.20 + 0.32 * place.y / 1000;
            if (square < 1) {
                double light = (-0.5 * off.x - 0.58 * off.y + 0.64 * sqrt(1 - square));
                dark = 1 - 0.04 - 0.96 * MAX(light, 0.09 * square);
            } else {
                spot cast = at((place.x - 610) / 400, (place.y - 845) / 70);
                double shade = cast.x * cast.x + cast.y * cast.y;
                if (shade < 1) dark += (0.95 - dark) * (1 - shade);
            }
            draw_disc(b, BLACK, place, pitch * 0.5642 * sqrt(dark) * (1 + 0.22 * dark * dark));
        }
}

void draw_stripes(board *b)
{
    double left = 30, pitch = 40;
    draw_box(b, WHITE, 0, 0, 1000, 1000);
    while (left + pitch / 2 < 970) {
        draw_box(b, BLACK, left, 40, left + pitch / 2, 960);
        left += pitch;
        pitch = MAX(pitch * 0.957, 2);
    }
}

void draw_checkerboard(board *b)
{
    enum { SQUARES = 16 };
    const double side = 56.25;
    draw_box(b, WHITE, 0, 0, 1000, 1000);
    for (int32_t v = 0; v < SQUARES; v++)
        for (int32_t u = v % 2; u < SQUARES; u += 2)
            draw_box(b, BLACK, 50 + side * u, 50 + side * v, 50 + side * (u + 1), 50 + side * (v + 1));
}
