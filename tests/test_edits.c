// edits: read and written, taken along with their picture, and what the image method keeps of them.
#include "testing.h"
#include "plain.h"

#include <jali/jali.h>
#include "raster/raster.h"

#include <math.h>

// --- Values

static jali_edits read_text(const char *json)
{
    jali_edits edits;
    CHECK_OK(jali_edits_read_bytes(ctx, (const uint8_t *)json, strlen(json), "edits", &edits));
    return edits;
}

static const char GOOD[] =
    "{\"version\": 1, \"size\": [600, 400], \"edits\": ["
    "{\"kind\": \"bridge\", \"points\": [[10, 20.5], [30, 40], [50.25, 60]], \"width\": 6},"
    "{\"kind\": \"forbid\", \"points\": [[1, 2], [3, 4], [5, 0]], \"note\": \"the eye\"},"
    "{\"kind\": \"lock\", \"points\": [[-5, 2]], \"width\": 0.1}]}";

TEST(edits_are_read_as_they_stand)
{
    jali_edits e = read_text(GOOD);
    CHECK_INT(e.count, 3);
    CHECK(e.size[0] == 600 && e.size[1] == 400);
    CHECK_INT(e.edit[0].kind, JALI_EDIT_BRIDGE);
    CHECK_INT(e.edit[1].kind, JALI_EDIT_FORBID);
    CHECK_INT(e.edit[2].kind, JALI_EDIT_LOCK);
    CHECK(e.edit[0].width == 6 && e.edit[1].width == 0 && e.edit[2].width == 0.1);
    CHECK_INT(e.edit[1].first, 3);
    CHECK_INT(e.edit[1].count, 3);
    CHECK(e.point[2][0] == 50.25 && e.point[6][0] == -5);
    jali_edits_free(ctx, &e);
    jali_edits_free(ctx, &e);
}

TEST(what_is_written_reads_back_the_same)
{
    jali_edits e = read_text(GOOD), back;
    jali_bytes first = {0}, second = {0};
    CHECK_OK(jali_edits_write(ctx, &e, &first));
    CHECK_OK(jali_edits_read_bytes(ctx, first.data, first.size, "edits", &back));
    CHECK_INT(back.count, e.count);
    CHECK(memcmp(back.point, e.point, (size_t)e.point_count * sizeof *e.point) == 0);
    for (int32_t i = 0; i < e.count; i++) CHECK(back.edit[i].width == e.edit[i].width);
    CHECK_OK(jali_edits_write(ctx, &back, &second));
    CHECK(first.size == second.size && memcmp(first.data, second.data, first.size) == 0);
    jali_edits_free(ctx, &e);
    jali_edits_free(ctx, &back);
    jali_bytes_free(ctx, &first);
    jali_bytes_free(ctx, &second);
}

