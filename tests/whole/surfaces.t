#!/usr/bin/env bash
# Bodies on surfaces of no thickness: normals at vanishing gaps, seams that must not be felt, edges that must, and
# what is faster than it is thick. Truth is a closed form, or the same body on one plane.
. tests/support/tap.sh

# A floor z = 0 of triangles [[x0, x1, y0, y1, z, diagonal], ...] as an OBJ file, no corner shared
obj() # NAME QUADS
{
    jq -rn --argjson q "$2" '[$q[] as [$x, $X, $y, $Y, $z, $d] | [[$x,$y,$z],[$X,$y,$z],[$X,$Y,$z],[$x,$Y,$z]] as $c |
        (if $d == 1 then [0,1,3,1,2,3] else [0,1,2,0,2,3] end)[] | $c[.]] | (.[] | "v \(map(tostring) | join(" "))"),
        (range(0; length; 3) | "f \(. + 1) \(. + 2) \(. + 3)")' >"$tmp/$1.obj"
}
mesh() { echo "{\"mesh\": {\"file\": \"$1.obj\"}}"; }
rect() # X0 X1 Z [Y]
{
    jq -cn "{rectangle: {center: [($1 + $2) / 2, 0, $3], normal: [0, 0, 1], along: [1, 0, 0], sides: [$2 - $1, ${4-2}]}}"
}
fixed() # X0 X1 TOP: a fixed box 0.1 m thick
{
    jq -cn "{shape: \"f\($1 * 10 | round)\", is: {box: [$2 - $1, 2, 0.1]}, x: [($1 + $2) / 2, 0, $3 - 0.05]}"
}
grains='{"box": [{"box": [0.2, 0.2, 0.2]}, 0.1, 0], "turned": [{"box": [0.2, 0.2, 0.2]}, 0.1, 0.5],
    "prism": [{"points": [[0.1,0,-0.1],[0.07,0.07,-0.1],[0,0.1,-0.1],[-0.07,0.07,-0.1],[-0.1,0,-0.1],[-0.07,-0.07,-0.1],[0,-0.1,-0.1],[0.07,-0.07,-0.1],
        [0.1,0,0.1],[0.07,0.07,0.1],[0,0.1,0.1],[-0.07,0.07,0.1],[-0.1,0,0.1],[-0.07,-0.07,0.1],[0,-0.1,0.1],[0.07,-0.07,0.1]]}, 0.1, 0.1],
    "ball": [null, 0.1, 0], "capsule": [{"capsule": {"length": 0.2, "radius": 0.05}}, 0.05, 0]}'
# slide GRAIN OVERLAP PARTS...: v_x and the greatest height after 0.3 s from x = 0.6 m at 3 m/s, mu 0.3; a part is a wall
# or a fixed box
slide()
{
    local grain=$1 way=$2
    shift 2
    printf '%s\n' "$@" | jq -sc --argjson all "$grains" --arg g "$grain" '$all[$g] as [$s, $h, $yaw] | . as $parts |
        ([$parts[] | select(.is)]) as $f | {dt: 1e-3, mu: 0.3, walls: [$parts[] | select(.is | not)],
         bodies: ([{x: [0.6, 0.013, ($h + 2e-5)], v: [3, 0, 0]} + (if $s then {shape: "s", orientation: [0, 0, $yaw]} else {radius: $h} end)] +
            [$f[] | {x, shape, fixed: true}])} +
        (if $s or ($f | length > 0) then {shapes: ((if $s then {s: $s} else {} end) + ($f | map({key: .shape, value: .is}) | from_entries))} else {} end)' >"$tmp/s.json"
    nsd-gen "$tmp/s.json" | nsd-step --until 0.3 --every 10 --overlap-rule "$way" 2>/dev/null |
        nsd-info -p | jq -sc 'map(select(.body == 0 or .id == 0)) | [.[-1].v[0], .[-1].x[0], (map(.x[2]) | max)]'
}
alike() { jq -n --argjson a "$1" --argjson b "$2" '[range(3)] | all(($a[.] - $b[.] | fabs) < 3e-4)'; }

