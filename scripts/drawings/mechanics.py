"""Drawings of the motion and the contact law: nsd-methods(7), Motion, Overlap, Contacts, The law"""
import math

from canvas import BODY, CHOICE, FAULT, FORCE, INK, MOTION, PALE, WALL, Canvas


def step():
    c = Canvas(640, 560, 'How a step is made')
    c.words(20, 28, 'Small steps, the default', bold=True, size=15)
    c.words(620, 28, 'nsd-step --small-steps R   [0.01]', mono=True, size=13, colour=CHOICE, anchor='end')
    x0, x1, y = 40, 600, 82
    c.line(x0, y, x1, y, width=2)
    for k in range(15):
        x = x0 + (x1 - x0) * k / 14
        c.line(x, y - (12 if k % 14 == 0 else 6), x, y + (12 if k % 14 == 0 else 6))
    c.arrow(x0, y - 24, x1, y - 24, PALE, 1.2, both=True)
    c.rect(258, y - 33, 124, 18, INK, width=0)
    c.words(320, y - 19, 'step dt of the scene', anchor='middle', size=13)
    c.arrow(x0 + 160, y + 22, x0 + 200, y + 22, CHOICE, 1.2, both=True)
    c.words(x0 + 210, y + 27, 'small step h = dt/n: no body moves by more than R radii', size=13)
    c.words(20, 150, 'In each small step', size=14)
    boxes = [('every pair finds', 'gap and normal'), ('one sweep: each pair', 'is solved once'), ('bodies move', 'by h')]
    for k, texts in enumerate(boxes):
        x = 20 + 206 * k
        c.box(x, 162, 176, 50, texts, INK, 13)
        if k < 2:
            c.arrow(x + 178, 187, x + 204, 187)
    c.bend([(520, 214), (520, 234), (108, 234), (108, 216)], PALE, 1.5)
    c.words(320, 252, 'n times; a small step begins with the reactions of the one before', anchor='middle', size=13)
    c.line(20, 276, 620, 276, PALE, 1)
    c.words(20, 304, 'One solve per step', bold=True, size=15)
    c.words(620, 304, 'nsd-step --solver auto', mono=True, size=13, colour=CHOICE, anchor='end')
    ground = 440
    c.wall(20, ground, 620, ground, 1)
    for x, yb, r, dash in ((90, 352, 26, None), (235, 414, 26, '4 3'), (420, 414, 26, None)):
        c.circle(x, yb, r, BODY, dash=dash, fill=None if dash is None else 'none')
        c.circle(x, yb, 2, BODY, BODY)
    c.arrow(90, 352, 229, 411, MOTION)
    c.words(128, 356, '(1 - θ) dt q̇', MOTION)
    c.arrow(235, 414, 414, 414, MOTION)
    c.words(330, 405, "θ dt q̇'", MOTION, anchor='middle')
    c.arrow(235, 440, 235, 392, FORCE, 2.5)
    c.words(243, 386, 'r', FORCE)
    c.words(90, 470, 'q', anchor='middle')
    c.words(235, 470, 'predicted position', anchor='middle')
    c.words(420, 470, "q'", anchor='middle')
    for k, texts in enumerate([('nsd-detect', 'contacts, in the', 'predicted position'), ('nsd-solve', 'sweeps over all contacts', 'until the tolerance'),
                               ('nsd-move', "velocities q̇' and", "positions q'")]):
        x = 20 + 206 * k
        c.box(x, 482, 184, 66, texts, INK, 13, mono=1)
        if k < 2:
            c.arrow(x + 185, 515, x + 205, 515)
    return c


