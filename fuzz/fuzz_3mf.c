// Any bytes as 3MF. Half of the inputs are an archive as they are; the rest is packed into one as its model,
// since a mutated archive rarely passes its checksums.
#include "model.h"

#include "write/zip.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size >= 4 && memcmp(data, "PK\3\4", 4) == 0) return fuzz_model(data, size, JALI_FORMAT_3MF);
    jali_context *ctx;
    jali_bytes archive = {0};
    zip_writer zip = {0};
    jali_context_options opt = jali_context_defaults();
    opt.threads = 1;
    REQUIRE(jali_context_create(&opt, &ctx) == JALI_OK);
    REQUIRE(zip_add(ctx, &zip, "3D/3dmodel.model", data, size, 1, &archive) == JALI_OK);
    REQUIRE(zip_finish(ctx, &zip, &archive) == JALI_OK);
    int result = fuzz_model(archive.data, archive.size, JALI_FORMAT_3MF);
    jali_bytes_free(ctx, &archive);
    jali_context_free(ctx);
    return result;
}
