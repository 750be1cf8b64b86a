// Runs a fuzzer's check over files, without libFuzzer: the committed corpus is a test of every build.
//
//     replay_NAME FILE...
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST_BYTES = 1 << 20 };

int main(int argc, char **argv)
{
    uint8_t *data = malloc(MOST_BYTES);
    int failed = argc < 2 || !data; // an empty corpus tests nothing
    for (int i = 1; i < argc && !failed; i++) {
        FILE *file = fopen(argv[i], "rb");
        if (!file) {
            fprintf(stderr, "cannot open %s\n", argv[i]);
            failed = 1;
            break;
        }
        size_t size = fread(data, 1, MOST_BYTES, file);
        fclose(file);
        printf("%s\n", argv[i]); // the last one named is the one that aborts
        fflush(stdout);
        LLVMFuzzerTestOneInput(data, size);
    }
    free(data);
    return failed;
}