TEST(bad_files_are_a_sentence_that_says_where)
{
    static const char *const bad[][2] = {
        {"", "line"},
        {"[]", "no JSON object"},
        {"{\"version\": 2}", "\"version\": 1"},
        {"{\"version\": 1, \"edits\": []}", "size"},
        {"{\"version\": 1, \"size\": [3], \"edits\": []}", "size"},
        {"{\"version\": 1, \"size\": [3, 0], \"edits\": []}", "3 x 0"},
        {"{\"version\": 1, \"size\": [3, 2]}", "edits"},
        {"{\"version\": 1, \"size\": [3, 2], \"edits\": [], \"more\": 1}", "more"},
        {"{\"version\": 1, \"size\": [3, 2], \"edits\": [5]}", "edit 1"},
        {"{\"version\": 1, \"size\": [3, 2], \"edits\": [{\"kind\": \"cut\"}]}", "cut"},
        {"{\"version\": 1, \"size\": [3, 2], \"edits\": [{\"kind\": \"lock\", \"points\": [[0, 0], [1, "
         "1]]}]}",
         "3"},
        {"{\"version\": 1, \"size\": [3, 2], \"edits\": [{\"kind\": \"bridge\", \"points\": [[0, 0]]}]}",
         "2"},
        {"{\"version\": 1, \"size\": [3, 2], \"edits\": [{\"kind\": \"bridge\", \"points\": [[0, 0], [1, "
         "5]]}]}",
         "point 2 of edit 1"},
        {"{\"version\": 1, \"size\": [3, 2], \"edits\": [{\"kind\": \"bridge\", \"points\": [[0, 0], [1]]}]}",
         "point 2 of edit 1"},
        {"{\"version\": 1, \"size\": [3, 2], \"edits\": [{\"kind\": \"lock\", \"width\": -1, \"points\": "
         "[[0, 0]]}]}",
         "width"},
        {"{\"version\": 1, \"size\": [3, 2], \"edits\": [{\"kind\": \"lock\", \"width\": \"x\", \"points\": "
         "[[0, 0]]}]}",
         "width"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        jali_edits e;
        CHECK_STATUS(jali_edits_read_bytes(ctx, (const uint8_t *)bad[i][0], strlen(bad[i][0]), "edits", &e),
                     JALI_BAD_INPUT);
        if (!strstr(jali_message(ctx), bad[i][1])) print_error("%s\n", jali_message(ctx));
        CHECK(strstr(jali_message(ctx), bad[i][1]) != NULL);
        CHECK(e.count == 0 && e.edit == NULL && e.point == NULL);
    }
}

// --- Along with the picture

static jali_picture read_pgm(int32_t w, int32_t h, int32_t x, int32_t y, const jali_read_options *read)
{
    char head[32];
    jali_picture picture;
    size_t begin = (size_t)snprintf(head, sizeof head, "P5 %d %d 255\n", w, h), count = (size_t)w * (size_t)h;
    uint8_t *bytes = calloc(begin + count, 1);
    memcpy(bytes, head, begin);
    bytes[begin + (size_t)y * (size_t)w + (size_t)x] = 255;
    CHECK_OK(jali_read_bytes(ctx, bytes, begin + count, "pgm", read, &picture));
    free(bytes);
    return picture;
}

static int32_t below(uint64_t *seed, int32_t end)
{
    return (int32_t)((next_random(seed) >> 33) % (uint64_t)end);
}

// One white pixel, and a point on its middle: however the picture is read, the point is where the pixel is.
TEST(points_go_with_their_pixels_through_crop_turn_and_mirror)
{
    uint64_t seed = 5;
    for (int32_t i = 0; i < 300; i++) {
        int32_t w = 2 + below(&seed, 30), h = 2 + below(&seed, 30), x = below(&seed, w), y = below(&seed, h);
        jali_read_options read = jali_read_defaults();
        read.quarter_turns = i % 4;
        read.mirror = i / 4 % 2;
        if (i / 8 % 2) {
            read.crop_px[0] = below(&seed, x + 1);
            read.crop_px[1] = below(&seed, y + 1);
            read.crop_px[2] = x - read.crop_px[0] + 1 + below(&seed, w - x);
            read.crop_px[3] = y - read.crop_px[1] + 1 + below(&seed, h - y);
        }
        jali_picture picture = read_pgm(w, h, x, y, &read);
        CHECK(picture.file_px[0] == w && picture.file_px[1] == h);
        double unit = 0.5 + below(&seed, 8);
        jali_edit edit = {JALI_EDIT_BRIDGE, 3, 0, 1};
        double point[1][2] = {{(x + 0.5) / unit, (y + 0.5) / unit}};
        jali_edits e = {{w / unit, h / unit}, 1, &edit, 1, point};
        CHECK_OK(jali_edits_follow(ctx, &read, picture.file_px, &e));
        CHECK(e.size[0] == picture.width_px && e.size[1] == picture.height_px);
        CHECK(fabs(edit.width - 3 * unit) < 1e-9);
        int32_t column = (int32_t)floor(point[0][0]), row = (int32_t)floor(point[0][1]);
        CHECK(column >= 0 && row >= 0 && column < picture.width_px && row < picture.height_px);
        CHECK_INT(picture.grey[row * picture.width_px + column], 255);
        jali_picture_free(ctx, &picture);
    }
}

TEST(edits_of_another_picture_are_refused)
{
    jali_edits e = read_text(GOOD);
    CHECK_STATUS(jali_edits_follow(ctx, NULL, (int32_t[]){400, 400}, &e), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "600 x 400"));
    CHECK_OK(jali_edits_follow(ctx, NULL, (int32_t[]){301, 200}, &e)); // rounded to whole pixels
    jali_edits_free(ctx, &e);
}

static jali_chart chart_of(int32_t width_px, int32_t height_px, int32_t margin_px, double pixel_mm)
{
    return (jali_chart){.width_px = width_px,
                        .height_px = height_px,
                        .margin_px = margin_px,
                        .pixel_units = 64,
                        .outside_solid = margin_px > 0,
                        .unit_mm = pixel_mm / 64};
}

