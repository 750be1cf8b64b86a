// A tree that branches in the wind, in a round window: limbs that taper, leaves at the twigs, some of them
// loose.
#include "sample/samples.h"

typedef struct branch {
    spot from;
    double turns, length, width;
    int32_t order; // 0 = the trunk
} branch;

enum { LAST_ORDER = 7, MOST_WAITING = 64 };

static void draw_twig_leaves(board *b, const branch *twig, spot tip)
{
    for (int32_t i = 0; i < 2; i++) {
        double turns = twig->turns + 0.16 * (i - 0.5) + 0.05 * (next_share(b) - 0.5);
        double length = 15 + 8 * next_share(b);
        draw_leaf(b, WHITE, tip, polar(tip, length, turns), 0.26, 0.1 * (next_share(b) - 0.5));
    }
}

// Two or three shoots: they lean away from their branch, shorter and thinner, and the wind bends them right.
static int32_t grow(board *b, const branch *parent, spot tip, branch *shoot)
{
    int32_t count = parent->order == 0 || next_share(b) < 0.35 ? 3 : 2;
    for (int32_t i = 0; i < count; i++) {
        double lean = count == 3 ? 0.088 * (i - 1) : 0.104 * (i - 0.5);
        double turns = parent->turns + lean + 0.05 * (next_share(b) - 0.5) + 0.002;
        double vigour = 0.69 + 0.15 * next_share(b);
        shoot[i] = (branch){tip, turns, parent->length * vigour, parent->width * (count == 3 ? 0.60 : 0.68),
                            parent->order + 1};
    }
    return count;
}

static void draw_branches(board *b, branch trunk)
{
    branch waiting[MOST_WAITING] = {trunk};
    for (int32_t count = 1; count > 0;) {
        branch now = waiting[--count];
        double bend = 0.05 * (next_share(b) - 0.5);
        spot tip = polar(now.from, now.length, now.turns);
        spot path[4] = {now.from, polar(now.from, now.length * 0.35, now.turns - bend),
                        polar(now.from, now.length * 0.7, now.turns + bend), tip};
        draw_curve(b, WHITE, path, now.width, now.width * 0.7);
        if (now.order >= LAST_ORDER - 1) draw_twig_leaves(b, &now, tip);
        if (now.order < LAST_ORDER) count += grow(b, &now, tip, waiting + count);
    }
}

static void draw_ground(board *b)
{
    spot left = at(0, 846), right = at(1000, 850);
    begin_polygon(b, WHITE);
    add_point(b, left);
    add_bezier(b, left, at(260, 846), at(400, 790), at(540, 806));
    add_bezier(b, at(540, 806), at(700, 824), at(820, 868), right);
    add_point(b, at(1000, 1000));
    add_point(b, at(0, 1000));
    end_polygon(b);
}

static void draw_roots(board *b, spot foot)
{
    for (int32_t i = 0; i < 5; i++) {
        double side = i - 2;
        spot p[4] = {plus(foot, at(side * 5, -62)), plus(foot, at(side * 7, -20)),
                     plus(foot, at(side * 15, -8)), plus(foot, at(side * 36, 12))};
        draw_curve(b, WHITE, p, 26, 6);
    }
}

static void draw_grass(board *b)
{
    for (int32_t i = 0; i < 70; i++) {
        double x = 90 + 820 * (i + next_share(b)) / 70, share = (x - 500) / 500;
        spot root = at(x, 824 + 40 * share * share),
             tip = plus(root, at(14 * (next_share(b) - 0.3), -16 - 26 * next_share(b)));
        draw_leaf(b, WHITE, root, tip, 0.1, 0.12);
    }
}

static void draw_loose_leaves(board *b)
{
    for (int32_t i = 0; i < 15; i++) {
        spot place = at(300 + 560 * next_share(b), 570 + 200 * next_share(b));
        if (place.x > 430 && place.x < 570) continue;
        draw_leaf(b, WHITE, place, polar(place, 20 + 8 * next_share(b), next_share(b)), 0.28, 0.1);
    }
}

static void draw_moon(board *b)
{
    draw_disc(b, WHITE, at(226, 618), 52);
    draw_disc(b, BLACK, at(249, 606), 45);
}

void draw_tree(board *b)
{
    spot foot = at(510, 812);
    draw_box(b, WHITE, 0, 0, 1000, 1000);
    draw_disc(b, BLACK, at(500, 500), 474);
    draw_ring(b, at(500, 500), 458, 8);
    b->seed = 11;
    draw_moon(b);
    draw_ground(b);
    draw_grass(b);
    draw_roots(b, foot);
    draw_branches(b, (branch){plus(foot, at(0, -10)), -0.249, 170, 46, 0});
    draw_loose_leaves(b);
}
