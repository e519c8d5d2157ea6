#!/usr/bin/env bash
# Static and kinetic friction, belts, surfaces of several materials, pairs that do not act on each other, forces on single bodies in time: closed forms, the
# same bytes however a run is made, and scenes that are refused with the cure.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2016,SC2317 # tap.sh sets tmp; text for jq; functions called by name
. tests/support/tap.sh

step() { nsd-step "$@" 2>/dev/null; }
last() { nsd-info --last -p "$1" | jq -s "$2"; }
near() { jq -ne --argjson x "$1" --argjson y "$2" --argjson e "$3" '($x - $y | fabs) <= $e'; } # X Y TOLERANCE
every_way() # SCENE: the same bytes by threads, ranks, in pieces, and step by step
{
    nsd-gen "$1" >"$tmp/way.h5"
    step -j 1 -n 40 --every 20 -o "$tmp/way1.h5" "$tmp/way.h5"
    step -j 4 -n 40 --every 20 -o "$tmp/way4.h5" "$tmp/way.h5"
    nsd-info -p "$tmp/way1.h5" >"$tmp/way1"
    nsd-info -p "$tmp/way4.h5" | cmp - "$tmp/way1" || return 1
    step -n 20 --every 20 -o "$tmp/piece.h5" "$tmp/way.h5" && step -n 20 --every 20 --in-place "$tmp/piece.h5" || return 1
    nsd-info -p "$tmp/piece.h5" | cmp - "$tmp/way1" || return 1
    step --solver auto -n 3 "$tmp/way.h5" | nsd-info --last -p >"$tmp/three"
    nsd-detect "$tmp/way.h5" | nsd-solve 2>/dev/null | nsd-move | nsd-detect | nsd-solve 2>/dev/null | nsd-move |
        nsd-detect | nsd-solve 2>/dev/null | nsd-move | nsd-info -p | cmp - "$tmp/three" || return 1
    have_ranks || return 0
    step --solver auto -n 40 --every 20 -o "$tmp/way1.h5" "$tmp/way.h5"
    ranks 2 nsd-step --solver auto -j 1 -n 40 --every 20 -o "$tmp/way2.h5" "$tmp/way.h5" 2>/dev/null
    cmp <(nsd-info -p "$tmp/way2.h5") <(nsd-info -p "$tmp/way1.h5")
}

# ---- static and kinetic friction: a block on an incline, mu_s = 0.6, mu = 0.3, v_s = 0.01 m/s ----

block() # ANGLE V0: gravity is turned by the angle
{
    jq -n --argjson a "$1" --argjson v "$2" '{ dim: 2, dt: 1e-3, gravity: [9.81 * ($a | sin), -9.81 * ($a | cos)],
        mu: 0.3, mu_s: 0.6, v_s: 0.01, walls: [{ point: [0, 0], normal: [0, 1] }],
        shapes: { block: { polygon: [[-1, -0.5], [1, -0.5], [1, 0.5], [-1, 0.5]] } },
        bodies: [{ x: [0, 0.05], shape: "block", size: 0.1, v: [$v, 0] }] }'
}
block 0.5354 0 | nsd-gen - | step --solver auto -n 400 --every 400 >"$tmp/block.h5" # tan^-1 0.6 = 0.5404
ok "below tan^-1 mu_s a block stays" near "$(last "$tmp/block.h5" '.[0].x[0]')" 0 1e-7
block 0.5454 0 | nsd-gen - | step -n 500 --every 500 >"$tmp/block.h5"
# g (sin a - mu_s cos a) up to v_s, then g (sin a - mu cos a)
ok "above it starts, and slides with mu" near "$(last "$tmp/block.h5" '.[0].v[0]')" \
    "$(jq -n '0.5454 as $a | (9.81 * (($a | sin) - 0.6 * ($a | cos))) as $slow | (9.81 * (($a | sin) - 0.3 * ($a | cos))) as $fast |
        0.01 + $fast * (0.5 - 0.01 / $slow)')" 6e-3
