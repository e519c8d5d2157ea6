"""The options of nsd-fit, which need Python alone."""
from __future__ import annotations

import argparse
import difflib
import os
import re
import sys
from typing import NoReturn

HELP = """usage: nsd-fit [OPTION ...] PROBLEM.json

Finds the parameters of a scene with which a command repeats measurements: it runs the
command for sets of parameters, keeps each in a table, and ends with the best values, their
90 % intervals and what the targets cannot determine. The same command line continues a run
that was stopped.

  -j, --jobs N                  run N evaluations at a time [number of processors]
  -n, --evaluations N           stop after N evaluations [of PROBLEM.json, or 60 per parameter]
  -o, --output FOLDER           write into FOLDER, and continue the run in it [PROBLEM.fit]
      --timeout T               end an evaluation after T of real time: 90 or 90s, 10min [never]
      --quiet                   write no progress

  -h, --help                    print this text
  -V, --version                 print the version

Examples:
  nsd-fit -j 2 drum.json && jq .parameters drum.fit/result.json

The manual: man nsd-fit, man 7 nsd
"""


def completion(shell: str) -> str:
    """For bash or zsh, made from HELP."""
    found = re.findall(r"^ {2}(?:-(\w), |    )--([a-z]+)(?: ([A-Z]+))? +(.*)$", HELP, re.M)
    if shell == "bash":
        words = " ".join(f"--{name}" for _, name, _, _ in found)
        return ("# bash completion of nsd-fit, made by nsd-fit --completion bash\n_nsd_fit()\n{\n"
                f"    local word=${{COMP_WORDS[COMP_CWORD]}} words=' {words}'\n    COMPREPLY=()\n    [[ $word = -* ]] || return\n"
                "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}\ncomplete -o default -F _nsd_fit nsd-fit\n")
    rows = []
    for letter, name, value, text in found:
        action = ":folder:_files -/" if value == "FOLDER" else f":{value}:" if value else ""
        text = re.sub(r" *\[.*\]", "", text)
        rows += [f"    '-{letter}[{text}]{action}' \\\n"] if letter else []
        rows.append(f"    '--{name}{'=' if value else ''}[{text}]{action}' \\\n")
    return ("#compdef nsd-fit\n# zsh completion, made by nsd-fit --completion zsh\n_arguments -s -S \\\n" + "".join(rows)
            + "    '*:file:_files'\n")


class Options(argparse.ArgumentParser):
    def format_help(self) -> str:
        return HELP

    def error(self, message: str) -> NoReturn:
        unknown = re.match(r"unrecognized arguments: (--[^ =]+)", message)
        if unknown:
            near = difflib.get_close_matches(unknown[1], self._option_string_actions, 1)
            message = f"{unknown[1]}: no such option" + (f"; did you mean {near[0]}?" if near else "")
        print(f"nsd-fit: {message}\nusage: nsd-fit [OPTION ...] PROBLEM.json, see nsd-fit --help", file=sys.stderr)
        sys.exit(64)


def seconds(text: str) -> float:
    """As the other tools read times: 90 or 90s, 5ms, 10min, 2h."""
    match = re.fullmatch(r"([-+.0-9eE]+)(ms|s|min|h)?", text)
    return float(match[1] if match else text) * {"ms": 1e-3, "min": 60, "h": 3600}.get(match[2] or "s", 1)


def read_options(version: str) -> argparse.Namespace:
    """Ends where there is nothing to run."""
    if sys.argv[1:2] == ["--completion"] and sys.argv[2:] in (["bash"], ["zsh"]):
        sys.stdout.write(completion(sys.argv[2]))
        sys.exit(0)
    p = Options(prog="nsd-fit", add_help=False, allow_abbrev=False)
    p.add_argument("problem")
    p.add_argument("-j", "--jobs", type=int, default=len(os.sched_getaffinity(0)))
    p.add_argument("-n", "--evaluations", type=int)
    p.add_argument("-o", "--output")
    p.add_argument("--timeout", type=seconds)
    p.add_argument("--quiet", action="store_true")
    p.add_argument("-h", "--help", action="help")
    p.add_argument("-V", "--version", action="version", version=f"nsd-fit (nsd) {version}")
    a = p.parse_args()
    if not 1 <= a.jobs <= 4096:
        p.error("--jobs: not from 1 to 4096")
    if a.evaluations is not None and not 2 <= a.evaluations <= 100000:
        p.error("--evaluations: not from 2 to 100000")
    if a.timeout is not None and not 0 < a.timeout < 1e7:
        p.error("--timeout: not above 0 and below 1e7 s")
    return a
