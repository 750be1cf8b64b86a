// The picture readers: every type against a formula in floating point; every prefix, bombs, refusals;
// thresholds.
#include "pictures.h"
#include "base/file.h"

#include <math.h>
#include <jali/png.h>
#include <jali/read.h>

static jali_picture picture;

static jali_status read_made(jali_context *with)
{
    return jali_read_bytes(with, file.bytes, file.size, "made", NULL, &picture);
}

static uint8_t grey_at(int32_t x, int32_t y)
{
    return picture.grey[(int64_t)y * picture.width_px + x];
}

static void check_kind(const png_kind *k)
{
    make_png(k);
    CHECK_OK(read_made(ctx));
    CHECK(picture.width_px == k->width && picture.height_px == k->height);
    for (int32_t y = 0; y < k->height; y++)
        for (int32_t x = 0; x < k->width; x++)
            if (fabs(grey_at(x, y) - grey_of(k, x, y)) > 1.01) {
                print_error("depth %d type %d interlaced %d transparent %d (%d, %d): %d, not %g\n", k->depth,
                            k->type, k->interlaced, k->transparent, x, y, grey_at(x, y), grey_of(k, x, y));
                CHECK(false);
            }
    jali_picture_free(ctx, &picture);
}

static bool valid_png(int depth, int type)
{
    if (type == PNG_COLOR_TYPE_GRAY) return true;
    if (type == PNG_COLOR_TYPE_PALETTE) return depth <= 8;
    return depth >= 8;
}

TEST(png_of_every_depth_and_type)
{
    static const int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_PALETTE, PNG_COLOR_TYPE_RGB,
                                PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGBA};
    static const int32_t sizes[][2] = {{1, 1}, {2, 3}, {7, 5}, {8, 8}, {33, 17}, {64, 40}};
    for (int32_t t = 0; t < 5; t++)
        for (int depth = 1; depth <= 16; depth *= 2)
            for (int32_t i = 0; i < 24; i++) {
                png_kind k = {sizes[i / 4][0], sizes[i / 4][1], depth, types[t], i & 1, i & 2};
                bool has_alpha = types[t] & PNG_COLOR_MASK_ALPHA;
                if (valid_png(depth, types[t]) && !(has_alpha && k.transparent)) check_kind(&k);
            }
}

// A file that ends early ends in a sentence, wherever it ends.
static void check_every_prefix(void)
{
    size_t whole = file.size;
    CHECK_OK(read_made(ctx));
    jali_picture_free(ctx, &picture);
    for (file.size = 0; file.size < whole; file.size++) {
        CHECK_STATUS(read_made(ctx), JALI_BAD_INPUT);
        CHECK(strlen(jali_message(ctx)) > 10 && picture.grey == NULL);
    }
}

// A file with one byte changed is read or refused, nothing else.
static void check_every_byte_changed(void)
{
    for (size_t i = 0; i < file.size; i++)
        for (int32_t bit = 0; bit < 8; bit += 3) {
            file.bytes[i] ^= (uint8_t)(1 << bit);
            jali_status status = read_made(ctx);
            CHECK(status == JALI_OK || status == JALI_BAD_INPUT);
            CHECK(status != JALI_OK || picture.grey != NULL);
            jali_picture_free(ctx, &picture);
            file.bytes[i] ^= (uint8_t)(1 << bit);
        }
}

TEST(prefixes_and_changed_bytes_of_png)
{
    png_kind kinds[] = {{13, 9, 1, PNG_COLOR_TYPE_GRAY, false, true},
                        {13, 9, 4, PNG_COLOR_TYPE_PALETTE, true, true},
                        {9, 9, 16, PNG_COLOR_TYPE_RGBA, true, false}};
    for (int32_t i = 0; i < 3; i++) {
        make_png(&kinds[i]);
        check_every_prefix();
        make_png(&kinds[i]);
        check_every_byte_changed();
    }
}

