# Example 1 eight times side by side, thrown at 1.5 to 1.57 m/s: rolling begins at eight places of a step.
.bodies[0] as $ball
| .dim as $d
| .dt = $dt
| .bodies = [range(8) as $k | $ball | .v[0] += 0.01 * $k
             | if $d == 3 then .x[1] = 0.02 * $k else .x[0] = 0.5 * $k end]
