#!/usr/bin/env bash
# Small steps with forces on bodies, sums of walls, cohesion, cells and loads: closed forms, balances, the same bytes for
# threads, vector widths and resumed runs, and the large step's results where there is no closed form.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2016 # jq, tap.sh sets tmp
. tests/support/tap.sh
# shellcheck source=tests/support/small.sh
. tests/support/small.sh

floor='walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }], gravity: [0, 0, -9.81], dt: 1e-3'

# ---- momentum ----

# Of $tmp/out.h5 and in.h5: momentum and angular momentum of bodies of which \$I is the inertia, relative to the largest of each
kept() # JQ PROGRAM OF I
{
    nsd-info --last -p "$tmp/out.h5" >"$tmp/after" && nsd-info --last -p "$tmp/in.h5" >"$tmp/before" &&
        jq -en --slurpfile old "$tmp/before" --slurpfile new "$tmp/after" "def cross(\$a; \$b):
            [\$a[1] * \$b[2] - \$a[2] * \$b[1], \$a[2] * \$b[0] - \$a[0] * \$b[2], \$a[0] * \$b[1] - \$a[1] * \$b[0]];
            def sums: map(select(.id != null)) | map(. as \$b | ($1) as \$I | cross(.x; .v) as \$c |
            [[range(3) | \$b.mass * \$b.v[.]], [range(3) | \$b.mass * \$c[.] + \$I * \$b.w[.]]]) | transpose | map(transpose | map(add));
            [[(\$old | sums), (\$new | sums)] | transpose[] | [(transpose[] | .[0] - .[1] | fabs)] as \$d | (\$d | max) / (.[0] | map(fabs) | max)]
            | max < 1e-11" >"$tmp/kept"
}
for e in 0 0.5 1; do
    scene "gravity: [0, 0, 0], dt: 1e-3, mu: 0, e_n: $e, bodies: [{ x: [0, 0, 0.5], radius: 0.01, v: [1, 0, 0] }, { x: [0.0213, 0.009, 0.503], radius: 0.012 }]"
    ok "balls without friction meet off their centres, e $e: none turns, momentum and angular momentum are kept" \
        eval 'small_alone 20 && [ "$(body .w 0)$(body .w 1)" = "[0,0,0][0,0,0]" ] && kept 0'
done
scene 'gravity: [0, 0, 0], dt: 1e-3, e_n: 0, bodies: [{ x: [0, 0, 0], radius: 0.01, v: [1, 0, 0] }, { x: [0.02133, 0, 0], radius: 0.01 }]'
small_alone 20
ok "with e 0 two balls stay together" near "$(body '.v[0]') - $(body '.v[0]' 1)" 0 1e-11
scene 'gravity: [0, 0, 0], dt: 1e-3, mu: 0.4, e_n: 0.5,
    bodies: [{ x: [0, 0, 0.5], radius: 0.01, v: [1, 0, 0], w: [0, 30, 9] }, { x: [0.0213, 0.009, 0.503], radius: 0.012 }]'
small_alone 20
ok "balls with friction keep momentum and angular momentum" kept '0.4 * .mass * .radius * .radius'
scene 'gravity: [0, 0, 0], dt: 1e-3, mu: 0.4, e_n: 0.5, shapes: { it: { box: [1, 1, 1] } },
    bodies: [{ x: [0, 0, 0.5], shape: "it", size: 0.02, v: [1, 0, 0], w: [0, 3, 9] }, { x: [0.0223, 0.009, 0.503], shape: "it", size: 0.02 }]'
small_alone 20
ok "and so do cubes" kept '.mass * 0.02 * 0.02 / 6'

# ---- forces on bodies ----

ball='x: [0, 0, 0], radius: 0.01, density: 2500' # m = 0.010472 kg
mass='(2500 * 4e-6 / 3 * 3.14159265358979)'
scene "gravity: [0, 0, 0], dt: 1e-3, bodies: [{ $ball }], forces: [{ bodies: [0], along: [1, 0, 0], force: 0.01 },
    { bodies: [0], about: [0, 0, 1], torque: 1e-6 }]"