static void check_halves(int32_t tolerance, bool alpha)
{
    int32_t width = picture.width_px, height = picture.height_px;
    for (int32_t y = 4; y < height - 4; y += 7)
        for (int32_t x = 4; x < width - 4; x += 5) {
            int32_t wanted = y < height / 4 ? 40 : x < width / 2 ? 220 : 120;
            if (abs(x - width / 2) < 12 || abs(y - height / 4) < 12) continue;
            if (alpha && (x + 4) % 16 < 8) continue;
            if (alpha && x % 32 < 16) wanted = 255;
            CHECK(abs(grey_at(x, y) - wanted) <= tolerance);
        }
}

TEST(jpeg_grey_colour_inks_and_progressive)
{
    for (int32_t i = 0; i < 6; i++) {
        static const int32_t channels[] = {1, 3, 4};
        make_jpeg(101, 90, channels[i / 2], i % 2, 0);
        CHECK_OK(read_made(ctx));
        CHECK(picture.width_px == 101 && picture.height_px == 90);
        check_halves(3, false);
        jali_picture_free(ctx, &picture);
    }
}

// Where the dark top quarter of the stored picture stands once it is upright, and where the light half.
TEST(jpeg_stands_as_exif_says)
{
    enum { TOP, RIGHT, BOTTOM, LEFT };
    static const int32_t dark_side[9] = {0, TOP, TOP, BOTTOM, BOTTOM, LEFT, RIGHT, RIGHT, LEFT};
    static const int32_t light_side[9] = {0, LEFT, RIGHT, RIGHT, LEFT, TOP, TOP, BOTTOM, BOTTOM};
    for (int32_t orientation = 1; orientation <= 8; orientation++) {
        make_jpeg(96, 64, 1, false, orientation);
        CHECK_OK(read_made(ctx));
        CHECK_INT(picture.width_px, orientation < 5 ? 96 : 64);
        int32_t w = picture.width_px, h = picture.height_px;
        int32_t edge[4][2] = {{w / 2, 4}, {w - 5, h / 2}, {w / 2, h - 5}, {4, h / 2}};
        int32_t *dark = edge[dark_side[orientation]], *light = edge[light_side[orientation]];
        CHECK(grey_at(dark[0], dark[1]) < 60);
        // the light side's edge middle may touch the dark quarter: go towards the far side of the dark one
        int32_t lx = light[0] + (light[0] == w / 2 ? (dark[0] < w / 2 ? w / 4 : -w / 4) : 0);
        int32_t ly = light[1] + (light[1] == h / 2 ? (dark[1] < h / 2 ? h / 4 : -h / 4) : 0);
        CHECK(grey_at(lx, ly) > 200);
        jali_picture_free(ctx, &picture);
    }
}

TEST(prefixes_and_changed_bytes_of_jpeg)
{
    for (int32_t progressive = 0; progressive < 2; progressive++) {
        make_jpeg(24, 16, 3, progressive, 6);
        size_t whole = file.size;
        check_every_prefix();
        file.size = whole;
        check_every_byte_changed();
    }
}

TEST(webp_lossy_lossless_and_alpha)
{
    for (int32_t i = 0; i < 4; i++) {
        make_webp(120, 96, i & 1, i & 2);
        CHECK_OK(read_made(ctx));
        check_halves(i & 1 ? 0 : 4, i & 2);
        jali_picture_free(ctx, &picture);
        make_webp(20, 12, i & 1, i & 2);
        size_t whole = file.size;
        check_every_prefix();
        file.size = whole;
        check_every_byte_changed();
    }
}

static void make_text(const char *text, size_t size)
{
    memcpy(file.bytes, text, size);
    file.size = size;
}
#define MAKE(text) make_text(text, sizeof(text) - 1)

