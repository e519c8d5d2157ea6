"""Drawings of what a scene has: walls, loads, the periodic cell. Names of keys are those of nsd-gen --keys."""
import math

from canvas import BODY, CHOICE, FORCE, INK, MOTION, PALE, WALL, Canvas


def walls():
    c = Canvas(640, 800, 'Shapes of walls with their keys')
    w, h = 204, 190

    def panel(k, name, keys):
        x, y = 14 + (k % 3) * (w + 2), 10 + (k // 3) * (h + 6)
        c.rect(x, y, w, h, PALE, '#ffffff', 1)
        c.words(x + 8, y + 20, name, CHOICE, 14, mono=True, bold=True)
        for j, line in enumerate(keys):
            c.words(x + 8, y + h - 12 - 16 * (len(keys) - 1 - j), line, INK, 12, mono=True)
        return x + w / 2, y + 88

    def dot(x, y, label='', dx=6, dy=-6):
        c.circle(x, y, 3, INK, INK)
        c.words(x + dx, y + dy, label, size=12)
    x, y = panel(0, 'point, normal', ['"point": [x, y, z]', '"normal": [x, y, z]'])
    c.wall(x - 80, y + 14, x + 80, y + 14)
    dot(x - 10, y + 14, 'point', -40, -6)
    c.arrow(x - 10, y + 14, x - 10, y - 36)
    c.words(x - 2, y - 26, 'normal', size=12)
    c.circle(x + 52, y - 6, 20)
    x, y = panel(1, 'box', ['"x": [x0, x1],', '"y": [..], "z": [..]'])
    for a in ((x - 55, y + 24, x + 55, y + 24), (x + 55, y + 24, x + 55, y - 50), (x + 55, y - 50, x - 55, y - 50), (x - 55, y - 50, x - 55, y + 24)):
        c.wall(*a)
    c.circle(x - 20, y + 4, 20)
    c.words(x - 58, y + 46, 'x0', size=12)
    c.words(x + 50, y + 46, 'x1', size=12)
    x, y = panel(2, 'segment', ['"segment":', '  [[x, y], [x, y]]   2D'])
    c.line(x - 70, y + 24, x + 60, y - 26, WALL, 3)
    dot(x - 70, y + 24)
    dot(x + 60, y - 26)
    x, y = panel(3, 'polygon', ['"points": [[x, y], ..],', '"closed": true       2D'])
    corners = [(x - 66, y - 32), (x - 20, y + 26), (x + 40, y + 12), (x + 62, y - 40)]
    c.path(corners, WALL, 3)
    c.path([corners[3], corners[0]], WALL, 1.5, dash='4 3')
    for q in corners:
        dot(*q)
    x, y = panel(4, 'circle, sphere', ['"center", "radius",', '"side": "inside"'])
    c.circle(x, y - 12, 46, WALL, 'none', 3)
    c.circle(x - 16, y + 12, 17)
    dot(x, y - 12, 'center', -20, -8)
    c.line(x, y - 12, x + 46 * math.cos(0.3), y - 12 + 46 * math.sin(0.3), INK, 1)
    c.words(x + 50, y + 14, 'radius', size=12)
    x, y = panel(5, 'arc', ['"center", "radius",', '"along", "arc",', '"side": "inside"     2D'])
    y -= 2
    c.arc(x, y - 16, 42, 20, -140, WALL, 3)
    dot(x, y - 16)
    ends = [(x + 42 * math.cos(math.radians(t)), y - 16 - 42 * math.sin(math.radians(t))) for t in (-140, 20)]
    c.arrow(x, y - 16, *ends[0], CHOICE, 1.5)
    c.line(x, y - 16, *ends[1], PALE, 1)
    c.arc(x, y - 16, 18, -140, 20, INK, 1.2, head=True)
    c.words(x - 66, y - 8, 'along', CHOICE, 12)
    c.words(x + 12, y + 12, 'arc', size=12)
    x, y = panel(6, 'rectangle', ['"center", "normal",', '"along", "sides": [a, b]'])
    q = [(x - 80, y + 18), (x + 24, y + 26), (x + 76, y - 14), (x - 28, y - 22)]
    c.path(q, WALL, 2.5, '#e6e6e6', True)
    m = (x - 2, y + 2)
    dot(*m)
    c.arrow(*m, m[0], m[1] - 44)
    c.words(m[0] + 6, m[1] - 34, 'normal', size=12)
    c.arrow(*m, m[0] + 40, m[1] + 3, CHOICE, 1.5)
    c.words(m[0] + 8, m[1] + 16, 'along', CHOICE, 12)
    c.words(x - 34, y + 38, 'a', size=13, italic=True)
    c.words(x + 56, y + 18, 'b', size=13, italic=True)
    x, y = panel(7, 'disc', ['"center", "normal",', '"radius", "hole"'])
    c.ellipse(x, y + 2, 76, 30, WALL, '#e6e6e6', 2.5)
    c.ellipse(x, y + 2, 22, 9, WALL, '#ffffff', 2)
    c.arrow(x, y + 2, x, y - 48)
    c.words(x + 6, y - 38, 'normal', size=12)
    c.line(x, y + 2, x + 66, y + 17, INK, 1)
    c.words(x + 58, y + 38, 'radius', size=12)
    c.words(x - 60, y + 2, 'hole', size=12)
    c.line(x - 30, y - 1, x - 20, y, INK, 1)
    x, y = panel(8, 'cylinder', ['"point", "axis", "radius",', '"length", "side",', '"along", "arc"'])
    y -= 8
    c.line(x - 56, y - 22, x + 56, y - 22, WALL, 2.5)
    c.line(x - 56, y + 22, x + 56, y + 22, WALL, 2.5)
    c.ellipse(x - 56, y, 10, 22, WALL, '#e6e6e6', 2)
    c.ellipse(x + 56, y, 10, 22, WALL, 'none', 2)
    dot(x - 56, y, 'point', -38, -26)
    c.arrow(x - 56, y, x + 20, y)
    c.words(x - 26, y - 6, 'axis', size=12)
    c.line(x + 56, y, x + 56, y + 22, INK, 1)
    c.words(x + 68, y + 20, 'r', size=12, italic=True)
    c.arrow(x - 56, y + 34, x + 56, y + 34, PALE, 1.2, both=True)
    c.words(x - 18, y + 31, 'length', size=11)
    x, y = panel(9, 'cone', ['"point", "axis", "length",', '"radii": [r, s], "side",', '"along", "arc"'])
    y -= 8
    c.ellipse(x - 50, y, 12, 34, WALL, '#e6e6e6', 2)
    c.ellipse(x + 56, y, 6, 12, WALL, 'none', 2)
    c.line(x - 50, y - 34, x + 56, y - 12, WALL, 2.5)
    c.line(x - 50, y + 34, x + 56, y + 12, WALL, 2.5)
    dot(x - 50, y, 'point', -44, -30)
    c.arrow(x - 50, y, x + 24, y)
    c.words(x - 20, y - 6, 'axis', size=12)
    c.words(x - 76, y + 22, 'r', size=13, italic=True)
    c.words(x + 68, y + 6, 's', size=13, italic=True)
    x, y = panel(10, 'mesh', ['"file": "drum.stl",', '"scale", "at", "parts"'])
    q = [(x - 70, y + 10), (x - 30, y + 30), (x + 20, y + 22), (x + 70, y - 6), (x + 40, y - 40), (x - 14, y - 24), (x - 54, y - 34)]
    c.path(q, WALL, 2, '#e6e6e6', True)
    for a, b in ((1, 5), (2, 5), (2, 4), (0, 5), (1, 6)):
        if (a, b) != (1, 6):
            c.line(*q[a], *q[b], WALL, 1.5)
    x, y = panel(11, 'every wall', [])
    x -= w / 2 - 10
    rows = [('"name"', 'of the wall'), ('"material"', 'what it is made of'), ('"velocity"', 'm/s'), ('"belt"', 'm/s, the surface'),
            ('"drives"', 'its motion'), ('"load"', 'force on it'), ('"until"', 's, a gate'), ('"wear"', '1/Pa')]
    for k, (key, text) in enumerate(rows):
        c.words(x, y - 42 + 17.5 * k, key, CHOICE, 12, mono=True)
        c.words(x + 84, y - 42 + 17.5 * k, text, size=12)
    return c


def load():
    c = Canvas(640, 456, 'Load and servo')
    c.words(20, 28, 'Load: a piston', bold=True, size=15)
    for a in ((40, 60, 40, 330), (40, 330, 240, 330), (240, 330, 240, 60)):
        c.wall(*a)
    for x, y in ((64, 306), (112, 306), (160, 306), (208, 306), (88, 265), (136, 265), (184, 265), (72, 222), (206, 222), (128, 217)):
        c.circle(x, y, 23 if y != 222 else 20)
    c.rect(42, 172, 196, 20, WALL, '#d0d0d0')
    c.arrow(140, 90, 140, 170, FORCE, 3)
    c.words(150, 108, 'f = P A', FORCE)
    c.arrow(128, 218, 128, 194, FORCE, 3)
    c.words(252, 206, 'r/dt', FORCE, 13)
    c.line(248, 202, 140, 206, FORCE, 0.8)
    c.arrow(70, 132, 70, 168, MOTION, 2)
    c.words(52, 130, 'speed s', MOTION, 13)
    c.words(20, 358, '"load": {"pressure": P}', CHOICE, 12.5, mono=True)
    c.words(20, 377, '"load": {"along": a, "force": f}', CHOICE, 12.5, mono=True)
    c.words(20, 396, '"load": {"about": p, "torque": M}', CHOICE, 12.5, mono=True)
    c.words(20, 418, "s' = s + (dt f + J* r)/m,  J = -a", MOTION, 13)
    c.words(20, 440, 's is one more unknown, solved with the contacts; m: "mass"', size=12.5)
    x = 320
    c.words(x, 28, 'Servo: a box of walls', bold=True, size=15)
    l, r, t, b = x + 40, x + 280, 70, 290
    for a in ((l, t, l, b), (l, b, r, b), (r, b, r, t), (r, t, l, t)):
        c.wall(*a)
    cx, cy = (l + r) / 2, (t + b) / 2
    for px, py in ((cx - 60, cy - 50), (cx + 55, cy - 55), (cx - 50, cy + 55), (cx + 62, cy + 48)):
        c.circle(px, py, 26)
    c.circle(cx, cy, 4, INK, INK)
    c.words(cx + 8, cy - 8, 'center c', size=13)
    c.arrow(cx, cy, r - 2, cy, PALE, 1.3)
    c.words(cx + 66, cy + 17, 'l', size=15, italic=True)
    for (x1, y1), (x2, y2) in (((l - 26, cy), (l - 2, cy)), ((r + 28, cy), (r + 3, cy)), ((cx, t - 28), (cx, t - 3)), ((cx, b + 28), (cx, b + 3))):
        c.arrow(x1, y1, x2, y2, FORCE, 3)
    c.words(cx + 8, b + 26, 'mean pressure P', FORCE, 13)
    c.lines(x, 358, ['"servo": {"walls": "box", "pressure": P,', '          "strain_rate": [e, e, -2e]}'], 18, size=12.5, mono=True, colour=CHOICE)
    c.words(x, 418, 'dl/dt = v_n + (s + e) l', MOTION, 13)
    c.words(x + 94, 440, 's: one growth of all walls, 1/s', size=12.5)
    return c


def cell():
    c = Canvas(640, 520, 'The periodic cell, its edges and images')
    ox, oy, ex, ey, lean = 120, 300, 190, 170, 62

    def at(i, j, u=0.0, v=0.0):
        i, j = i + u, j + v
        return ox + ex * i + lean * j, oy - ey * j
    c.path([at(0, 0), at(1, 0), at(1, 1), at(0, 1)], INK, 1.5, '#fafafa', True)
    c.path([at(1, 0), at(2, 0), at(2, 1), at(1, 1)], PALE, 1, closed=True, dash='4 4')
    for u, v, name in ((0.9, 0.36, 'a'), (0.17, 0.42, 'b'), (0.5, 0.75, '')):
        x, y = at(0, 0, u, v)
        c.circle(x, y, 27)
        c.words(x - 5, y + 5, name, BODY, 15, bold=True)
    x, y = at(1, 0, 0.17, 0.42)
    c.circle(x, y, 27, BODY, 'none', dash='4 3')
    c.words(x - 9, y + 5, "b'", BODY, 15, bold=True)
    x, y = at(1, 0, 0.5, 0.75)
    c.circle(x, y, 27, BODY, 'none', dash='4 3')
    c.arrow(*at(0, 0), *at(1, 0), CHOICE, 3)
    c.arrow(*at(0, 0), *at(0, 1), CHOICE, 3)
    c.words(at(0.5, 0)[0], oy + 22, 'e_1', CHOICE, 16, 'middle', bold=True)
    c.words(at(0, 0.55)[0] - 28, at(0, 0.55)[1], 'e_2', CHOICE, 16, bold=True)
    c.circle(*at(0, 0), 4, INK, INK)
    c.words(ox - 60, oy + 22, '"origin"', CHOICE, 12.5, mono=True)
    c.arrow(at(0, 1)[0] - 30, at(0, 1)[1] - 18, at(0, 1)[0] + 50, at(0, 1)[1] - 18, MOTION, 2.5)
    c.words(at(0, 1)[0] - 40, at(0, 1)[1] - 32, 'c = L e_2, with L = [[0, G], [0, 0]]', MOTION, 13)
    c.words(20, 28, 'Periodic cell in simple shear', bold=True, size=15)
    c.lines(20, 446, ['a meets the image of b at x_b + s_1 e_1 + s_2 e_2; here the contact stores shift s = [1, 0].',
                      'The image moves at v_b + s_1 c_1 + s_2 c_2, with the rates c of the edges.',
                      'A body that leaves is replaced by its image inside; an edge that leans over another by more than',
                      '0.75 of its length is replaced by e_k - n e_j: the same lattice.'], 19, size=12.5)
    c.lines(20, 362, ['"cell": { "lengths": [1, 1],  or  "edges": [[e1x, e1y], [e2x, e2y]],', '          "origin": [0, 0], "repeats": [true, true],',
                      '          "gradient": [[0, G], [0, 0]],  or  "stress": {"pressure": P} }'], 18, size=12.5, mono=True, colour=CHOICE)
    return c
