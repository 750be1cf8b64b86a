// Fuzzer of edits by hand: the file, and what the image method makes of it.
#include <jali/jali.h>

#include <stdlib.h>
#include <string.h>

#define REQUIRE(condition)                                                                                   \
    do {                                                                                                     \
        if (!(condition)) abort();                                                                           \
    } while (0)

enum { WIDE = 90, HIGH = 60 };

// Two discs and a bar on void, no frame.
static void draw(jali_context *ctx, jali_bitmap *drawing)
{
    REQUIRE(jali_bitmap_create(ctx, WIDE, HIGH, drawing) == JALI_OK);
    for (int32_t y = 0; y < HIGH; y++)
        for (int32_t x = 0; x < WIDE; x++) {
            int32_t dx = x % 45 - 22, dy = y - 25;
            jali_bitmap_set(drawing, x, y, dx * dx + dy * dy < 180 || y > 52);
        }
}

static void check_optimised(jali_context *ctx, const jali_edits *edits)
{
    jali_bitmap drawing;
    jali_marks marks;
    jali_optimised r;
    jali_chart chart = {.width_px = WIDE, .height_px = HIGH, .pixel_units = 64, .unit_mm = 0.025 / 64};
    jali_optimise_options opt = jali_optimise_defaults();
    opt.edits = edits;
    draw(ctx, &drawing);
    REQUIRE(jali_edits_draw(ctx, edits, &chart, &marks) == JALI_OK);
    jali_status status = jali_optimise(ctx, &drawing, &chart, &opt, &r);
    REQUIRE(status == JALI_OK || status == JALI_NO_RESULT);
    for (int32_t y = 0; status == JALI_OK && y < HIGH; y++)
        for (int32_t x = 0; x < WIDE; x++)
            if (jali_bitmap_get(&marks.locked, x, y) && jali_bitmap_get(&drawing, x, y))
                REQUIRE(jali_bitmap_get(&r.mask, x, y));
    jali_optimised_free(ctx, &r);
    jali_marks_free(ctx, &marks);
    jali_bitmap_free(ctx, &drawing);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    jali_context *ctx;
    jali_edits edits, again;
    jali_bytes json = {0}, twice = {0};
    jali_context_options opt = jali_context_defaults();
    opt.threads = 1;
    REQUIRE(jali_context_create(&opt, &ctx) == JALI_OK);
    jali_status status = jali_edits_read_bytes(ctx, data, size, "fuzzed.json", &edits);
    if (status != JALI_OK) {
        REQUIRE(status == JALI_BAD_INPUT && *jali_message(ctx));
        REQUIRE(edits.count == 0 && !edits.edit && !edits.point);
    } else {
        REQUIRE(jali_edits_write(ctx, &edits, &json) == JALI_OK);
        REQUIRE(jali_edits_read_bytes(ctx, json.data, json.size, "again.json", &again) == JALI_OK);
        REQUIRE(jali_edits_write(ctx, &again, &twice) == JALI_OK);
        REQUIRE(json.size == twice.size && memcmp(json.data, twice.data, json.size) == 0);
        jali_edits_free(ctx, &again);
        jali_read_options read = jali_read_defaults();
        read.quarter_turns = (int32_t)(size % 4);
        read.mirror = size / 4 % 2;
        bool across = size % 2;
        status =
            jali_edits_follow(ctx, &read, (int32_t[]){across ? HIGH : WIDE, across ? WIDE : HIGH}, &edits);
        REQUIRE(status == JALI_OK || (status == JALI_BAD_INPUT && *jali_message(ctx)));
        if (status == JALI_OK && edits.count > 0) check_optimised(ctx, &edits);
    }
    jali_edits_free(ctx, &edits);
    jali_bytes_free(ctx, &json);
    jali_bytes_free(ctx, &twice);
    jali_context_free(ctx);
    return 0;
}
