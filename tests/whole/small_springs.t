#!/usr/bin/env bash
# Contacts with a stiffness, and bonds of adhesion, in small steps: closed forms, an independent code, and what a resumed run finds.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

step() { nsd-step --small-steps 0.01 "$@" 2>"$tmp/err"; }
last() { nsd-info --last -p "$1"; }
near() { jq -en "($1 - $2 | fabs) <= $3 * (if $2 > 0 then $2 else 1 end)" >/dev/null; } # VALUE WANTED RELATIVE
small() { grep -q "steps were made in [0-9]* small ones" "$tmp/err" && ! grep -q "at once" "$tmp/err"; }
mass=$(jq -n '4 / 3 * 3.141592653589793 * 1e-6 * 2500') # kg, of a ball of 1 cm

# ---- springs of balls ----

# pair E GAP: a ball of 1 cm strikes another one with 1 m/s
pair()
{
    jq -n --argjson e "$1" --argjson gap "$2" '{ dt: 1e-3, e_n: $e, gravity: [0, 0, 0], stiffness: 1e6,
        bodies: [{ x: [0, 0, 0], radius: 0.01 }, { x: [0, 0, (0.02 + $gap)], radius: 0.01, v: [0, 0, -1] }] }' | nsd-gen -
}
for e in 0.01 0.1 0.3 0.5 0.7 0.9 1; do
    for gap in 5e-5 5.286e-5 5.572e-5 5.858e-5 6.144e-5; do # over a small step of 1.43e-5 s
        pair $e $gap | step -n 5 --every 5 | last - | jq -s -c '[.[1].v[2] - .[0].v[2], .[1].v[2] + .[0].v[2] + 1]'
    done >"$tmp/rebounds"
    like "a pair rebounds with $e of its speed" "$(jq -s --argjson e $e 'map(.[0]) | add / 5 - $e | fabs < 4e-3' "$tmp/rebounds")" true
    like "each time to 0.015, with all of the momentum" "$(jq -s --argjson e $e 'all((.[0] - $e | fabs) < 0.015 and (.[1] | fabs) < 1e-12)' "$tmp/rebounds")" true
done
# the stretch of the impact: v sqrt(m/(2 k)), and its time, pi sqrt(m/(2 k))
pair 1 1e-5 >"$tmp/pair.h5"
nsd-info --scene "$tmp/pair.h5" | jq '.dt = 2e-6' | nsd-gen - | step -n 150 --log "$tmp/log" -o "$tmp/spring.h5"
ok "two balls without damping are pressed by v sqrt(m/(2 k))" near \
    "$(nsd-info -p "$tmp/spring.h5" | jq -s '[range(0; length; 2) as $i | .[$i + 1].x[2] - .[$i].x[2]] | 0.02 - min')" "$(jq -n "$mass / 2e6 | sqrt")" 2e-3
ok "for pi sqrt(m/(2 k))" near "$(jq -s '(map(select(.balance.bond_energy > 0)) | length) * 2e-6' "$tmp/log")" "$(jq -n "3.14159265 * ($mass / 2e6 | sqrt)")" 0.02
like "and keep their energy: a part of 1e-3 at any time" "$(jq -s 'map(.balance | .kinetic + .bond_energy) | (max - min) / max < 2e-3' "$tmp/log")" true

# column K: ten balls of 1 cm on a floor
jq -n '{ dt: 1e-3, mu: 0.3, stiffness: 1e5, walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }], bodies: [range(10) | { x: [0, 0, (. * 0.02 + 0.01)], radius: 0.01 }] }' |
    nsd-gen - | step -n 1500 --every 1500 -o "$tmp/column.h5"
ok "a column is made in small steps" small
last "$tmp/column.h5" | jq -s -c '[-0.01] + map(.x[2]) | [range(1; 11) as $i | 0.02 - .[$i] + .[$i - 1]]' >"$tmp/sunk"
like "and each of its contacts overlaps by the weight above over k" \
    "$(jq --argjson w "$(jq -n "$mass * 9.81 / 1e5")" '[range(10) as $i | .[$i] / ((10 - $i) * $w) - 1 | fabs] | max < 1e-6' "$tmp/sunk")" true
# the wave in a row that touches, as bench/reference/dem.c has it with dashpots
for e in '1 0.943' '0.9 0.846'; do
    for order in '[0, 1, 2, 3, 4]' '[2, 0, 4, 1, 3]'; do
        jq -n --argjson e "${e% *}" --argjson order "$order" '{ dt: 1e-5, e_n: $e, gravity: [0, 0, 0], stiffness: 1e6,
            bodies: [$order[] as $i | { x: [$i * 0.002, 0, 0], radius: 0.001, v: [(if $i == 0 then 1 else 0 end), 0, 0] }] }' | nsd-gen - | step -n 50 --every 50 -o "$tmp/row.h5"
        ok "the last of five balls, in the order $order, leaves as soft spheres do, e ${e% *}" near "$(last "$tmp/row.h5" | jq -s 'map(.v[0]) | max')" "${e#* }" 5e-3
        rm "$tmp/row.h5"
    done
