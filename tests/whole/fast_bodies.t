#!/usr/bin/env bash
# Bodies that meet within a step of small ones, however far they go in it: impacts in closed form, a row, the rate of impacts
# of a gas, a shot into a bed; no shape goes through another or through a thin wall. One solve per step: tests/tools/fast.t.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2016 # jq, tap.sh sets tmp
. tests/support/tap.sh

scene() # BODIES [MORE]: into $tmp/in.h5
{
    jq -n "{ gravity: [0, 0, 0], dt: 1e-3, bodies: ($1) } + (${2:-{\}})" | nsd-gen - >"$tmp/in.h5"
}
went() # STEPS [OPTION ...]: the bodies in the end as an array; the run fails where something is too fast, or overlaps
{
    nsd-step -e -n "$1" --every "$1" --contacts "${@:2}" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err" || return 1
    nsd-info -p --last "$tmp/out.h5" | jq -s -c 'map(select(.id != null)) | sort_by(.id)'
}
near() # VALUE WANTED ERROR: numbers, or arrays of them, as jq computes them
{
    jq -n "[($1), ($2) | [.. | numbers]] | (.[0] | length) == (.[1] | length) and (.[0] | length) > 0 and
        (transpose | all((.[0] - .[1] | fabs) <= $3 * (1 + (.[1] | fabs))))" | grep -qx true
}

# ---- two equal balls, one at rest 5 m ahead: they meet after 4.98 m / v, to the way of a small step ----

for v in 15 300 20000 3e6; do
    for e in 0 0.5 1; do
        scene "[{ x: [0, 0.1, 0.2], radius: 0.01, v: [$v, 0, 0] }, { x: [5, 0.1, 0.2], radius: 0.01 }]" "{ e_n: $e, dt: (6 / $v) }"
        now=$(went 1)
        # v1 = (1 - e) v/2, v2 = (1 + e) v/2; 1.02 m/v are left of the step of 6 m/v
        ok "at $v m/s, e $e: velocities in one step" near "$(jq -c "[.[] | .v[0] / $v]" <<<"$now")" "[(1 - $e) / 2, (1 + $e) / 2]" 1e-10
        ok "at $v m/s, e $e: places" near "$(jq -c '[.[] | .x[]]' <<<"$now")" \
            "[4.98 + 1.02 * (1 - $e) / 2, 0.1, 0.2, 5 + 1.02 * (1 + $e) / 2, 0.1, 0.2]" 1e-4
    done
done

# ---- an oblique impact of two discs with friction, to the turn of the normal in a small step ----

# sin of the normal: 0.6. Approach 0.8 v, slip 0.6 v; an impulse J along n and at most mu J across, which changes the slip by
# 6/m each N s, the approach by 2/m.
for mu in 0.1 2; do
    scene "[{ x: [0, 0], radius: 0.01, v: [4000, 0] }, { x: [5, 0.012], radius: 0.01 }]" "{ dim: 2, gravity: [0, 0], density: 1000, e_n: 0.5, mu: $mu, dt: 1.5e-3 }"
    now=$(went 1)
    jq -n --argjson mu $mu '(1000 * 3.141592653589793 * 1e-4) as $m | ($m * 1e-4 / 2) as $i | 4000 as $v |
        (1.5 * 0.8 * $v / (2 / $m)) as $n | ([$mu * $n, 0.6 * $v * $m / 6] | min) as $t | [$n * 0.8 + $t * 0.6, $n * 0.6 - $t * 0.8] as $j |
        { v: [$v - $j[0] / $m, -$j[1] / $m, $j[0] / $m, $j[1] / $m], w: (-0.01 * $t / $i), m: $m, i: $i,
          energy: ($m * $v * $v / 2) }' >"$tmp/wanted"
    ok "mu $mu: velocities" near "$(jq -c '[.[] | .v[0], .v[1]]' <<<"$now")" "$(jq -c .v "$tmp/wanted")" 5e-3
    ok "mu $mu: both turn alike" near "$(jq -c '[.[] | .w[2] | fabs]' <<<"$now")" "$(jq -c '.w | fabs | [., .]' "$tmp/wanted")" 5e-3
    ok "mu $mu: momentum" near "$(jq -c --slurpfile w "$tmp/wanted" '[(map(.v[0]) | add), (map(.v[1]) | add)]' <<<"$now")" '[4000, 0]' 1e-12
    ok "mu $mu: angular momentum" near "$(jq -c --slurpfile w "$tmp/wanted" \
        'map($w[0].m * (.x[0] * .v[1] - .x[1] * .v[0]) + $w[0].i * .w[2]) | add' <<<"$now")" 0 1e-8
    ok "mu $mu: the balance of energy closes" near "$(nsd-info "$tmp/out.h5" | jq 'select(.step == 1).balance | .kinetic + .dissipation')" "$(jq .energy "$tmp/wanted")" 1e-12
done

# ---- a row: a ball at 1e4 m/s against five that are apart by 0.2 m ----

