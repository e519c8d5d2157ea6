#!/usr/bin/env bash
# Grains come and go, packings become scenes again, and runs go on in their own file.
# shellcheck source=tests/support/tap.sh disable=SC2016,SC2034,SC2317 # functions, and variables, named in what ok evaluates
. tests/support/tap.sh

scenes=$PWD/scenes
cd "$tmp"

# The last frame's particles and passages, bit by bit, of documents of one frame
last() { nsd-cat --last "$1"; }
same_last() # ONE OTHER: also what is remembered of the pours
{
    last "$1" >one.last && last "$2" >other.last && same_particles one.last other.last &&
        cmp <(dump one.last /nsd/flow/poured) <(dump other.last /nsd/flow/poured) &&
        cmp <(dump one.last /nsd/flow/removed_mass) <(dump other.last /nsd/flow/removed_mass)
}
every_frame() { nsd-info "$1" | jq -s -e "map(select(.step != null)) | $2"; }

# ---- pours and removals ----

n=1200 half=600
nsd-gen "$scenes/pour.json" >pour.h5
nsd-step -n $n pour.h5 2>/dev/null >whole.h5
{
    ok "the bodies of every frame are those poured less those removed, and some are removed" \
        every_frame whole.h5 'all(.bodies == .poured[0].bodies - .removed[0].bodies) and .[-1].removed[0].bodies > 200'
    ok "so is their mass, to rounding" eval '
        nsd-info --last -p whole.h5 | jq -s "map(.mass) | add" >mass &&
        every_frame whole.h5 ".[-1] | (.poured[0].mass - .removed[0].mass) / $(cat mass) - 1 | fabs < 1e-12"'
    ok "grain k of 20000 a second is poured at the first step at or after k / 20000 s, or waits" \
        every_frame whole.h5 'all(.poured[0].bodies <= 20000 * .time + 1e-6) and .[199].poured[0].bodies >= 195'
    nsd-info --events whole.h5 >events
    ok "each event is in the file once: a body comes once, under a number of its own, and goes once" \
        jq -s -e 'group_by(.id) | all(map(.event) | . == ["poured"] or . == ["poured", "removed"])' events
    ok "the numbers are those of coming, from 0" \
        jq -s -e 'map(select(.event == "poured").id) | . == [range(length)]' events
    ok "removed bodies are beyond the edge, by less than a step's way" \
        jq -s -e 'map(select(.event == "removed")) | all(([.position[0], .position[1]] | map(fabs) | max) as $far | $far > 4e-3 and $far < 4.2e-3)' events
    ok "poured bodies begin in the opening" \
        jq -s -e 'map(select(.event == "poured")) | all(.position[2] == 8e-3 and .position[0] * .position[0] + .position[1] * .position[1] <= 9.0000001e-6 and .velocity == [0, 0, -0.5])' events
    ok "their sizes are those asked for, as often small as large" \
        jq -s -e 'map(select(.event == "poured").radius) | all(. >= 2.5e-4 and . <= 5e-4) and ((add / length) / 3.75e-4 - 1 | fabs < 0.03)' events
    ok "no two bodies overlap by more than a run leaves, for they come where there is room" \
        eval 'nsd-step --contacts -n 200 pour.h5 2>/dev/null | nsd-info -c | jq -s -e "all(.gap > -2.5e-5)"'
}

nsd-step -n $half pour.h5 2>/dev/null >first.h5
nsd-step -n $half first.h5 2>/dev/null >second.h5
ok "a run in two pieces is the run, bit for bit" same_last whole.h5 second.h5
nsd-step -n 7 pour.h5 2>/dev/null | nsd-step -n 93 2>/dev/null | nsd-step -n 500 2>/dev/null >third.h5
ok "wherever it is cut, and through pipes" same_last first.h5 third.h5
nsd-step -n $half -j 2 --warm pour.h5 2>/dev/null >two.h5
nsd-step -n $half --warm pour.h5 2>/dev/null >one.h5
ok "2 threads give the same bytes" cmp one.h5 two.h5
nsd-step -n $half pour.h5 2>/dev/null | cat >stream.h5
nsd-cat -o packed.h5 stream.h5
ok "what nsd-cat packs from a stream is what nsd-step writes" cmp first.h5 packed.h5
chain()
{
    last first.h5 >chain.h5
    for _ in 1 2 3 4 5 6 7 8; do
        nsd-detect chain.h5 | nsd-solve 2>/dev/null | nsd-move >next.h5 && mv next.h5 chain.h5 || return
    done
    nsd-step --solver auto -n 8 first.h5 2>/dev/null >eight.h5
    same_last chain.h5 eight.h5
}
ok "nsd-detect | nsd-solve | nsd-move is a step of a pour, too" chain
ok "detecting twice pours once" eval 'nsd-detect first.h5 | nsd-cat --last | nsd-detect >twice.h5 && nsd-cat --last first.h5 | nsd-detect >once.h5 && same_particles once.h5 twice.h5'
ok "the solutions of a run with pours are checked from their contacts" \
    eval 'nsd-step -n 300 --contacts pour.h5 2>/dev/null | nsd-err | jq -s -e "length == 300 and all(.max_penetration_true < 0.01)"'
