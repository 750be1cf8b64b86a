// Lettering with a broad pen held at one angle: thick and thin come from the direction of the stroke. The
// letters are pierced, so what they enclose falls out; the small lines are finer than most printers.
#include "sample/samples.h"

enum { MOST_STROKES = 6 };

// A letter of strokes, each a cubic curve; a straight one has its ends twice. The base line is y = 0,
// lower-case letters are 1 high, y up.
typedef struct letter {
    char name;
    double advance;
    int32_t count;
    spot stroke[MOST_STROKES][4];
} letter;

#define LINE(x0, y0, x1, y1)                                                                                 \
    {                                                                                                        \
        {x0, y0}, {x0, y0}, {x1, y1},                                                                        \
        {                                                                                                    \
            x1, y1                                                                                           \
        }                                                                                                    \
    }
#define LEFT_BOWL                                                                                            \
    {                                                                                                        \
        {.47, 1}, {-.11, 1}, {-.11, 0},                                                                      \
        {                                                                                                    \
            .47, 0                                                                                           \
        }                                                                                                    \
    }
#define RIGHT_BOWL                                                                                           \
    {                                                                                                        \
        {.43, 1}, {1.01, 1}, {1.01, 0},                                                                      \
        {                                                                                                    \
            .43, 0                                                                                           \
        }                                                                                                    \
    }
#define TO_STEM_ABOVE                                                                                        \
    {                                                                                                        \
        {.47, 1}, {.62, 1}, {.73, .93},                                                                      \
        {                                                                                                    \
            .8, .82                                                                                          \
        }                                                                                                    \
    }
#define TO_STEM_BELOW                                                                                        \
    {                                                                                                        \
        {.47, 0}, {.62, 0}, {.73, .1},                                                                       \
        {                                                                                                    \
            .8, .24                                                                                          \
        }                                                                                                    \
    }

// clang-format off
static const letter letters[] = {
    {'J', .78, 2, {LINE(.5, 1.5, .5, .38), {{.5, .38}, {.5, -.16}, {.1, -.12}, {0, .12}}}},
    {'A', 1.16, 3, {LINE(.56, 1.5, .02, 0), LINE(.52, 1.5, 1.06, 0), LINE(.2, .46, .9, .46)}},
    {'L', .92, 2, {LINE(.1, 1.5, .1, 0), {{.1, .04}, {.4, .04}, {.6, -.06}, {.84, .1}}}},
    {'I', .34, 1, {LINE(.16, 1.5, .16, 0)}},
    {'a', .98, 4, {LEFT_BOWL, TO_STEM_ABOVE, TO_STEM_BELOW, LINE(.8, 1, .8, 0)}},
    {'c', .86, 3, {LEFT_BOWL, {{.47, 1}, {.6, 1}, {.7, .95}, {.76, .84}},
                  {{.47, 0}, {.62, 0}, {.72, .06}, {.8, .2}}}},
    {'d', .98, 4, {LEFT_BOWL, TO_STEM_ABOVE, TO_STEM_BELOW, LINE(.8, 1.6, .8, 0)}},
    {'e', .9, 4, {LEFT_BOWL, {{.47, 1}, {.78, 1}, {.86, .76}, {.8, .56}}, LINE(.8, .56, .08, .46),
                  {{.47, 0}, {.62, 0}, {.73, .06}, {.82, .2}}}},
    {'g', .98, 5, {LEFT_BOWL, TO_STEM_ABOVE, TO_STEM_BELOW, LINE(.8, 1, .8, -.2),
                   {{.8, -.2}, {.8, -.66}, {.3, -.62}, {.1, -.42}}}},
    {'h', .95, 3, {LINE(.12, 1.6, .12, 0), {{.12, .66}, {.24, 1.1}, {.78, 1.2}, {.78, .62}},
                  LINE(.78, .62, .78, 0)}},
    {'i', .32, 2, {LINE(.14, 1, .14, 0), LINE(.12, 1.42, .17, 1.38)}},
    {'l', .32, 1, {LINE(.14, 1.6, .14, 0)}},
    {'n', .95, 3, {LINE(.12, 1, .12, 0), {{.12, .66}, {.24, 1.1}, {.78, 1.2}, {.78, .62}},
                  LINE(.78, .62, .78, 0)}},
    {'o', .98, 2, {LEFT_BOWL, {{.47, 1}, {1.05, 1}, {1.05, 0}, {.47, 0}}}},
    {'p', .98, 4, {LINE(.1, 1, .1, -.58), RIGHT_BOWL, {{.1, .78}, {.17, .92}, {.28, 1}, {.43, 1}},
                   {{.1, .2}, {.17, .08}, {.28, 0}, {.43, 0}}}},
    {'r', .66, 2, {LINE(.12, 1, .12, 0), {{.12, .66}, {.2, .92}, {.38, 1.06}, {.6, .93}}}},
    {'s', .76, 3, {{{.64, .86}, {.46, 1.06}, {.08, 1.02}, {.09, .74}},
                  {{.09, .74}, {.1, .46}, {.66, .58}, {.66, .27}},
                   {{.66, .27}, {.66, -.08}, {.22, -.06}, {.04, .14}}}},
    {'t', .62, 3, {LINE(.26, 1.32, .26, .3), {{.26, .3}, {.26, -.04}, {.44, -.06}, {.58, .1}},
                  LINE(.02, .96, .54, .96)}},
    {'u', .95, 3, {LINE(.12, 1, .12, .38), {{.12, .38}, {.12, -.2}, {.66, -.1}, {.78, .34}},
                  LINE(.78, 1, .78, 0)}},
};
// clang-format on

