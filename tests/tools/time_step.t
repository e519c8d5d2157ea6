#!/usr/bin/env bash
# The time step: what suits a scene, and another one for a run.
# shellcheck source=tests/support/tap.sh disable=SC2016 # text for jq and eval; options
. tests/support/tap.sh

step() { nsd-step "$@" 2>/dev/null; }
checked() { jq -nc "$1" | nsd-gen --check - 2>/dev/null | jq -c "$2"; }
holds() { jq -e -n "$@" >/dev/null; } # a jq program that says true
near() { ok "$1" eval "jq -n -e '(($2) / ($3) - 1 | fabs) < 1e-9'"; }
limit() { echo ".limits[] | select(.limit == \"$1\").dt"; }
root="$PWD"
cd "$tmp"

# ---- suggestions, against numbers by hand ----

ball='{dt: 1e-5, bodies: [{x: [0, 0, 0.1], radius: 1e-3}], walls: [{point: [0, 0, 0], normal: [0, 0, 1]}]}'
near "gravity: sqrt(0.002 r / g)" "$(checked "$ball" "$(limit gravity)")" '0.002e-3 / 9.81 | sqrt'
# it falls until its column of (2 r)^2 is filled to 0.6 by 4/3 pi r^3
near "a fall: 0.05 r / sqrt(2 g h)" "$(checked "$ball" "$(limit fall)")" \
    '0.05e-3 / (2 * 9.81 * (0.101 - 4 / 3 * 3.14159265358979324 * 1e-9 / (0.6 * 4e-6)) | sqrt)'
# a disc above a segment, a metre above the bottom: it falls to the segment
shelf='{dim: 2, dt: 1e-5, bodies: [{x: [0, 0.1], radius: 1e-3}], walls: [{point: [0, -1], normal: [0, 1]}, {segment: [[-0.02, 0], [0.02, 0]]}]}'
to_shelf='0.05e-3 / (2 * 9.81 * (0.101 - 3.14159265358979324 * 1e-6 / (0.8 * 2e-3)) | sqrt)'
near "a fall on a shelf ends there" "$(checked "$shelf" "$(limit fall)")" "$to_shelf"
near "beside the shelf it does not" "$(checked "$shelf"' | .bodies[0].x[0] = 0.03' "$(limit fall)")" "${to_shelf/0.101/1.101}"
# two balls that touch each other and the wall of a round drum of 0.1 m; a third falls on them
second='(1 / 99 | asin * 2 | [0.099 * sin, -0.099 * cos])'
rest="$second"' as $at | {dt: 1e-5, walls: [{cylinder: {point: [0, 0, 0], axis: [0, 1, 0], radius: 0.1}}],
    bodies: [{x: [0, 0, -0.099], radius: 1e-3}, {x: [$at[0], 0, $at[1]], radius: 1e-3}]}'
is "balls that rest in a round drum do not fall" "$(checked "$rest" '[.limits[] | select(.limit == "fall")] | length')" 0
near "a ball above them falls, on them" \
    "$(checked "$rest"' | .bodies += [{x: [0, 0, -0.09], radius: 1e-3}]' "$(limit fall)")" \
    "$second"' as $at | 0.05e-3 / (2 * 9.81 * (-0.09 - $at[1] - 4 / 3 * 3.14159265358979324 * 1e-9 / (0.6 * 2e-3 * ($at[0] + 2e-3))) | sqrt)'
# ---- a scene without a dt ----

chosen() { jq -nc "$1 | del(.dt)" | nsd-gen - | nsd-info | jq "select(.dt).dt"; }
is "sqrt(0.002 r / g) = 4.52e-4 s, of which 2e-4 is chosen" "$(chosen "$ball")" "$(jq -n 2e-4)"
is "of balls 1.3 times as large 5e-4" "$(chosen "$ball"' | .bodies[0].radius = 1.3e-3')" "$(jq -n 5e-4)"
is "where nothing accelerates, the suggestion for impacts" "$(chosen "$ball"' | .gravity = [0, 0, 0] | .bodies[0].v = [0, 2, 0]')" "$(jq -n 2e-5)"
is "a dt that is chosen does not adapt" "$(jq -nc "$ball | del(.dt)" | nsd-gen - | nsd-step -n 3 2>/dev/null | nsd-info --last -l | jq .time)" "$(jq -n '3 * 2e-4')"
is "and is the one of --check" "$(checked "$ball | del(.dt)" '[.scene, .interval]')" "$(jq -nc '[2e-4, 2e-4]')"

