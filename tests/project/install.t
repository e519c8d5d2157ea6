#!/usr/bin/env bash
# make install, completion in the shells, a program with the library, and the Debian packages.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2016 # functions called by name; text for other shells
. tests/support/tap.sh

unset MAKEFLAGS MFLAGS MAKELEVEL
root=$tmp/usr
tools() { for t in tools/nsd-*; do basename "$t" .c; done; }

ok "make install" make -s PREFIX="$root" install
installed()
{
    local t
    for t in $(tools); do
        [ -x "$root/bin/$t" ] && [ -e "$root/share/man/man1/$t.1" ] &&
            [ -s "$root/share/bash-completion/completions/$t" ] && [ -s "$root/share/zsh/site-functions/_$t" ] || return
    done
}
ok "every tool is there, with its manual and its completion" installed

# ---- a program with the library ----

config() { PKG_CONFIG_PATH=$root/lib/pkgconfig pkg-config "$@" nsd; }
build_step() # [--static]
{
    # shellcheck disable=SC2046 # words
    cc -Wall -Wextra -Werror -o "$tmp/step" docs/step.c $(config --cflags --libs "$@" | if [ $# = 0 ]; then cat; else sed "s|-lnsd|$root/lib/libnsd.a|"; fi)
}
scene=scenes/paper/example3.json
want=$(nsd-gen $scene | nsd-step --overlap-rule keep -n 200 --every 200 --contacts --warm -m exact --order natural --criterion natural --tolerance 1e-6 \
        --max-sweeps 10000 2>/dev/null >"$tmp/step.h5"
    nsd-info --last -p "$tmp/step.h5" | head -n 1 | jq -r ".x[2]" >"$tmp/z"
    nsd-info --last "$tmp/step.h5" | jq -r '[.step, .time, .contacts] | @tsv' | tr '\t' ' ' |
        awk -v z="$(<"$tmp/z")" '{ printf "%d %.17g %d %.17g", $1, $2, $3, z }')
ok "a program that includes <err.h> is built by pkg-config" build_step
is "and makes the steps that nsd-step makes" "$(LD_LIBRARY_PATH=$root/lib "$tmp/step" $scene)" "$want"
ok "and with the archive" build_step --static
is "with the same steps" "$("$tmp/step" $scene)" "$want"
cat >"$tmp/plus.cc" <<'EOT'
#include <nsd.h>
int main() { nsd_run *run = nullptr; return nsd_from_scene(&run, "{\"dt\": 1e-3}", nullptr) || nsd_step(run, 1); }
EOT
plus()
{
    # shellcheck disable=SC2046 # words
    c++ -Wall -Wextra -Werror -o "$tmp/plus" "$tmp/plus.cc" $(config --cflags --libs) && LD_LIBRARY_PATH=$root/lib "$tmp/plus"
}
ok "and in C++" plus
python() { PYTHONPATH=$root/lib/python3/dist-packages /usr/bin/python3 -c "$1"; }
if /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    is "and in Python" "$(python "import nsd; r = nsd.Run.from_scene('$scene'); r.set(local='exact', criterion='natural', tolerance=1e-6, \
max_sweeps=10000, order='natural', warm=True, overlap_rule='keep'); r.step(200); print('%.17g' % r.position[0, 2])")" "${want##* }"
else
    skip "in Python" "no numpy"
fi
is "its version" "$(PKG_CONFIG_PATH=$root/lib/pkgconfig pkg-config --modversion nsd)" "$(nsd-gen --version | sed 's/.* //')"

# ---- completion ----

complete() # WORD ...: what bash makes of the last word
{
    bash --norc -c '. "$1/share/bash-completion/completions/$2"
        shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); compopt() { :; }
        "_${1//-/_}"; printf "%s\n" "${COMPREPLY[@]}"' bash "$root" "$@" | paste -s -d ' '
}
is "bash: an option" "$(complete nsd-step --loca)" --local
is "bash: its words" "$(complete nsd-step --local e)" "ebp eal exact"
is "bash: of a letter" "$(complete nsd-solve -m sb)" sbp
is "bash: behind =" "$(complete nsd-export --to = l)" lammps
is "bash: = itself" "$(complete nsd-export --part =)" "grains contacts walls cell surfaces"
is "bash: files are the shell's" "$(complete nsd-info out)" ""
lacking() # options in --help that completion does not know
{
    local t o
    for t in $(tools); do
        for o in $(nsd-help "$t"); do
            grep -q -e " ${o}[ ']" "$root/share/bash-completion/completions/$t" || echo "$t: bash: $o"
            grep -q -e "${o}[=['}]" "$root/share/zsh/site-functions/_$t" || echo "$t: zsh: $o"
        done
    done
}
nsd-help() { "$1" --help | sed -n '/^Examples/q; s/^ *\(-., \)\{0,1\}\(--[a-z-]*\).*/\2/p' | sort -u; }
is "every option of --help is completed" "$(lacking)" ""
bash_reads() { for f in "$root"/share/bash-completion/completions/*; do bash -n "$f" || return; done; }
ok "bash reads them" bash_reads
if command -v zsh >/dev/null; then
    zsh_reads() { for f in "$root"/share/zsh/site-functions/*; do zsh -n "$f" || return; done; }
    ok "zsh reads them" zsh_reads
    zsh_completes() # TEXT: what a line begun so becomes, by the tab key
    {
        timeout 60 zsh -f -c '
            zmodload zsh/zpty
            zpty shell zsh -f -i
            zpty -w shell "PROMPT=; fpath=($1/share/zsh/site-functions \$fpath); autoload -U compinit; compinit -u -d $2"
            zpty -w shell "show() { print -r -- \"<\$BUFFER>\"; zle kill-buffer }; zle -N show; bindkey \"^X\" show; print ready"
            zpty -r -m shell line "*ready*ready*"
            zpty -w -n shell "$3"$'"'\t\x18'"'
            zpty -r -m shell line "*<nsd*>*"
            print -r -- "${${line##*<}%%>*}"' zsh "$root" "$tmp/zcompdump" "$1"
    }
    is "zsh: an option" "$(zsh_completes 'nsd-step --loca')" "nsd-step --local="
    is "zsh: its words" "$(zsh_completes 'nsd-export --to la')" "nsd-export --to lammps "
else
    skip "zsh" "no zsh"
fi
refuses 64 "a shell that is not known" nsd-step --completion tcsh

make -s PREFIX="$root" uninstall >/dev/null
is "make uninstall leaves no file" "$(find "$root" -type f -o -type l)" ""

# ---- Debian ----

if command -v dh >/dev/null && command -v dpkg-buildpackage >/dev/null; then
    ok "make deb" env DEB_BUILD_OPTIONS=noopt nice make -s deb # the packages, not their speed
    version=$(sed -n 's/^VERSION := //p' Makefile)
    arch=$(dpkg --print-architecture)
    tools_deb=build/deb/nsd-tools_${version}_$arch.deb dev_deb=build/deb/libnsd-dev_${version}_$arch.deb
    lib_deb=build/deb/libnsd2_${version}_$arch.deb python_deb=build/deb/python3-nsd_${version}_all.deb
    if command -v lintian >/dev/null; then
        is "lintian says nothing" "$(lintian --allow-root --fail-on error "$tools_deb" "$dev_deb" "$lib_deb" "$python_deb" 2>&1)" ""
    else
        skip "lintian says nothing" "no lintian"
    fi
    unpacked()
    {
        dpkg-deb -x "$tools_deb" "$tmp/deb" && dpkg-deb -x "$dev_deb" "$tmp/deb" &&
            dpkg-deb -x "$lib_deb" "$tmp/deb" && dpkg-deb -x "$python_deb" "$tmp/deb" &&
            (PATH=$tmp/deb/usr/bin:$PATH && nsd-gen 4 | nsd-step -n 5 2>/dev/null | nsd-info --last | jq -e '.step == 5') &&
            [ -s "$tmp/deb/usr/share/doc/nsd-tools/copyright" ] && [ -s "$tmp/deb/usr/lib/$(gcc -print-multiarch)/libnsd.a" ] &&
            NSD_LIBRARY=$tmp/deb/usr/lib/$(gcc -print-multiarch)/libnsd.so.2 PYTHONPATH=$tmp/deb/usr/lib/python3/dist-packages \
                /usr/bin/python3 -c "import nsd; nsd.Run.from_scene('scenes/press.json').step()"
    }
    ok "unpacked, the tools run" unpacked
    if [ "$(id -u)" = 0 ] && ! dpkg -s nsd-tools >/dev/null 2>&1 && [ -w /usr/bin ]; then
        ok "installed" dpkg -i "$tools_deb" "$lib_deb" "$dev_deb" "$python_deb"
        used()
        {
            # shellcheck disable=SC2046 # words
            /usr/bin/nsd-gen 4 | /usr/bin/nsd-step -n 5 2>/dev/null | /usr/bin/nsd-info --last | jq -e '.step == 5' &&
                cc -o "$tmp/step" docs/step.c $(pkg-config --cflags --libs nsd) && "$tmp/step" $scene &&
                /usr/bin/python3 -c "import nsd; nsd.Run.from_scene('scenes/press.json').step()"
        }
        ok "used" used
        ok "removed" dpkg -P python3-nsd nsd-tools libnsd-dev libnsd2
        is "and nothing is left" "$(ls /usr/bin/nsd-gen /usr/include/nsd.h /usr/share/nsd 2>/dev/null)" ""
    else
        skip "installed, used, removed" "not root, or it is installed"
    fi
else
    skip "make deb" "no debhelper"
fi
done_testing
