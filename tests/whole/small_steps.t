#!/usr/bin/env bash
# Steps in small ones of one sweep: impacts, sliding and rolling in closed form, a heavy ball on a bed, a gas that keeps its
# energy, a pile that comes to rest; the same bytes for threads and resumed runs; what is made at once is said.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2016 # jq, tap.sh sets tmp
. tests/support/tap.sh
# shellcheck source=tests/support/small.sh
. tests/support/small.sh

floor='walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }], gravity: [0, 0, -9.81], dt: 1e-3'

# ---- one ball ----

for e in 0.3 0.7 1; do
    scene "$floor, e_n: $e, bodies: [{ x: [0, 0, 0.11], radius: 0.01 }]"
    small 200 # it falls 0.1 m in 0.143 s: m g h e^2 is left of its energy above the floor
    ok "a ball that falls from 0.1 m with e $e keeps e^2 of its energy" near \
        "$(body '(.v[2] * .v[2] / 2 + 9.81 * (.x[2] - 0.01)) / 0.981')" "$e * $e" 2e-3
done
scene "$floor, mu: 0.3, bodies: [{ x: [0, 0, 0.01], radius: 0.01, v: [1, 0, 0] }]"
small 300
ok "a sliding ball ends at 5/7" near "$(body '.v[0]')" "5 / 7" 2e-5
scene 'dim: 2, walls: [{ point: [0, 0], normal: [0, 1] }], gravity: [0, -9.81], dt: 1e-3, mu: 0.3,
    bodies: [{ x: [0, 0.01], radius: 0.01, v: [1, 0] }]'
small 300
ok "a sliding disc ends at 2/3" near "$(body '.v[0]')" "2 / 3" 2e-5
scene "$floor, mu: 0.5, rolling: { mu_r: 1e-4 }, bodies: [{ x: [0, 0, 0.01], radius: 0.01, v: [1, 0, 0], w: [0, 100, 0] }]"
small 300
ok "rolling friction: v = v0 - 5/7 g mu_r t/r" near "$(body '.v[0]')" "1 - 5 / 7 * 9.81 * 0.01 * 0.3" 1e-5
# a lift that starts late: what it does in a small step is not what it does at another time
scene 'gravity: [0, 0, -9.81], dt: 1e-3, bodies: [{ x: [0, 0, 0.01], radius: 0.01 }],
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1], drives: [{ along: [0, 0, 1], table: [[0, 0], [0.1, 0], [0.2, 0.01], [0.3, 0.01]] }] }]'
small 95
ok "a ball on a floor that is to rise at 0.1 s is at rest before" near "$(body '.x[2]')" 0.01 2e-6
small 150
ok "and rises with it" near "$(body '.x[2]')" 0.015 1e-5

# A ball whose lowest point is on the seam of two flush discs stays there: neither takes the other's contact for that of a rim.
for x in 0.00599 0.005999 0.0059999 0.006 0.0060001; do
    scene "dt: 2e-4, gravity: [0, 0, -9.81], bodies: [{ x: [$x, 0, 0.001], radius: 0.001 }], walls: [
        { disc: { center: [0, 0, 0], normal: [0, 0, 1], radius: 0.02, hole: 0.006 } }, { disc: { center: [0, 0, 0], normal: [0, 0, 1], radius: 0.006 } }]"
    small 500
    ok "a ball rests on the seam of two discs, at $x m" near "$(body '.x[2]')" 0.001 1e-6
done

# ---- many ----

# A ball of 20 mm on two layers of 2 mm, at 2 m/s with e 0.4: 0.62 to 0.72 m/s by Newton's law for simultaneous impacts
jq -n '[range(7) as $i | range(7) as $j | { x: [0.002 * ($i - 3), 0.002 * ($j - 3), 0.001], radius: 0.001 }] +
    [range(6) as $i | range(6) as $j | { x: [0.002 * ($i - 2.5), 0.002 * ($j - 2.5), 0.00242], radius: 0.001 }] +
    [{ x: [0, 0, 0.0135], radius: 0.01, v: [0, 0, -2], material: "steel" }] | { dim: 3, dt: 5e-5, gravity: [0, 0, -9.8],
    density: 2500, mu: 0.3, e_n: 0.4, overlap: true, materials: { steel: { density: 7200 } },
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }], bodies: . }' | nsd-gen - >"$tmp/in.h5"
for dt in 5e-5 1e-5; do
    steps=$(jq -n "0.003 / $dt | round")
    small "$steps" --dt "$dt"
    ok "a heavy ball rebounds from a bed of light ones, dt $dt s" near \
        "$(nsd-info --last -p "$tmp/out.h5" | jq 'select(.radius > 0.009) | .v[2]')" 0.67 0.05