# ---- suggestions ----

is "the least counts, by its first two digits" "$(checked "$ball" '.dt == 3.5e-5 and .by == "fall"')" true
near "a start with 2 m/s" "$(checked "$ball"' | .gravity = [0, 0, 0] | .bodies[0].v = [0, 2, 0]' .dt)" 2.5e-5
drum='{dt: 1, dim: 2, gravity: [0, 0], bodies: [{x: [0, -0.05], radius: 1e-3}],
    walls: [{circle: {center: [0, 0], radius: 0.1}, drives: [{about: [0, 0], speed: 2}]}]}'
near "a drum's wall where the discs are: 0.05 r / (w R)" "$(checked "$drum" "$(limit wall)")" 5e-4
near "its turn: 0.02 / w" "$(checked "$drum" "$(limit turn)")" 0.01
near "drives that follow one another are not added" "$(checked "$ball"' | .walls[0].drives =
    [{along: [0, 0, 1], speed: 1, from: 0, until: 1}, {along: [0, 0, 1], speed: 2, from: 1, until: 2}]' "$(limit wall)")" 2.5e-5
near "those that overlap are" "$(checked "$ball"' | .walls[0].drives =
    [{along: [0, 0, 1], speed: 1, from: 0, until: 1.5}, {along: [0, 0, 1], speed: 2, from: 1, until: 2}]' "$(limit wall)")" '0.05e-3 / 3'
near "a drive of 50 Hz: 1/200 of its period" \
    "$(checked "$ball"' | .walls[0].drives = [{along: [0, 0, 1], amplitude: 1e-9, frequency: 50}]' "$(limit period)")" 1e-4
cell='{dt: 1, dim: 2, gravity: [0, 0], density: 1000, bodies: [{x: [0.1, 0.1], radius: 0.01}],
    cell: {lengths: [0.2, 0.4], stress: {pressure: 100, mass: 3}}}'
near "a pressure: sqrt(0.001 m / P) of discs" "$(checked "$cell" "$(limit pressure)")" '0.001 * 1000 * 3.14159265358979324 * 1e-4 / 100 | sqrt'
near "and of its edge, sqrt(0.002 r M / F)" "$(checked "$cell" "$(limit load)")" '0.002 * 0.01 * 3 / (100 * 0.4) | sqrt'
near "an edge's mass is 3/(4 pi^2) of all" "$(checked "$cell" '.masses[0].mass')" '3 / (4 * 3.14159265358979324) * 1000 * 1e-4'
near "simple shear at 5/s: 0.001 / L" \
    "$(checked "$cell"' | .cell = {lengths: [0.2, 0.4], gradient: [[0, 5], [0, 0]], affine: true}' "$(limit strain)")" 2e-4
is "the flow itself is no approach" \
    "$(checked "$cell"' | .cell = {lengths: [0.2, 0.4], gradient: [[0, 5], [0, 0]], affine: true}' .by)" '"strain"'
piston='{dt: 1e-3, gravity: [0, 0, 0], bodies: [{x: [0, 0, 0.01], radius: 0.01}, {x: [0.06, 0.02, 0.01], radius: 0.01}],
    walls: [{point: [0, 0, 0.05], normal: [0, 0, -1], load: {along: [0, 0, 1], mass: 0.5, force: -4}}]}'
near "a piston: its force over the face that the balls span" "$(checked "$piston" '.limits[] | select(.limit == "pressure").value')" \
    '4 / (0.08 * 0.04) * 4e-4 / (2500 * 4 / 3 * 3.14159265358979324 * 1e-6)'
near "and a mass of one layer" "$(checked "$piston" '.masses[] | select(.wall == 0).mass')" \
    '2500 * 4 / 3 * 3.14159265358979324 * 1e-6 / 4e-4 * 0.08 * 0.04'
is "of a dt too long for one solve per step there is a remark" "$(jq -nc "$ball"' | .dt = 1e-2' | nsd-gen --check - 2>&1 >/dev/null | grep -c 'dt = 0.01 s of the scene is')" 1
ok "and ends with 0, without a document" eval "jq -nc '$ball | .dt = 1e-2' | nsd-gen --check - 2>/dev/null | jq -e .dt >/dev/null"
ok "all scenes have a suggestion" eval 'for scene in "$root"/scenes/{drum,silo,press,shear}.json; do nsd-gen --check $scene 2>/dev/null | jq -e ".dt > 0" || exit 1; done >/dev/null'