done
# a heavy ball on a light one: exp(-pi zeta (m/(2 M))^(1/2)) of 2 m/s
jq -n '{ dt: 1e-5, density: 2500, mu: 0, e_n: 0.4, gravity: [0, 0, 0], stiffness: 1e6, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
    bodies: [{ x: [0, 0, 0.001], radius: 0.001 }, { x: [0, 0, 0.0179], radius: 0.0159, v: [0, 0, -2] }] }' | nsd-gen - | step -n 200 --every 200 -o "$tmp/heavy.h5"
ok "a heavy ball on a light one rebounds as dashpots let it" near "$(last "$tmp/heavy.h5" | jq -s '.[1].v[2]')" 1.980 5e-3

# ---- friction ----

# ball SCENE: on a floor
ball() { jq -n "{ dt: 1e-3, stiffness: 1e6, walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }], bodies: [{ x: [0, 0, 0.01], radius: 0.01 }] } * $1" | nsd-gen -; }
ball '{ mu: 0.3, e_n: 0.5, bodies: [{ x: [0, 0, 0.01], radius: 0.01, v: [1, 0, 0] }] }' | step -n 400 --every 400 -o "$tmp/rolled.h5"
ok "a ball slides, then rolls at 5/7 of its speed" near "$(last "$tmp/rolled.h5" | jq '.v[0]')" "$(jq -n 5/7)" 1e-4
ball '{ mu: 0.6, gravity: [1, 0, -9], rolling: { mu_r: 2e-3 } }' | step -n 200 --every 200 -o "$tmp/held.h5"
ok "a ball that rolling friction holds on a slope is displaced by F/k_t" near "$(last "$tmp/held.h5" | jq '.x[0]')" "$(jq -n "$mass / (2e6 / 7)")" 0.02
like "and rests" "$(last "$tmp/held.h5" | jq '.v | map(fabs) | max < 1e-12')" true
jq -n '{ dt: 1e-3, mu: 0.5, gravity: [2, 0, -9], stiffness: { normal: 1e6, tangential: 5e5 },
    walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }], shapes: { brick: { box: [0.04, 0.04, 0.01] } },
    bodies: [{ x: [0, 0, 0.005], shape: "brick", size: 1 }] }' | nsd-gen - | step -n 300 --every 300 -o "$tmp/brick.h5"
ok "a brick is made in small steps" small
# as in laws.t
ok "a brick on a slope stays, displaced by m g sin/(4 k_t)" near "$(last "$tmp/brick.h5" | jq '.x[0]')" "$(jq -n '0.08 / 2e6 + 0.08 * 2.5e-5 / (4e6 * 4e-4)')" 1e-2
like "and sinks by m g cos/(4 k)" "$(last "$tmp/brick.h5" | jq '(0.005 - .x[2]) / (0.36 / 4e6) - 1 | fabs < 1e-2')" true
jq -n '{ dt: 1e-3, stiffness: 1e6, allow_overlap: true, walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }],
    bodies: [{ x: [0, 0, 0.0095], radius: 0.01 }] }' | nsd-gen - | step -n 100 --every 1 -o "$tmp/deep.h5"
