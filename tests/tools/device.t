#!/usr/bin/env bash
# --device where there is no OpenCL: what is wrong is said, and nothing is solved elsewhere.
# shellcheck source=tests/support/tap.sh disable=SC2016 # eval expands them
. tests/support/tap.sh

nsd-gen 20 | nsd-detect >"$tmp/a.h5"
mkdir "$tmp/lib"
: >"$tmp/lib/libOpenCL.so.1"
without() { env LD_LIBRARY_PATH="$tmp/lib" "$@"; }

refuses 69 "no loader: nsd-solve refuses" without nsd-solve --device opencl "$tmp/a.h5"
like "and names the cure" "$(cat "$tmp/err")" "no OpenCL here.*install.*or leave --device out"
refuses 69 "no loader: nsd-step refuses" without nsd-step --device opencl "$tmp/a.h5"
status 69 "no loader: there is no list" without nsd-solve --device list
ok "without --device a loader that is broken is not asked" without nsd-solve "$tmp/a.h5"
for name in cuda opencl: opencl:x opencl:1:2 opencl:1000 ''; do
    refuses 64 "'$name' is no device" nsd-solve --device "$name" "$tmp/a.h5"
done
ok "no tool is linked with OpenCL" eval '! ldd "$(command -v nsd-step)" | grep -i opencl'
done_testing
