// G-code, with what tests/test_gcode.c holds of any print.
#include "print.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    jali_context *ctx = fuzz_context();
    jali_print print;
    jali_print_options opt = jali_print_defaults();
    opt.pixel_mm = 1; // beds of some metres stay small
    require_print(ctx, jali_print_gcode_bytes(ctx, data, size, "print", &opt, &print), &print);
    jali_print_free(ctx, &print);
    jali_context_free(ctx);
    return 0;
}
