#!/usr/bin/env bash
# the page has the frames, and curves with units; the first frames are empty, the last has all grains; a picture
sed -n 's/.*id="meta">\(.*\)<\/script>/\1/p' page.html >meta.json
jq -e '.frames[0].n == 0 and .frames[-1].n == 320 and .curves["energy.kinetic"].unit == "J" and .curves["temperature.velocity.z"].unit == "m/s"' meta.json &&
    [ -s pour.png ]