if have_h5py; then
    cat >rows.py <<'EOF'
import h5py, numpy as np
with h5py.File("whole.h5") as f:
    p = f["particles/all"]
    id, x, radius = p["id/value"][:], p["position/value"][:], p["radius"][:]
    here = id >= 0
    assert here.shape[1] <= p["position/value"].maxshape[1] and (here.sum(1)[-1] > 0)
    assert (id[here] == np.broadcast_to(np.arange(id.shape[1]), id.shape)[here]).all()  # a row for ever
    assert np.isfinite(x[here]).all() and np.isnan(x[~here]).all()
    poured = f["nsd/flow/poured/value"][:, 0]
    removed = f["nsd/flow/removed/value"][:, 0]
    assert (here.sum(1) == poured - removed).all() and len(radius) == poured[-1]
    assert (p["id/step"][:] == p["position/step"][:]).all()
EOF
    ok "h5py finds a row a body, NaN and id -1 where it is not there" py rows.py
else
    skip "h5py finds a row a body" "no h5py"
fi

by_mass='{"dt": 1e-4, "gravity": [0, 0, 0], "pour": [{"mass_rate": 0.01, "opening": {"box": {"x": [0, 0.1], "y": [0, 0.1], "z": [0, 0.1]}},
    "radius": {"uniform": [3e-4, 6e-4]}, "from": 0.01, "until": 0.05}]}'
nsd-gen - <<<"$by_mass" | nsd-step -n 800 --every 100 2>/dev/null >mass.h5
ok "a pour by mass brings its rate, to a grain, from its beginning to its end" \
    every_frame mass.h5 '.[0].bodies <= 1 and (.[-1].poured[0].mass - 4e-4 | fabs < 2.3e-6) and .[-1].bodies == .[-3].bodies'
count='{"dt": 1e-4, "dim": 2, "pour": [{"rate": 1e5, "count": 40, "opening": {"disc": {"center": [0, 0], "normal": [0, 1], "radius": 0.05}},
    "radius": 1e-3, "material": "ball"}], "remove": [{"below": {"point": [0, -0.1], "normal": [0, 1]}}, {"inside": {"x": [0, 1], "y": [-0.01, -0.005]}, "material": "ball"}]}'
nsd-gen - <<<"$count" | nsd-step -n 2000 --every 500 2>/dev/null >count.h5
ok "a count ends a pour; each removal has its own account; discs, too" \
    every_frame count.h5 '.[-1] | .poured[0].bodies == 40 and .removed[0].bodies + .removed[1].bodies == 40 and .bodies == 0 and (.removed | all(.bodies > 5))'
jq -c '.pour[0].radius = 5 | .pour[0].count = 3' <<<"$count" | nsd-gen - | nsd-step -n 10 2>/dev/null >wait.h5
ok "where there is room for one, the others wait" every_frame wait.h5 '.[-1].bodies == 1'

refuses 65 "an opening has to be closed" nsd-gen - <<<'{"dt": 1, "pour": [{"rate": 1, "radius": 1, "opening": {"box": {"x": [0, 1]}}}]}'
like "with line and column" "$(cat err)" '1:57: pour\[0\].opening.box: an opening needs a closed box, y is open'
refuses 65 "a removal is of one kind" nsd-gen - <<<'{"dt": 1, "remove": [{"below": {"point": [0, 0, 0], "normal": [0, 0, 0]}}]}'
like "and its plane has a normal" "$(cat err)" 'remove\[0\].below.normal: must not be zero'

# ---- a packing becomes a scene again ----

particles() { nsd-info -p "$@" | jq -c 'del(.step)'; }
ok "a scene of a document has its bodies, with their motion and numbers" \
    eval 'nsd-info --scene whole.h5 | nsd-gen - >again.h5 && cmp <(particles --last whole.h5) <(particles again.h5)'
ok "and its time, and goes on: what is poured has new numbers" \
    eval 'nsd-step -n 40 again.h5 2>/dev/null >on.h5 && every_frame on.h5 ".[-1].poured[0].bodies > 10" &&
        nsd-info -p --last on.h5 | jq -s -e "map(.id) | length == (unique | length)"'
nsd-gen "$scenes/piston.json" | nsd-step -n 50 2>/dev/null >piston.h5
ok "walls that move go on from where they were" \
    eval 'nsd-info --scene piston.h5 | nsd-gen - >moved.h5 &&
        cmp <(nsd-info -w --last piston.h5 | jq -c "del(.step)") <(nsd-info -w moved.h5 | jq -c "del(.step)")'
