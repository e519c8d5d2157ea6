# A run's summary, its CPU seconds, and how many of its last contacts (nsd-info --contacts, slurped) have bonds that are whole,
# damaged and broken. --slurpfile run, log
$run[0] + { seconds: ($log | map(.seconds) | add),
  whole: (map(select(.beta == 1)) | length),
  damaged: (map(select(.beta > 0 and .beta < 1)) | length),
  broken: (map(select((.beta // 0) == 0)) | length) }