static void check_greys(const uint8_t *wanted, int32_t count)
{
    CHECK_OK(read_made(ctx));
    CHECK_INT(picture.width_px * picture.height_px, count);
    for (int32_t i = 0; i < count; i++) CHECK_INT(picture.grey[i], wanted[i]);
    jali_picture_free(ctx, &picture);
}
#define GREYS(...) check_greys((uint8_t[]){__VA_ARGS__}, sizeof((uint8_t[]){__VA_ARGS__}))

TEST(pnm_plain_and_raw)
{
    MAKE("P1\n# a comment\n3 2\n101 0 1 0\n");
    GREYS(0, 255, 0, 255, 0, 255);
    MAKE("P2 2 2 15 0 15 # end\n 5 10\n");
    GREYS(0, 255, 85, 170);
    MAKE("P3 1 2 1 1 1 1 0 1 0");
    GREYS(255, 182);
    MAKE("P3 1 2 255 255 0 0 0 0 255 ");
    GREYS(54, 18);
    MAKE("P4 10 2\n\x80\x40\x00\xc0");
    GREYS(0, 255, 255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0);
    MAKE("P5 3 1 255\n\x00\x80\xff");
    GREYS(0, 128, 255);
    MAKE("P5 2 1 65535\n\x00\x80\xff\xff");
    GREYS(0, 255);
    MAKE("P5 2 1 1000\n\x01\xf4\x03\xe8");
    GREYS(128, 255);
    MAKE("P6 1 1 255\n\xff\x00\x00");
    GREYS(54);
    MAKE("P6 1 1 65535\n\x00\x00\xff\xff\x00\x00");
    GREYS(182);
}

TEST(pnm_refusals)
{
    static const char *const bad[] = {
        "P1 2 2 10 1",           "P1 2 2 1012",     "P2 1 1 255",     "P2 1 1 255 256 ",
        "P2 1 1 0 0 ",           "P2 1 1 65536 0 ", "P5 2 2 255 abc", "P5 x 2 255 ab",
        "P5 -1 2 255 ab",        "P4 0 3 ",         "P6 1 1 255x",    "P5 1 1",
        "P2 999999999999 1 3 1 "};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        make_text(bad[i], strlen(bad[i]));
        if (read_made(ctx) != JALI_BAD_INPUT) print_error("%s\n", bad[i]);
        CHECK_STATUS(read_made(ctx), JALI_BAD_INPUT);
    }
    MAKE("P3 2 2 9 1 2 3 4 5 6 7 8 9 1 2 3");
    file.size = sizeof "P3 2 2 9 1 2 3 4 5 6 7 8 9 1 2 " - 1;
    check_every_byte_changed();
}

static uint32_t crc_of(const uint8_t *bytes, size_t size)
{
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int32_t bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

// A header that promises more than its file can hold is refused before memory is taken for it.
TEST(bombs_are_refused_by_their_header)
{
    jali_context_options opt = jali_context_defaults();
    opt.max_memory_bytes = 64 << 20;
    jali_context *small;
    CHECK_INT(jali_context_create(&opt, &small), JALI_OK);
    png_kind k = {8, 8, 1, PNG_COLOR_TYPE_GRAY, false, false};
    static const uint8_t sizes[][2] = {{0, 0}, {0xff, 0x00}, {0x7f, 0xff}, {0x01, 0x00}};
    static const uint32_t ihdr_at = 16;
    for (int32_t i = 0; i < 4; i++) {
        make_png(&k);
        file.bytes[ihdr_at + 1] = sizes[i][0]; // 0xff0000: too wide; 0x7fff00 too
        file.bytes[ihdr_at + 2] = sizes[i][1];
        file.bytes[ihdr_at + 6] = 0xff;
        uint32_t crc = crc_of(file.bytes + ihdr_at - 4, 17);
        for (int32_t b = 0; b < 4; b++) file.bytes[ihdr_at + 13 + b] = (uint8_t)(crc >> (24 - 8 * b));
        CHECK_INT(read_made(small), JALI_BAD_INPUT);
        CHECK(jali_peak_memory_bytes(small) < 1 << 20);
    }
    MAKE("P4 65000 8000 ");
    CHECK_INT(read_made(small), JALI_BAD_INPUT);
    MAKE("P5 99999999 99999999 255 ");
    CHECK_INT(read_made(small), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(small), "65500 px a side"));
    jali_read_options limited = jali_read_defaults();
    limited.max_px = 63;
    make_png(&k);
    CHECK_INT(jali_read_bytes(small, file.bytes, file.size, "made", &limited, &picture), JALI_BAD_INPUT);
    jali_context_free(small);
}