ok "and do so in a scene without walls and time" \
    eval 'nsd-info --scene piston.h5 | jq "del(.walls, .time)" | nsd-gen - >moved.h5 &&
        cmp <(nsd-info -w --last piston.h5 | jq -c "del(.step)") <(nsd-info -w moved.h5 | jq -c "del(.step)")'
ok "a run that goes on from the scene is the run, bit for bit, from r = 0: contacts are found anew" \
    eval 'nsd-info --scene piston.h5 | nsd-gen - | nsd-step --cold -n 20 2>/dev/null >new.h5; nsd-step --cold -n 20 piston.h5 2>/dev/null >old.h5;
        cmp <(particles --last new.h5) <(particles --last old.h5)'
ok "jq changes what it likes: friction, gravity, the walls, bodies at rest and of one kind" \
    eval 'nsd-info --scene piston.h5 | jq ".mu = 0.7 | .gravity = [1, 0, -9] | .walls = [] |
            .materials = {steel: {density: 7800}} | .bodies[0] += {at_rest: true, material: \"steel\", density: 7800}" | nsd-gen - >changed.h5 &&
        nsd-info changed.h5 | jq -s -e ".[0] | .walls == 0 and .gravity == [1, 0, -9] and (.material | all(.mu == 0.7))" &&
        nsd-info -p changed.h5 | jq -s -e "all(.v == [0, 0, 0] and .w == [0, 0, 0] and .material == \"steel\")"'
ok "any frame may be taken, also counted from the end" \
    eval 'nsd-gen - <<<"{\"dt\": 1e-4, \"bodies\": [{\"document\": \"piston.h5\", \"frame\": 9}]}" >nine.h5 &&
        nsd-gen - <<<"{\"dt\": 1e-4, \"bodies\": [{\"document\": \"piston.h5\", \"frame\": -41}]}" >ninth.h5 &&
        cmp <(particles nine.h5) <(particles ninth.h5) && cmp <(particles nine.h5) <(particles --frames 10 piston.h5)'
refuses 65 "a frame has to be there" nsd-gen - <<<'{"dt": 1, "bodies": [{"document": "piston.h5", "frame": 50}]}'
refuses 66 "and the document" nsd-gen - <<<'{"dt": 1, "bodies": [{"document": "none.h5"}]}'
refuses 65 "a kind that the scene does not name" eval \
    'nsd-gen '"$scenes"'/impact.json >impact.h5 && nsd-gen - <<<"{\"dt\": 1, \"bodies\": [{\"document\": \"impact.h5\"}]}"'
refuses 65 "a document in the plane is none of space" eval \
    'nsd-gen -d 2 9 >flat.h5 && nsd-gen - <<<"{\"dt\": 1, \"bodies\": [{\"document\": \"flat.h5\"}]}"'
refuses 65 "a new body must not overlap" nsd-gen - \
    <<<"$(nsd-info --scene piston.h5 | jq --argjson x "$(nsd-info -p --last piston.h5 | head -n 1 | jq .x)" '.bodies += [{$x, radius: 1e-4}]')"

# ---- tables with named columns ----

scene='{"dt": 1, "materials": {"steel": {"density": 7800}}, "bodies": [{"file": "table.txt"}]}'
printf '%s\n' '# id kind vz d x y z  wx' '7 steel 0.5 2e-3 1 2 3 9 # the first' '' '3 ball 0 4e-3 4 5 6 0' >table.txt
ok "a table's first line names its columns" \
    eval 'nsd-gen - <<<"$scene" | nsd-info -p | jq -s -e "map([.id, .material, .radius, .x, .v, .w]) == [[7, \"steel\", 1e-3, [1, 2, 3], [0, 0, 0.5], [9, 0, 0]], [3, \"ball\", 2e-3, [4, 5, 6], [0, 0, 0], [0, 0, 0]]]"'
ok "masses follow the kinds' densities" \
    eval 'nsd-gen - <<<"$scene" | nsd-info -p | jq -s -e "(.[0].mass / 7800 * 8) / (.[1].mass / 2500) - 1 | fabs < 1e-12"'
bad_table() # WHAT REGEX LINE ...
{
    printf '%s\n' "${@:3}" >table.txt
    refuses 65 "a bad table: $1" nsd-gen - <<<"$scene"
    like "$1, with file and line" "$(cat err)" "$2"
}
bad_table "an unknown column" 'table.txt:1: no column is called "colour"' '# x y z r colour' '1 2 3 4 5'
bad_table "a column twice" 'table.txt:1: named twice: the column "x"' '# x y z r x' '1 2 3 4 5'
bad_table "no radius" 'table.txt:1: there is no column "r"' '# x y z kind' '1 2 3 ball'
bad_table "too few words" 'table.txt:3: not as many words as columns' '# x y z r' '1 2 3 4' '1 2 3'
bad_table "too many" 'table.txt:2: not as many words as columns' '# x y z r' '1 2 3 4 5'
bad_table "no number" 'table.txt:2: r: not a number: "four"' '# x y z r' '1 2 3 four'
bad_table "no kind" 'table.txt:2: the scene names no material "wood"' '# x y z r kind' '1 2 3 4 wood'
bad_table "one number for two" 'body 1: another one has its id, 5' '# x y z r id' '1 2 3 1 5' '4 5 6 1 5'
bad_table "a number that is none of bodies" 'table.txt:2: an id must be a whole number: "0.5"' '# x y z r id' '1 2 3 1 0.5'
bad_table "neither fixed nor free" 'table.txt:2: fixed must be 0 or 1: "2"' '# x y z r fixed' '1 2 3 1 2'
bad_table "half an orientation" 'table.txt:1: an orientation is qw qx qy qz' '# x y z r qw qx' '1 2 3 1 1 0'
bad_table "an orientation that is no rotation" 'table.txt:2: qw qx qy qz is no unit quaternion' '# x y z r qw qx qy qz' '1 2 3 1 1 1 0 0'
bad_table "radius and diameter" 'table.txt:1: both r and "d"' '# x y z r d' '1 2 3 1 2'
bad_table "mass and density" 'table.txt:1: both mass and "density"' '# x y z r mass density' '1 2 3 1 2 3'
bad_table "no height" 'table.txt:1: there is no column "z"' '# x y r' '1 2 1'
printf '%s\n' '# x y z r qw qx qy qz fixed mass' '1 2 3 1 0 1 0 0 1 5' '5 2 3 1 0.6 0 0.8 0 0 5' >table.txt
ok "orientations, masses, and bodies that are fixed" \
    eval 'nsd-gen - <<<"$scene" | nsd-info -p | jq -s -e "map([.mass, .q]) == [[0, [0, 1, 0, 0]], [5, [0.6, 0, 0.8, 0]]]"'
jq -c '.dim = 2' <<<"$scene" >plane.json
printf '%s\n' '# x y r z' '1 2 1 0' >table.txt
refuses 65 "a height in the plane" nsd-gen plane.json
printf '%s\n' '# x y r wz vx' '1 2 1 3 4' >table.txt
ok "in the plane a spin is one number" eval 'nsd-gen plane.json | nsd-info -p | jq -e ".w == [0, 0, 3] and .v == [4, 0, 0]"'
printf '%s\n' '# a table, whose columns are x y z r' '1 2 3 4' >table.txt
ok "any other comment is a comment" eval 'nsd-gen - <<<"$scene" | nsd-info -p | jq -e ".radius == 4"'

# ---- starts ----

box='"box": {"x": [0, 0.01], "y": [0, 0.01], "z": [0, 0.01]}'
start() { nsd-gen - <<<"{\"dt\": 1e-5, \"bodies\": [{$1}], \"walls\": [{$box}]}"; }
fills() { nsd-info -p "$1" | jq -s -e "map(.radius * .radius * .radius) | add * 4.18879020478639 / 1e-6 | $2"; }
dense=0.52
[ -z "$thin" ] || dense=0.35
ok "a loose start fills what it shall, and overlaps nowhere (nsd-gen looks)" \
    eval 'start "\"random\": {\"phi\": 0.2}, \"radius\": 4e-4, $box" >loose.h5 && fills loose.h5 ". - 0.2 | fabs < 2e-4"'
ok "a dense one" \
    eval 'start "\"random\": {\"phi\": $dense}, \"radius\": {\"uniform\": [4e-4, 6e-4]}, $box" >dense.h5 && fills dense.h5 ". - $dense | fabs < 5e-4"'
no_overlap='
import h5py, numpy as np, sys
with h5py.File(sys.argv[1]) as f:
    x, r = f["particles/all/position/value"][0], f["particles/all/radius"][:]
least = min((np.linalg.norm(x[i + 1:] - x[i], axis=1) - r[i + 1:] - r[i]).min() for i in range(len(r) - 1))
assert least >= 0 and ((x - r[:, None]).min() >= 0) and (x + r[:, None]).max() <= 0.01, least'
if have_h5py; then
    ok "no pair of it overlaps at all, brute force says" py -c "$no_overlap" dense.h5
else
    skip "no pair of it overlaps at all" "no h5py"
fi
ok "the same scene gives the same start, another seed another one" \
    eval 'start "\"random\": {\"phi\": 0.2}, \"radius\": 4e-4, $box" | cmp - loose.h5 && ! start "\"random\": {\"phi\": 0.2}, \"radius\": 4e-4, $box}], \"seed\": 2, \"comment\": [{" | same_particles - loose.h5'
ok "so many, at random, of radii of 1 to 100" \
    eval 'start "\"random\": {\"count\": 5000}, \"radius\": {\"power\": {\"exponent\": 3.5, \"min\": 2e-5, \"max\": 2e-3}}, $box" >wide.h5 && nsd-info wide.h5 | jq -s -e ".[0].bodies == 5000"'
refuses 65 "more than fits is refused" start "\"random\": {\"phi\": 0.9}, \"radius\": {\"uniform\": [1e-3, 2e-3]}, $box"
shelves='"count": 5000, "radius": {"power": {"exponent": 3.5, "min": 2e-5, "max": 2e-3}}, "box": {"x": [0, 0.01], "y": [0, 0.01], "z": [0, null]}'
heights() { nsd-info -p "$1" | jq -s 'map(.x[2] + .radius) | max'; }
nsd-gen - <<<"{\"dt\": 1, \"bodies\": [{$shelves, \"cells\": \"own\"}]}" >own.h5
nsd-gen - <<<"{\"dt\": 1, \"bodies\": [{$shelves}]}" >equal.h5
ok "cells that fit their grains: 5000 of 1 to 100 take less than a tenth of the height of equal cells" \
    eval 'jq -n -e "$(heights own.h5) < 0.1 * $(heights equal.h5)"'
refuses 65 "a box that is too small for them" start "\"cells\": \"own\", \"count\": 5000, \"radius\": 1e-3, $box"

# ---- how far a run goes, what it keeps ----

nsd-gen 20 >small.h5 # dt = 5e-5
nsd-step --until 0.01 small.h5 2>/dev/null >until.h5
ok "--until ends at its time" every_frame until.h5 'length == 200 and (.[-1].time - 0.01 | fabs < 1e-9)'
nsd-step --until 0.01 until.h5 2>/dev/null >nothing.h5
ok "and there is nothing to do then" every_frame nothing.h5 'length == 1 and .[0].step == 200'
nsd-step -n 230 --every 0.001s small.h5 2>/dev/null >seconds.h5
ok "--every by seconds keeps the frame at each of them, and the last" \
    every_frame seconds.h5 'map(.step) == [20,40,60,80,100,120,140,160,180,200,220,230]'
nsd-step -n 33 --every 0.001s small.h5 2>/dev/null >part.h5
nsd-step -n 47 --every 0.001s part.h5 2>/dev/null >rest.h5
ok "wherever the run began" every_frame rest.h5 'map(.step) == [40, 60, 80]'
refuses 64 "--every needs steps or seconds" nsd-step --every 3m small.h5
refuses 64 "and more than none" nsd-step --every 0s small.h5
refuses 64 "-n and --until exclude each other" nsd-step -n 3 --until 1 small.h5
nsd-step -n 3000 --progress 0.02 --every 1000 small.h5 2>said >/dev/null
like "--progress says how far it is, how fast, and how long it takes" "$(grep -m 1 ' left: ' said)" \
    '^nsd-step: step [0-9]+, [0-9]+ % of 3000, [0-9.e+]+/s, [0-9]+:[0-9][0-9] left: [0-9]+ contacts'

# ---- in place ----

nsd-step -n 100 --every 10 small.h5 2>/dev/null >base.h5
cp base.h5 grown.h5
ok "a run in place appends" eval 'nsd-step -n 100 --every 10 -i grown.h5 2>/dev/null && every_frame grown.h5 "map(.step) == [range(10; 201; 10)]"'
nsd-step -n 200 --every 10 small.h5 2>/dev/null >long.h5
ok "the frames are those of a run that did not stop" \
    eval 'cmp <(dump grown.h5) <(dump long.h5) && cmp <(dump grown.h5 /nsd/solver) <(dump long.h5 /nsd/solver)'
ok "the history has both commands" eval 'nsd-info grown.h5 | jq -s -e ".[0].history | map(.command) == [\"nsd-gen\", \"nsd-step\", \"nsd-step\"]"'
is "nothing else is left there" "$(find . -name '*nsd-new*' | wc -l)" 0
chmod 640 grown.h5 && ln -s grown.h5 link.h5
ok "a link stays one, and rights stay" eval 'nsd-step -n 1 -i link.h5 2>/dev/null && [ -L link.h5 ] && [ "$(stat -c %a grown.h5)" = 640 ] && every_frame grown.h5 "length == 21"'
cp base.h5 typed.h5
if [ -x /usr/bin/python3 ]; then
    ok "at a terminal, FILE is appended to" eval 'terminal nsd-step -n 50 --every 10 typed.h5 && every_frame typed.h5 "length == 15"'
else
    skip "at a terminal, FILE is appended to" "no python3"
fi
cp base.h5 kept.h5
refuses 65 "what is damaged is refused" eval 'head -c 3512 base.h5 | tail -c +513 >broken.h5; cp broken.h5 broken.was; nsd-step -i broken.h5'
refuses 64 "one file at a time" nsd-step -i base.h5 kept.h5
refuses 64 "a time-step rule of its own is refused" nsd-step -i --theta 0.7 kept.h5
ok "and the file is as it was" cmp base.h5 kept.h5
ok "left as it is" cmp broken.h5 broken.was
if have_h5py; then
    tail -c +513 kept.h5 >mine.h5
    py - <<'EOF'
import h5py
with h5py.File("mine.h5", "r+") as f:
    g = f.create_group("observables/mine")
    g["step"], g["value"] = list(range(10)), list(range(10))
EOF
    cp mine.h5 mine.was
    refuses 65 "what would be lost is not: numbers over time that nsd does not know" nsd-step -i mine.h5
    ok "that file too is as it was" cmp mine.h5 mine.was
fi
cp base.h5 raced.h5
nsd-step -n 100000000 --every 100 -i raced.h5 2>/dev/null &
runs=$!
while kill -0 $runs 2>/dev/null && [ "$(nsd-info raced.h5 2>/dev/null | wc -l)" -le 13 ]; do sleep 0.02; done
refuses 74 "a second writer is refused" nsd-step -i raced.h5
kill -9 $runs || true
wait $runs 2>/dev/null || true
ok "killed, it has left whole frames, the old ones among them" \
    eval 'every_frame raced.h5 "length > 12 and .[9].step == 100 and .[10].step == 200" && cmp <(nsd-info -p --frames 100 raced.h5) <(nsd-info -p --last base.h5)'
ok "and it goes on" eval 'nsd-step -n 10 -i raced.h5 2>/dev/null && nsd-info raced.h5 >/dev/null'

# Killed at any moment: while it copies, as it takes the place, as it grows
killed() # I: after I/1000 s
{
    local mine=killed.$1.h5 was=10
    cp base.h5 "$mine"
    nsd-step -n 100000000 --every 100 -i "$mine" 2>/dev/null &
    local pid=$!
    sleep "$(printf '0.%03d' $((2 * $1)))"
    kill -9 $pid
    wait $pid 2>/dev/null || true
    nsd-info "$mine" | jq -s -e "map(select(.step != null).step) | length >= $was and .[:10] == [range(10; 101; 10)]" >/dev/null ||
        echo "after $1: $(nsd-info "$mine" 2>&1 | head -n 1)"
    rm -f "$mine" ".$mine.nsd-new"
}
ok_each "killed after 0 to 80 ms, the old frames are there" killed 40

# ---- where grains at random start ----

# a cube as an OBJ file, by its lower and upper corners
cube() { awk -v a="$2" -v b="$3" 'BEGIN { split("0 2 3 1 4 5 7 6 0 1 5 4 2 6 7 3 0 4 6 2 1 3 7 5", q)
    for (i = 0; i < 8; i++) print "v", (i % 2 ? b : a), (int(i / 2) % 2 ? b : a), (i > 3 ? b : a)
    for (k = 1; k < 24; k += 4) print "f", q[k] + 1, q[k + 1] + 1, q[k + 2] + 1, q[k + 3] + 1 }' >"$1"; }
cube inner.obj 0.3 0.7
cube outer.obj 0 1
start() # DIM WALLS BODIES: a scene, and its grains as [x, y, z, r]
{
    jq -n --argjson d "$1" --argjson w "$2" --argjson b "$3" '{dim: $d, dt: 1e-4, walls: $w, bodies: [$b]}' >start.json
    nsd-gen start.json >start.h5 2>start.err && nsd-info -p start.h5 | jq -cs 'map(.x + [.radius])' >start.x
}
near() { ok "$1" jq -e "$2" start.x; } # WHAT JQ-FILTER OF THE GRAINS
box3='"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1]}'
for phi in 0.2 0.5; do # one after another; grown
    body="{\"random\": {\"phi\": $phi}, \"radius\": 0.04, $box3}"
    start 3 '[{"mesh": {"file": "inner.obj"}}]' "$body"
    near "phi $phi: grains keep out of a cube in their box" 'all(.[3] as $r | .[:3] | map([. - 0.7, 0.3 - ., 0] | max) | map(. * .) | add >= $r * $r)'
    near "and fill that share of the rest of the box" "(length * 4 / 3 * 3.14159265 * 0.000064 / (1 - 0.064)) / $phi - 1 | fabs < 0.02"
    start 3 '[{"mesh": {"file": "outer.obj"}}]' "$body"
    near "phi $phi: a cube around the box is a vessel" 'length > 100 and all(.[3] as $r | .[:3] | all(. >= $r and . <= 1 - $r))'
    start 3 '[{"cylinder": {"point": [0.5, 0.5, 0], "axis": [0, 0, 1], "radius": 0.5, "length": 1.2}}]' "$body"
    near "phi $phi: a box around a cylinder fills the cylinder" 'all([.[0] - 0.5, .[1] - 0.5] | map(. * .) | add | sqrt <= 0.46)'
    near "by that share of it" "(length * 4 / 3 * 3.14159265 * 0.000064 / 0.78539816) / $phi - 1 | fabs < 0.02"
    start 3 '[{"sphere": {"center": [0.5, 0.5, 0.5], "radius": 0.3, "side": "outside"}}]' "$body"
    near "phi $phi: grains keep out of a ball" 'all(.[:3] | map((. - 0.5) * (. - 0.5)) | add | sqrt >= 0.34)'
done
start 3 '[{"cone": {"point": [0.5, 0.5, 0], "axis": [0, 0, 1], "radii": [0.1, 0.5], "length": 1}}]' "{\"random\": {\"count\": 100}, \"radius\": {\"uniform\": [0.02, 0.04]}, $box3}"
near "a funnel is filled" 'length == 100 and all((0.1 + 0.4 * .[2] - ([.[0] - 0.5, .[1] - 0.5] | map(. * .) | add | sqrt)) / 1.0770329614 >= .[3] * (1 - 1e-9))'
start 3 '[{"cylinder": {"point": [0, 0, 0], "axis": [0, 0, 1], "radius": 0.4, "length": 1}}, {"cylinder": {"point": [2, 0, 0], "axis": [0, 0, 1], "radius": 0.4, "length": 1}}]' \
    '{"random": {"count": 50}, "radius": 0.05, "box": {"x": [1.6, 2.4], "y": [-0.4, 0.4], "z": [0, 1]}}'
near "a vessel beside is not in the way" 'length == 50 and all([.[0] - 2, .[1]] | map(. * .) | add | sqrt <= 0.35)'
body='{"random": {"phi": 0.6}, "radius": 0.02, "box": {"x": [0, 1], "y": [0, 1]}}'
start 2 '[{"polygon": {"points": [[0.3, 0.3], [0.7, 0.3], [0.7, 0.7], [0.3, 0.7]]}}]' "$body"
near "in the plane grains keep out of a polygon" 'length > 300 and all(.[2] as $r | .[:2] | map([. - 0.7, 0.3 - ., 0] | max) | map(. * .) | add >= 0.0004)'
start 2 '[{"circle": {"center": [0.5, 0.5], "radius": 0.5}}]' "$body"
near "and fill a circle" 'length > 300 and all([.[0] - 0.5, .[1] - 0.5] | map(. * .) | add | sqrt <= 0.48)'
jq -n '{dt: 1e-4, cell: {lengths: [1, 1, 1], repeats: [true, true, false]}, walls: [{point: [0, 0, 0.3], normal: [0, 0, 1]}],
    bodies: [{random: {phi: 0.4}, radius: 0.05}]}' | nsd-gen - | nsd-info -p | jq -cs 'map(.x + [.radius])' >start.x
