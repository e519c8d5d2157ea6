#!/bin/bash
# The default criterion sees every contact, and the default start is the last step's reactions: impacts, mass ratios,
# wedged grains, rest, and runs that are resumed
# shellcheck source=tests/support/tap.sh disable=SC2016,SC2086 # text for jq and eval; options
. tests/support/tap.sh

# JSON lines of the last frame's bodies
bodies() { nsd-info --last -p "$@"; }
below() { jq -en "$1 < $2" >/dev/null; }
near() { jq -en "($1 - $2 | fabs) <= $3" >/dev/null; }

# ---- impacts ----

# A ball of 20 mm falls with 2 m/s on two layers of balls of 2 mm.
jq -n '{dt: 5e-5, gravity: [0, 0, -9.8], density: 2500, mu: 0.3, e_n: 0.4, overlap: true,
    materials: {steel: {density: 7200}}, walls: [{point: [0, 0, 0], normal: [0, 0, 1]}],
    bodies: ([range(-3; 4) as $i | range(-3; 4) as $j | {x: [0.002 * $i, 0.002 * $j, 0.001], radius: 0.001}] +
        [range(-3; 3) as $i | range(-3; 3) as $j |
            {x: [0.002 * $i + 0.001, 0.002 * $j + 0.001, 0.0024142], radius: 0.001}] +
        [{x: [2e-4, 1e-4, 0.0134], radius: 0.01, v: [0, 0, -2], material: "steel"}])}' | nsd-gen - >"$tmp/bed.h5"
rebound() { nsd-step --solver auto "$@" -n 60 "$tmp/bed.h5" 2>/dev/null | bodies | jq 'select(.radius > 0.009).v[2]'; }
exact=$(rebound --cold --criterion natural --tolerance 1e-9)
for o in "" --cold "--order natural"; do
    up=$(rebound $o)
    ok "a ball on a bed rebounds with $exact m/s, with ${o:-the defaults} $up" near "$up" "$exact" "0.02 * $exact"
done

# A column: the impulse passes through four balls at rest, and is not made again in the next step.
for e in 0 0.5 0.9; do
    jq -n --argjson e $e '{dt: 5e-5, density: 2500, mu: 0.3, e_n: $e, overlap: true,
        walls: [{point: [0, 0, 0], normal: [0, 0, 1]}], bodies: ([range(4) | {x: [0, 0, 0.001 + 0.002 * .], radius: 0.001}] +
        [{x: [5e-5, 0, 0.00901], radius: 0.001, v: [0, 0, -2]}])}' | nsd-gen - >"$tmp/column.h5"
    top() { nsd-step --solver auto "$@" -n 10 "$tmp/column.h5" 2>/dev/null | bodies | jq -s '.[-1].v[2]'; }
    exact=$(top --cold --criterion natural --tolerance 1e-11) up=$(top)
    ok "the top ball of a column, e_n $e: $exact m/s, by default $up" near "$up" "$exact" 0.02
done

# Momentum and energy of a cluster without gravity that a ball meets
jq -n '{dt: 1e-4, gravity: [0, 0, 0], density: 2500, mu: 0.3, e_n: 0.5, overlap: true,
    bodies: ([range(3) as $i | range(3) as $j | range(3) as $k | {x: [0.002 * $i, 0.002 * $j, 0.002 * $k], radius: 0.001}] +
    [{x: [-0.0031, 0.0011, 0.0023], radius: 0.002, v: [1, 0.1, 0]}])}' | nsd-gen - >"$tmp/cluster.h5"
after() { nsd-step --solver auto "$@" -n 40 "$tmp/cluster.h5" 2>/dev/null; }
sum() { nsd-info --last -p | jq -s -c "[.[] | . as \$b | $1] | add"; }
mass='($b.radius | . * . * .)'
is "its momentum is kept" "$(after | sum "$mass * \$b.v[0]" | jq '. * 1e15 | round')" \
    "$(nsd-cat "$tmp/cluster.h5" | sum "$mass * \$b.v[0]" | jq '. * 1e15 | round')"
kinetic() { nsd-info --last | jq -s '.[-1].kinetic_energy'; }
is_energy=$(after | kinetic) exact=$(after --cold --criterion natural --tolerance 1e-10 | kinetic)
ok "its energy is what an exact solve leaves: $exact J, $is_energy" near "$is_energy" "$exact" "0.02 * $exact"

# ---- mass ratios ----