scene '[{ x: [0, 0, 0], radius: 0.01, v: [1e4, 0, 0] }] + [range(5) | { x: [(3 + . * 0.22), 0, 0], radius: 0.01 }]' '{ e_n: 1, dt: 5e-4 }'
ok "through a row with gaps the velocity is handed on, and each stops where it has met the next" near "$(went 1 | jq -c '[.[] | .v[0], .x[0]]')" \
    '[0, 2.98, 0, 3.2, 0, 3.42, 0, 3.64, 0, 3.86, 1e4, 5 + 5 * 0.02]' 1e-4

# ---- a gas ----

# many, 20 times the usual path: energy, and the rate of collisions of kinetic theory, 4 n d^2 g sqrt(pi kT/m)
jq -n '[range(216)] | map({ x: [(. % 6 + 0.5) * 0.04, ((. / 6 | floor) % 6 + 0.5) * 0.04, ((. / 36 | floor) + 0.5) * 0.04], radius: 0.01 }) |
    { dt: 0.01, gravity: [0, 0, 0], e_n: 1, cell: { lengths: [0.24, 0.24, 0.24] }, bodies: . }' >"$tmp/swarm.json"
awk 'BEGIN { srand(3); for (i = 0; i < 216; i++) { for (k = 0; k < 3; k++) { s = -6; for (j = 0; j < 12; j++) s += rand(); printf "%.12f ", s } print "" } }' |
    jq -s -R --slurpfile s "$tmp/swarm.json" '[split("\n")[] | select(length > 0) | split(" ") | map(select(length > 0) | tonumber)] as $v |
        $s[0] | .bodies = [range(216) as $i | .bodies[$i] + { v: $v[$i] }]' | nsd-gen - >"$tmp/in.h5"
energy=$(nsd-info -p "$tmp/in.h5" | jq -s 'map(select(.v) | .v | map(. * .) | add) | add')
ok "a gas of 216 balls at 20 times the usual path: nothing passes, nothing overlaps by a tenth of a radius" \
    nsd-step -e -n 12 --contacts -o "$tmp/swarm.h5" "$tmp/in.h5"
ok "its energy is kept" near "$(nsd-info -p --last "$tmp/swarm.h5" | jq -s 'map(select(.v) | .v | map(. * .) | add) | add')" "$energy" 1e-5
rate=$(nsd-info "$tmp/swarm.h5" | jq -s '[.[] | select(.step > 2).contacts | numbers] | add / length')
theory=$(jq -n --argjson e "$energy" '216 as $n | (0.24 * 0.24 * 0.24) as $V | ($n * 4 / 3 * 3.141592653589793 * 1e-6 / $V) as $phi |
    ((1 - $phi / 2) / pow(1 - $phi; 3)) as $g | $n / 2 * 4 * ($n / $V) * 4e-4 * $g * (3.141592653589793 * $e / (3 * $n) | sqrt) * 0.01')
ok "$rate pairs meet in a step, by kinetic theory $theory impacts" jq -n -e "($rate / $theory - 1 | fabs) < 0.08"

# ---- what cannot be said of the sums of a step ----

scene "[{ x: [0, 0, 0], radius: 0.01, v: [400, 0, 0] }, { x: [0.1, 0, 0], radius: 0.01 }]" "{ e_n: 0.5 }"
nsd-step -n 1 --contacts -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
mass=$(nsd-info -p "$tmp/out.h5" | jq -s '.[1].mass')
nsd-stat -m energy "$tmp/out.h5" >"$tmp/log"
ok "the dissipation of a step: (1 - e^2)/4 m v^2 of two equal balls" \
    jq -e --argjson m "$mass" '.energy.dissipated / ((1 - 0.25) / 4 * $m * 160000) - 1 | fabs < 1e-9' "$tmp/log"
is "its parts are not known, and nsd-stat says why" \
    "$(jq -c '[.energy.impact, .energy.friction, (.why.energy | test("made at once"))]' "$tmp/log")" '[null,null,true]'
is "of a part of the bodies it is not known, and nsd-stat says why" \
    "$(nsd-stat -m energy --box -1,1,-1,1,-1,1 "$tmp/out.h5" | jq -c '[.energy.dissipated, (.why.energy | test("all bodies"))]')" '[null,true]'

# ---- shots ----

# a ball of 0.05 of the others' diameter into a fixed lattice, and into one that rests: it stays between the first layers
lattice='[range(5) as $i | range(5) as $j | range(5) as $k | { x: [0.1 + $i * 0.02 + ($j % 2) * 0.01, $j * 0.0174, $k * 0.02], radius: 0.01, MORE }]'
for more in 'fixed: true' 'v: [0, 0, 0]'; do
    for dt in 1e-5 1e-4; do
        scene "[{ x: [0, 0.0348, 0.0402], radius: 5e-4, v: [500, 0, 0] }] + ${lattice/MORE/$more}" "{ e_n: 0.2, mu: 0.3, dt: $dt }"
        now=$(went "$(jq -n "(0.02 / $dt) | ceil")")
        ok "a shot into a lattice ($more), dt $dt: it does not get through the first layer" \
            jq -n -e --argjson b "${now:-null}" '$b[0].x[0] < 0.13 + ($b[1:] | map(.x[0]) | min - 0.1)'
    done
done

# of each shape at each, at rest or towards it, with paths of some to hundreds of thicknesses: it stays on its side
shapes='{ ball: null, box: { box: [0.04, 1, 1] }, rod: { capsule: { length: 1, radius: 0.05 } },
    pair: { balls: [[-0.5, 0, 0, 0.5], [0.5, 0, 0, 0.5]] } }'
