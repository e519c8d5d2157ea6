#!/usr/bin/env bash
# Groups and kinds of bodies by name in nsd-stat, nsd-export and nsd-view: what is measured, exported and drawn is what
# nsd-info -p lists of them, summed by jq.
# shellcheck source=tests/support/tap.sh disable=SC2016 # eval
. tests/support/tap.sh

# A heap of two groups, one of steel, on a floor, and a pour with a name; its frames come and go
jq -n '{ dim: 2, dt: 5e-4, mu: 0.4, seed: 4, materials: { steel: { density: 7800 } },
    walls: [{ segment: [[-0.06, 0], [0.06, 0]], name: "floor" }, { segment: [[-0.06, 0.5], [-0.06, 0]], name: "side" },
            { segment: [[0.06, 0], [0.06, 0.5]], name: "side" }],
    bodies: [{ count: 60, radius: { uniform: [3e-3, 4e-3] }, box: { x: [-0.06, 0.06], y: [0, null] }, name: "charge" },
             { x: [0, 0.15], radius: 0.01, material: "steel", name: "intruder", v: [0, -1] }],
    pour: [{ rate: 100, radius: 3e-3, opening: { box: { x: [-0.03, 0.03], y: [0.2, 0.25] } }, v: [0, -1], name: "rain", until: 0.2 }],
    remove: [{ name: "rain", below: { point: [0, 0.06], normal: [0, 1] } }] }' >"$tmp/scene.json"
nsd-gen "$tmp/scene.json" >"$tmp/start.h5"
nsd-step --until 0.3 --every 0.05s --contacts -o "$tmp/run.h5" "$tmp/start.h5" 2>/dev/null
stat() { nsd-stat "$@" 2>/dev/null; }
near() { jq -ne --argjson a "$1" --argjson b "$2" '(($a - $b) | fabs) <= 1e-12 * (1 + ($b | fabs))'; }
bodies() { nsd-info --last -p --only "$1" "$tmp/run.h5" | jq -s 'map(select(.id != null))'; }

for name in charge intruder steel ball charge,intruder; do
    bodies "$name" >"$tmp/list"
    stat -l -m coordination,temperature,energy,fraction --only "$name" "$tmp/run.h5" >"$tmp/measured"
    got() { jq "$1" "$tmp/measured"; }
    is "$name: bodies" "$(got .temperature.bodies)" "$(jq length "$tmp/list")"
    ok "$name: kinetic energy" near "$(got .energy.kinetic)" "$(jq 'map(0.5 * .mass * (.v[0] * .v[0] + .v[1] * .v[1])) | add' "$tmp/list")"
    ok "$name: mean velocity" near "$(got .temperature.velocity[1])" "$(jq '(map(.mass * .v[1]) | add) / (map(.mass) | add)' "$tmp/list")"
    ok "$name: solid area" near "$(got .fraction.solid)" "$(jq 'map(3.141592653589793 * .radius * .radius) | add' "$tmp/list")"
    nsd-info --last -c "$tmp/run.h5" | jq -s --slurpfile list "$tmp/list" --slurpfile all <(nsd-info --last -p "$tmp/run.h5" | jq -s 'map(select(.id != null))') '
        ($list[0] | map(.id)) as $ids | ($all[0] | map(.id)) as $id |
        map(select(.r and .r[0] != 0) | .body | map(if . < 0 then . else $id[.] end)) |
        [(map(map(select(. as $b | $ids | index($b) != null)) | length) | add) / ($ids | length),
         (map(select(any(.[]; . as $b | $ids | index($b) != null))) | length)]' >"$tmp/z"
    ok "$name: contacts of a body" near "$(got .coordination.z)" "$(jq '.[0]' "$tmp/z")"
    is "$name: contacts" "$(got .coordination.contacts)" "$(jq '.[1]' "$tmp/z")"
    is "$name: each body" "$(stat -l -m grains --only "$name" "$tmp/run.h5" | jq -c .grains.id)" "$(jq -c 'map(.id)' "$tmp/list")"
    for to in csv xyz lammps; do
        is "$name: nsd-export --to $to" "$(nsd-export -l --to $to --only "$name" "$tmp/run.h5" | case $to in
            csv) tail -n +2 | cut -d, -f6 ;; xyz) tail -n +3 ;; *) sed '1,/ITEM: ATOMS/d' ;;
        esac | wc -l)" "$(jq length "$tmp/list")"
    done
    is "$name: exported contacts" "$(nsd-export -l --to csv --part contacts --only "$name" "$tmp/run.h5" | tail -n +2 | wc -l)" \
        "$(nsd-info --last -c --only "$name" "$tmp/run.h5" | jq -s 'map(select(.body)) | length')"
done
is "an exported body keeps the force of all its contacts" \
    "$(nsd-export -l --to csv --only intruder "$tmp/run.h5" | tail -1)" "$(nsd-export -l --to csv "$tmp/run.h5" | awk -F, '$6 == 60')"
is "groups sum up to all" "$(stat -m energy --only charge,intruder,rain "$tmp/run.h5" | jq -s 'map(.energy.kinetic)')" \
    "$(stat -m energy "$tmp/run.h5" | jq -s 'map(.energy.kinetic)')"
