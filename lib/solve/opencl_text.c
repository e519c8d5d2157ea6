/* solve/opencl_text.c: the assembler takes the files in as they are [solve/opencl_text.h]. */
#include "solve/opencl_text.h"

#include <stdlib.h>
#include <string.h>

#define EACH_TEXT(X)                                                                               \
    X(begin, "lib/problem/opencl/begin.cl")                                                        \
    X(lanes, "lib/base/lanes.h")                                                                   \
    X(local, "lib/solve/local.h")                                                                    \
    X(sbp, "lib/solve/local_sbp.h")                                                                  \
    X(sal, "lib/solve/local_sal.h")                                                                  \
    X(exact, "lib/solve/local_exact.h")                                                              \
    X(newton, "lib/solve/local_newton.h")                                                            \
    X(ebp, "lib/solve/local_ebp.h")                                                                  \
    X(eal, "lib/solve/local_eal.h")                                                                  \
    X(bundle, "lib/solve/bundle.h")                                                              \
    X(kernels, "lib/problem/opencl/kernels.cl")

#define TAKE_IN(name, file)                                                                        \
    __asm__(".section .rodata\n.hidden nsd_cl_" #name "\n.globl nsd_cl_" #name "\nnsd_cl_" #name   \
            ":\n.incbin \"" file "\"\n.byte 0\n.previous\n");                                      \
    extern const char nsd_cl_##name[];
EACH_TEXT(TAKE_IN)

#define TEXT(name, file) nsd_cl_##name,
static const char *const texts[] = { EACH_TEXT(TEXT) };
enum { TEXTS = sizeof texts / sizeof *texts };

/* Appends a text but for its includes, whose lines stay, empty. */
static char *opencl_api_append(char *to, const char *text)
{
    while (*text) {
        size_t n = strcspn(text, "\n");
        if (strncmp(text, "#include", 8)) memcpy(to, text, n), to += n;
        *to++ = '\n';
        text += n + (text[n] == '\n');
    }
    return to;
}

char *opencl_text(void)
{
    size_t size = 1;
    for (int k = 0; k < TEXTS; k++) size += strlen(texts[k]) + 1;
    char *all = malloc(size), *end = all;
    for (int k = 0; all && k < TEXTS; k++) end = opencl_api_append(end, texts[k]);
    if (all) *end = 0;
    return all;
}
