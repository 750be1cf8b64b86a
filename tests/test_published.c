// The facet against published cases: each within the limits of its table (published.h; docs/analyse.md).
#include "testing.h"
#include "published.h"
#include "mitc.h"

TEST(published_cases_are_met)
{
    int missed = 0;
    for (int i = 0; i < PUBLISHED_COUNT; i++) {
        const published *p = &PUBLISHED[i];
        double percent = 100 * (p->value(ctx, p->n, facet_stiffness, p->which) / p->reference - 1);
        if (percent >= p->low && percent <= p->high) continue;
        print_error("%s, %s: %+.2f %%, allowed %g .. %g\n", p->name, p->mesh, percent, p->low, p->high);
        missed++;
    }
    CHECK_INT(missed, 0);
}

// Another element of the same theory on the same meshes: plates, shells and stresses agree as meshes get
// fine.
TEST(another_element_agrees)
{
    const struct {
        double (*value)(jali_context *with, int32_t n, stiffness_of *element, double which);
        double which;
        int32_t n;
        double within;
    } same[] = {
        {clamped_square, 0.1, 24, 0.005},
        {clamped_disc, 0.2, 24, 0.005},
        {scordelis_lo, 0, 16, 0.003},
        {hemisphere_with_hole, 0, 24, 0.002},
        {twisted_beam, 1, 24, 0.001},
        {strip, 2, 4, 0.001},
        {strip, 3, 8, 0.01},
        {bent_hole, 0.25, 24, 0.005},
        {bent_hole, 10, 24, 0.005},
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        double ours = same[i].value(ctx, same[i].n, facet_stiffness, same[i].which);
        double other = same[i].value(ctx, same[i].n, mitc_stiffness, same[i].which);
        if (!(fabs(ours / other - 1) < same[i].within)) print_error("case %zu: %g and %g\n", i, ours, other);
        CHECK(fabs(ours / other - 1) < same[i].within);
    }
}

// An angle of two arms, 2 wide in all, hung at the top and loaded at the end of its foot: the stress in the
// inner corner.
static void angle_bracket(int32_t n, double *worst, double *mean)
{
    shell_model m = grid_model(2 * n, 2 * n, CROSSED, (facet_material){1000, 0.3, 0.5});
    jali_sheet sheet;
    stresses s;
    int32_t nodes = 0, triangles = 0, *now = zeros((size_t)m.node_count, sizeof *now);
    for (int32_t i = 0; i < m.node_count; i++) {
        now[i] = m.place[i][0] > 0.5 && m.place[i][1] > 0.5 ? -1 : nodes;
        if (now[i] < 0) continue;
        memmove(m.place[nodes], m.place[i], sizeof *m.place);
        nodes++;
    }
    for (int32_t t = 0; t < m.triangle_count; t++) {
        const int32_t *o = m.triangle[t], corner[3] = {now[o[0]], now[o[1]], now[o[2]]};
        if (corner[0] < 0 || corner[1] < 0 || corner[2] < 0) continue;
        memcpy(m.triangle[triangles++], corner, sizeof corner);
    }
    free(now);
    m.node_count = nodes;
    m.triangle_count = triangles;
    stretch_grid(&m, 2, 2);
    hold(&m, 1, 1, HOLD_ALL);
    load_edge(&m, 0, 1, (double[6]){0, -1});
    sheet = model_sheet(&m);
    CHECK_OK(solve_model(ctx, &m));
    CHECK_OK(recover_stresses(ctx, &sheet, &m.made_of, (const double(*)[6])m.u, 0.25, &s));
    *worst = s.worst[node_at(&m, 0.5, 0.5)];
    *mean = s.mean[node_at(&m, 0.5, 0.5)];
    stresses_free(ctx, &s);
    free(sheet.thickness_mm);
    model_free(&m);
}

// From each mesh to one twice as fine.
TEST(means_settle_where_the_stress_has_no_limit)
{
    double worst[4], mean[4];
    for (int i = 0; i < 4; i++) angle_bracket(8 << i, &worst[i], &mean[i]);
    for (int i = 2; i < 4; i++) {
        CHECK(worst[i] - worst[i - 1] > 1.2 * (worst[i - 1] - worst[i - 2]));
        CHECK(mean[i] - mean[i - 1] < 0.9 * (mean[i - 1] - mean[i - 2]));
    }
    CHECK(mean[3] < 1.06 * mean[2]);
    CHECK(mean[3] < 1.4 * mean[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_cases_are_met),
        cmocka_unit_test(another_element_agrees),
        cmocka_unit_test(means_settle_where_the_stress_has_no_limit),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