is "flux of a group: those that are poured and removed" \
    "$(stat -m flux --plane 0,-1,0 --point 0,0.06,0 --only rain "$tmp/start.h5" "$tmp/run.h5" | jq -s 'map(.flux.forth // 0) | add')" \
    "$(nsd-info --events "$tmp/run.h5" | jq -s 'map(select(.event == "removed")) | length')"
is "and of the others: the intruder, and no one of the charge" \
    "$(stat -m flux --plane 0,-1,0 --point 0,0.1,0 --only charge,intruder "$tmp/start.h5" "$tmp/run.h5" | jq -s 'map(.flux.forth // 0) | add')" 1
ok "displacement of a group" near "$(stat -m displacement --only intruder "$tmp/run.h5" | jq -s '.[-1].displacement.drift[1]')" \
    "$(nsd-info -p --only intruder "$tmp/run.h5" | jq -s 'map(select(.x)) | .[-1].x[1] - .[0].x[1]')"
is "residence of a group" "$(stat -m residence --only rain "$tmp/run.h5" | jq -s 'map(.residence.left // 0) | add')" \
    "$(nsd-info --events "$tmp/run.h5" | jq -s 'map(select(.event == "removed" and .step > 100)) | length')"
is "walls leave measures of bodies alone" "$(stat -l -m coordination,boundaries --only side "$tmp/run.h5" | jq -c '[.coordination, .boundaries.boundary]')" \
    "$(stat -l -m coordination "$tmp/run.h5" | jq -c '[.coordination, [1, 2]]')"
is "names of bodies leave measures of walls alone" "$(stat -l -m temperature,boundaries --only charge "$tmp/run.h5" | jq -c .boundaries)" \
    "$(stat -l -m boundaries "$tmp/run.h5" | jq -c .boundaries)"

for m in stress fabric friction normal_forces tangential_forces mobilised surface strain mixing lifetimes separations; do
    refuses 65 "$m of a group" nsd-stat -m "$m" --only charge "$tmp/run.h5"
    like "says why" "$(cat "$tmp/err")" "$m is measured of all bodies"
done
refuses 65 "walls, and no measure of walls" nsd-stat -m coordination --only floor "$tmp/run.h5"
refuses 65 "bodies, and no measure of bodies" nsd-stat -m boundaries --only charge "$tmp/run.h5"
refuses 65 "fields of a group" nsd-stat -m fraction --only charge -f "$tmp/f.h5" "$tmp/run.h5"
refuses 65 "grains by the name of a wall" nsd-export -l --to csv --only floor "$tmp/run.h5"
refuses 65 "boundaries by the name of a group" nsd-export -l --to csv --part walls --only charge "$tmp/run.h5"
refuses 64 "the cell by a name" nsd-export -l --to csv --part cell --only charge "$tmp/run.h5"
refuses 65 "bodies drawn by the name of a wall" nsd-view --only floor "$tmp/run.h5"
refuses 65 "or by none" nsd-view --only lid "$tmp/run.h5"

# ---- pictures and trajectories ----

nsd-gen - <<<"$(jq '.bodies |= .[1:] | del(.pour, .remove)' "$tmp/scene.json")" >"$tmp/alone.h5"
jq '.bodies[0].count = 20 | .bodies[1].x = [0, 0.05] | .bodies[0].box.y = [0.1, null] | del(.pour, .remove)' "$tmp/scene.json" | nsd-gen - >"$tmp/both.h5"
box=-0.06,0.06,0,0.12
nsd-gen - <<<"$(jq '.bodies |= .[1:] | .bodies[0].x = [0, 0.05] | del(.pour, .remove)' "$tmp/scene.json")" >"$tmp/alone.h5"
for file in alone both; do nsd-view -c material --box $box --only intruder -o "$tmp/$file.png" "$tmp/$file.h5" 2>/dev/null; done
ok "a picture of a group is that of a packing without the others" cmp "$tmp/alone.png" "$tmp/both.png"
nsd-view -c material --box $box -o "$tmp/all.png" "$tmp/both.h5" 2>/dev/null
nsd-view -c material --only charge -o "$tmp/charge.svg" --svg "$tmp/both.h5" 2>/dev/null
ok "one of all is another" eval '! cmp -s "$tmp/alone.png" "$tmp/all.png"'
is "triangles of STL: of the bodies that are chosen, and of walls that are named" \
    "$(nsd-export -l --to stl --only intruder "$tmp/run.h5" | od -An -tu4 -j80 -N4 | tr -d ' ')" \
    "$(nsd-export -l --to stl --only intruder,floor "$tmp/run.h5" | od -An -tu4 -j80 -N4 | tr -d ' ')"
mkdir "$tmp/dir"
nsd-export -l --only charge -o "$tmp/dir/" "$tmp/run.h5"
ok "a directory has boundaries and contacts, too" test -s "$tmp/dir/walls-00000.vtp" -a -s "$tmp/dir/contacts-00000.vtp"
nsd-export --only rain -o "$tmp/rain.gsd" "$tmp/run.h5"
ok "a trajectory of a group that comes and goes" test -s "$tmp/rain.gsd"
done_testing
