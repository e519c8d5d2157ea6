# balls.jq: lines of `nsd-info --particles` as discs to draw: "u v radius 0xrrggbb", mm, far ones
# first. A ball is four discs, dark to light, shifted towards the lamp; its hue tells its number.
# Run with -s -r; --argjson n N: how many balls the hues are spread over.

def hue($h):  # 0..1 -> [r, g, b], 0..1: blue, green, yellow, red
    [1 - (($h - 0.95) / 0.55 | fabs), 1 - (($h - 0.5) / 0.5 | fabs), 1 - (($h - 0.05) / 0.5 | fabs)]
    | map(. * 1.3 | if . < 0.12 then 0.12 elif . > 1 then 1 else . end);

def rgb($c; $light): [$c[] | . * $light | if . > 1 then 1 else . end | . * 255 | floor]
    | .[0] * 65536 + .[1] * 256 + .[2];

def seen:     # turned by 0.5 rad about z, looked at from 0.25 rad above
    . as [$x, $y, $z]
    | (0.5 | cos) as $ca | (0.5 | sin) as $sa | (0.25 | cos) as $ce | (0.25 | sin) as $se
    | ($x * $ca - $y * $sa) as $u | ($x * $sa + $y * $ca) as $away
    | { u: $u, v: ($z * $ce + $away * $se), far: ($away * $ce - $z * $se) };

map({ at: (.x | seen), r: .radius, c: hue(.id / $n) })
| sort_by(-.at.far)[]
| . as $b
| ([1, 0.55], [0.86, 0.8], [0.6, 1.05], [0.25, 1.6])
| . as [$size, $light]
| [ ($b.at.u - (1 - $size) * 0.42 * $b.r) * 1e3, ($b.at.v + (1 - $size) * 0.5 * $b.r) * 1e3,
    $size * $b.r * 1e3, rgb($b.c; $light) ]
| @tsv
