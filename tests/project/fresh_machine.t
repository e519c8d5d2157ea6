#!/usr/bin/env bash
# README's two commands on a Debian machine that has make and git: a chroot made by mmdebstrap with the Debian sources and
# the apt settings of this machine, in which a clone of the last commit is built and tested. What the tests skip there
# is in README. It takes some 15 minutes on two idle cores; what it does is on standard error.
# shellcheck source=tests/support/tap.sh disable=SC2016 # text of others
. tests/support/tap.sh

skip_all() { echo "1..0 # SKIP $1"; exit 0; }
[ "$(id -u)" = 0 ] || skip_all "not root"
command -v mmdebstrap >/dev/null || skip_all "no mmdebstrap"
# Nothing stays mounted, and nothing runs on, whatever ends this test: mounts and processes are in namespaces of their own.
enclosed=(setpriv --pdeathsig KILL unshare --mount --propagation private --pid --fork --kill-child)
"${enclosed[@]}" true 2>/dev/null || skip_all "no namespaces here"

machine=$tmp/machine
# where apt has what Debian has
sources() { apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' | sort -u; }
sources >"$tmp/sources.list"
[ -s "$tmp/sources.list" ] || { apt-get update -qq >&2 && sources >"$tmp/sources.list"; }
[ -s "$tmp/sources.list" ] || skip_all "apt has no lists of Debian's"
# and how it gets there: proxies, checks of dates
apt-config dump | grep -E '^Acquire::(http|https|ftp|Check|Retries|ForceIPv)[^ ]* "..*";' >"$tmp/apt.conf" || true

progress() { while IFS= read -r line; do printf '%s\n' "$line" >>"$1" && diag "$line"; done; }

install_machine()
{
    mmdebstrap --quiet --mode=root --variant=minbase --include=make,git,ca-certificates --aptopt="$tmp/apt.conf" \
        "$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)" "$machine" "$tmp/sources.list" &&
        mkdir "$machine/root/work" && git clone -q --no-hardlinks . "$machine/root/work/nsd" &&
        { [ ! -d ../shared ] || cp -rL ../shared "$machine/root/work/shared"; } &&
        ! chroot "$machine" sh -c 'command -v cc || command -v python3 || command -v pkg-config'
}
diag "installing Debian in $machine"
ok "a machine with make, git and a clone" install_machine
[ -d "$machine/root/work/nsd" ] || { done_testing; exit; }

cat >"$tmp/enter" <<'EOF'
set -eu # MACHINE COMMAND ...
cd "$1"
mount -t proc proc proc
mount -t tmpfs -o mode=755 tmpfs dev # devices work on it where the folder forbids them
for d in null zero full random urandom tty; do : >"dev/$d" && mount --bind "/dev/$d" "dev/$d"; done
mkdir dev/pts dev/shm
mount -t devpts -o newinstance,ptmxmode=0666 devpts dev/pts
mount -t tmpfs tmpfs dev/shm
ln -s pts/ptmx dev/ptmx
ln -s /proc/self/fd dev/fd
for k in 0 1 2; do ln -s "fd/$k" "dev/$(echo stdin stdout stderr | cut -d ' ' -f $((k + 1)))"; done
shift
exec chroot . "$@"
EOF
proxies=()
for name in http_proxy https_proxy no_proxy; do [ -z "${!name-}" ] || proxies+=("$name=${!name}"); done
readme() # COMMAND ...: as a newcomer who is root; all that it prints is in $tmp/said
{
    local s=0
    diag "$*"
    : >"$tmp/said"
    time "${enclosed[@]}" bash "$tmp/enter" "$machine" env -i HOME=/root TERM=dumb PATH=/usr/sbin:/usr/bin:/sbin:/bin "${proxies[@]}" \
        sh -c "cd /root/work/nsd && $*" 2>&1 </dev/null | progress "$tmp/said" || s=$?
    return $s
}
TIMEFORMAT='# %0R s, of the processor %0U s and %0S s in the system'
for command in "make demo" "make check"; do
    is "README has it" "$(grep -c "^    $command " README.md)" 1
    s=0
    readme "$command" || s=$?
    is "$command ends with 0" $s 0
    is "and nothing is missing" "$(grep -nE 'not found|No such file' "$tmp/said" || true)" ""
    is "nor is an error left over" "$(grep -nE '(^|/)make(\[[0-9]\])?: \*\*\*|Segmentation' "$tmp/said" || true)" ""
done
skipped=$machine/root/work/nsd/build/tap/skipped
ok "the tests have ended" [ -e "$skipped" ]
# README: "make check skips what needs A, B, ..., which it does not install"; a reason: "file: name: no A, or no B"
unnamed()
{
    local names
    names=$(tr '\n' ' ' <README.md | grep -oiE '`make check` skips [^.]*[.]')
    sed 's/.*: //' "$skipped" | sort -u | while IFS= read -r reason; do
        name=$(sed -E 's/^(there is )?no //; s/[ ,:(.].*//' <<<"$reason")
        grep -qiwF -- "$name" <<<"$names" || echo "$reason"
    done
}
is "README names what is skipped" "$(unnamed)" ""
is "nothing of it is mounted here" "$(grep -F "$machine" /proc/self/mounts || true)" ""
done_testing