block 0 1 | nsd-gen - | step -n 330 >"$tmp/block.h5"
nsd-info -p "$tmp/block.h5" | jq -s '[.[].v[0]] | [range(1; length) as $k | (.[$k - 1] - .[$k]) / 9.81e-3]' >"$tmp/slow"
ok "one that slides is braked by mu" near "$(jq '.[:300] | add / length' "$tmp/slow")" 0.3 1e-4
block 0.4 0 | jq '.bodies[0].v = [0.3, 0]' | nsd-gen - | step -n 300 --every 300 >"$tmp/block.h5"
ok "between the two angles it goes on sliding" near "$(last "$tmp/block.h5" '.[0].v[0]')" \
    "$(jq -n '0.3 + 0.3 * 9.81 * ((0.4 | sin) - 0.3 * (0.4 | cos))')" 2e-3
jq '.mu_s = 0.8 | .v_s = 1e-3 | .pairs[].mu_s = 1.2 | .bodies[0].count = 150' scenes/drum.json >"$tmp/drum.json"
ok "static friction: the same bytes by threads, ranks, in pieces, step by step" every_way "$tmp/drum.json"
block 0 0 | nsd-gen - >"$tmp/pairs.h5"
is "nsd-info shows it" "$(nsd-info "$tmp/pairs.h5" | jq -sc '[.. | objects | select(.mu_s != null) | [.mu, .mu_s, .v_s]] | unique')" '[[0.3,0.6,0.01]]'
is "a document without it has no dataset of it" "$(nsd-gen 3 | h5dump -n /dev/stdin 2>/dev/null | grep -c mu_s || true)" 0
says() # SCENE WHAT: it is refused with that
{
    jq "$1" "$tmp/refused.json" >"$tmp/no.json"
    ! nsd-gen "$tmp/no.json" >/dev/null 2>"$tmp/said" && grep -q "$2" "$tmp/said"
}
block 0 0 >"$tmp/refused.json"
ok "mu_s without v_s" says 'del(.v_s)' 'are given together'
ok "mu_s below mu" says '.mu_s = 0.1' 'must not be below mu'

# ---- belts ----

jq -n '{ dt: 1e-3, gravity: [0, 0, -10], mu: 0.3, walls: [{ rectangle: { center: [0, 0, 0], normal: [0, 0, 1], sides: [4, 1] }, belt: [1, 0, 5] }],
    bodies: [{ x: [0, 0, 0.05], radius: 0.05 }] }' | nsd-gen - >"$tmp/belt.h5"
step -n 200 --every 1 "$tmp/belt.h5" >"$tmp/belts.h5"
ok "a ball that is put on a belt of 1 m/s rolls with 2/7 m/s" near "$(last "$tmp/belts.h5" '.[0].v[0]')" 0.2857142857142857 1e-6
# the belt gives V times the momentum that friction gives: half of it is the ball's energy, and the rest is lost
m=$(nsd-info -p "$tmp/belt.h5" | jq .mass)
ok "the belt's work is V J, J = 2/7 m V" near "$(nsd-info "$tmp/belts.h5" | jq -s 'map(.balance.drives) | add')" "$(jq -n "2 / 7 * $m")" 1e-6
jq -n '{ dt: 1e-3, gravity: [0, 0, -10], mu: 0.5, walls: [{ point: [0, 0, 0], normal: [0, 0, 1], belt: [0, 2, 0] }], shapes: { block: { box: [0.2, 0.2, 0.1] } },
    bodies: [{ x: [0, 0, 0.05], shape: "block", size: 1 }] }' | nsd-gen - | step -n 200 --every 200 >"$tmp/block.h5"
ok "a block on a belt: v = mu g t" near "$(last "$tmp/block.h5" '.[0].v[1]')" 1 1e-6
# a roller: its belt turns with it, so that after a quarter turn what was along x is along y
jq -n '{ dt: 1e-3, gravity: [0, 0, -10], mu: 0.5, walls: [{ point: [0, 0, 0], normal: [0, 0, 1], belt: [1, 0, 0],
    drives: [{ about: [0, 0, 0], axis: [0, 0, 1], table: [[0, 1.5707963267948966]] }] }], shapes: { block: { box: [0.2, 0.2, 0.1] } },
    bodies: [{ x: [0, 0, 0.05], shape: "block", size: 1 }] }' | nsd-gen - | step -n 100 --every 100 >"$tmp/block.h5"
