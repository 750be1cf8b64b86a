// Fuzzer of the PNG reader.
#include "pictures.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_reader(data, size, "\x89PNG\r\n\x1a\n", 8);
}
