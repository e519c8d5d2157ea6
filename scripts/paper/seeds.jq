# Example 2, run by run, as TSV. Slurped: the runs.

[ "dim", "settings", "method", "seed", "contacts", "sweeps", "eps_glob", "penetration", "penetration_true",
  "missed", "steps", "total_sweeps" ],
( map(select(.example == "2" and .box == null)) | sort_by(-.dim, .settings, ({ sbp: 1, sal: 2, ebp: 3, eal: 4, exact: 5 }[.method]), .seed)[]
  | [ .dim, .settings, .method, .seed, .contacts, .sweeps, .eps_glob, .max_penetration, .max_penetration_true,
      .missed, .steps, .total_sweeps ] )
| @tsv