// Bridges of a grid, as edits of the file, taken along again and drawn: the same pixels.
TEST(found_bridges_come_back_as_edits)
{
    uint64_t seed = 6;
    for (int32_t i = 0; i < 64; i++) {
        int32_t w = 20 + below(&seed, 40), h = 20 + below(&seed, 40);
        jali_read_options read = jali_read_defaults();
        read.quarter_turns = i % 4;
        read.mirror = i / 4 % 2;
        if (i / 8 % 2) memcpy(read.crop_px, (int32_t[]){2, 3, w - 7, h - 5}, sizeof read.crop_px);
        jali_picture picture = read_pgm(w, h, 8, 8, &read);
        jali_chart chart = chart_of(4 * picture.width_px + 30, 4 * picture.height_px + 30, 15, 0.025);
        int32_t via[2][2];
        jali_bridge bridge = {.via_count = 2};
        jali_bridges bridges = {.count = 1, .bridge = &bridge, .via_count = 2, .via = via};
        int32_t *pixel[] = {bridge.from, via[0], via[1], bridge.to};
        for (int32_t k = 0; k < 4; k++) {
            pixel[k][0] = below(&seed, chart.width_px);
            pixel[k][1] = below(&seed, chart.height_px);
        }
        jali_edits e;
        jali_marks marks;
        CHECK_OK(jali_edits_of_bridges(ctx, &bridges, &chart, 12, &picture, &read, 1, &e));
        CHECK(e.size[0] == w && e.size[1] == h && e.count == 1 && e.edit[0].count == 4);
        CHECK(fabs(e.edit[0].width - 3) < 1e-9);
        CHECK_OK(jali_edits_follow(ctx, &read, picture.file_px, &e));
        CHECK_OK(jali_edits_draw(ctx, &e, &chart, &marks));
        const jali_bridge *back = &marks.drawn.bridge[0];
        CHECK(memcmp(back->from, bridge.from, sizeof bridge.from) == 0);
        CHECK(memcmp(back->to, bridge.to, sizeof bridge.to) == 0);
        CHECK_INT(back->via_count, 2);
        CHECK(memcmp(marks.drawn.via, via, sizeof via) == 0);
        jali_edits_free(ctx, &e);
        jali_marks_free(ctx, &marks);
        jali_picture_free(ctx, &picture);
    }
}

TEST(a_region_holds_the_pixels_whose_centre_it_holds)
{
    jali_edits e =
        read_text("{\"version\": 1, \"size\": [8, 6], \"edits\": ["
                  "{\"kind\": \"lock\", \"points\": [[1, 1], [7, 1], [7, 5], [5, 5], [5, 3], [1, 3]]},"
                  "{\"kind\": \"forbid\", \"points\": [[0.5, 5.5], [2.5, 5.5]], \"width\": 1}]}");
    jali_chart chart = chart_of(8, 6, 0, 0.025);
    jali_marks marks;
    CHECK_OK(jali_edits_draw(ctx, &e, &chart, &marks));
    jali_bitmap locked = drawn_rows(8, "........"
                                       ".######."
                                       ".######."
                                       ".....##."
                                       ".....##."
                                       "........"),
                closed = drawn_rows(8, "........"
                                       ".######."
                                       ".######."
                                       ".....##."
                                       ".....##."
                                       "###.....");
    CHECK(same_bitmap(&marks.locked, &locked));
    CHECK(same_bitmap(&marks.closed, &closed));
    CHECK_INT(marks.count[JALI_EDIT_LOCK], 1);
    CHECK_INT(marks.count[JALI_EDIT_FORBID], 1);
    jali_bitmap_free(ctx, &locked);
    jali_bitmap_free(ctx, &closed);
    jali_marks_free(ctx, &marks);
    jali_edits_free(ctx, &e);
}

// --- In the image method

/// A drawing on a grid with a margin, and edits in pixels of the grid without it.
typedef struct scene {
    jali_chart chart;
    jali_bitmap drawing;
    jali_edits edits;
    jali_optimise_options opt;
} scene;

enum { MARGIN = 46 };

static void paint_disc(jali_bitmap *a, int32_t x, int32_t y, int32_t radius)
{
    for (int32_t v = MAX(y - radius, 0); v < MIN(y + radius, a->height_px); v++)
        for (int32_t u = MAX(x - radius, 0); u < MIN(x + radius, a->width_px); u++)
            if ((u - x) * (u - x) + (v - y) * (v - y) < radius * radius) jali_bitmap_set(a, u, v, true);
}

// Void in a solid margin.
static scene empty_scene(int32_t w, int32_t h, const char *edits)
{
    scene s = {.chart = chart_of(w + 2 * MARGIN, h + 2 * MARGIN, MARGIN, 0.025),
               .opt = jali_optimise_defaults()};
    s.edits = read_text(edits);
    CHECK_OK(jali_bitmap_create(ctx, s.chart.width_px, s.chart.height_px, &s.drawing));
    fill(ctx, &s.drawing, true);
    for (int32_t y = MARGIN; y < MARGIN + h; y++) paint_run(&s.drawing, y, MARGIN, MARGIN + w, false);
    return s;
}

static void scene_free(scene *s)
{
    jali_edits_free(ctx, &s->edits);
    jali_bitmap_free(ctx, &s->drawing);
    free(s->chart.metric);
}

static jali_optimised optimise(scene *s)
{
    jali_optimised r;
    s->opt.edits = &s->edits;
    s->opt.details = true;
    CHECK_OK(jali_optimise(ctx, &s->drawing, &s->chart, &s->opt, &r));
    return r;
}

static int32_t pieces_of(const jali_bitmap *a)
{
    plain p = plain_of(a);
    int32_t *label = malloc((size_t)p.w * (size_t)p.h * sizeof *label),
            count = plain_label(&p, true, 4, label);
    free(label);
    plain_free(&p);
    return count;
}

