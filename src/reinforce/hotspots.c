// Hot spots and their gradients.
//
// The stress resultants of a facet are linear in its 18 unknowns, so 18 unit displacements give the matrix;
// von Mises of a face is differentiated by hand. The worse face is the one that is worse now. Checked:
// tests/test_reinforce.c: against differences.
#include "reinforce/hotspots.h"
#include "structure/element.h"
#include "base/vector.h"

#include <math.h>

int32_t find_hotspots(const jali_sheet *sheet, const float *mean_mpa, double apart_mm,
                      int32_t node[MOST_HOTSPOTS])
{
    const double least_share = 0.7;
    int32_t count = 0;
    float highest = 0;
    while (count < MOST_HOTSPOTS) {
        int32_t best = -1;
        for (int32_t i = 0; i < sheet->node_count; i++) {
            if (best >= 0 && mean_mpa[i] <= mean_mpa[best]) continue;
            bool far = true;
            for (int32_t k = 0; k < count && far; k++)
                far = distance(sheet->node[i], sheet->node[node[k]]) > apart_mm;
            if (far) best = i;
        }
        if (count == 0 && best >= 0) highest = mean_mpa[best];
        if (best < 0 || mean_mpa[best] <= 0 || mean_mpa[best] < least_share * highest) break;
        node[count++] = best;
    }
    return count;
}

// Stress in a face of the wall, xx, yy, xy; side +1 = outer, -1 = inner.
static void face_stress(const resultants *r, double t, double side, double stress[3])
{
    for (int k = 0; k < 3; k++) stress[k] = r->n[k] / t + side * 6 * r->m[k] / (t * t);
}

static double von_mises(const double s[3])
{
    return sqrt(s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3 * s[2] * s[2]);
}

// Add the derivative of the mean over a triangle's corners, times `share`.
static void add_triangle(const jali_sheet *sheet, const jali_material *material, const double (*u)[6],
                         int32_t t, double share, double (*gradient)[6])
{
    const int32_t *c = sheet->triangle[t];
    double node[3][3], of_triangle[18];
    resultants now[3], unit[3];
    facet_material made_of = {material->e_mpa, material->nu, 0};
    double side[3], weight[3][3];
    for (int i = 0; i < 3; i++) {
        memcpy(node[i], sheet->node[c[i]], sizeof node[i]);
        memcpy(of_triangle + 6 * i, u[c[i]], 6 * sizeof(double));
        made_of.thickness_mm += sheet->thickness_mm[c[i]] / 3;
    }
    facet_resultants((const double(*)[3])node, &made_of, of_triangle, now);
    for (int i = 0; i < 3; i++) {
        double outer[3], inner[3], *s = outer;
        face_stress(&now[i], made_of.thickness_mm, 1, outer);
        face_stress(&now[i], made_of.thickness_mm, -1, inner);
        side[i] = von_mises(outer) >= von_mises(inner) ? 1 : -1;
        if (side[i] < 0) s = inner;
        double vm = fmax(von_mises(s), 1e-300);
        weight[i][0] = (s[0] - s[1] / 2) / vm;
        weight[i][1] = (s[1] - s[0] / 2) / vm;
        weight[i][2] = 3 * s[2] / vm;
    }
    for (int j = 0; j < 18; j++) {
        double one[18] = {0}, sum = 0, s[3];
        one[j] = 1;
        facet_resultants((const double(*)[3])node, &made_of, one, unit);
        for (int i = 0; i < 3; i++) {
            face_stress(&unit[i], made_of.thickness_mm, side[i], s);
            for (int k = 0; k < 3; k++) sum += weight[i][k] * s[k] / 3;
        }
        gradient[c[j / 6]][j % 6] += share * sum;
    }
}

static double area_of(const jali_sheet *sheet, int32_t t)
{
    const int32_t *c = sheet->triangle[t];
    double n[3];
    area_vector(sheet->node[c[0]], sheet->node[c[1]], sheet->node[c[2]], n);
    return sqrt(dot(n, n));
}

static bool near_node(const jali_sheet *sheet, int32_t t, int32_t node, double radius_mm)
{
    const int32_t *c = sheet->triangle[t];
    double middle[3];
    if (c[0] == node || c[1] == node || c[2] == node) return true;
    for (int k = 0; k < 3; k++)
        middle[k] = (sheet->node[c[0]][k] + sheet->node[c[1]][k] + sheet->node[c[2]][k]) / 3;
    return distance(middle, sheet->node[node]) <= radius_mm;
}

void stress_gradient(const jali_sheet *sheet, const jali_material *material, const double (*u)[6],
                     int32_t node, double radius_mm, double (*gradient)[6])
{
    double area = 0;
    memset(gradient, 0, (size_t)sheet->node_count * sizeof *gradient);
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        if (near_node(sheet, t, node, radius_mm)) area += area_of(sheet, t);
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        if (near_node(sheet, t, node, radius_mm))
            add_triangle(sheet, material, u, t, area_of(sheet, t) / area, gradient);
}
