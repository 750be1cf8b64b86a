// SL1: bytes as an archive; what is none is packed into one as its settings, beside a layer, so that they are
// reached past the checksums.
#include "print.h"

#include <jali/png.h>
#include "write/zip.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void wrap(jali_context *ctx, const uint8_t *data, size_t size, jali_bytes *archive)
{
    jali_bitmap layer = {0};
    jali_bytes png = {0};
    zip_writer zip = {0};
    REQUIRE(jali_bitmap_create(ctx, 8, 8, &layer) == JALI_OK);
    jali_bitmap_set(&layer, 3, 4, true);
    REQUIRE(jali_bitmap_png(ctx, &layer, 0, &png) == JALI_OK);
    REQUIRE(zip_add(ctx, &zip, "0.png", png.data, png.size, 0, archive) == JALI_OK);
    if (size > 3 && data[0] == 0x89) // a layer of its own
        REQUIRE(zip_add(ctx, &zip, "1.png", data, size, 0, archive) == JALI_OK);
    else
        REQUIRE(zip_add(ctx, &zip, "prusaslicer.ini", data, size, 0, archive) == JALI_OK);
    REQUIRE(zip_finish(ctx, &zip, archive) == JALI_OK);
    jali_bytes_free(ctx, &png);
    jali_bitmap_free(ctx, &layer);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    jali_context *ctx = fuzz_context();
    jali_bytes archive = {0};
    jali_print print;
    bool zipped = size >= 4 && memcmp(data, "PK\3\4", 4) == 0;
    if (!zipped) wrap(ctx, data, size, &archive);
    require_print(ctx,
                  jali_print_sl1_bytes(ctx, zipped ? data : archive.data, zipped ? size : archive.size,
                                       "print", NULL, &print),
                  &print);
    jali_print_free(ctx, &print);
    jali_bytes_free(ctx, &archive);
    jali_context_free(ctx);
    return 0;
}