ok "a force and a torque are made in small steps" small_alone 100
ok "a constant force: x = F t^2/(2 m)" near "$(body '.x[0]')" "0.01 * 0.01 / 2 / $mass" 1e-12
ok "a constant torque: w = T t/I" near "$(body '.w[2]')" "1e-6 * 0.1 / (0.4 * $mass * 1e-4)" 1e-9
ok "their work is the kinetic energy: nothing is dissipated" near "$(last '.balance | .dissipation / .loads')" 0 1e-12

scene "gravity: [0, 0, 0], dt: 1e-3, bodies: [{ $ball }],
    forces: [{ bodies: [0], along: [1, 0, 0], force: { amplitude: 0.01, frequency: 20 } }]"
small_alone 25
ok "half a period of a sine: v = 2 F/(m omega)" near "$(body '.v[0]')" "2 * 0.01 / $mass / (40 * 3.14159265358979)" 3e-5

scene "$floor, mu: 0.3, bodies: [{ x: [0, 0, 0.01], radius: 0.01, density: 2500, v: [1, 0, 0], w: [0, 100, 0] },
    { x: [0.1, 0, 0.01], radius: 0.01, density: 2500 }], forces: [{ bodies: [0], along: [0, 0, -1], force: 0.3 },
    { bodies: [0], about: [0, 1, 0], torque: -1e-2 }]"
small_alone 10
ok "a ball that is pushed onto a floor brakes with mu (m g + F)" \
    near "$(body '.v[0]')" "1 - 0.3 * (9.81 + 0.3 / $mass) * 0.01" 2e-3

scene "gravity: [0, 0, 0], dt: 1e-3, bodies: [{ $ball }]"
small_alone 100 --with 'jq -c --unbuffered "{forces: [[0, 0, (.time)]]}"'
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
ok "sums of walls are kept in small steps" small_alone 300 --wall-loads
ok "a ball at rest: the floor carries m g" near "$(sums '.normal[0]')" "$mass * 9.81" 1e-9
ok "a ball that slides until it rolls: friction takes 2/7 of its energy" near "$(sums '.friction[0]')" "$mass / 7" 1e-7
ok "and has slid over that divided by mu m g" near "$(sums '.rub[0]')" "$mass / 7 / 0.3" 1e-6
ok "and pushes the floor by 2/7 of its momentum" near "$(sums '.force[0][0]')" "$mass * 2 / 7 / 0.3" 1e-6
scene "walls: [{ point: [0, 0, 0], normal: [0, 0, 1], velocity: [0, 0, 0.2] }], gravity: [0, 0, 0], dt: 1e-3, e_n: 0.5,
    bodies: [{ x: [0, 0, 0.02], radius: 0.01, density: 2500, v: [0, 0, -1] }]"
small_alone 50 --wall-loads
ok "a wall that a ball meets at 1.2 m/s with e 0.5 gets m 1.2 1.5, and works on it by that times 0.2 m/s" \
    near "$(sums '.force[0][2]') * 0.05 + $(sums '.power[0]') * 0.05 / 0.2 + 2 * $mass * 1.8" 0 1e-9

# ---- attraction ----

for force in 0.11 0.05; do # m g = 0.10273 N
    scene "walls: [{ point: [0, 0, 0], normal: [0, 0, -1] }], gravity: [0, 0, -9.81], dt: 1e-3, cohesion: { force: $force },
        bodies: [{ x: [0, 0, -0.01], radius: 0.01, density: 2500 }]"
    ok "cohesion is made in small steps, $force N" small_alone 100
    ok "a ball below a ceiling hangs by $force N or falls" \
        near "$(body '.x[2]')" "-0.01 - (if $force < 9.81 * $mass then 9.81 * 0.005 else 0 end)" "if $force > 0.1 then 1e-6 else 1.5e-3 end"
done
scene "walls: [{ point: [0, 0, 0], normal: [0, 0, -1] }], gravity: [0, 0, -9.81], dt: 1e-3, cohesion: { force: 0.3, range: 5e-3 },
    bodies: [{ x: [0, 0, -0.014], radius: 0.01, density: 2500 }]"
