#!/usr/bin/env bash
# The solvers of whole problems: real ones to the end, the criterion as nsd-err recomputes it, the same
# bytes whatever the threads and the width, and an honest end where there is none.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

solvers=(auto nlgs anderson)

# A settled heap, and what of it is to be solved
nsd-gen 60 | nsd-step -m exact --relax 1.5 -n 900 --every 900 --criterion glob --tolerance 1e-8 2>/dev/null |
    nsd-cat --last | nsd-detect --fclib=local >"$tmp/heap.h5"
nsd-detect "$tmp/heap.h5" >"$tmp/contacts.h5"

# awk: it is asked a hundred times, and jq takes ten times as long to start
below() # DOCUMENT NAME MOST: that number of each line of nsd-err
{
    nsd-err "$1" | awk -v name="\"$2\":" -v most="$3" '
        { at = index($0, name); x = substr($0, at + length(name)); if (!at || x !~ /^-?[0-9]/ || x + 0 > most) bad = 1 }
        END { exit bad || !NR }'
}

# ---- the paper's criterion, by bodies; W of the same packing ----

nsd-solve -m exact --criterion glob --tolerance 1e-13 --max-sweeps 200000 "$tmp/contacts.h5" >"$tmp/truth.h5" 2>/dev/null
velocities() { nsd-info --contacts "$1" | jq -r '.u | @tsv'; }
for g in "${solvers[@]}"; do
    eps=1e-12
    status 0 "--solver $g converges" nsd-solve -e --solver "$g" --criterion glob --tolerance $eps --max-sweeps 100000 "$tmp/contacts.h5"
    cp "$tmp/out" "$tmp/$g.h5"
    ok "--solver $g: the criterion, recomputed" below "$tmp/$g.h5" eps_glob "$eps"
    nsd-solve --solver "$g" --criterion glob --tolerance $eps --max-sweeps 100000 -j 4 "$tmp/contacts.h5" >"$tmp/four.h5" 2>/dev/null
    ok "--solver $g: the same bytes with four threads" cmp "$tmp/$g.h5" "$tmp/four.h5"
    NSD_LANES=2 nsd-solve --solver "$g" --criterion glob --tolerance $eps --max-sweeps 100000 "$tmp/contacts.h5" >"$tmp/two.h5" 2>/dev/null
    ok "--solver $g: and two lanes" cmp "$tmp/$g.h5" "$tmp/two.h5"
done
same() # two tables, to within the third number everywhere?
{
    paste "$1" "$2" | awk -v most="$3" '
        { for (i = 1; i <= NF / 2; i++) { d = $i - $(i + NF / 2); if (d < 0) d = -d; if (d > worst) worst = d } }
        END { exit worst > most }'
}
for g in auto anderson; do
    velocities "$tmp/truth.h5" >"$tmp/a"
    velocities "$tmp/$g.h5" >"$tmp/b"
    ok "--solver $g: the velocities are Gauss-Seidel's" same "$tmp/a" "$tmp/b" 1e-8
done

# ---- real problems ----

