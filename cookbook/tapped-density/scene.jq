# jq -n -f scene.jq --argjson grain 3 --argjson dt 5e-4 --argjson taps 25 --argjson period 0.08 --arg surfaces ""
def mm: . * 1e-3;
def r: { gaussian: { mean: (0.61 | mm * $grain), sd: (0.042 | mm * $grain), min: (0.52 | mm * $grain), max: (0.75 | mm * $grain) } };
# A tap: the tube rises by 1 mm in the last part of the period, and falls freely, which takes sqrt(2 mm/g) = 14.3 ms.
def tap: range($taps) as $k | (0.2 + ($k + 1) * $period) as $stop | [$stop - 0.035, 0], [$stop - 0.0143, 1e-3],
    (range(1; 6) as $i | [$stop - 0.0143 * (1 - $i / 5), 1e-3 * (1 - $i * $i / 25)]);
def taps: { drives: [{ along: [0, 0, 1], table: [[0, 0], tap] }] };
{ title: "A tube that is tapped",
  dt: $dt, density: 1580, mu: 0.561, rolling: { mu_r_ratio: 0.293 }, e_n: 0.3, seed: 1,
  walls: (if $surfaces == "" then
      [{ name: "bottom", disc: { center: [0, 0, 0], normal: [0, 0, 1], radius: (13 | mm) } } + taps,
       { name: "tube", cylinder: { point: [0, 0, 0], axis: [0, 0, 1], radius: (13 | mm), length: (105 | mm) } } + taps]
    else [{ name: "tube", mesh: { file: ($surfaces + "/GranuPack/tube.stl"), at: [0, 0, (-5 | mm)] } } + taps] end),
  bodies: [{ count: (16000 / ($grain * $grain * $grain) | round), radius: r,
             box: { x: [-0.009, 0.009], y: [-0.009, 0.009], z: [0, null] } }] }
