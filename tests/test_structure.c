// Structures: displacements against a dense elimination, supports that do not suffice, what a piece needs.
#include "testing.h"

#include "sheets.h"

#include "structure/assemble.h"

static const facet_material plastic = {.e_mpa = 2300, .nu = 0.35};

static double random_in(uint64_t *seed, double low, double high)
{
    return low + (high - low) * (double)(next_random(seed) >> 11) / 9007199254740992.0;
}

// Of a sheet with uneven nodes and thickness, shuffled so that no order is given.
static void make_uneven(jali_sheet *sheet, uint64_t seed, double by_mm)
{
    for (int32_t i = 0; i < sheet->node_count; i++) {
        for (int k = 0; k < (sheet->flat ? 2 : 3); k++) sheet->node[i][k] += random_in(&seed, -by_mm, by_mm);
        sheet->thickness_mm[i] *= random_in(&seed, 0.7, 1.3);
    }
    for (int32_t t = sheet->triangle_count - 1; t > 0; t--) {
        int32_t other = (int32_t)(next_random(&seed) >> 33) % (t + 1), kept[3];
        memcpy(kept, sheet->triangle[t], sizeof kept);
        memcpy(sheet->triangle[t], sheet->triangle[other], sizeof kept);
        memcpy(sheet->triangle[other], kept, sizeof kept);
    }
}

// The stiffness of all unknowns of all nodes, held ones too.
static double *dense_stiffness(const jali_sheet *sheet, bool bending_only)
{
    size_t size = (size_t)sheet->node_count * NODE_UNKNOWNS;
    double *dense = calloc(size * size, sizeof *dense);
    int width = bending_only ? 3 : 6, shift = bending_only ? 2 : 0;
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        const int32_t *c = sheet->triangle[t];
        double node[3][3], flat[3][2], k18[18][18], k9[9][9];
        facet_material made_of = plastic;
        made_of.thickness_mm = 0;
        for (int i = 0; i < 3; i++) {
            memcpy(node[i], sheet->node[c[i]], sizeof node[i]);
            memcpy(flat[i], sheet->node[c[i]], sizeof flat[i]);
            made_of.thickness_mm += sheet->thickness_mm[c[i]] / 3;
        }
        facet_stiffness((const double(*)[3])node, &made_of, k18);
        plate_stiffness((const double(*)[2])flat, &made_of, k9);
        for (int i = 0; i < 3 * width; i++)
            for (int j = 0; j < 3 * width; j++) {
                size_t r = (size_t)(c[i / width] * NODE_UNKNOWNS + i % width + shift);
                size_t q = (size_t)(c[j / width] * NODE_UNKNOWNS + j % width + shift);
                dense[r * size + q] += bending_only ? k9[i][j] : k18[i][j];
            }
    }
    return dense;
}

// K u where K is dense; only in rows that are free.
static double largest_imbalance(const structure *s, const double *dense, const double (*load)[NODE_UNKNOWNS],
                                const double (*u)[NODE_UNKNOWNS])
{
    int32_t size = s->sheet->node_count * NODE_UNKNOWNS;
    double most = 0;
    for (int32_t r = 0; r < size; r++) {
        double sum = 0;
        for (int32_t c = 0; c < size; c++)
            sum += dense[(size_t)r * (size_t)size + (size_t)c] * u[c / NODE_UNKNOWNS][c % NODE_UNKNOWNS];
        if (unknown_at(s, r / NODE_UNKNOWNS, r % NODE_UNKNOWNS) < 0)
            CHECK(u[r / NODE_UNKNOWNS][r % NODE_UNKNOWNS] == 0);
        else
            most = fmax(most, fabs(sum - load[r / NODE_UNKNOWNS][r % NODE_UNKNOWNS]));
    }
    return most;
}

