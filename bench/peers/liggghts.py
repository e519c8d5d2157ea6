"""A run of LIGGGHTS from an nsd scene and the balls of its start: the data file, the surfaces, the input."""
import math
import os

NU = 0.3  # Poisson's ratio
RAYLEIGH = 0.2  # dt over Rayleigh's time


def time_step(balls, modulus):
    """0.2 of the shortest Rayleigh time, rounded down to two digits."""
    shear = modulus / (2 * (1 + NU))
    density = balls["mass"] / (4 / 3 * math.pi * balls["radius"] ** 3)
    shortest = min(math.pi * r * math.sqrt(rho / shear) for r, rho in zip(balls["radius"], density)) / (0.1631 * NU + 0.8766)
    dt = RAYLEIGH * shortest
    unit = 10.0 ** (math.floor(math.log10(dt)) - 1)
    return math.floor(dt / unit) * unit


def pair(scene, a, b):
    """Friction and restitution of two kinds."""
    for p in scene.get("pairs", []):
        if sorted(p["pair"]) == sorted((a, b)):
            return p["mu"], p["e_n"]
    return scene.get("mu", 0), scene.get("e_n", 0)


def ring(radius, height, sides=96):
    return [(radius * math.cos(2 * math.pi * k / sides), radius * math.sin(2 * math.pi * k / sides), height)
            for k in range(sides)]


def band(lower, upper):
    """Triangles between two rings."""
    out = []
    for k in range(len(lower)):
        n = (k + 1) % len(lower)
        out += [(lower[k], lower[n], upper[n]), (lower[k], upper[n], upper[k])]
    return out


