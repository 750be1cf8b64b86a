// Fuzzer of scans: bytes as a small grey picture, or as what is done to a board that was printed,
// photographed and then soiled, covered and cropped.
#include "print.h"

// What draws the pictures is not what is searched.
#ifdef __clang__
#pragma clang attribute push(__attribute__((no_sanitize("coverage", "address"))), apply_to = function)
#endif
#include "printed.h"
#ifdef __clang__
#pragma clang attribute pop
#endif

#include <jali/calibrate.h>

enum { MOST_SIDE = 200, MOST_SPOTS = 32, SPOT_BYTES = 6, MOST_BOARD_PX = 640 };

// The bytes, one after the other; 0 beyond their end.
typedef struct source {
    const uint8_t *data;
    size_t size;
} source;

static uint8_t byte_of(source *s)
{
    if (s->size == 0) return 0;
    s->size--;
    return *s->data++;
}

static double share_of(source *s)
{
    return byte_of(s) / 255.0;
}

// What the bytes are, row by row, repeated.
static jali_picture picture_of_bytes(source *s)
{
    int32_t width = 1 + byte_of(s) % MOST_SIDE, height = 1 + byte_of(s) % MOST_SIDE;
    jali_picture p = {.width_px = width, .height_px = height, .grey = malloc((size_t)width * (size_t)height)};
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        p.grey[i] = s->size > 0 ? s->data[i % s->size] : 0;
    return p;
}

// The board that all are printed from, at first use.
static const printed *drawn_board(jali_context *ctx)
{
    static jali_board board;
    static jali_bitmap plate;
    static printed p;
    double pixel_mm = 0.1;
    jali_board_options opt = jali_board_defaults();
    if (p.board) return &p;
    opt.phi_s_mm = opt.phi_v_mm = 1;
    REQUIRE(jali_board_layout(ctx, &opt, &board) == JALI_OK);
    REQUIRE(jali_board_bitmap(ctx, &board, &pixel_mm, &plate) == JALI_OK);
    p = (printed){.board = &board, .plate = &plate, .plate_pixel_mm = pixel_mm};
    return &p;
}

static void soil(source *s, jali_picture *p)
{
    for (int32_t n = 0; n < MOST_SPOTS && s->size >= SPOT_BYTES; n++) {
        int32_t x0 = byte_of(s) * p->width_px / 256, y0 = byte_of(s) * p->height_px / 256;
        int32_t x1 = x0 + byte_of(s) * p->width_px / 512, y1 = y0 + byte_of(s) * p->height_px / 512;
        uint8_t way = byte_of(s), level = byte_of(s);
        for (int32_t y = y0; y <= y1 && y < p->height_px; y++)
            for (int32_t x = x0; x <= x1 && x < p->width_px; x++) {
                uint8_t *at = &p->grey[(size_t)y * (size_t)p->width_px + (size_t)x];
                if (way % 4 == 0) *at = level;
                if (way % 4 == 1) *at = (uint8_t)(*at ^ level);
                if (way % 4 == 2) *at = (uint8_t)((*at + level) / 2);
                if (way % 4 == 3) *at = (uint8_t)(255 - *at);
            }
    }
}

static jali_picture picture_of_board(jali_context *ctx, source *s)
{
    printed p = *drawn_board(ctx);
    p.e_solid = 0.6 * share_of(s) - 0.2;
    p.e_void = 0.6 * share_of(s) - 0.2;
    p.phi_s = 3 * share_of(s);
    p.phi_v = 3 * share_of(s);
    p.corner_mm = share_of(s);
    look l = {.px_per_mm = 2.6 + share_of(s), .seed = 1, .mirrored = byte_of(s) % 2};
    l.width = (int32_t)((p.board->width_mm + 12) * l.px_per_mm);
    l.height = (int32_t)((p.board->height_mm + 12) * l.px_per_mm);
    l.turn = 0.1 * share_of(s);
    l.tilt[0] = 0.2 * share_of(s);
    l.lens = 0.02 * share_of(s);
    l.solid = share_of(s);
    l.through = share_of(s);
    l.light[0] = share_of(s);
    l.blur_px = 3 * share_of(s);
    l.noise = 0.1 * share_of(s);
    REQUIRE(l.width <= MOST_BOARD_PX * 2 && l.height <= MOST_BOARD_PX * 2);
    jali_picture picture = looked_at(&p, &l);
    int32_t kept = picture.height_px - byte_of(s) / 4 * picture.height_px / 128; // half of it may be missing
    picture.height_px = kept;
    soil(s, &picture);
    return picture;
}