near "a plane cuts a periodic cell: the part above it is filled" 'all(.[2] >= 0.35) and (length * 4 / 3 * 3.14159265 * 0.000125 / 0.7 / 0.4 - 1 | fabs < 0.02)'
start 3 '[{"cylinder": {"point": [0.5, 0.5, 0], "axis": [0, 0, 1], "radius": 0.05, "length": 1}}]' "{\"random\": {\"count\": 500}, \"radius\": 0.045, $box3}" || :
like "grains that do not go in: the search ends, with what is free" "$(cat start.err)" 'free of walls|[0-9]+ of 500 bodies found a place at random between the walls'

# ---- as many as there can be, and how large they are ----

for body in '{"random": {"count": 2147483647}, "radius": 0.1, '"$box3"'}' '{"count": 2147483647, "radius": 0.1, "box": {"x": [0, 1], "y": [0, 1], "z": [0, null]}}' \
    '{"count": 2000000000, "cells": "own", "radius": 1e-6, "box": {"x": [0, 1], "y": [0, 1], "z": [0, 1]}}'; do
    jq -n --argjson b "$body" '{dt: 1e-4, bodies: [$b]}' >many.json
    few() { ({ [ -n "$thin" ] || ulimit -v 3000000; } && timeout 20 nsd-gen many.json); } # sanitizers map terabytes
    refuses 65 "two thousand million bodies, before one is made" few
    like "with what they take" "$(cat "$tmp/err")" 'bodies take .* GB of memory and more, and this process has [0-9.]* GB: a smaller count'
