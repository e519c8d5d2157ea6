#!/usr/bin/env bash
# What holds up the solvers on large piles: self-stresses are seen, sweeps that wander are given up, and make wall
# measures what it says.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

# ---- a ball, a disc on a floor: W r is g dt, r is m g dt, and rho is m over 7/2 in space, 3 in the plane ----

resting() { jq -n --argjson dim "$1" '{dim: $dim, dt: 1e-4, mu: 0.3, density: 2500, bodies: [{x: ([0, 0, 1e-3] | if $dim == 2 then [0, 1e-3] else . end), radius: 1e-3}],
    walls: [{normal: (if $dim == 2 then [0, 1] else [0, 0, 1] end), point: (if $dim == 2 then [0, 0] else [0, 0, 0] end)}]}' |
    if [ "$1" = 2 ]; then jq '.gravity = [0, -9.81]'; else cat; fi | nsd-gen - | nsd-detect | nsd-solve --tolerance 1e-12 2>/dev/null | nsd-err | jq .self_stress; }
is "a ball at rest: 2/7" "$(resting 3 | jq '. - 2/7 | fabs < 1e-14')" true
is "a disc at rest: 1/3" "$(resting 2 | jq '. - 1/3 | fabs < 1e-14')" true

# ---- four balls that wedge themselves in: reactions grow, nothing moves ----

jq '.seed = 7' scenes/paper/example2.json | nsd-gen - | nsd-step -n 217 --overlap-rule keep --criterion natural 2>/dev/null |
    nsd-cat --frames 217 | nsd-detect --overlap-rule keep >"$tmp/jam.h5"
for eps in 1e-4 1e-5 1e-6; do
    nsd-solve --solver nlgs -m exact --criterion natural --tolerance $eps --max-sweeps 1000000 "$tmp/jam.h5" >"$tmp/jam-$eps.h5" 2>/dev/null
    nsd-err "$tmp/jam-$eps.h5" >"$tmp/jam-$eps"
done
like "self-stress falls as eps does" "$(jq -s 'map(.self_stress) | [.[0] / .[1], .[1] / .[2]] | all(. > 8 and . < 12)' "$tmp"/jam-1e-[456])" '^true$'

# ---- the page's own numbers, from M and H ----

if /usr/bin/python3 -c 'import scipy' 2>/dev/null; then
    nsd-detect --overlap-rule keep --fclib=global <"$tmp/jam.h5" >"$tmp/jam.global"
    scripts/wall/wall.py follow "$tmp/jam.global" "$tmp"/jam-1e-[456].h5 >"$tmp/follow"
    is "the self-stress and the map of nsd-err are those of M and H" \
        "$(jq -s '[.[0:3], .[3:]] | transpose | map((.[0].self_stress / .[1].self_stress - 1 | fabs < 1e-9) and (.[0].natural / .[1].natural - 1 | fabs < 1e-6)) | all' \
            "$tmp"/jam-1e-[456] "$tmp/follow")" true
    if [ -z "$thin" ]; then
        ok "make wall QUICK=1" make -s -f scripts/wall.mk QUICK=1 OUT="$tmp/wall"
        steps() { jq -s --arg l "$1" "map(select(.law == \$l and .ratio)) | length > 15 and $2" "$tmp/wall/500/steps.jsonl"; }
        is "its proximal steps are solved" "$(jq -s 'all(.exact < 1e-4)' "$tmp/wall/500/steps.jsonl")" true
        is "with the radii held none is longer than the one before" "$(steps held 'all(.ratio < 1)')" true
        # the contacts of the spectrum are the pile's
        like "its page has its tables" "$(cat "$tmp/wall/README.md")" \
            "\| 500 \| 4000 \|.*\| 500 \| $(nsd-info --last "$tmp/wall/500/pile.h5" | jq 'select(.contacts).contacts') \|"
        is "nothing is left to fill in" "$(grep -c '@' "$tmp/wall/README.md" || true)" 0
    fi
else
    skip "make wall" "no scipy"
fi

# ---- sweeps that wander ----

if [ -n "$thin" ]; then
    skip "sweeps of 8000 balls" "they are made without sanitizers"
elif [ -e "$problems/piles/pile8000.h5" ]; then
    nsd-detect "$problems/piles/pile8000.h5" >"$tmp/pile.h5"
    status 1 "they are given up" nsd-solve --strict --criterion natural --tolerance 1e-8 "$tmp/pile.h5"
    cp "$tmp/out" "$tmp/given-up.h5"
    like "nsd-solve says so" "$(cat "$tmp/err")" 'given up: the sweeps wander'
    like "long before the limit, with the best that they found" \
        "$(nsd-info "$tmp/given-up.h5" | jq -c 'select(.sweeps) | [.sweeps < 50000, .converged, .natural < 1e-5]')" '^\[true,false,true\]$'
    NSD_LANES=2 nsd-solve -j 2 --criterion natural --tolerance 1e-8 "$tmp/pile.h5" >"$tmp/again.h5" 2>/dev/null
    ok "at the same sweep for any threads and width" cmp "$tmp/given-up.h5" "$tmp/again.h5"
    status 0 "the default is not concerned" nsd-solve --strict "$tmp/pile.h5"
else
    skip "sweeps of 8000 balls" "no ../shared/problems"
fi
done_testing