if [ -d "$problems" ]; then
    tolerance=1e-12
    [ -z "$thin" ] || tolerance=1e-8
    for f in "$problems"/*.hdf5 "$problems"/global/*.hdf5; do
        name=${f#"$problems/"}
        [ -z "$thin" ] || [ "$(stat -c %s "$f")" -lt 300000 ] || continue
        status 0 "$name: auto converges" nsd-solve -e --tolerance "$tolerance" "$f"
        ok "$name: to $tolerance, recomputed" below "$tmp/out" natural "$tolerance"
    done
else
    skip "problems of others" "no $problems"
fi

# ---- where there is no end ----

hard=$tmp/heap.h5
status 1 "-e and too few sweeps: status 1" nsd-solve -e --tolerance 0 --max-sweeps 7 "$hard"
like "says NOT CONVERGED" "$(cat "$tmp/err")" "NOT CONVERGED"
for g in "${solvers[@]}"; do
    status 0 "--solver $g, eps 0: ends" nsd-solve --solver "$g" --tolerance 0 --max-seconds $((thin ? 8 : 4)) "$tmp/contacts.h5"
    ok "--solver $g: what comes back is good all the same" below "$tmp/out" eps_glob 1e-6
done
status 0 "-m auto is --solver auto" nsd-solve -m auto "$tmp/contacts.h5"
cp "$tmp/out" "$tmp/a.h5"
nsd-solve "$tmp/contacts.h5" >"$tmp/b.h5" 2>/dev/null
ok "and the default" cmp <(nsd-info --contacts "$tmp/a.h5") <(nsd-info --contacts "$tmp/b.h5")
like "the document says so" "$(nsd-info "$tmp/b.h5" | jq -r '.options.solver? // empty')" auto
is "-m alone is Gauss-Seidel" "$(nsd-solve -m sbp "$tmp/contacts.h5" 2>/dev/null | nsd-info - |
    jq -r '.options.solver? // empty')" nlgs

# An operator that no bodies have, and numbers whose squares are none
spoilt() # NAME PYTHON: of the group g
{
    foreign "$tmp/heap.h5" "$tmp/heap.hdf5"
    h5copy -i "$tmp/heap.hdf5" -o "$tmp/$1.h5" -s /fclib_local -d /fclib_local
    py -c "import h5py; g = h5py.File('$tmp/$1.h5', 'r+')['fclib_local']; $2"
}
if have_h5py; then
    spoilt negative 'g["W/x"][...] *= -1'
    spoilt hole 'g["W/x"][0] = -0.1'
    spoilt huge 'g["vectors/q"][...] *= 1e200'
    for g in "${solvers[@]}"; do
        status 1 "--solver $g, -W: NOT CONVERGED" timeout 30 nsd-solve -e --solver "$g" --max-sweeps 2000 "$tmp/negative.h5"
        ok "--solver $g, -W: nsd-err reads it" nsd-err "$tmp/out"
        status 1 "--solver $g, one entry of W negative" timeout 30 nsd-solve -e --solver "$g" --max-sweeps 2000 "$tmp/hole.h5"
        ok "--solver $g, huge q: ends" timeout 30 nsd-solve --solver "$g" --max-sweeps 2000 "$tmp/huge.h5"
    done
else
    skip "operators of no bodies" "no h5py"
fi

# ---- the report is the truth: what nsd-err finds in the written file ----

agree() # NAME FILE: the report's natural map and nsd-err's, within a factor of 2 or both at rounding
{
    # shellcheck disable=SC2016 # jq's variables
    ok "$1: the report is what nsd-err finds" jq -en --argjson said "$(nsd-info "$2" | jq '.natural // empty')" \
        --argjson found "$(nsd-err "$2" | jq .natural)" \
        '($said < 1e-13 and $found < 1e-13) or ($said <= 2 * $found and $found <= 2 * $said)'
}
sweeps=1000000
[ -z "$thin" ] || sweeps=20000
for m in exact sbp; do
    nsd-solve -m $m --criterion natural --tolerance 0 --max-sweeps $sweeps "$tmp/contacts.h5" >"$tmp/long.h5" 2>/dev/null
    agree "$m, $sweeps sweeps" "$tmp/long.h5"
    ok "$m, $sweeps sweeps: their additions are not in it" below "$tmp/long.h5" natural 1e-13
done
for g in "${solvers[@]}"; do agree "--solver $g" "$tmp/$g.h5"; done

# ---- what cannot be done is said ----

if [ -z "$thin" ]; then
    many=$tmp/many.h5
    jq -n '{ dt: 1e-3, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
         bodies: [range(102400) | { radius: 0.5, x: [. % 32, (. / 32 | floor) % 32, 0.5 + (. / 1024 | floor)] }] }' |
        nsd-gen - | nsd-detect --gap 1e-6 >"$many"
    status 0 "very many contacts are not factorised" nsd-solve --criterion natural --tolerance 0 --max-sweeps 600 --log "$tmp/log" "$many"
    is "but swept" "$(jq -c '[.sweeps, .newton // 0]' "$tmp/log")" '[600,0]'
fi

# A limit of seconds holds in a factorisation too: none is begun that would pass it.
if [ -d "$problems/piles" ] && [ -z "$thin" ]; then
    nsd-detect "$problems/piles/pile8000.h5" >"$tmp/pile8000.h5"
    # seconds of the processor, of which a busy machine gives fewer in the same time
    spent=$(TIMEFORMAT=%0U && { time nsd-solve --criterion natural --tolerance 1e-9 --max-seconds 4 \
        "$tmp/pile8000.h5" >"$tmp/out" 2>/dev/null; } 2>&1)
    ok "auto ends within its seconds" [ "$spent" -lt 8 ]
fi

# ---- auto is as good as what it is made of: counted work, not time ----

work() # GLOBAL FILE EPS: what a solve that converges has cost, ns; null where it does not
{
    nsd-solve -m exact --solver "$1" --criterion natural --tolerance "$3" --max-sweeps 50000 --log "$tmp/work" "$2" \
        >"$tmp/out" 2>/dev/null
    jq 'if .converged then .work else null end' "$tmp/work"
}
# A quarter more than the best of its ingredients at most, or 10 ms
never_worse() # FILE EPS INGREDIENT ...
{
    local file=$1 eps=$2 auto least=null g w
    shift 2
    auto=$(work auto "$file" "$eps")
    for g in "$@"; do
        w=$(work "$g" "$file" "$eps")
        least=$(jq -n "[$least, $w] | map(values) | min")
    done
    jq -en --argjson auto "$auto" --argjson least "$least" \
        'if $least == null then true elif $auto == null then false else $auto <= 1.25 * $least + 1e7 end' ||
        { echo "auto $auto, the best of $* $least"; return 1; }
}
if [ -d "$problems" ] && [ -z "$thin" ]; then
    for f in "$problems"/*.hdf5; do
        ok "${f#"$problems/"}: auto is as good as anderson" never_worse "$f" 1e-8 anderson
    done
    stock pile500 | nsd-detect >"$tmp/pile500.h5"
    ok "500 balls: auto is as good as anderson" never_worse "$tmp/pile500.h5" 1e-6 anderson
    nsd-detect "$problems/piles/pile2000.h5" >"$tmp/pile2000.h5"
    for eps in 1e-4 1e-5; do
        ok "2000 balls to $eps: auto is as good as anderson" never_worse "$tmp/pile2000.h5" $eps anderson
        ok "8000 balls to $eps: auto is as good as anderson" never_worse "$tmp/pile8000.h5" $eps anderson
    done
fi

# ---- a map that is relative to reactions ----

jq '.e_n = 0 | .e_t = 0 | .mu = 0.3 | .bodies[0].spacing = 1.2' scenes/gas.json | nsd-gen - >"$tmp/gas.h5"
status 0 "a gas that cools: where no reactions are needed, rounding is no error" \
    nsd-step -e --criterion natural --tolerance 1e-6 -n 300 --every 300 --max-sweeps 3000 "$tmp/gas.h5"
jq '.seed = 7' scenes/paper/example2.json | nsd-gen - >"$tmp/jam.h5"
status 0 "a jam: 400 steps of example 2, seed 7" \
    nsd-step -e --criterion natural --tolerance 1e-4 -n 400 --every 400 --log "$tmp/log" "$tmp/jam.h5"
ok "and no small map of reactions that grow passes for a solution" \
    jq -se 'map(.natural_q) | max < 0.3' "$tmp/log"

status 0 "--max-seconds 0.001 is no error" nsd-solve --max-seconds 0.001 "$tmp/contacts.h5"
refuses 64 "--max-seconds 0" nsd-solve --max-seconds 0 "$tmp/contacts.h5"
refuses 64 "--solver nothing" nsd-solve --solver nothing "$tmp/contacts.h5"
for g in cg prox ipm; do
    refuses 64 "--solver $g is refused" nsd-solve --solver $g "$tmp/contacts.h5"
    like "with what to use instead" "$(cat "$tmp/err")" "$g is no longer available: auto"
done
nsd-gen 0 | nsd-detect >"$tmp/none.h5"
for g in "${solvers[@]}"; do
    status 0 "--solver $g of no contacts" nsd-solve -e --solver "$g" "$tmp/none.h5"
done

# ---- a settled pile, where a few contacts hold the sweeps up and are solved by themselves ----

jq ".mu = 0.8" scenes/paper/example3.json | nsd-gen - |
    nsd-step -m exact --relax 1.5 -n 955 --every 955 --overlap-rule keep --criterion glob --tolerance 1e-5 2>/dev/null | nsd-cat --last >"$tmp/pile.h5"
status 0 "steps of a settled pile to 1e-12" nsd-step -e --criterion glob --tolerance 1e-12 -n 12 --contacts --log "$tmp/log" "$tmp/pile.h5"
cp "$tmp/out" "$tmp/one.h5"
ok "three of them or more by one or two thousand sweeps and Newton's steps" \
    jq -se 'map(select(.newton > 0 and .sweeps < 2500)) | length >= 3' "$tmp/log"
ok "the criterion, recomputed" jq -se 'map(.eps_glob) | max <= 1e-12' <(nsd-err "$tmp/one.h5")
nsd-step --criterion glob --tolerance 1e-12 -n 12 --contacts -j 4 "$tmp/pile.h5" >"$tmp/four.h5" 2>/dev/null
ok "the same bytes with four threads" cmp "$tmp/one.h5" "$tmp/four.h5"
NSD_LANES=2 nsd-step --criterion glob --tolerance 1e-12 -n 12 --contacts "$tmp/pile.h5" >"$tmp/two.h5" 2>/dev/null
ok "and two lanes" cmp "$tmp/one.h5" "$tmp/two.h5"

for mu in 0 1e-9 2; do
    jq ".mu = $mu | .bodies[0].count = 60" scenes/paper/example3.json | nsd-gen - |
        nsd-step -m exact --relax 1.5 -n 700 --every 700 --tolerance 1e-6 --max-sweeps 200 2>/dev/null | nsd-cat --last |
        nsd-detect >"$tmp/mu.h5"
    status 0 "auto, mu = $mu" nsd-solve -e --criterion glob --tolerance 1e-11 "$tmp/mu.h5"
done
done_testing
