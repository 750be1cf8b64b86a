// Loads and supports at the nodes.
//
// A uniform load on a triangle is a third of it at each corner. Where facets meet at an angle, pressure needs
// the moments of facet_pressure beside it: by thirds alone the end of a pipe of 16 facets a quarter has 7 %
// too much hoop stress. Checked: tests/test_loads.c: sums of forces, spots, what is held.
#include "structure/loads.h"
#include "structure/element.h"
#include "base/vector.h"

#include <math.h>

static const double GRAVITY = 9.80665e-6; // N a mm3 of 1 g/cm3

static void area_at(const jali_sheet *sheet, int32_t t, double v[3])
{
    const int32_t *c = sheet->triangle[t];
    area_vector(sheet->node[c[0]], sheet->node[c[1]], sheet->node[c[2]], v);
}

double sheet_area(const jali_sheet *sheet)
{
    double sum = 0, v[3];
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        area_at(sheet, t, v);
        sum += sqrt(dot(v, v));
    }
    return sum;
}

jali_status support_nodes(jali_context *ctx, const jali_sheet *sheet, jali_support support, uint8_t *held)
{
    static const char *const what[] = {"the solid meets the picture's boundary nowhere, so nothing holds it; "
                                       "a frame, or --support base, would",
                                       "this has no rim to be held at; --support base would hold it",
                                       "nothing of this lies lowest"};
    double low = INFINITY, high = -INFINITY;
    int32_t count = 0;
    for (int32_t i = 0; i < sheet->node_count; i++) {
        low = fmin(low, sheet->node[i][2]);
        high = fmax(high, sheet->node[i][2]);
    }
    for (int32_t i = 0; i < sheet->node_count; i++) {
        if (support == JALI_SUPPORT_BASE)
            held[i] = sheet->node[i][2] <= low + 0.01 * (high - low);
        else
            held[i] = (sheet->border[i] &
                       (support == JALI_SUPPORT_PICTURE ? JALI_BORDER_PICTURE : JALI_BORDER_RIM)) != 0;
        count += held[i];
    }
    if (count == 0) return fail(ctx, JALI_NO_RESULT, "%s", what[support]);
    if (count == sheet->node_count)
        return fail(ctx, JALI_NO_RESULT,
                    "all of it is held, so nothing can move; a flat plate is held at its rim or at the "
                    "picture's boundary, not at its base");
    return JALI_OK;
}

static void press(const jali_sheet *sheet, double pressure_mpa, double (*force)[6])
{
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        const int32_t *c = sheet->triangle[t];
        double node[3][3], v[3], load[3][6] = {0};
        for (int i = 0; i < 3; i++) memcpy(node[i], sheet->node[c[i]], sizeof node[i]);
        area_at(sheet, t, v);
        if (sheet->flat)
            for (int i = 0; i < 3; i++) load[i][2] = -pressure_mpa * v[2] / 3;
        else
            facet_pressure((const double(*)[3])node, -pressure_mpa, load);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 6; k++) force[c[i]][k] += load[i][k];
    }
}

static void weigh(const jali_sheet *sheet, double n_per_mm3, const double unit[3], double (*force)[6])
{
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        const int32_t *c = sheet->triangle[t];
        double v[3];
        area_at(sheet, t, v);
        double thickness =
            (sheet->thickness_mm[c[0]] + sheet->thickness_mm[c[1]] + sheet->thickness_mm[c[2]]) / 3;
        double third = n_per_mm3 * sqrt(dot(v, v)) * thickness / 3;
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) force[c[i]][k] += third * unit[k];
    }
}

// The free node nearest to a point; -1 when there is none.
static int32_t nearest_free(const jali_sheet *sheet, const uint8_t *held, const double at[3])
{
    int32_t best = -1;
    double least = INFINITY;
    for (int32_t i = 0; i < sheet->node_count; i++) {
        double d[3];
        subtract(sheet->node[i], at, d);
        if (held[i] || dot(d, d) >= least) continue;
        least = dot(d, d);
        best = i;
    }
    return best;
}

// Does a triangle belong to the spot around a node: its middle lies near, or it is one of the node's own.
static bool in_spot(const jali_sheet *sheet, int32_t t, int32_t node, double radius)
{
    const int32_t *c = sheet->triangle[t];
    double off[3];
    if (c[0] == node || c[1] == node || c[2] == node) return true;
    for (int k = 0; k < 3; k++)
        off[k] =
            (sheet->node[c[0]][k] + sheet->node[c[1]][k] + sheet->node[c[2]][k]) / 3 - sheet->node[node][k];
    return dot(off, off) <= radius * radius;
}

// The spot's area vectors summed, and its area.
static double spot_area(const jali_sheet *sheet, int32_t node, double radius, double sum[3])
{
    double area = 0, v[3];
    memset(sum, 0, 3 * sizeof *sum);
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        if (!in_spot(sheet, t, node, radius)) continue;
        area_at(sheet, t, v);
        for (int k = 0; k < 3; k++) sum[k] += v[k];
        area += sqrt(dot(v, v));
    }
    return area;
}

// A force spread evenly over the spot around a node.
static void push_spot(const jali_sheet *sheet, int32_t node, double radius, const double n[3],
                      double (*force)[6])
{
    double v[3], area = spot_area(sheet, node, radius, v);
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        if (!in_spot(sheet, t, node, radius)) continue;
        area_at(sheet, t, v);
        double share = sqrt(dot(v, v)) / area / 3;
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) force[sheet->triangle[t][c]][k] += share * n[k];
    }
}