done
for body in '{"count": 1, "radius": 1e308, "box": {"x": [-1e308, 1e308], "y": [0, 1], "z": [0, null]}}' \
    '{"random": {"phi": 0.5}, "radius": 1e90, "box": {"x": [0, 1e307], "y": [0, 1e307], "z": [0, 1e307]}}'; do
    jq -n --argjson b "$body" '{dt: 1e-4, bodies: [$b]}' >huge.json
    refuses 65 "sizes beyond numbers" nsd-gen huge.json
    like "without an infinite number in the message" "$(cat "$tmp/err")" 'too large(: its volume is not a finite number)?$'
done
check() { jq -n --argjson r "$1" --argjson k "${2-{\}}" '{dt: 1e-4, bodies: [{count: 20000, radius: $r, box: {x: [0, 0.2], y: [0, 0.2], z: [0, null]}} + $k]}' | nsd-gen --check - 2>check.err | jq -c '.sizes[0]' >check.json; }
check '{"sieve": [[1e-3, 0], [2e-3, 0.4], [4e-3, 1]]}'
# F linear in log d: the median of the mass is 2e-3 * 2^(1/6); numbers by the integral of dF / d^3, mean likewise
ok "what a sieve curve asks for: quantiles by mass, numbers below a sieve, mean" jq -e '(.asked.mass.d50 / (2e-3 * pow(2; 1/6)) - 1 | fabs < 1e-3) and .asked.mass.d10 / (1e-3 * pow(2; 0.25)) - 1 < 1e-3 and
    ((0.4 * (1 - 1/8)) as $a | (0.6 * (1/8 - 1/64)) as $b | (.passing[0].number[0] - $a / ($a + $b) | fabs) < 1e-4 and
    (.asked.mean - 1.5e-3 * (0.4 * (1 - 1/4) + 0.6 * (1/4 - 1/16)) / ($a + $b) | fabs) < 1e-6)' check.json