TEST(crop_turn_mirror_and_invert)
{
    jali_read_options opt = jali_read_defaults();
    MAKE("P2 3 2 255 1 2 3 4 5 6 ");
    opt.quarter_turns = 1;
    opt.crop_px[0] = 1, opt.crop_px[2] = 2, opt.crop_px[3] = 2; // 2 3 / 5 6, turned: 5 2 / 6 3
    opt.mirror = true;                                          // 2 5 / 3 6
    opt.invert = true;
    CHECK_OK(jali_read_bytes(ctx, file.bytes, file.size, "made", &opt, &picture));
    CHECK(grey_at(0, 0) == 253 && grey_at(1, 0) == 250 && grey_at(0, 1) == 252 && grey_at(1, 1) == 249);
    jali_picture_free(ctx, &picture);
    opt.crop_px[2] = 3;
    CHECK_STATUS(jali_read_bytes(ctx, file.bytes, file.size, "made", &opt, &picture), JALI_BAD_VALUE);
    CHECK(strstr(jali_message(ctx), "3 x 2 px"));
}

static jali_picture greys(int32_t width, int32_t height)
{
    jali_picture p = {.width_px = width, .height_px = height};
    CHECK_OK(ALLOCATE(ctx, p.grey, width * height));
    return p;
}

TEST(otsu_splits_two_heaps_in_the_middle)
{
    int32_t threshold;
    jali_picture p = greys(100, 100);
    for (int32_t i = 0; i < 10000; i++) p.grey[i] = (uint8_t)(i % 5 == 0 ? 180 + i % 7 : 60 + i % 9);
    CHECK_OK(jali_threshold(ctx, &p, NULL, &threshold));
    CHECK(abs(threshold - (183 + 64) / 2) <= 2);
    for (int32_t i = 0; i < 10000; i++) p.grey[i] = i % 3 == 0 ? 255 : 0;
    CHECK_OK(jali_threshold(ctx, &p, NULL, &threshold));
    CHECK_INT(threshold, 128);
    jali_picture_free(ctx, &p);
}

TEST(levels_are_counted_and_say_where_auto_falls)
{
    int32_t threshold;
    jali_levels levels;
    jali_picture p = greys(70, 50);
    for (int32_t i = 0; i < 3500; i++) p.grey[i] = (uint8_t)(i < 1000 ? 30 : i < 1200 ? 31 : 220);
    CHECK_OK(jali_count_levels(ctx, &p, &levels));
    CHECK_OK(jali_threshold(ctx, &p, NULL, &threshold));
    CHECK_INT(levels.automatic, threshold);
    for (int32_t v = 0; v < 256; v++)
        CHECK_INT(levels.count[v], v == 30 ? 1000 : v == 31 ? 200 : v == 220 ? 2300 : 0);
    memset(p.grey, 9, 3500);
    CHECK_OK(jali_count_levels(ctx, &p, &levels));
    CHECK_INT(levels.automatic, 0);
    CHECK_INT(levels.count[9], 3500);
    jali_picture_free(ctx, &p);
}

