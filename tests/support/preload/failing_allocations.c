/*
 * Preloaded: allocation number NSD_FAIL_AT fails, of those asked for by the tool itself (NSD_FAIL_IN
 * is "tool") or by its libraries ("library"); a child goes on counting where its parent stood. With
 * NSD_COUNT the number of allocations goes to that file. NSD_TOOL_END is where the tool's own code ends in
 * its file and that of archives begins, in hexadecimal; empty: they are shared libraries.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *__libc_malloc(size_t size);               // NOLINT(bugprone-reserved-identifier)
void *__libc_calloc(size_t count, size_t size); // NOLINT(bugprone-reserved-identifier)
void *__libc_realloc(void *old, size_t size);   // NOLINT(bugprone-reserved-identifier)

static atomic_long count;
static long fail_at;
static bool on, in_tool;
static uintptr_t tool_first, tool_end; /* where its code is */

static int look_at(struct dl_phdr_info *info, size_t size, void *data)
{
    (void)size, (void)data;
    for (int k = 0; k < info->dlpi_phnum; k++) {
        if (info->dlpi_phdr[k].p_type != PT_LOAD || !(info->dlpi_phdr[k].p_flags & PF_X)) continue;
        tool_first = info->dlpi_addr + info->dlpi_phdr[k].p_vaddr;
        tool_end = tool_first + info->dlpi_phdr[k].p_memsz;
        const char *end = getenv("NSD_TOOL_END");
        if (end && *end) tool_end = info->dlpi_addr + strtoul(end, NULL, 16);
    }
    return 1; // the first is the program itself
}

__attribute__((constructor)) static void start(void)
{
    const char *at = getenv("NSD_FAIL_AT");
    fail_at = at ? atol(at) : 0;
    const char *in = getenv("NSD_FAIL_IN");
    in_tool = in && !strcmp(in, "tool");
    dl_iterate_phdr(look_at, NULL);
    on = true;
}

/* What the compiler adds at the end (gcov's counts) is not the tool's. */
static void end(void)
{
    on = false;
}

/* So the reading process says that only counts are left. */
int malloc_trim(size_t pad)
{
    (void)pad;
    end();
    return 0;
}

static bool fails(const void *caller)
{
    uintptr_t at = (uintptr_t)caller;
    static atomic_flag begun = ATOMIC_FLAG_INIT;
    if (on && at >= tool_first && at < tool_end && !atomic_flag_test_and_set(&begun))
        atexit(end); // before the destructors, for main() has begun
    if (!on || (at >= tool_first && at < tool_end) != in_tool) return false;
    if (atomic_fetch_add(&count, 1) + 1 != fail_at) return false;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_malloc(size);
}

void *calloc(size_t number, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_calloc(number, size);
}

void *realloc(void *old, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_realloc(old, size);
}

__attribute__((destructor)) static void tell(void)
{
    const char *path = getenv("NSD_COUNT");
    char text[32];
    int fd = path ? open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
    int n = snprintf(text, sizeof text, "%ld\n", (long)count);
    if (fd >= 0 && write(fd, text, (size_t)n) == n) close(fd);
}
