// Fuzzer of the PBM, PGM and PPM reader.
#include "pictures.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_reader(data, size, "P", 1);
}
