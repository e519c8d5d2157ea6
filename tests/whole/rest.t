#!/usr/bin/env bash
# What is done about overlap (--overlap-rule): piles that rest keep theirs bounded, nothing gains energy, balls
# bounce as high as they should, and the chain of tools does what nsd-step does.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

modes=(keep gap push project gap-project)
radius=0.005

scene() { nsd-gen - >"$tmp/$1.h5"; } # NAME < JSON
step() { nsd-step "$@" 2>/dev/null; }
moments() { nsd-info "$@" | jq -c 'select(.step != null)'; }
holds() { jq -e -n "$@" >/dev/null; } # a jq program that says true

# ---- a column of ten balls: overlap over time ----

jq -n --argjson r $radius '{ dt: 1e-4, mu: 0.5, bodies: [range(10) | { x: [0, 0, $r * (2 * . + 1)], radius: $r }],
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }] }' | scene column
slop=$(jq -n "9.81 * 1e-8 + 1e-6 * $radius") # what a projection leaves, m
for mode in "${modes[@]}"; do
    step --cold --overlap-rule "$mode" -n 10000 --every 5000 "$tmp/column.h5" >"$tmp/column-$mode.h5"
    mapfile -t overlap < <(moments "$tmp/column-$mode.h5" | jq .max_overlap)
    case $mode in
    keep | gap) ok "$mode: the overlap of a column grows with the steps" \
        holds "${overlap[1]} > 1.3 * ${overlap[0]} and ${overlap[1]} > 2e-5 * $radius" ;;
    push) ok "push: that of a column stays below 1e-6 r" holds "${overlap[1]} <= 1e-6 * $radius" ;;
    *) ok "$mode: that of a column stays within the slop" holds "${overlap[1]} <= 1.05 * $slop" ;;
    esac
done
drift() # MODE: how far the top ball has moved against the start, m
{
    nsd-info -p --last "$tmp/column-$1.h5" |
        jq -s "map(select(.id == 9)) | .[-1].x | (.[0] | fabs) + (.[1] | fabs) + ((.[2] - 19 * $radius) | fabs)"
}
ok "project: its top does not sink" holds "$(drift project) <= 10 * $slop"
ok "keep: its top sinks further" holds "$(drift keep) > 2 * $(drift project)"

# ---- the paper's rule is what it was ----

nsd-gen 20 >"$tmp/twenty.h5"
bits() { nsd-info -p --last "$1" | jq -S -c 'select(.x) | [.step, .id, .x, .v, .w, .q]' | sha256sum | cut -c 1-32; }
is "--protocol paper: 20 balls after 400 steps have the bits that they had before there was --overlap-rule" \
    "$(step --protocol paper -m ebp -n 400 --every 400 "$tmp/twenty.h5" >"$tmp/paper.h5" && bits "$tmp/paper.h5")" \
    "$(sed -n 's/^paper //p' tests/support/golden/rest)"
is "so with --overlap-rule keep and the natural map" \
    "$(step --criterion natural --overlap-rule keep -n 400 --every 400 "$tmp/twenty.h5" >"$tmp/keep.h5" && bits "$tmp/keep.h5")" \
    "$(sed -n 's/^keep //p' tests/support/golden/rest)"
ok "project gives others" [ "$(step -n 400 --every 400 "$tmp/twenty.h5" >"$tmp/p.h5" && bits "$tmp/p.h5")" != "$(bits "$tmp/keep.h5")" ]
is "--protocol paper keeps, whatever the document says" \
    "$(step --protocol paper -m ebp -n 1 "$tmp/p.h5" | nsd-info - | jq -r '.overlap_rule // empty')" keep
is "the document says what is done" "$(nsd-info "$tmp/p.h5" | jq -r '.overlap_rule // empty')" project

# ---- one step: by its parts and as a whole; threads ----

