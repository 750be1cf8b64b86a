// The reference board: a table of cells, a width each column, a kind and direction each row.
//
// From above: slots (horizontal, vertical, diagonal, between two bars), bars the same, then holes and pins;
// above each group its widths. Marks in the corners, the code along the lower edge.
//
// Source:  Binary Image Carving for 3D Printing, section 4.2 and Fig. 5 (bars of both tones in steps of 0.1
// mm). Differs: directions, pairs, holes and pins besides; steps of a tenth of the width expected; readable
// by scan. Checked: tests/test_board.c: nothing touches, every width as designed, and what is left in one
// piece when
//          the finest break.
#include "board/layout.h"
#include "board/glyphs.h"

#include <math.h>
#include <stdio.h>

static const double GRID_MM = 0.01;      // of the expected widths
enum { LEAST_PHI = 5, MOST_PHI = 150 };  // grid steps
static const double LEAST_CELL_MM = 4;   // for a bar long enough to be averaged along
static const double LEAST_MARK_MM = 4.5; // 26 px at 150 dpi
static const double LEAST_EDGE_MM = 1.5; // solid around marks and at the plate's edge
static const double SURE = 1.5;          // times the width expected, this prints even so
static const double WEB_SHARE = 0.2;     // of a cell, solid between neighbours' windows
static const double LETTER_SHARE = 0.75; // of a cell, height of a letter where the printer allows less
static const double STROKE_SHARE = 0.13; // of its height, width of its strokes likewise
static const double DEFAULT_THICKNESS_MM = 2;
static const double CELL_WIDTHS[CELL_STEPS] = {12, 11, 10}; // of a cell, in the larger of the widths expected

jali_board_options jali_board_defaults(void)
{
    return (jali_board_options){
        .phi_s_mm = 0.3, .phi_v_mm = 0.5, .most_mm = 200, .thickness_mm = DEFAULT_THICKNESS_MM};
}

const char *jali_board_kind_name(jali_board_kind kind)
{
    static const char *const name[JALI_BOARD_KINDS] = {"solid",     "void", "solid pair",
                                                       "void pair", "hole", "pin"};
    return name[kind];
}

void jali_board_free(jali_context *ctx, jali_board *board)
{
    release(ctx, board->feature);
    release(ctx, board->label);
    *board = (jali_board){0};
}

bool possible(const board_figures *f)
{
    return f->phi_s >= LEAST_PHI && f->phi_s <= MOST_PHI && f->phi_v >= LEAST_PHI && f->phi_v <= MOST_PHI &&
           f->columns >= FEWEST_COLUMNS && f->columns <= MOST_COLUMNS && f->cell_step >= 0 &&
           f->cell_step < CELL_STEPS;
}

// Widths of the columns in tenths of the width expected, on the grid of what a label can say; those of least
// use are left out when there are fewer columns.
static double fill_ladder(double phi_mm, int32_t columns, double *width_mm)
{
    static const struct {
        double tenths;
        int32_t columns; // from so many on
    } ladder[MOST_COLUMNS] = {
        {4, 15}, {5, 13}, {6, 9},  {7, 9},   {8, 9},   {9, 9},   {10, 9},  {11, 9},
        {12, 9}, {13, 9}, {14, 9}, {16, 12}, {19, 11}, {23, 14}, {28, 10},
    };
    double grid = phi_mm >= 0.75 ? 0.1 : phi_mm >= 0.1 ? 0.01 : 0.005, last = 0;
    for (int32_t i = 0, k = 0; i < MOST_COLUMNS; i++) {
        if (ladder[i].columns > columns) continue;
        last = MAX(round(ladder[i].tenths / 10 * phi_mm / grid), last + 1);
        width_mm[k++] = last * grid;
    }
    return grid;
}

static void fill_rounds(double phi_mm, const double *times, int32_t count, double grid, double *width_mm)
{
    double last = 0;
    for (int32_t i = 0; i < count; i++) {
        last = MAX(round(times[i] * phi_mm / grid), last + 1);
        width_mm[i] = last * grid;
    }
}

// A group of rows that share their widths.
typedef struct group {
    double width_mm[MOST_COLUMNS], grid;
    jali_board_kind kind[MOST_COLUMNS]; // of what is round; else that of the bars
} group;

