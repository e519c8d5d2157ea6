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
