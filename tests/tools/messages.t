#!/usr/bin/env bash
# Messages: they name the place in the scene and the cure, and move no terminal; streams have one line.
# shellcheck source=tests/support/tap.sh disable=SC2016 # text for jq and eval; options
. tests/support/tap.sh

cd "$tmp"
gen() { echo "$1" | nsd-gen -; }
says() { like "$1" "$(cat err)" "$2"; }

# ---- overlaps ----

walls='"walls": [{"box": {"x": [0, 1], "y": [0, 1], "z": [0, null]}}, {"point": [0, 0, 0.3], "normal": [0, 0, 1]}]'
ball='{"x": [0.5, 0.5, 0.2], "radius": 0.1}' above='{"x": [0.5, 0.5, 0.3], "radius": 0.1}'
refuses 65 "a body in a wall" gen "{\"dt\": 1, $walls, \"bodies\": [$ball]}"
says "has its place in the scene, and the wall's" 'body 0 is 0.2 m deep in wall 5 \(bodies\[0\], walls\[1\]; "allow_overlap": true allows it\)'
refuses 65 "bodies of two groups" gen "{\"dt\": 1, \"bodies\": [$ball, $above]}"
says "have theirs" 'bodies 0 and 1 overlap by 0.1 m \(bodies\[0\], bodies\[1\]; "allow_overlap": true allows it\)'
refuses 65 "a wall that the cell repeats across" gen '{"dt": 1, "cell": {"lengths": [1, 1, 1]}, "bodies": [],
    "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}]}'
says "is named by its place" 'walls\[0\]: wall 0: crosses a periodic edge of the cell'
refuses 65 "a cell of one diameter" gen '{"dt": 1, "cell": {"lengths": [1, 1, 1]}, "bodies": [{"x": [0, 0, 0], "radius": 0.5000001}]}'
says "shows by how much" 'is 1 m wide .* 1.0000002 m'

# ---- random groups ----

random() { gen "{\"dt\": 1, $2 \"bodies\": [$ball, {\"random\": $1, \"radius\": 0.05 $3}]}"; }
box=', "box": {"x": [2, 3], "y": [0, 1], "z": [0, 1]}'
refuses 65 "a group that does not fit" random '{"phi": 0.8}' '' "$box"
says "is named" 'bodies\[1\]: phi 0.8'
refuses 65 "a group of two sizes of which the small find no room" gen '{"dt": 1, "bodies": [{"random": {"count": 1},
    "box": {"x": [0, 1], "y": [0, 1], "z": [0, 1]}, "radius": 0.49}, {"random": {"count": 2},
    "box": {"x": [0, 1], "y": [0, 1], "z": [0, 1.001]}, "radius": 0.5}]}'
says "is named, too" 'bodies\[1\]: '
echo '{"dt": 1, "cell": {"lengths": [1, 1, 2], "origin": [5, 0, 0]}, "bodies": [{"random": {"phi": 0.25}, "radius": 0.1}]}' >cell.json
ok "a random group uses the cell" eval 'nsd-gen cell.json >cell.h5 && nsd-info cell.h5 | jq -e ".bodies > 100" >/dev/null'
ok "and lies in it" eval 'nsd-info -p cell.h5 | jq -s -e "map(select(.x)) | all(.x[0] >= 5 and .x[0] < 6 and .x[2] >= 0 and .x[2] < 2)"'
ok "and fills it across the border" eval 'nsd-info -p cell.h5 | jq -s -e "map(select(.x)) | any(.x[0] < 5.1 or .x[0] > 5.9)"'
gen_fine() { echo "$1" >oblique.json && nsd-gen oblique.json >oblique.h5; }
ok "an oblique one, too" gen_fine '{"dt": 1, "cell": {"edges": [[1, 0, 0], [0.3, 1, 0], [0, 0, 1]]}, "bodies": [{"random": {"phi": 0.3}, "radius": 0.1}]}'

# ---- tables, documents ----

printf '0 0 0.0999998 0.1\n' >table.txt
echo '{"dt": 1e-3, "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}], "bodies": [{"file": "table.txt"}]}' >table.json
ok "a table may be as deep in a wall as a document" nsd-gen table.json
printf '0 0 0.08 0.1\n' >table.txt
refuses 65 "and no deeper" nsd-gen table.json
mkdir sub && nsd-gen 5 >sub/five.h5 && nsd-info --scene sub/five.h5 >sub/five.json
ok "a document that nsd-info --scene names is found from the working folder" nsd-gen sub/five.json
ok "and from the scene's" eval 'jq ".bodies[0].document = \"five.h5\"" sub/five.json >sub/beside.json && nsd-gen sub/beside.json'

# ---- streams ----

nsd-gen 50 | nsd-step -n 450 2>/dev/null | nsd-cat --frames 401: --stream >stream.h5
nsd-detect stream.h5 | nsd-solve 2>said >/dev/null
is "a stream of 50 documents has one line" "$(wc -l <said)" 1
like "with its sums" "$(cat said)" '^nsd-solve: 50 documents, [0-9]+ contacts, [0-9]+ sweeps, largest [a-z]+ [0-9.e-]+, [0-9.e-]+ s$'
nsd-detect stream.h5 | nsd-solve -v 2>said >/dev/null
is "with -v all have" "$(wc -l <said)" 51
nsd-detect stream.h5 | nsd-solve --solver nlgs --max-sweeps 2 2>said >/dev/null
is "those that did not converge have one" "$(grep -c ': NOT CONVERGED to' said)" "$(tail -n 1 said | sed -n 's/.*: \([0-9]*\) NOT CONVERGED$/\1/p')"
status 1 "and the exit status, with -e" eval 'nsd-detect stream.h5 | nsd-solve -e --solver nlgs --max-sweeps 2'

# ---- terminals ----

printf 'id \033[31mred\033[0m\302\233x\303\251\n0 1\n1 2\n' >values.tsv
nsd-gen 6 >six.h5
nsd-view --values values.tsv --bare -o v.png six.h5 2>said
is "no byte of a table's moves the terminal" "$(LC_ALL=C tr -d '\40-\176\303\251\n' <said | wc -c)" 0
like "but letters stay" "$(cat said)" 'red\?\[0m\?\?xé'
: >"$(printf 'no\033file')"
refuses 65 "a file's name" nsd-info "$(printf 'no\033file')"
ok "is plain, too" eval '! grep -q "$(printf "\033")" err'


done_testing
