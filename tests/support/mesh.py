# mesh.py write DIR: a cube of 1.3 m and other surfaces as STL, OBJ and PLY, each as programs write them, and scenes
# that have each for a wall and for a grain; DIR/list names them, with where the cube is.
# mesh.py judge DIR: are the documents DIR/NAME.wall.h5 and DIR/NAME.grain.h5 right? A line for each that is not.
import json, os, struct, sys

S = 1.3
MAP = (500000.2, 4649776.4, 312.7)
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
TRIANGLES = [t for q in QUADS for t in (q[:3], (q[0], q[2], q[3]))]


def corners(at):
    return [tuple(round(at[k] + S * (i >> k & 1), 3) for k in range(3)) for i in range(8)]


def text(v):
    return " ".join(map(repr, v))


def stl(at, name="c", normal="0 0 0", faces=TRIANGLES):
    v = corners(at)
    facets = "".join("facet normal %s\n  outer loop\n%s  endloop\nendfacet\n" % (
        normal, "".join("    vertex %s\n" % text(v[i]) for i in t)) for t in faces)
    return "solid %s\n%sendsolid %s\n" % (name, facets, name)


def binary(at, header=b"cube", faces=TRIANGLES):
    v = corners(at)
    return header.ljust(80) + struct.pack("<I", len(faces)) + b"".join(
        struct.pack("<12fH", *[float("nan")] * 3, *[c for i in t for c in v[i]], 7) for t in faces)


def obj(at, index="{0}", faces=QUADS, more="", tail=""):
    v = corners(at)
    f = "".join("f %s\n" % " ".join(index.format(i + 1, i - 8) for i in q) for q in faces)
    return "# a cube\n" + "".join("v %s%s\n" % (text(x), tail) for x in v) + more + f