ok "a belt turns with its boundary" near "$(last "$tmp/block.h5" '.[0].v[1]')" 0.5 1e-6
is "a belt is in the document and nsd-info" "$(nsd-info --walls "$tmp/belt.h5" | jq -c .belt)" '[1,0,5]'
jq '.walls[0].belt = [0.3, 0, 0] | .walls[0].kind = "wall" | .pour[0].count = 60' scenes/pour.json >"$tmp/poured.json"
ok "belts: the same bytes however the run is made" every_way "$tmp/poured.json"

# ---- a surface of several materials: a strip of 8 squares, the second half ice ----

awk 'BEGIN { for (i = 0; i <= 8; i++) for (y = -1; y <= 1; y += 2) print "v", i, y, 0
    for (i = 0; i < 8; i++) print "f", 2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2 }' >"$tmp/strip.obj"
strip() { jq -n --argjson m "$1" '{ dt: 1e-3, gravity: [0, 0, -10], mu: 0.3, kinds: { ice: {} }, pairs: [{ pair: ["ball", "ice"], mu: 0 }],
    walls: [{ mesh: { file: "strip.obj" }, materials: $m }], shapes: { block: { box: [0.1, 0.1, 0.1] } },
    bodies: [{ x: [3.5, 0, 0.05], shape: "block", size: 1, v: [2.5, 0, 0] }] }' >"$tmp/strip.json"; }
strip '[{ "faces": [8, 15], "kind": "ice" }]'
nsd-gen "$tmp/strip.json" >"$tmp/strip.h5"
step -n 900 --every 900 "$tmp/strip.h5" >"$tmp/slid.h5"
# 0.5 m with mu g, then none: v^2 = 2.5^2 - 2 mu g s; while it crosses, the part of its length that is on ice has none
ok "a block slides onto ice and keeps its speed" near "$(last "$tmp/slid.h5" '.[0].v[0]')" "$(jq -n '6.25 - 2 * 3 * 0.5 | sqrt')" 5e-2
is "as fast as when it left the rest" "$(step -n 600 --every 600 "$tmp/strip.h5" | nsd-info -p | jq '.v[0] * 1e6 | round')" "$(last "$tmp/slid.h5" '.[0].v[0] * 1e6 | round')"
is "the part is a wall of its own" "$(nsd-info --walls "$tmp/strip.h5" | jq -sc 'map(.kind)')" '["wall","ice"]'
strip '[{ "faces": [0, 15], "belt": [1, 0, 0] }]'
jq '.bodies[0].v = [0, 0, 0]' "$tmp/strip.json" >"$tmp/moved.json"
ok "a part with a belt: v = mu g t" near "$(nsd-gen "$tmp/moved.json" | step -n 200 --every 200 | nsd-info -p | jq '.v[0]')" 0.6 1e-5
# a seam between two materials is no step: a ball rolls over it as over one surface
strip '[{ "faces": [8, 15], "kind": "wall" }]'
roll() { jq '.bodies = [{ x: [3.5, 0.3, 0.05], radius: 0.05, v: [1, 0, 0], w: [0, 20, 0] }]' "$1" >"$tmp/roll.json" && nsd-gen "$tmp/roll.json" |
    step --solver auto -n 900 --every 900 | nsd-info -p | jq -c '[.x[0], .v[2]] | map(. * 1e6 | round | fabs)'; }
is "a ball rolls over the seam" "$(roll "$tmp/strip.json")" '[4400000,0]'
strip '[{ "faces": [16, 16] }]' && cp "$tmp/strip.json" "$tmp/refused.json"
ok "a face that is not there" says . 'no face 16: the surface has 16'
ok "a face of two parts" says '.walls[0].materials = [{ faces: [0, 3] }, { faces: [3, 5] }]' 'face 3 is named twice'
ok "faces of a plane" says '.walls[0] = { point: [0, 0, 0], normal: [0, 0, 1], materials: [] }' 'materials'
ok "a load" says '.walls[0].load = { along: [0, 0, 1], mass: 1 }' 'its parts would move by themselves'
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, -10], mu: 0.3, kinds: { ice: {} }, pairs: [{ pair: ["ball", "ice"], mu: 0 }],
    walls: [{ polygon: { points: [[0, 0], [4, 0], [8, 0]], closed: false }, materials: [{ faces: [0, 0], kind: "ice" }] }],
    bodies: [{ x: [0.5, 0.1], radius: 0.1, v: [1, 0] }] }' | nsd-gen - | step -n 300 --every 300 >"$tmp/disc.h5"