done

# A column of five on the floor is struck from above at 2 m/s: by Newton's law for simultaneous impacts the top ball rebounds
# with 2 e, but for gravity, and the others rest. In whatever order the balls are.
for e in 0 0.5 0.9; do
    for order in '0, 1, 2, 3, 4, 5' '3, 0, 5, 1, 4, 2'; do
        scene "$floor, mu: 0.3, e_n: $e, bodies: [$order | { x: [0, 0, (0.01 + 0.02 * .)], radius: 0.01 } + (if . == 5 then { x: [0, 0, 0.1105], v: [0, 0, -2] } else {} end)]"
        small_alone 2
        ok "a column is struck, e $e: the top ball rebounds with 2 e, order $order" near \
            "$(nsd-info --last -p "$tmp/out.h5" | jq -s 'map(select(.id != null)) | max_by(.x[2]).v[2]')" "2 * $e" 0.25
    done
done

for ratio in 300 3000; do
    scene "$floor, materials: { heavy: { density: ($ratio * 2600) } }, bodies: [{ x: [0, 0, 0.01], radius: 0.01 }, { x: [0, 0, 0.03], radius: 0.01, material: \"heavy\" }]"
    ok "a ball that carries $ratio times its mass sinks by less than 0.003 radii, in small steps" \
        eval 'small_alone 200 && near "$(last .max_overlap)" 0 3e-3 && near "$(body ".x[2]")" 0.01 3e-5'
done

jq -n '{ dim: 3, dt: 1e-3, gravity: [0, 0, 0], density: 2500, mu: 0, e_n: 1, seed: 3, cell: { lengths: [0.05, 0.05, 0.05] },
    bodies: [range(6) as $i | range(6) as $j | range(6) as $k | { radius: 0.002, x: [$i, $j, $k] | map((. + 0.5) * 0.0083),
    } | .v = [(.x[0] * 7e4 | sin), (.x[1] * 5e4 + 1 | sin), (.x[2] * 6e4 + 2 | sin)]] | map(.v |= map(. * 0.5)) }' | nsd-gen - >"$tmp/in.h5"
before=$(nsd-info --last -l "$tmp/in.h5" | jq .kinetic_energy)
small 300
ok "a gas of elastic balls keeps its energy" near "$(last .kinetic_energy) / $before" 1 0.01
is "no step of it was made at once" "$(grep -c "at once" "$tmp/err")" 0

nsd-gen 400 | nsd-step --small-steps 0.01 --until 1.5 --every 1000 -o "$tmp/pile.h5" 2>"$tmp/err"
ok "a pile of 400 comes to rest: less than 1e-5 m g d per ball" \
    eval 'nsd-info --last -p "$tmp/pile.h5" | jq -es "map(select(.id != null)) | (map(.v | map(. * .) | add) | add / length / 2)
        < 1e-5 * 9.81 * 2 * .[0].radius" >"$tmp/rest"'
heights() { nsd-info -p "$tmp/pile.h5" | jq -s "map(select(.step == $1 and .x)) | (map(.x[2]) | add / length), .[0].radius"; }
ok "and stays there: in 0.5 s it sinks by less than 1e-5 of a radius" near "$(heights 20000 | jq -s "[($(heights 30000 | jq -s '.[0]') - .[0]) / .[1]] | .[0]")" 0 1e-5

# ---- forces ----

nsd-gen 60 | nsd-step --small-steps 0.01 -n 300 --every 300 2>"$tmp/err" >"$tmp/in.h5"
nsd-step --small-steps 0.01 -n 4 --contacts -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "reactions of a heap are those of Newton's law" newton '[0, 0, -4.905e-4]' # of 5e-5 s
# Balls that meet and part within a step, and fly past a plate with an edge
scene 'dim: 3, dt: 2e-2, gravity: [0, 0, 0], density: 2500, mu: 0.3, e_n: 0.9,
    walls: [{ rectangle: { center: [0.02, 0.02, 0], normal: [0, 0, 1], along: [1, 0, 0], sides: [0.03, 0.03] } }],
    bodies: [range(5) as $i | range(5) as $j | range(3) as $k | { radius: 0.002, x: [$i, $j, $k] | map((. + 0.5) * 0.0083) } |
        .v = [(.x[0] * 7e4 | sin), (.x[1] * 5e4 + 1 | sin), (.x[2] * 6e4 + 2 | sin)]] | map(.v |= map(. * 0.5))'