// A disc 40 px from the frame on its left: there its bridge would be. On both ways.
TEST(a_bridge_takes_another_way_where_it_is_forbidden)
{
    for (int32_t paper = 0; paper < 2; paper++) {
        scene s =
            empty_scene(300, 200,
                        "{\"version\": 1, \"size\": [300, 200], \"edits\": ["
                        "{\"kind\": \"forbid\", \"points\": [[15, 0], [25, 0], [25, 200], [15, 200]]}]}");
        paint_disc(&s.drawing, MARGIN + 80, MARGIN + 100, 40);
        s.opt.paper = paper;
        jali_optimised r = optimise(&s);
        CHECK_INT(pieces_of(&r.mask), 1);
        CHECK_INT(r.edited.left_out, 0);
        if (!paper) CHECK_INT(r.laid.count, 1);
        for (int32_t y = MARGIN; y < MARGIN + 200; y++)
            for (int32_t x = MARGIN + 15; x < MARGIN + 25; x++) {
                bool corner = y < MARGIN + 12 || y >= MARGIN + 188; // rounded
                CHECK(corner || !jali_bitmap_get(&r.mask, x, y));
            }
        CHECK(jali_bitmap_get(&r.mask, MARGIN + 80, MARGIN + 100));
        jali_optimised_free(ctx, &r);
        scene_free(&s);
    }
}

// The rest of the picture and the promises stay.
TEST(what_no_bridge_may_reach_is_left_out_and_reported)
{
    scene s = empty_scene(300, 200,
                          "{\"version\": 1, \"size\": [300, 200], \"edits\": ["
                          "{\"kind\": \"forbid\", \"points\": [[80, 60], [140, 60], [140, 140], [80, 140], "
                          "[80, 60]], \"width\": 8}]}");
    paint_disc(&s.drawing, MARGIN + 110, MARGIN + 100, 20);
    paint_disc(&s.drawing, MARGIN + 220, MARGIN + 100, 20);
    jali_optimised r = optimise(&s);
    CHECK_INT(pieces_of(&r.mask), 1);
    CHECK_INT(r.edited.left_out, 1);
    CHECK_INT(r.edited.loose, 0);
    CHECK(abs(r.edited.left_out_at[0] - MARGIN - 110) < 20 &&
          abs(r.edited.left_out_at[1] - MARGIN - 100) < 20);
    CHECK(!jali_bitmap_get(&r.mask, MARGIN + 110, MARGIN + 100));
    CHECK(jali_bitmap_get(&r.mask, MARGIN + 220, MARGIN + 100));
    jali_optimised_free(ctx, &r);
    scene_free(&s);
}

// From a disc to the frame on its far side, through what is forbidden: drawn by hand it goes.
TEST(a_drawn_bridge_stands_and_needs_no_other)
{
    for (int32_t paper = 0; paper < 2; paper++) {
        scene s =
            empty_scene(300, 200,
                        "{\"version\": 1, \"size\": [300, 200], \"edits\": ["
                        "{\"kind\": \"forbid\", \"points\": [[200, 0], [210, 0], [210, 200], [200, 200]]},"
                        "{\"kind\": \"bridge\", \"points\": [[80, 100], [190, 60], [300, 60]]}]}");
        paint_disc(&s.drawing, MARGIN + 80, MARGIN + 100, 40);
        s.opt.paper = paper;
        jali_optimised r = optimise(&s);
        CHECK_INT(pieces_of(&r.mask), 1);
        CHECK_INT(r.laid.count, 0);
        CHECK_INT(r.edited.count[JALI_EDIT_BRIDGE], 1);
        CHECK(r.bridges >= 1 && r.bridge_pixels > 0);
        for (int32_t x = 190; x < 300; x++) {
            int32_t width = 0;
            for (int32_t y = 40; y < 80; y++) width += jali_bitmap_get(&r.mask, MARGIN + x, MARGIN + y);
            CHECK(width >= r.kernels_px[1]);
            CHECK(jali_bitmap_get(&r.bridge_mask, MARGIN + x, MARGIN + 60));
        }
        for (int32_t type = JALI_TYPE_A; type <= JALI_TYPE_B; type++)
            CHECK(r.residual.white[type] == 0 && r.residual.black[type] == 0);
        jali_optimised_free(ctx, &r);
        scene_free(&s);
    }
}

TEST(a_bridge_is_as_wide_as_it_is_drawn)
{
    scene s = empty_scene(300, 200,
                          "{\"version\": 1, \"size\": [300, 200], \"edits\": ["
                          "{\"kind\": \"bridge\", \"points\": [[0, 100], [300, 100]], \"width\": 30}]}");
    jali_optimised r = optimise(&s);
    int32_t width = 0; // of the mask: the printer adds the rest
    for (int32_t y = 0; y < 200; y++) width += jali_bitmap_get(&r.mask, MARGIN + 150, MARGIN + y);
    CHECK(abs(width - (30 - (r.kernels_px[0] - 1))) <= 1);
    jali_optimised_free(ctx, &r);
    scene_free(&s);
}