step -n 300 --every 300 --overlap-rule keep "$tmp/twenty.h5" >"$tmp/falling.h5"
parts() # MODE: three steps
{
    nsd-cat --last "$tmp/falling.h5" >"$tmp/0.h5"
    for k in 1 2 3; do
        nsd-detect --overlap-rule "$1" "$tmp/$((k - 1)).h5" | nsd-solve 2>/dev/null | nsd-move >"$tmp/$k.h5"
    done
    step --overlap-rule "$1" -n 3 "$tmp/falling.h5" | nsd-cat --last >"$tmp/whole.h5"
    same_particles "$tmp/3.h5" "$tmp/whole.h5"
}
for mode in "${modes[@]}"; do
    ok "$mode: three times detect | solve | move and step -n 3 give the same bits" parts "$mode"
done
chain_paper()
{
    nsd-cat --last "$tmp/falling.h5" | nsd-detect | nsd-solve --protocol paper -m ebp 2>/dev/null | nsd-move >"$tmp/3.h5"
    step --protocol paper -m ebp -n 1 "$tmp/falling.h5" | nsd-cat --last >"$tmp/whole.h5"
    same_particles "$tmp/3.h5" "$tmp/whole.h5"
}
ok "so with --protocol paper, which nsd-solve hands on to nsd-move" chain_paper
nsd-gen 500 | step -n 300 --every 300 | nsd-cat --last >"$tmp/pile.h5"
threads() { cmp <(step -j 1 "$@" "$tmp/pile.h5") <(step -j 2 "$@" "$tmp/pile.h5"); }
judged() # MODE: what nsd-err finds of frames that have been moved is what their solves reported
{
    step --overlap-rule "$1" -n 3 --contacts "$tmp/pile.h5" >"$tmp/judged.h5" &&
        paste <(nsd-err "$tmp/judged.h5" | jq .natural_q) <(moments "$tmp/judged.h5" | jq 'select(.natural_q).natural_q') |
        awk '{ d = $1 - $2; if (d * d > 1e-20 || $2 == "") exit 1; n++ } END { exit n != 3 }'
}
for mode in "${modes[@]}"; do
    ok "$mode: 1 and 2 threads give the same bytes" threads --overlap-rule "$mode" -n 5
    ok "$mode: nsd-err finds what the steps reported" judged "$mode"
done

# ---- balls that bounce ----

tops() # MODE E: heights of the first three bounces over those of the closed form, 1 m e^(2 n)
{
    jq -n --argjson e "$2" --argjson r $radius '{ dt: 1e-4, e_n: $e, bodies: [{ x: [0, 0, 1 + $r], radius: $r }],
        walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }] }' | nsd-gen - | step --overlap-rule "$1" -n 24000 --every 20 >"$tmp/bounces.h5"
    nsd-info -p "$tmp/bounces.h5" |
        jq -r 'select(.x) | .x[2] - 0.005' |
        awk -v e="$2" 'NR > 2 && b > a && b >= $1 && n < 3 { n++; print b / e ^ (2 * n) } { a = b; b = $1 }'
}
for e in 0.5 0.9; do
    for mode in "${modes[@]}"; do
        ok "$mode: with e_n = $e a ball's first bounces are as high as they should, to 0.4 %" \
            holds "[$(tops "$mode" $e | paste -sd ,)] | length == 3 and all(. > 0.996 and . < 1.004)"
    done
done
superball() # MODE: how much less than 3/7 v it leaves with
{
    echo '{ "dt": 0.01, "gravity": [0, 0, 0], "mu": 10, "e_n": 1, "e_t": 1, "walls": [{ "point": [0, 0, 0], "normal": [0, 0, 1] }],
        "bodies": [{ "x": [0, 0, 1], "radius": 1, "v": [1, 0, -1] }] }' | nsd-gen - | step --overlap-rule "$1" --tolerance 1e-13 |
        nsd-info -p - | jq 'select(.v) | 1 - .v[0] * 7 / 3'
}
ok "keep: a superball leaves with 1 % less than 3/7 v, its arm being short" holds "$(superball keep) | . > 0.009 and . < 0.010"
for mode in "${modes[@]:1}"; do
    ok "$mode: it leaves with 3/7 v" holds "$(superball "$mode") | fabs < 1e-12"
