#!/usr/bin/env bash
# import nsd: names of kinds, shapes, walls and groups, and corners, of documents and of runs.
. tests/support/tap.sh

if ! /usr/bin/python3 -c 'import numpy' 2>/dev/null; then echo "1..0 # SKIP no numpy"; exit; fi
export PYTHONPATH=$PWD/python NSD_LIBRARY=${NSD_LIBRARY-$PWD/build/libnsd.so.2}

jq -n '{ dt: 1e-3, gravity: [0, 0, 0], materials: { steel: {} }, shapes: { cube: { box: [0.2, 0.2, 0.2] } },
    walls: [{ point: [0, 0, -1], normal: [0, 0, 1], name: "floor" }, { point: [-1, 0, 0], normal: [1, 0, 0], name: "side" },
            { point: [1, 0, 0], normal: [-1, 0, 0], name: "side" }, { point: [0, 0, 1], normal: [0, 0, -1] }],
    bodies: [{ x: [0, 0, 0], shape: "cube", size: 1, material: "steel", orientation: [0, 0, 0.785398163397448], name: "first" },
             { x: [0.5, 0, 0], radius: 0.1 }] }' >"$tmp/scene.json"
nsd-gen "$tmp/scene.json" >"$tmp/a.h5"

document()
{
    /usr/bin/python3 - "$tmp/a.h5" <<'END'
import sys
import numpy as np
import nsd
f = nsd.last(sys.argv[1])
assert [f.material_names[k] for k in f.material] == ["steel", "ball"], f.material_names
assert [f.shape_names[k] for k in f.shape] == ["cube", "ball"], f.shape_names
assert list(f.group) == ["first", None], f.group
assert f.wall_names == ["floor", "side", "side", None], f.wall_names
assert f.walls("side") == [1, 2] and f.walls(3) == [3]
try:
    f.walls("lid")
    assert False
except KeyError as e:
    assert "floor, side" in str(e)
try:
    f.walls(4)
    assert False
except KeyError as e:
    assert "no wall 4, but 4 walls" in str(e)
# a cube turned by 45 degrees about z: corners at 0.1 sqrt(2) along the axes, 0.1 up and down
c = f.corners(0)
r = 0.1 * 2 ** 0.5
want = np.array([[s * r if k == j else 0 for j in range(2)] + [z] for k in range(2) for s in (-1, 1) for z in (-0.1, 0.1)])
assert c.shape == (8, 3) and all(np.abs(c - w).max(axis=1).min() < 1e-9 for w in want), c
assert f.corners(1).shape == (0, 3)
END
}
ok "a document's names and corners" document
run()
{
    /usr/bin/python3 - "$tmp/scene.json" <<'END'
import sys
import nsd
with nsd.Run.from_scene(sys.argv[1]) as run:
    steel = ["ball", "wall", "steel"]
    assert run.names == {"materials": steel, "kinds": steel, "shapes": ["ball", "cube"],
                         "walls": ["floor", "side", "side", None], "groups": ["first"], "named": {"floor": [0], "side": [1, 2]}}, run.names
    run.move_wall("side", [0, 0, 0.25])
    assert [list(v) for v in run.wall_velocity] == [[0, 0, 0], [0, 0, 0.25], [0, 0, 0.25], [0, 0, 0]]
    run.set(only="side", contacts=True)
    run.step(2)
    assert run.measure("boundaries")["boundaries"]["boundary"] == [1, 2]
    for key, name, heard in ("only", "lid", "only: no 'lid' here, but floor, side"), ("tracer", "gravel", "tracer: no material 'gravel'"):
        run.set(**{key: name, "contacts": False})
        try:
            run.measure("fraction")
            assert False
        except nsd.Error as e:
            assert str(e).startswith(heard), e
        run.set(**{key: "side" if key == "only" else "steel"})
    try:
        run.move_wall("lid", [0, 0, 1])
        assert False
    except ValueError as e:
        assert "floor, side" in str(e)
END
}
if [ -e "$NSD_LIBRARY" ]; then ok "a run's names, and walls by name" run; else skip "a run's names, and walls by name" "no library"; fi

# ---- parts of walls ----

printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 -1 0\nvertex 1 1 0\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 1 0\nvertex -1 1 0\nendloop\nendfacet\nendsolid a\n' >"$tmp/sheet.stl"
jq -n '{ dt: 1e-3, walls: [{ point: [0, 0, -9], normal: [0, 0, 1], name: "floor" },
    { mesh: { file: "sheet.stl", parts: [{ name: "half", faces: [0, 0] }, { name: "floor", faces: [1, 1] }] }, name: "sheet" }],
    bodies: [{ x: [0, 0, 2], radius: 0.1 }] }' >"$tmp/parts.json"
parts()
{
    nsd-gen "$tmp/parts.json" >"$tmp/parts.h5" && /usr/bin/python3 - "$tmp/parts.json" "$tmp/parts.h5" <<'END'
import sys
import nsd
run, frame = nsd.Run.from_scene(sys.argv[1]), nsd.last(sys.argv[2])
for name, want in {"floor": [0, 1], "sheet": [1], "half": [1], 0: [0], 1: [1]}.items():
    assert run.walls(name) == frame.walls(name) == want, (name, run.walls(name), frame.walls(name))
for name in "lid", 2, -1:
    for it in run, frame:
        try:
            it.walls(name)
            assert False, name
        except KeyError as e:
            assert isinstance(e, ValueError) and "no wall" in str(e), e
run.move_wall("floor", [0, 0, 1])
assert [v[2] for v in run.wall_velocity] == [1, 0]
try:
    run.move_wall("half", [0, 0, 1])
    assert False
except ValueError as e:
    assert "part of wall 1" in str(e), e
END
}
if [ -e "$NSD_LIBRARY" ]; then ok "walls by the names of their parts, in runs as in frames" parts; else skip "walls by the names of their parts" "no library"; fi
done_testing
