# Example 1 against its closed solution: sliding v = v0 - mu g t until the ball rolls, then v = c v0,
# c = 5/7 of a ball, 2/3 of a disc. Lines of nsd-info --bodies (errors of x and v), then of
# nsd-info --contacts of another run, every step (when rolling begins). --arg scene, method;
# --argjson dt.

def mu_g: 0.7 * 9.81;
def c: if $scene == "example1" then 5 / 7 else 2 / 3 end;
def v0($k): 1.5 + 0.01 * $k;
def rolls($k): (1 - c) * v0($k) / mu_g;                      # s
def v($k; $t): if $t < rolls($k) then v0($k) - mu_g * $t else c * v0($k) end;
def x($k; $t): if $t < rolls($k) then v0($k) * $t - mu_g * $t * $t / 2
               else rolls($k) as $s | v0($k) * $s - mu_g * $s * $s / 2 + c * v0($k) * ($t - $s) end;
def greatest($a; $b): if $a > $b then $a else $b end;

reduce inputs as $l ({ x: 0, v: 0, since: {} };
    if $l.status == null then
        $l.id as $k | ($l.step * $dt) as $t
        | (if $scene == "example1" then 0 else 0.5 * $k end) as $from
        | .x = greatest(.x; $l.position[0] - $from - x($k; $t) | fabs)
        | .v = greatest(.v; $l.velocity[0] - v($k; $t) | fabs)
    elif $l.status == "stick" and .since["\($l.body[1])"] == null then
        .since["\($l.body[1])"] = $l.step * $dt - rolls($l.body[1])
    else . end)
| [ (if $scene == "example1" then 3 else 2 end), $method, $dt, .x, .v, (.since | [.[]] | max) ] | @tsv