done
cradle() # MODE: speeds of five balls in a row, after
{
    jq -n '{ dt: 1e-4, gravity: [0, 0, 0], e_n: 1, bodies: [range(5) | { x: [. * 0.0101, 0, 0], radius: 0.005,
        v: [if . == 0 then 1 else 0 end, 0, 0] }] }' | nsd-gen - | step --overlap-rule "$1" -n 100 --every 100 |
        nsd-info -p - | jq -s -c 'map(select(.x)) | .[-5:] | map(.v[0] | . * 1e9 | round / 1e9 | fabs)'
}
for mode in keep project; do
    is "$mode: of a row with gaps the last ball alone leaves" "$(cradle "$mode")" "[0,0,0,0,1]"
done
# with gaps each pair meets alone, whatever the order of the bodies is: ((1 + e)/2)^4 = 0.8145 for e = 0.9
row() # ORDER OPTION...
{
    jq -n --argjson order "$1" '{ dt: 1e-5, gravity: [0, 0, 0], e_n: 0.9, mu: 0, bodies: [$order[] as $i | { x: [$i * 0.002001, 0, 0], radius: 0.001,
        v: [if $i == 0 then 1 else 0 end, 0, 0] }] }' | nsd-gen - | step "${@:2}" --until 4e-3 --every 4e-3s | nsd-info -p --last | jq -s 'max_by(.x[0]) | .v[0]'
}
for order in '[0, 1, 2, 3, 4]' '[2, 0, 4, 1, 3]'; do
    ok "small steps, order $order: it leaves with ((1 + e)/2)^4" holds "$(row "$order") | . - pow(0.95; 4) | fabs < 1e-4"
    ok "one solve per step: so it does" holds "$(row "$order" --small-steps 0) | . - pow(0.95; 4) | fabs < 1e-4"
done
# of 4000 times the mass, on a ball on a floor: e v, as with plastic loss; dashpots that a pair of light balls has give 1.98
heavy() # OPTION...
{
    jq -n '{ dt: 1e-6, gravity: [0, 0, 0], e_n: 0.4, mu: 0, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
        bodies: [{ x: [0, 0, 0.001], radius: 0.001 }, { x: [0, 0, 0.0179], radius: 0.0159, v: [0, 0, -2] }] }' | nsd-gen - |
        step "$@" --until 4e-3 --every 4e-3s | nsd-info -p --last | jq -s 'max_by(.x[2]) | .v[2]'
}
ok "small steps: a heavy ball on a light one rebounds with e v" holds "$(heavy) | . - 0.8 | fabs < 1e-3"
ok "one solve per step: so it does" holds "$(heavy --small-steps 0) | . - 0.8 | fabs < 1e-3"

# ---- energy ----

# What an impact has let sink below a surface is lifted in some steps: the rises of ten at a time.
rises() # SCENE MODE: the rises of energy from ten steps to ten steps, added up, over the first energy
{
    step --overlap-rule "$2" -n 600 "$tmp/$1.h5" >"$tmp/rises.h5"
    nsd-info "$tmp/rises.h5" |
        jq -n '[inputs | select(.step != null) | .kinetic_energy + .potential_energy] |
            . as $e | [range(10; length; 10) | $e[.] - $e[. - 10] | select(. > 0)] | add / $e[0]'
}
jq -n '{ dt: 5e-5, mu: 0.3, e_n: 0.7, bodies: [{ count: 20, radius: { uniform: [2.5e-4, 5e-4] } }],
    walls: [{ box: { x: [-1e-3, 1e-3], y: [-1e-3, 1e-3], z: [0, null] } }] }' | scene bouncing