static void require_scan(const jali_picture *p, const jali_scan *scan)
{
    REQUIRE(scan->feature && scan->board.feature_count > 0);
    REQUIRE(scan->pixel_mm > 0 && scan->blur_mm >= 0 && isfinite(scan->blur_mm));
    REQUIRE(scan->contrast >= 0.1 && scan->contrast <= 1.5);
    REQUIRE(scan->residual_mm >= 0 && scan->residual_mm <= 0.12);
    REQUIRE(scan->corner_mm >= 0 && isfinite(scan->corner_mm) && scan->corners >= 0);
    for (int i = 0; i < 9; i++) REQUIRE(isfinite(scan->map[i]));
    for (int32_t i = 0; i < scan->board.feature_count; i++) {
        const jali_board_feature *f = &scan->board.feature[i];
        const jali_measured *m = &scan->feature[i];
        const double *h = scan->map;
        double w = h[6] * f->at_mm[0] + h[7] * f->at_mm[1] + h[8];
        double x = (h[0] * f->at_mm[0] + h[1] * f->at_mm[1] + h[2]) / w;
        double y = (h[3] * f->at_mm[0] + h[4] * f->at_mm[1] + h[5]) / w;
        REQUIRE(x > 0 && y > 0 && x < p->width_px && y < p->height_px);
        REQUIRE(isfinite(m->width_mm) && isfinite(m->off_mm[0]) && isfinite(m->off_mm[1]));
        REQUIRE(m->spread_mm >= 0 && isfinite(m->spread_mm));
        REQUIRE(!m->printed || m->width_mm > 0);
    }
}

static void require_fitted(const jali_fitted *f)
{
    REQUIRE(f->kept >= 0 && f->kept <= f->measured);
    REQUIRE(isfinite(f->value) && f->spread >= 0 && isfinite(f->spread));
    REQUIRE(f->error_mm >= 0 && isfinite(f->error_mm) && (f->doubtful || 2 * f->error_mm <= 0.02));
}

// Figures and a profile that says all it needs, or a sentence.
static void require_profile(jali_context *ctx, const jali_scan *scan)
{
    jali_widths widths = {0};
    jali_calibration c;
    jali_printer printer = {0};
    REQUIRE(jali_scan_widths(ctx, scan, &widths) == JALI_OK);
    REQUIRE(widths.count == (size_t)scan->board.feature_count);
    if (jali_calibrate(ctx, &widths, &c) == JALI_OK) {
        require_fitted(&c.phi_e_solid);
        require_fitted(&c.phi_e_void);
        require_fitted(&c.pin);
        REQUIRE(isfinite(c.hole.value) && c.hole.value >= 0);
        if (jali_calibration_apply(ctx, &c, "fuzz", &printer) == JALI_OK) {
            REQUIRE(printer.phi_s_mm.value > 0 && printer.phi_v_mm.value > 0);
            REQUIRE(printer.phi_v_mm.value > printer.phi_e_void_mm.value);
        } else {
            REQUIRE(strlen(jali_message(ctx)) > 0);
        }
    } else {
        REQUIRE(strlen(jali_message(ctx)) > 0);
    }
    jali_widths_free(ctx, &widths);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    source s = {data, size};
    jali_context *ctx = fuzz_context();
    uint8_t way = byte_of(&s);
    bool board = way % 4 != 0, drawn = way & 64; // the map of what was measured takes longer than the rest
    jali_picture p = board ? picture_of_board(ctx, &s) : picture_of_bytes(&s);
    jali_scan_options opt = {.board = board && way & 128 ? drawn_board(ctx)->board : NULL};
    jali_scan scan;
    jali_bytes png = {0};
    jali_status status = jali_scan_board(ctx, &p, &opt, &scan);
    if (status == JALI_OK) {
        require_scan(&p, &scan);
        require_profile(ctx, &scan);
        REQUIRE(!drawn || (jali_scan_map(ctx, &p, &scan, &png) == JALI_OK && png.size > 0));
    } else {
        REQUIRE(status == JALI_NO_RESULT || status == JALI_NO_MEMORY || status == JALI_LIMIT);
        REQUIRE(strlen(jali_message(ctx)) > 0 && !scan.feature && scan.board.feature_count == 0);
    }
    jali_bytes_free(ctx, &png);
    jali_scan_free(ctx, &scan);
    free(p.grey);
    jali_context_free(ctx);
    return 0;
}
