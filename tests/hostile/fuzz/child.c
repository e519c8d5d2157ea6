/* In the reading process libhdf5 may break down: libFuzzer shall not take that for its own crash. */
#include <pthread.h>
#include <signal.h>
#include <stddef.h>

void __sanitizer_set_death_callback(void (*callback)(void)); // NOLINT(bugprone-reserved-identifier)

static void in_child(void)
{
    static const int signals[] = { SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM, SIGXCPU };
    for (size_t k = 0; k < sizeof signals / sizeof signals[0]; k++) signal(signals[k], SIG_DFL);
    __sanitizer_set_death_callback(NULL);
}

__attribute__((constructor)) static void start(void)
{
    pthread_atfork(NULL, NULL, in_child);
}