enum { SLOT_GROUP, BAR_GROUP, ROUND_GROUP, GROUPS, BAR_ROWS = 4 };

static void choose_widths(const jali_board *b, group *g)
{
    // Holes reach down to where the error grows and up to where it is that of a slot.
    static const double hole[8] = {1.2, 1.5, 1.8, 2.2, 2.7, 3.5, 4.5, 6}, pin[7] = {2, 2.5, 3, 3.5, 4, 5, 6};
    int32_t holes = (b->columns + 1) / 2;
    g[SLOT_GROUP].grid = fill_ladder(b->phi_v_mm, b->columns, g[SLOT_GROUP].width_mm);
    g[BAR_GROUP].grid = fill_ladder(b->phi_s_mm, b->columns, g[BAR_GROUP].width_mm);
    g[ROUND_GROUP].grid = MIN(g[SLOT_GROUP].grid, g[BAR_GROUP].grid);
    fill_rounds(b->phi_v_mm, hole + 8 - holes, holes, g[SLOT_GROUP].grid, g[ROUND_GROUP].width_mm);
    fill_rounds(b->phi_s_mm, pin + 7 - (b->columns - holes), b->columns - holes, g[BAR_GROUP].grid,
                g[ROUND_GROUP].width_mm + holes);
    for (int32_t i = 0; i < b->columns; i++)
        g[ROUND_GROUP].kind[i] = i < holes ? JALI_BOARD_HOLE : JALI_BOARD_PIN;
}

static void write_width(double width_mm, double grid, char text[8])
{
    int32_t thousandths = (int32_t)lround(1000 * width_mm);
    int digits = snprintf(text, 8, "%d.%03d", thousandths / 1000 % 100, thousandths % 1000);
    text[digits - (grid >= 0.1 ? 2 : grid >= 0.01 ? 1 : 0)] = 0;
}

// Room for the widths above a group: the longest of its labels and solid above and below.
static double strip_of(const jali_board *b, const group *g)
{
    double longest = 0;
    for (int32_t i = 0; i < b->columns; i++) {
        char text[8];
        write_width(g->width_mm[i], g->grid, text);
        longest = MAX(longest, label_length(b, text));
    }
    return longest + 2 * b->gap_mm;
}

static void size_parts(jali_board *b, int32_t cell_step)
{
    double phi = MAX(b->phi_s_mm, b->phi_v_mm);
    b->gap_mm = SURE * b->phi_s_mm;
    b->stroke_mm = SURE * b->phi_v_mm;
    double letter = least_letter(b->stroke_mm, b->gap_mm);
    b->cell_mm = MAX(MAX(LEAST_CELL_MM, CELL_WIDTHS[cell_step] * phi), letter + b->gap_mm);
    b->glyph_mm[1] = MAX(letter, LETTER_SHARE * b->cell_mm);
    b->stroke_mm = MAX(b->stroke_mm, STROKE_SHARE * b->glyph_mm[1]);
    b->glyph_mm[0] = letter_width(b->stroke_mm, b->gap_mm, b->glyph_mm[1]);
    b->mark_diameter_mm = MAX(LEAST_MARK_MM, 9 * b->phi_v_mm);
}

static double edge_of(const jali_board *b)
{
    return MAX(LEAST_EDGE_MM, 2 * b->phi_s_mm);
}

static void size_plate(jali_board *b, const group *g)
{
    double band = b->mark_diameter_mm + 2 * edge_of(b);
    b->width_mm = b->columns * b->cell_mm + 2 * edge_of(b);
    b->height_mm = 2 * band + (2 * BAR_ROWS + 1) * b->cell_mm;
    for (int32_t i = 0; i < GROUPS; i++) b->height_mm += strip_of(b, &g[i]);
}

static void place_marks(jali_board *b)
{
    double inset = b->mark_diameter_mm / 2 + edge_of(b);
    double span[2] = {b->width_mm - 2 * inset, b->height_mm - 2 * inset}, share[2];
    for (int32_t i = 0; i < JALI_BOARD_MARKS; i++) {
        jali_board_mark_share(i, share);
        for (int k = 0; k < 2; k++) b->mark_mm[i][k] = inset + share[k] * span[k];
    }
    for (int32_t i = 0; i < JALI_BOARD_CODE_BITS; i++) {
        jali_board_code_share(i, share);
        for (int k = 0; k < 2; k++) b->code_mm[i][k] = inset + share[k] * span[k];
    }
    b->code_side_mm = 0.55 * (b->code_mm[1][0] - b->code_mm[0][0]);
}