# A heavy body rests on a light one of the same size: both stay. (Sweeps need as many rounds as the ratio.)
stack() # shape ratio
{
    jq -n --argjson m "$2" --arg s "$1" '{dt: 1e-3, mu: 0.5, shapes: {b: {box: [0.2, 0.2, 0.2]}},
        walls: [{point: [0, 0, 0], normal: [0, 0, 1]}], bodies: [
        {x: [0, 0, 0.1], mass: 1}, {x: (if $s == "box" then [0.01, 0.02, 0.3] else [0, 0, 0.3] end), mass: $m}]} |
        .bodies[] += (if $s == "box" then {shape: "b"} else {radius: 0.1} end)' | nsd-gen -
}
for s in box ball; do
    for ratio in 1 1e3 1e6; do
        way=$(stack $s $ratio | nsd-step --solver auto --until 0.3 --every 300 2>"$tmp/err" | bodies |
            jq -s '[(.[] | .x[0:2]), [(.[0].x[2] - 0.1), 0]] | .[1] = (.[1] | map(. - 0)) |
            (.[0] | map(. * .) | add | sqrt) + (.[2][0] | fabs)')
        ok "$s on a $s, mass ratio $ratio: the light one moves by $way m in 0.3 s" below "$way" 1e-5
        is "and every step has converged" "$(grep -c 'NOT CONV' "$tmp/err" || :)" 0
    done
done

# Light balls pinched between two heavy ones, one of which a force presses: they are carried along, and the heavy one
# stays. lambda r is the mass ratio times what moves, and there is a solution.
pinch() # dim, mass ratio, balls, force
{
    jq -n --argjson dim "$1" --argjson R "$2" --argjson k "$3" --argjson F "${4:-50}" '(0.1 / pow($R; 1 / $dim)) as $s | ([0.2, 100 * $s] | min) as $v |
        {dim: $dim, dt: 1e-4, mu: 0.5, gravity: [0, 0, 0][:$dim], overlap: true, bodies: ([{x: [-0.1 - $s, 0, 0][:$dim],
        radius: 0.1, fixed: true, v: [0, $v, 0][:$dim]}, {x: [0.1 + $s, 0, 0][:$dim], radius: 0.1, v: [0, $v, 0][:$dim]}] +
        [range($k) | ((. - ($k - 1) / 2) * 2.2 * $s) as $y |
            {x: [0, $y, 0][:$dim], radius: ($s + ((0.01 + $y * $y) | sqrt) - 0.1)}]),
        forces: [{bodies: [1], along: [-1, 0, 0][:$dim], force: $F}]}' | nsd-gen -
}
for dim in 2 3; do
    for ratio in 1e3 1e9 1e12; do
        for balls in 1 3; do
            status 0 "$dim dimensions, mass ratio $ratio, $balls pinched: every step is solved" \
                nsd-step --solver auto -e -n 20 --every 20 <(pinch $dim $ratio $balls)
            away=$(nsd-info --last -p "$tmp/out" | jq -s 'map(.v[0]) | max')
            ok "and the heavy ball is not thrown back: $away m/s, of 0.0024 a step" below "$away" 0.0024
        done
    done
done
# sal's first steps there are no numbers: the solve goes on from the best ones that it had
status 0 "an iterate that is no number leaves none behind" nsd-step -e --solver auto -m sal -n 20 --every 20 <(pinch 3 1e3 3 1e6)
if command -v h5copy >/dev/null; then
    pinch 3 1e12 3 | nsd-step --solver auto -n 1 2>/dev/null | nsd-cat --last | nsd-detect --fclib=local >"$tmp/both.h5"
    h5copy -i "$tmp/both.h5" -o "$tmp/pinch.h5" -s fclib_local -d fclib_local
    status 0 "nor has an FCLIB problem of them no solution" nsd-solve -e --criterion velocity --tolerance 0.01 "$tmp/pinch.h5"
fi

# ---- no solution ----

# A plate presses a ball onto the floor of a bed: it cannot give way, and the bed is solved all the same.
jq -n '{dt: 5e-4, density: 2500, mu: 0.5, e_n: 0.3, overlap: true, walls: [{box: {x: [-0.02, 0.02], y: [-0.02, 0.02], z: [0, null]}},
    {point: [0, 0, 0.02], normal: [0, 0, -1], velocity: [0, 0, -0.1]}],
    bodies: ([{x: [0, 0, 0.01], radius: 0.01}] + [range(-4; 5) as $i | range(-4; 5) as $j | range(3) as $k |
    {x: [0.0045 * $i, 0.0045 * $j, 0.002 + 0.0043 * $k], radius: 0.002}
    | select((.x | .[0] * .[0] + .[1] * .[1] + (.[2] - 0.01) * (.[2] - 0.01)) > 1.44e-4)])}' | nsd-gen - >"$tmp/wedge.h5"
