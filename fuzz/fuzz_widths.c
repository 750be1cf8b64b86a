// Fuzzer of tables and lists of widths, and of the fit.
#include <jali/calibrate.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void require(bool truth, const char *what)
{
    if (truth) return;
    fprintf(stderr, "broken: %s\n", what);
    abort();
}

static void require_fitted(const jali_fitted *f)
{
    require(f->kept >= 0 && f->kept <= f->measured, "no more is kept than was measured");
    require(f->kept == 0 || f->measured >= 3, "three are needed");
    require(isfinite(f->value) && isfinite(f->spread) && f->spread >= 0, "figures are numbers");
}

static void require_limit(const jali_limit *l, const jali_widths *w, jali_board_kind bar,
                          jali_board_kind pair)
{
    require(l->bounded == (l->found && l->lost_mm > 0), "bounded");
    for (size_t i = 0; i < w->count; i++) {
        const jali_width *one = &w->width[i];
        if (one->kind != bar && one->kind != pair) continue;
        if (l->found && one->designed_mm >= l->value_mm)
            require(one->measured_mm > 0, "all wider ones printed");
        if (one->measured_mm == 0) require(one->designed_mm <= l->lost_mm, "what is lost is known");
    }
}

static void calibrate(jali_context *ctx, const jali_widths *w)
{
    jali_calibration c;
    jali_printer printer = {0};
    jali_bytes text = {0};
    if (jali_calibrate(ctx, w, &c) != JALI_OK) {
        require(strlen(jali_message(ctx)) > 0, "a refusal has a sentence");
        return;
    }
    require_fitted(&c.phi_e_solid);
    require_fitted(&c.phi_e_void);
    require_fitted(&c.hole);
    require_fitted(&c.pin);
    require_limit(&c.phi_s, w, JALI_BOARD_SOLID, JALI_BOARD_SOLID_PAIR);
    require_limit(&c.phi_v, w, JALI_BOARD_VOID, JALI_BOARD_VOID_PAIR);
    require(jali_calibration_sentences(ctx, &c, &text) == JALI_OK, "sentences");
    if (jali_calibration_apply(ctx, &c, "fuzz", &printer) == JALI_OK)
        require(*printer.phi_s_mm.source && *printer.phi_e_void_mm.source, "a profile says all it needs");
    else
        require(strlen(jali_message(ctx)) > 0 && !*printer.phi_s_mm.source, "a refusal leaves the profile");
    jali_bytes_free(ctx, &text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    jali_context_options own = jali_context_defaults();
    jali_context *ctx;
    jali_widths widths = {0};
    char list[4096];
    own.threads = 1;
    own.max_memory_bytes = 256 << 20;
    if (jali_context_create(&own, &ctx) != JALI_OK) return 0;
    if (jali_widths_read(ctx, data, size, "fuzz", &widths) == JALI_OK) {
        require(widths.count > 0, "a table has widths");
        for (size_t i = 0; i < widths.count; i++)
            require(widths.width[i].designed_mm > 0 && widths.width[i].measured_mm >= 0 &&
                        widths.width[i].line > 0,
                    "widths are lengths");
    } else {
        require(widths.count == 0 && strlen(jali_message(ctx)) > 0, "a refusal has a sentence and no widths");
        size_t length = size < sizeof list ? size : sizeof list - 1;
        memcpy(list, data, length);
        list[length] = 0;
        if (jali_widths_parse(ctx, list, &widths) != JALI_OK)
            require(widths.count == 0 && strlen(jali_message(ctx)) > 0, "a refused list leaves nothing");
    }
    calibrate(ctx, &widths);
    jali_widths_free(ctx, &widths);
    jali_context_free(ctx);
    return 0;
}