TEST(one_tone_is_refused_and_the_sentence_helps)
{
    int32_t threshold;
    jali_threshold_options opt = {.method = JALI_THRESHOLD_FIXED, .level = 200};
    jali_picture p = greys(4, 4);
    memset(p.grey, 100, 16);
    CHECK_STATUS(jali_threshold(ctx, &p, NULL, &threshold), JALI_BAD_INPUT);
    p.grey[3] = 120;
    CHECK_STATUS(jali_threshold(ctx, &p, &opt, &threshold), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "all black at threshold 200; at 101 .. 120"));
    opt.level = 110;
    CHECK_OK(jali_threshold(ctx, &p, &opt, &threshold));
    CHECK_INT(threshold, 110);
    opt.level = 256;
    CHECK_STATUS(jali_threshold(ctx, &p, &opt, &threshold), JALI_BAD_VALUE);
    jali_picture_free(ctx, &p);
}

// Dark lines on a sheet lit from one side: no single level separates them, the local one does.
TEST(local_threshold_follows_the_light)
{
    enum { SIDE = 300 };
    int32_t threshold, wrong[2] = {0, 0};
    for (int32_t method = 0; method < 2; method++) {
        jali_picture p = greys(SIDE, SIDE);
        for (int32_t y = 0; y < SIDE; y++)
            for (int32_t x = 0; x < SIDE; x++)
                p.grey[y * SIDE + x] = (uint8_t)((x % 20 < 4 ? 40 : 90) * (1 + x / 200.0));
        jali_threshold_options opt = jali_threshold_defaults();
        if (method) opt.method = JALI_THRESHOLD_LOCAL;
        CHECK_OK(jali_threshold(ctx, &p, &opt, &threshold));
        for (int32_t i = 0; i < SIDE * SIDE; i++)
            wrong[method] += (p.grey[i] >= threshold) != (i % SIDE % 20 >= 4);
        jali_picture_free(ctx, &p);
    }
    CHECK(wrong[0] > 3000 && wrong[1] == 0);
}

// The sliding sums against the definition, and the same bytes for any number of threads.
TEST(local_threshold_is_its_definition)
{
    enum { WIDTH = 70, HEIGHT = 333, RADIUS = 8 };
    int32_t threshold;
    uint64_t seed = 5;
    jali_picture p = greys(WIDTH, HEIGHT), source = greys(WIDTH, HEIGHT);
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
        p.grey[i] = source.grey[i] = (uint8_t)(next_random(&seed) >> 56);
    jali_threshold_options opt = {JALI_THRESHOLD_LOCAL, 0, 2 * RADIUS + 1, 0.3};
    CHECK_OK(jali_threshold(ctx, &p, &opt, &threshold));
    for (int32_t y = 0; y < HEIGHT; y += 3)
        for (int32_t x = 0; x < WIDTH; x++) {
            double count = 0, sum = 0, square = 0;
            for (int32_t v = MAX(y - RADIUS, 0); v <= MIN(y + RADIUS, HEIGHT - 1); v++)
                for (int32_t u = MAX(x - RADIUS, 0); u <= MIN(x + RADIUS, WIDTH - 1); u++) {
                    double grey = source.grey[v * WIDTH + u];
                    count++, sum += grey, square += grey * grey;
                }
            double mean = sum / count,
                   level = mean * (1 + 0.3 * (sqrt(square / count - mean * mean) / 128 - 1));
            double distance = floor(128 + source.grey[y * WIDTH + x] - level);
            CHECK(fabs(p.grey[y * WIDTH + x] - MIN(MAX(distance, 0), 255)) <= 1);
        }
    jali_picture_free(ctx, &p);
    jali_picture_free(ctx, &source);
}

TEST(a_written_bitmap_is_read_back)
{
    uint64_t seed = 3;
    for (int32_t width = 1; width <= 200; width += 1 + width / 20) {
        jali_bitmap bitmap = random_bitmap(&seed, width, 11, 40);
        jali_bytes png = {0};
        CHECK_OK(jali_bitmap_png(ctx, &bitmap, 0.05, &png));
        CHECK_OK(jali_read_bytes(ctx, png.data, png.size, "made", NULL, &picture));
        for (int32_t y = 0; y < 11; y++)
            for (int32_t x = 0; x < width; x++)
                CHECK_INT(grey_at(x, y), jali_bitmap_get(&bitmap, x, y) ? 255 : 0);
        jali_picture_free(ctx, &picture);
        jali_bytes_free(ctx, &png);
        jali_bitmap_free(ctx, &bitmap);
    }
}

