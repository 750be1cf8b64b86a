// Any bytes as STL: refused with a sentence, or a sound mesh that survives being written as 3MF.
#include "model.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return size >= 2 && memcmp(data, "PK", 2) == 0 ? -1 : fuzz_model(data, size, JALI_FORMAT_3MF);
}
