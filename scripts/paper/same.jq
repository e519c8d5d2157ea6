# The same contact problems solved by every method, as TSV: medians and ranges over the problems. "gain": SBP's
# penetration of the motion over this method's on the same problem. Slurped: same.json.
include "stats";

. as $all
| [ "scene", "method", "problems", "contacts", "sweeps", "eps_glob", "penetration", "penetration_true", "gain" ],
  ( ["example2", "example2-2d", "example3", "example3-2d"][] as $scene
    | ["sbp", "sal", "ebp", "eal", "exact"][] as $method
    | [$all[] | select(.scene == $scene and .method == $method)]
    | [ $scene, $method, length, ([.[].contacts] | stat | counts), ([.[].sweeps] | stat | counts),
        ([.[].eps_glob] | stat | spread), ([.[].max_penetration] | stat | spread),
        ([.[].max_penetration_true] | stat | spread),
        ([.[] as $one | $all[] | select(.scene == $scene and .method == "sbp" and .pile == $one.pile)
          | select($one.max_penetration_true > 0) | .max_penetration_true / $one.max_penetration_true] | stat | spread) ] )
| @tsv
