// Fuzzer of printer profiles: ours, PrusaSlicer's, Orca's.
#include <jali/printer.h>

#include <stdlib.h>
#include <string.h>

#define REQUIRE(condition)                                                                                   \
    do {                                                                                                     \
        if (!(condition)) abort();                                                                           \
    } while (0)

// What it inherits may be a file, and some never end.
static bool names_a_file(const uint8_t *data, size_t size)
{
    return memmem(data, size, "/", 1) && memmem(data, size, "inherits", 8);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const jali_printer nothing;
    jali_context *ctx;
    jali_printer printer, again;
    jali_bytes json = {0}, twice = {0};
    if (names_a_file(data, size)) return 0;
    jali_context_options opt = jali_context_defaults();
    opt.threads = 1;
    REQUIRE(jali_context_create(&opt, &ctx) == JALI_OK);
    jali_status status = jali_printer_read(ctx, data, size, "fuzzed.json", NULL, &printer);
    if (status != JALI_OK) {
        REQUIRE(status == JALI_BAD_INPUT || status == JALI_BAD_VALUE || status == JALI_IO);
        REQUIRE(*jali_message(ctx) && memcmp(&printer, &nothing, sizeof printer) == 0);
    } else { // a profile that was read is one that can be written, and reads back as the same
        REQUIRE(*printer.name && printer.phi_s_mm.value > 0 && printer.phi_v_mm.value > 0);
        REQUIRE(jali_printer_write(ctx, &printer, &json) == JALI_OK);
        REQUIRE(jali_printer_read(ctx, json.data, json.size, "again.json", NULL, &again) == JALI_OK);
        REQUIRE(memcmp(&printer, &again, sizeof printer) == 0);
        REQUIRE(jali_printer_write(ctx, &again, &twice) == JALI_OK);
        REQUIRE(json.size == twice.size && memcmp(json.data, twice.data, json.size) == 0);
    }
    jali_bytes_free(ctx, &json);
    jali_bytes_free(ctx, &twice);
    jali_context_free(ctx);
    return 0;
}