small_alone 10
ok "within its range a pull accelerates with A/m - g" near "$(body '.x[2]')" "-0.014 + (0.3 / $mass - 9.81) * 0.01 * 0.01 / 2" 1e-10
ok "and nothing is dissipated" near "$(last '.balance | .dissipation / .bond_change')" 0 1e-2
small_alone 200
ok "then the ball rests" near "$(body '.v[2]') + ($(body '.x[2]') + 0.01) / 1e-2" 0 1e-3
ok "and stores - A range" near "$(last '.balance.bond_energy')" "-0.3 * 5e-3" 1e-5

scene "walls: [{ point: [0, 0, 0], normal: [0, 0, -1] }], gravity: [0, 0, 0], dt: 1e-4, cohesion: { force: 0.1 },
    bodies: [{ x: [0, 0, -0.01], radius: 0.01, density: 2500 }],
    forces: [{ bodies: [0], along: [0, 0, -1], force: { table: [[0, 0], [1, 1]] } }]"
small_alone 1500
ok "a force that grows pulls a ball off at A: then it falls freely" \
    near "$(body '.v[2]')" "-(0.15 * 0.15 - 0.1 * 0.1) / 2 / $mass" 2e-2

# the energy of a bridge: the integral of its force from 0 to V^(1/3) [state/pair_law.h]
bridge='(2 * 3.14159265358979 * 1e-3 * 0.072 * (4.641588833612779e-4 - (4.641588833612779e-4 * 4.641588833612779e-4 + $c2 | sqrt) + ($c2 | sqrt)))'
wet='capillary: { volume: 1e-10, tension: 0.072 }'
for v in 0.15 0.11; do
    scene "dt: 1e-5, gravity: [0, 0, 0], $wet, bodies: [{ x: [0, 0, 0], radius: 1e-3, fixed: true },
        { x: [0, 0, -2e-3], radius: 1e-3, density: 2500, v: [0, 0, -$v] }]"
    small_alone 3000
    ok "a ball leaves a liquid bridge with what is left of its energy, or comes back: $v m/s" near "$(body '.v[2]' 1)" \
        "(2e-10 / 3.14159265358979 / 1e-3) as \$c2 | ($v * $v - 2 * $bridge / ($mass * 1e-3)) | if . > 0 then -sqrt else 0 end" 4e-4
done
# a rebound with e_n v = 0.15 m/s, or 0.05 m/s at a ceiling, whose bridge has more energy than that, and pulls with 9 times the weight
scene "dt: 1e-5, gravity: [0, 0, 0], $wet, e_n: 0.5, bodies: [{ x: [0, 0, 0], radius: 1e-3, fixed: true },
    { x: [0, 0, -2.1e-3], radius: 1e-3, density: 2500, v: [0, 0, 0.3] }]"
small_alone 3000
ok "the impact of a dry ball makes a bridge, which the rebound has to break" near "$(body '.v[2]' 1)" \
    "(2e-10 / 3.14159265358979 / 1e-3) as \$c2 | -(0.15 * 0.15 - 2 * $bridge / ($mass * 1e-3) | sqrt)" 3e-3
for n in 49 50 51 3000; do # the impact is in step 50
    scene "dt: 1e-5, $wet, e_n: 0.5, walls: [{ point: [0, 0, 2.05e-3], normal: [0, 0, -1] }], bodies: [{ x: [0, 0, 1e-3], radius: 1e-3, v: [0, 0, 0.1] }]"
    small $n
    mv "$tmp/out.h5" "$tmp/in.h5"
    small $((6000 - n))
    ok "a wet ball that rebounds from a ceiling hangs there, in two runs of $n steps and the others" near "$(body '.x[2]')" 1.05e-3 1e-5
done

is "a ball that comes back stays wet" "$(small_alone 3000 --contacts && nsd-info --last -c "$tmp/out.h5" | jq .wet)" true

scene "dt: 1e-3, gravity: [6.9367, 0, -6.9367], mu: 0.1, mu_s: 0.4, v_s: 0.01, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
    bodies: [{ x: [0, 0, 0.01], radius: 0.01, density: 2500 }]"