# A projection lifts what an impact has let sink below the surface: m g v dt/2 each.
declare -A most=([keep]=1e-6 [gap]=1e-5 [push]=1e-5 [project]=1e-4 [gap-project]=1e-4)
for mode in "${modes[@]}"; do
    ok "$mode: 20 balls that fall gain at most ${most[$mode]} of their energy in all" \
        holds "$(rises twenty "$mode") <= ${most[$mode]}"
done
for mode in keep project; do
    ok "$mode: so do balls that bounce" holds "$(rises bouncing "$mode") <= ${most[$mode]}"
done
echo '{ "dt": 1e-4, "gravity": [0, 0, 0], "allow_overlap": true, "bodies": [{ "x": [0, 0, 0], "radius": 0.01, "mass": 1 },
    { "x": [0.019, 0, 0], "radius": 0.01, "mass": 3 }] }' | scene pair
step --overlap-rule project -n 60 "$tmp/pair.h5" | nsd-cat --last >"$tmp/apart.h5"
place() { nsd-info -p "$tmp/apart.h5" | jq "select(.id == $1).x[0]"; }
is "two balls that overlap are left without a velocity" \
    "$(nsd-info -p "$tmp/apart.h5" | jq -s -c 'map(select(.v).v | map(fabs)) | add | max')" 0
ok "apart, to the slop" holds "$(place 1) - $(place 0) | . > 0.02 - 1.1e-8 and . < 0.02"
ok "and with their centre of mass where it was" holds "$(place 0) + 3 * $(place 1) - 0.057 | fabs < 1e-16"
echo '{ "dt": 1e-4, "allow_overlap": true, "bodies": [{ "x": [0, 0, 0.01], "radius": 0.01, "fixed": true },
    { "x": [0, 0, 0.011], "radius": 0.01 }], "walls": [{ "point": [0, 0, 0], "normal": [0, 0, 1] }] }' | scene deep
step --overlap-rule project -n 1 "$tmp/deep.h5" >"$tmp/first.h5"
ok "what overlaps deeply is moved by a tenth of its radius in a step, and not more" \
    holds "$(nsd-info -p "$tmp/first.h5" | jq -s 'map(select(.id == 1)) | .[-1].x[2] - 0.011') | . > 0.0009 and . < 0.0011"

# ---- what a projection does is in the balance ----

balances() { nsd-info "$1" | jq 'select(.balance).balance'; }
jq -n '{ dt: 1e-4, overlap: true, bodies: [{ x: [0, 0, 0.00999], radius: 0.01, mass: 0.5 }],
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }] }' | scene sunk
step -n 3 --overlap-rule project "$tmp/sunk.h5" >"$tmp/risen.h5"
ok "a ball that begins 1e-5 m deep in a floor is lifted to the slop: m g times that" \
    holds "$(balances "$tmp/risen.h5" | jq -s 'map(.projection) | add') / (0.5 * 9.81 * (1e-5 - 9.81e-8 - 1e-8)) - 1 | fabs < 1e-9"
is "nsd-move puts it into the report of nsd-solve" \
    "$(nsd-detect --overlap-rule project "$tmp/sunk.h5" | nsd-solve 2>/dev/null | nsd-move | nsd-info - | jq -c 'select(.balance).balance')" \
    "$(step -n 1 --overlap-rule project "$tmp/sunk.h5" | nsd-info - | jq -c 'select(.balance).balance')"
is "where nothing is moved there is no such term" \
    "$(step -n 1 --overlap-rule push "$tmp/sunk.h5" | nsd-info - | jq 'select(.balance).balance | has("projection")')" false
if have_h5py; then
    nsd-step -n 2 --overlap-rule project "$tmp/sunk.h5" 2>/dev/null >"$tmp/newer.h5"
    tail -c +513 "$tmp/newer.h5" >"$tmp/older.h5" # without its checksum
    /usr/bin/python3 -c 'import h5py, sys
