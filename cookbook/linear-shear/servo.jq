# nsd-step asks before each step: the head descends with a speed that is proportional to the load that is missing, N.
foreach inputs as $x ({ f: 0 }; { f: (0.9 * .f + 0.1 * ([$x.walls[].force[2] // 0] | add)) };
    { walls: { head: { velocity: [0, 0, ([[(.f / $load - 1) * 0.05, -0.05] | max, 0.05] | min)] } } })