small_alone 100
ok "static friction lets a ball roll where kinetic friction does not: 5/7 g sin" near "$(body '.v[0]')" "5 / 7 * 6.9367 * 0.1" 1e-4
jq 'del(.mu_s, .v_s)' <(nsd-info --scene "$tmp/in.h5") | nsd-gen - >"$tmp/dry.h5" && mv "$tmp/dry.h5" "$tmp/in.h5"
small_alone 100
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
small_alone 600
ok "a cohesive heap comes to rest" near "$(last .kinetic_energy)" 0 1e-12

# A heap that flows: pairs turn while they attract
for law in 'capillary: { volume: 1e-9, tension: 0.072 }' 'cohesion: { force: 0.05 }'; do
    scene "${heap/gravity: \[0, 0/gravity: [6, 0}, $law"
    small_alone 45
    cp "$tmp/out.h5" "$tmp/in.h5"
    nsd-step --small-steps 0.01 -n 4 --contacts -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
    ok "reactions of a heap with ${law%%:*} that flows are those of Newton's law" newton '[6e-3, 0, -9.81e-3]'
done

# ---- a cell that moves ----

scene "dt: 1e-3, gravity: [0, 0, 0], cell: { lengths: [1, 1, 1], gradient: [[-0.5, 0, 0.2], [0, 0.3, 0], [0, 0, 0]] },
    bodies: [{ x: [0.5, 0.25, 0.5], radius: 0.01 }]"
ok "a cell that moves is made in small steps" small_alone 1000
ok "a body follows the flow of its cell: y = y0 exp(0.3 t)" near "$(body '.x[1]')" "0.25 * (0.3 | exp)" 1e-6
ok "and x, which is sheared and compressed" near "$(body '.x[0]')" "(0.5 - 0.2) * (-0.5 | exp) + 0.2 | if . < 0 then . + (-0.5 | exp) else . end" 1e-6

# a gas of elastic balls in shear flow: the cell's edges work on it, and nothing is dissipated; how it lies in the cell does not matter
gas() # M IN Z
{
    scene "dt: 1e-3, gravity: [0, 0, 0], mu: 0, e_n: 1, cell: { lengths: [0.05, 0.05, 0.05], gradient: [[0, 0, 20], [0, 0, 0], [0, 0, 0]] },
        bodies: [range(6) as \$i | range(6) as \$j | range(6) as \$k | { radius: 0.0035, x: [\$i, \$j, \$k] | map((. + 0.5) * 0.05 / 6) }
            | .v = [(.x[0] * 7e4 | sin), (.x[1] * 5e4 + 1 | sin), (.x[2] * 6e4 + 2 | sin)] | .x[2] += $1]"
}
gas 0
ok "a gas in shear flow" small_alone 60 --log "$tmp/log"
jq -s 'map(.balance) | [(map(.drives) | add), (map(.dissipation) | add), .[-1].peculiar, .[-1].kinetic]' "$tmp/log" >"$tmp/first"
ok "what the edges do is not dissipated" near "$(jq '.[1] / .[3]' "$tmp/first")" 0 1e-2
gas 0.013
small_alone 60 --log "$tmp/log"
ok "and does not depend on where the cell begins" near "$(jq -s '.[-1].balance.peculiar' "$tmp/log") / $(jq '.[2]' "$tmp/first")" 1 2e-3
ok "a gas in shear flow: the same bytes" same_bytes 40

# J: of the edges, in shear at 1/s, of three packings, which scatter by a quarter
works() # OPTION ...
{
    local seed
    for seed in 34 35 36; do
        jq ".seed = $seed | .bodies[0].count = 100 | .cell.lengths = [0.53, 0.53]" scenes/shear.json | nsd-gen - >"$tmp/in.h5"
        timeout 60 nsd-step "$@" --until 6 --every 6s --log "$tmp/log" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err" || return
        jq 'select(.time > 2) | .balance.drives' "$tmp/log"
    done | jq -s add
}
ok "dense discs in shear: the work of steps that are made at once, within their scatter" \
    near "$(works --small-steps 0.005) / $(works --dt 2.5e-4)" 1 0.25

# ---- loads ----

