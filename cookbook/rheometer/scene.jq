# jq -n -f scene.jq --argjson grain 3.4 --argjson dt 5e-4 --argjson fill 20 --argjson tip 0.5 --arg surfaces "" --arg settled ""
# fill: depth of the powder, mm; tip: speed of the ends of the blade, m/s, which descends along a helix of 5 degrees
# settled: the document of the powder, once it is at rest; without it the scene is that of the filling
def mm: . * 1e-3;
def r: { gaussian: { mean: (0.61 | mm * $grain), sd: (0.042 | mm * $grain), min: (0.52 | mm * $grain), max: (0.75 | mm * $grain) } };
(1.25 * $fill + 12 | mm) as $top | # of the middle of the blade at the start
(($top - (9 + 3 * $grain | mm)) / ($tip * 0.0872)) as $last | # s that it takes to 10 mm above the bottom, of coarse grains more
def down: { drives: [{ about: [0, 0, 0], axis: [0, 0, 1], speed: ($tip / 0.024), from: 0, until: $last },
                     { along: [0, 0, -1], speed: ($tip * 0.0872), from: 0, until: $last }] };
def stl($name): { name: $name, mesh: { file: ($surfaces + "/FT4/" + {vessel: "box.stl", blade: "blade.stl"}[$name]), scale: 1e-3 } };
# The blade is 48 mm wide and 10 mm across, and twisted: strips from radius a to b (mm) with an angle to the horizontal.
def strip($side): [3.5, 8, 10], [8, 12, 20], [12, 16, 37], [16, 20, 50], [20, 24, 61] | .[0] as $a | .[1] as $b | (.[2] / 57.29578) as $t |
    { name: "blade", rectangle: { center: [$side * ($a + $b) / 2 * 1e-3, 0, $top], normal: [0, -$side * ($t | sin), ($t | cos)],
                                  along: [1, 0, 0], sides: [($b - $a | mm), (10 | mm)] } } + down;
{ title: "A powder rheometer: a twisted blade descends through the powder",
  dt: $dt, density: 1580, mu: 0.561, rolling: { mu_r_ratio: 0.293 }, e_n: 0.3, seed: 1,
  walls: ((if $surfaces != "" then [stl("vessel")] else
      [{ name: "vessel", cylinder: { point: [0, 0, (2 | mm)], axis: [0, 0, 1], radius: (25 | mm), length: (100 | mm) } },
       { name: "bottom", disc: { center: [0, 0, (2 | mm)], normal: [0, 0, 1], radius: (25 | mm) } }] end) +
    (if $settled == "" then [] elif $surfaces != "" then [stl("blade") + down | .mesh.at = [0, 0, $top + 0.0066]] else
      [{ name: "blade", cylinder: { point: [0, 0, $top], axis: [0, 0, 1], radius: (3.5 | mm), length: (90 | mm), side: "outside" } } + down,
       { name: "blade", disc: { center: [0, 0, $top], normal: [0, 0, -1], radius: (3.5 | mm) } } + down, strip(1), strip(-1)] end)),
  bodies: (if $settled != "" then [{ document: $settled, at_rest: true }] else
    [{ random: { count: (1200 * $fill / ($grain * $grain * $grain) | round) }, radius: r,
       box: { x: [-0.0175, 0.0175], y: [-0.0175, 0.0175], z: [(2 | mm), (2 * $fill + 2 | mm)] } }] end) }