// A dot and a hair that would be dropped or thickened, and an island that would be joined.
TEST(what_is_locked_stays_and_its_price_is_reported)
{
    scene s = empty_scene(300, 200,
                          "{\"version\": 1, \"size\": [300, 200], \"edits\": ["
                          "{\"kind\": \"lock\", \"points\": [[20, 20], [280, 20], [280, 180], [20, 180]]}]}");
    paint_disc(&s.drawing, MARGIN + 80, MARGIN + 100, 30);
    paint_disc(&s.drawing, MARGIN + 200, MARGIN + 60, 3);
    for (int32_t x = 120; x < 260; x++) jali_bitmap_set(&s.drawing, MARGIN + x, MARGIN + 140, true);
    jali_optimised r = optimise(&s);
    for (int32_t y = 20; y < 180; y++)
        for (int32_t x = 20; x < 280; x++)
            CHECK(jali_bitmap_get(&r.mask, MARGIN + x, MARGIN + y) ==
                  jali_bitmap_get(&s.drawing, MARGIN + x, MARGIN + y));
    CHECK_INT(r.edited.loose, 3);
    CHECK_INT(pieces_of(&r.mask), 4);
    CHECK(r.edited.locked_details >= 1);
    CHECK_INT(r.edited.locked_details, r.residual.white[JALI_TYPE_A] + r.residual.white[JALI_TYPE_B] +
                                           r.residual.black[JALI_TYPE_A] + r.residual.black[JALI_TYPE_B]);
    jali_optimised_free(ctx, &r);
    scene_free(&s);
}

// --- Any edits on any picture

static void add_point(jali_edits *e, double x, double y)
{
    e->point[e->point_count][0] = x;
    e->point[e->point_count++][1] = y;
}

static jali_edits random_edits(uint64_t *seed, int32_t w, int32_t h, bool locks)
{
    jali_edits e = {.size = {w, h}};
    int32_t count = 1 + below(seed, 6);
    CHECK_OK(ALLOCATE(ctx, e.edit, count));
    CHECK_OK(ALLOCATE(ctx, e.point, 5 * count));
    for (int32_t i = 0; i < count; i++) {
        jali_edit_kind kind = (jali_edit_kind)below(seed, locks ? 3 : 2);
        bool region = kind != JALI_EDIT_BRIDGE && below(seed, 2);
        int32_t points = (region ? 3 : 2) + below(seed, 3);
        e.edit[e.count++] = (jali_edit){kind, region ? 0 : below(seed, 30), e.point_count, points};
        if (kind != JALI_EDIT_BRIDGE && !region && e.edit[i].width == 0) e.edit[i].width = 5;
        for (int32_t k = 0; k < points; k++)
            add_point(&e, below(seed, 2 * w) - w / 2.0, below(seed, 2 * h) - h / 2.0);
    }
    return e;
}

// The pixels that bridges run over, as far as they lie on the grid.
static void draw_ways(const jali_bridges *bridges, jali_bitmap *spine)
{
    for (int32_t i = 0; i < bridges->count; i++) {
        int32_t from[2], to[2];
        for (int32_t leg = 0; jali_bridge_leg(bridges, i, leg, from, to); leg++) {
            line_walk walk = walk_line(from, to);
            do
                if (walk.x >= 0 && walk.y >= 0 && walk.x < spine->width_px && walk.y < spine->height_px)
                    jali_bitmap_set(spine, walk.x, walk.y, true);
            while (walk_on(&walk));
        }
    }
}

static void check_kept(const scene *s, const jali_optimised *r)
{
    jali_marks marks;
    jali_bitmap spine;
    CHECK_OK(jali_edits_draw(ctx, &s->edits, &s->chart, &marks));
    CHECK_OK(jali_bitmap_create(ctx, s->drawing.width_px, s->drawing.height_px, &spine));
    draw_ways(&marks.drawn, &spine);
    CHECK_INT(count_combined(ctx, RULE_AND_NOT, &spine, &r->mask), 0); // what is drawn is solid
    for (int32_t y = 0; y < spine.height_px; y++)
        for (int32_t x = 0; x < spine.width_px; x++) {
            if (!jali_bitmap_get(&marks.locked, x, y)) continue; // as drawn, and else by a drawn bridge alone
            bool was = jali_bitmap_get(&s->drawing, x, y), is = jali_bitmap_get(&r->mask, x, y);
            CHECK(is || !was);
            bool near = false;
            for (int32_t v = MAX(y - 18, 0); is && !was && !near && v < MIN(y + 19, spine.height_px); v++)
                near = count_run(&spine, v, MAX(x - 18, 0), MIN(x + 19, spine.width_px)) > 0;
            CHECK(is == was || near || jali_bitmap_get(&marks.wide, x, y));
        }
    jali_bitmap_free(ctx, &spine);
    jali_marks_free(ctx, &marks);
}