// A bar, slot or pair in the cell around a centre.
static jali_board_feature bar_at(const jali_board *b, jali_board_kind kind, int32_t row, double width_mm,
                                 double x, double y)
{
    double side = b->cell_mm * (1 - WEB_SHARE);
    jali_board_feature f = {kind, (jali_board_direction)row, width_mm, {x, y}, side, 0, side / 2, 0};
    if (row == JALI_BOARD_DIAGONAL) { // its corners stay within the window; a bar's ends lie outside
        f.length_mm = M_SQRT2 * side - width_mm;
        f.reach_mm = kind == JALI_BOARD_SOLID ? side * M_SQRT1_2 / 2 : side * 0.6;
    } else if (row > JALI_BOARD_DIAGONAL) {
        f.kind = kind == JALI_BOARD_SOLID ? JALI_BOARD_SOLID_PAIR : JALI_BOARD_VOID_PAIR;
        f.direction = JALI_BOARD_VERTICAL;
        f.beside_mm = (side - width_mm) / 4;
        f.reach_mm = width_mm / 2 + f.beside_mm;
    }
    f.window_mm = f.length_mm * 0.6;
    if (f.direction == JALI_BOARD_DIAGONAL) f.window_mm = f.length_mm * 0.4;
    return f;
}

static jali_board_feature round_at(const jali_board *b, jali_board_kind kind, double width_mm, double x,
                                   double y)
{
    double side = b->cell_mm * (1 - WEB_SHARE);
    jali_board_feature f = {kind, JALI_BOARD_ROUND, width_mm, {x, y}, 0, 0, side / 2, 0};
    if (kind == JALI_BOARD_PIN) {
        f.length_mm = side / 2;
        f.beside_mm = SURE * b->phi_s_mm;
    }
    return f;
}

static void label_group(jali_board *b, const group *g, double top)
{
    for (int32_t i = 0; i < b->columns; i++) {
        jali_board_label *l = &b->label[b->label_count++];
        write_width(g->width_mm[i], g->grid, l->text);
        l->upwards = true; // the letters' tops point to the left
        l->at_mm[0] = edge_of(b) + (i + 0.5) * b->cell_mm + b->glyph_mm[1] / 2;
        l->at_mm[1] = top - strip_of(b, g) + b->gap_mm;
    }
}

static void fill_table(jali_board *b, const group *g)
{
    static const jali_board_kind kinds[] = {JALI_BOARD_VOID, JALI_BOARD_SOLID};
    double top = b->height_mm - b->mark_diameter_mm - 2 * edge_of(b), left = edge_of(b) + b->cell_mm / 2;
    for (int32_t n = 0; n < GROUPS; n++) {
        label_group(b, &g[n], top);
        top -= strip_of(b, &g[n]);
        for (int32_t row = 0; row < (n == ROUND_GROUP ? 1 : BAR_ROWS); row++, top -= b->cell_mm)
            for (int32_t i = 0; i < b->columns; i++) {
                double x = left + i * b->cell_mm, y = top - b->cell_mm / 2;
                b->feature[b->feature_count++] = n == ROUND_GROUP
                                                     ? round_at(b, g[n].kind[i], g[n].width_mm[i], x, y)
                                                     : bar_at(b, kinds[n], row, g[n].width_mm[i], x, y);
            }
    }
}

// The name, between the odd mark and the corner, where the edge is high enough.
static void sign(jali_board *b)
{
    static const char name[] = "JALI";
    double left = b->mark_mm[4][0] + b->mark_diameter_mm, length = label_length(b, name);
    double right = b->mark_mm[2][0] - b->mark_diameter_mm;
    if (b->glyph_mm[1] > b->mark_diameter_mm + edge_of(b) || length > right - left) return;
    jali_board_label *l = &b->label[b->label_count++];
    memcpy(l->text, name, sizeof name);
    l->upwards = false;
    l->at_mm[0] = (left + right - length) / 2;
    l->at_mm[1] = b->mark_mm[2][1] - b->glyph_mm[1] / 2;
}

