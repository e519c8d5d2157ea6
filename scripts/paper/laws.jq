# A scene of balls or discs that touch the floor, each with a velocity of its own and none with
# another: as many one-contact problems. --arg law signorini|coulomb|coulombcone.

def scene($dim; $bodies):
    { dim: $dim, dt: 1e-4, gravity: (if $dim == 2 then [0, 0] else [0, 0, 0] end), mu: 0.7,
      bodies: [$bodies | to_entries[] | { radius: 1e-3, v: .value,
          x: [(.key * 3e-3), (if $dim == 2 then 1e-3 else 0 end), 1e-3][:$dim] }],
      walls: [{ point: [0, 0, 0][:$dim],
                normal: (if $dim == 2 then [0, 1] else [0, 0, 1] end) }] };

def span($n; $a; $b): range($n) | $a + ($b - $a) * . / ($n - 1);

if $law == "signorini" then scene(2; [span(21; -0.1; 0.1) | [0, .]])
elif $law == "coulomb" then scene(2; [span(41; -0.4; 0.4) | [., -0.1]])
else scene(3; [span(6; 0.02; 0.12) as $h | (0, 0.05, 0.15, 0.2, 0.3, 0.6) as $a | range(16) * 0.3927
               | [$a * cos, $a * sin, -$h]])
end