// One piece but for what is locked or drawn, widths but for what is locked.
static void check_promises(const jali_optimised *r)
{
    CHECK_INT(pieces_of(&r->mask), 1 + r->edited.loose);
    int32_t below_widths = 0;
    for (int32_t type = JALI_TYPE_A; type <= JALI_TYPE_B; type++)
        below_widths += r->residual.white[type] + r->residual.black[type];
    CHECK_INT(below_widths, r->edited.locked_details);
}

// Longer across from left to right, up to twice.
static void stretch(jali_chart *chart)
{
    enum { STEP = 16 };
    chart->metric_step_px = STEP;
    chart->metric_columns = (chart->width_px + STEP - 1) / STEP;
    chart->metric_rows = (chart->height_px + STEP - 1) / STEP;
    chart->metric =
        malloc(sizeof *chart->metric * (size_t)chart->metric_columns * (size_t)chart->metric_rows);
    for (int32_t j = 0; j < chart->metric_rows; j++)
        for (int32_t i = 0; i < chart->metric_columns; i++) {
            float longer = 1 + (float)i / (float)chart->metric_columns;
            memcpy(chart->metric[j * chart->metric_columns + i], (float[]){1, 0, longer * longer},
                   3 * sizeof(float));
        }
}

static void check_random_edits(uint64_t seed, bool paper, bool locks, bool curved)
{
    int32_t w = 100 + below(&seed, 100), h = 80 + below(&seed, 60), grain = 2 + below(&seed, 12);
    scene s = empty_scene(w, h, "{\"version\": 1, \"size\": [1, 1], \"edits\": []}");
    jali_bitmap blobs = random_blobs(&seed, w, h, grain, 10 + below(&seed, 60));
    paste(ctx, &blobs, MARGIN, MARGIN, &s.drawing);
    jali_bitmap_free(ctx, &blobs);
    jali_edits_free(ctx, &s.edits);
    s.edits = random_edits(&seed, w, h, locks);
    s.opt.paper = paper;
    if (curved) stretch(&s.chart);
    s.opt.edits = &s.edits;
    jali_optimised r;
    jali_status status = jali_optimise(ctx, &s.drawing, &s.chart, &s.opt, &r);
    if (status == JALI_OK) {
        check_promises(&r);
        check_kept(&s, &r);
    } else {
        CHECK_INT(status, JALI_NO_RESULT);
    }
    jali_optimised_free(ctx, &r);
    scene_free(&s);
}

#ifdef __SANITIZE_ADDRESS__
enum { SEEDS = 25 };
#else
enum { SEEDS = 120 };
#endif

TEST(promises_hold_with_any_edits)
{
    for (uint64_t seed = 1; seed <= SEEDS; seed++)
        for (int32_t way = 0; way < 4; way++) check_random_edits(seed, way & 1, way & 2, false);
}

TEST(promises_hold_with_any_edits_on_a_curved_surface)
{
    for (uint64_t seed = 1; seed <= SEEDS / 2; seed++)
        for (int32_t locks = 0; locks < 2; locks++) check_random_edits(1000 + seed, false, locks, true);
}

// Discs far from each other, so that nothing is thickened: no stroke covers what is forbidden. (Corners
// between strokes may, rounded as wide as voids must be.)
TEST(no_bridge_lies_on_what_is_forbidden)
{
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        uint64_t random = seed * 77;
        scene s = empty_scene(400, 300, "{\"version\": 1, \"size\": [1, 1], \"edits\": []}");
        for (int32_t y = 50; y < 300; y += 100)
            for (int32_t x = 50; x < 400; x += 100)
                if (below(&random, 3))
                    paint_disc(&s.drawing, MARGIN + x, MARGIN + y, 10 + below(&random, 12));
        jali_edits_free(ctx, &s.edits);
        s.edits = random_edits(&random, 400, 300, false);
        for (int32_t i = 0; i < s.edits.count; i++) {
            s.edits.edit[i].kind = JALI_EDIT_FORBID;
            if (s.edits.edit[i].width == 0) s.edits.edit[i].width = s.edits.edit[i].count < 3 ? 6 : 0;
        }
        jali_optimised r = optimise(&s);
        jali_marks marks;
        jali_bitmap strokes, spine;
        element stroke = {0};
        CHECK_OK(jali_edits_draw(ctx, &s.edits, &s.chart, &marks));
        CHECK_OK(jali_bitmap_create(ctx, s.drawing.width_px, s.drawing.height_px, &spine));
        CHECK_OK(jali_bitmap_create(ctx, s.drawing.width_px, s.drawing.height_px, &strokes));
        CHECK_OK(element_disc(ctx, r.kernels_px[1], &stroke));
        draw_ways(&r.laid, &spine);
        CHECK_OK(dilate(ctx, &spine, &stroke, false, &strokes));
        combine(ctx, RULE_AND_NOT, &marks.closed, &s.drawing, &marks.closed);
        CHECK_INT(count_combined(ctx, RULE_AND, &marks.closed, &strokes), 0);
        CHECK_INT(pieces_of(&r.mask), 1);
        element_free(ctx, &stroke);
        jali_bitmap_free(ctx, &spine);
        jali_bitmap_free(ctx, &strokes);
        jali_marks_free(ctx, &marks);
        jali_optimised_free(ctx, &r);
        scene_free(&s);
    }
}