ok "and what was drawn, near it" jq -e '.count == 20000 and (.passing | map(.d)) == [0.002, 0.004] and (.passing[0] | (.mass[0] - 0.4 | fabs) < 1e-9 and (.mass[1] - 0.4 | fabs) < 0.02) and
    (.drawn.mass.d90 / .asked.mass.d90 - 1 | fabs) < 0.02 and (.drawn.mean / .asked.mean - 1 | fabs) < 0.02' check.json
like "as text, too" "$(cat check.err)" 'below 0\.002 m: of the mass 0\.4000, drawn 0\.[34][0-9]*; of the number'
check '{"gaussian": {"mean": 1e-3, "sd": 1e-4, "min": 5e-4, "max": 1.5e-3}}'
ok "a normal distribution" jq -e '(.asked.mean / 2e-3 - 1 | fabs) < 1e-4 and (.asked.number.d90 / (2e-3 + 2e-4 * 1.2815515655) - 1 | fabs) < 1e-4 and (.drawn.number.d50 / .asked.number.d50 - 1 | fabs) < 0.01' check.json
check 1e-3
ok "one size" jq -e '.asked == .drawn or (.asked.mass == .drawn.mass and .passing == [] and (.drawn.mean / 2e-3 - 1 | fabs) < 1e-9)' check.json
like "an open box is not infinite" "$(cat check.err)" 'a height of 0\.[0-9]* m, in a box that is open above'
jq -n '{dt: 1e-4, shapes: {c: {box: [1, 1, 1]}}, bodies: [{count: 200, shape: "c", size: {sieve: [[1e-3, 0], [2e-3, 1]]}, box: {x: [0, 0.2], y: [0, 0.2], z: [0, null]}}]}' >shape.json
nsd-gen --check shape.json >shape.out 2>shape.err
is "of shapes the balls around them: of a cube by its diagonal, an aperture twice the scale factor" "$(jq '.sizes[0].passing[0].d * 1e9 | round' shape.out)" 1732051
like "which is explained" "$(cat shape.err)" '"size" scales the shape, whose ball has a diameter of 1.732 m at size 1; an aperture of its sieve is twice the size'

