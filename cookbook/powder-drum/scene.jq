# jq -n -f scene.jq --argjson grain 1 --argjson dt 3e-4 --argjson rpm 45 --argjson count 29185 --argjson mu 0.561 --argjson mu_r_ratio 0.293
# The measured diameters (m) and their fractions by number, as a sieve curve: the fraction of the mass below the middle of two diameters
def sizes: [[1.05, 0.0065], [1.1, 0.0739], [1.15, 0.2625], [1.2, 0.2525], [1.25, 0.1701], [1.3, 0.1053], [1.35, 0.0689], [1.4, 0.0366], [1.45, 0.0186], [1.5, 0.0051]];
def sieve: (sizes | map(.[0] * .[0] * .[0] * .[1]) | add) as $all |
    [[1.025, 0]] + [foreach (sizes[]) as [$d, $n] (0; . + $d * $d * $d * $n / $all; [$d + 0.025, .])] | .[-1][1] = 1 | map(.[0] *= $grain * 1e-3);
def turn: { drives: [{ about: [0, 0, 0], axis: [0, 1, 0], speed: ($rpm * 0.104719755) }] };
{ title: "Microcrystalline cellulose in a drum of 84 mm by 20 mm at \($rpm) turns a minute",
  dt: $dt, density: 1580, mu: $mu, rolling: { mu_r_ratio: $mu_r_ratio }, e_n: 0.3, seed: 1,
  walls: [{ name: "drum", cylinder: { point: [0, 0, 0], axis: [0, 1, 0], radius: 0.042 } } + turn,
          { name: "back", point: [0, 0, 0], normal: [0, 1, 0] } + turn, { name: "front", point: [0, 0.02, 0], normal: [0, -1, 0] } + turn],
  bodies: [{ random: { count: ($count / ($grain * $grain * $grain) | round) }, radius: { sieve: sieve },
             box: { x: [-0.035, 0.035], y: [0, 0.02], z: [-0.022, 0.022] } }] }