for shot in ball box rod pair; do
    for goal in ball box rod pair; do
        jq -n --arg s $shot --arg g $goal --argjson all "$(jq -n "$shapes")" '{ gravity: [0, 0, 0], dt: 1e-3, e_n: 0.3, mu: 0.2, shapes: ($all | del(.ball)),
            bodies: ([range(6) | . as $k | [1, 3, 7, 15, 30, 60][$k] as $path | (0.31 * $path) as $x |
                { body: $s, size: 0.01, x: [-$x, 0.002, $k], v: [($path * 1), 0, 0] },
                { body: $g, size: (if $k % 2 == 0 then 0.02 else 0.01 end), x: [0.03, 0, $k], v: (if $k < 3 then [0, 0, 0] else [-$path / 3, 0, 0] end) }] |
                map((if .body == "ball" then { radius: .size } else { shape: .body, size, orientation: [0, 1.5707963, 0.3] } end) + { x, v })) }' |
            nsd-gen - >"$tmp/in.h5"
        now=$(went 4)
        ok "each $shot that is shot at a $goal stays on its side" jq -n -e --argjson b "${now:-[]}" '($b | length) == 12 and
            all(range(6) as $k | $b[2 * $k].x[0] < $b[2 * $k + 1].x[0]; .)'
    done
done

# in the plane: polygons
jq -n '{ dim: 2, gravity: [0, 0], dt: 1e-3, e_n: 0.3, mu: 1, shapes: { slab: { points: [[-0.02, -1], [0.02, -1], [0.02, 1], [-0.02, 1]] } },
    bodies: [range(4) | . as $k | { shape: "slab", size: 0.02, x: [-0.15 * ($k + 1), 0.1 * $k], v: [90 * ($k + 1), 0] }, { shape: "slab", size: 0.02, x: [0, 0.1 * $k + 0.004], orientation: 3.1415927 }] }' | nsd-gen - >"$tmp/in.h5"
now=$(went 2)
ok "polygons do not go through polygons" jq -n -e --argjson b "${now:-[]}" '($b | length) == 8 and all(range(4) as $k | $b[2 * $k].x[0] < $b[2 * $k + 1].x[0]; .)'

# a sheet, a disc, a mesh, a thin fixed body on the way of a ball that goes 250 of its diameters in a step
for x in 4 4.003; do
    printf 'v %s -1 -1\nv %s 1 -1\nv %s 1 1\nv %s -1 1\nf 1 2 3\nf 1 3 4\n' $x $x $x $x >"$tmp/sheet.obj"
    ball='{ x: [0, 0.1, 0.2], radius: 0.01, v: [5000, 0, 0] }'
    while IFS=';' read -r what walls bodies; do
        jq -n "{ dt: 1e-3, gravity: [0, 0, 0], shapes: { thin: { box: [0.01, 2, 2] } }, walls: ($walls), bodies: ([$ball] + ($bodies)) }" >"$tmp/fast.json"
        nsd-gen "$tmp/fast.json" >"$tmp/in.h5"
        ok "$what at $x m" jq -n -e --argjson b "$(went 3)" "\$b[0].x[0] < $x and \$b[0].x[0] > $x - 0.03"
    done <<-END
		a sheet;[{ rectangle: { center: [$x, 0, 0], normal: [1, 0, 0], sides: [2, 2] } }];[]
		a sheet with its normal the other way;[{ rectangle: { center: [$x, 0, 0], normal: [-1, 0, 0], sides: [2, 2] } }];[]
		a disc;[{ disc: { center: [$x, 0, 0], normal: [1, 0, 0], radius: 1 } }];[]
		a mesh;[{ mesh: { file: "sheet.obj" } }];[]
		a thin fixed body;[];[{ x: [$x, 0, 0], shape: "thin", size: 1, fixed: true }]
	END
done

# ---- what is kept of such a step ----

scene "[{ x: [0, 0.1, 0.2], radius: 0.01, v: [5000, 0, 0] }, { x: [4, 0.1, 0.2], radius: 0.1 }]" '{ e_n: 0.5 }'
now=$(went 1 --forces)
ok "the forces of the frame are the momentum that was handed over, over dt" near \
    "$(nsd-info -c --last "$tmp/out.h5" | jq -s 'map(.r[0]) | add')" "$(nsd-info -p --last "$tmp/out.h5" | jq -s 'map(select(.id == 1) | .mass * .v[0])[0]')" 1e-10
is "their state says that they are sums" "$(nsd-info -c --last "$tmp/out.h5" | jq -r .status)" summed
is "and nsd-err judges no problem" "$(nsd-err "$tmp/out.h5")" '{"step":1,"substeps":true}'
is "the time is that of the step" "$(nsd-info --last "$tmp/out.h5" | jq -s 'map(.time | numbers)[0]')" 0.001

done_testing