TEST(displacements_balance_the_loads)
{
    for (uint64_t seed = 1; seed <= 12; seed++) {
        bool bending_only = seed % 3 == 0;
        pierced_options o = {.cells = 4 + (int32_t)seed,
                             .holes = seed % 2 ? 2 : 0,
                             .size_mm = 20,
                             .hole_mm = 2.5,
                             .thickness_mm = 2,
                             .radius_mm = bending_only ? 0 : 15};
        jali_sheet sheet;
        structure s;
        uint64_t random = seed;
        uint8_t *held = NULL;
        double(*load)[NODE_UNKNOWNS] = NULL, (*u)[NODE_UNKNOWNS] = NULL;
        CHECK_OK(pierced_sheet(ctx, &o, &sheet));
        make_uneven(&sheet, seed, 0.2);
        CHECK_OK(ALLOCATE(ctx, held, sheet.node_count));
        CHECK_OK(ALLOCATE(ctx, load, sheet.node_count));
        CHECK_OK(ALLOCATE(ctx, u, sheet.node_count));
        for (int32_t i = 0; i < sheet.node_count; i++) {
            held[i] = sheet.border[i] ? (uint8_t)(next_random(&random) >> 40) & HELD_ALL : 0;
            for (int k = 0; k < NODE_UNKNOWNS; k++) load[i][k] = random_in(&random, -1, 1);
        }
        CHECK_OK(structure_create(ctx, &sheet, &plastic, held, bending_only, &s));
        CHECK_OK(structure_solve(ctx, &s, 1, (const double(*)[NODE_UNKNOWNS])load, u));
        CHECK(s.residual < 1e-8);
        double *dense = dense_stiffness(&sheet, bending_only);
        CHECK(largest_imbalance(&s, dense, (const double(*)[NODE_UNKNOWNS])load,
                                (const double(*)[NODE_UNKNOWNS])u) < 1e-7);
        free(dense);
        // Twice the thickness, and the same pattern.
        for (int32_t i = 0; i < sheet.node_count; i++) sheet.thickness_mm[i] *= 2;
        CHECK_OK(structure_refactor(ctx, &s));
        CHECK_OK(structure_solve(ctx, &s, 1, (const double(*)[NODE_UNKNOWNS])load, u));
        dense = dense_stiffness(&sheet, bending_only);
        CHECK(largest_imbalance(&s, dense, (const double(*)[NODE_UNKNOWNS])load,
                                (const double(*)[NODE_UNKNOWNS])u) < 1e-7);
        free(dense);
        structure_free(ctx, &s);
        drop_sheet(ctx, &sheet);
        release(ctx, held);
        release(ctx, load);
        release(ctx, u);
    }
}

TEST(nodes_in_a_row_lie_side_by_side)
{
    pierced_options o = {.cells = 64, .size_mm = 64, .thickness_mm = 1};
    jali_sheet sheet;
    int32_t *node = NULL;
    double length = 0;
    CHECK_OK(pierced_sheet(ctx, &o, &sheet));
    CHECK_OK(ALLOCATE(ctx, node, sheet.node_count));
    CHECK_OK(morton_order(ctx, sheet.node_count, (const double(*)[3])sheet.node, node));
    uint8_t *seen = calloc((size_t)sheet.node_count, 1);
    for (int32_t i = 0; i < sheet.node_count; i++) {
        const double *here = sheet.node[node[i]], *before = sheet.node[node[i > 0 ? i - 1 : 0]];
        CHECK(!seen[node[i]]++);
        length += hypot(here[0] - before[0], here[1] - before[1]);
    }
    CHECK(length / sheet.node_count < 2); // 1.67 mm a step on an endless grid of 1 mm
    free(seen);
    release(ctx, node);
    drop_sheet(ctx, &sheet);
}

// Hold some nodes of a plate by some unknowns and say whether that suffices.
static jali_status held_by(const pierced_options *o, int32_t count, const int32_t (*support)[2],
                           bool bending_only)
{
    jali_sheet sheet;
    uint8_t *held = NULL;
    CHECK_OK(pierced_sheet(ctx, o, &sheet));
    CHECK_OK(ALLOCATE_CLEARED(ctx, held, sheet.node_count));
    for (int32_t i = 0; i < count; i++) held[support[i][0]] = (uint8_t)support[i][1];
    jali_status status = pieces_are_held(ctx, &sheet, held, bending_only);
    release(ctx, held);
    drop_sheet(ctx, &sheet);
    return status;
}

TEST(supports_must_stop_every_rigid_motion)
{
    enum { X = 1, Y = 2, Z = 4, ABOUT_X = 8, ABOUT_Y = 16, ABOUT_Z = 32, LAST = 24 };
    const pierced_options flat = {.cells = 4, .size_mm = 8, .thickness_mm = 1};
    const pierced_options bent = {.cells = 4, .size_mm = 8, .thickness_mm = 1, .radius_mm = 10};
    const int32_t nothing[1][2] = {{0, 0}}, clamp[1][2] = {{7, HELD_ALL}}, hinge[1][2] = {{7, HELD_IN_PLACE}};
    CHECK_STATUS(held_by(&flat, 1, nothing, false), JALI_NO_RESULT);
    CHECK_STATUS(held_by(&flat, 1, clamp, false), JALI_OK);
    CHECK_STATUS(held_by(&bent, 1, clamp, false), JALI_OK);
    CHECK_STATUS(held_by(&flat, 1, hinge, false), JALI_NO_RESULT);
    CHECK_STATUS(held_by(&flat, 1, hinge, true), JALI_NO_RESULT);
    const int32_t axle[2][2] = {{0, HELD_IN_PLACE}, {LAST, HELD_IN_PLACE}};
    CHECK_STATUS(held_by(&flat, 2, axle, false), JALI_NO_RESULT);
    const int32_t locked[2][2] = {{0, HELD_IN_PLACE | ABOUT_X}, {LAST, HELD_IN_PLACE}};
    CHECK_STATUS(held_by(&bent, 2, locked, false), JALI_OK);
    const int32_t legs[3][2] = {{0, Z}, {1, Z}, {LAST, Z}}, in_line[3][2] = {{0, Z}, {1, Z}, {4, Z}};
    CHECK_STATUS(held_by(&flat, 3, legs, true), JALI_OK);
    CHECK_STATUS(held_by(&flat, 3, legs, false), JALI_NO_RESULT); // it may glide
    CHECK_STATUS(held_by(&flat, 3, in_line, true), JALI_NO_RESULT);
    const int32_t least[3][2] = {{0, X | Y | Z}, {1, Y | Z}, {LAST, Z}};
    CHECK_STATUS(held_by(&flat, 3, least, false), JALI_OK); // nodes 0 and 1 lie along x: y stops the turn
}

