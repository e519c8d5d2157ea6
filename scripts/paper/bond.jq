# A scene whose bodies are bonded wherever they touch. A bond holds $weights weights of the scene's middle ball, or disc, and
# is whole up to a hundredth of its radius: 1/2 c_n of that squared is half its energy w. --argjson weights

def middle: .bodies[0].radius | if type == "object" then .uniform | add / 2 else . end;
middle as $r | (0.01 * $r) as $reach | (.dim // 3) as $dim
| (if $dim == 2 then 2 * $r else 3.141592653589793 * $r * $r end) as $area
| (.density * 9.81 * $area * $r * (if $dim == 2 then 1.5707963267948966 else 1.3333333333333333 end)) as $weight
| ($weights * $weight / $area) as $stress
| .adhesion = { c_n: ($stress / $reach), c_t: ($stress / $reach / 2), w: ($stress * $reach), forever: true }