def overlap():
    c = Canvas(640, 500, 'Gap and overlap, and what depends on them')
    for x, gap, text in ((110, 22, 'gap g > 0'), (320, 0, 'g = 0: they touch'), (530, -16, 'overlap: g < 0')):
        r = 42
        c.circle(x - r - gap / 2, 70, r)
        c.circle(x + r + gap / 2, 70, r, fill='none' if gap < 0 else None)
        if gap:
            a, b = x - abs(gap) / 2, x + abs(gap) / 2
            c.line(a, 52, a, 126, PALE, 1)
            c.line(b, 52, b, 126, PALE, 1)
            c.words(x, 144, 'g' if gap > 0 else '-g', anchor='middle', italic=True)
            c.line(a, 122, b, 122, INK, 3)
        c.words(x, 20, text, anchor='middle')
    c.words(20, 182, 'The gap of a pair, in radii r (not to scale)', bold=True, size=15)
    y, at = 300, {'-0.1': 50, '-2R': 200, '-R': 255, '0': 345, '0.001': 430, '0.3': 590}
    c.line(20, y, 620, y, width=2)
    c.rect(345, y - 5, 85, 10, PALE, '#dddddd', width=0.5)
    c.rect(200, y - 5, 55, 10, CHOICE, width=0.5)
    c.rect(20, y - 5, 30, 10, FAULT, width=0.5)
    for name, x in at.items():
        c.line(x, y - 9, x, y + 9)
        c.words(x, y + 26, {'-2R': '-2 R', '-R': '-R'}.get(name, name), anchor='middle', size=13)
    notes = [(35, 232, ['account: the run fails', '(-e ends it)'], 20, 'start'), (228, 196 + 20, ['small steps leave', 'overlaps of R to 2 R'], 228, 'middle'),
             (388, 232, ['near: a contact of', 'one solve, if <= 1e-3 r'], 400, 'middle'),
             (590, 216, ['margin of the list', 'of small steps,', '0.3 of the smallest r'], 620, 'end')]
    for x, top, texts, tx, anchor in notes:
        c.lines(tx, top, texts, 17, size=12.5, anchor=anchor)
        c.line(x, top + 17 * len(texts) - 8, x, y - 12, PALE, 1)
    c.words(20, 362, 'Permitted overlap', bold=True, size=15)
    rows = [('scene', 'allow_overlap: false', 'at the start at most 1e-6 of the smaller radius,', 'of a document or a table a tenth of it'),
            ('small steps', '--small-steps R', 'bodies move by R per small step: overlaps of R to 2 R', ''),
            ('one solve', '--overlap-rule project', 'bodies are moved apart by at least 2e-3 r per step, down', 'to an overlap of |g| dt² + 1e-6 r; velocities stay')]
    yy = 386
    for name, key, text, more in rows:
        c.words(20, yy, name, size=13)
        c.words(105, yy, key, CHOICE, 12.5, mono=True)
        c.words(285, yy, text, size=12)
        if more:
            c.words(285, yy + 16, more, size=12)
        yy += 40 if more else 26
    return c


def contact():
    c = Canvas(640, 470, 'The frame of a contact, and signs')
    c.circle(150, 150, 92)
    c.circle(338, 150, 76)
    c.words(120, 126, 'a', size=20, bold=True, colour=BODY)
    c.words(368, 126, 'b', size=20, bold=True, colour=BODY)
    p = 252
    c.line(242, 60, 242, 262, PALE, 1, '3 3')
    c.line(262, 60, 262, 262, PALE, 1, '3 3')
    c.arrow(242, 254, 262, 254, PALE, 1.2)
    c.words(252, 278, 'gap g (negative: overlap)', anchor='middle', size=13)
    c.arrow(p, 150, p + 62, 150, INK, 2.5)
    c.words(p + 50, 170, 'n', bold=True)
    c.arrow(p, 150, p, 88, INK, 2.5)
    c.words(p + 8, 90, 't_1', bold=True)
    c.circle(p, 150, 7, INK, '#ffffff')
    c.circle(p, 150, 2, INK, INK)
    c.words(p - 30, 172, 't_2', bold=True)
    c.words(20, 30, 'Two bodies', bold=True, size=15)
    c.lines(440, 60, ['n points from a to b;', '(n, t_1, t_2) is right-handed.', 'In the plane t_2 is the z axis.'], 20, size=13)
    c.lines(440, 140, ['u = velocity of b', 'relative to a, m/s', 'u_n > 0: they separate'], 20, size=13, colour=MOTION)
    c.lines(440, 220, ['r = impulse that a', 'exerts on b, N s', 'r_n > 0: it pushes', 'force on b: r/dt, N'], 20, size=13, colour=FORCE)
    c.line(20, 308, 620, 308, PALE, 1)
    c.words(20, 334, 'A wall and a body', bold=True, size=15)
    c.wall(40, 440, 420, 440, 1)
    c.circle(250, 382, 58)
    c.words(212, 368, 'b', size=18, bold=True, colour=BODY)
    c.words(50, 430, 'a: the wall', WALL)
    c.arrow(250, 440, 250, 392, INK, 2.5)
    c.words(232, 408, 'n', bold=True)
    c.arrow(266, 440, 266, 368, FORCE, 3)
    c.words(272, 402, 'r_n n', FORCE)
    c.arrow(324, 382, 386, 382, MOTION, 2.5)
    c.words(346, 372, 'u_t', MOTION)
    c.arrow(250, 446, 190, 446, FORCE, 3)
    c.words(176, 464, 'r_t: friction opposes u_t', FORCE, 13)
    c.lines(440, 356, ['The wall is always a, and', 'n points into the interior.', 'In documents body = [a, b]:', 'rows of particles,', 'wall w is -1 - w.'], 20, size=13)
    return c


