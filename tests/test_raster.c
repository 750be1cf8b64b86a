// Bitmaps and everything on them, against the definitions.
#include "testing.h"
#include "plain.h"
#include "raster/raster.h"

static bool pixel(const jali_bitmap *a, int32_t x, int32_t y, bool outside)
{
    return x < 0 || y < 0 || x >= a->width_px || y >= a->height_px ? outside : jali_bitmap_get(a, x, y);
}

// Whether (dx, dy) is in the element, in half pixels.
static bool in_element(const element *e, int32_t dx, int32_t dy)
{
    int32_t even = e->size % 2 == 0;
    int32_t v = abs(2 * dy + even) / 2, u = abs(2 * dx + even);
    return v < e->rows && u <= 2 * e->half[v] - even;
}

/// The element's pixels as a list, from its definition.
typedef struct offsets {
    int32_t count;
    int16_t (*at)[2]; // dx, dy
} offsets;

static offsets offsets_of(const element *e)
{
    offsets o = {0, malloc((size_t)(4 * e->size * e->size) * sizeof *o.at)};
    for (int32_t dy = -e->size; dy < e->size; dy++)
        for (int32_t dx = -e->size; dx < e->size; dx++)
            if (in_element(e, dx, dy)) {
                o.at[o.count][0] = (int16_t)dx;
                o.at[o.count++][1] = (int16_t)dy;
            }
    return o;
}

static bool eroded_pixel(const jali_bitmap *a, const offsets *o, int32_t x, int32_t y, bool outside)
{
    for (int32_t k = 0; k < o->count; k++)
        if (!pixel(a, x + o->at[k][0], y + o->at[k][1], outside)) return false;
    return true;
}

static bool dilated_pixel(const jali_bitmap *a, const offsets *o, int32_t x, int32_t y, bool outside)
{
    for (int32_t k = 0; k < o->count; k++)
        if (pixel(a, x - o->at[k][0], y - o->at[k][1], outside)) return true;
    return false;
}

static void check_morphology(const jali_bitmap *a, const element *e, bool outside)
{
    jali_bitmap got, scratch;
    offsets o = offsets_of(e);
    CHECK_OK(jali_bitmap_create(ctx, a->width_px, a->height_px, &got));
    CHECK_OK(jali_bitmap_create(ctx, a->width_px, a->height_px, &scratch));
    CHECK_OK(erode(ctx, a, e, outside, &got));
    for (int32_t y = 0; y < a->height_px; y++)
        for (int32_t x = 0; x < a->width_px; x++)
            CHECK(jali_bitmap_get(&got, x, y) == eroded_pixel(a, &o, x, y, outside));
    CHECK_OK(dilate(ctx, a, e, outside, &got));
    for (int32_t y = 0; y < a->height_px; y++)
        for (int32_t x = 0; x < a->width_px; x++)
            CHECK(jali_bitmap_get(&got, x, y) == dilated_pixel(a, &o, x, y, outside));
    CHECK_OK(open_by(ctx, a, e, outside, &scratch, &got));
    CHECK_INT(count_combined(ctx, RULE_AND_NOT, &got, a), 0);
    jali_bitmap again;
    CHECK_OK(jali_bitmap_copy(ctx, &got, &again));
    CHECK_OK(open_by(ctx, &again, e, outside, &scratch, &again));
    CHECK(same_bitmap(&got, &again)); // idempotent
    CHECK_OK(close_by(ctx, a, e, outside, &scratch, &again));
    CHECK_INT(count_combined(ctx, RULE_AND_NOT, a, &again), 0);
    free(o.at);
    jali_bitmap_free(ctx, &again);
    jali_bitmap_free(ctx, &got);
    jali_bitmap_free(ctx, &scratch);
}

TEST(morphology_is_its_definition)
{
    uint64_t seed = 11;
    for (int32_t size = 1; size <= 12; size++) {
        element e[3];
        CHECK_OK(element_square(ctx, size, &e[0]));
        CHECK_OK(element_disc(ctx, size, &e[1]));
        CHECK_OK(element_octagon(ctx, size, &e[2]));
        for (int32_t kind = 0; kind < 3; kind++)
            for (int32_t outside = 0; outside < 2; outside++) {
                int32_t width[] = {20, 63, 64, 65, 130};
                jali_bitmap a =
                    random_bitmap(&seed, width[(size + kind + outside) % 5], 17, 50 + 40 * outside);
                check_morphology(&a, &e[kind], outside);
                jali_bitmap_free(ctx, &a);
            }
        for (int32_t kind = 0; kind < 3; kind++) element_free(ctx, &e[kind]);
    }
}

