# small.sh: scenes in small steps, for tests/whole/small_*.t, after tap.sh: what they begin with, and what they end with.
# shellcheck shell=bash disable=SC2154 # tap.sh sets tmp
scene() # MEMBERS OF THE SCENE: into $tmp/in.h5
{
    jq -n "{ $1 }" | nsd-gen - >"$tmp/in.h5"
}
small() # STEPS [OPTION ...]: the last frame of them is in $tmp/out.h5
{
    nsd-step --small-steps 0.01 -n "$1" --every "$1" "${@:2}" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
}
small_alone() # STEPS [OPTION ...]: likewise, and no step is made at once
{
    small "$@" && ! grep -E "at once|no small steps" "$tmp/err"
}
last() # JQ PROGRAM: of the summary of the last frame
{
    nsd-info --last -l "$tmp/out.h5" | jq -c "select(.kinetic_energy != null) | $1"
}
body() # JQ PROGRAM [ID]: of a body, the first one
{
    nsd-info --last -p "$tmp/out.h5" | jq -c "select(.id == ${2:-0}) | $1"
}
near() # VALUE WANTED ERROR: jq's numbers
{
    jq -en "(($1) - ($2) | fabs) <= $3" >"$tmp/near"
}
same_bytes() # STEPS [OPTION ...]: of bodies, by two and three threads, two and four lanes, and in two runs
{
    local half=$(($1 / 2)) one
    run() { nsd-step --small-steps 0.01 "$@" 2>"$tmp/err"; }
    frame() { nsd-info --last -p | sha256sum; }
    one=$(run -n "$1" --every "$1" "${@:2}" "$tmp/in.h5" | frame)
    [ "$one" = "$(run -j 2 -n "$1" --every "$1" "${@:2}" "$tmp/in.h5" | frame)" ] &&
        [ "$one" = "$(run -j 3 -n "$1" --every "$1" "${@:2}" "$tmp/in.h5" | frame)" ] &&
        [ "$one" = "$(NSD_LANES=2 run -n "$1" --every "$1" "${@:2}" "$tmp/in.h5" | frame)" ] &&
        [ "$one" = "$(NSD_LANES=4 run -n "$1" --every "$1" "${@:2}" "$tmp/in.h5" | frame)" ] &&
        [ "$one" = "$(run -n $half --every $half "${@:2}" "$tmp/in.h5" |
            run -n $(($1 - half)) --every $(($1 - half)) "${@:2}" | frame)" ]
}
# m (v - v^-) = m g dt + the reactions of contacts, of each body and each step, over the largest reaction
newton() # GRAVITY, of out.h5
{
    nsd-info -p -c "$tmp/out.h5" | jq -es --argjson g "$1" 'def plus($x; $s): [., $x] | transpose | map((.[0] // 0) + $s * .[1]);
        group_by(.step) | map(select(.[0].step)) | [range(1; length) as $k | (.[$k - 1:$k + 1] | map(map(select(.id != null)))) as [$old, $new] |
        map(.[] | select(.body)) as $all | [$all[] | select(.step == $new[0].step)] as $c |
        (reduce $c[] as $c ({ most: 0 }; ([range(3) as $i | $c.r[0] * $c.n[$i] + $c.r[1] * $c.t1[$i] + $c.r[2] * $c.t2[$i]]) as $r |
            .most = ([.most, $c.r[0]] | max) | .["\($c.body[0])"] |= plus($r; -1) | .["\($c.body[1])"] |= plus($r; 1))) as $f | select($f.most > 0) |
        [range($new | length) as $i | $new[$i] | [.v, $old[$i].v, $f["\(.id)"] // [0, 0, 0], $g] | transpose[] as $x |
            $new[$i].mass * ($x[0] - $x[1] - $x[3]) - $x[2] | fabs] | max / $f.most] | length > 1 and max < 1e-9' >"$tmp/newton"
}
