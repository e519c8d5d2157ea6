#!/usr/bin/env bash
# Loads of laboratory tests: a cell whose size yields to a mean stress, pressures on walls, factors in time, masses
# by rule. Balances, statics, resuming, threads, documents, errors.
# shellcheck source=tests/support/tap.sh disable=SC2016,SC2094 # jq programs; names of tests with what is read
. tests/support/tap.sh

step() { nsd-step "$@" 2>/dev/null; }
holds() { jq -e "$1" >/dev/null; }
# The energy that is missing from the balance of a log's worst step, in parts of what there is
misfit()
{
    jq -s 'map(.balance | ((.change - (.gravity + .loads + .drives - .dissipation)) | fabs) /
        (.kinetic + (.gravity | fabs) + (.loads | fabs) + (.drives | fabs) + (.dissipation | fabs) + 1e-300)) | max' "$1"
}
natural() { step -n 3 --contacts --tolerance 1e-9 --overlap-rule gap "$@" | nsd-err | jq -s 'map(.natural) | max < 2e-9'; }
state() { nsd-info --last -p "$1" && nsd-info --last -w "$1" && nsd-info --last "$1" | jq -c 'select(.edges) | [.edges, .rates]'; }

# resumes NAME: to the bit, by threads, as a stream, in parts
resumes()
{
    step -n 20 -o "$tmp/ten.h5" "$tmp/$1.h5"
    step -n 20 -o "$tmp/again.h5" "$tmp/ten.h5"
    step -n 40 -o "$tmp/twenty.h5" "$tmp/$1.h5"
    ok "$1: a run resumes to the bit" cmp <(state "$tmp/again.h5") <(state "$tmp/twenty.h5")
    step -j 4 -n 20 -o "$tmp/j4.h5" "$tmp/$1.h5"
    ok "$1: 4 threads give the bytes of one" cmp "$tmp/j4.h5" "$tmp/ten.h5"
    if have_ranks; then
        step --solver auto -n 20 -o "$tmp/once.h5" "$tmp/$1.h5"
        ranks 3 nsd-step --solver auto -n 20 -o "$tmp/ranks.h5" "$tmp/$1.h5" >/dev/null 2>&1 || true
        ok "$1: 3 processes give the bytes of one" cmp "$tmp/ranks.h5" "$tmp/once.h5"
    else
        skip "$1: 3 processes give the bytes of one" "no MPI"
    fi
    nsd-cat --last "$tmp/$1.h5" | nsd-detect | nsd-solve 2>/dev/null | nsd-move >"$tmp/parts.h5"
    nsd-cat --last "$tmp/$1.h5" | step --solver auto -n 1 | cat >"$tmp/whole.h5"
    ok "$1: detect | solve | move and step give the same bits" cmp <(dump "$tmp/parts.h5") <(dump "$tmp/whole.h5")
    is "$1: nsd-err finds the solution that the solver has found" "$(natural "$tmp/$1.h5")" true
}

# ---- a mean stress ----

# mean DIM MASS RATE: a cell that is distorted, while its size yields to a mean stress of 1
mean()
{
    jq -n --argjson dim "$1" --argjson mass "$2" --argjson rate "$3" '
        (if $dim == 2 then 11 else 6 end) as $L |
        { dim: $dim, dt: 0.02, gravity: [range($dim) | 0], density: (if $dim == 2 then 1.257 else 1.88 end), seed: 5, mu: 0.4,
          cell: { lengths: [range($dim) | $L], gradient: [range($dim) as $i | [range($dim) as $j |
              if $i != $j then 0 elif $i == $dim - 1 then -$rate else $rate / ($dim - 1) end]],
              stress: ({ mean: 1, factor: [[0, 0], [4, 1]] } + if $mass then { mass: $mass } else {} end) },
          bodies: [{ random: { count: 80 }, radius: { uniform: [0.4, 0.6] },
              box: ({ x: [0, $L], y: [0, $L] } + if $dim == 3 then { z: [0, $L] } else {} end) }] }' | nsd-gen -
}
for dim in 2 3; do
    mean $dim null 0.01 >"$tmp/start.h5"
    step -n 1500 --every 50 --overlap-rule gap --contacts --log "$tmp/log" -o "$tmp/mean$dim.h5" "$tmp/start.h5"
    like "dim $dim: energy is balanced while the size yields to a mean stress" "$(misfit "$tmp/log" | jq '. < 1e-13')" true
    nsd-stat -m stress,strain "$tmp/start.h5" "$tmp/mean$dim.h5" >"$tmp/stat"
    like "dim $dim: the shape follows the gradient exactly" \
        "$(tail -n 1 "$tmp/stat" | jq --argjson dim $dim '.strain.shear / (if $dim == 2 then 0.6 else 0.3 end) - 1 | fabs < 2e-3')" true
    nsd-cat --last "$tmp/mean$dim.h5" >"$tmp/mean.h5"
    resumes mean
