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
} pierced_options;

static inline bool in_hole(const pierced_options *o, double x, double y)
{
    if (o->holes == 0) return false;
    double pitch = o->size_mm / o->holes, dx = fmod(x, pitch) - pitch / 2, dy = fmod(y, pitch) - pitch / 2;
    return dx * dx + dy * dy < o->hole_mm * o->hole_mm;
}

static inline void place_node(const pierced_options *o, double x, double y, double node[3])
{
    double turn = o->radius_mm > 0 ? (x - o->size_mm / 2) / o->radius_mm : 0;
    node[0] = o->radius_mm > 0 ? o->radius_mm * sin(turn) : x;
    node[1] = y;
    node[2] = o->radius_mm > 0 ? o->radius_mm * cos(turn) : 0;
}

/// Squares whose middle lies in a hole are left out. The rim carries JALI_BORDER_RIM.
static inline jali_status pierced_sheet(jali_context *limited, const pierced_options *o, jali_sheet *sheet)
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
    for (int32_t c = 0; c < o->cells * o->cells; c++) {
        int32_t x = c % o->cells, y = c / o->cells, at[4];
        if (in_hole(o, (x + 0.5) * step, (y + 0.5) * step)) continue;
        for (int32_t k = 0; k < 4; k++) {
            int32_t i = x + (k == 1 || k == 2), j = y + (k >= 2), n = sheet->node_count;
            int32_t *slot = &number[j * side + i];
            if (*slot < 0) {
                place_node(o, i * step, j * step, sheet->node[n]);
                sheet->thickness_mm[n] = o->thickness_mm;
                if (i == 0 || j == 0 || i == o->cells || j == o->cells) sheet->border[n] = JALI_BORDER_RIM;
                *slot = sheet->node_count++;
            }
            at[k] = *slot;
        }
        bool turned = (x + y) % 2;
        int32_t *t = sheet->triangle[sheet->triangle_count];
        int32_t two[6] = {at[0], at[1], at[turned ? 3 : 2], at[turned ? 1 : 0], at[2], at[3]};
        memcpy(t, two, sizeof two);
        sheet->triangle_count += 2;
    }
done:
    arena_rewind(limited, mark);
    return status;
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
