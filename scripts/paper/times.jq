# Times, slurped: "run once median": CPU seconds of the run itself, and the median of the rounds.

map(.run |= . / "_")
| group_by(.run[:3])[]
| [ (.[0].run[:3] | join("_")),
    (map(select(.run[3] == "run").seconds)[0]),
    (map(select(.run[3] != "run").seconds) | sort | .[length / 2 | floor]) ]
| @tsv
