// Any bytes as OBJ (others are passed over): refused with a sentence, or a sound mesh that survives being
// written.
#include "model.h"

#include "mesh/readers.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const model_file file = {.data = (const char *)data, .size = size};
    return looks_like_obj(&file) && !is_binary_stl(&file) ? fuzz_model(data, size, JALI_FORMAT_3MF) : -1;
}