obj floor '[[-1, 1, -1, 1, 0, 0]]'
obj left '[[-1, 1, -1, 1, 0, 0]]'
obj right '[[1.0000001, 3, -1.2, 0.9, 1e-7, 1]]'
obj junctions '[[-1, 1, -1, 1, 0, 0], [1, 3, -1, 0.02, 1e-7, 0], [1, 3, 0.02, 1, 0, 1]]'
obj doubled '[[-1, 1, -1, 1, 0, 0], [1, 3, -1, 1, 0, 0], [-1, 1.1, -1, 1, 0, 1], [1.1, 3, -1, 1, 0, 1]]'

# a box that lies exactly on a mesh: mu g dt of its velocity is lost, in any frame
for axis in 0 0.3 1; do
    jq -n --argjson a "$axis" '($a | cos) as $c | ($a | sin) as $s | {dt: 1e-3, mu: 0.5, gravity: [-9.81 * $s, 0, -9.81 * $c],
        shapes: {b: {box: [0.2, 0.2, 0.2]}}, bodies: [{x: [0.5 * $c + 0.1 * $s, 0.013, 0.1 * $c - 0.5 * $s], shape: "b", v: [$c, 0, -$s], orientation: [0, $a, 0]}],
        walls: [{mesh: {file: "turned.obj"}}]}' >"$tmp/on.json"
    awk -v a="$axis" '$1 == "v" { printf "v %.17g %.17g %.17g\n", cos(a)*$2 + sin(a)*$4, $3, cos(a)*$4 - sin(a)*$2; next } { print }' "$tmp/floor.obj" >"$tmp/turned.obj"
    is "a box exactly on a mesh turned by $axis slides as it should" "$(nsd-gen "$tmp/on.json" | nsd-step --solver auto 2>/dev/null | nsd-info --last -p |
        jq '((.v | map(. * .) | add | sqrt) - (1 - 0.5 * 9.81e-3) | fabs) < 1e-5 and (.w | map(. * .) | add | sqrt) < 1e-3')" true
done

plane='{"point": [0, 0, 0], "normal": [0, 0, 1]}'
patch='{"rectangle": {"center": [1.2, 0, 0], "normal": [0, 0, 1], "sides": [0.3, 0.4]}}'
for grain in box turned prism ball capsule; do
    for way in gap-project push project; do
        [ "$way" = gap-project ] || [ "$grain" = box ] || continue
        truth=$(slide $grain $way "$plane")
        seam() { is "$way: a $grain passes $1" "$(alike "$(slide $grain $way "${@:2}")" "$truth")" true; }
        seam 'from rectangle to rectangle, 1e-7 apart and higher' "$(rect -1 1 0)" "$(rect 1.0000001 3 1e-7)"
        seam 'from a mesh to another' "$(mesh left)" "$(mesh right)"
        [ "$way" = project ] && continue
        seam 'triangles that do not share corners' "$(mesh junctions)"
        seam 'doubled triangles' "$(mesh doubled)"
        seam 'from a mesh to a rectangle' "$(mesh left)" "$(rect 1 3 0)"
        seam 'a rectangle in a plane' "$plane" "$patch"
        seam 'from a fixed box to another' "$(fixed -1 1 0)" "$(fixed 1 3 0)"
        seam 'from a fixed box to a rectangle' "$(fixed -1 1 0)" "$(rect 1 3 0)"
        seam 'from a rectangle to a fixed box' "$(rect -1 1 0)" "$(fixed 1 3 0)"
    done
done
is 'a box on a strip passes to a rectangle that is wider than it is' \
    "$(alike "$(slide turned gap-project "$(rect -1 1 0 0.1)" "$(rect 1 3 0)")" "$(slide turned gap-project "$plane")")" true

