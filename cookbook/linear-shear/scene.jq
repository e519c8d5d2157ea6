# jq -n -f scene.jq --argjson grain 1.8 --argjson size 0.4 --argjson dt 4e-4 --argjson speed 0.045
# size: of the cell, 1 is that of the laboratory; speed: of the box, m/s
def mm: . * 1e-3;
def r: { gaussian: { mean: (0.61 | mm * $grain), sd: (0.042 | mm * $grain), min: (0.52 | mm * $grain), max: (0.75 | mm * $grain) } };
def slide: { name: "box", drives: [{ along: [1, 0, 0], speed: $speed, from: 0.15 }] };
($size | mm) as $s | (52 * $s) as $deep | # of the powder at the start
{ title: "A linear shear cell, periodic along its motion: the box slides under a head with two vanes",
  dt: $dt, density: 1580, mu: 0.561, rolling: { mu_r_ratio: 0.293 }, e_n: 0.3, seed: 1,
  materials: { rough: {} }, pairs: [{ pair: ["ball", "rough"], mu: 5, rolling: { mu_r_ratio: 1 } }],
  cell: { lengths: [46 * $s, 50 * $s, 100 * $s], repeats: [true, false, false] },
  bodies: [{ random: { count: (56000 * $size * $size * $size / ($grain * $grain * $grain) | round) }, radius: r,
             box: { x: [0, 46 * $s], y: [0, 50 * $s], z: [0, $deep] } }],
  walls: [slide + { point: [0, 0, 0], normal: [0, 0, 1], material: "rough" },
          slide + { point: [0, 0, 0], normal: [0, 1, 0] }, slide + { point: [0, 50 * $s, 0], normal: [0, -1, 0] },
          { name: "head", point: [0, 0, ($deep + 6 * $s)], normal: [0, 0, -1] },
          (11.5, 34.5 | { name: "head", rectangle: { center: [. * $s, 25 * $s, ($deep + 4 * $s)], normal: [1, 0, 0], along: [0, 1, 0], sides: [48 * $s, 4 * $s] } })] }