like "a ball that is in a floor rises at g dt" "$(nsd-info -p "$tmp/deep.h5" | jq -s '(map(.v[2]) | max) < 0.011 and (.[-1].x[2] | . > 0.00999)')" true
rm "$tmp"/*.h5

# a lid under 1 N on two balls, heavy or much lighter than they are
for m in 5e-3 1e-7; do
    for e in 0.3 1; do
        jq -n --argjson m $m --argjson e $e '{ dt: 1e-3, e_n: $e, stiffness: 1e5, walls: [{ normal: [0, 0, 1], point: [0, 0, 0] },
            { normal: [0, 0, -1], point: [0, 0, 0.0401], load: { along: [0, 0, 1], force: -1, mass: $m } }],
            bodies: [{ x: [0, 0, 0.01], radius: 0.01 }, { x: [0, 0, 0.03], radius: 0.01 }] }' | nsd-gen - | step -n 300 --every 300 --log "$tmp/log" -o "$tmp/lid.h5"
        like "a lid of $m kg on springs, e $e: they keep or lose energy, and carry it" "$(jq -s '(map(.balance.dissipation) | min) > -2e-5 and (map(.balance.kinetic) | max) < 1e-3' "$tmp/log")" true
        [ $e = 1 ] || ok "and overlap by its force and the weights over k" near "$(last "$tmp/lid.h5" | jq -s '0.03 - .[1].x[2]')" "$(jq -n "(2 + 3 * $mass * 9.81) / 1e5")" 1e-6
        rm "$tmp/lid.h5"
    done
done

# ---- bytes, and the other way to make steps ----

# same NAME STEPS: threads, lanes, and a run that goes on from a frame give the same bodies
same()
{
    step -n "$2" --every "$2" -o "$tmp/one.h5" "$tmp/$1.h5"
    ok "$1: made in small steps" small
    step -j 3 -n "$2" --every "$2" -o "$tmp/three.h5" "$tmp/$1.h5"
    NSD_LANES=2 step -n "$2" --every "$2" -o "$tmp/lanes.h5" "$tmp/$1.h5"
    step -n $(($2 / 2)) --every $(($2 / 2)) "$tmp/$1.h5" | step -n $(($2 - $2 / 2)) --every "$2" -o "$tmp/again.h5"
    last "$tmp/one.h5" >"$tmp/bodies"
    for way in three lanes again; do ok "$1: the same bodies, $way" cmp "$tmp/bodies" <(last "$tmp/$way.h5"); done
    rm "$tmp"/{one,three,lanes,again}.h5
}
walls='walls: [{ box: { x: [-3e-3, 3e-3], y: [-3e-3, 3e-3], z: [0, null] } }]'
balls='bodies: [{ count: 60, radius: { uniform: [4e-4, 6e-4] }, box: { x: [-3e-3, 3e-3], y: [-3e-3, 3e-3], z: [0, null] } }]'
jq -n "{ dt: 2e-4, mu: 0.5, e_n: 0.5, seed: 3, stiffness: 2e3, rolling: { mu_r: 1e-4, mu_p: 1e-4 }, $walls, $balls }" | nsd-gen - >"$tmp/balls.h5"
same balls 200
jq -n "{ dt: 2e-4, mu: 0.5, e_n: 0.3, seed: 3, stiffness: 2e3, capillary: { volume: 1e-12, tension: 0.07 }, $walls, $balls }" | nsd-gen - >"$tmp/wet.h5"
same wet 200
jq -n "{ dt: 2e-4, mu: 0.5, seed: 3, stiffness: 2e3, adhesion: { c_n: 1e9, c_t: 5e8, w: 1e-4, forever: true }, $walls, $balls }" | nsd-gen - >"$tmp/glued.h5"
same glued 200
jq -n "{ dt: 2e-4, mu: 0.5, seed: 3, stiffness: 2e3, shapes: { brick: { box: [1, 1, 1] } }, $walls,
    bodies: [{ count: 12, shape: \"brick\", size: 1e-3, box: { x: [-3e-3, 3e-3], y: [-3e-3, 3e-3], z: [0, null] } }] }" | nsd-gen - >"$tmp/bricks.h5"
same bricks 100
step -n 1000 --every 1000 --log "$tmp/log" -o "$tmp/rest.h5" "$tmp/balls.h5"
like "a heap rests, and gains no energy" "$(jq -s '(map(.balance.dissipation / (.balance.kinetic + 1e-12)) | min > -1e-6) and .[-1].balance.kinetic < 1e-25' "$tmp/log")" true
nsd-step --small-steps 0 --tolerance 1e-6 -n 20 --every 20 -o "$tmp/once.h5" "$tmp/rest.h5" 2>/dev/null
like "it stays at rest with one solve per step" "$(nsd-info "$tmp/once.h5" | jq -s '.[-1].kinetic_energy < 1e-14')" true
step -n 20 --every 20 -o "$tmp/back.h5" "$tmp/once.h5"
like "and in small steps again" "$(nsd-info "$tmp/back.h5" | jq -s '.[-1].kinetic_energy < 1e-14')" true
rm "$tmp"/*.h5

# ---- bonds ----

jq -n '{ dt: 1e-3, mu: 0.3, adhesion: { c_n: 1e9, w: 1e9, area: 1e-4 },
    bodies: [{ x: [0, 0, 0], radius: 0.01, fixed: true }, { x: [0, 0, -0.02], radius: 0.01 }] }' | nsd-gen - | step -n 200 --every 200 -o "$tmp/weld.h5"
ok "a welded ball is made in small steps" small
ok "and hangs, its bond as long as its weight makes it" near "$(last "$tmp/weld.h5" | jq -s '-0.02 - .[1].x[2]')" "$(jq -n "$mass * 9.81 / 1e5")" 1e-3
# two discs that spin as one body: the bond carries m w^2 R
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, 0], mu: 0.3, adhesion: { c_n: 1e7, c_t: 1e7, w: 1000, made: 0 },
    bodies: [{ x: [-0.05, 0], radius: 0.05, v: [0, -0.5], w: 10 }, { x: [0.05, 0], radius: 0.05, v: [0, 0.5], w: 10 }] }' | nsd-gen - >"$tmp/spin.h5"
step -n 1000 --every 1000 --contacts -o "$tmp/spun.h5" "$tmp/spin.h5"
like "discs that spin as one body keep momentum and angular momentum" "$(nsd-info -p "$tmp/spin.h5" "$tmp/spun.h5" >/dev/null 2>&1; last "$tmp/spun.h5" | jq -s '
    (.[0].v[0] + .[1].v[0] | fabs < 1e-10) and (map(.mass * (.x[0] * .v[1] - .x[1] * .v[0]) + 0.5 * .mass * 0.0025 * .w[2]) | add) as $l |
    (.[0].mass * (2 * 0.05 * 0.5 + 0.0025 * 10)) as $was | ($l / $was - 1 | fabs) < 1e-3')" true
ok "and stretch by m w^2 R/(S c_n)" near "$(last "$tmp/spun.h5" | jq -s '[.[0].x, .[1].x] | transpose | map(.[0] - .[1] | . * .) | add | sqrt - 0.1')" \
    "$(last "$tmp/spun.h5" | jq -s '.[0].mass * 100 * 0.05 / 1e6')" 0.02
# pulled apart at 1 m/s: S sqrt(w c) at most, and w S in all, to first order
for direction in '[1,0,0] 1e10' '[0,1,0] 5e9' '[0,0,-1] 5e9'; do
    read -r v c <<<"$direction"
    for dt in 2.5e-7 6.25e-8; do
        jq -n --argjson dt $dt --argjson v "$v" '{ dt: $dt, gravity: [0, 0, 0], mu: 0.3, allow_overlap: true,
            adhesion: { c_n: 1e10, c_t: 5e9, w: 0.02, area: 1e-6 },
            bodies: [{ x: [0, 0, 0], radius: 1e-3, density: 1e12 }, { x: [(0.002 - $dt / 2 * $v[0]), 0, 0], radius: 1e-3, density: 1e12, v: $v }] }' |
            nsd-gen - | step -n "$(jq -n "7e-5 / $dt | floor")" --contacts --log "$tmp/log" -o "$tmp/pulled.h5"
        jq -n -c --argjson peak "$(nsd-info -c "$tmp/pulled.h5" | jq -s "map(.r | map(. * .) | add | sqrt) | max / $dt")" \
            --argjson broken "$(jq -s 'map(.balance.broken) | add' "$tmp/log")" "[\$peak / (1e-6 * (0.02 * $c | sqrt)) - 1, \$broken / 2e-8 - 1]"
        rm "$tmp/pulled.h5"
    done >"$tmp/bears"
    like "pulled along $v a bond bears S sqrt(w c), and costs w S, to first order" \
        "$(jq -s 'map(map(fabs)) | .[1][0] < 0.04 and .[1][1] < 0.04 and .[1][0] < 0.4 * .[0][0] and .[1][1] < 0.4 * .[0][1]' "$tmp/bears")" true
done
jq '.pairs[0].adhesion.c_n = 2e8 | .pairs[0].adhesion.c_t = 1e8' scenes/bonded.json | nsd-gen - >"$tmp/pillar.h5"
same pillar 100

# ---- what is made at once ----

jq -n '{ dt: 1e-3, stiffness: 1e12, bodies: [{ x: [0, 0, 0], radius: 0.01 }] }' | nsd-gen - | step -n 1 -o "$tmp/stiff.h5"
like "springs that need too many small steps are made at once, and that is said" "$(cat "$tmp/err")" 'no small steps with contacts or bonds so stiff that a step has more than 1000 small ones yet'
jq -n '{ dt: 1e-3, stiffness: 1e5, bodies: [{ x: [0, 0, 0], radius: 0.01 }] }' | nsd-gen - | nsd-step -n 1 -o "$tmp/default.h5" 2>"$tmp/err"
ok "small steps are the default with a stiffness" small
jq -n '{ dt: 1e-3, stiffness: "auto", bodies: [{ x: [0, 0, 0], radius: 0.01 }] }' | nsd-gen - | nsd-step -n 1 -o "$tmp/auto.h5" 2>"$tmp/err"
ok "and not with a compliance" test "$(grep -c "small ones" "$tmp/err")" = 0
jq -n '{ dt: 1e-3, stiffness: "auto", walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }], bodies: [{ x: [0, 0, 0.01], radius: 0.01 }] }' | nsd-gen - | step -n 100 --every 100 -o "$tmp/sunk.h5"
ok "a compliance in small steps is that of the whole step: alpha W F dt^2" near "$(last "$tmp/sunk.h5" | jq '0.01 - .x[2]')" "$(jq -n '0.01 * 9.81 * 1e-6')" 1e-4

done_testing
