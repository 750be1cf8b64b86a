// Sheets for tests and benches: a square plate with rows of round holes, flat or bent over a cylinder.
#ifndef TESTS_SHEETS_H
#define TESTS_SHEETS_H

#include "base/base.h"

#include <jali/sheet.h>
#include <math.h>

typedef struct pierced_options {
    int32_t cells; // squares a side, each two triangles
    int32_t holes; // a side; 0 = none
    double size_mm, thickness_mm;
    double hole_mm;   // radius
    double radius_mm; // of the cylinder; 0 = flat
    int32_t bridges;  // holes that a strip crosses; its triangles come last, bridge by bridge
    double strip_mm;  // its width
} pierced_options;

/// Which bridge a place lies in, 0 .. bridges-1; -1: in the plate; -2: in a hole.
static inline int32_t part_of(const pierced_options *o, double x, double y)
{
    if (o->holes == 0) return -1;
    double pitch = o->size_mm / o->holes, dx = fmod(x, pitch) - pitch / 2, dy = fmod(y, pitch) - pitch / 2;
    if (dx * dx + dy * dy >= o->hole_mm * o->hole_mm) return -1;
    int32_t hole = (int32_t)(y / pitch) * o->holes + (int32_t)(x / pitch);
    for (int32_t b = 0; b < o->bridges; b++)
        if (hole == b * o->holes * o->holes / o->bridges + o->holes / 2)
            return fabs(dy) < o->strip_mm / 2 ? b : -2;
    return -2;
}

static inline void place_node(const pierced_options *o, double x, double y, double node[3])
{
    double turn = o->radius_mm > 0 ? (x - o->size_mm / 2) / o->radius_mm : 0;
    node[0] = o->radius_mm > 0 ? o->radius_mm * sin(turn) : x;
    node[1] = y;
    node[2] = o->radius_mm > 0 ? o->radius_mm * cos(turn) : 0;
}

/// One square as two triangles; number holds the nodes that are there, -1: not yet.
static inline void lay_square(const pierced_options *o, int32_t square, int32_t *number, jali_sheet *sheet)
{
    int32_t x = square % o->cells, y = square / o->cells, at[4];
    double step = o->size_mm / o->cells;
    for (int32_t k = 0; k < 4; k++) {
        int32_t i = x + (k == 1 || k == 2), j = y + (k >= 2), n = sheet->node_count;
        int32_t *slot = &number[j * (o->cells + 1) + i];
        if (*slot < 0) {
            place_node(o, i * step, j * step, sheet->node[n]);
            sheet->thickness_mm[n] = o->thickness_mm;
            if (i == 0 || j == 0 || i == o->cells || j == o->cells) sheet->border[n] = JALI_BORDER_RIM;
            *slot = sheet->node_count++;
        }
        at[k] = *slot;
    }
    bool turned = (x + y) % 2;
    int32_t two[6] = {at[0], at[1], at[turned ? 3 : 2], at[turned ? 1 : 0], at[2], at[3]};
    memcpy(sheet->triangle[sheet->triangle_count], two, sizeof two);
    sheet->triangle_count += 2;
}

/// Squares whose middle lies in a hole are left out, but for the strips. The rim carries JALI_BORDER_RIM.
///   out    first   [bridges + 1] where each bridge's triangles begin; NULL: not asked for
static inline jali_status pierced_sheet_parts(jali_context *limited, const pierced_options *o,
                                              jali_sheet *sheet, int32_t *first)
{
    jali_status status;
    arena_mark mark = arena_here(limited);
    int32_t side = o->cells + 1, *number;
    double step = o->size_mm / o->cells;
    *sheet = (jali_sheet){.flat = o->radius_mm == 0};
    TRY(ARENA(limited, number, side * side));
    TRY(ALLOCATE(limited, sheet->node, side * side));
    TRY(ALLOCATE(limited, sheet->thickness_mm, side * side));
    TRY(ALLOCATE_CLEARED(limited, sheet->border, side * side));
    TRY(ALLOCATE(limited, sheet->triangle, 2 * o->cells * o->cells));
    for (int32_t i = 0; i < side * side; i++) number[i] = -1;
    for (int32_t i = 0; i < (o->bridges + 1) * o->cells * o->cells; i++) {
        int32_t part = i / (o->cells * o->cells) - 1, c = i % (o->cells * o->cells);
        if (first && part >= 0 && c == 0) first[part] = sheet->triangle_count;
        if (part_of(o, (c % o->cells + 0.5) * step, (c / o->cells + 0.5) * step) == part)
            lay_square(o, c, number, sheet);
    }
    if (first) first[o->bridges] = sheet->triangle_count;
done:
    arena_rewind(limited, mark);
    return status;
}

static inline jali_status pierced_sheet(jali_context *limited, const pierced_options *o, jali_sheet *sheet)
{
    return pierced_sheet_parts(limited, o, sheet, NULL);
}

/// What jali_sheet_free does, for sheets made here.
static inline void drop_sheet(jali_context *limited, jali_sheet *sheet)
{
    release(limited, sheet->node);
    release(limited, sheet->thickness_mm);
    release(limited, sheet->border);
    release(limited, sheet->triangle);
    *sheet = (jali_sheet){0};
}

#endif