nsd-step --small-steps 0.01 -n 4 --contacts -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "and of balls that have parted" newton '[0, 0, 0]'
# A ball on a turntable: pivoting friction turns it, I dw = the moment of its contact
scene 'dt: 1e-3, gravity: [0, 0, -10], density: 1000, mu: 0.5, rolling: { mu_p: 1e-4 }, bodies: [{ x: [0, 0, 0.01], radius: 0.01 }],
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1], drives: [{ about: [0, 0, 0], axis: [0, 0, 1], speed: 5 }] }]'
nsd-step --small-steps 0.002 -n 20 --contacts -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "moments of a step are what turns a ball, and torques are those of the law" \
    eval 'nsd-info -p -c "$tmp/out.h5" | jq -es "(4e-6 / 3 * 3.14159265358979 * 1000 * 0.4 * 1e-4) as \$I | map(select(.id == 0).w[2]) as \$w |
        [[.[] | select(.moment).moment[0]][1:], [range(1; \$w | length) as \$k | \$I * (\$w[\$k] - \$w[\$k - 1])]] |
        (transpose | length == 19 and all(.[0] - .[1] | fabs < 1e-15)) and (.[0] | add / length / 4.18879e-9 - 1 | fabs < 2e-3)" >"$tmp/moment"'

# ---- the error ----

# At rest reactions persist, and the sweeps of all steps are those of one solve.
ok "of a pile at rest less than 1e-4 of the load" \
    eval 'nsd-info --last -l "$tmp/pile.h5" | jq -es "map(select(.balance)) | last.balance.missing_impulse_mean < 1e-4" >"$tmp/missing"'
scene "$floor, bodies: [{ x: [0, 0, 0.01], radius: 0.01 }]"
small 20
ok "of one ball on a floor nothing" near "$(last .balance.missing_impulse)" 0 1e-12
jq -n "{ $floor, bodies: [range(10) | { x: [0, 0, (0.01 + 0.02 * .)], radius: 0.01 }] }" | nsd-gen - >"$tmp/in.h5"
small 1
first=$(last .balance.missing_impulse_mean)
small 60
ok "of a column whose reactions begin at 0 more than 0.04, at rest less than 0.01" \
    near "($first > 0.04) and ($(last .balance.missing_impulse_mean) < 0.01) | if . then 0 else 1 end" 0 0
small 1000
ok "and it comes to rest to rounding" near "$(last '[.balance.missing_impulse, .balance.kinetic / .balance.potential] | max')" 0 1e-12
nsd-step --small-steps 0.01 -n 5 --log "$tmp/log" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
is "each line of a log has it" "$(jq -s 'map(select(.balance.missing_impulse > 0)) | length' "$tmp/log")" 5

# Two balls on a floor, from reactions of 0, in units of m g h: a sweep gives 1/1.04 and that over 2.08; the law, C = 0.04 W, holds for both
# where 1.04 r_0 - r_1 = 1 and 2.08 r_1 = r_0.
jq -n "{ $floor, bodies: [range(2) | { x: [0, 0, (0.01 + 0.02 * .)], radius: 0.01 }] } | .dt = 1e-4" | nsd-gen - >"$tmp/in.h5"
exact='(1 / (1.04 * 2.08 - 1)) as $r | [2.08 * $r, $r] as $c | [1 / 1.04, 1 / 1.04 / 2.08] as $f |
    ([$c, $f] | transpose | map(pow(.[0] - .[1]; 2)) | add | sqrt) / ($c | map(. * .) | add | sqrt)'
error() { last '.balance | [.small_steps, .reaction_error]'; }
small 1 --contacts
is "the one small step of two balls" "$(error | jq '.[0]')" 1
ok "its reactions differ from converged ones as by hand" near "$(error | jq '.[1]')" "$exact" 1e-6
small 1 --contacts --missing-impulse 1e-9
ok "sweeps that are bounded converge" near "$(error | jq '.[1]')" 0 1e-7
small 1
is "without --contacts nothing is compared" "$(error)" '[1,null]'
nsd-gen 60 >"$tmp/balls.h5"
jq '.bodies[0].count = 20' scenes/capsules.json | nsd-gen - >"$tmp/capsules.h5"
for start in in balls capsules; do
    for options in "" --contacts "--contacts -j 3"; do
        # shellcheck disable=SC2086 # words
        nsd-step --small-steps 0.01 -n 40 --every 20 $options "$tmp/$start.h5" 2>"$tmp/err" | nsd-info --last -p
    done | sort -u >"$tmp/all"
    is "nor does a comparison change the motion, on any number of threads: $start" "$(wc -l <"$tmp/all")" "$(sort -u <(jq .id "$tmp/all") | wc -l)"
