#!/usr/bin/env bash
# A device by OpenCL (here PoCL, which is the CPU again by another compiler) makes the sweeps: the bytes of --order
# colour on the CPU; what it cannot solve stays on the CPU and is named; a device that fails ends the run clearly.
# shellcheck source=tests/support/tap.sh disable=SC2016 # eval expands them
. tests/support/tap.sh

if ! nsd-solve --device list >"$tmp/list" 2>/dev/null; then
    echo "1..0 # SKIP there is no OpenCL device: packages pocl-opencl-icd, ocl-icd-libopencl1"
    exit 0
fi
export POCL_CACHE_DIR=$tmp/pocl
mkdir "$tmp/pocl"
like "--device list names a device a line" "$(head -n 1 "$tmp/list")" "^opencl:0"$'\t'"(GPU|CPU|other)"

# FILE OPTION ...: both solve it, to the same bytes
same()
{
    local file=$1
    shift
    nsd-solve --order colour "$@" "$file" >"$tmp/cpu.h5" 2>"$tmp/said" || return 1
    nsd-solve --order colour "$@" --device opencl "$file" >"$tmp/device.h5" 2>"$tmp/said" || return 1
    grep -q ': 1 of 1 solves' "$tmp/said" && cmp "$tmp/cpu.h5" "$tmp/device.h5"
}

# FILE ... : the same of problems given by W, each with the solver of all contacts and a method in turn
same_problems()
{
    local methods=(exact sbp sal ebp eal) k=0 f
    for f; do
        { same "$f" --max-sweeps 300 && same "$f" -m "${methods[k++ % 5]}" --max-sweeps 100; } || { echo "$f"; return 1; }
    done
}

# ---- the same bytes ----

# shellcheck disable=SC2034 # heap() needs it
work=$tmp
. bench/heap.sh
for tiles in 1 16 64; do
    heap $tiles | nsd-detect >"$tmp/$tiles.h5"
    balls=$((500 * tiles))
    for method in exact sbp sal ebp eal; do
        ok "$balls balls, $method: the bytes of the CPU" same "$tmp/$tiles.h5" -m $method --max-sweeps 60
    done
    ok "$balls balls, auto: the bytes of the CPU" same "$tmp/$tiles.h5"
    ok "$balls balls, Anderson's mixing to 1e-6: the bytes of the CPU" \
        same "$tmp/$tiles.h5" --solver anderson --criterion natural --tolerance 1e-6
done
ok "a history of every sweep: the bytes of the CPU" same "$tmp/1.h5" --criterion glob --history --max-sweeps 100
ok "every criterion judged after every sweep: the bytes of the CPU" \
    same "$tmp/1.h5" -m ebp --criterion scaled --every-sweep --relax 1.2
ok "in the order of the paper: the bytes of the CPU" \
    eval 'nsd-solve -m exact --order natural "$tmp/1.h5" >"$tmp/cpu.h5" &&
          nsd-solve -m exact --order natural --device opencl "$tmp/1.h5" | cmp - "$tmp/cpu.h5"'
ok "plain steps of Newton: the bytes of the CPU" same "$tmp/1.h5" -m eal --newton plain --max-sweeps 40
if [ -d "$problems" ]; then
    mapfile -t files < <(find "$problems" -name '*.hdf5' | sort)
    ok "${#files[@]} FCLIB problems: the bytes of the CPU" same_problems "${files[@]}"
else
    skip "FCLIB problems: the bytes of the CPU" "there are no ../shared/problems"
fi

# SCENE STEPS: both make the steps, to the same bytes; from where there are contacts
same_steps()
{
    nsd-gen "$1" | nsd-step -n "$2" --every "$2" >"$tmp/start.h5" &&
        nsd-step --order colour -n 20 --every 5 --contacts <"$tmp/start.h5" >"$tmp/cpu.h5" &&
        nsd-step --order colour -n 20 --every 5 --contacts --device opencl <"$tmp/start.h5" >"$tmp/device.h5" 2>"$tmp/said" &&
        grep -q ': 20 of 20 solves' "$tmp/said" && cmp "$tmp/cpu.h5" "$tmp/device.h5"
}
ok "balls in a box, made to steps: the bytes of the CPU" same_steps scenes/paper/example3.json 300
ok "a sheared periodic cell of discs: the bytes of the CPU" same_steps scenes/shear.json 200
ok "a silo of balls: the bytes of the CPU" same_steps scenes/silo-flat.json 100
ok "discs in a drum: the bytes of the CPU" same_steps scenes/drum.json 600
ok "two threads beside it: the bytes of one" \
    eval 'nsd-step -n 20 --device opencl <"$tmp/start.h5" >"$tmp/one.h5" &&
          nsd-step -n 20 --device opencl -j 2 <"$tmp/start.h5" >"$tmp/two.h5" && cmp "$tmp/one.h5" "$tmp/two.h5"'

# ---- what it says ----

ok "--device is in no document" \
    eval 'nsd-solve --device opencl "$tmp/1.h5" >"$tmp/out.h5" && ! grep -a -q opencl "$tmp/out.h5"'