done

# The mean stress is the one asked for, whatever the mass of the edges: over 30 s
for mass in 0.3 null 20; do
    mean 2 $mass 0.01 >"$tmp/start.h5"
    step -n 3000 --overlap-rule gap --every 10 --contacts "$tmp/start.h5" |
        nsd-stat -m stress,fraction | jq -s -c '.[length / 2 | floor:] | [(map(.stress.p) | add / length), (map(.fraction.fraction) | add / length)]' >"$tmp/p"
    ok "mass $mass: the mean stress is 1 to 6 %, and the solid fraction 0.78 to 0.83: $(cat "$tmp/p")" \
        holds '(.[0] - 1 | fabs) < 0.06 and .[1] > 0.78 and .[1] < 0.83' <"$tmp/p"
done

# ---- a pressure on the face of a wall ----

cat >"$tmp/box.json" <<'END'
{ "dt": 1e-4, "mu": 0.3, "gravity": [0, 0, 0],
  "bodies": [{ "count": 60, "radius": { "uniform": [4e-3, 5e-3] }, "box": { "x": [0, 0.04], "y": [0, 0.05], "z": [0, 0.06] } }],
  "walls": [{ "box": { "y": [0, 0.05], "z": [0, null], "x": [0, null] } },
            { "point": [0.04, 0, 0], "normal": [-1, 0, 0], "velocity": [-0.02, 0, 0] },
            { "point": [0, 0, 0.06], "normal": [0, 0, -1], "load": { "pressure": { "table": [[0, 0], [0.02, 500]] }, "mass": 0.02 } }] }
END
nsd-gen "$tmp/box.json" >"$tmp/start.h5"
step -n 1500 --every 300 --contacts --log "$tmp/log" -o "$tmp/box.h5" "$tmp/start.h5"
like "energy is balanced under a pressure" "$(misfit "$tmp/log" | jq '. < 1e-13')" true
like "the face is what the walls leave, one of which moves: 0.05 (0.04 - 0.02 t), and the force 500 Pa times that at the middle of the step" \
    "$(nsd-info --last -w "$tmp/box.h5" | jq 'select(.load).load | (.face - 0.05 * 0.037 | fabs) < 1e-12 and
        (.force - 500 * 0.05 * (0.04 - 0.02 * 0.15005) | fabs) < 1e-10')" true
nsd-cat --last "$tmp/box.h5" >"$tmp/wall.h5"
resumes wall
nsd-info --scene "$tmp/box.h5" | nsd-gen - >"$tmp/on.h5"
is "nsd-info --scene resumes with the wall where it is" "$(nsd-info -w "$tmp/on.h5" | jq -c 'select(.load).load')" \
    "$(nsd-info --last -w "$tmp/box.h5" | jq -c 'select(.load).load')"

# statics: the balance of the piston, m dv/dt = -F + p A, in the mean of many steps at rest
jq '.walls[1].velocity = [0, 0, 0] | del(.walls[2].load.mass)' "$tmp/box.json" | nsd-gen - >"$tmp/start.h5"
step -n 3000 --every 10 --contacts --overlap-rule gap "$tmp/start.h5" | nsd-stat -m boundaries |
    jq -s '.[150:] | map(.boundaries.force[5][2]) | add / length' >"$tmp/f"
ok "a piston at rest carries its pressure times its face, 1 N, to 2 %: $(cat "$tmp/f")" holds '(. | fabs) - 1 | fabs < 0.02' <"$tmp/f"

# periodic along x and y: the face is that of the cell
jq '.cell = { lengths: [0.04, 0.05, 1], repeats: [true, true, false] } | .walls = [{ point: [0, 0, 0], normal: [0, 0, 1] }, .walls[2]]' "$tmp/box.json" |
    nsd-gen - >"$tmp/cell.h5"
is "between edges of a cell it is that of the cell" "$(nsd-info -w "$tmp/cell.h5" | jq 'select(.load).load.face * 1e6 | round')" 2000

# ---- factors in time ----