ok "in the plane, too: on ice a disc does not begin to roll" near "$(last "$tmp/disc.h5" '.[0].w[2]')" 0 1e-9

# ---- inert pairs: a net that stops gravel and lets sand through ----

net='{ dt: 1e-3, gravity: [0, 0, -10], kinds: { sand: {}, gravel: {}, net: {} }, pairs: [{ pair: ["sand", "net"], acts: false }],
    walls: [{ rectangle: { center: [0, 0, 1], normal: [0, 0, 1], sides: [2, 2] }, kind: "net" }, { point: [0, 0, -9], normal: [0, 0, 1], kind: "net" }],
    shapes: { cube: { box: [1, 1, 1] } },
    bodies: [{ x: [0, 0, 1.2], radius: 0.1, kind: "sand" }, { x: [0.5, 0, 1.2], radius: 0.1, kind: "gravel" }, { x: [-0.5, 0, 1.2], radius: 0.1, kind: "sand", shape: "cube" },
        { x: [-0.5, 0.5, 1.2], radius: 0.1, kind: "gravel", shape: "cube" }] }'
jq -n "$net" >"$tmp/net.json"
nsd-gen "$tmp/net.json" | step -n 1000 --every 1000 -o "$tmp/net.h5"
is "sand falls through net as if nothing were there, h = g t^2/2; gravel stays" \
    "$(last "$tmp/net.h5" '[.[] | .x[2] * 1000 | round] | [.[0], .[1], .[2], (.[3] < 1200 and .[3] > 1040)]' | jq -c .)" '[-3800,1100,-3800,true]'
# two balls that meet, and an image across the border of a periodic cell; without the pair they would rebound or stop
meet='{ dt: 1e-2, gravity: [0, 0, 0], e_n: 0.5, cell: { lengths: [4, 4, 4] }, kinds: { a: {}, b: {} }, pairs: [{ pair: ["a", "b"], acts: false }],
    shapes: { cube: { box: [1, 1, 1] } },
    bodies: [{ x: [1, 2, 2], radius: 0.2, kind: "a", v: [1, 0, 0] }, { x: [2, 2, 2], radius: 0.2, kind: "b", v: [-1, 0, 0] },
        { x: [0.5, 1, 2], radius: 0.2, kind: "b", v: [-1, 0, 0], shape: "cube" }, { x: [3.5, 1, 2], radius: 0.2, kind: "a", v: [1, 0, 0] }] }'
speeds() { nsd-gen <(jq -n "$meet | $1") | step "${@:2}" | nsd-info --last -p | jq -sc 'map(.v[0])'; }
is "inert grains go through one another, across the border of a cell, too" "$(speeds . -n 100)" '[1,-1,-1,1]'
is "without the key they rebound" "$(speeds 'del(.pairs)' -n 100 | jq -c 'map(. * 1000 | round) | .[:2]')" '[-500,500]'
is "and fast ones are neither stopped on their ways nor said to go through" \
    "$(nsd-gen <(jq -n "$meet | .bodies[].v[0] *= 90") | nsd-step -n 3 --log "$tmp/fast.log" 2>"$tmp/err" | nsd-info --last -p | jq -sc 'map(.v[0])') $(grep -c 'NOT\|[1-9][0-9]* too fast' "$tmp/err" || true)" '[90,-90,-90,90] 0'