TEST(a_loose_piece_is_named)
{
    pierced_options o = {.cells = 12, .size_mm = 12, .thickness_mm = 1};
    jali_sheet sheet;
    structure s;
    CHECK_OK(pierced_sheet(ctx, &o, &sheet));
    uint8_t *held = NULL;
    CHECK_OK(ALLOCATE_CLEARED(ctx, held, sheet.node_count));
    int32_t kept = 0; // cut along x = 8 .. 9
    for (int32_t t = 0; t < sheet.triangle_count; t++) {
        double x = 0;
        for (int k = 0; k < 3; k++) x += sheet.node[sheet.triangle[t][k]][0] / 3;
        if (x < 8 || x > 9) memcpy(sheet.triangle[kept++], sheet.triangle[t], sizeof *sheet.triangle);
    }
    sheet.triangle_count = kept;
    for (int32_t i = 0; i < sheet.node_count; i++) held[i] = sheet.node[i][0] < 0.5 ? HELD_ALL : 0;
    CHECK_STATUS(structure_create(ctx, &sheet, &plastic, held, false, &s), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "(10.5, 6.0, 0.0) mm"));
    for (int32_t i = 0; i < sheet.node_count; i++)
        if (sheet.node[i][0] > 11.5) held[i] = HELD_ALL;
    CHECK_OK(structure_create(ctx, &sheet, &plastic, held, false, &s));
    structure_free(ctx, &s);
    sheet.thickness_mm[30] = sheet.thickness_mm[31] = NAN;
    CHECK_STATUS(structure_create(ctx, &sheet, &plastic, held, true, &s), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "stiffness"));
    release(ctx, held);
    drop_sheet(ctx, &sheet);
}

TEST(threads_change_nothing)
{
    jali_context *by_threads[3];
    uint64_t sums[3];
    open_thread_contexts(by_threads);
    for (int n = 0; n < 3; n++) {
        pierced_options o = {
            .cells = 90, .holes = 4, .size_mm = 40, .hole_mm = 2, .thickness_mm = 2, .radius_mm = 60};
        jali_sheet sheet;
        structure s;
        uint8_t *held = NULL;
        double(*u)[NODE_UNKNOWNS] = NULL;
        CHECK(pierced_sheet(by_threads[n], &o, &sheet) == JALI_OK);
        CHECK(ALLOCATE_CLEARED(by_threads[n], held, sheet.node_count) == JALI_OK);
        CHECK(ALLOCATE_CLEARED(by_threads[n], u, sheet.node_count) == JALI_OK);
        for (int32_t i = 0; i < sheet.node_count; i++) {
            held[i] = sheet.border[i] ? HELD_ALL : 0;
            u[i][2] = 1;
        }
        CHECK(structure_create(by_threads[n], &sheet, &plastic, held, false, &s) == JALI_OK);
        CHECK(structure_solve(by_threads[n], &s, 1, (const double(*)[NODE_UNKNOWNS])u, u) == JALI_OK);
        sums[n] = 0;
        for (int32_t i = 0; i < sheet.node_count; i++)
            for (int k = 0; k < NODE_UNKNOWNS; k++) {
                uint64_t bits;
                memcpy(&bits, &u[i][k], sizeof bits);
                sums[n] = sums[n] * 31 + bits;
            }
        structure_free(by_threads[n], &s);
        drop_sheet(by_threads[n], &sheet);
        release(by_threads[n], held);
        release(by_threads[n], u);
    }
    CHECK(sums[0] == sums[1] && sums[0] == sums[2]);
    close_thread_contexts(by_threads);
}

static jali_status small_plate(jali_context *limited, void *data)
{
    (void)data;
    jali_status status;
    pierced_options o = {.cells = 4, .size_mm = 8, .thickness_mm = 1};
    jali_sheet sheet = {0};
    structure s = {0};
    uint8_t held[25] = {[0 ... 4] = HELD_ALL};
    double u[25][NODE_UNKNOWNS] = {{0}};
    TRY(pierced_sheet(limited, &o, &sheet));
    TRY(structure_create(limited, &sheet, &plastic, held, false, &s));
    TRY(structure_solve(limited, &s, 1, (const double(*)[NODE_UNKNOWNS])u, u));
done:
    structure_free(limited, &s);
    drop_sheet(limited, &sheet);
    return status;
}

TEST(every_allocation_may_fail)
{
    refuse_each_allocation(small_plate, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(displacements_balance_the_loads),
        cmocka_unit_test(nodes_in_a_row_lie_side_by_side),
        cmocka_unit_test(supports_must_stop_every_rigid_motion),
        cmocka_unit_test(a_loose_piece_is_named),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