// Found bridges drawn where they lie: the same print, and none is found any more.
TEST(a_pinned_bridge_takes_the_place_of_the_one_found)
{
    scene s = empty_scene(300, 200, "{\"version\": 1, \"size\": [300, 200], \"edits\": []}");
    paint_disc(&s.drawing, MARGIN + 90, MARGIN + 90, 30);
    paint_disc(&s.drawing, MARGIN + 200, MARGIN + 120, 25);
    jali_optimised found = optimise(&s), pinned;
    jali_picture picture = {.width_px = 300, .height_px = 200};
    CHECK_INT(found.laid.count, 2);
    jali_edits_free(ctx, &s.edits);
    CHECK_OK(
        jali_edits_of_bridges(ctx, &found.laid, &s.chart, found.kernels_px[1], &picture, NULL, 1, &s.edits));
    CHECK_INT(s.edits.count, 2);
    pinned = optimise(&s);
    CHECK_INT(pinned.laid.count, 0);
    CHECK_INT(pinned.bridges, 2);
    int64_t apart = count_combined(ctx, RULE_XOR, &found.mask, &pinned.mask);
    CHECK(apart < found.bridge_pixels / 4); // corners are rounded at another time
    jali_optimised_free(ctx, &found);
    jali_optimised_free(ctx, &pinned);
    scene_free(&s);
}

TEST(connectors_keep_off_what_is_forbidden)
{
    scene s = empty_scene(300, 200,
                          "{\"version\": 1, \"size\": [300, 200], \"edits\": ["
                          "{\"kind\": \"forbid\", \"points\": [[100, 0], [100, 200]], \"width\": 6}]}");
    jali_optimised r = optimise(&s);
    jali_bitmap blocked;
    jali_bridge bridge[2] = {{.from = {MARGIN + 50, MARGIN - 8}, .to = {MARGIN + 50, MARGIN + 207}},
                             {.from = {MARGIN - 8, MARGIN + 50}, .to = {MARGIN + 307, MARGIN + 50}}};
    jali_bridges bridges = {.count = 2, .bridge = bridge};
    CHECK_OK(jali_optimise_blocked(ctx, &s.chart, &s.opt, &r, &blocked));
    CHECK(jali_bitmap_get(&blocked, MARGIN + 100, MARGIN + 100));
    CHECK(!jali_bitmap_get(&blocked, MARGIN + 50, MARGIN + 100));
    CHECK_OK(jali_optimise_add(ctx, &bridges, &s.chart, &s.opt, &r));
    CHECK_INT(r.laid.count, 1);
    CHECK(jali_bitmap_get(&r.mask, MARGIN + 50, MARGIN + 100));
    CHECK(!jali_bitmap_get(&r.mask, MARGIN + 100, MARGIN + 50));
    jali_bitmap_free(ctx, &blocked);
    jali_optimised_free(ctx, &r);
    scene_free(&s);
}

// --- Through the whole pipeline

static jali_picture two_discs(void)
{
    jali_picture picture = {.width_px = 200, .height_px = 100};
    CHECK_OK(ALLOCATE_CLEARED(ctx, picture.grey, 200 * 100));
    for (int32_t y = 0; y < 100; y++)
        for (int32_t x = 0; x < 200; x++) {
            int32_t dx = x % 100 - 50, dy = y - 50;
            if (dx * dx + dy * dy < 30 * 30) picture.grey[y * 200 + x] = 255;
        }
    return picture;
}