# edges that are there
stop() { jq -n --argjson a "$1" "(\$a[1] - $2 | fabs) < 2e-3 and (\$a[0] | fabs) < 1e-3"; }
riser='{"rectangle": {"center": [1, 0, 0.5], "normal": [-1, 0, 0], "along": [0, 1, 0], "sides": [2, 1]}}'
post='{"rectangle": {"center": [1, 0, 0.5], "normal": [-1, 0, 0], "along": [0, 1, 0], "sides": [0.02, 1]}}'
for way in gap-project push; do
    is "$way: a wall on the floor stops a box" "$(stop "$(slide box $way "$(rect -1 3 0)" "$riser")" 0.9)" true
    is "$way: so does a post" "$(stop "$(slide box $way "$(rect -1 3 0)" "$post")" 0.9)" true
    is "$way: and a fixed box as high as it is" "$(stop "$(slide box $way "$(fixed -1 1 0)" "$(jq -cn '{shape: "w", is: {box: [1, 2, 2]}, x: [1.5, 0, 0]}')")" 0.9)" true
    is "$way: a step of 1 mm trips it, of rectangles and of boxes" \
        "$(slide box $way "$(rect -1 1 0)" "$(rect 1 3 1e-3)" | jq '.[0] < 1.5') $(slide box $way "$(fixed -1 1 0)" "$(fixed 1 3 1e-3)" | jq '.[0] < 1.5')" 'true true'
done
is 'beyond the end of a table a box falls' "$(slide box gap-project "$(rect -1 0.9 0)" | jq '.[0] > 2')" true

# faster than thick: 15 cm and 50 cm a step
through() # WALL-OR-BOX SHAPE SPEED [OPTION ...]: it stays above for 0.2 s, or is said to be too fast
{
    printf '%s\n' "$1" | jq -c --argjson s "$2" --argjson v "$3" '. as $p | {dt: 0.0166666, e_n: 0.3, shapes: ({a: {box: [1, 1, 1]}} + (if $p.is then {f: $p.is} else {} end) + (if $s then {s: $s} else {} end)),
        walls: (if $p.is then [] else [$p] end), bodies: ([{x: [0.01, 0.02, 1.07], v: [0.1, 0, -$v]} + (if $s then {shape: "s"} else {radius: 0.05} end)] + (if $p.is then [{x: $p.x, shape: "f", fixed: true}] else [] end))}' >"$tmp/t.json"
    nsd-gen "$tmp/t.json" | nsd-step --until 0.2 "${@:4}" 2>"$tmp/said" | nsd-info -p | jq -s 'map(select(.body == 0 or .id == 0).x[2]) | min > 0' >"$tmp/above"
    if grep -q '[1-9][0-9]* too fast' "$tmp/said"; then echo said; else cat "$tmp/above"; fi
}
thin='{"is": {"box": [0.6, 0.6, 0.004]}, "x": [0, 0, -0.002]}'
for shape in null '{"box": [0.1, 0.1, 0.1]}' '{"capsule": {"length": 0.1, "radius": 0.04}}'; do
    for wall in "$(mesh floor)" "$(rect -1 1 0)" "$thin" '{"disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1}}'; do
        is "$shape does not go through ${wall:0:12}" "$(through "$wall" "$shape" 9) $(through "$wall" "$shape" 30)" 'true true'
        is "one solve per step: $shape and ${wall:0:12} are told" "$(through "$wall" "$shape" 9 --overlap-rule keep) $(through "$wall" "$shape" 30 --solver auto)" 'said said'
    done
done
# what goes through at once is told
printf '{"dt": 0.1, "bodies": [{"x": [0, 0, 1.3], "radius": 1e-5, "v": [0, 0, -20]}], "gravity": [0, 0, 0], "walls": [%s]}' "$(rect -1 1 0)" >"$tmp/fast.json"
nsd-gen "$tmp/fast.json" >"$tmp/fast-in.h5"
s=0
nsd-step --small-steps 0 -e -n 2 "$tmp/fast-in.h5" >"$tmp/fast.h5" 2>"$tmp/err" || s=$?
is 'what is so fast gives status 1 under -e' $s 1
ok 'and a line that says who, where and when' grep -q '1 too fast (step 1, body 0)' "$tmp/err"
is 'and is counted in the document' "$(nsd-info --last "$tmp/fast.h5" | jq 'select(.account).account.fast.value')" 1

# a weld tolerance of a scene is kept
jq -cn --argjson r "$(rect -1 1 0)" '{dt: 1e-3, walls: [$r + {weld: 1e-3}]}' >"$tmp/weld.json"
is 'a weld tolerance is kept in the document' "$(nsd-gen "$tmp/weld.json" | nsd-step -n 1 2>/dev/null >"$tmp/weld.h5" && h5dump -d /particles/boundary/body/weld "$tmp/weld.h5" | grep -c 0.001)" 1
done_testing
