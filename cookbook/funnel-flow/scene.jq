# jq -n -f scene.jq --argjson grain 2 --argjson dt 4e-4 --argjson orifice 20 --argjson tube 14 --arg surfaces ""
# orifice: its diameter, mm; tube: its radius, mm; the fill is 1.1 times as deep as the tube is wide
def mm: . * 1e-3;
def r: { gaussian: { mean: (0.61 | mm * $grain), sd: (0.042 | mm * $grain), min: (0.52 | mm * $grain), max: (0.75 | mm * $grain) } };
($tube * 0.69 | mm) as $half | # of the square in which the grains start
{ title: "A tube over a plate with an orifice",
  dt: $dt, density: 1580, mu: 0.561, rolling: { mu_r_ratio: 0.293 }, e_n: 0.3, seed: 1,
  walls: ((if $surfaces == "" then
      [{ name: "tube", cylinder: { point: [0, 0, (5 | mm)], axis: [0, 0, 1], radius: ($tube | mm), length: (200 | mm) } },
       { name: "plate", disc: { center: [0, 0, (5 | mm)], normal: [0, 0, 1], radius: ($tube | mm), hole: ($orifice / 2 | mm) } },
       { name: "orifice", cylinder: { point: [0, 0, 0], axis: [0, 0, 1], radius: ($orifice / 2 | mm), length: (5 | mm) } }]
    else
      [{ name: "tube", mesh: { file: ($surfaces + "/GranuFlow/Tube.stl"), scale: 1e-3 } },
       { name: "plate", mesh: { file: ($surfaces + "/GranuFlow/Plate\($orifice)mm.stl"), scale: 1e-3 } }]
    end) + [{ name: "gate", disc: { center: [0, 0, (5 | mm)], normal: [0, 0, 1], radius: ($orifice / 2 | mm) }, until: 0.15 }]),
  bodies: [{ count: (4.2 * $tube * $tube * $tube / ($grain * $grain * $grain) | round), radius: r,
             box: { x: [-$half, $half], y: [-$half, $half], z: [(5.1 | mm), null] } }],
  remove: [{ below: { point: [0, 0, (-20 | mm)], normal: [0, 0, 1] } }] }
