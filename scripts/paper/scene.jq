# A scene with another seed, and its box another width. --arg seed, --arg box (mm); empty: the scene's own.

if $seed != "" then .seed = ($seed | tonumber) else . end
| if $box != "" then ($box | tonumber / 2000) as $half
      | .walls[0].box |= map_values(if .[1] == null then . else [-$half, $half] end)
  else . end