def ply(at, form="ascii", x="double", count="uchar", index="int", words="vertex_indices", faces_first=False, extra=False):
    v, order = corners(at), ">" if "big" in form else "<"
    code = {"float": "f", "double": "d", "float32": "f", "float64": "d", "uchar": "B", "int": "i", "char": "b", "short": "h",
            "ushort": "H", "uint": "I", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I"}
    e = ["element vertex 8\nproperty %s z\n%sproperty %s x\nproperty %s y\n" % (
            x, "property uchar red\nproperty list uchar float w\n" if extra else "", x, x),
         "element face 6\n%sproperty list %s %s %s\n" % ("property float quality\n" if extra else "", count, index, words)]
    lines = [[], []]
    for p in v:
        lines[0].append([(x, p[2])] + ([("uchar", 255), ("uchar", 2), ("float", 0.5), ("float", 1.5)] if extra else []) +
                        [(x, p[0]), (x, p[1])])
    for q in QUADS:
        lines[1].append(([("float", float("nan"))] if extra else []) + [(count, 4)] + [(index, i) for i in q])
    if faces_first:
        e.reverse(), lines.reverse()
    if extra:
        e.insert(1, "element edge 2\nproperty int a\nproperty list ushort short b\n")
        lines.insert(1, [[("int", -1), ("ushort", 2), ("short", 5), ("short", -6)], [("int", 7), ("ushort", 0)]])
    head = "ply\nformat %s 1.0\ncomment made by hand\nobj_info none\n%send_header\n" % (form, "".join(e))
    rows = [row for part in lines for row in part]
    if form == "ascii":
        return head + "".join(" ".join(repr(w) for _, w in row) + "\n" for row in rows)
    return head.encode() + b"".join(struct.pack(order + code[t], w) for row in rows for t, w in row)


def files():
    near, far = (0.2, -0.4, 0.7), MAP
    yield "text.stl", near, stl(near)
    yield "map.stl", far, stl(far)
    yield "upper.stl", near, stl(near).upper()
    yield "nan.stl", near, stl(near, normal="-nan(ind) 1.#QNAN nan")
    yield "crlf.stl", near, stl(near).replace("\n", "\r\n")
    yield "mark.stl", near, "\ufeff" + stl(near)
    yield "tabs.stl", near, stl(near).replace(" ", "\t \t").replace("\n", "\n\n")
    yield "solids.stl", near, stl(near, "facet of a", faces=TRIANGLES[:5]) + stl(near, "", faces=TRIANGLES[5:])
    yield "line.stl", near, stl(near).replace("\n  outer", " outer")
    yield "twice.stl", near, stl(near, faces=TRIANGLES + TRIANGLES[:3] + [(0, 0, 1), (2, 2, 2)])
    yield "turned.stl", near, stl(near, faces=TRIANGLES + [TRIANGLES[4][::-1]])
    yield "binary.stl", near, binary(near)
    yield "solid.stl", near, binary(near, b"solid cube")
    yield "named.dat", near, binary(near, b"v 1 2 3\n")
    yield "wrong.obj", near, binary(near)
    yield "plain.obj", far, obj(far)
    yield "texture.obj", near, obj(near, "{0}/1/2", more="vt 0 0\nvn 0 0 1\nvn nan nan nan\nvp 1\n")
    yield "normal.obj", near, obj(near, "{0}//1", more="mtllib a.mtl\nusemtl red\ns off\nl 1 2\np 3\n")
    yield "back.obj", near, obj(near, "{1}", more="g side\no cube\ng\nunknown 1 2 3 f\n")
    yield "weight.obj", near, obj(near, tail=" 1.0")
    yield "colour.obj", near, obj(near, tail=" 0.5 0.5 1e0")
    yield "colour_nan.obj", near, obj(near, tail=" 0.5 nan word")
    yield "joined.obj", near, obj(near).replace(" 4 2\n", " \\\n 4 \\\n2\n").replace("\n", "\r\n")
    yield "comment.obj", near, "\ufeff" + obj(near).replace("\nf", " # f 1 2\n  f")
    yield "triangles.obj", near, obj(near, faces=TRIANGLES)
    yield "unused.obj", near, obj(near, more="v 9 9 9\nv 1e300 0 0\n")
    yield "content.txt", near, obj(near)
    yield "ascii.ply", far, ply(far)
    yield "float.ply", far, ply(far, x="float")  # by text digits are kept, whatever the type
    yield "crlf.ply", near, ply(near).replace("\n", "\r\n")
    yield "extra.ply", near, ply(near, extra=True)
    yield "first.ply", near, ply(near, faces_first=True, words="vertex_index")
    for end in "little", "big":
        yield end + ".ply", far, ply(far, "binary_%s_endian" % end)
        yield end + "-extra.ply", near, ply(near, "binary_%s_endian" % end, x="float32", extra=True, faces_first=end == "big")
    for n, (c, i) in enumerate((("char", "char"), ("uchar", "uchar"), ("short", "short"), ("ushort", "uint16"), ("int", "int32"),
                                ("uint", "uint"), ("int8", "uint8"), ("uint32", "int16"))):
        yield "types%d.ply" % n, near, ply(near, "binary_%s_endian" % ("little", "big")[n % 2], count=c, index=i)


def write(dir):
    with open(dir + "/list", "w") as list:
        for name, at, data in files():
            with open(os.path.join(dir, name), "wb") as f:
                f.write(data if isinstance(data, bytes) else data.encode())
            side = [at[0] + 0.5 * S, at[1] + S + 0.15, at[2] + 0.5 * S]  # 0.05 m off its north side
            json.dump({"dt": 1e-3, "walls": [{"mesh": {"file": name}}], "bodies": [{"x": side, "radius": 0.1}]},
                      open("%s/%s.wall.json" % (dir, name), "w"))
            json.dump({"dt": 1e-3, "shapes": {"it": {"mesh": {"file": name}}},
                       "bodies": [{"x": [0, 0, 0], "shape": "it", "density": 1}]},
                      open("%s/%s.grain.json" % (dir, name), "w"))
            print(name, *at, file=list)


def judge(dir):
    import h5py, numpy as np
    for line in open(dir + "/list"):
        name, *at = line.split()
        at = np.array([float(a) for a in at])
        single = name in ("binary.stl", "solid.stl", "named.dat", "wrong.obj", "little-extra.ply", "big-extra.ply")
        eps = 1e-6 if single else 2e-9
        f = h5py.File("%s/%s.wall.h5" % (dir, name))
        v, e = f["particles/boundary/mesh/vertex"][:] - at, f["particles/boundary/mesh/element"][:]
        grain = h5py.File("%s/%s.grain.h5" % (dir, name))
        gap = h5py.File("%s/%s.gap.h5" % (dir, name))["contacts/gap"][:].min()
        a, b, c = v[e[:, 0]], v[e[:, 1]], v[e[:, 2]]
        cross = np.cross(b - a, c - a)
        on = [tuple(np.round(w, 3)) for w in np.round(v / S)]
        sides = sorted(tuple(np.round(n / np.linalg.norm(n)).astype(int)) for n in cross)
        good = [
            ("eight corners", len(v) == 8 and np.abs(v / S - np.round(v / S)).max() * S < eps and len(set(on)) == 8),
            ("twelve triangles", len(e) == 12 and len({tuple(sorted(t)) for t in e.tolist()}) == 12),
            ("its area", abs(np.linalg.norm(cross, axis=1).sum() / 2 - 6 * S * S) < 10 * eps),
            ("its volume", abs((a * cross).sum() / 6 - S ** 3) < 10 * eps),
            ("two triangles a side, outward", sides == sorted(2 * [(0, 0, 1), (0, 0, -1), (0, 1, 0), (0, -1, 0), (1, 0, 0), (-1, 0, 0)])),
            ("the gap", abs(gap - 0.05) < eps),
            ("the mass of the grain", abs(grain["particles/all/mass"][:].ravel()[0] - 2.197) < 10 * eps),
            ("its reach", abs(grain["particles/all/radius"][:].ravel()[0] - S * 3 ** 0.5 / 2) < eps),
        ]
        for what, is_so in good:
            if not is_so:
                print(name, "has not", what)


if __name__ == "__main__":
    {"write": write, "judge": judge}[sys.argv[1]](sys.argv[2])