TEST(written_greys_are_read_back)
{
    uint64_t seed = 8;
    for (int32_t width = 1; width <= 90; width += 1 + width / 7) {
        jali_picture grey = greys(width, 9);
        jali_bytes png = {0};
        for (int32_t i = 0; i < 9 * width; i++) grey.grey[i] = (uint8_t)(next_random(&seed) >> 56);
        CHECK_OK(jali_grey_png(ctx, width, 9, grey.grey, &png));
        CHECK_OK(jali_read_bytes(ctx, png.data, png.size, "made", NULL, &picture));
        CHECK_INT(picture.width_px, width);
        CHECK(memcmp(picture.grey, grey.grey, 9 * (size_t)width) == 0);
        jali_picture_free(ctx, &picture);
        jali_picture_free(ctx, &grey);
        jali_bytes_free(ctx, &png);
    }
}

static jali_status read_and_threshold(jali_context *limited, void *data)
{
    int32_t threshold;
    jali_levels levels;
    jali_read_options opt = jali_read_defaults();
    jali_threshold_options local = {JALI_THRESHOLD_LOCAL, 0, 5, 0.2};
    (void)data;
    opt.quarter_turns = 1;
    jali_status status = jali_read_bytes(limited, file.bytes, file.size, "made", &opt, &picture);
    if (status == JALI_OK) status = jali_count_levels(limited, &picture, &levels);
    if (status == JALI_OK) status = jali_threshold(limited, &picture, &local, &threshold);
    jali_picture_free(limited, &picture);
    return status;
}

static jali_status write_png(jali_context *limited, void *bitmap)
{
    jali_bytes png = {0};
    jali_status status = jali_bitmap_png(limited, bitmap, 0.1, &png);
    jali_bytes_free(limited, &png);
    return status;
}

TEST(each_allocation_may_be_refused)
{
    for (int32_t interlaced = 0; interlaced < 2; interlaced++) {
        png_kind k = {20, 10, 8, PNG_COLOR_TYPE_RGB, interlaced, false};
        make_png(&k);
        refuse_each_allocation(read_and_threshold, NULL);
    }
    make_jpeg(40, 40, 3, true, 1);
    refuse_each_allocation(read_and_threshold, NULL);
    make_webp(40, 40, true, true);
    refuse_each_allocation(read_and_threshold, NULL);
    MAKE("P2 3 2 255 1 2 3 4 5 6 ");
    refuse_each_allocation(read_and_threshold, NULL);
    uint64_t seed = 3;
    jali_bitmap bitmap = random_bitmap(&seed, 100, 50, 50);
    refuse_each_allocation(write_png, &bitmap);
    jali_bitmap_free(ctx, &bitmap);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(png_of_every_depth_and_type),
        CASE(prefixes_and_changed_bytes_of_png),
        CASE(jpeg_grey_colour_inks_and_progressive),
        CASE(jpeg_stands_as_exif_says),
        CASE(prefixes_and_changed_bytes_of_jpeg),
        CASE(webp_lossy_lossless_and_alpha),
        CASE(pnm_plain_and_raw),
        CASE(pnm_refusals),
        CASE(bombs_are_refused_by_their_header),
        CASE(crop_turn_mirror_and_invert),
        CASE(otsu_splits_two_heaps_in_the_middle),
        CASE(levels_are_counted_and_say_where_auto_falls),
        CASE(one_tone_is_refused_and_the_sentence_helps),
        CASE(local_threshold_follows_the_light),
        CASE(local_threshold_is_its_definition),
        CASE(a_written_bitmap_is_read_back),
        CASE(written_greys_are_read_back),
        CASE(each_allocation_may_be_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
