/*
 * run/completion.h: what a shell needs to complete a tool's options, made from the table of options:
 * `TOOL --completion bash` and `TOOL --completion zsh` print it, and `make install` keeps it.
 */
#pragma once

#include "run/cli.h"

/* To stdout; false: no such shell. */
bool completion_print(const char *shell);
