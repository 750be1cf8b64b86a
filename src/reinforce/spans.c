// Where connectors could be laid: rays from the borders of the solid across the void.
//
// From border nodes about a connector's width apart five rays go out, square to the border and aslant; each
// ends at the solid it meets first, at the border node nearest to there. The mask says what is void; where it
// and the sheet's outline differ (by less than half a pixel), the ray begins a pixel out. Checked:
// tests/test_reinforce.c: combs, rings, parts a known way apart.
#include "reinforce/spans.h"
#include "mesh/sides.h"
#include "base/vector.h"

#include <math.h>

static const double SLANT[] = {0, 0.6, -0.6, 1.05, -1.05}; // rad from the square direction

enum { RAYS = sizeof SLANT / sizeof *SLANT, CELL_PX = 4, FANS = 64 };

void borders_free(jali_context *ctx, borders *b)
{
    release(ctx, b->next);
    release(ctx, b->last);
    release(ctx, b->first);
    release(ctx, b->node);
    *b = (borders){0};
}

static jali_status link_borders(jali_context *ctx, const jali_sheet *sheet, borders *b)
{
    jali_status status;
    sides linked = {0};
    TRY(sides_create(ctx, sheet->node_count, sheet->triangle_count, (const int32_t(*)[3])sheet->triangle,
                     &linked));
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            if (linked.beside[4 * t + i] != NO_SIDE) continue;
            int32_t from = sheet->triangle[t][(i + 1) % 3], to = sheet->triangle[t][(i + 2) % 3];
            b->next[from] = to;
            b->last[to] = from;
        }
done:
    sides_free(ctx, &linked);
    return status;
}

static int32_t cell_of(const borders *b, const double at[2])
{
    int32_t x = (int32_t)floor(at[0] / b->cell_units), y = (int32_t)floor(at[1] / b->cell_units);
    return MAX(0, MIN(y, b->rows - 1)) * b->columns + MAX(0, MIN(x, b->columns - 1));
}

typedef struct place {
    double at[2];
} place;

static place place_of(const jali_sheet *sheet, int32_t i)
{
    return (place){{sheet->at[i][0], sheet->at[i][1]}};
}

static bool on_border(const jali_sheet *sheet, const borders *b, int32_t i)
{
    return (sheet->border[i] & JALI_BORDER_VOID) && b->next[i] >= 0 && b->last[i] >= 0 &&
           sheet->at[i][0] != INT32_MIN;
}

jali_status borders_create(jali_context *ctx, const jali_sheet *sheet, const jali_chart *chart, borders *b)
{
    jali_status status;
    *b = (borders){.cell_units = CELL_PX * chart->pixel_units};
    b->columns = (chart->width_px + CELL_PX - 1) / CELL_PX;
    b->rows = (chart->height_px + CELL_PX - 1) / CELL_PX;
    int64_t cells = (int64_t)b->columns * b->rows;
    TRY(ALLOCATE(ctx, b->next, sheet->node_count));
    TRY(ALLOCATE(ctx, b->last, sheet->node_count));
    TRY(ALLOCATE(ctx, b->node, sheet->node_count));
    TRY(ALLOCATE_CLEARED(ctx, b->first, cells + 1));
    memset(b->next, -1, (size_t)sheet->node_count * sizeof *b->next);
    memset(b->last, -1, (size_t)sheet->node_count * sizeof *b->last);
    TRY(link_borders(ctx, sheet, b));
    for (int32_t i = 0; i < sheet->node_count; i++)
        if (on_border(sheet, b, i)) b->first[cell_of(b, place_of(sheet, i).at) + 1]++;
    for (int64_t c = 0; c < cells; c++) b->first[c + 1] += b->first[c];
    for (int32_t i = 0; i < sheet->node_count; i++)
        if (on_border(sheet, b, i)) b->node[b->first[cell_of(b, place_of(sheet, i).at)]++] = i;
    for (int64_t c = cells; c > 0; c--) b->first[c] = b->first[c - 1]; // each had moved to the next one's
    b->first[0] = 0;
done:
    if (status != JALI_OK) borders_free(ctx, b);
    return status;
}

int32_t border_near(const borders *b, const jali_sheet *sheet, const double at[2], double reach)
{
    int32_t best = -1, ring = (int32_t)ceil(reach / b->cell_units);
    double least = reach * reach;
    int32_t here = cell_of(b, at), x = here % b->columns, y = here / b->columns;
    for (int32_t v = MAX(y - ring, 0); v <= MIN(y + ring, b->rows - 1); v++)
        for (int32_t u = MAX(x - ring, 0); u <= MIN(x + ring, b->columns - 1); u++) {
            int32_t cell = v * b->columns + u;
            for (int32_t k = b->first[cell]; k < b->first[cell + 1]; k++) {
                double dx = sheet->at[b->node[k]][0] - at[0], dy = sheet->at[b->node[k]][1] - at[1];
                if (dx * dx + dy * dy > least) continue;
                least = dx * dx + dy * dy;
                best = b->node[k];
            }
        }
    return best;
}

// White at a place of the chart; beyond the grid nothing can be reached.
typedef enum ground { VOID_GROUND, SOLID_GROUND, NO_GROUND } ground;