nsd-solve --device opencl -m exact --log "$tmp/log" "$tmp/1.h5" >"$tmp/out.h5" 2>"$tmp/said"
is "with -m the order is then colour" "$(nsd-info "$tmp/out.h5" | jq -r 'select(.order).order // .options.order' | head -n 1)" colour
ok "--log has the bytes that went over the bus" \
    jq -e '.device | .bytes_to > 1e5 and .bytes_from > 2e4 and .kernels > 100 and (.name | length) > 3' "$tmp/log"
ok "numbers come back from a sweep, not vectors" \
    eval 'nsd-solve --device opencl -m exact --tolerance 0 --max-sweeps 400 --log "$tmp/long" "$tmp/1.h5" >"$tmp/out.h5" &&
          jq -s -e "(.[1].device.bytes_from - .[0].device.bytes_from) / (.[1].sweeps - .[0].sweeps) < 200 and
                    .[0].device.bytes_to == .[1].device.bytes_to" "$tmp/log" "$tmp/long"'

stays() # SCENE STEPS REGEX: after them it is solved by the CPU, to its bytes, and the run says why
{
    nsd-gen "$1" | nsd-step -n "$2" --every "$2" 2>/dev/null | nsd-detect >"$tmp/other.h5" &&
        nsd-solve --order colour "$tmp/other.h5" >"$tmp/cpu.h5" &&
        nsd-solve --order colour --device opencl "$tmp/other.h5" 2>"$tmp/said" | cmp - "$tmp/cpu.h5" &&
        grep -E -q "on the CPU, not on opencl: $3" "$tmp/said"
}
ok "bonds stay on the CPU, and the run says so" stays scenes/bonded.json 20 "contacts have bonds"
ok "rolling friction stays on the CPU, and the run says so" stays scenes/rolling.json 20 "contacts have rolling friction"
ok "loads stay on the CPU, and the run says so" stays scenes/plane-shear.json 200 "loads push contacts"
ok "shapes stay on the CPU, and the run says so" stays scenes/dominoes.json 20 "grains are no balls"

# ---- what fails ----

refuses 69 "a device that is not there is refused" nsd-solve --device opencl:99 "$tmp/1.h5"
real=$(ldconfig -p | sed -n 's/.*libOpenCL\.so\.1 .*=> //p' | head -n 1)
mkdir "$tmp/lib"
ok "the driver with faults compiles" \
    cc -shared -fPIC -o "$tmp/lib/libOpenCL.so.1" tests/support/fake_opencl.c
faulty() # FAULT COMMAND ...
{
    env LD_LIBRARY_PATH="$tmp/lib" FAKE_OPENCL="$1" FAKE_OPENCL_REAL="$real" timeout 100 "${@:2}"
}
fails() # FAULT REGEX: it ends with 69 and this reason, and writes nothing
{
    local s=0
    faulty "$1" nsd-solve --criterion natural --tolerance 1e-8 --device opencl "$tmp/1.h5" >"$tmp/out" 2>"$tmp/err" || s=$?
    [ $s = 69 ] && [ ! -s "$tmp/out" ] && [ "$(grep -c '^nsd-solve: ' "$tmp/err")" = 1 ] && grep -E -q "$2" "$tmp/err"
}
ok "that driver without a fault gives the bytes of the CPU" \
    eval 'nsd-solve "$tmp/1.h5" >"$tmp/cpu.h5" && faulty no nsd-solve --device opencl "$tmp/1.h5" | cmp - "$tmp/cpu.h5"'
ok "no device: 69, and why" fails none "no device has a driver here"
ok "no double precision: 69, and why" fails nofp64 "no double precision"
ok "too little memory: 69, and how much" fails memory "needs .* GB.*it has"
ok "kernels that do not compile: 69, and why" fails broken "does not compile the kernels"
ok "products contracted with sums: 69, for the bits are others" fails wrong "computes other bits than the CPU"
ok "a device that is lost in its first sweep: 69, and why" fails lost:1 "it has failed: .*CL_INVALID_COMMAND_QUEUE"
ok "a device that is lost in the solve: 69, and why" fails lost:700 "it has failed: .*CL_INVALID_COMMAND_QUEUE"

nsd-gen 500 >"$tmp/start.h5"
s=0
faulty lost:9000 nsd-step -n 1000 --device opencl -o "$tmp/lost.h5" "$tmp/start.h5" 2>"$tmp/err" || s=$?
is "a device that is lost during a run: 69" $s 69
last=$(nsd-info "$tmp/lost.h5" | jq -s 'map(.step // 0) | max')
ok "and the frames until then, $last, are whole" [ "$last" -gt 20 ]
nsd-step -n "$last" --order colour -o "$tmp/whole.h5" "$tmp/start.h5" 2>/dev/null
is "and those of the CPU" "$(nsd-cat --last "$tmp/lost.h5" | nsd-info --particles | md5sum)" \
    "$(nsd-cat --last "$tmp/whole.h5" | nsd-info --particles | md5sum)"

done_testing
