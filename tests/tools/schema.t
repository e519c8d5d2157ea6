#!/usr/bin/env bash
# nsd-gen --schema: valid JSON Schema, which accepts the scenes of the repository, and refuses what nsd-gen refuses for its keys,
# types and ranges, and nothing else.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

refuses 64 "--schema takes no scene" nsd-gen --schema scenes/drum.json
refuses 64 "--schema and --keys are two" nsd-gen --schema --keys
nsd-gen --schema >"$tmp/schema.json"
nsd-gen --keys >"$tmp/keys.tsv"
ok "--schema is one JSON object" jq -e 'type == "object"' "$tmp/schema.json"
is "--keys has seven fields in each line" "$(awk -F '\t' '{ print NF }' "$tmp/keys.tsv" | sort -u)" 7
is "and no key twice in a table" "$(cut -f 1,2 "$tmp/keys.tsv" | sort | uniq -d)" ""
is "all keys of the tables are in the schema" "$(awk -F '\t' 'NR > 1 && $1 != "law" && $1 != "group" { print $1 "." $2 }' "$tmp/keys.tsv" | sort -u)" \
    "$(jq -r '."$defs" | to_entries[] | (.key | sub("-[23]d$"; "")) as $t | .value.properties // {} | keys[] | "\($t).\(.)"' "$tmp/schema.json" | grep -v '\.comment$' |
        sort -u | join - <(awk -F '\t' 'NR > 1 && $1 != "law" && $1 != "group" { print $1 "." $2 }' "$tmp/keys.tsv" | sort -u))"

if ! has jsonschema; then
    skip "the schema, judged by jsonschema" "no python3-jsonschema"
    done_testing
    exit
fi

# All scenes, among them those that others have written into scripts and manuals
git ls-files -co --exclude-standard '*.json' 2>/dev/null >"$tmp/files" || find . -name '*.json' -not -path './build/*' >"$tmp/files"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >"$tmp/stone.obj"
nsd-gen 4 >"$tmp/four.h5"

# Each value of three scenes in turn is replaced, by nsd-gen's judgement and by the schema's.
cat >"$tmp/judge.py" <<'PYTHON'
import json, os, re, subprocess, sys
from jsonschema import Draft202012Validator

tmp, step = sys.argv[1], int(sys.argv[2])
schema = json.load(open(tmp + "/schema.json"))
Draft202012Validator.check_schema(schema)
judge = Draft202012Validator(schema)

def verdict(good, name, trouble):
    print("ok" if good else "no", name, trouble, sep="\t")

verdict(True, "the schema is valid by the draft 2020-12 metaschema", "")
number, refused = 0, ""
for name in open(tmp + "/files").read().split("\n"):
    try:
        scene = json.load(open(name))
    except (OSError, ValueError):
        continue
    if not isinstance(scene, dict) or "dt" not in scene: continue
    number += 1
    if not judge.is_valid(scene): refused += " " + name
verdict(number >= 60 and not refused, "the schema accepts all %d scenes of the repository" % number, refused)

