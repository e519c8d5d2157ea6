#!/usr/bin/env bash
# Small steps with forces on bodies, sums of walls, cohesion, cells and loads: closed forms, balances, the same bytes for
# threads, vector widths and resumed runs, and the large step's results where there is no closed form.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2016 # jq, tap.sh sets tmp
. tests/support/tap.sh

floor='walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }], gravity: [0, 0, -9.81], dt: 1e-3'
scene() # MEMBERS OF THE SCENE: into $tmp/in.h5
{
    jq -n "{ $1 }" | nsd-gen - >"$tmp/in.h5"
}
small() # STEPS [OPTION ...]: the last frame of them is in $tmp/out.h5; nothing is made at once
{
    nsd-step --small-steps 0.01 -n "$1" --every "$1" "${@:2}" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err" &&
        ! grep -E "at once|no small steps" "$tmp/err"
}
last() # JQ PROGRAM: of the summary of the last frame
{
    nsd-info --last -l "$tmp/out.h5" | jq -c "select(.kinetic_energy != null) | $1"
}
body() # JQ PROGRAM [ID]: of a body, the first one
{
    nsd-info --last -p "$tmp/out.h5" | jq -c "select(.id == ${2:-0}) | $1"
}
near() # VALUE WANTED ERROR: jq's numbers
{
    jq -en "(($1) - ($2) | fabs) <= $3" >"$tmp/near"
}
same_bytes() # STEPS [OPTION ...]: of bodies, by three threads, two lanes and in two runs
{
    local half=$(($1 / 2)) one
    run() { nsd-step --small-steps 0.01 "$@" 2>"$tmp/err"; }
    frame() { nsd-info --last -p - | sha256sum; }
    one=$(run -n "$1" --every "$1" "${@:2}" "$tmp/in.h5" | frame)
    [ "$one" = "$(run -j 3 -n "$1" --every "$1" "${@:2}" "$tmp/in.h5" | frame)" ] &&
        [ "$one" = "$(NSD_LANES=2 run -n "$1" --every "$1" "${@:2}" "$tmp/in.h5" | frame)" ] &&
        [ "$one" = "$(run -n $half --every $half "${@:2}" "$tmp/in.h5" |
            run -n $(($1 - half)) --every $(($1 - half)) "${@:2}" | frame)" ]
}

# ---- forces on bodies ----

ball='x: [0, 0, 0], radius: 0.01, density: 2500' # m = 0.010472 kg
mass='(2500 * 4e-6 / 3 * 3.14159265358979)'
scene "gravity: [0, 0, 0], dt: 1e-3, bodies: [{ $ball }], forces: [{ bodies: [0], along: [1, 0, 0], force: 0.01 },
    { bodies: [0], about: [0, 0, 1], torque: 1e-6 }]"
ok "a force and a torque are made in small steps" small 100
ok "a constant force: x = F t^2/(2 m)" near "$(body '.x[0]')" "0.01 * 0.01 / 2 / $mass" 1e-12
ok "a constant torque: w = T t/I" near "$(body '.w[2]')" "1e-6 * 0.1 / (0.4 * $mass * 1e-4)" 1e-9
ok "their work is the kinetic energy: nothing is dissipated" near "$(last '.balance | .dissipation / .loads')" 0 1e-12

scene "gravity: [0, 0, 0], dt: 1e-3, bodies: [{ $ball }],
    forces: [{ bodies: [0], along: [1, 0, 0], force: { amplitude: 0.01, frequency: 20 } }]"
small 25
ok "half a period of a sine: v = 2 F/(m omega)" near "$(body '.v[0]')" "2 * 0.01 / $mass / (40 * 3.14159265358979)" 3e-5

scene "$floor, mu: 0.3, bodies: [{ x: [0, 0, 0.01], radius: 0.01, density: 2500, v: [1, 0, 0], w: [0, 100, 0] },
    { x: [0.1, 0, 0.01], radius: 0.01, density: 2500 }], forces: [{ bodies: [0], along: [0, 0, -1], force: 0.3 },
    { bodies: [0], about: [0, 1, 0], torque: -1e-2 }]"
