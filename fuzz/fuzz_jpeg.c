// Fuzzer of the JPEG reader.
#include "pictures.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_reader(data, size, "\xff\xd8\xff", 3);
}
