"""Smooth elastic balls in a periodic cell, from impact to impact: the motion that nsd-step must find at any time step.

    hard_balls.py make N PATH >scene.json     paths of PATH mean radii a step
    hard_balls.py run FRAME TIME              collisions, and the positions of the balls at that time, from lines of nsd-info -p
"""
import json
import math
import random
import sys

RADIUS, FRACTION = 0.01, 0.05


def make(n: int, path: float) -> None:
    random.seed(5)
    edge = (n * 4 / 3 * math.pi * RADIUS**3 / FRACTION) ** (1 / 3)
    side = math.ceil(n ** (1 / 3))
    places = [(i, j, k) for i in range(side) for j in range(side) for k in range(side)]
    random.shuffle(places)
    bodies = [{"x": [(c + 0.5) * edge / side for c in place], "radius": RADIUS,
               "v": [random.gauss(0, 1) for _ in range(3)]} for place in places[:n]]
    print(json.dumps({"dt": path * RADIUS / math.sqrt(8 / math.pi), "gravity": [0, 0, 0], "mu": 0, "e_n": 1, "e_t": 0,
                      "cell": {"lengths": [edge] * 3}, "bodies": bodies}))


def next_impact(x, v, edge, until):
    """The first impact before `until`: its time, the two balls, and the way from one to the other."""
    best = (until, None)
    for i in range(len(x)):
        for j in range(i):
            w = [v[j][k] - v[i][k] for k in range(3)]
            w2 = sum(c * c for c in w)
            way = math.sqrt(w2) * best[0]
            d0 = [x[j][k] - x[i][k] for k in range(3)]
            for a in (-1, 0, 1):
                for b in (-1, 0, 1):
                    for c in (-1, 0, 1):
                        d = [d0[0] + a * edge, d0[1] + b * edge, d0[2] + c * edge]
                        d2, dw = sum(s * s for s in d), sum(s * t for s, t in zip(d, w))
                        if dw >= 0 or math.sqrt(d2) - 2 * RADIUS > way:
                            continue
                        root = dw * dw - w2 * (d2 - 4 * RADIUS**2)
                        if root < 0:
                            continue
                        t = (d2 - 4 * RADIUS**2) / (math.sqrt(root) - dw)
                        if t < best[0]:
                            best = (max(t, 0), (i, j, [s + t * u for s, u in zip(d, w)]))
    return best


def run(path: str, time: float) -> None:
    lines = [json.loads(line) for line in open(path)]
    balls = sorted((l for l in lines if "x" in l), key=lambda l: l["id"])
    n = len(balls)
    edge = (n * 4 / 3 * math.pi * RADIUS**3 / FRACTION) ** (1 / 3)
    x, v, now, impacts = [b["x"] for b in balls], [b["v"] for b in balls], 0.0, 0
    while now < time:
        t, pair = next_impact(x, v, edge, min(time - now, 1e-3))
        x = [[(c + t * u) % edge for c, u in zip(p, q)] for p, q in zip(x, v)]
        now += t
        if pair:
            i, j, d = pair
            normal = [c / (2 * RADIUS) for c in d]
            push = sum((v[j][k] - v[i][k]) * normal[k] for k in range(3))
            v[i] = [v[i][k] + push * normal[k] for k in range(3)]
            v[j] = [v[j][k] - push * normal[k] for k in range(3)]
            impacts += 1
    print(json.dumps({"impacts": impacts, "edge": edge, "x": x, "v": v}))


if __name__ == "__main__":
    if sys.argv[1] == "make":
        make(int(sys.argv[2]), float(sys.argv[3]))
    else:
        run(sys.argv[2], float(sys.argv[3]))