TEST(wide_elements_cross_words)
{
    uint64_t seed = 5;
    for (int32_t size = 25; size <= 200; size += 35) {
        element e;
        CHECK_OK(size % 2 ? element_disc(ctx, size, &e) : element_square(ctx, size, &e));
        jali_bitmap a, eroded;
        CHECK_OK(jali_bitmap_create(ctx, 600, 300, &a));
        fill(ctx, &a, true);
        int32_t hole[3][2];
        for (int32_t i = 0; i < 3; i++) {
            hole[i][0] = (int32_t)(next_random(&seed) % 600);
            hole[i][1] = (int32_t)(next_random(&seed) % 300);
            jali_bitmap_set(&a, hole[i][0], hole[i][1], false);
        }
        CHECK_OK(jali_bitmap_create(ctx, 600, 300, &eroded));
        CHECK_OK(erode(ctx, &a, &e, true, &eroded));
        for (int32_t y = 0; y < 300; y++)
            for (int32_t x = 0; x < 600; x++) {
                bool hit = false;
                for (int32_t i = 0; i < 3; i++) hit |= in_element(&e, hole[i][0] - x, hole[i][1] - y);
                CHECK(jali_bitmap_get(&eroded, x, y) == !hit);
            }
        jali_bitmap_free(ctx, &a);
        jali_bitmap_free(ctx, &eroded);
        element_free(ctx, &e);
    }
}

TEST(a_bar_as_wide_as_the_disc_survives_and_a_thinner_one_does_not)
{
    for (int32_t size = 2; size <= 15; size++) {
        element e;
        CHECK_OK(element_disc(ctx, size, &e));
        for (int32_t width = size - 1; width <= size; width++) {
            jali_bitmap a, scratch;
            CHECK_OK(jali_bitmap_create(ctx, 90, 90, &a));
            CHECK_OK(jali_bitmap_create(ctx, 90, 90, &scratch));
            for (int32_t y = 0; y < 90; y++) paint_run(&a, y, 40, 40 + width, true);
            int64_t before = count_white(ctx, &a);
            CHECK_OK(open_by(ctx, &a, &e, true, &scratch, &a));
            CHECK_INT(count_white(ctx, &a), width == size ? before : 0);
            jali_bitmap_free(ctx, &a);
            jali_bitmap_free(ctx, &scratch);
        }
        element_free(ctx, &e);
    }
}

TEST(components_are_those_of_a_flood_fill)
{
    uint64_t seed = 3;
    int32_t label[100 * 40];
    for (int32_t round = 0; round < 40; round++) {
        int32_t w = 1 + (int32_t)(next_random(&seed) >> 40) % 99,
                h = 1 + (int32_t)(next_random(&seed) >> 40) % 39;
        jali_bitmap a = random_bitmap(&seed, w, h, 20 + round * 3 / 2);
        plain p = plain_of(&a);
        for (int32_t variant = 0; variant < 4; variant++) {
            bool white = variant % 2;
            int32_t connectivity = variant / 2 ? 8 : 4;
            components c;
            CHECK_OK(label_components(ctx, &a, white, connectivity, &c));
            CHECK_INT(c.count, plain_label(&p, white, connectivity, label));
            for (int32_t y = 0; y < h; y++)
                for (int32_t x = 0; x < w; x++) {
                    int32_t run = run_at(&c, x, y);
                    CHECK_INT(run < 0 ? -1 : c.label[run], label[y * w + x]);
                }
            components_free(ctx, &c);
        }
        plain_free(&p);
        jali_bitmap_free(ctx, &a);
    }
}

TEST(majority_is_most_of_seven_by_seven)
{
    uint64_t seed = 33;
    for (int32_t round = 0; round < 8; round++) {
        int32_t w = 20 + 37 * round, h = 70;
        bool outside = round % 2;
        jali_bitmap a = random_bitmap(&seed, w, h, 30 + 6 * round), got;
        CHECK_OK(jali_bitmap_create(ctx, w, h, &got));
        CHECK_OK(majority(ctx, &a, outside, &got));
        for (int32_t y = 0; y < h; y++)
            for (int32_t x = 0; x < w; x++) {
                int32_t white = 0;
                for (int32_t k = 0; k < 49; k++) white += pixel(&a, x + k % 7 - 3, y + k / 7 - 3, outside);
                CHECK(jali_bitmap_get(&got, x, y) == (white >= 25));
            }
        jali_bitmap_free(ctx, &a);
        jali_bitmap_free(ctx, &got);
    }
}

// The centres of maximal squares: no neighbour inside the bitmap has a greater chessboard distance.
static int32_t square_distance(const jali_bitmap *a, int32_t x, int32_t y, bool white, bool outside)
{
    for (int32_t reach = 0;; reach++)
        for (int32_t dy = -reach; dy <= reach; dy++)
            for (int32_t dx = -reach; dx <= reach; dx++) {
                int32_t u = x + dx, v = y + dy;
                bool inside = u >= 0 && v >= 0 && u < a->width_px && v < a->height_px;
                if (inside ? jali_bitmap_get(a, u, v) != white : !outside) return reach;
                if (reach > 200) return reach;
            }
}

