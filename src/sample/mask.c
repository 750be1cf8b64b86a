// A lion's head as one cuts it from folded paper: everything is drawn twice, once in the mirror. The lobes of
// the mane hang on nothing.
#include "sample/samples.h"

static const spot heart = {500, 500};

static void draw_both_leaves(board *b, tone t, spot from, spot to, double bulge, double bend)
{
    draw_leaf(b, t, from, to, bulge, bend);
    draw_leaf(b, t, mirrored(from), mirrored(to), bulge, -bend);
}

static void draw_both_curves(board *b, tone t, const spot p[4], double width_from, double width_to)
{
    spot m[4] = {mirrored(p[0]), mirrored(p[1]), mirrored(p[2]), mirrored(p[3])};
    draw_curve(b, t, p, width_from, width_to);
    draw_curve(b, t, m, width_from, width_to);
}

static void draw_both_discs(board *b, tone t, spot centre, double radius)
{
    draw_disc(b, t, centre, radius);
    draw_disc(b, t, mirrored(centre), radius);
}

// A closed outline that is given by its right half, from top to bottom, as curves end to end.
static void draw_symmetric(board *b, tone t, const spot *p, int32_t curves)
{
    begin_polygon(b, t);
    add_point(b, p[0]);
    for (int32_t i = 0; i < curves; i++) add_bezier(b, p[3 * i], p[3 * i + 1], p[3 * i + 2], p[3 * i + 3]);
    for (int32_t i = curves - 1; i >= 0; i--)
        add_bezier(b, mirrored(p[3 * i + 3]), mirrored(p[3 * i + 2]), mirrored(p[3 * i + 1]),
                   mirrored(p[3 * i]));
    end_polygon(b);
}

static void draw_lobe(board *b, spot from, spot to, double bulge, double bend)
{
    spot out = times(minus(to, from), 0.06);
    draw_both_leaves(b, BLACK, minus(from, out), plus(to, out), bulge * 1.2, bend);
    draw_both_leaves(b, WHITE, from, to, bulge, bend);
    draw_both_leaves(b, BLACK, between(from, to, 0.16), between(from, to, 0.74), bulge * 0.17, bend);
}

// A ring of lobes, swept downwards like hair; longer towards the chin. The last lies uppermost.
static void draw_mane_ring(board *b, int32_t lobes, double inner, double outer, double bulge, double phase)
{
    for (int32_t i = 0; i < lobes; i++) {
        double share = (i + phase) / lobes; // 0 at the top, 1 at the chin
        double turns = -0.25 + 0.5 * share, stretch = 1 + 0.02 * share * share;
        draw_lobe(b, polar(heart, inner * stretch, turns), polar(heart, outer * stretch, turns + 0.012),
                  bulge, 0.1);
    }
}

static void draw_ears(board *b)
{
    draw_both_discs(b, BLACK, at(676, 300), 80);
    draw_both_discs(b, WHITE, at(676, 300), 68);
    draw_both_discs(b, BLACK, at(676, 304), 42);
    for (int32_t i = 0; i < 3; i++)
        draw_both_leaves(b, WHITE, at(644, 344), polar(at(644, 344), 62, -0.17 + 0.055 * i), 0.13, 0.04);
}

static void draw_face(board *b)
{
    static const spot gap[] = {{500, 282}, {610, 278}, {716, 340}, {722, 470}, {726, 590},
                               {660, 640}, {626, 720}, {600, 790}, {550, 806}, {500, 806}};
    static const spot face[] = {{500, 298}, {600, 294}, {700, 352}, {705, 470}, {708, 580},
                                {646, 630}, {610, 712}, {586, 772}, {548, 788}, {500, 788}};
    draw_symmetric(b, BLACK, gap, 3);
    draw_symmetric(b, WHITE, face, 3);
}

static void draw_brow(board *b)
{
    draw_leaf(b, BLACK, at(500, 424), at(500, 312), 0.11, 0);
    draw_both_leaves(b, BLACK, at(524, 420), at(574, 322), 0.1, -0.1);
    draw_both_leaves(b, BLACK, at(556, 418), at(640, 352), 0.1, -0.12);
    draw_both_curves(b, BLACK, (spot[]){at(524, 470), at(560, 428), at(620, 424), at(672, 462)}, 17, 3);
}

static void draw_eyes(board *b)
{
    draw_both_leaves(b, BLACK, at(536, 516), at(652, 474), 0.21, -0.02);
    draw_both_discs(b, WHITE, at(592, 494), 18);
    draw_both_discs(b, BLACK, at(592, 494), 9);
    draw_both_curves(b, BLACK, (spot[]){at(556, 538), at(590, 544), at(630, 528), at(662, 500)}, 3, 7);
}

static void draw_nose(board *b)
{
    static const spot nose[] = {{500, 604}, {530, 600}, {556, 602}, {562, 618},
                                {560, 640}, {520, 662}, {500, 668}};
    draw_both_curves(b, BLACK, (spot[]){at(529, 508), at(536, 540), at(544, 566), at(566, 592)}, 9, 4);
    draw_symmetric(b, BLACK, nose, 2);
    draw_both_leaves(b, WHITE, at(514, 640), at(546, 622), 0.2, 0.05);
    draw_limb(b, BLACK, at(500, 660), at(500, 694), 8, 8);
    draw_both_curves(b, BLACK, (spot[]){at(500, 692), at(516, 724), at(566, 726), at(594, 690)}, 9, 4);
    draw_leaf(b, BLACK, at(462, 738), at(538, 738), 0.13, -0.12);
}

static void draw_whiskers(board *b)
{
    for (int32_t row = 0; row < 3; row++) {
        for (int32_t i = 0; i < 3; i++)
            draw_both_discs(b, BLACK, at(542 + 17 * i + 4 * row, 668 + 13 * row - 5 * i), 4.2);
        spot from = at(600, 650 + 19 * row), to = at(826 - 14 * row, 596 + 66 * row);
        spot p[4] = {from, plus(from, at(70, -18 + 4 * row)), plus(to, at(-90, -18 + 2 * row)), to};
        draw_both_curves(b, BLACK, p, 25, 21);
        draw_both_curves(b, WHITE, p, 9, 6);
    }
}

static void draw_beard(board *b)
{
    for (int32_t i = 2; i >= 0; i--)
        draw_lobe(b, at(520 + 30 * i, 790 - 14 * i), at(514 + 46 * i, 938 - 22 * i), 0.16, 0.06);
}

void draw_mask(board *b)
{
    draw_box(b, WHITE, 0, 0, 1000, 1000);
    draw_box(b, BLACK, 24, 24, 976, 976);
    draw_mane_ring(b, 14, 300, 446, 0.25, 0.36);
    draw_mane_ring(b, 14, 240, 376, 0.26, 0.86);
    draw_mane_ring(b, 14, 190, 306, 0.27, 0.36);
    draw_beard(b);
    draw_ears(b);
    draw_face(b);
    draw_brow(b);
    draw_eyes(b);
    draw_nose(b);
    draw_whiskers(b);
}
