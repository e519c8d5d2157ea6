# A scene of $n balls of the paper's sizes that settle in a box as wide as the pile becomes high
(({ "500": 0.003564814875007254, "2000": 0.0056587908826584, "8000": 0.0089827706 }[$n | tostring]) // 0.0089827706 * pow($n / 8000; 1 / 3)) as $a # m: as the cube root of n
| { title: "pile \($n)", dt: 0.0001, density: 2500, mu: 0.3, seed: 3,
    bodies: [{ count: $n, radius: { uniform: [0.00044, 0.0005] }, spacing: 1, jitter: 1, v: [0, 0, -0.1],
               box: { x: [-$a, $a], y: [-$a, $a], z: [0, null] } }],
    walls: [{ box: { x: [-$a, $a], y: [-$a, $a], z: [0, null] } }] }
