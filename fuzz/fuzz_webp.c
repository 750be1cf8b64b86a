// Fuzzer of the WebP reader.
#include "pictures.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_reader(data, size, "RIFF", 4);
}
