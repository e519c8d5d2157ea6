# Times, slurped: "run once least": CPU seconds of the run itself, and the least of the rounds: what other
# work on the machine adds is never less than nothing.

map(.run |= . / "_")
| group_by(.run[:3])[]
| [ (.[0].run[:3] | join("_")),
    (map(select(.run[3] == "run").seconds)[0]),
    (map(select(.run[3] != "run").seconds) | min) ]
| @tsv