# discs that do not touch: an edge of mass 2 under 3 N/m on a face of 4 m, by a factor that rises from 0 to 1 in 1 s
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, 0], bodies: [{ x: [1, 1], radius: 1e-3 }, { x: [2, 2], radius: 1e-3 }],
    cell: { lengths: [4, 4], stress: { target: [[null, null], [null, 3]], mass: 2, factor: [[0, 0], [1, 1]] } } }' | nsd-gen - >"$tmp/free.h5"
step -n 500 --every 250 -o "$tmp/fall.h5" "$tmp/free.h5"
ok "an edge under a load that rises: its speed is the integral, 3 x 4 / 2 x t^2 / 2" \
    holds '.rates[1][1] / (-6 * 0.125) - 1 | fabs < 1e-12' < <(nsd-info --last "$tmp/fall.h5")
step -n 250 -o "$tmp/half.h5" "$tmp/free.h5"
step -n 250 -o "$tmp/rest.h5" "$tmp/half.h5"
ok "the same, resumed, to the bit" cmp <(state "$tmp/rest.h5") <(state "$tmp/fall.h5")

# ---- masses by rule ----

mean 2 null 0 >"$tmp/start.h5"
kg=$(nsd-info -p "$tmp/start.h5" | jq -s 'map(.mass // 0) | add')
ok "edges have 3/(4 pi^2) of the grains' mass, unless it is given" \
    holds ".masses[0].has / (3 / (4 * 9.8696044010893586) * $kg) - 1 | fabs < 1e-9" \
    < <(nsd-info --scene "$tmp/start.h5" | nsd-gen --check - 2>/dev/null)
ok "a wall has that of one layer of grains" holds '.masses[] | select(.wall == 5) | .has == .mass and .has > 0' \
    < <(jq 'del(.walls[2].load.mass)' "$tmp/box.json" | nsd-gen --check - 2>/dev/null)

# ---- errors ----

bad() # "what is true" FILE FILTER REGEX
{
    jq "$3" "$tmp/$2.json" >"$tmp/bad.json"
    refuses 65 "$1" nsd-gen "$tmp/bad.json"
    like "and where, and the cure" "$(cat "$tmp/err")" "$4"
}
jq -n '{ dim: 2, dt: 1, gravity: [0, 0], cell: { lengths: [4, 4], stress: { mean: 1 } }, bodies: [{ x: [1, 1], radius: 0.5 }] }' >"$tmp/m.json"
bad "a mean stress with a gradient that changes the volume is refused" m '.cell.gradient = [[1, 0], [0, 0]]' 'cell.stress.mean: the gradient changes the volume.*subtract'
bad "a mean stress where an edge does not repeat is refused" m '.cell.repeats = [true, false]' 'edge 1 is not periodic'
bad "a mean stress and a pressure are refused" m '.cell.stress.pressure = 1' 'cell.stress'
bad "edges without grains need their mass" m '.bodies = []' 'cell.stress: no body moves.*give a "mass"'
bad "factors rise in time" m '.cell.stress.factor = [[1, 0], [0, 1]]' 'cell.stress.factor\[1\].*times must rise'
bad "factors are pairs" m '.cell.stress.factor = [1]' 'cell.stress.factor\[0\]'
bad "a pressure without walls beside is refused" box 'del(.walls[0].box.y)' 'pressure needs planes on all sides.*give a force'
bad "a pressure on a disc is refused" box '.walls[2] = { disc: { center: [0.02, 0.02, 0.06], normal: [0, 0, -1], radius: 0.02 }, load: { pressure: 1 } }' 'walls\[2\].load.pressure: only a plane'
bad "a pressure and a force are refused" box '.walls[2].load.force = 1' 'walls\[2\].load.force'

if have_h5py; then
    for change in 'f["/nsd/cell/size_mass"][0] = -1' 'f["/nsd/cell/mean"][0] = float("nan")' 'f["/nsd/cell/factor"][1, 0] = -5' 'f["/nsd/cell/mass"][0, 0] = 1'; do
        foreign "$tmp/mean.h5" "$tmp/forged.h5"
        py -c "import h5py, sys; f = h5py.File(sys.argv[1], 'r+'); $change" "$tmp/forged.h5"
        refuses 65 "a document with $change is refused" nsd-cat "$tmp/forged.h5"
    done
    foreign "$tmp/wall.h5" "$tmp/forged.h5"
    py -c 'import h5py, sys; f = h5py.File(sys.argv[1], "r+"); f["/particles/boundary/load/spread"][:] = 7' "$tmp/forged.h5"
    refuses 65 "a pressure that is neither there nor not is refused" nsd-cat "$tmp/forged.h5"
fi
done_testing
