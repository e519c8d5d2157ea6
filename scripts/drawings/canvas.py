"""A drawing as SVG: lines, arrows, circles and words, in pixels from the upper left corner.

Colours have one meaning in all drawings: blue is a body, grey a wall, green a velocity or a motion, orange a force or a reaction,
violet what a user chooses, red a failure. In words _x or _{xy} is a subscript, ^x or ^{xy} a superscript; mono=True: as it is typed, without these."""
import html
import math
import re

INK, BODY, WALL, MOTION, FORCE, CHOICE, FAULT, PALE = '#222222', '#1f4e79', '#777777', '#3a7d44', '#c05a1a', '#7a4a8a', '#aa0000', '#999999'
FILL = {BODY: '#dce8f2', WALL: '#e6e6e6', MOTION: '#e2f0e4', FORCE: '#f8e8dc', CHOICE: '#efe6f3', FAULT: '#e8b0b0', INK: '#ffffff', PALE: '#f6f6f6'}


def number(x):
    return f'{x:.1f}'.rstrip('0').rstrip('.').replace('-0', '0') if abs(x) < 0.05 else f'{x:.1f}'.rstrip('0').rstrip('.')


class Canvas:
    def __init__(self, width, height, title):
        self.width, self.height, self.title, self.parts = width, height, title, []

    def add(self, name, content=None, **attributes):
        text = ''.join(f' {k.replace("__", ":").replace("_", "-")}="{number(v) if isinstance(v, (int, float)) else v}"' for k, v in attributes.items() if v is not None)
        self.parts.append(f'<{name}{text}/>' if content is None else f'<{name}{text}>{content}</{name}>')

    def line(self, x1, y1, x2, y2, colour=INK, width=1.5, dash=None):
        self.add('line', x1=x1, y1=y1, x2=x2, y2=y2, stroke=colour, stroke_width=width, stroke_dasharray=dash)

    def path(self, points, colour=INK, width=1.5, fill='none', closed=False, dash=None):
        d = 'M' + ' L'.join(f'{number(x)} {number(y)}' for x, y in points) + (' Z' if closed else '')
        self.add('path', d=d, stroke=colour, stroke_width=width, fill=fill, stroke_dasharray=dash)

    def head(self, x, y, angle, colour, size=8):
        tip = [(x + size * math.cos(angle + a) * k, y + size * math.sin(angle + a) * k) for a, k in ((math.pi - 0.38, 1), (0, 0), (math.pi + 0.38, 1))]
        self.path(tip, colour, 0.5, colour, True)

    def arrow(self, x1, y1, x2, y2, colour=INK, width=2, both=False, dash=None):
        angle = math.atan2(y2 - y1, x2 - x1)
        cut = 6
        self.line(x1 + (cut * math.cos(angle) if both else 0), y1 + (cut * math.sin(angle) if both else 0),
                  x2 - cut * math.cos(angle), y2 - cut * math.sin(angle), colour, width, dash)
        self.head(x2, y2, angle, colour)
        if both:
            self.head(x1, y1, angle + math.pi, colour)

    def bend(self, points, colour=INK, width=2, dash=None):
        """An arrow along several points"""
        self.path(points[:-1] + [(points[-1][0], points[-1][1])], colour, width, dash=dash)
        (a, b), (c, d) = points[-2:]
        self.head(c, d, math.atan2(d - b, c - a), colour)

    def circle(self, x, y, r, colour=BODY, fill=None, width=1.5, dash=None):
        self.add('circle', cx=x, cy=y, r=r, stroke=colour, stroke_width=width, fill=FILL.get(colour, 'none') if fill is None else fill, stroke_dasharray=dash)

    def ellipse(self, x, y, rx, ry, colour=WALL, fill='none', width=1.5, dash=None):
        self.add('ellipse', cx=x, cy=y, rx=rx, ry=ry, stroke=colour, stroke_width=width, fill=fill, stroke_dasharray=dash)

    def arc(self, x, y, r, start, end, colour=INK, width=1.5, head=False, dash=None):
        """Counterclockwise on the screen, degrees"""
        n = max(2, int(abs(end - start) / 5))
        turn = [math.radians(start + (end - start) * k / n) for k in range(n + 1)]
        points = [(x + r * math.cos(t), y - r * math.sin(t)) for t in turn]
        (self.bend if head else self.path)(points, colour, width, dash=dash)

    def rect(self, x, y, w, h, colour=INK, fill=None, width=1.5, round_=0, dash=None):
        self.add('rect', x=x, y=y, width=w, height=h, rx=round_ or None, stroke=colour, stroke_width=width,
                 fill=FILL.get(colour, 'none') if fill is None else fill, stroke_dasharray=dash)

    def wall(self, x1, y1, x2, y2, behind=1, width=2.5):
        """A wall from one point to another, hatched on its right (behind = 1) or left"""
        length = math.hypot(x2 - x1, y2 - y1)
        ex, ey = (x2 - x1) / length, (y2 - y1) / length
        for k in range(int(length // 8) + 1):
            x, y = x1 + ex * 8 * k, y1 + ey * 8 * k
            self.line(x, y, x - 5 * ex - 7 * ey * behind, y - 5 * ey + 7 * ex * behind, PALE, 1)
        self.line(x1, y1, x2, y2, WALL, width)

    def words(self, x, y, text, colour=INK, size=14, anchor='start', mono=False, bold=False, italic=False):
        if mono:
            content = html.escape(text, quote=False)
        else:
            content, shift = '', 0
            for part in re.split(r'([_^](?:\{[^}]*\}|[^\s{]))', text):
                small = re.fullmatch(r'([_^])(?:\{([^}]*)\}|(.))', part)
                want = 0 if not small else 4 if small[1] == '_' else -6
                inner = html.escape(part if not small else small[2] or small[3], quote=False)
                if inner:
                    content += f'<tspan dy="{want - shift}" font-size="{size * 0.75 if small else size:g}">{inner}</tspan>' if want != shift or small else inner
                    shift = want
        self.add('text', content, x=x, y=y, fill=colour, font_size=size, text_anchor=None if anchor == 'start' else anchor,
                 font_family='DejaVu Sans Mono, monospace' if mono else None, font_weight='bold' if bold else None,
                 font_style='italic' if italic else None, xml__space='preserve' if mono else None)

    def lines(self, x, y, texts, step=19, **how):
        for k, text in enumerate(texts):
            self.words(x, y + step * k, text, **how)

    def box(self, x, y, w, h, texts, colour=INK, size=14, mono=0, step=18):
        """A box with lines in its middle; the first of them as they are typed, if mono is their number"""
        self.rect(x, y, w, h, colour, round_=5)
        top = y + h / 2 - step * (len(texts) - 1) / 2 + size * 0.36
        for k, text in enumerate(texts):
            self.words(x + w / 2, top + step * k, text, size=size if k >= mono or mono == 0 else size - 0.5, anchor='middle', mono=k < mono, bold=k < mono)

    def text(self):
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" width="{self.width}" height="{self.height}" '
                f'font-family="DejaVu Sans, Verdana, sans-serif">\n<title>{html.escape(self.title)}</title>\n'
                f'<rect width="{self.width}" height="{self.height}" fill="#ffffff"/>\n' + '\n'.join(self.parts) + '\n</svg>\n')
