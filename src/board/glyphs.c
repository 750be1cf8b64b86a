// Digits and a few letters of straight strokes on a grid of 3 x 3 nodes, cut through. Where a stroke would
// close a counter it ends gap_mm before what it would meet. The dotted letters of map have closed counters
// and the pen's letters of sample no digits: neither serves as a stencil.
#include "board/glyphs.h"

#include <math.h>

enum { MOST_NODES = 6 };

// How a stroke ends at its last node.
typedef enum ending {
    CAP,  // half a stroke beyond it
    STEM, // gap_mm before the side of another stroke there
    HALF  // half of gap_mm before it: another stroke comes from the other side
} ending;

typedef struct stroke {
    ending from, to;
    const char *nodes; // two letters a node: l m r from the left, then t c b from the top
} stroke;

static const struct {
    char letter;
    stroke stroke[STROKES];
} letters[] = {
    {'0', {{HALF, HALF, "mtltlbmb"}, {HALF, HALF, "mbrbrtmt"}}},
    {'1', {{CAP, CAP, "mtmb"}}},
    {'2', {{CAP, CAP, "ltrtrclclbrb"}}},
    {'3', {{CAP, CAP, "ltrtrblb"}, {CAP, STEM, "lcrc"}}},
    {'4', {{CAP, STEM, "ltlcrc"}, {CAP, CAP, "rtrb"}}},
    {'5', {{CAP, CAP, "rtltlcrcrblb"}}},
    {'6', {{CAP, STEM, "rtltlbrbrclc"}}},
    {'7', {{CAP, CAP, "ltrtrb"}}},
    {'8', {{STEM, STEM, "ltrtrclclbrb"}, {CAP, STEM, "ltlc"}, {STEM, CAP, "rcrb"}}},
    {'9', {{CAP, STEM, "lbrbrtltlcrc"}}},
    {'J', {{CAP, CAP, "rtrblb"}}},
    {'A', {{CAP, CAP, "lbltrtrb"}, {STEM, STEM, "lcrc"}}},
    {'L', {{CAP, CAP, "ltlbrb"}}},
    {'I', {{CAP, CAP, "mtmb"}}},
};

static const double LETTER_WIDTH = 0.58; // of its height
static const double SPACING = 1.5;       // between letters, in gaps

double least_letter(double stroke_mm, double gap_mm)
{
    return 4.2 * stroke_mm + 2 * gap_mm; // three strokes, and counters wider than the gap
}

double letter_width(double stroke_mm, double gap_mm, double height_mm)
{
    return MAX(LETTER_WIDTH * height_mm,
               2.4 * stroke_mm + 2 * gap_mm); // the bar of an A has a gap on both sides
}

double letter_advance(const jali_board *board, char letter)
{
    bool narrow = letter == '.' || letter == '1' || letter == 'I';
    return (narrow ? board->stroke_mm : board->glyph_mm[0]) + SPACING * board->gap_mm;
}

double label_length(const jali_board *board, const char *text)
{
    double length = -SPACING * board->gap_mm;
    for (; *text; text++) length += letter_advance(board, *text);
    return length;
}

static void place_node(const jali_board *b, const char *node, bool narrow, double at[2])
{
    double half = b->stroke_mm / 2;
    double span[2] = {b->glyph_mm[0] - b->stroke_mm, b->glyph_mm[1] - b->stroke_mm};
    double x = node[0] == 'l'   ? 0
               : node[0] == 'm' ? 0.5
                                : 1,
           y = node[1] == 'b'   ? 0
               : node[1] == 'c' ? 0.5
                                : 1;
    at[0] = half + (narrow ? 0 : x * span[0]);
    at[1] = half + y * span[1];
}

// Move an end along its stroke, away from the node `inner` when `by` is positive.
static void draw_out(double end[2], const double inner[2], double by)
{
    double along[2] = {end[0] - inner[0], end[1] - inner[1]}, length = hypot(along[0], along[1]);
    for (int k = 0; k < 2; k++) end[k] += along[k] / length * by;
}

static double beyond(const jali_board *b, ending e)
{
    return e == CAP ? b->stroke_mm / 2 : e == STEM ? -b->stroke_mm / 2 - b->gap_mm : -b->gap_mm / 2;
}

// Both sides of a line of upright and level pieces, the right one first: corners are square.
static void outline_stroke(const double (*node)[2], int32_t count, double width, stroke_outline *o)
{
    o->count = 2 * count;
    for (int32_t i = 0; i < count; i++) {
        double offset[2] = {0, 0}; // to the right of the direction, of both pieces at a corner
        for (int32_t piece = MAX(i - 1, 0); piece <= MIN(i, count - 2); piece++) {
            double dx = node[piece + 1][0] - node[piece][0], dy = node[piece + 1][1] - node[piece][1];
            if (dx != 0) offset[1] = dx > 0 ? -width / 2 : width / 2;
            if (dy != 0) offset[0] = dy > 0 ? width / 2 : -width / 2;
        }
        for (int k = 0; k < 2; k++) {
            o->corner[i][k] = node[i][k] + offset[k];
            o->corner[2 * count - 1 - i][k] = node[i][k] - offset[k];
        }
    }
}

static void draw_stroke(const jali_board *b, const stroke *s, bool narrow, stroke_outline *o)
{
    double node[MOST_NODES][2];
    int32_t count = (int32_t)strlen(s->nodes) / 2;
    for (int32_t i = 0; i < count; i++) place_node(b, s->nodes + 2 * i, narrow, node[i]);
    draw_out(node[0], node[1], beyond(b, s->from));
    draw_out(node[count - 1], node[count - 2], beyond(b, s->to));
    outline_stroke((const double(*)[2])node, count, b->stroke_mm, o);
}

int32_t draw_letter(const jali_board *b, char letter, stroke_outline outline[STROKES])
{
    bool narrow = letter == '1' || letter == 'I';
    if (letter == '.') {
        const double q = b->stroke_mm, point[4][2] = {{0, 0}, {q, 0}, {q, q}, {0, q}};
        outline[0].count = 4;
        memcpy(outline[0].corner, point, sizeof point);
        return 1;
    }
    for (size_t i = 0; i < sizeof letters / sizeof *letters; i++) {
        if (letters[i].letter != letter) continue;
        int32_t count = 0;
        while (count < STROKES && letters[i].stroke[count].nodes) {
            draw_stroke(b, &letters[i].stroke[count], narrow, &outline[count]);
            count++;
        }
        return count;
    }
    return 0;
}