def cone():
    c = Canvas(640, 500, "Coulomb's cone and the natural map")
    ox, oy, s, mu = 200, 330, 88, 0.5

    def at(t, n):
        return ox + s * t, oy - s * n
    top = 2.7
    c.path([at(-mu * top, top), at(0, 0), at(mu * top, top)], FORCE, 2, '#f8e8dc')
    low = 1.35
    c.path([at(-low, -mu * low), at(0, 0), at(low, -mu * low)], PALE, 1.5, '#f2f2f2', dash='5 3')
    c.arrow(ox - 180, oy, ox + 200, oy, PALE, 1.2)
    c.words(ox + 186, oy + 20, 'r_t')
    c.arrow(ox, oy + 110, ox, oy - 275, PALE, 1.2)
    c.words(ox + 10, oy - 262, 'r_n')
    c.words(ox - 22, oy - 190, 'K', FORCE, 20, 'end', bold=True)
    c.words(ox + 4, oy - 160, 'stick', FORCE, 13)
    c.words(ox + 8, oy + 92, 'free: proj = 0', WALL, 13)
    # tau outside, and its projection
    tt, tn = 1.75, 1.5
    rn = (tn + mu * tt) / (1 + mu * mu)
    rt = mu * rn
    (px, py), (qx, qy) = at(tt, tn), at(rt, rn)
    c.arrow(ox, oy, qx, qy, FORCE, 2.5)
    c.line(px, py, qx, qy, INK, 1.5, '4 3')
    ux, uy = (px - qx) / math.hypot(px - qx, py - qy), (py - qy) / math.hypot(px - qx, py - qy)
    c.path([(qx + 11 * ux, qy + 11 * uy), (qx + 11 * ux - 11 * uy, qy + 11 * uy + 11 * ux), (qx - 11 * uy, qy + 11 * ux)], INK, 1)
    c.circle(px, py, 4, INK, INK)
    c.words(px - 20, py + 24, 'τ = r - ρ û', size=15)
    c.words(qx + 10, qy - 6, 'proj(τ, K)', FORCE, 14)
    c.words(ox - 180, oy - 290, 'slide: on the edge, |r_t| = μ r_n', FORCE, 13)
    x = 430
    c.words(x, 40, "Coulomb's cone", bold=True, size=15)
    c.words(x, 64, 'K = { r : |r_t| <= μ r_n }', FORCE, 13.5)
    c.words(x, 100, 'The law, for any ρ > 0', bold=True, size=13.5)
    c.words(x, 122, 'r = proj(r - ρ û, K)', size=13.5)
    c.words(x, 144, 'û = u + μ |u_t| n', MOTION, 13.5)
    c.words(x, 186, 'proj(τ, K) is', bold=True, size=13.5)
    c.lines(x, 208, ['0      if μ |τ_t| <= -τ_n', 'τ      if |τ_t| <= μ τ_n', 'else the nearest edge:', 'r_n = (τ_n + μ |τ_t|)/(1 + μ²)', 'r_t = μ r_n τ_t/|τ_t|'], 21, size=13)
    c.words(x - 10, 350, 'Natural map', bold=True, size=15)
    c.lines(x - 10, 374, ['how far r is from its', 'projection, all contacts:'], 19, size=13)
    c.words(x - 10, 420, '|r - proj(r - ρ_a û, K)| / |r|', size=13)
    c.words(x - 10, 444, 'ρ_a = 1/λ_{max}(W_{aa})', size=13)
    c.words(20, 486, 'At a solution τ projects on r itself: û = 0 inside of K, û at right angles to the edge, or r = 0.', size=12.5)
    return c