is "a kind may be inert to itself" "$(speeds '.pairs = [{ pair: ["a", "a"], acts: false }] | .bodies[].kind = "a"' -n 100)" '[1,-1,-1,1]'
is "bodies of an inert pair may overlap at the start" "$(nsd-gen <(jq -n "$meet | .bodies[1].x[0] = 1.1") | nsd-detect | nsd-info | jq -s 'map(.contacts | select(. != null))' | jq -c .)" '[0]'
jq -n "$net"' | del(.shapes) | .seed = 4 | .walls += [{ box: { x: [-1, 1], y: [-1, 1], z: [-2, null] }, kind: "wall" }] |
    .bodies = (["sand", "gravel"] | map({ count: 60, kind: ., radius: 0.1, box: { x: [-1, 1], y: [-1, 1], z: [(if . == "sand" then 1.2 else 2.2 end), null] }, v: [0, 0, -4] }))' >"$tmp/sieve.json"
ok "inert pairs: the same bytes however the run is made" every_way "$tmp/sieve.json"
cp "$tmp/net.json" "$tmp/refused.json"
ok "an inert pair with a law" says '.pairs[0].mu = 0.3' 'no other key'
if have_h5py; then
    nsd-gen "$tmp/net.json" | tail -c +513 >"$tmp/net0.h5"
    is "an inert pair is in the document, both ways" \
        "$(/usr/bin/python3 -c 'import h5py, sys; print(*map(list, zip(*h5py.File(sys.argv[1])["nsd/material/inert"][:].nonzero())))' "$tmp/net0.h5")" '[2, 4] [4, 2]'
    for value in 0.5 2 nan; do
        cp "$tmp/net0.h5" "$tmp/inert.h5"
        /usr/bin/python3 -c 'import h5py, sys; h5py.File(sys.argv[1], "r+")["nsd/material/inert"][...] = float(sys.argv[2])' "$tmp/inert.h5" "$value"
        refuses 65 "inert is $value in a document" nsd-info "$tmp/inert.h5"
    done
fi

# ---- forces on single bodies ----

jq -n '{ dt: 1e-3, gravity: [0, 0, 0], bodies: [range(3) | { x: [., 0, 0], radius: 0.1 }],
    forces: [{ bodies: [1], along: [0, 0, 2], force: 2 }, { bodies: [2], along: [1, 0, 0], force: { table: [[0, 0], [1, 4]] }, until: 0.8 },
             { bodies: [0, 1], about: [0, 0, 1], torque: { amplitude: 0.1, frequency: 2, mean: 0.01 } }] }' >"$tmp/forces.json"
nsd-gen "$tmp/forces.json" | step -n 1000 --every 1000 >"$tmp/forces.h5"
m=$(last "$tmp/forces.h5" '.[0].mass')
ok "a constant force: F t/m" near "$(last "$tmp/forces.h5" '.[1].v[2]')" "$(jq -n "2 / $m")" 1e-12
ok "a table until 0.8 s: 2 t^2/m" near "$(last "$tmp/forces.h5" '.[2].v[0]')" "$(jq -n "2 * 0.64 / $m")" 1e-12
ok "a torque: what its mean makes" near "$(last "$tmp/forces.h5" '.[0].w[2]')" "$(jq -n "0.01 / (0.4 * $m * 0.01)")" 1e-9
ok "their work is that of loads" near "$(nsd-gen "$tmp/forces.json" | step -n 100 | nsd-info | jq -s 'map(.balance.loads) | add')" \
    "$(nsd-gen "$tmp/forces.json" | step -n 100 | nsd-info --last | jq .kinetic_energy)" 1e-15
jq -n '{ dt: 1e-4, mu: 0.4, seed: 3, walls: [{ box: { x: [0, 0.05], y: [0, 0.05], z: [0, null] } }], bodies: [{ count: 60, radius: { uniform: [0.003, 0.005] } }],
    forces: [{ bodies: [3, 7, 20], along: [0, 0, 1], force: { amplitude: 0.01, frequency: 50, mean: 0.002 } }, { bodies: [7], about: [1, 0, 0], torque: 1e-6 }] }' >"$tmp/heap.json"
ok "forces: the same bytes however the run is made" every_way "$tmp/heap.json"
cp "$tmp/forces.json" "$tmp/refused.json"
ok "a body that is not there" says '.forces[0].bodies = [9]' 'no body has the id 9'
ok "a force without a direction" says 'del(.forces[0].along)' 'along'
ok "a force that ends before it begins" says '.forces[1].from = 1' 'must not lie before its beginning'

done_testing