small 10
ok "a ball that is pushed onto a floor brakes with mu (m g + F)" \
    near "$(body '.v[0]')" "1 - 0.3 * (9.81 + 0.3 / $mass) * 0.01" 2e-3

scene "gravity: [0, 0, 0], dt: 1e-3, bodies: [{ $ball }]"
small 100 --with 'jq -c --unbuffered "{forces: [[0, 0, (.time)]]}"'
ok "a program's force that grows with time: v = t (t - dt)/(2 m)" near "$(body '.v[2]')" "0.1 * 0.099 / 2 / $mass" 1e-9

jq -n '{ dim: 3, dt: 1e-3, density: 2500, mu: 0.3, gravity: [0, 0, -9.81], walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { point: [0, 0, 0], normal: [1, 0, 0] }, { point: [0, 0, 0], normal: [0, 1, 0] }],
    bodies: [range(4) as $i | range(4) as $j | range(5) as $k | { radius: (0.005 + 0.001 * ($i + $j + $k) / 10), x: [$i, $j, $k] |
        map((. + 0.6) * 0.0135) }], forces: [{ bodies: [3, 40, 70], along: [0, 1, -1], force: { amplitude: 0.02, frequency: 40 } },
        { bodies: [7], about: [1, 0, 0], torque: 1e-5 }] }' | nsd-gen - >"$tmp/in.h5"
ok "balls with forces: the same bytes" same_bytes 30

# ---- sums of walls ----

sums() # JQ PROGRAM: of the sums of the last frame
{
    nsd-stat --last -m sums "$tmp/out.h5" 2>"$tmp/stat" | jq -c ".sums | $1"
}
scene "$floor, mu: 0.3, bodies: [{ x: [0, 0, 0.01], radius: 0.01, density: 2500, v: [1, 0, 0] }]"
ok "sums of walls are kept in small steps" small 300 --sums
ok "a ball at rest: the floor carries m g" near "$(sums '.normal[0]')" "$mass * 9.81" 1e-9
ok "a ball that slides until it rolls: friction takes 2/7 of its energy" near "$(sums '.friction[0]')" "$mass / 7" 1e-7
ok "and has slid over that divided by mu m g" near "$(sums '.rub[0]')" "$mass / 7 / 0.3" 1e-6
ok "and pushes the floor by 2/7 of its momentum" near "$(sums '.force[0][0]')" "$mass * 2 / 7 / 0.3" 1e-6
scene "walls: [{ point: [0, 0, 0], normal: [0, 0, 1], velocity: [0, 0, 0.2] }], gravity: [0, 0, 0], dt: 1e-3, e_n: 0.5,
    bodies: [{ x: [0, 0, 0.02], radius: 0.01, density: 2500, v: [0, 0, -1] }]"
small 50 --sums
ok "a wall that a ball meets at 1.2 m/s with e 0.5 gets m 1.2 1.5, and works on it by that times 0.2 m/s" \
    near "$(sums '.force[0][2]') * 0.05 + $(sums '.power[0]') * 0.05 / 0.2 + 2 * $mass * 1.8" 0 1e-9

# ---- attraction ----

for force in 0.11 0.05; do # m g = 0.10273 N
    scene "walls: [{ point: [0, 0, 0], normal: [0, 0, -1] }], gravity: [0, 0, -9.81], dt: 1e-3, cohesion: { force: $force },
        bodies: [{ x: [0, 0, -0.01], radius: 0.01, density: 2500 }]"
    ok "cohesion is made in small steps, $force N" small 100
    ok "a ball below a ceiling hangs by $force N or falls" \
        near "$(body '.x[2]')" "-0.01 - (if $force < 9.81 * $mass then 9.81 * 0.005 else 0 end)" "if $force > 0.1 then 1e-6 else 1.5e-3 end"
done
scene "walls: [{ point: [0, 0, 0], normal: [0, 0, -1] }], gravity: [0, 0, -9.81], dt: 1e-3, cohesion: { force: 0.3, range: 5e-3 },
    bodies: [{ x: [0, 0, -0.014], radius: 0.01, density: 2500 }]"
