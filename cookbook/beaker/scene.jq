# jq -n -f scene.jq --argjson grain 3 --argjson dt 3e-4 --arg surfaces ""
def mm: . * 1e-3;
def r: { gaussian: { mean: (0.61 | mm * $grain), sd: (0.042 | mm * $grain), min: (0.52 | mm * $grain), max: (0.75 | mm * $grain) } };
{ title: "A beaker that is filled over its rim, and struck off",
  dt: $dt, density: 1580, mu: 0.561, rolling: { mu_r_ratio: 0.293 }, e_n: 0.3, seed: 1,
  walls: (if $surfaces == "" then
      [{ name: "bottom", disc: { center: [0, 0, 0], normal: [0, 0, 1], radius: (20 | mm) } },
       { name: "beaker", cylinder: { point: [0, 0, 0], axis: [0, 0, 1], radius: (20 | mm), length: (55 | mm), side: "both" } }]
    else [{ name: "beaker", mesh: { file: ($surfaces + "/GranuBeaker/beaker.stl"), scale: 1e-3 } }] end),
  bodies: [{ count: (49000 / ($grain * $grain * $grain) | round), radius: r,
             box: { x: [-0.0138, 0.0138], y: [-0.0138, 0.0138], z: [0, null] } }],
  remove: [{ below: { point: [0, 0, (-20 | mm)], normal: [0, 0, 1] } },
           { inside: { z: [(55 | mm), null] }, from: 0.5 }] }
