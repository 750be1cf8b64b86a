// CalculiX (ccx) as a peer: the same sheet as its shells, or thickened to solids.
#ifndef BENCH_CALCULIX_H
#define BENCH_CALCULIX_H

#include <jali/sheet.h>

typedef enum calculix_kind {
    CALCULIX_S3,    // shells of three nodes
    CALCULIX_S6,    // shells of six: inside, one layer of quadratic wedges
    CALCULIX_WEDGES // C3D15: each triangle extruded, quadratic in all directions
} calculix_kind;

typedef struct calculix_case {
    const jali_sheet *sheet; // flat, of one thickness
    calculix_kind kind;
    int32_t layers; // of wedges through the thickness, >= 1
    double e_mpa, nu;
    double pressure_mpa; // along -z; on wedges, at the top
    uint8_t held;        // nodes whose border has one of these bits are clamped, wedges on their whole face
} calculix_case;

/// What it says; {0} is valid and empty. Values at the sheet's nodes.
typedef struct calculix_answer {
    double seconds;         // CPU time, files included
    double displacement_mm; // the largest along z, NAN: it did not run
    int32_t nodes;          // of solids, those into which it turns shells as well
    double *moved_mm;       // [node_count] along z in the middle; S3 has no middle: 0
    float (*von_mises)[2];  // [node_count] at the outer face; the largest of all levels (MPa)
} calculix_answer;

void calculix_free(calculix_answer *answer);

bool calculix_there(void);

calculix_answer calculix_run(const calculix_case *c);

/// Places sorted by x, to find those near a point. free() the order.
typedef struct near_index {
    int32_t count, *order;
    const double (*at)[3];
} near_index;

near_index near_index_of(int32_t count, const double (*at)[3]);
/// The place nearest to (x, y) within a radius, -1: none.
int32_t nearest_within(const near_index *near, double x, double y, double radius);

#endif