static void size_board(const board_figures *f, jali_board *b, group g[GROUPS])
{
    *b = (jali_board){.phi_s_mm = f->phi_s * GRID_MM,
                      .phi_v_mm = f->phi_v * GRID_MM,
                      .columns = f->columns,
                      .cell_step = f->cell_step,
                      .thickness_mm = DEFAULT_THICKNESS_MM};
    choose_widths(b, g);
    size_parts(b, f->cell_step);
    size_plate(b, g);
}

jali_status lay_out(jali_context *ctx, const board_figures *f, jali_board *b)
{
    jali_status status;
    group g[GROUPS];
    size_board(f, b, g);
    TRY(ALLOCATE_CLEARED(ctx, b->feature, f->columns * (2 * BAR_ROWS + 1)));
    TRY(ALLOCATE_CLEARED(ctx, b->label, f->columns * GROUPS + 1));
    place_marks(b);
    write_code(f, b->code);
    fill_table(b, g);
    sign(b);
done:
    if (status != JALI_OK) jali_board_free(ctx, b);
    return status;
}

static jali_status check_options(jali_context *ctx, const jali_board_options *opt)
{
    const struct {
        const char *name;
        double value, least, most;
    } range[] = {
        {"phi_s", opt->phi_s_mm, LEAST_PHI * GRID_MM, 2 * MOST_PHI * GRID_MM},
        {"phi_v", opt->phi_v_mm, LEAST_PHI * GRID_MM, 2 * MOST_PHI * GRID_MM},
        {"longest side", opt->most_mm, 40, 200},
        {"thickness", opt->thickness_mm, 0.01, 100},
    };
    for (size_t i = 0; i < sizeof range / sizeof *range; i++)
        if (!(range[i].value >= range[i].least && range[i].value <= range[i].most))
            return fail(ctx, JALI_BAD_VALUE, "a board's %s of %g mm: %g to %g mm is accepted", range[i].name,
                        range[i].value, range[i].least, range[i].most);
    return JALI_OK;
}

// The roomiest board of these widths that fits: fewer columns before narrower cells would crowd them.
static bool fit(board_figures *f, double most_mm, jali_board *tried)
{
    group g[GROUPS];
    for (f->columns = MOST_COLUMNS; f->columns >= FEWEST_COLUMNS; f->columns--)
        for (f->cell_step = 0; f->cell_step < CELL_STEPS; f->cell_step++) {
            size_board(f, tried, g);
            if (MAX(tried->width_mm, tried->height_mm) <= most_mm) return true;
        }
    return false;
}

jali_status jali_board_layout(jali_context *ctx, const jali_board_options *given, jali_board *board)
{
    jali_status status;
    jali_board_options opt = given ? *given : jali_board_defaults();
    jali_board tried = {0};
    *board = (jali_board){0};
    TRY(check_options(ctx, &opt));
    const int32_t phi_s = (int32_t)lround(opt.phi_s_mm / GRID_MM),
                  phi_v = (int32_t)lround(opt.phi_v_mm / GRID_MM);
    board_figures f = {MIN(phi_s, MOST_PHI), MIN(phi_v, MOST_PHI), 0, 0};
    while (!fit(&f, opt.most_mm, &tried)) { // the coarser width is brought down: its steps reach far above it
        int32_t *coarser = f.phi_s > f.phi_v ? &f.phi_s : &f.phi_v;
        if (--*coarser < MAX(LEAST_PHI, (f.phi_s > f.phi_v ? phi_s : phi_v) / 2))
            TRY(fail(ctx, JALI_NO_RESULT,
                     "a board for phi_s %g and phi_v %g mm needs %.0f x %.0f mm; %g mm is the longest side "
                     "allowed",
                     opt.phi_s_mm, opt.phi_v_mm, ceil(tried.width_mm), ceil(tried.height_mm), opt.most_mm));
    }
    TRY(lay_out(ctx, &f, board));
    board->thickness_mm = opt.thickness_mm;
done:
    return status;
}
