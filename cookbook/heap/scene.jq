# jq -n -f scene.jq --argjson grain 2.5 --argjson dt 5e-4 --arg surfaces ""
# The powder: balls of 1.22 mm in the mean, here "grain" times as large, with the friction that fits a rotating drum.
def mm: . * 1e-3;
def r: { gaussian: { mean: (0.61 | mm * $grain), sd: (0.042 | mm * $grain), min: (0.52 | mm * $grain), max: (0.75 | mm * $grain) } };
def lift: { drives: [{ along: [0, 0, 1], speed: 0.04, from: 0.2 }] };
{ title: "A heap on a round base, from a sleeve that is lifted",
  dt: $dt, density: 1580, mu: 0.561, rolling: { mu_r_ratio: 0.293 }, e_n: 0.3, seed: 1,
  walls: (if $surfaces == "" then
      [{ name: "base", disc: { center: [0, 0, 0], normal: [0, 0, 1], radius: (20 | mm) } },
       { name: "sleeve", cylinder: { point: [0, 0, 0], axis: [0, 0, 1], radius: (20 | mm), length: (80 | mm) } } + lift]
    else
      [{ name: "base", mesh: { file: ($surfaces + "/GranuHeap/aor_bottom.stl") } },
       { name: "sleeve", mesh: { file: ($surfaces + "/GranuHeap/wall.stl") } } + lift]
    end),
  bodies: [{ count: (17000 / ($grain * $grain * $grain) | round), radius: r,
             box: { x: [-0.0138, 0.0138], y: [-0.0138, 0.0138], z: [0, null] } }],
  remove: [{ below: { point: [0, 0, (-10 | mm)], normal: [0, 0, 1] } }] }
