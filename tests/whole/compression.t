#!/usr/bin/env bash
# Compression without gravity, by what nsd-step does about overlap by default: packings end at solid fractions
# that are known and without overlaps, whatever presses them; and balls go round in what is concave.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

holds() { jq -e -n "$@" >/dev/null; } # a jq program that says true
# Of the last frame: the solid fraction, the largest overlap over the radius
end() { nsd-info --last "$1" | jq -c "select(.sweeps) | [$2, .max_overlap / 0.005]"; }

# 150 balls (r = 5 mm) in a cell under P Pa, friction MU, steps of DT s, edges of M kg
cell()
{
    jq -n --argjson P "$1" --argjson mu "$2" --argjson dt "$3" --argjson M "$4" --argjson e "${5:-0}" '
        0.005 as $r | (150 * 4.18879 * $r * $r * $r / 0.22 | log / 3 | exp) as $L |
        { dt: $dt, gravity: [0, 0, 0], density: 2500, seed: 3, mu: $mu, e_n: $e, cell: { lengths: [$L, $L, $L], stress: { pressure: $P, mass: $M } },
          bodies: [{ random: { count: 150 }, radius: $r, box: { x: [0, $L], y: [0, $L], z: [0, $L] } }] }' | nsd-gen - >"$tmp/cell.h5"
    nsd-step -n "$6" --every "$6" --log "$tmp/log" "$tmp/cell.h5" >"$tmp/pressed.h5" 2>"$tmp/err"
    end "$tmp/pressed.h5" '(150 * 4.18879 * 1.25e-7) / (.edges[0][0] * .edges[1][1] * .edges[2][2])'
}
# Balls with friction jam between random loose and random close packing, without friction at 0.64 less what a
# small cell lacks [Onoda & Liniger 1990, O'Hern et al. 2003]. A grain goes P d^2 dt^2/m, in radii: 4e-3, 4e-3, 0.4, 6e-2, 4e-3.
while read -r name low high args; do
    # shellcheck disable=SC2086 # words
    found=$(cell $args)
    ok "$name: a solid fraction of $low to $high, no overlap beyond 3e-3 r: $found" \
        holds "$found | .[0] > $low and .[0] < $high and .[1] < 3e-3"
done <<'END'
1kPa,mu=0.3 0.56 0.61 1000 0.3 5e-4 0.02 0 400
1kPa,mu=0 0.60 0.65 1000 0 5e-4 0.02 0 500
100kPa,mu=0.3 0.56 0.61 100000 0.3 5e-4 0.02 0 300
light,fast,edges 0.56 0.61 1000 0.3 2e-3 0.002 0 200
balls,that,rebound 0.56 0.61 1000 0.3 5e-4 0.02 0.5 400
END

# Discs in a cell, without friction: 0.84 where all jam at once [O'Hern et al. 2003], a little less in a small one
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, 0], density: 2500, seed: 5, mu: 0, e_n: 0, cell: { lengths: [0.14, 0.14], stress: { pressure: 100, mass: 2 } },
    bodies: [{ random: { count: 120 }, radius: { uniform: [0.004, 0.006] }, box: { x: [0, 0.14], y: [0, 0.14] } }] }' | nsd-gen - >"$tmp/discs.h5"
nsd-step -n 1500 --every 1500 "$tmp/discs.h5" 2>/dev/null >"$tmp/pressed.h5"
area=$(nsd-info -p --last "$tmp/pressed.h5" | jq -s 'map(select(.radius).radius | 3.14159265 * . * .) | add')
found=$(end "$tmp/pressed.h5" "$area / (.edges[0][0] * .edges[1][1])")
ok "discs: 0.81 to 0.86, no overlap beyond 3e-3 r: $found" holds "$found | .[0] > 0.81 and .[0] < 0.86 and .[1] < 3e-3"

# Six walls that loads press together
jq -n '0.07 as $L | 2.5 as $f | { dt: 2e-4, gravity: [0, 0, 0], density: 2500, seed: 3, mu: 0.3, e_n: 0,
    bodies: [{ random: { count: 150 }, radius: 0.005, box: { x: [0, $L], y: [0, $L], z: [0, $L] } }],
    walls: [[1, 0, 0], [0, 1, 0], [0, 0, 1] | . as $n | { point: [0, 0, 0], normal: $n, load: { along: $n, mass: 0.05, force: $f } },
        { point: map(. * $L), normal: map(-.), load: { along: map(-.), mass: 0.05, force: $f } }] }' | nsd-gen - >"$tmp/box.h5"
nsd-step -n 2500 --every 2500 "$tmp/box.h5" 2>"$tmp/err" >"$tmp/pressed.h5"
found=$(end "$tmp/pressed.h5" 0)
ok "six walls: no overlap beyond 3e-3 r: $found" holds "$found | .[1] < 3e-3"
nsd-info -w --last "$tmp/pressed.h5" | jq -s -c '[map(select(.wall != null)) | range(0; 6; 2) as $k | (.[$k + 1].point[$k / 2] - .[$k].point[$k / 2])] | 150 * 4.18879 * 1.25e-7 / (.[0] * .[1] * .[2])' >"$tmp/phi"
ok "and a loose packing between them: $(cat "$tmp/phi")" holds "$(cat "$tmp/phi") | . > 0.45 and . < 0.6"

# ---- what is concave: a ball slides in a cylinder, a sphere, a circle at 0.008 rad a step ----

round() # WALL MODE E: its speed after 2.4 s over that before, and how deep it is in the wall over its radius
{
    jq -n --arg w "$1" --argjson e "$3" '{ dt: 1e-3, dim: (if $w == "circle" then 2 else 3 end), gravity: (if $w == "circle" then [0, 0] else [0, 0, 0] end), mu: 0, e_n: $e,
        bodies: [{ x: [0.095, 0, 0], radius: 0.005, v: [0, 0.76, 0] } | if $w == "circle" then .x |= .[:2] | .v |= .[:2] else . end],
        walls: [if $w == "sphere" then { sphere: { center: [0, 0, 0], radius: 0.1, side: "inside" } } elif $w == "circle" then { circle: { center: [0, 0], radius: 0.1 } }
            else { cylinder: { point: [0, 0, 0], axis: [0, 0, 1], radius: 0.1 } } end] }' | nsd-gen - |
        nsd-step --overlap-rule "$2" -n 2400 --every 2400 2>/dev/null | nsd-info --last -p - |
        jq -c 'select(.x) | [(.v | map(. * .) | add | sqrt / 0.76), ((.x | map(. * .) | add | sqrt) - 0.095) / 0.005]'
}
for wall in cylinder sphere circle; do
    for e in 0 0.5; do
        for mode in project gap gap-project; do
            ok "$mode, $wall, e_n = $e: a ball keeps its speed to 1e-4, and its way to 1e-3 r" \
                holds "$(round $wall $mode $e) | (.[0] - 1 | fabs) < 1e-4 and (.[1] | fabs) < 1e-3"
        done
    done
done
ok "keep: it is slowed down and sinks" holds "$(round cylinder keep 0) | .[0] < 0.99 and .[1] > 0.1"

done_testing
