# The log of a run (nsd-step --log), slurped, as one object. --arg run SCENE_SETTINGS_METHOD[_SEED[_BOX]],
# --argjson steps: how many were asked for, --argjson frame: its last frame (nsd-info).

def total(f): map(f) | add;

($run / "_") as [$scene, $settings, $method, $seed, $box]
| ($settings / "-") as [$newton, $alpha]
| .[-1] as $last
| { run: $run, scene: $scene, example: $scene[7:8], dim: (if $scene | endswith("-2d") then 2 else 3 end),
    settings: $newton, alpha: ($alpha // null), method: $method,
    seed: ($seed // null | if . then tonumber else null end), box: ($box // null | if . then tonumber else null end),
    # the step after which a number would not be finite is not made, and ends the run
    steps: length, asked: $steps, diverged: (length < $steps),
    # without restitution nothing gets faster than it was thrown or fell
    blew_up: ($frame.max_speed > 1.5 + 9.81 * $frame.time), max_speed: $frame.max_speed }
+ ($last | { contacts, sweeps, eps_glob, motion, proj, bipotential, penetration,
             max_penetration, max_penetration_true })
+ { missed: map(select(.converged | not)) | length,
    most_sweeps: (map(.sweeps) | max), total_sweeps: total(.sweeps),
    contact_sweeps: total(.contacts * .sweeps),
    newton: total(.newton), safeguarded: total(.safeguarded), gave_up: total(.gave_up) }