small 10
ok "within its range a pull accelerates with A/m - g" near "$(body '.x[2]')" "-0.014 + (0.3 / $mass - 9.81) * 0.01 * 0.01 / 2" 1e-10
ok "and nothing is dissipated" near "$(last '.balance | .dissipation / .bond_change')" 0 1e-2
small 200
ok "then the ball rests" near "$(body '.v[2]') + ($(body '.x[2]') + 0.01) / 1e-2" 0 1e-3
ok "and stores - A range" near "$(last '.balance.bond_energy')" "-0.3 * 5e-3" 1e-5

scene "walls: [{ point: [0, 0, 0], normal: [0, 0, -1] }], gravity: [0, 0, 0], dt: 1e-4, cohesion: { force: 0.1 },
    bodies: [{ x: [0, 0, -0.01], radius: 0.01, density: 2500 }],
    forces: [{ bodies: [0], along: [0, 0, -1], force: { table: [[0, 0], [1, 1]] } }]"
small 1500
ok "a force that grows pulls a ball off at A: then it falls freely" \
    near "$(body '.v[2]')" "-(0.15 * 0.15 - 0.1 * 0.1) / 2 / $mass" 2e-2

# the energy of a bridge: the integral of its force from 0 to V^(1/3) [state/pair_law.h]
bridge='(2 * 3.14159265358979 * 1e-3 * 0.072 * (4.641588833612779e-4 - (4.641588833612779e-4 * 4.641588833612779e-4 + $c2 | sqrt) + ($c2 | sqrt)))'
wet='capillary: { volume: 1e-10, tension: 0.072 }'
for v in 0.15 0.11; do
    scene "dt: 1e-5, gravity: [0, 0, 0], $wet, bodies: [{ x: [0, 0, 0], radius: 1e-3, fixed: true },
        { x: [0, 0, -2e-3], radius: 1e-3, density: 2500, v: [0, 0, -$v] }]"
    small 3000
    ok "a ball leaves a liquid bridge with what is left of its energy, or comes back: $v m/s" near "$(body '.v[2]' 1)" \
        "(2e-10 / 3.14159265358979 / 1e-3) as \$c2 | ($v * $v - 2 * $bridge / ($mass * 1e-3)) | if . > 0 then -sqrt else 0 end" 4e-4
done
is "a ball that comes back stays wet" "$(small 3000 --contacts && nsd-info --last -c "$tmp/out.h5" | jq .wet)" true

scene "dt: 1e-3, gravity: [6.9367, 0, -6.9367], mu: 0.1, mu_s: 0.4, v_s: 0.01, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
    bodies: [{ x: [0, 0, 0.01], radius: 0.01, density: 2500 }]"
small 100
ok "static friction lets a ball roll where kinetic friction does not: 5/7 g sin" near "$(body '.v[0]')" "5 / 7 * 6.9367 * 0.1" 1e-4
jq 'del(.mu_s, .v_s)' <(nsd-info --scene "$tmp/in.h5") | nsd-gen - >"$tmp/dry.h5" && mv "$tmp/dry.h5" "$tmp/in.h5"
small 100
ok "with kinetic friction alone it slides" near "$(body '.v[0]')" "0.9 * 6.9367 * 0.1" 1e-4

heap='dim: 3, dt: 1e-3, density: 2500, mu: 0.3, e_n: 0.3, gravity: [0, 0, -9.81], walls: [{ point: [0, 0, 0], normal: [0, 0, 1] },
    { point: [0, 0, 0], normal: [1, 0, 0] }, { point: [0, 0, 0], normal: [0, 1, 0] }],
    bodies: [range(5) as $i | range(4) as $j | range(6) as $k | { radius: (0.005 + 0.001 * (($i + 3 * $j + 2 * $k) % 5) / 5),
        x: [$i, $j, $k] | map((. + 0.55) * 0.0121) }]'
for law in "$wet" 'cohesion: { force: 0.05, range: 2e-4 }, rolling: { mu_r: 1e-5 }, mu_s: 0.5, v_s: 0.01'; do
    scene "$heap, $law"
    ok "a heap with ${law%%:*}: the same bytes" same_bytes 60
done
scene "$heap, cohesion: { force: 0.05, range: 2e-4 }"
small 600
ok "a cohesive heap comes to rest" near "$(last .kinetic_energy)" 0 1e-12

done_testing