space = {
    "title": "all", "dim": 3, "dt": 1e-3, "theta": 0.5, "gravity": [0, 0, -9.81], "time": 0, "seed": 3, "density": 2500,
    "mu": 0.3, "mu_s": 0.4, "v_s": 1e-3, "e_n": 0.1, "e_t": 0, "impact": "newton", "allow_overlap": True,
    "cohesion": {"force": 1e-3, "range": 0}, "capillary": {"volume": 1e-10, "tension": 0.07, "wetting": 0.2},
    "rolling": {"mu_r": 1e-4, "mu_p": 0}, "materials": {"steel": {"density": 7800}},
    "adhesion": {"c_n": 1e9, "c_t": 1e9, "w": 0.1, "eta": 0, "area": 1e-6, "beta": 1, "made": 0},
    "pairs": [{"pair": ["ball", "steel"], "mu": 0.2, "e_n": 0.5, "rolling": {"mu_r": 0}}, {"pair": ["wall", "steel"], "acts": False}],
    "shapes": {"brick": {"box": [1, 1, 1], "round": 0.1}, "pill": {"capsule": {"length": 1, "radius": 1}},
               "pair": {"balls": [[0, 0, 0, 1], [1, 0, 0, 1]]}, "hull": {"points": [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, 0, 1]]},
               "prism": {"regular": {"sides": 5, "radius": 1, "height": 1}},
               "egg": {"superquadric": {"radii": [2, 1, 1], "exponents": [2, 2], "segments": 2}},
               "tetrahedron": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "faces": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]},
               "stone": {"mesh": {"file": "stone.obj", "scale": 0.1, "hull": False}}},
    "walls": [{"point": [0, 0, -2], "normal": [0, 0, 1], "name": "floor", "material": "steel", "weld": 1e-6, "wear": 0, "until": 9,
               "load": {"along": [0, 0, 1], "mass": 2, "force": {"amplitude": 1, "frequency": 2, "phase": 0, "mean": 3}, "speed": 0, "travel": 0}},
              {"box": {"x": [-20, 20], "y": [-20, 20], "z": [-1, None]}, "name": "box", "velocity": [0, 0, 0]},
              {"rectangle": {"center": [0, 0, 0], "normal": [0, 0, 1], "along": [1, 0, 0], "sides": [1, 2]}, "belt": [1, 0, 0]},
              {"disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 2, "hole": 1},
               "drives": [{"along": [0, 0, 1], "speed": 1, "from": 0.1, "until": 0.2},
                          {"about": [0, 0, 0], "axis": [0, 0, 1], "amplitude": 0.1, "frequency": 2, "phase": 1, "from": 0, "since_from": True},
                          {"along": [1, 0, 0], "table": [[0, 1], [1, 2]]}]},
              {"cylinder": {"point": [0, 0, 0], "axis": [0, 0, 1], "radius": 9, "length": 9, "side": "inside", "along": [1, 0, 0], "arc": 3},
               "load": {"about": [0, 0, 0], "axis": [0, 0, 1], "mass": 2, "torque": 1}},
              {"cone": {"point": [0, 0, 0], "axis": [0, 0, 1], "radii": [8, 9], "length": 9, "side": "both"}},
              {"sphere": {"center": [0, 0, 0], "radius": 30, "side": "outside"}},
              {"mesh": {"file": "stone.obj", "scale": 2, "at": [0, 0, 0], "parts": [{"name": "tip", "faces": [0, 1]}]},
               "materials": [{"faces": [0, 1], "material": "steel", "belt": [0, 0, 0]}]}],
    "servo": {"walls": ["box"], "pressure": 1, "strain_rate": [0, 0, 0], "center": [0, 0, 0], "mass": 1, "growth": 0},
    "bodies": [{"x": [0, 0, 0], "radius": 1, "v": [0, 0, 0], "w": [0, 0, 0], "material": "steel", "density": 3, "fixed": True, "name": "one"},
               {"x": [9, 0, 0], "size": 1, "shape": "brick", "orientation": [0, 0, 1], "mass": 1},
               {"count": 3, "radius": {"uniform": [0.1, 0.2]}, "box": {"x": [0, 9], "y": [0, 9], "z": [0, None]}, "cells": "own",
                "spacing": 1.1, "jitter": 0.5, "thermal": 0.1},
               {"random": {"phi": 0.01}, "box": {"x": [0, 9], "y": [0, 9], "z": [0, 9]}, "thermal": 0, "shape": "pill", "orientation": "random",
                "radius": {"gaussian": {"mean": 1, "sd": 0.1, "min": 0.9, "max": 1.1}}},
               {"random": {"count": 1}, "box": {"x": [0, 9], "y": [0, 9], "z": [0, 9]}, "radius": {"sieve": [[0.1, 0], [0.2, 0.5], [0.3, 1]]}},
               {"document": "four.h5", "frame": -1, "at_rest": True}, {"file": "balls"},
               {"import": "balls.data", "frame": 0, "at_rest": True, "types": {"1": "ball"}, "repeats": [True, True, False]}],
    "pour": [{"rate": 9, "radius": {"power": {"exponent": 3, "min": 0.1, "max": 0.2}}, "v": [0, 0, 0], "w": [0, 0, 0], "material": "steel",
              "opening": {"disc": {"center": [0, 0, 8], "normal": [0, 0, 1], "radius": 3}}, "from": 0, "until": 1, "count": 9,
              "poured": {"bodies": 0, "mass": 0}, "name": "new"},
             {"mass_rate": 9, "radius": {"lognormal": {"median": 1, "sigma": 0.1, "min": 0.9, "max": 1.1}},
              "opening": {"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1]}}}],
    "remove": [{"outside": {"x": [-9, 9]}, "material": "steel", "id": [1, 2], "from": 0, "until": 1, "removed": {"bodies": 0, "mass": 0}},
               {"below": {"point": [0, 0, -9], "normal": [0, 0, 1]}, "name": "one"}],
    "forces": [{"bodies": [0], "along": [0, 0, 1], "force": 1, "from": 0, "until": 1}, {"bodies": [0], "about": [0, 0, 1], "torque": {"table": [[0, 1]]}}]}
plane = {
    "dim": 2, "dt": "auto", "gravity": [0, -9.81], "shapes": {"tile": {"polygon": [[0, 0], [1, 0], [0, 1]]}, "brick": {"box": [1, 1]},
        "egg": {"superquadric": {"radii": [1, 2], "exponents": [2]}}, "pair": {"balls": [[0, 0, 1], [1, 0, 1]]},
        "hexagon": {"regular": {"sides": 6, "radius": 1}}},
    "walls": [{"point": [0, -9], "normal": [0, 1], "load": {"pressure": 1, "mass": 1}}, {"box": {"x": [-20, 20], "y": [-20, None]}},
              {"segment": [[-9, -5], [9, -5]], "drives": [{"about": [0, 0], "speed": 0.1}]},
              {"circle": {"center": [0, 0], "radius": 40, "side": "inside"}, "load": {"about": [0, 0], "mass": 2, "torque": 1}},
              {"arc": {"center": [0, 0], "radius": 30, "along": [1, 0], "arc": 1, "side": "both"}},
              {"polygon": {"points": [[20, 0], [21, 0], [21, 1]], "closed": True}}],
    "bodies": [{"x": [0, 0], "radius": 1, "v": [0, 1], "w": 2}, {"x": [5, 0], "shape": "tile", "orientation": 1},
               {"count": 2, "radius": {"uniform_by_mass": [0.1, 0.2]}, "box": {"x": [0, 9], "y": [0, 9]}}],
    "pour": [{"rate": 1, "radius": 0.1, "w": 1, "opening": {"disc": {"center": [0, 8], "normal": [0, 1], "radius": 3}}}],
    "remove": [{"inside": {"x": [1, 2]}, "id": 3}], "forces": [{"bodies": [0], "torque": 1}]}
cell = {
    "dt": 1e-3, "cell": {"edges": [[9, 0, 0], [1, 9, 0], [0, 0, 9]], "origin": [0, 0, 0], "repeats": [True, True, True],
        "gradient": [{"t": 0, "L": [[0, 0, 0], [0, 0, 0], [0, 0, 0]]}], "affine": True,
        "stress": {"target": [[1, None, None], [None, 2, None], [None, None, None]], "factor": [[0, 1], [1, 2]], "mass": 1}}}

# nsd-gen's reasons that a schema sees, and those that follow from several values, or from names
seen = re.compile("unknown key|is missing|needs |must be positive|must not be negative|must lie in|must be at least|must not be zero|"
                  "goes with|does not go with|is given too|is no choice|only a |must be below 2 pi|must be less than pi/2|types are whole")
unseen = re.compile("no material|no wall|no shape|a name|the name|needs a box|needs [0-9]+ to |needs \\[min|needs .walls|closed box|needs a height|"
                    "must be below|needs two points|needs two kinds|names of walls|needs the name|two adjacent|only a servo with .* grows|"
                    "stress-controlled and needs a mass|only a plane|cell: needs one of|drives.*from: is missing|box: is missing")
def gen(scene):
    p = subprocess.run(["nsd-gen", "-"], input=json.dumps(scene).encode(), capture_output=True, cwd=tmp)
    said = p.stderr.decode().strip().split("\n")[0]
    place = re.match("nsd-gen: standard input:[0-9]+:[0-9]+: (.*)", said)
    return place.group(1) if p.returncode == 65 and place else ""

# Of a list of plain values the last is changed, and each value to an unknown object and to two of the others by turns. Each
# second change is judged; NSD_DEEP=1: all, and to all values.
others = ["no such word", None, -1, True, 0, 0.5, 1e30, [], [1, 2]]
tried = both = 0
apart = {"refused by the schema alone": [], "refused by nsd-gen alone": []}

def judge_one(scene, what):
    global tried, both
    tried += 1
    if tried % step: return
    said, valid = gen(scene), judge.is_valid(scene)
    both += bool(said) and not valid
    if not said and not valid: apart["refused by the schema alone"].append(what)
    if valid and said and seen.search(said) and not unseen.search(said):
        apart["refused by nsd-gen alone"].append(what + ": " + said)

def turn(scene, at, k, path):
    was, few = at[k], len(path) + tried
    path = "%s.%s" % (path, k)
    for other in [{"no such key": 1}] + (others if step == 1 else [others[few % 9], others[few * 4 % 9]]):
        at[k] = other
        judge_one(scene, "%s = %s" % (path, json.dumps(other)))
    at[k] = was
    if isinstance(was, list):
        plain = was and not isinstance(was[0], (dict, list))
        for i in range(len(was) - 1 if plain else 0, len(was)): turn(scene, was, i, path)
    if isinstance(was, dict):
        for key in list(was): turn(scene, was, key, path)
        for key in list(was):
            kept = was.pop(key)
            judge_one(scene, "%s without %s" % (path, key))
            was[key] = kept

# A scene of one item of one key, and of what that needs; smaller scenes are judged sooner
def parts(scene):
    for key, value in scene.items():
        small = {k: scene[k] for k in ("dt", "dim", "kinds") if k in scene}
        if key in ("bodies", "pour"): small["shapes"] = {k: scene["shapes"][k] for k in ("brick", "pill", "tile") if k in scene["shapes"]}
        if key == "servo": small["walls"] = [scene["walls"][1]]
        if key == "mu_s": small["v_s"] = scene["v_s"]
        if key == "v_s": small["mu_s"] = scene["mu_s"]
        items = [[x] for x in value] if isinstance(value, list) and isinstance(value[0], dict) else \
            [{k: x} for k, x in value.items()] if key in ("shapes", "kinds") else [value]
        for item in items: yield key, {**small, key: item}

for name, scene in ("space", space), ("plane", plane), ("cell", cell):
    errors = [e.message for e in judge.iter_errors(scene)]
    verdict(not errors and not gen(scene), "the scene of all keys is accepted by both (%s)" % name, gen(scene) + str(errors[:1])[:300])
    for key, small in parts(scene): turn(small, small, key, name)
for what, list_of in apart.items():
    verdict(not list_of and both > 0.7 * tried / step, "of %d changed scenes none is %s (%d are refused by both)" % (tried / step, what, both), "; ".join(list_of[:12]))
PYTHON
step=2
[ -z "$thin" ] || step=11
[ -z "${NSD_DEEP-}" ] || step=1
/usr/bin/python3 "$tmp/judge.py" "$tmp" "$step" >"$tmp/verdicts"
while IFS=$'\t' read -r good name trouble; do
    [ "$good" = ok ] || diag "$trouble"
    is "$name" "$good" ok
done <"$tmp/verdicts"

done_testing
