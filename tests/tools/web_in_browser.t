#!/usr/bin/env bash
# nsd-web's page in a browser: it plays, a click reads the right grain, nothing is asked of a network.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

if ! command -v chromium >/dev/null || ! /usr/bin/python3 -c 'import selenium' 2>/dev/null; then
    echo "1..0 # SKIP no chromium, or no selenium"
    exit 0
fi

stock run60 >"$tmp/out.h5"
nsd-web -o "$tmp/out.html" "$tmp/out.h5" 2>/dev/null
printf '{"dt": 1e-3, "shapes": {"cube": {"box": [0.1, 0.1, 0.1]}, "pill": {"capsule": {"length": 0.1, "radius": 0.05}}}, "gravity": [0, 0, 0],
    "bodies": [{"x": [0, 0, 0], "shape": "cube", "w": [0, 0, 100]}, {"x": [0.5, 0, 0.3], "radius": 0.1}, {"x": [0.2, 0.4, 0], "shape": "pill"}]}' |
    nsd-gen - | nsd-step -n 3 >"$tmp/shapes.h5" 2>/dev/null
nsd-web "$tmp/shapes.h5" >"$tmp/shapes.html" 2>/dev/null

browse() { timeout 300 /usr/bin/python3 tests/support/web.py "$1" "$tmp/shot.png" >"$tmp/seen" 2>"$tmp/why" || { cat "$tmp/why"; return 1; }; }
seen() { jq -r "$1" "$tmp/seen"; }
plays() # FILE NAME SOLVED
{
    ok "$2: a browser shows it" browse "$1"
    [ -s "$tmp/seen" ] || return 0
    is "$2: no error on the console, no trouble said" "$(seen '(.console | length | tostring) + .trouble')" 0
    is "$2: nothing is asked of a network" "$(seen '.requests | length')" 0
    is "$2: frames change, and come back" "$(seen '[.changes, .back, .plays] | tojson')" '[true,true,true]'
    is "$2: a click reads the grain under it" "$(seen '.chosen == .id and .row >= 0')" true
    is "$2: the network is there where forces are, and is seen" "$(seen '.solved, .network // false' | paste -sd' ')" "$3 $3"
    row=$(seen .row)
    truth=$(nsd-info --last -p "$4" | sed -n "$((row + 1))p")
    is "$2: its numbers are the document's" "$(seen ".id == ($truth | .id) and
        ([.position, ($truth | .x)] | transpose | all((.[0] - .[1] | fabs) < 1e-6))
        and (.text | contains(\"radius\"))")" true
}
plays "$tmp/out.html" "balls" true "$tmp/out.h5"

if [ -z "$thin" ]; then
    nsd-gen -d 2 50 | nsd-step -n 40 --every 4 >"$tmp/discs.h5" 2>/dev/null
    nsd-web "$tmp/discs.h5" >"$tmp/discs.html" 2>/dev/null
    plays "$tmp/discs.html" "discs, without contacts" false "$tmp/discs.h5"

    plays "$tmp/shapes.html" "a cube, a ball and a pill" false "$tmp/shapes.h5"
    printf '{"dim": 2, "dt": 1e-3, "gravity": [0, 0], "shapes": {"tile": {"box": [0.2, 0.1]}},
        "bodies": [{"x": [0, 0], "shape": "tile", "orientation": 0.3}, {"x": [0.3, 0.1], "shape": "tile"}]}' |
        nsd-gen - | nsd-step -n 1 >"$tmp/tiles.h5" 2>/dev/null
    nsd-web "$tmp/tiles.h5" >"$tmp/tiles.html" 2>/dev/null
    ok "tiles: a browser shows them" browse "$tmp/tiles.html"
    # 2 a b of pi (a^2 + b^2)/4 with a = 2 b
    is "a click finds a tile, and a tile is coloured, in 0.51 of the disc around it" \
        "$(seen '.part | length == 2 and all(. > 0.49 and . < 0.53)')" true

    # a cell that repeats: two discs meet across its border, one of them cuts a corner
    printf '{"dim": 2, "dt": 1e-3, "density": 2500, "mu": 0, "gravity": [0, 0],
        "cell": {"lengths": [1, 1]}, "bodies": [{"radius": 0.1, "x": [0.02, 0.03]}, {"radius": 0.1, "x": [0.81, 0.03], "v": [1, 0.5]}]}' |
        nsd-gen - | nsd-step -n 11 --contacts >"$tmp/cell.h5" 2>/dev/null
    nsd-web "$tmp/cell.h5" >"$tmp/cell.html" 2>/dev/null
    plays "$tmp/cell.html" "a cell that repeats" true "$tmp/cell.h5"
    is "grains are drawn on either side of its border: 4 and 2 images" "$(seen '.images | tojson')" '[0,0,0,0,1,1]'
fi
done_testing
