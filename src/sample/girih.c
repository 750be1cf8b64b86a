// A girih lattice after Hankin: from the middle of every edge of a tiling two rays go into each of its tiles,
// cross the neighbours' rays and bend where they meet. The tiling is 4.6.12: dodecagons at the knots of a
// triangular lattice, hexagons in its triangles, squares on its edges.
//
// Source:  E. H. Hankin, The drawing of geometric patterns in Saracenic art, 1925 (polygons in contact).
// Weave:   a strand lies over where it leaves an edge towards the next one (counter-clockwise), under where
// it
//          arrives; so it alternates along every strand, across tiles too. A crossing is drawn by cutting a
//          gap beside the strand that lies over.
#include "sample/samples.h"

static const double spacing = 472;                   // between the centres of two dodecagons
static const double edge = 472 / 4.7320508075688773; // spacing = edge (3 + sqrt 3)
static const double strap = 15, gap = 7.6;
static const double contact_turns = 60.0 / 360;
static const double border = 34;

typedef struct tile {
    spot centre;
    int32_t sides, skip; // the strand from edge i goes to edge i + skip
    double first_turns;  // direction of the middle of edge 0
} tile;

typedef void draw_strand(board *b, const tile *t, int32_t edge_index);

static double tangent(double turns)
{
    spot d = direction(turns);
    return d.y / d.x;
}

static double inradius(const tile *t)
{
    return edge / 2 / tangent(0.5 / t->sides);
}

static spot edge_middle(const tile *t, int32_t i)
{
    return polar(t->centre, inradius(t), t->first_turns + (double)i / t->sides);
}

static spot leaving(const tile *t, int32_t i)
{
    return direction(t->first_turns + (double)i / t->sides + 0.5 - (0.25 - contact_turns));
}

static spot arriving(const tile *t, int32_t i)
{
    return direction(t->first_turns + (double)i / t->sides + 0.5 + (0.25 - contact_turns));
}

// Where the strand that leaves edge i meets the mirror line `skip` half edges on.
static spot meeting(const tile *t, int32_t i, int32_t skip)
{
    double slope = tangent(0.5 * skip / t->sides);
    spot c = direction(contact_turns);
    return plus(edge_middle(t, i), times(leaving(t, i), inradius(t) * slope / (c.x + c.y * slope)));
}

static void draw_flat_strand(board *b, const tile *t, int32_t i)
{
    spot bend = meeting(t, i, t->skip);
    draw_bent_bar(b, WHITE, edge_middle(t, i), bend, edge_middle(t, i + t->skip), strap);
}

// The strand along `over` lies over the one along `under`: it gets a gap on both sides, as long as the other
// is wide, and is drawn again.
static void draw_crossing(board *b, spot place, spot over, spot under)
{
    double sine = over.x * under.y - over.y * under.x, cosine = over.x * under.x + over.y * under.y;
    if (sine < 0) sine = -sine;
    if (cosine < 0) cosine = -cosine;
    double reach = (strap / 2 + (strap / 2 + gap) * cosine) / sine + 0.5;
    spot half = times(over, reach), longer = times(over, reach + 1);
    draw_bar(b, BLACK, minus(place, half), plus(place, half), strap + 2 * gap);
    draw_bar(b, WHITE, minus(place, longer), plus(place, longer), strap);
}

static void draw_crossings(board *b, const tile *t, int32_t i)
{
    draw_crossing(b, edge_middle(t, i), leaving(t, i), arriving(t, i));
    if (t->skip == 2) draw_crossing(b, meeting(t, i, 1), arriving(t, i + 1), leaving(t, i));
}

static void draw_star(board *b, tone t, spot centre, int32_t points, double outer, double inner, double turns)
{
    begin_polygon(b, t);
    for (int32_t i = 0; i < 2 * points; i++)
        add_point(b, polar(centre, i % 2 ? inner : outer, turns + 0.5 * i / points));
    end_polygon(b);
}

// A loose rosette in the middle of every dodecagon.
static void draw_rosette(board *b, spot centre)
{
    draw_star(b, WHITE, centre, 12, 0.80 * edge, 0.60 * edge, 1.0 / 24);
    for (int32_t i = 0; i < 12; i++)
        draw_leaf(b, BLACK, polar(centre, 0.26 * edge, (i + 0.5) / 12),
                  polar(centre, 0.64 * edge, (i + 0.5) / 12), 0.17, 0);
    draw_star(b, BLACK, centre, 6, 0.2 * edge, 0.1 * edge, 1.0 / 12);
}

static void draw_tile(board *b, const tile *t, draw_strand *draw)
{
    double reach = 2 * edge;
    if (t->centre.x < -reach || t->centre.x > 1000 + reach || t->centre.y < -reach ||
        t->centre.y > 1000 + reach)
        return;
    for (int32_t i = 0; i < t->sides; i++) draw(b, t, i);
}

static void draw_tiles(board *b, draw_strand *draw)
{
    for (int32_t v = -3; v <= 3; v++)
        for (int32_t u = -4; u <= 4; u++) {
            spot knot = plus(at(500, 500),
                             plus(times(direction(0), spacing * u), times(direction(1.0 / 6), spacing * v)));
            draw_tile(b, &(tile){knot, 12, 2, 0}, draw);
            if (draw == draw_crossings) draw_rosette(b, knot);
            for (int32_t k = 0; k < 3; k++)
                draw_tile(b, &(tile){polar(knot, spacing / 2, k / 6.0), 4, 1, k / 6.0}, draw);
            for (int32_t k = 0; k < 2; k++)
                draw_tile(b,
                          &(tile){polar(knot, spacing / 1.7320508075688773, (2 * k + 1) / 12.0), 6, 2,
                                  (2 * k + 1) / 12.0},
                          draw);
        }
}

void draw_girih(board *b)
{
    draw_tiles(b, draw_flat_strand);
    draw_tiles(b, draw_crossings);
    for (int32_t side = 0; side < 2; side++) {
        double edge_at = side ? 1000 - border : 0;
        draw_box(b, WHITE, edge_at, 0, edge_at + border, 1000);
        draw_box(b, WHITE, 0, edge_at, 1000, edge_at + border);
    }
}