done
nsd-gen 100 | nsd-step -n 600 --every 600 -o "$tmp/in.h5" 2>"$tmp/err"
for b in 0.1 0.01 0.001; do
    small 20 --missing-impulse $b
    ok "at most the part $b of the impulses is missing" near "($(last .balance.missing_impulse_mean) <= 1.05 * $b) | if . then 0 else 1 end" 0 0
done
ok "the same bytes where it is bounded" same_bytes 20 --missing-impulse 0.01

# ---- which runs make small steps ----

nsd-gen 20 >"$tmp/in.h5"
makes() # small|once OPTION ...: such steps, of in.h5
{
    nsd-step -n 1 "${@:2}" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err" || return
    [ "$(grep -c "1 steps were made in" "$tmp/err")$(grep -c "small ones" "$tmp/err")" = "$([ "$1" = small ] && echo 11 || echo 00)" ]
}
while read -ra option; do
    ok "one solve per step: ${option[*]}" makes once "${option[@]}"
done <<'END'
--small-steps 0
--solver auto
-m sbp
-m auto
--protocol paper -m sbp
--tolerance 1
--criterion velocity
--max-sweeps 100
--max-seconds 100
--alpha 1
--newton plain
--newton-max 10
--relax 1
--order colour
--every-sweep
--gap 0
--overlap-rule project
--dt 5e-5
--stiffness auto
END
while read -ra option; do
    ok "small steps: ${option[*]-without options}" makes small "${option[@]}"
done <<'END'

--small-steps 0.02
--small-steps 0.02 --solver nlgs --tolerance 1e-3 --overlap-rule keep
--theta 0.7
--cold
--warm
-j 2
--contacts --wall-loads
--stiffness 1e3
END
nsd-step --protocol paper -m sbp -n 1 "$tmp/in.h5" 2>"$tmp/err" >"$tmp/paper.h5" && mv "$tmp/paper.h5" "$tmp/in.h5"
ok "one solve per step: a document with another rule of overlaps" makes once
nsd-gen 20 | nsd-step --solver auto -n 1 2>"$tmp/err" >"$tmp/in.h5"
ok "small steps: one with the default rule" makes small
scene "$floor, stiffness: { compliance: 0.01 }, bodies: [{ x: [0, 0, 0.02], radius: 0.01 }]"
ok "one solve per step: contacts with a compliance" makes once

# ---- bytes, and words ----

nsd-gen 400 | nsd-step --small-steps 0.02 -n 40 --every 20 -o "$tmp/one.h5" 2>"$tmp/err"
nsd-gen 400 | nsd-step -j 3 --small-steps 0.02 -n 40 --every 20 -o "$tmp/three.h5" 2>"$tmp/err"
nsd-gen 400 | NSD_LANES=2 nsd-step --small-steps 0.02 -n 40 --every 20 -o "$tmp/narrow.h5" 2>"$tmp/err"
nsd-gen 400 | nsd-step --small-steps 0.02 -n 20 --every 20 2>"$tmp/err" |
    nsd-step --small-steps 0.02 -n 20 --every 20 -o "$tmp/again.h5" 2>"$tmp/err"
frame() { nsd-info --last -p "$1"; }
ok "three threads: the same bodies" cmp <(frame "$tmp/one.h5") <(frame "$tmp/three.h5")
ok "two lanes: the same bodies" cmp <(frame "$tmp/one.h5") <(frame "$tmp/narrow.h5")
ok "a resumed run: the same bodies" cmp <(frame "$tmp/one.h5") <(frame "$tmp/again.h5")
ok "the end says how many small steps there were" grep -q "made in [0-9]* small ones" "$tmp/err"

scene "$floor, stiffness: 1e12, bodies: [{ x: [0, 0, 0.02], radius: 0.01 }]"
small 2
ok "what small steps do not have is said" grep -q "no small steps with contacts or bonds so stiff" "$tmp/err"

done_testing