TEST(medial_axis_is_the_ridge_of_the_chessboard_distance)
{
    uint64_t seed = 21;
    for (int32_t round = 0; round < 12; round++) {
        int32_t w = 40 + 17 * (round % 5), h = 90;
        jali_bitmap a = random_bitmap(&seed, w, h, 97), axis, limited;
        bool white = round % 3 != 0, outside = round % 2;
        CHECK_OK(medial_axis(ctx, &a, white, outside, 0, &axis));
        CHECK_OK(medial_axis(ctx, &a, white, outside, 60, &limited));
        CHECK(same_bitmap(&axis, &limited));
        for (int32_t y = 0; y < h; y++)
            for (int32_t x = 0; x < w; x++) {
                int32_t own = square_distance(&a, x, y, white, outside), best = own;
                for (int32_t k = 0; k < 9; k++) {
                    int32_t u = x + k % 3 - 1, v = y + k / 3 - 1;
                    if (u >= 0 && v >= 0 && u < w && v < h)
                        best = MAX(best, square_distance(&a, u, v, white, outside));
                }
                CHECK_INT(jali_bitmap_get(&axis, x, y), own > 0 && best == own);
            }
        jali_bitmap_free(ctx, &a);
        jali_bitmap_free(ctx, &axis);
        jali_bitmap_free(ctx, &limited);
    }
}

TEST(distances_are_those_of_all_pairs)
{
    static int32_t squared[130 * 40];
    uint64_t seed = 17;
    for (int32_t round = 0; round < 60; round++) {
        int32_t w = 1 + (int32_t)(next_random(&seed) >> 40) % 130,
                h = 1 + (int32_t)(next_random(&seed) >> 40) % 40;
        int32_t first = round % 3 ? (int32_t)(next_random(&seed) >> 40) % h : 0;
        int32_t rows = round % 3 ? 1 + (int32_t)(next_random(&seed) >> 40) % (h - first) : h;
        jali_bitmap a = random_bitmap(&seed, w, h, round % 10 == 0 ? 0 : 1 + round % 5 * 6);
        CHECK_OK(squared_distances(ctx, &a, true, first, rows, squared));
        if (round % 7 == 6) {
            invert(ctx, &a, &a);
            memset(squared, 0xff, sizeof squared);
            CHECK_OK(squared_distances(ctx, &a, false, first, rows, squared));
            invert(ctx, &a, &a);
        }
        for (int32_t y = 0; y < rows; y++)
            for (int32_t x = 0; x < w; x += 1 + round % 4) {
                int32_t best = DISTANCE_NONE;
                for (int32_t v = 0; v < h; v++)
                    for (int32_t u = next_white(a.word + v * a.stride, 0, w, 0); u < w;
                         u = next_white(a.word + v * a.stride, u + 1, w, 0))
                        best = MIN(best, (u - x) * (u - x) + (v - first - y) * (v - first - y));
                CHECK(squared[y * w + x] == best);
            }
        jali_bitmap_free(ctx, &a);
    }
}

TEST(threads_do_not_change_distances)
{
    uint64_t seed = 19;
    jali_context *by_threads[3];
    int32_t *squared[3];
    jali_bitmap a = random_bitmap(&seed, 300, 200, 1);
    open_thread_contexts(by_threads);
    for (int32_t i = 0; i < 3; i++) {
        squared[i] = malloc(300 * 200 * sizeof *squared[i]);
        CHECK_INT(squared_distances(by_threads[i], &a, true, 0, 200, squared[i]), JALI_OK);
        CHECK(memcmp(squared[i], squared[0], 300 * 200 * sizeof *squared[i]) == 0);
    }
    for (int32_t i = 0; i < 3; i++) free(squared[i]);
    close_thread_contexts(by_threads);
    jali_bitmap_free(ctx, &a);
}

static jali_status open_and_label(jali_context *limited, void *data)
{
    jali_status status;
    jali_bitmap scratch = {0};
    element e = {0};
    components c = {0};
    int32_t row[70];
    TRY(element_disc(limited, 5, &e));
    TRY(jali_bitmap_copy(limited, data, &scratch));
    TRY(open_by(limited, data, &e, true, &scratch, &scratch));
    TRY(label_components(limited, data, true, 4, &c));
    TRY(squared_distances(limited, data, true, 0, 1, row));
done:
    components_free(limited, &c);
    element_free(limited, &e);
    jali_bitmap_free(limited, &scratch);
    return status;
}

TEST(every_refused_allocation_is_reported)
{
    uint64_t seed = 9;
    jali_bitmap a = random_bitmap(&seed, 70, 30, 50);
    refuse_each_allocation(open_and_label, &a);
    jali_bitmap_free(ctx, &a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(morphology_is_its_definition),
        cmocka_unit_test(wide_elements_cross_words),
        cmocka_unit_test(a_bar_as_wide_as_the_disc_survives_and_a_thinner_one_does_not),
        cmocka_unit_test(components_are_those_of_a_flood_fill),
        cmocka_unit_test(majority_is_most_of_seven_by_seven),
        cmocka_unit_test(medial_axis_is_the_ridge_of_the_chessboard_distance),
        cmocka_unit_test(distances_are_those_of_all_pairs),
        cmocka_unit_test(threads_do_not_change_distances),
        cmocka_unit_test(every_refused_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
