# jq -n -f scene.jq --argjson grain 3 --argjson dt 5e-4 --argjson rpm 15 --arg surfaces ""
def mm: . * 1e-3;
def r: { gaussian: { mean: (0.61 | mm * $grain), sd: (0.042 | mm * $grain), min: (0.52 | mm * $grain), max: (0.75 | mm * $grain) } };
def turn: { drives: [{ about: [0, 0, 0], axis: [0, 1, 0], speed: ($rpm * 0.104719755) }] };
{ title: "A drum of 84 mm by 20 mm at \($rpm) turns a minute",
  dt: $dt, density: 1580, mu: 0.561, rolling: { mu_r_ratio: 0.293 }, e_n: 0.3, seed: 1,
  walls: (if $surfaces == "" then [{ name: "drum", cylinder: { point: [0, 0, 0], axis: [0, 1, 0], radius: (42 | mm) } } + turn]
    else [{ name: "drum", mesh: { file: ($surfaces + "/GranuDrum/rotating_drum_mm.stl"), scale: 1e-3 } } + turn] end +
    [{ name: "back", point: [0, 0, 0], normal: [0, 1, 0] } + turn, { name: "front", point: [0, (20 | mm), 0], normal: [0, -1, 0] } + turn]),
  bodies: [{ random: { count: (29200 / ($grain * $grain * $grain) | round) }, radius: r,
             box: { x: [(-35 | mm), (35 | mm)], y: [0, (20 | mm)], z: [(-22 | mm), (22 | mm)] } }] }