jq -nc "$ball"' | .dt = "auto"' >auto.json
nsd-gen auto.json >auto.h5
is "\"auto\" takes it" "$(nsd-info auto.h5 | jq -s '.[0].dt == 3.5e-5')" true
refuses 65 "where nothing moves auto is refused" eval "jq -nc '$ball | .gravity = [0, 0, 0] | .dt = \"auto\"' | nsd-gen -"
refuses 65 "and so is another word" eval "jq -nc '$ball | .dt = \"fast\"' | nsd-gen -"

# ---- another dt ----

now() { nsd-info --last "$1" | jq -c '[.step, .time]'; }
echo '{"dt": 1e-3, "gravity": [0, 0, 0], "bodies": [{"x": [0, 0, 0], "v": [1, 0, 0], "radius": 0.1}]}' | nsd-gen - | step -n 10 >ten.h5
step -n 20 --dt 5e-4 --every 20 ten.h5 >half.h5
is "--dt: 20 steps of half a dt are 10 of a whole" "$(now half.h5)" '[30,0.02]'
is "which the document has then" "$(nsd-info half.h5 | jq -s '.[0].dt')" 0.0005
step -n 10 --dt 5e-4 ten.h5 | step -n 10 >pieces.h5
ok "in pieces the same bits" cmp <(nsd-info -p --last half.h5) <(nsd-info -p --last pieces.h5)
step --until 1 --dt 3e-4 --every 10000 ten.h5 >third.h5
is "--until with another dt" "$(nsd-info --last third.h5 | jq '.step == 3310 and (.time - 1 | fabs) < 1e-15')" true
for bad in 0 -1 nan inf 1e-3x '' auto auto: auto:0 auto:-1 auto:2 auto:nan; do
    refuses 64 "--dt '$bad' is refused" nsd-step --dt "$bad" ten.h5
done
step -n 1 -o one.h5 ten.h5
refuses 64 "in place a trajectory has one dt" nsd-step -i --dt 5e-4 one.h5
refuses 64 "one that adapts is refused" nsd-step --dt auto:0.01 one.h5
like "with what there is instead" "$(nsd-step --dt auto:0.01 one.h5 2>&1)" 'leave dt out, for small steps'
refuses 65 "one that does not change the time" nsd-step --dt 1e-30 ten.h5

# ---- documents of versions whose time step adapted have one of each frame ----

if have_h5py; then
    step -n 3 --dt 1e-3 -o three.h5 ten.h5
    foreign three.h5 set.h5
    own() { cp set.h5 old.h5 && /usr/bin/python3 -c "import h5py
f = h5py.File('old.h5', 'r+')
f['nsd/time_step/value'] = [1e-3] * (f['particles/all/position/step'].shape[0] - 1) + [$1]"; }
    own 5e-4
    step -n 1 --every 1 -o next.h5 old.h5
    is "a run goes on with the last one" "$(nsd-info next.h5 | jq -s '.[0].dt')" 0.0005
    ok "nsd.py has the frame's dt" env PYTHONPATH="$root/python" /usr/bin/python3 -c "import nsd
assert nsd.last('old.h5').dt == 5e-4"
    for bad in 3e-3 0 'float("nan")' -1e-3; do
        own "$bad"
        refuses 65 "a frame's dt of $bad is refused" nsd-step old.h5
    done
else
    skip "frames that others have written" "no h5py"
fi
if have_ranks; then
    jq -nc '{dt: 4e-3, bodies: [{x: [0, 0, 0.2], radius: 0.01}, {x: [0, 0.001, 0.15], radius: 0.02}, {x: [0.1, 0, 0.3], radius: 0.015}],
        mu: 0.3, e_n: 0.5, walls: [{point: [0, 0, 0], normal: [0, 0, 1]}]}' | nsd-gen - >start.h5
    ranks 2 nsd-step --until 0.4 --dt 1e-3 -o mpi.h5 start.h5 2>/dev/null
    step --until 0.4 --dt 1e-3 -o one.h5 start.h5
    ok "several processes make the same steps of another dt" cmp one.h5 mpi.h5
else
    skip "several processes" "no MPI"
fi

done_testing
