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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_cases_are_met),
        cmocka_unit_test(another_element_agrees),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
