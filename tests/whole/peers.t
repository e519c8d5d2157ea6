#!/usr/bin/env bash
# make peers: its smallest job by nsd alone, observables of arrangements that are known, and the kept page, which is what
# page.py makes of the kept results.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

# ---- the kept page ----

for kept in docs/peers/*.json; do
    ok "$kept has every job of the table" py - "$kept" <<'PY'
import json, re, sys
jobs = re.findall(r'^    "([a-z0-9-]+)": Job\(', open("bench/peers/jobs.py").read(), re.M)
assert len(jobs) == 7 and set(jobs) <= set(json.load(open(sys.argv[1]))["jobs"])
PY
done
ok "docs/peers/README.md is what page.py makes of the kept results: make peers-keep" \
    cmp docs/peers/README.md <(bench/peers/page.py docs/peers/*.json)

if ! have_h5py; then
    skip "make peers" "no h5py"
    done_testing
    exit
fi

# ---- observables ----

observes() { py - <<'PY'
import sys
sys.path.insert(0, "bench/peers")
import numpy as np
import observe
# balls of 1 in a lattice of 2: pi/6, whatever part of a layer is cut
n = 12
x = np.stack(np.meshgrid(*[np.arange(n) * 2.0 + 1] * 3), -1).reshape(-1, 3)
one = np.ones(len(x))
frame = {"x": x, "v": 0.1 * np.ones_like(x), "radius": one, "mass": 3 * one}
got = observe.bed(frame, {"side": 2.0 * n, "g": 9.81})
low, high = 4.0, 0.8 * n ** 3 * 4 / 3 * np.pi / 0.6 / (2.0 * n) ** 2
layers = np.arange(n) * 2.0 + 1
h = np.linspace(low, high, 200001)
area = sum(np.pi * np.clip(1 - (h - z) ** 2, 0, None) for z in layers)  # of the lattice's sections, by a quadrature
want = np.trapz(area, h) * n * n / (4.0 * n * n * (high - low))
assert abs(got["fraction"] / want - 1) < 1e-6, (got, want)
assert abs(got["kinetic"] - 0.5 * 0.03 / (9.81 * 2)) < 1e-12, got
# a heap that is turned by 30 degrees about x: its right side, y > 0, goes up
a = np.radians(30)
heap = np.array([[0, y, z] for y in np.linspace(-1, 1, 21) for z in np.linspace(-3, -1, 5)])
turn = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
m = np.ones(len(heap))
got = observe.angle({"x": heap @ turn.T, "mass": m}, {})
assert abs(got["angle"] - 30) < 1e-9, got
# a row of balls of 1 and 2, the last two of which overlap by 0.03; one of 9 that overlaps a ball of 2 by 0.1
x = np.array([[0, 0, 0], [3, 0, 0], [6, 0, 0], [7.97, 0, 0]])
radius = np.array([1, 2, 1, 1.0])
assert abs(observe.overlap(x, radius) - 0.03) < 1e-12
assert abs(observe.overlap(np.vstack([x, [3, 0, 10.9]]), np.append(radius, 9)) - 0.05) < 1e-12
assert observe.overlap(x[:2], radius[:2] * 0.9) == 0
PY
}
ok "solid fraction, energy and angle of known arrangements" observes

# ---- the scene of a job as LIGGGHTS gets it ----

translates() { py - "$tmp" <<'PY'
import json, os, sys
sys.path.insert(0, "bench/peers")
import numpy as np
import liggghts
from jobs import JOBS
folder = sys.argv[1]
start, run, _ = JOBS["silo"].scenes(100, 1)
scene = {**start, **run}
r = np.array([1.5e-3, 2e-3])
balls = {"x": np.array([[0, 0, 0.01], [0, 0, 0.02]]), "v": np.zeros((2, 3)), "radius": r, "mass": 2500 * 4 / 3 * np.pi * r ** 3,
         "kind": np.array(["ball", "ball"])}
dt, every = liggghts.write(folder, scene, balls, 5e6, 0.1, 40, False, 1)
# a fifth of pi r sqrt(rho/G)/(0.1631 nu + 0.8766) = 1.836e-4 s [Li, Xu, Thornton 2005]
assert abs(dt - 3.6e-5) < 1e-12, dt
text = open(os.path.join(folder, "in")).read()
assert "zcylinder 0.04 0 0" in text and "mesh/surface file wall1.stl" in text, text
data = [line.split() for line in open(os.path.join(folder, "data"))]
assert ["-0.02"] == [w[0] for w in data if w[2:3] == ["zlo"]], data
rows = [w for w in data if len(w) == 7 and w[1] == "1"]
assert len(rows) == 2 and float(rows[0][2]) == 3e-3 and abs(float(rows[0][3]) - 2500) < 1e-9, rows
# the area of the floor: that of polygons with 96 sides
corner = [list(map(float, line.split()[1:])) for line in open(os.path.join(folder, "wall1.stl")) if line.startswith("vertex")]
tri = np.array(corner).reshape(-1, 3, 3)
area = np.linalg.norm(np.cross(tri[:, 1] - tri[:, 0], tri[:, 2] - tri[:, 0]), axis=1).sum() / 2
assert abs(area / (48 * np.sin(2 * np.pi / 96) * (0.041 ** 2 - 0.015 ** 2)) - 1) < 1e-6, area
PY
}
ok "walls, balls and time step of the silo for LIGGGHTS" translates

# ---- the smallest job, by nsd alone ----

export N_SETTLING=200 T_SETTLING=0.1 LIGGGHTS=none-such YADE=none-such
peers() { bench/peers.py --quick --bound 30 --jobs settling --out "$tmp/peers" "$@"; }
ok "make peers, one job" peers --mode cost,page
is "a code that is not installed is said to be so" \
    "$(grep -c 'not installed' "$tmp/peers/README.md")" 6
like "the job ran to its end" "$(jq -c '.runs[0] | [.cut, (.span - 0.1 | fabs < 1e-9), .cpu > 0, .memory > 1, .steps]' "$tmp/peers/settling/nsd.json")" \
    '^\[false,true,true,true,100\]$'
like "its curve is a bed that forms" "$(jq -c '.series | [.t[0] == 0, .fraction[-1] > .fraction[0]]' "$tmp/peers/settling/nsd.json")" '^\[true,true\]$'
is "two threads give the same curve" "$(jq -c .series "$tmp/peers/settling/nsd-2.json")" "$(jq -c .series "$tmp/peers/settling/nsd.json")"
before=$(cksum "$tmp/peers/settling/nsd.json")
ok "again" peers --mode cost
is "what is there is not made again" "$(cksum "$tmp/peers/settling/nsd.json")" "$before"
status 64 "an unknown job" bench/peers.py --jobs drumm --out "$tmp/none"
like "and the jobs are named" "$(cat "$tmp/err")" '^peers: no job, variant or mode drumm: jobs are drum,'
done_testing