static const double pen_turns = -35.0 / 360;
static const double pen_thickness = 0.16; // of the pen's width

static const letter *letter_of(char name)
{
    for (size_t i = 0; i < sizeof letters / sizeof *letters; i++)
        if (letters[i].name == name) return &letters[i];
    return NULL;
}

static double advance_of(char name)
{
    const letter *l = letter_of(name);
    return l ? l->advance : 0.55;
}

static void draw_edge(board *b, spot from, spot to, double width)
{
    draw_limb(b, BLACK, from, to, width * pen_thickness, width * pen_thickness);
}

// The pen is a short thick line; between two of its places it sweeps a parallelogram.
static void draw_pen(board *b, const spot p[4], double width)
{
    enum { PIECES = 24 };
    spot half = times(direction(pen_turns), width / 2), last = p[0];
    for (int32_t i = 1; i <= PIECES; i++) {
        spot next = bezier(p[0], p[1], p[2], p[3], (double)i / PIECES);
        draw_polygon(b, BLACK,
                     (spot[]){plus(last, half), plus(next, half), minus(next, half), minus(last, half)}, 4);
        draw_edge(b, plus(last, half), plus(next, half), width);
        draw_edge(b, minus(last, half), minus(next, half), width);
        last = next;
    }
    draw_edge(b, plus(p[0], half), minus(p[0], half), width);
    draw_edge(b, plus(p[3], half), minus(p[3], half), width);
}

static void draw_line_of_text(board *b, const char *text, double base, double size, double pen,
                              double spacing)
{
    double length = -spacing;
    for (const char *c = text; *c; c++) length += advance_of(*c) + spacing;
    double left = 500 - length * size / 2;
    for (const char *c = text; *c; c++) {
        const letter *l = letter_of(*c);
        for (int32_t i = 0; l && i < l->count; i++) {
            spot p[4];
            for (int32_t k = 0; k < 4; k++)
                p[k] = at(left + l->stroke[i][k].x * size, base - l->stroke[i][k].y * size);
            draw_pen(b, p, pen * size);
        }
        left += (advance_of(*c) + spacing) * size;
    }
}

static void draw_flourish(board *b, double x, double y, double f)
{
    for (int32_t side = 0; side < 2; side++) {
        double g = side ? -f : f;
        draw_pen(
            b,
            (spot[]){at(x, y), at(x + 60 * g, y - 44 * f), at(x + 130 * g, y + 40 * f), at(x + 200 * g, y)},
            11 * f);
        draw_pen(b,
                 (spot[]){at(x + 200 * g, y), at(x + 240 * g, y - 26 * f), at(x + 200 * g, y - 44 * f),
                          at(x + 178 * g, y - 16 * f)},
                 8 * f);
    }
    draw_disc(b, BLACK, at(x, y), 9 * f);
}

static void draw_frame_line(board *b, double inset, double width)
{
    draw_box(b, BLACK, inset, inset, 1000 - inset, 1000 - inset);
    draw_box(b, WHITE, inset + width, inset + width, 1000 - inset - width, 1000 - inset - width);
}

void draw_lettering(board *b)
{
    draw_box(b, WHITE, 0, 0, 1000, 1000);
    draw_frame_line(b, 44, 12);
    draw_frame_line(b, 64, 4);
    draw_line_of_text(b, "JALI", 430, 196, 0.19, 0.2);
    draw_flourish(b, 500, 508, 1);
    draw_line_of_text(b, "pierced screens", 626, 56, 0.19, 0.1);
    draw_line_of_text(b, "let the light through", 734, 43, 0.19, 0.1);
    draw_line_of_text(b, "stone paper tin or plastic", 820, 30, 0.19, 0.1);
    draw_line_of_text(b, "and all that is cut loose is held again", 884, 17, 0.19, 0.12);
}