static ground ground_at(const jali_bitmap *mask, const jali_bitmap *blocked, const jali_chart *chart,
                        const double at[2])
{
    int32_t x = (int32_t)floor(at[0] / chart->pixel_units),
            y = chart->height_px - 1 - (int32_t)floor(at[1] / chart->pixel_units);
    if (x < 0 || y < 0 || x >= mask->width_px || y >= mask->height_px) return NO_GROUND;
    if (jali_bitmap_get(mask, x, y)) return SOLID_GROUND;
    return blocked && jali_bitmap_get(blocked, x, y) ? NO_GROUND : VOID_GROUND;
}

// Where a ray from a border node meets solid again: its border node there, or -1.
static int32_t cast(const jali_sheet *sheet, const borders *b, const jali_bitmap *mask,
                    const jali_bitmap *blocked, const jali_chart *chart, int32_t from, const double along[2],
                    double longest_px)
{
    double at[2], px = chart->pixel_units;
    for (double s = 1; s <= longest_px; s += 0.5) {
        for (int k = 0; k < 2; k++) at[k] = sheet->at[from][k] + s * px * along[k];
        ground g = ground_at(mask, blocked, chart, at);
        if (g == NO_GROUND || (g == SOLID_GROUND && s < 2)) return -1;
        if (g == SOLID_GROUND) return border_near(b, sheet, at, 3 * px);
    }
    return -1;
}

// The unit direction out of the solid at a border node, on the chart.
static bool outward(const jali_sheet *sheet, const borders *b, int32_t i, double out[2])
{
    double dx = sheet->at[b->next[i]][0] - sheet->at[b->last[i]][0],
           dy = sheet->at[b->next[i]][1] - sheet->at[b->last[i]][1], size = sqrt(dx * dx + dy * dy);
    if (size == 0) return false;
    out[0] = dy / size;
    out[1] = -dx / size;
    return true;
}

// What the fans of rays share.
typedef struct fanning {
    const jali_sheet *sheet;
    const borders *borders;
    const jali_bitmap *mask, *blocked;
    const jali_chart *chart;
    double longest_mm;
    int32_t count;
    int32_t *from;     // [count] border nodes
    span (*way)[RAYS]; // [count] one a ray; without width, and without length where there is none
} fanning;

static void cast_fan(const fanning *f, int32_t from, span way[RAYS])
{
    double out[2];
    double longest_px = 4 * f->longest_mm / jali_chart_pixel_mm(f->chart); // stretched at most four times
    memset(way, 0, RAYS * sizeof *way);
    if (!outward(f->sheet, f->borders, from, out)) return;
    for (int i = 0; i < RAYS; i++) {
        double c = cos(SLANT[i]), s = sin(SLANT[i]);
        int32_t to = cast(f->sheet, f->borders, f->mask, f->blocked, f->chart, from,
                          (double[]){c * out[0] - s * out[1], s * out[0] + c * out[1]}, longest_px);
        if (to < 0 || to == from || to == f->borders->next[from] || to == f->borders->last[from]) continue;
        double length = distance(f->sheet->node[from], f->sheet->node[to]);
        if (length <= f->longest_mm) way[i] = (span){{from, to}, length, 0, 0};
    }
}

static void cast_fans(void *shared, int32_t block)
{
    const fanning *f = shared;
    for (int32_t i = block * FANS; i < MIN((block + 1) * FANS, f->count); i++)
        cast_fan(f, f->from[i], f->way[i]);
}

// Border nodes some way apart, along each loop.
static void space_out(fanning *f, double apart_mm, uint8_t *done_with)
{
    const jali_sheet *sheet = f->sheet;
    for (int32_t begin = 0; begin < sheet->node_count; begin++) {
        if (done_with[begin] || !on_border(sheet, f->borders, begin)) continue;
        double since = apart_mm;
        int32_t i = begin;
        do {
            done_with[i] = 1;
            if (since >= apart_mm) {
                f->from[f->count++] = i;
                since = 0;
            }
            int32_t next = f->borders->next[i];
            if (!on_border(sheet, f->borders, next)) break;
            since += distance(sheet->node[i], sheet->node[next]);
            i = next;
        } while (!done_with[i]);
    }
}

jali_status find_spans(jali_context *ctx, const jali_sheet *sheet, const borders *b, const jali_bitmap *mask,
                       const jali_bitmap *blocked, const jali_chart *chart, double apart_mm,
                       double longest_mm, spans *found)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    uint8_t *done_with;
    fanning f = {sheet, b, mask, blocked, chart, longest_mm, 0, NULL, NULL};
    *found = (spans){0};
    TRY(ARENA(ctx, done_with, sheet->node_count));
    TRY(ARENA(ctx, f.from, sheet->node_count));
    memset(done_with, 0, (size_t)sheet->node_count);
    space_out(&f, apart_mm, done_with);
    TRY(ARENA(ctx, f.way, f.count));
    TRY(ALLOCATE(ctx, found->span, (size_t)f.count * RAYS));
    parallel(ctx, (f.count + FANS - 1) / FANS, cast_fans, &f);
    for (int32_t i = 0; i < f.count; i++)
        for (int k = 0; k < RAYS; k++)
            if (f.way[i][k].length_mm > 0) found->span[found->count++] = f.way[i][k];
    TRY(step(ctx, "reinforce", 0));
done:
    arena_rewind(ctx, mark);
    if (status != JALI_OK) {
        release(ctx, found->span);
        *found = (spans){0};
    }
    return status;
}
