#!/usr/bin/env bash
# docs/examples: programs that step, read and act on runs, each with its figure beside the closed form that it prints; and
# the Python module by itself.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317 # tap.sh sets tmp; functions called by name
. tests/support/tap.sh

export PYTHONPATH=$PWD/python
[ -z "${NSD_LIBRARY-}" ] || unset NSD_LIBRARY
library=$(dirname "$(command -v nsd-gen)")/libnsd.so.2
within() # TOLERANCE KEY: each line of $tmp/lines has this key within it of what is expected
{
    jq -es --argjson tolerance "$1" --arg key "$2" \
        'length > 0 and all(.[]; (.[$key] / .expected - 1 | fabs) <= $tolerance)' "$tmp/lines"
}
case_of() # CASE: its line alone
{
    jq -c --arg case "$1" 'select(.case == $case)' "$tmp/all" >"$tmp/lines"
}

san=()
grep -q __asan_init "$(command -v nsd-gen)" && san=("-fsanitize=address,undefined")
cc "${san[@]}" -Ilib/run -o "$tmp/fluid" docs/examples/fluid.c "$library" -lm -Wl,-rpath,"$(dirname "$library")"
"$tmp/fluid" >"$tmp/lines"
ok "fluid.c: balls sink at the velocity of Schiller and Naumann, to 1 %" within 0.01 velocity

bash docs/examples/hold.sh >"$tmp/lines"
ok "hold.sh: a piston comes to rest as the damped spring that jq makes of it, to 1 %" within 0.01 place

if grep -q __asan_init "$(command -v nsd-gen)"; then
    skip "Python" "its interpreter has no sanitizer"
elif ! /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    skip "Python" "no numpy"
else
    export NSD_LIBRARY=$library
    /usr/bin/python3 docs/examples/fluid.py >"$tmp/all"
    case_of terminal
    ok "fluid.py: a ball sinks at the velocity of Schiller and Naumann, to 1 %" within 0.01 velocity
    case_of fluidised
    ok "fluid.py: a bed is fluidised at the velocity of Ergun, to 10 %" within 0.1 velocity
    /usr/bin/python3 docs/examples/servo.py >"$tmp/lines"
    ok "servo.py: stresses are those of the built-in load, to 1 %" within 0.01 stress
    /usr/bin/python3 docs/examples/rocks.py >"$tmp/lines"
    ok "rocks.py: rocks slide as far as friction lets them, to 0.1 %" within 0.001 way
    if /usr/bin/python3 -c 'import scipy' 2>/dev/null; then
        /usr/bin/python3 docs/examples/repose.py >"$tmp/lines"
        ok "repose.py: the friction of an angle of repose, to 1 %" within 0.01 mu
    else
        skip "repose.py" "no scipy"
    fi
    if localedef -i de_DE -f UTF-8 "$tmp/de_DE.UTF-8" 2>/dev/null; then
        cat >"$tmp/comma.py" <<'EOT'
import locale, sys
import nsd
locale.setlocale(locale.LC_ALL, sys.argv[1])
scene = {"dim": 3, "dt": 1.5e-3, "gravity": [0, 0, -9.81], "bodies": [{"file": "table"}, {"x": [0, 0, 0.75], "radius": 0.125}],
         "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}, {"mesh": {"file": "slope.obj"}}]}
run = nsd.Run.from_scene(scene, folder=sys.argv[2])
run.set(dt=1.25e-3, tolerance=1.5e-3)
run.step(3)
print(run.position.tolist(), run.time, run.measure("energy")["energy"]["kinetic"])
run.set(box="-0.5,0.5,-0.5,0.5,0.25,1.25")
print(run.measure("fraction")["fraction"])
EOT
        echo '0.5 0.5 0.75 0.0625' >"$tmp/table"
        printf '%s\n' 'v -5.5 -5.5 -1.5' 'v 5.5 -5.5 -1.25' 'v 5.5 5.5 -1.25' 'f 1 2 3' >"$tmp/slope.obj"
        like "numbers with fractions are read" "$(/usr/bin/python3 "$tmp/comma.py" C "$tmp" 2>&1)" '0.7499.* 0.00375 .*solid'
        is "a decimal comma in the program's locale changes nothing" "$(LOCPATH=$tmp /usr/bin/python3 "$tmp/comma.py" de_DE.UTF-8 "$tmp" 2>&1)" \
            "$(/usr/bin/python3 "$tmp/comma.py" C "$tmp" 2>&1)"
    else
        skip "a decimal comma" "localedef makes no locale"
    fi
    /usr/bin/python3 tests/support/outside.py "$tmp" >"$tmp/python" 2>"$tmp/err" || true
    while read -r line; do
        case $line in
        'ok '*) tap_result 0 "${line#ok }" ;;
        *) tap_result 1 "${line#not ok }" ;;
        esac
    done <"$tmp/python"
    is "and nothing else is said" "$(<"$tmp/err")" ""
fi
done_testing