# ---- a document of many groups, shapes and kinds ----

jq -n '{dt: 1e-3, bodies: [range(3000) | {x: [3 * ., 0, 0], radius: 1, name: "group \(.)"}]}' | nsd-gen - >groups.h5
jq -n '{dt: 1e-3, bodies: [{x: [-9, 0, 0], radius: 1, name: "group 7"}, {document: "groups.h5"}]}' >groups.json
is "each body keeps its group's name" "$(nsd-gen groups.json | nsd-info -p | jq -c 'select(.group == "group 7").x' | xargs)" "[-9,0,0] [21,0,0]"
for names in kinds shapes; do
    for name in '' ' a' 'a,b' 'a\"b' 'a\u001bb' 'a\u007fb' 'a\u0085b' "$(printf '%061d' 0)x"; do
        printf '{"dt": 1e-3, "%s": {"%s": %s}}' $names "$name" "$([ $names = kinds ] && echo '{}' || echo '{"box": [1, 1, 1]}')" >name.json
        refuses 65 "$names: the name \"$name\"" nsd-gen name.json
    done
    printf '{"dt": 1e-3, "%s": {"7": {"density": 1}, "7": {"density": 2}}}' $names >name.json
    refuses 65 "$names: a name twice" nsd-gen name.json
done

done_testing
