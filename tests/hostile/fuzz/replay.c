/* replay FILE ...: a fuzz target on kept inputs, a time each, without libFuzzer. */
#include "fuzz.h"

#include <stdlib.h>

int main(int argc, char **argv)
{
    for (int k = 1; k < argc; k++) {
        FILE *f = fopen(argv[k], "rb");
        static uint8_t bytes[1 << 21];
        if (!f) return perror(argv[k]), 66;
        size_t size = fread(bytes, 1, sizeof bytes, f);
        fclose(f);
        uint8_t *exactly = malloc(size + !size); // so that a read behind its end is seen
        if (!exactly) return 70;
        for (size_t i = 0; i < size; i++) exactly[i] = bytes[i];
        LLVMFuzzerTestOneInput(exactly, size);
        free(exactly);
    }
    printf("%s: %d inputs\n", argv[0], argc - 1);
    return 0;
}