status 1 "a wedged ball: 1" nsd-step --solver auto -n 30 --contacts "$tmp/wedge.h5"
like "and it says why" "$(cat "$tmp/err")" 'no solution: reactions grow without end'
report=$(nsd-info --last "$tmp/out" | jq -s -c '.[-1] | [.jammed > 0, .velocity <= 1, .converged]')
is "its contacts are told apart, and the others meet the criterion" "$report" '[true,true,false]'
worst=$(nsd-info --last -c "$tmp/out" | jq -s '[.[] | select(.r and .status != "jammed") | -.u[0]] | max')
ok "no other contact approaches faster than g dt (the fastest by $worst m/s)" below "$worst" 0.0049
status 1 "a ball between two plates: 1" nsd-step --solver auto -n 5 <(nsd-gen <(jq -n '{dt: 1e-3, mu: 1,
    bodies: [{x: [0, 0, 0], radius: 0.1, mass: 1}], walls: [{point: [0, 0, -0.1], normal: [0, 0, 1]},
    {point: [0, 0, 0.1], normal: [0, 0, -1], velocity: [0, 0, -0.1]}]}'))
is "in every step" "$(nsd-info "$tmp/out" | jq -s '[.[] | select(.converged == false)] | length')" 5
if command -v h5copy >/dev/null; then
    nsd-detect --fclib=local "$tmp/wedge.h5" >"$tmp/both.h5"
    h5copy -i "$tmp/both.h5" -o "$tmp/fclib.h5" -s fclib_local -d fclib_local
    for g in auto anderson; do
        status 1 "$g: so does an FCLIB problem without a solution" nsd-solve -e --solver $g "$tmp/fclib.h5"
        like "and it says why" "$(cat "$tmp/err")" 'no solution: reactions grow without end'
    done
fi

# What needs no more leaps is not multiplied by infinity.
jq -n '{dt: 1e-3, mu: 1000, bodies: [{x: [0, 0, 0.125], radius: 0.1, mass: 1}],
    walls: [{point: [0, 0, 0], normal: [0.6, 0, 0.8]}]}' | nsd-gen - | nsd-detect --gap 1 >"$tmp/one.h5"
nsd-solve --solver anderson --criterion natural --tolerance 0 "$tmp/one.h5" 2>/dev/null >"$tmp/out"
ok "a report has numbers, however long its solve" jq -e -s '.[-1].natural | isnormal or . == 0' <(nsd-info "$tmp/out")

# ---- rest ----

jq -n '{dt: 1e-3, density: 2500, mu: 0.5, e_n: 0.5, seed: 3, walls: [{box: {x: [0, 0.02], y: [0, 0.02], z: [0, null]}}],
    bodies: [{random: {count: 150}, radius: {uniform: [0.0015, 0.0025]}, box: {x: [0, 0.02], y: [0, 0.02], z: [0, 0.1]}}]}' |
    nsd-gen - >"$tmp/pour.h5"
nsd-step --solver auto --until 1 --every 1000 "$tmp/pour.h5" 2>/dev/null >"$tmp/rest.h5"
# m g d: a mean mass of 9.1e-5 kg and a d of 4 mm
energy=$(nsd-info --last "$tmp/rest.h5" | jq -s '.[-1].kinetic_energy / 150 / (9.1e-5 * 9.81 * 4e-3)')
ok "a pile comes to rest: kinetic energy $energy m g d a ball" below "$energy" 1e-6
nsd-step --solver auto -n 1000 --every 1000 "$tmp/rest.h5" 2>/dev/null >"$tmp/later.h5"
centre() { bodies "$1" | jq -s '[.[] | (.radius | . * . * .) as $m | [$m, $m * .x[2]]] | (map(.[1]) | add) / (map(.[0]) | add)'; }
sunk=$(jq -n "$(centre "$tmp/rest.h5") - $(centre "$tmp/later.h5")")
ok "and does not creep: its centre sinks by $sunk m in the next second" below "$sunk" 4e-6
sweeps=$(nsd-info --last "$tmp/later.h5" | jq -s '.[-1].sweeps')
ok "for $sweeps sweeps a step" below "$sweeps" 41

# ---- the start travels with the frames ----

