"""Drawings of the tools and of what they exchange: the pipeline, a document, which step to choose"""
from canvas import BODY, CHOICE, FORCE, INK, PALE, WALL, Canvas


def pipeline():
    c = Canvas(640, 490, 'The pipeline of the tools')

    def tool(x, y, name, text, w=130, colour=INK):
        c.box(x, y, w, 48, [name, text], colour, 13, mono=1)
    c.words(20, 28, 'A step by hand', bold=True, size=15)
    tool(20, 44, 'nsd-gen', 'makes a packing')
    tool(182, 44, 'nsd-detect', 'finds contacts')
    tool(344, 44, 'nsd-solve', 'finds reactions')
    tool(496, 44, 'nsd-move', 'moves bodies', 124)
    for a, b in ((150, 182), (312, 344), (474, 496)):
        c.arrow(a, 68, b, 68)
    c.bend([(558, 92), (558, 112), (247, 112), (247, 94)], PALE, 1.5)
    c.words(402, 128, 'the next step', anchor='middle', size=12.5)
    c.words(20, 148, 'scene.json', CHOICE, 12.5, mono=True)
    c.arrow(60, 134, 60, 94, CHOICE, 1.8)
    c.words(20, 188, 'N steps', bold=True, size=15)
    tool(20, 200, 'nsd-gen', 'makes a packing')
    c.arrow(150, 224, 182, 224)
    tool(182, 200, 'nsd-step -n N', 'makes N steps', 150)
    c.arrow(332, 224, 372, 224)
    c.rect(372, 196, 130, 56, PALE, round_=5)
    c.words(437, 220, 'out.h5', INK, 13.5, 'middle', mono=True, bold=True)
    c.words(437, 239, 'trajectory', anchor='middle', size=13)
    c.bend([(437, 196), (437, 178), (257, 178), (257, 198)], PALE, 1.5)
    c.words(347, 172, 'resume', anchor='middle', size=12.5)
    c.words(514, 220, 'HDF5, in files', size=12.5)
    c.words(514, 238, 'and in pipes', size=12.5)
    c.words(20, 292, 'Programs that read a document', bold=True, size=15)
    c.arrow(437, 252, 437, 306, INK, 2)
    c.line(20, 308, 620, 308, INK, 2)
    readers = [('nsd-info', 'JSON lines'), ('nsd-stat', 'measures'), ('nsd-err', 'errors'), ('nsd-view', 'pictures, films'), ('nsd-web', 'a page to play'),
               ('nsd-export', 'other formats'), ('nsd-cat', 'joins, cuts, thins'), ('import nsd', 'Python module')]
    for k, (name, text) in enumerate(readers):
        x, y = 20 + 152 * (k % 4), 324 + 64 * (k // 4)
        tool(x, y, name, text, 144)
        if k < 4:
            c.line(x + 72, 308, x + 72, 324, INK, 1.5)
    c.words(20, 476, 'nsd-fit', INK, 13, mono=True, bold=True)
    c.words(84, 476, 'runs a scene again with other parameters, until it repeats measurements', size=12.5)
    c.words(620, 28, 'nsd-gen | nsd-detect | nsd-solve | nsd-move', CHOICE, 12, 'end', mono=True)
    return c


def document():
    c = Canvas(640, 560, 'The tree of a document')
    rows = [(0, '/', 'a document: an HDF5 file or part of a stream', INK),
            (1, 'h5md', 'version, author, creator', INK),
            (1, 'particles', '', INK),
            (2, 'all', 'the bodies', BODY),
            (3, 'id, mass, radius, ...', 'fixed in time', BODY),
            (3, 'position/value', '[frame][body][3], m', BODY),
            (3, 'orientation/value', 'quaternions', BODY),
            (3, 'velocity/value', 'm/s; likewise the angular velocity, rad/s', BODY),
            (3, 'box', 'the cell and its edges', BODY),
            (2, 'boundary', 'the walls: shapes, drives, loads', WALL),
            (1, 'contacts', 'of all frames, one row each', FORCE),
            (2, 'step, start, count', 'one per frame: its rows', FORCE),
            (2, 'body, point, frame, gap', 'a, b; n, t1, t2 in rows; m', FORCE),
            (2, 'mu, en, et', 'coefficients of the pair', FORCE),
            (2, 'reaction, velocity', 'of the solve: r, N s; u, m/s', FORCE),
            (2, 'status', '0 free, 1 stick, 2 slide, 3 jammed, 4 summed', FORCE),
            (1, 'nsd', 'data that only nsd reads', INK),
            (2, 'scene, history', 'the scene; the commands that made this', CHOICE),
            (2, 'material, cell', 'mu, en, et by materials; gradient and stress', CHOICE),
            (2, 'solver', 'the report of each frame', INK),
            (2, 'account', 'the largest errors of all steps', INK),
            (2, 'memory, bonds', 'state for a resumed run', INK),
            (2, 'outside', 'answers of a program in the loop', INK)]
    top, gap = 30, 23.4
    last = {}
    for k, (level, name, text, colour) in enumerate(rows):
        x, y = 24 + 30 * level, top + gap * k
        if level:
            px, py = 24 + 30 * (level - 1) + 5, last[level - 1]
            c.path([(px, py + 7), (px, y - 4), (x - 4, y - 4)], PALE, 1.2)
        last[level] = y
        c.words(x, y, name, colour, 13.5, mono=True, bold=level < 2)
        c.words(300, y, text, size=13)
    return c


def choose():
    c = Canvas(640, 600, 'Which step do I choose')

    def question(y, texts, h=58):
        c.rect(20, y, 290, h, INK, '#ffffff', round_=14)
        top = y + h / 2 - 9 * (len(texts) - 1) + 4.5
        for k, t in enumerate(texts):
            c.words(165, top + 18 * k, t, anchor='middle', size=13)

    def answer(y, key, texts, h=58, colour=CHOICE):
        c.rect(372, y, 252, h, colour, round_=5)
        c.words(384, y + 21, key, colour, 12.5, mono=True, bold=True)
        for k, t in enumerate(texts):
            c.words(384, y + 39 + 16 * k, t, size=12)

    def yes(y):
        c.arrow(310, y, 372, y)
        c.words(340, y - 6, 'yes', anchor='middle', size=12.5)

    def no(y1, y2):
        c.arrow(165, y1, 165, y2)
        c.words(173, (y1 + y2) / 2 + 4, 'no', size=12.5)
    question(20, ['Do you repeat the paper', 'or compare its methods?'])
    yes(49)
    answer(20, '--protocol paper -m METHOD', ['one solve per step, overlaps stay'])
    no(78, 104)
    question(104, ['Are the forces of single contacts', 'the result, or do masses differ', 'by a factor of 100 or more?'], 76)
    yes(142)
    answer(104, '--solver auto', ['one solve per step, to --tolerance;', '0.01 or less for exact forces;', 'dt decides about overlaps: below'], 76)
    no(180, 206)
    question(206, ['A compliance of contacts,', '--stiffness auto?'])
    yes(235)
    answer(206, '(no option)', ['nsd-step makes one solve per step', 'by itself; dt as below'], 62)
    no(264, 290)
    c.rect(20, 290, 290, 76, PALE, round_=5)
    c.words(32, 312, 'small steps, the default', INK, 14, bold=True)
    c.lines(32, 332, ['Overlaps are 0.01 to 0.02 radii for any dt:', 'dt is only the unit of steps and frames.'], 18, size=12.5)
    question(392, ['Does the result depend on the overlap?'], 44)
    c.arrow(165, 366, 165, 392)
    yes(414)
    answer(384, '--small-steps 0.005', ['half of R, until results differ by less', 'than their scatter between seeds'], 62)
    c.line(20, 466, 620, 466, PALE, 1)
    c.words(20, 490, 'dt of one solve per step: nsd-gen --check prints every limit', bold=True, size=13.5)
    rows = [('flow of grains in contact', 'limit gravity: g dt² <= 0.002 r, dt = 0.045 sqrt(r/g)'),
            ('impacts and falls', 'limit fall: v dt <= 0.05 r'),
            ('to be sure', 'half of dt: compare with the scatter between seeds')]
    for k, (name, text) in enumerate(rows):
        c.words(20, 514 + 21 * k, name, INK, 12.5, bold=True)
        c.words(205, 514 + 21 * k, text, size=12.5)
    return c
