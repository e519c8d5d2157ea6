#include "run/completion.h"

#include <stdio.h>
#include <string.h>

static bool is_flag(const struct cli_option *o)
{
    return o->kind == CLI_FLAG || o->kind == CLI_UNFLAG;
}

/* Calls each for all options of the tool. */
static void for_each(void (*each)(const struct cli_option *))
{
    const struct cli_option *o;
    for (int k = 0; (o = cli_option_at(k)); k++) each(o);
}

static void completion_words(const struct cli_option *o)
{
    for (int k = 0; o->choice(k).name; k++) printf("%s%s", k ? " " : "", o->choice(k).name);
}

/* The tool's name as a shell function's: nsd_step */
static void function_name(void)
{
    for (const char *c = tool.name; *c; c++) putchar(*c == '-' ? '_' : *c);
}

/* ---- bash ---- */

/* A case of `case $previous in`: what follows an option that takes an argument. Files are bash's own. */
static void bash_argument(const struct cli_option *o)
{
    if (is_flag(o)) return;
    printf("    ");
    if (o->letter) printf("-%c | ", o->letter);
    printf("--%s) ", o->name);
    if (o->choice) {
        printf("words='");
        completion_words(o);
        printf("' ;;\n");
    } else {
        printf(o->kind == CLI_TEXT ? "return ;;\n" : "compopt +o default; return ;;\n");
    }
}

static void bash_name(const struct cli_option *o)
{
    printf(" --%s", o->name);
    if (o->letter) printf(" -%c", o->letter);
}

static void bash(void)
{
    printf("# bash completion of %s, made by %s --completion bash\n_", tool.name, tool.name);
    function_name();
    printf("()\n{\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} words=\n"
           "    COMPREPLY=()\n"
           "    # --option=word comes in three pieces\n"
           "    if [[ $word = = ]]; then word=\n"
           "    elif [[ $previous = = ]]; then previous=${COMP_WORDS[COMP_CWORD-2]}; fi\n"
           "    case $previous in\n");
    for_each(bash_argument);
    printf("    *) [[ $word = -* ]] || return\n       words='");
    for_each(bash_name);
    printf("' ;;\n    esac\n    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}\n"
           "complete -o default -F _");
    function_name();
    printf(" %s\n", tool.name);
}

/* ---- zsh ---- */

/* Within single quotes and a description of _arguments */
static void zsh_text(const char *text)
{
    for (; *text; text++) {
        if (*text == '\'')
            printf("'\\''");
        else if (strchr("[]:\\", *text))
            printf("\\%c", *text);
        else
            putchar(*text);
    }
}

static void zsh_option(const struct cli_option *o)
{
    printf(" \\\n    ");
    if (o->letter)
        printf("'(-%c --%s)'{-%c,--%s%s}'[", o->letter, o->name, o->letter, o->name,
               is_flag(o) ? "" : "=");
    else
        printf("'--%s%s[", o->name, is_flag(o) ? "" : "=");
    zsh_text(o->help);
    printf("]");
    if (!is_flag(o)) {
        printf(":%s:", o->arg ? o->arg : o->name);
        if (o->choice) {
            printf("(");
            completion_words(o);
            printf(")");
        } else if (o->kind == CLI_TEXT) {
            printf("_files");
        }
    }
    printf("'");
}

static void zsh(void)
{
    printf("#compdef %s\n# zsh completion, made by %s --completion zsh\n_arguments -s -S",
           tool.name, tool.name);
    for_each(zsh_option);
    printf(" \\\n    '*:file:_files'\n");
}

bool completion_print(const char *shell)
{
    bool is_bash = !strcmp(shell, "bash");
    if (!is_bash && strcmp(shell, "zsh") != 0) return false;
    is_bash ? bash() : zsh();
    return true;
}
