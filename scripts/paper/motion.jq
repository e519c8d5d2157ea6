# How fast the bodies of a picture are, as TSV. Slurped: the frame's line of nsd-info, then its bodies'.
# --arg scene, picture.
include "stats";

[ $scene, $picture, .[0].step, .[0].time, .[0].max_speed,
  (.[1:] | map(.velocity | map(. * .) | add | sqrt) | median) ]
| @tsv
