#!/usr/bin/env bash
# Clumps fitted to closed surfaces: mass and moments are the surface's, and the errors are as nsd-gen says.
# shellcheck source=tests/support/tap.sh disable=SC2016 # jq's variables
. tests/support/tap.sh

if ! has h5py; then
    echo "1..0 # SKIP no h5py"
    exit 0
fi
py tests/support/clump.py write "$tmp"
scene() # FILE BALLS [jq's change]
{
    jq -n --arg f "$1.obj" --argjson b "$2" '{dt: 1e-4, density: 2500, bodies: [{x: [0, 0, 3], shape: "g"}],
        shapes: {g: {mesh: {file: $f}, clump: {balls: $b}}}, walls: [{point: [0, 0, 0], normal: [0, 0, 1]}]}' | jq "${3-.}" >"$tmp/scene.json"
}
said() { jq -r ".clumps[0].$1" "$tmp/check"; }
for case in sphere:1:1 torus:30:1 ell:40:0.001; do
    IFS=: read -r name balls scale <<<"$case"
    scene "$name" "$balls" ".shapes.g.mesh.scale = $scale"
    ok "$name: it is made" sh -c "nsd-gen '$tmp/scene.json' >'$tmp/$name.h5' 2>'$tmp/$name.said'"
    like "$name: what it is worth is said" "$(cat "$tmp/$name.said")" "^nsd-gen: shape \"g\": $balls balls: volume .*, distance .*, moments .* of their sum$"
    nsd-gen --check "$tmp/scene.json" >"$tmp/check" 2>"$tmp/none"
    ok "$name: mass, centre and moments are the surface's; volume and distance as said" \
        py tests/support/clump.py judge "$tmp/$name.h5" "$tmp/$name.obj" "$scale" "$balls" "$(said volume)" "$(said distance)"
    ok "$name: the moments of the balls are not far off" jq -e '.clumps[0].moments < 0.03' "$tmp/check"
    nsd-gen "$tmp/scene.json" >"$tmp/again.h5" 2>"$tmp/none"
    ok "$name: the same balls again" cmp "$tmp/again.h5" "$tmp/$name.h5"
    nsd-info --scene "$tmp/$name.h5" | nsd-gen - >"$tmp/again.h5"
    ok "$name: the document needs no file any more" h5diff "$tmp/again.h5" "$tmp/$name.h5" /particles
    ok "$name: nor for the shape" sh -c "for d in vertex ball moment volume; do h5diff '$tmp/again.h5' '$tmp/$name.h5' /nsd/shape/\$d || exit 1; done"
done
is "the L weighs what three cubes weigh" "$(nsd-info -p "$tmp/ell.h5" | jq '.mass * 1e9 - 7500 * 1 | fabs < 1e-6')" true
scene torus 200 '.shapes.g.clump.error = 0.05'
nsd-gen --check "$tmp/scene.json" >"$tmp/check" 2>"$tmp/none"
is "fewer balls where the error allows it" "$(jq '.clumps[0] | .balls < 100 and .distance < 0.06' "$tmp/check")" true
# a pin falls through the hole of a ring, which its hull would have closed
jq '.bodies = [{x: [0, 0, 0.31], shape: "g", fixed: true}, {x: [0, 0, 1.4], radius: 0.5}] | .walls = [{point: [0, 0, -3], normal: [0, 0, 1]}] | .dt = 1e-3' \
    "$tmp/scene.json" >"$tmp/ring.json"
nsd-gen "$tmp/ring.json" 2>"$tmp/none" | nsd-step -n 900 --every 900 2>"$tmp/none" >"$tmp/ring.h5"
is "a ball falls through a ring" "$(nsd-info --last -p "$tmp/ring.h5" | jq -s '.[1].x[2] < -0.5')" true
for wrong in open inside plate; do
    scene "$wrong" 10
    refuses 65 "$wrong: no closed surface with something within" nsd-gen "$tmp/scene.json"
done
# the volume inside: nowhere twice, nowhere inside out; edges of cubes: 1 + 1, 8 - 1, 27 - 8 + 1
volume() { nsd-info -p "$1" | jq '.mass / 2500 * 1e9 | round / 1e9'; }
for case in apart:2 touching:2 hollow:7 island:20; do
    scene "${case%:*}" 100
    ok "${case%:*}: it is made" sh -c "nsd-gen '$tmp/scene.json' >'$tmp/one.h5' 2>'$tmp/none'"
    is "and has the volume of what is within" "$(volume "$tmp/one.h5")" "${case#*:}"
done
for case in overlapping outward; do
    scene "$case" 60
    refuses 65 "$case: a place that two solids share" nsd-gen "$tmp/scene.json"
    like "with the place and the cure" "$(cat "$tmp/err")" 'overlaps or encloses itself, as around \(.*unite its solids, and turn the faces of cavities inward$'
done
scene one_inside_out 60
refuses 65 "one of two cubes is turned inside out" nsd-gen "$tmp/scene.json"
like "with the place" "$(cat "$tmp/err")" 'inside out in parts, as around \(3\.5, '
for case in overlapping outward hidden; do
    scene "$case" 60 'del(.shapes.g.clump)'
    refuses 65 "$case: nor is it a polyhedron" nsd-gen "$tmp/scene.json"
    like "with the cause" "$(cat "$tmp/err")" 'encloses itself|inside out'
done
# walls of 1.6 points of the grid, for too few balls: the volume is the surface's, and nothing else
scene shell 40
refuses 65 "balls that leave out a part of the surface" nsd-gen "$tmp/scene.json"
like "with what they miss, what is allowed, and the cure" "$(cat "$tmp/err")" 'not what 40 balls fill: volume .*distance .*moments .* allowed: more balls, or thicker walls$'
scene torus 5
refuses 65 "five balls for a ring" nsd-gen "$tmp/scene.json"
for change in '.shapes.g.clump.balls = 0' '.shapes.g.clump.balls = 5000' '.shapes.g.clump.error = 2' '.shapes.g.mesh.hull = true' \
    'del(.shapes.g.clump.balls)' '.shapes.g.round = 0.1' '.shapes.g.clump.holes = 1' '.shapes.g = {box: [1, 1, 1], clump: {balls: 3}}' \
    '.shapes.g = {points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], solid: {}}' \
    '.shapes.g = {balls: [[0, 0, 0, 1]], solid: {volume: 1, centre: [0, 0, 0], inertia: [[1, 0, 0], [0, 1, 0], [0, 0, 9]]}}' \
    '.shapes.g = {balls: [[0, 0, 0, 1]], solid: {volume: -1, centre: [0, 0, 0], inertia: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}}' \
    '.shapes.g = {balls: [[0, 0, 0, 1]], solid: {volume: 1, centre: [0, 0, 0], inertia: [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]}}'; do
    scene torus 10 "$change"
    refuses 65 "$change" nsd-gen "$tmp/scene.json"
done
done_testing