// A force against the mean normal of the spot nearest to a point.
static jali_status push(jali_context *ctx, const jali_sheet *sheet, const jali_load *load,
                        const uint8_t *held, double (*force)[6])
{
    int32_t node = nearest_free(sheet, held, load->push_at_mm);
    double n[3];
    if (node < 0) return fail(ctx, JALI_NO_RESULT, "there is no free place to push at");
    spot_area(sheet, node, load->spot_mm, n);
    double size = sqrt(dot(n, n));
    for (int k = 0; k < 3; k++) n[k] *= size > 0 ? -load->push_n / size : 0;
    push_spot(sheet, node, load->spot_mm, n, force);
    return JALI_OK;
}

// The unit vector along v, or along axis `usual` when v is zero.
static void direction_of(const double v[3], int32_t usual, double sign, double unit[3])
{
    double size = sqrt(dot(v, v));
    for (int k = 0; k < 3; k++) unit[k] = size > 0 ? v[k] / size : (k == usual ? sign : 0);
}

void carried_load(const jali_sheet *sheet, const jali_analyse_options *opt, double pressure_mpa,
                  double (*force)[6])
{
    double unit[3];
    if (pressure_mpa != 0) press(sheet, pressure_mpa, force);
    if (opt->load.weight == 0) return;
    direction_of(opt->load.gravity, 2, -1, unit);
    weigh(sheet, opt->load.weight * opt->material.density_g_cm3 * GRAVITY, unit, force);
}

// The free node furthest out along `unit` among those near the line through the middle.
static int32_t outermost(const jali_sheet *sheet, const uint8_t *held, const double middle[3],
                         const double unit[3], double radius)
{
    int32_t best = -1;
    double furthest = -INFINITY;
    for (double r = radius; best < 0 && r < 1e6; r *= 2)
        for (int32_t i = 0; i < sheet->node_count; i++) {
            double d[3];
            subtract(sheet->node[i], middle, d);
            double along = dot(d, unit), aside2 = dot(d, d) - along * along;
            if (held[i] || aside2 > r * r || along <= furthest) continue;
            furthest = along;
            best = i;
        }
    return best;
}

static jali_status pinch(jali_context *ctx, const jali_sheet *sheet, const jali_load *load,
                         const uint8_t *held, double (*force)[6])
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, middle[3];
    for (int32_t i = 0; i < sheet->node_count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], sheet->node[i][k]);
            high[k] = fmax(high[k], sheet->node[i][k]);
        }
    for (int k = 0; k < 3; k++) middle[k] = (low[k] + high[k]) / 2;
    double out[3], in[3], push_in[3], push_out[3];
    direction_of(load->pinch_axis, 0, 1, out);
    for (int k = 0; k < 3; k++) {
        in[k] = -out[k];
        push_out[k] = load->pinch_n * out[k];
        push_in[k] = -push_out[k];
    }
    int32_t one = outermost(sheet, held, middle, out, load->spot_mm),
            other = outermost(sheet, held, middle, in, load->spot_mm);
    if (one < 0 || other < 0 || one == other)
        return fail(ctx, JALI_NO_RESULT, "there are no two free places to pinch the sheet at");
    push_spot(sheet, one, load->spot_mm, push_in, force);
    push_spot(sheet, other, load->spot_mm, push_out, force);
    return JALI_OK;
}

static jali_status check_load(jali_context *ctx, const jali_load *load)
{
    const double figure[] = {load->force_n, load->pressure_mpa, load->weight, load->push_n, load->pinch_n};
    static const char *const name[] = {"force", "pressure", "weight", "push", "pinch"};
    static const char *const unit[] = {"N", "MPa", "times itself", "N", "N"};
    double sum = 0;
    for (int i = 0; i < 5; i++) {
        if (!(fabs(figure[i]) <= 1e9))
            return fail(ctx, JALI_BAD_VALUE, "the %s is %g %s; a number up to 1e9 is accepted", name[i],
                        figure[i], unit[i]);
        sum += fabs(figure[i]);
    }
    for (int k = 0; k < 3; k++)
        if (!isfinite(load->gravity[k]) || !isfinite(load->push_at_mm[k]) || !isfinite(load->pinch_axis[k]))
            return fail(ctx, JALI_BAD_VALUE, "a direction or place of the load is not a number");
    if (sum == 0)
        return fail(ctx, JALI_BAD_VALUE,
                    "there is no load; a force, pressure, weight, push or pinch is needed");
    if (load->force_n != 0 && load->pressure_mpa != 0)
        return fail(ctx, JALI_BAD_VALUE, "force (%g N) and pressure (%g MPa) are two ways to say one thing",
                    load->force_n, load->pressure_mpa);
    if (!(load->spot_mm > 0) || load->spot_mm > 1e4)
        return fail(ctx, JALI_BAD_VALUE, "a spot of %g mm radius: more than 0 and up to 10000 mm is accepted",
                    load->spot_mm);
    return JALI_OK;
}

jali_status load_nodes(jali_context *ctx, const jali_sheet *sheet, const jali_analyse_options *opt,
                       const uint8_t *held, double (*force)[6], double *applied)
{
    jali_status status;
    const jali_load *load = &opt->load;
    TRY(check_load(ctx, load));
    *applied = load->force_n != 0 ? load->force_n / sheet_area(sheet) : load->pressure_mpa;
    carried_load(sheet, opt, *applied, force);
    if (load->push_n != 0) TRY(push(ctx, sheet, load, held, force));
    if (load->pinch_n != 0) TRY(pinch(ctx, sheet, load, held, force));
done:
    return status;
}

bool bends_only(const jali_sheet *sheet, const jali_load *load)
{
    bool sideways = load->weight != 0 && (load->gravity[0] != 0 || load->gravity[1] != 0);
    return sheet->flat && load->pinch_n == 0 && !sideways;
}