solver = h5py.File(sys.argv[1], "r+")["nsd/solver"]
del solver["projection_work"], solver["projection_angular_momentum"]' "$tmp/older.h5"
    nsd-step -n 2 -i "$tmp/older.h5" 2>/dev/null
    is "a document of an earlier version, without the term, has a balance in all frames once it is continued" \
        "$(balances "$tmp/older.h5" | jq -s -c 'map(has("projection"))')" "[false,false,false,false]"
fi
jq '.walls[0].drives[0].from = 0 | .walls[0].drives[0].amplitude = 1.5e-3' scenes/shaken.json | scene shaken
# The mechanical energy that is missing over all steps of a log, and the work of the projection, in parts of that of the drives
misfit()
{
    jq -n -c '[inputs.balance | select(.)] | (map(.drives | fabs) | add) as $w | def E: .kinetic + .potential;
        [((.[-1] | E) - (.[0] | E) - (.[1:] | map(.loads + .drives - .dissipation + .projection) | add) | fabs) / $w,
            (map(.projection) | add) / $w]' "$1"
}
step --overlap-rule project -n 400 --every 400 --log="$tmp/shaken.log" "$tmp/shaken.h5" >"$tmp/x.h5"
ok "a vibrated bed: energy is balanced from its first step to its last, of which the projection is a part" \
    holds "$(misfit "$tmp/shaken.log") | .[0] < 1e-13 and .[1] > 1e-4"
jq -n '{ dt: 1e-3, gravity: [0, 0, 0], mu: 0.5, bodies: [{ x: [0, 0, 0], radius: 0.01, mass: 1, v: [1, 0, 0] },
    { x: [0.0205, 0.01, 0], radius: 0.01, mass: 1 }] }' | scene oblique
step -n 10 --overlap-rule project "$tmp/oblique.h5" >"$tmp/oblique-after.h5"
angular() { jq -s 'map(select(.x) | .x[0] * .v[1] - .x[1] * .v[0] + 4e-5 * .w[2]) | add'; } # of balls of 1 kg and 0.01 m, N m s
ok "an oblique impact: the angular momentum changes by what the projection adds" \
    holds "($(nsd-info -p --last "$tmp/oblique-after.h5" | angular) - $(nsd-info -p "$tmp/oblique.h5" | angular)) as \$more |
        $(balances "$tmp/oblique-after.h5" | jq -s 'map(.projection_angular_momentum[2]) | add') | . > 1e-6 and (\$more / . - 1 | fabs < 1e-9)"

# ---- a ball that rests on a slope, in the notch of two others ----

jq -n --argjson r $radius '{ dim: 2, dt: 1e-4, mu: 0.6, gravity: [0.98, -9.76], bodies: [{ x: [0, $r], radius: $r, fixed: true },
    { x: [2 * $r, $r], radius: $r, fixed: true }, { x: [$r, $r + (3 | sqrt) * $r], radius: $r }] }' | scene notch
for mode in "${modes[@]}"; do
    step --overlap-rule "$mode" -n 5000 --every 5000 "$tmp/notch.h5" >"$tmp/rests.h5"
    ok "$mode: a ball in a notch on a slope stays" \
        holds "$(nsd-info -p --last "$tmp/rests.h5" | jq -s -c "map(select(.id == 2)) | .[-1].x") as \$x |
            ((\$x[0] - $radius) | fabs) + ((\$x[1] - $radius * (1 + (3 | sqrt))) | fabs) <= 1e-4 * $radius"
done

# ---- what may not be ----

refuses 64 "a way that there is not" nsd-step --overlap-rule magic "$tmp/twenty.h5"
nsd-detect --overlap-rule gap "$tmp/falling.h5" >"$tmp/gaps.h5"
refuses 64 "contacts that were detected for gaps solved without" nsd-solve --overlap-rule project "$tmp/gaps.h5"
refuses 64 "or with --protocol paper" nsd-solve --protocol paper -m ebp "$tmp/gaps.h5"

done_testing