load() # JQ PROGRAM: of the load of the last frame
{
    nsd-info --last -w "$tmp/out.h5" | jq -c "select(.load) | .load | $1" | head -n 1
}
scene "dt: 1e-3, gravity: [0, 0, 0], walls: [{ point: [0, 0, 1], normal: [0, 0, -1], load: { along: [0, 0, -1], force: 2, mass: 0.01 } }],
    bodies: [{ $ball }]"
ok "a load is made in small steps" small_alone 20
ok "a lid falls freely: F t^2/(2 m)" near "$(load .travel)" "2 * 0.02 * 0.02 / 2 / 0.01" 1e-12
ok "the work of its force is its energy" near "$(last '.balance | .loads / .change')" 1 1e-9

scene "dt: 1e-3, gravity: [0, 0, 0], e_n: 0.5, walls: [{ point: [0, 0, 0], normal: [0, 0, 1], load: { along: [0, 0, 1], mass: $(jq -n "$mass"), speed: 1 } }],
    bodies: [{ x: [0, 0, 0.02], radius: 0.01, density: 2500 }]"
small_alone 30
ok "a wall meets a ball of its mass at 1 m/s with e 0.5: 0.75 m/s and 0.25 m/s" near "$(body '.v[2]') + $(load .speed) / 1e3" 0.75025 1e-9

scene "$floor, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { point: [0, 0, 0.03], normal: [0, 0, -1], load: { along: [0, 0, -1], force: 2, mass: 0.01 } }],
    e_n: 0.2, bodies: [{ x: [0, 0, 0.01], radius: 0.01, density: 2500 }]"
small_alone 200
ok "a lid that falls on a ball comes to rest on it" near "$(load .travel)" 0.01 2e-5
cp "$tmp/out.h5" "$tmp/in.h5"
small_alone 20 --wall-loads
ok "the ball carries the load" near "$(sums '.normal[1]')" 2 1e-9
ok "and the floor carries both" near "$(sums '.normal[0]')" "2 + $mass * 9.81" 1e-9

scene "dt: 1e-3, gravity: [0, -9.81, 0], mu: 0.3, walls: [{ cylinder: { point: [0, 0, 0], axis: [0, 0, 1], radius: 0.1 }, load: { about: [0, 0, 0], mass: 1e-3 } }],
    bodies: [{ x: [0, -0.09, 0], radius: 0.01, density: 2500, v: [0.5, 0, 0] }]"
small_alone 100
ok "a drum that turns freely is driven by a ball that slides in it" near "$(load '.speed > 0 | if . then 1 else 0 end')" 1 0

lid() # LOAD: a lid on 320 balls
{
    scene "dt: 1e-3, gravity: [0, 0, 0], density: 2500, mu: 0.3, e_n: 0.2, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { point: [0, 0, 0], normal: [1, 0, 0] },
        { point: [0, 0, 0], normal: [0, 1, 0] }, { point: [0.063, 0, 0], normal: [-1, 0, 0] }, { point: [0, 0.063, 0], normal: [0, -1, 0] },
        { point: [0, 0, 0.042], normal: [0, 0, -1], load: { $1 } }], bodies: [range(8) as \$i | range(8) as \$j | range(5) as \$k |
        { radius: (0.003 + 0.0002 * ((\$i * 7 + \$j * 3 + \$k * 11) % 5)), x: [\$i, \$j, \$k] | map((. + 0.55) * 0.0077) }
        | .x[0] += 2e-4 * (\$k * 12 | sin) | .x[1] += 2e-4 * (\$k * 7 | cos)]"
}
lid "pressure: 1000"
ok "balls below a lid: the same bytes" same_bytes 60
small_alone 400
travel=$(load .travel)
ok "a lid at a constant pressure comes to rest on balls" near "$(load .speed)" 0 3e-3
nsd-step --small-steps 0.01 -n 100 --every 100 --wall-loads -o "$tmp/sums.h5" "$tmp/out.h5" 2>"$tmp/err" && mv "$tmp/sums.h5" "$tmp/out.h5"
ok "which carry p A" near "$(sums '.normal[5]') / 3.969" 1 1e-3
nsd-step --overlap-rule gap -n 400 --every 400 -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "where steps that are made at once leave it" near "$travel / $(load .travel)" 1 0.1
lid "pressure: 1000, mass: 1"
nsd-step --small-steps 0.01 -n 2 -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "a lid much heavier than a layer is made at once" grep -q "no small steps with a load of more mass" "$tmp/err"