def triangles(wall, reach):
    """Those of a wall that LIGGGHTS has no primitive for; of a rotating plane a square of half the edge reach."""
    if "disc" in wall:
        disc, height = wall["disc"], wall["disc"]["center"][2]
        return band(ring(disc["hole"], height), ring(disc["radius"], height))
    if "cone" in wall:
        cone, height = wall["cone"], wall["cone"]["point"][2]
        return band(ring(cone["radii"][0], height), ring(cone["radii"][1], height + cone["length"]))
    a = wall["point"][0]
    corner = [(a, s * reach, t * reach) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return [(corner[0], corner[1], corner[2]), (corner[0], corner[2], corner[3])]


def write_stl(path, faces):
    with open(path, "w") as f:
        f.write("solid wall\n")
        for face in faces:
            u, v = ([face[k][c] - face[0][c] for c in range(3)] for k in (1, 2))
            n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            size = math.sqrt(sum(c * c for c in n))
            f.write("facet normal %g %g %g\nouter loop\n" % tuple(c / size for c in n))
            f.writelines("vertex %.9g %.9g %.9g\n" % p for p in face)
            f.write("endloop\nendfacet\n")
        f.write("endsolid wall\n")


def walls(scene, folder, kind, radius, box):
    """Lines of the input. box: the bounds, widened where a surface reaches beyond."""
    lines, meshes = [], []
    model = "model hertz tangential history"

    def primitive(name, what):
        lines.append(f"fix {name} all wall/gran {model} primitive type {kind} {what}")

    for k, wall in enumerate(scene["walls"]):
        drive = wall.get("drives", [None])[0]
        if "box" in wall:
            for axis, ends in wall["box"].items():
                for n, end in enumerate(ends):
                    if end is not None:
                        primitive(f"w{k}{axis}{n}", f"{axis}plane {end:.9g}")
        elif "cylinder" in wall:
            axis = "xyz"[wall["cylinder"]["axis"].index(1)]
            turn = f" shear y {drive['speed']:.9g}" if drive else ""
            assert not drive or axis == "x"
            primitive(f"w{k}", f"{axis}cylinder {wall['cylinder']['radius']:.9g} 0 0{turn}")
        elif "point" in wall and not drive:
            axis = next(a for a in range(3) if wall["normal"][a])
            primitive(f"w{k}", f"{'xyz'[axis]}plane {wall['point'][axis]:.9g}")
        else:
            faces = triangles(wall, 1.2 * radius)
            write_stl(os.path.join(folder, f"wall{k}.stl"), faces)
            for face in faces:
                for p in face:
                    for c in range(3):
                        box[c][0], box[c][1] = min(box[c][0], p[c] - 1e-3), max(box[c][1], p[c] + 1e-3)
            turn = f" surface_ang_vel origin 0. 0. 0. axis 1. 0. 0. omega {drive['speed']:.9g}" if drive else ""
            lines.append(f"fix m{k} all mesh/surface file wall{k}.stl type {kind}{turn}")
            meshes.append(f"m{k}")
    if meshes:
        lines.append(f"fix meshes all wall/gran {model} mesh n_meshes {len(meshes)} meshes {' '.join(meshes)}")
    return lines


def write(folder, scene, balls, modulus, span, frames, velocities, processes, skin=None):
    """data, in, wall*.stl into the folder; gives dt and the steps between frames."""
    kinds = sorted(set(balls["kind"])) + ["wall"]
    type_of = {name: k + 1 for k, name in enumerate(kinds)}
    dt = time_step(balls, modulus)
    every = max(1, round(span / frames / dt))
    widest = 2 * balls["radius"].max()
    small = 2 * balls["radius"].min()
    usual = (widest + small) / 2 if widest < 3 * small else small
    box = [[balls["x"][:, c].min() - widest, balls["x"][:, c].max() + widest] for c in range(3)]
    radius = max([w["cylinder"]["radius"] for w in scene["walls"] if "cylinder" in w], default=0)
    repeats = scene["cell"]["repeats"] if "cell" in scene else [False] * 3
    for wall in scene["walls"]:
        if "cylinder" in wall:  # balls come to all of it, except along its axis
            for c in range(3):
                if not wall["cylinder"]["axis"][c]:
                    box[c] = [min(box[c][0], -1.1 * radius), max(box[c][1], 1.1 * radius)]
        for c, name in enumerate("xyz"):
            for n, end in enumerate(wall.get("box", {}).get(name, [])):
                if end is not None:
                    box[c][n] = end + (1, -1)[1 - n] * widest
    for c in range(3):
        if repeats[c]:
            box[c] = [scene["cell"]["origin"][c], scene["cell"]["origin"][c] + scene["cell"]["lengths"][c]]
    lines = walls(scene, folder, type_of["wall"], radius, box)
    for gone in scene.get("remove", []):  # what leaves the bounds is lost
        box[2][0] = gone["below"]["point"][2]
    density = balls["mass"] / (4 / 3 * math.pi * balls["radius"] ** 3)
    with open(os.path.join(folder, "data"), "w") as f:
        f.write(f"balls\n\n{len(balls['x'])} atoms\n{len(kinds)} atom types\n")
        f.writelines(f"{low:.9g} {high:.9g} {name}lo {name}hi\n" for (low, high), name in zip(box, "xyz"))
        f.write("\nAtoms\n\n")
        for k, x in enumerate(balls["x"]):
            f.write("%d %d %.17g %.17g %.17g %.17g %.17g\n" % (k + 1, type_of[balls["kind"][k]], 2 * balls["radius"][k], density[k], *x))
        f.write("\nVelocities\n\n")
        for k, v in enumerate(balls["v"]):
            f.write("%d %.17g %.17g %.17g 0 0 0\n" % (k + 1, *v))

    def matrix(which):
        return " ".join("%g" % max(pair(scene, a, b)[which], (0, 0.06)[which]) for a in kinds for b in kinds)

    n = len(kinds)
    gravity = -scene["gravity"][2]
    with open(os.path.join(folder, "in"), "w") as f:
        f.write("\n".join([
            "atom_style granular", f"atom_modify map array sort 1000 {1.5 * usual:.6g}",
            "communicate single vel yes", "boundary " + " ".join("p" if r else "f" for r in repeats), "newton off", "units si",
            f"processors {'1 2 1' if repeats[0] else '2 1 1'}" if processes > 1 else "",
            "read_data data", f"neighbor {skin or 0.25 * usual:.6g} bin",
            # bins are as large as the largest ball needs, unless they are told
            "neigh_modify delay 0" + (f" binsize {1.5 * usual:.6g}" if widest > 3 * small else ""),
            f"fix e all property/global youngsModulus peratomtype {' '.join(['%g' % modulus] * n)}",
            f"fix nu all property/global poissonsRatio peratomtype {' '.join([str(NU)] * n)}",
            f"fix cor all property/global coefficientRestitution peratomtypepair {n} {matrix(1)}",
            f"fix mu all property/global coefficientFriction peratomtypepair {n} {matrix(0)}",
            "pair_style gran model hertz tangential history", "pair_coeff * *", f"timestep {dt:.9g}",
            f"fix g all gravity {gravity:.9g} vector 0 0 -1", *lines, "fix motion all nve/sphere",
            "thermo_style custom step atoms cpu", f"thermo {max(1, every // 5)}", "thermo_modify lost ignore norm no flush yes",
            f"dump d all custom {every} dump id x y z{' vx vy vz' if velocities else ''}", "dump_modify d format \"%d" + " %.7g" * (6 if velocities else 3) + "\"",
            f"run {round(span / dt)}", ""]))
    return dt, every
