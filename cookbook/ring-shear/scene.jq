# jq -n -f scene.jq --argjson grain 1.8 --argjson size 0.2 --argjson dt 4e-4 --argjson omega 3 --arg surfaces "" --argjson cell '{"box": "Schulze-Normal/box.stl", "head": "Schulze-Normal/head_full.stl", "inner": 50, "outer": 100, "deep": 40}'
# size: of the cell, 1 is that of the laboratory; omega: speed of the trough, rad/s
def mm: . * 1e-3;
def r: { gaussian: { mean: (0.61 | mm * $grain), sd: (0.042 | mm * $grain), min: (0.52 | mm * $grain), max: (0.75 | mm * $grain) } };
def turn: { drives: [{ about: [0, 0, 0], axis: [0, 0, 1], speed: $omega, from: 0.15 }] };
($size | mm) as $s | (1.3 * $cell.deep * $s) as $deep | # of the powder at the start
{ title: "A ring shear cell: the trough turns under a head with vanes",
  dt: $dt, density: 1580, mu: 0.561, rolling: { mu_r_ratio: 0.293 }, e_n: 0.3, seed: 1,
  bodies: [{ random: { count: (1.9 * $cell.deep * ($cell.outer * $cell.outer - $cell.inner * $cell.inner) * $size * $size * $size / ($grain * $grain * $grain) | round) }, radius: r,
             box: { x: [-$cell.outer * $s, $cell.outer * $s], y: [-$cell.outer * $s, $cell.outer * $s], z: [0, $deep] } }],
  walls: (if $surfaces != "" then
      [{ name: "trough", mesh: { file: ($surfaces + "/" + $cell.box), scale: $s } } + turn,
       { name: "head", mesh: { file: ($surfaces + "/" + $cell.head), scale: $s, at: [0, 0, ($deep + 6 * $s)] } }]
    else
      [{ name: "trough", disc: { center: [0, 0, 0], normal: [0, 0, 1], radius: ($cell.outer * $s), hole: ($cell.inner * $s) } } + turn,
       { name: "trough", cylinder: { point: [0, 0, 0], axis: [0, 0, 1], radius: ($cell.outer * $s), length: (2 * $cell.deep * $s) } } + turn,
       (select($cell.inner > 0) | { name: "trough", cylinder: { point: [0, 0, 0], axis: [0, 0, 1], radius: ($cell.inner * $s), length: (2 * $cell.deep * $s), side: "outside" } } + turn),
       { name: "head", mesh: { file: "head.obj", scale: $s, at: [0, 0, ($deep + 6 * $s)] } }] end) }