# Uninterrupted, resumed twice over, appended to, killed within a frame, and step by step in a pipeline
travels() # name file options of the step
{
    local name=$1 in=$2 half=$tmp/half.h5
    nsd-step -n 8 "$in" 2>/dev/null >"$tmp/whole.h5"
    particles() { nsd-info --last -p "$@"; }
    ok "$name: a run that is resumed has the same bits" cmp <(particles "$tmp/whole.h5") \
        <(nsd-step -n 3 "$in" 2>/dev/null | nsd-step -n 5 2>/dev/null | particles)
    cp "$in" "$half"
    nsd-step -n 3 -i "$half" 2>/dev/null && nsd-step -n 5 -i "$half" 2>/dev/null
    ok "$name: so has a file that is appended to" cmp <(particles "$tmp/whole.h5") <(particles "$half")
    nsd-step --solver auto -n 8 "$in" 2>/dev/null >"$tmp/once.h5"
    nsd-cat --last "$in" >"$tmp/next.h5"
    for _ in 1 2 3 4 5 6 7 8; do
        nsd-detect "$tmp/next.h5" | nsd-solve 2>/dev/null | nsd-move >"$tmp/moved.h5"
        mv "$tmp/moved.h5" "$tmp/next.h5"
    done
    ok "$name: so have nsd-detect | nsd-solve | nsd-move" cmp <(particles "$tmp/once.h5") <(particles "$tmp/next.h5")
}
nsd-step -n 220 --every 220 "$tmp/pour.h5" 2>/dev/null >"$tmp/falls.h5"
travels "a pile" "$tmp/falls.h5"
travels "an impact" "$tmp/bed.h5"
stack box 1e3 >"$tmp/boxes.h5"
travels "boxes" "$tmp/boxes.h5"
nsd-gen scenes/plane-shear.json >"$tmp/shear.h5"
travels "a sheared cell with a load" "$tmp/shear.h5"
nsd-step -n 6 -o "$tmp/killed.h5" "$tmp/falls.h5" 2>/dev/null
nsd-cat --frames 0:223 "$tmp/killed.h5" >"$tmp/cut.h5"
ok "an earlier frame of a trajectory starts as the run did" cmp \
    <(nsd-info --last -p "$tmp/killed.h5") <(nsd-step -n 3 "$tmp/cut.h5" 2>/dev/null | nsd-info --last -p)
for l in 2 4 8; do
    ok "$l lanes and two threads: the same bytes" cmp <(nsd-step -n 3 "$tmp/falls.h5" 2>/dev/null) \
        <(NSD_LANES=$l nsd-step -j 2 -n 3 "$tmp/falls.h5" 2>/dev/null)
done

# ---- what is kept at a limit gives no energy ----

# Balls that touch in a box: they fall by less than 0.00006 m in 600 steps of 3e-5 s, 1.4e-6 J if every step converges.
jq -n '{ dt: 3e-5, mu: 0.5, e_n: 0.5, density: 2500, gravity: [0, 0, -9.81], overlap: true, walls: [
    { point: [0, 0, 0], normal: [0, 0, 1] }, { point: [-0.0121, 0, 0], normal: [1, 0, 0] }, { point: [0.0121, 0, 0], normal: [-1, 0, 0] },
    { point: [0, -0.0121, 0], normal: [0, 1, 0] }, { point: [0, 0.0121, 0], normal: [0, -1, 0] }],
    bodies: [range(6) as $i | range(6) as $j | range(10) as $k | { radius: 0.002,
        x: [0.004 * ($i - 2.5) + 0.00003 * ($k % 2), 0.004 * ($j - 2.5) - 0.00004 * ($k % 3 - 1), 0.002 + 0.00399 * $k] }] }' |
    nsd-gen - >"$tmp/dense.h5"
for limit in "--solver nlgs -m exact --relax 1.8 --max-sweeps 1" "--solver nlgs -m exact --relax 1.5 --max-sweeps 1" "--max-sweeps 1" \
    "--max-sweeps 3" "--solver nlgs -m sbp --max-sweeps 1"; do
    # shellcheck disable=SC2086 # options
    nsd-step $limit --warm -n 600 --every 600 --log "$tmp/log" -o "$tmp/out.h5" "$tmp/dense.h5" 2>/dev/null
    ok "$limit: no step throws balls" jq -es 'map(.balance.kinetic) | max | . > 5e-7 and . < 1e-5' "$tmp/log"
done
ok "--cold leaves no memory in a document" test -z "$(nsd-step --cold -n 2 "$tmp/falls.h5" 2>/dev/null |
    h5ls -r /dev/stdin 2>/dev/null | grep memory)"
done_testing
