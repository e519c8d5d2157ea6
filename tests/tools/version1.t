#!/usr/bin/env bash
# A document of the first commit of version 1.0 (nsd-gen 4 | nsd-step -n 800 --every 400 --contacts), and the same datasets as h5py
# writes them: every tool reads both, and prints the numbers that h5py finds.
# shellcheck source=tests/support/tap.sh disable=SC2016 # text for eval
. tests/support/tap.sh

gzip -dc tests/support/golden/version1-contacts.h5.gz >"$tmp/v1.h5"
cd "$tmp"
documents=(v1.h5)
if have_h5py; then
    py - <<'END'
import json
import h5py

source = h5py.File("v1.h5")
with h5py.File("copy.h5", "w") as copy:  # no user block, and h5py's own defaults for chunks and times
    for name in source:
        source.copy(name, copy)
    for name, value in source.attrs.items():
        copy.attrs[name] = value

p, c = source["particles/all"], source["contacts"]
rows = int(c["count"][-2]) if len(c["count"]) > 1 else 0
with open("h5py.bodies", "w") as out:
    for b in range(p["position/value"].shape[1]):
        out.write(json.dumps([list(p[f"{name}/value"][-1][b]) for name in ("position", "velocity", "angular_velocity", "orientation")]) + "\n")
with open("h5py.contacts", "w") as out:
    for k in range(rows, rows + int(c["count"][-1])):
        out.write(json.dumps([c["body"][k].tolist(), float(c["gap"][k]), c["reaction"][k].tolist(), c["velocity"][k].tolist()]) + "\n")
END
    documents+=(copy.h5)
else
    skip "the same as h5py writes it" "no h5py"
fi

for d in "${documents[@]}"; do
    is "$d: what it is" "$(nsd-info "$d" | jq -c 'select(.frames) | [.type, .frames, .bodies, .walls, .dt, .options.tolerance, .options.solver, .history[1].version]')" \
        '["packing",2,4,5,0.0001,0.0001,"auto","1.0"]'
    is "$d: its frames" "$(nsd-info "$d" | jq -c 'select(.step != null) | [.step, .contacts, .converged, .sweeps, .tolerance, .criterion]')" \
        '[400,6,true,7,0.0001,"natural"]
[800,10,true,10,0.0001,"natural"]'
    for tool in nsd-info 'nsd-info -p' 'nsd-info -c' 'nsd-info -w' 'nsd-info --scene' nsd-stat nsd-err nsd-cat nsd-detect nsd-view nsd-web \
        'nsd-export -t csv' 'nsd-step -n 2' 'nsd-step -n 2 --solver auto'; do
        status 0 "$tool reads $d" eval "$tool -o out.any $d"
    done
    status 0 "nsd-detect, nsd-solve and nsd-move of $d" eval "nsd-cat --last $d | nsd-detect | nsd-solve -e | nsd-move -o next.h5"
    is "make its next step" "$(nsd-info next.h5 | jq 'select(.step != null).step')" 801
    [ -s h5py.bodies ] || continue
    ok "$d: bodies are those that h5py reads" cmp <(nsd-info --last -p "$d" | jq -c '[.position // .x, .velocity // .v, .angular_velocity // .w, .orientation // .q | map(. + 0)]') \
        <(jq -c . h5py.bodies)
    ok "$d: contacts, too" cmp <(nsd-info --last -c "$d" | jq -c '[.body, .gap, .r, .u]') <(jq -c . h5py.contacts)
done
if [ "${#documents[@]}" = 2 ]; then
    # shellcheck disable=SC2086 # none, too
    for part in '' -p -c -w; do ok "nsd-info $part: both documents have the same lines" cmp <(nsd-info $part v1.h5) <(nsd-info $part copy.h5); done
fi
ok "solutions are as good as the old nsd-err found them" eval 'nsd-err v1.h5 | jq -e -n "[inputs.natural] | .[0] < 1.2e-5 and .[0] > 1.1e-5 and .[1] < 4.2e-5 and .[1] > 4e-5" >/dev/null'

done_testing