// Locked through nudging and reinforcing, on each of three copies; any number of threads.
TEST(edits_hold_through_the_whole_pipeline)
{
    jali_context *by_threads[3];
    open_thread_contexts(by_threads);
    jali_picture picture = two_discs();
    jali_edits edits = read_text("{\"version\": 1, \"size\": [200, 100], \"edits\": ["
                                 "{\"kind\": \"lock\", \"points\": [[30, 20], [70, 20], [70, 45], [30, 45]]},"
                                 "{\"kind\": \"bridge\", \"points\": [[50, 50], [50, 100]], \"width\": 4},"
                                 "{\"kind\": \"forbid\", \"points\": [[85, 50], [115, 50]], \"width\": 8}]}");
    jali_options opt = jali_defaults();
    opt.place.width_mm = 8;
    opt.repeat = 3;
    opt.nudge_rounds = 2;
    opt.check = false;
    opt.optimise.edits = &edits;
    opt.structure = true;
    opt.strengthen.analyse.load.force_n = 5;
    opt.strengthen.across = 1;
    jali_result r[3];
    for (int32_t i = 0; i < 3; i++) {
        CHECK_INT(jali_make(by_threads[i], &picture, &opt, &r[i]), JALI_OK);
        CHECK(same_bitmap(&r[i].optimised.mask, &r[0].optimised.mask));
        CHECK_INT(r[i].optimised.laid.count, r[0].optimised.laid.count);
    }
    const jali_chart *chart = &r[0].chart;
    CHECK(r[0].one_piece && r[0].printable);
    CHECK_INT(r[0].optimised.edited.count[JALI_EDIT_LOCK], 3);
    for (int32_t y = 0; y < chart->height_px; y++)
        for (int32_t x = 0; x < chart->width_px; x++) {
            int32_t u = jali_input_column(chart, 600, x, 1) % 200, v = jali_input_row(chart, 100, y, 1);
            if (u >= 42 && u < 58 && v >= 30 && v < 44) CHECK(jali_bitmap_get(&r[0].optimised.mask, x, y));
            if (u >= 49 && u < 51 && v >= 81) CHECK(jali_bitmap_get(&r[0].optimised.mask, x, y));
            if (u >= 86 && u < 114 && v >= 48 && v < 52) CHECK(!jali_bitmap_get(&r[0].optimised.mask, x, y));
        }
    for (int32_t i = 0; i < 3; i++) jali_result_free(by_threads[i], &r[i]);
    jali_edits_free(ctx, &edits);
    jali_picture_free(ctx, &picture);
    close_thread_contexts(by_threads);
}

// --- Memory

static jali_status read_and_write(jali_context *limited, void *data)
{
    jali_status status;
    jali_edits e = {0}, row = {0};
    jali_bytes json = {0};
    (void)data;
    TRY(jali_edits_read_bytes(limited, (const uint8_t *)GOOD, strlen(GOOD), "edits", &e));
    TRY(jali_edits_repeat(limited, &e, 3, &row));
    CHECK_INT(row.count, 9);
    TRY(jali_edits_write(limited, &row, &json));
done:
    jali_edits_free(limited, &e);
    jali_edits_free(limited, &row);
    jali_bytes_free(limited, &json);
    return status;
}

static jali_status optimise_limited(jali_context *limited, void *data)
{
    scene *s = data;
    jali_optimised r;
    jali_status status = jali_optimise(limited, &s->drawing, &s->chart, &s->opt, &r);
    if (status != JALI_OK) CHECK(r.mask.word == NULL && r.laid.bridge == NULL);
    jali_optimised_free(limited, &r);
    return status;
}

TEST(every_allocation_refused_once)
{
    refuse_each_allocation(read_and_write, NULL);
    for (int32_t paper = 0; paper < 2; paper++) {
        scene s = empty_scene(70, 60,
                              "{\"version\": 1, \"size\": [70, 60], \"edits\": ["
                              "{\"kind\": \"forbid\", \"points\": [[0, 30], [12, 30]], \"width\": 30},"
                              "{\"kind\": \"bridge\", \"points\": [[50, 30], [70, 30]], \"width\": 14},"
                              "{\"kind\": \"lock\", \"points\": [[20, 40], [30, 40], [30, 50]]}]}");
        paint_disc(&s.drawing, MARGIN + 30, MARGIN + 20, 9);
        s.opt.edits = &s.edits;
        s.opt.paper = paper;
        refuse_each_allocation(optimise_limited, &s);
        scene_free(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edits_are_read_as_they_stand),
        cmocka_unit_test(what_is_written_reads_back_the_same),
        cmocka_unit_test(bad_files_are_a_sentence_that_says_where),
        cmocka_unit_test(points_go_with_their_pixels_through_crop_turn_and_mirror),
        cmocka_unit_test(edits_of_another_picture_are_refused),
        cmocka_unit_test(found_bridges_come_back_as_edits),
        cmocka_unit_test(a_region_holds_the_pixels_whose_centre_it_holds),
        cmocka_unit_test(a_bridge_takes_another_way_where_it_is_forbidden),
        cmocka_unit_test(what_no_bridge_may_reach_is_left_out_and_reported),
        cmocka_unit_test(a_drawn_bridge_stands_and_needs_no_other),
        cmocka_unit_test(a_bridge_is_as_wide_as_it_is_drawn),
        cmocka_unit_test(what_is_locked_stays_and_its_price_is_reported),
        cmocka_unit_test(promises_hold_with_any_edits),
        cmocka_unit_test(promises_hold_with_any_edits_on_a_curved_surface),
        cmocka_unit_test(no_bridge_lies_on_what_is_forbidden),
        cmocka_unit_test(a_pinned_bridge_takes_the_place_of_the_one_found),
        cmocka_unit_test(connectors_keep_off_what_is_forbidden),
        cmocka_unit_test(edits_hold_through_the_whole_pipeline),
        cmocka_unit_test(every_allocation_refused_once),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
