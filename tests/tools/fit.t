#!/usr/bin/env bash
# nsd-fit: known parameters lie in the stated intervals; it says what targets cannot tell; a killed run makes the same table.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2016 # functions called by name; text for eval
. tests/support/tap.sh

{ has sklearn && has scipy; } || { echo "1..0 # SKIP no scikit-learn"; exit 0; }
cd "$tmp"

# ---- closed forms with scatter: p = a + 0.3 b, q = a^2 - b, uniform noise of 0.05 by the seed ----

problem() # A B: targets of these parameters, with errors that the noise of one measurement has
{
    jq -n --argjson a "$1" --argjson b "$2" --argjson k "$3" '
        def noise($s; $n): (($s * $n % 1009) / 1009 - 0.5) * 0.05;
        { scene: { seed: 1, mu: 0, pairs: [{ mu: 0 }] }, seed: (1000 * $k),
          parameters: { a: { keys: "mu", range: [0, 1] }, b: { keys: { "pairs[0].mu": 1 }, range: [0, 2] } },
          command: "jq \"def n(\\$k): ((.seed * \\$k % 1009) / 1009 - 0.5) * 0.05; {p: (.mu + 0.3 * .pairs[0].mu + n(7919)), q: (.mu * .mu - .pairs[0].mu + n(104729))}\"",
          targets: { p: { value: ($a + 0.3 * $b + noise($k + 17; 613)), error: 0.0145 },
                     q: { value: ($a * $a - $b + noise($k + 5; 401)), error: 0.0145 } } }'
}
inside=0 of=0
for k in 1 2 3 4; do
    a=0.$((2 * k)) b=$(jq -n "1.9 - 0.4 * $k")
    problem $a "$b" $k >known.json
    rm -rf known.fit
    nsd-fit --quiet known.json >known.out 2>&1 || { diag "$(cat known.out)"; break; }
    n=$(jq --argjson a $a --argjson b "$b" '[(.parameters | [.a, $a], [.b, $b]) | .[0].interval90[0] <= .[1] and .[1] <= .[0].interval90[1]] |
        map(select(.)) | length' known.fit/result.json)
    inside=$((inside + n)) of=$((of + 2))
done
ok "known parameters lie in 90 % intervals, $inside of $of" [ "$inside" -ge 7 ]
ok "which are narrow" jq -e '.parameters | .a.interval90[1] - .a.interval90[0] < 0.08' known.fit/result.json
is "and the run has finished without a remark" "$(jq -c '[.finished, .remarks]' known.fit/result.json)" '[true,[]]'
is "the scene has the best values" "$(jq -c '[.mu, .pairs[0].mu]' known.fit/scene.json)" "$(jq -c '.parameters | [.a.value, .b.value]' known.fit/result.json)"
if command -v gnuplot >/dev/null; then ok "a plot" grep -q '</svg>' known.fit/errors.svg; else skip "a plot" "no gnuplot"; fi
like "all are told on standard output" "$(cat known.out)" 'a +[0-9.]+ +[0-9.]+ to [0-9.]+'

problem 0.5 0.9 3 | jq '.command |= sub(", q.*"; "}\"") | del(.targets.q)' >ridge.json
nsd-fit --quiet ridge.json >ridge.out 2>&1 || true
like "a sum does not tell its terms" "$(cat ridge.out)" 'a and b are determined only together'
like "and several sets fit" "$(cat ridge.out)" 'sets of parameters that are far apart fit equally well'
problem 0.5 0.9 3 | jq '.command = "jq .mu" | del(.targets.q)' >one.json
nsd-fit --quiet one.json >one.out 2>&1 || true
like "what has no influence is not determined" "$(cat one.out)" 'b is not determined by the targets'
# one packing has both measures, so that the second one has no new information; if its error counted as independent, the interval would be 0.7 times as wide
width() { jq '.parameters.a.interval90 | .[1] - .[0]' "$1.fit/result.json"; }
problem 0.5 0.9 3 | jq '.targets = { p: { value: 0.5 } } | del(.parameters.b) |
    .command = "jq \"(((.seed * 7919 % 1009) / 1009 - 0.5) * 0.05) as \\$n | {p: (.mu + \\$n), q: (.mu + \\$n)}\""' >alone.json
jq '.targets.q = .targets.p' alone.json >twice.json
for n in alone twice; do nsd-fit --quiet $n.json >$n.out 2>&1 || true; done
ok "a measure that repeats another one makes no interval narrower" jq -n -e "$(width twice) / $(width alone) > 0.9"
jq '.targets.p.value = 40 | .evaluations = 40' known.json >far.json
nsd-fit --quiet far.json >far.out 2>&1 || true
like "targets out of reach" "$(cat far.out)" 'no parameters in their ranges reach the targets'

# ---- the same table: after kills, for other numbers of processes ----

nsd-fit --quiet -j 1 -n 34 -o once known.json >once.out 2>&1 || true
killed_at() # LINES: a run that is killed as soon as its table has so many
{
    nsd-fit --quiet -j 3 -n 34 -o killed known.json >/dev/null 2>&1 &
    local pid=$!
    until { [ -e killed/table.tsv ] && [ "$(wc -l <killed/table.tsv)" -ge "$1" ]; } || ! kill -0 $pid 2>/dev/null; do sleep 0.02; done
    kill -KILL $pid 2>/dev/null || true
    wait $pid 2>/dev/null || true
}
for lines in 3 9 20; do killed_at $lines; done
ok "runs are killed before they end" [ "$(wc -l <killed/table.tsv)" -lt 34 ]
printf '7\t' >>killed/table.tsv # a line that was being written
nsd-fit --quiet -j 2 -n 34 -o killed known.json >killed.out 2>&1 || true
ok "after kills" cmp once/table.tsv killed/table.tsv
ok "and the same values" cmp once.out killed.out
sed -i 's/^5\t/6\t/' killed/table.tsv
refuses 65 "a damaged table" nsd-fit known.json -o killed
refuses 65 "a table of another problem" nsd-fit ridge.json -o once

# -n ends a run earlier, also within a batch; the same points come when it is continued, and none is lost
problem 0.5 0.9 3 >stops.json
nsd-fit --quiet -n 29 stops.json >/dev/null 2>&1 || true
cp stops.fit/table.tsv stops.29
for n in 9 25 29; do nsd-fit --quiet -n $n -o parts stops.json >/dev/null 2>&1 || true; done
ok "-n 9, 25 and 29 make the table of -n 29" cmp stops.29 parts/table.tsv
nsd-fit --quiet -n 9 -o parts stops.json >/dev/null 2>&1 || true
ok "a smaller -n removes no evaluation" cmp stops.29 parts/table.tsv

# ---- a real pipeline: the way of a sliding ball over the plane tells the friction ----

cat >slide.json <<'EOF'
{ "scene": { "dim": 2, "dt": 1e-3, "mu": 0.3, "seed": 1, "walls": [{ "point": [0, 0], "normal": [0, 1] }],
             "bodies": [{ "x": [0, 0.01], "radius": 0.01, "v": [1, 0] }] },
  "parameters": { "mu": { "keys": "mu", "range": [0.05, 0.6] } },
  "command": "nsd-gen - | nsd-step -n 50 -j 1 --overlap-rule keep | nsd-cat --last | nsd-info --particles - | jq -s '{v: .[-1].v[0]}'",
  "targets": { "v": { "value": 0.901855, "error": 1e-3 } } }
EOF
nsd-fit --quiet slide.json >slide.out 2>&1 || true # v = 1 - mu g t: 0.2
ok "the friction of a sliding disc" jq -e '.parameters.mu | (.value - 0.2 | fabs) < 0.003 and .interval90[0] <= 0.2001 and .interval90[1] >= 0.1999' slide.fit/result.json

# ---- what cannot be done ----

mkdir -p without/numpy
echo 'raise ImportError("no numpy here")' >without/numpy/__init__.py
export PYTHONPATH=$tmp/without
refuses 69 "without numpy" nsd-fit known.json
ok "completions and --help need none" eval 'nsd-fit --completion zsh && nsd-fit --help'
unset PYTHONPATH

edit() { jq "$1" known.json >bad.json; }
bad() { local name=$1 status=$2; edit "$3"; rm -rf bad.fit; refuses "$status" "$name" nsd-fit --quiet bad.json; }
bad "a command that fails" 1 '.command = "echo broken >&2; exit 3"'
like "with the reason" "$(cat err)" 'status 3: broken'
bad "an answer that is no object" 1 '.command = "echo 3"'
bad "an answer that is infinite" 1 '.command = "echo \"{\\\"p\\\": 1e999, \\\"q\\\": 1}\""'
bad "a path that the scene lacks" 65 '.parameters.a.keys = "walls[0].mu"'
bad "an empty range" 65 '.parameters.a.range = [1, 1]'
bad "a logarithm of 0" 65 '.parameters.a.log = true'
bad "an unknown key" 65 '.targts = 1'
bad "no targets" 65 '.targets = {}'
bad "an error of 0" 65 '.targets.p.error = 0'
bad "a name twice" 65 '.targets.a = .targets.p'
refuses 66 "no file" nsd-fit missing.json
refuses 64 "no option" nsd-fit --nonsense known.json
refuses 64 "no jobs" nsd-fit -j 0 known.json
late() { jq '.command = "sleep 9"' known.json >late.json && status 1 "an evaluation that takes too long" nsd-fit --timeout 0.2 -n 4 late.json; }
late
done_testing
