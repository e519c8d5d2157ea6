/* run/main.c: the only main(), of every tool; the tool itself is in tool_main(). */
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): on_exit
#include "file/reader.h"
#include "run/cli.h"
#include "run/completion.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/*
 * A standard descriptor that the caller has closed must not become the next file that we open. It
 * is /dev/null instead, opened the wrong way round: reading stdin and writing to stdout then fail.
 */
static void guard_standard_descriptors(void)
{
    const int mode[3] = { O_WRONLY, O_RDONLY, O_RDWR };
    for (int fd = 0; fd < 3; fd++)
        if (fcntl(fd, F_GETFD) == -1 && errno == EBADF && open("/dev/null", mode[fd]) != fd)
            _exit(70);
}

/* jansson leaves out what it has no memory for, and hardly anybody looks: the tool ends instead. */
static void *json_memory(size_t size)
{
    void *memory = malloc(size);
    if (!memory) die(EX_SOFTWARE, "no memory");
    return memory;
}

/* --completion SHELL, for make install: not among the options, whose abbreviations it would change */
static int completion(const char *shell)
{
    if (!completion_print(shell)) die_usage("--completion: bash or zsh");
    finish_stdout();
    return 0;
}

/* libhdf5 ends the program with 255 where it has no memory to begin with. No tool of ours does. */
static void on_end(int status, void *unused)
{
    static const char text[] = ": no memory (libhdf5 gave up)\n";
    (void)unused;
    if ((status & 0xff) != 255) return;
    ssize_t said = write(STDERR_FILENO, tool.name, strlen(tool.name));
    said += write(STDERR_FILENO, text, sizeof text - 1);
    _exit(said ? EX_SOFTWARE : EX_IOERR);
}

int main(int argc, char **argv)
{
    on_exit(on_end, NULL); // after all others
    guard_standard_descriptors();
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_IGN); // a file that may not grow is said as a full disk is: EFBIG
    json_set_alloc_funcs(json_memory, free);
    if (argc == 3 && !strcmp(argv[1], "--completion")) return completion(argv[2]);
    int first = cli_parse(argc, argv);
    if (cli_output() && reader_reads(argc - first, argv + first, cli_output()))
        die_usage("%s: is also the input", cli_output());
    return tool_main(argc - first, argv + first);
}