# ---- what has no solution ----

plates() # SPEED: a ball of 1 kg between the floor and a plate that comes down
{
    scene "dt: 1e-3, mu: 1, walls: [{ point: [0, 0, -0.1], normal: [0, 0, 1] }, { point: [0, 0, 0.1], normal: [0, 0, -1], velocity: [0, 0, -$1] }],
        bodies: [{ x: [0, 0, 0], radius: 0.1, mass: 1 }]"
    local s=0
    nsd-step -n 100 --small-steps 0.01 -e --log "$tmp/log" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err" || s=$?
    is "a plate that comes down at $1 m/s: status" $s "$2"
}
plates 0.1 1
ok "a ball that walls crush has no solution" grep -q ", 1 without a solution" "$tmp/err"
ok "and overlaps by little more than 3 R then" near "$(jq -s 'last.max_overlap / 0.1' "$tmp/log")" 0.03 1e-3
ok "walls still approach it, at half of their velocity at least" near "$(jq -s '(map(.max_penetration_true | select(. >= 0.05)) | length) / length' "$tmp/log")" 1 0
plates -0.1 0

# ---- cells under a stress ----

squeezed() # STRESS: 150 balls of some 1 kg, with friction
{
    jq ".mu = 0.3 | .cell.lengths = [6.1, 6.1, 6.1] | .cell.stress = { $1 } | .bodies[0].random.count = 150 |
        .bodies[0].box = { x: [0, 6.1], y: [0, 6.1], z: [0, 6.1] }" scenes/isotropic.json | nsd-gen - >"$tmp/in.h5"
}
stress() # JQ PROGRAM: of the stress of the last frame
{
    nsd-stat --last -m stress "$tmp/out.h5" 2>"$tmp/stat" | jq -c ".stress | $1"
}
squeezed 'pressure: 1, mass: 10'
ok "balls in a cell under a stress: the same bytes" same_bytes 40
small_alone 1000 --contacts
ok "a cell under a pressure comes to rest at it" near "$(stress '[.tensor[0][0], .tensor[1][1], .tensor[2][2]] | map(. - 1 | fabs) | max')" 0 1e-3
ok "with overlaps of at most 0.01 radii" near "$(last .account.overlap.value)" 0 0.01
squeezed 'mean: 2, mass: 10'
small_alone 1000 --contacts
ok "so does the size of one under a mean pressure" near "$(stress '.p')" 2 2e-3
squeezed 'pressure: 1, mass: 1'
nsd-step --small-steps 0.01 -n 1 -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "one whose edges are lighter than a row of grains is made at once" grep -q "no small steps with edges of a cell that are lighter" "$tmp/err"
scene 'dim: 3, dt: 1e-3, gravity: [0, 0, 0], density: 2500, mu: 0, e_n: 1, seed: 3, cell: { lengths: [0.05, 0.05, 0.05], stress: { mean: 94, mass: 0.004 } },
    bodies: [range(6) as $i | range(6) as $j | range(6) as $k | { radius: 0.002, x: [$i, $j, $k] | map((. + 0.5) * 0.0083) } | .x as $x |
        .v = [($x[0] * 7e4 + $x[1] * 3e4 | sin), ($x[1] * 5e4 + $x[2] * 9e4 + 1 | sin), ($x[2] * 6e4 + $x[0] * 4e4 + 2 | sin)]]'
rm -f "$tmp/log"
small_alone 100 --log "$tmp/log"
ok "an elastic gas in a cell under a stress keeps its energy" near \
    "$(jq -s 'map(.balance) | (map(.dissipation) | add) / .[0].kinetic' "$tmp/log")" 0 0.01
# Shear under a constant load: as high as many solves make it
nsd-gen scenes/plane-shear.json >"$tmp/in.h5"
small_alone 1000
height=$(last '.edges[1][1]')
nsd-step --small-steps 0 -n 1000 --every 1000 -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "a shear cell under a load is as high as one solve per step makes it" near "$height / $(last '.edges[1][1]')" 1 0.02

done_testing
