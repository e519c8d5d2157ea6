#!/usr/bin/env bash
set -euo pipefail
# GRAIN: size of the balls, 1 is that of the powder; COUNT: their number, of that size, of which fewer fill the drum alike where they are larger;
# PHOTOS: the folder with measured-15rpm.bmp.gz and measured-45rpm.bmp.gz
grain=${GRAIN:-2.4} dt=${DT:-1e-3} count=${COUNT:-26500} mu=${MU:-0.561} mu_r_ratio=${MU_R_RATIO:-0.293} until=${UNTIL:-0.9} pictures=()
read -ra step <<<"${STEP---small-steps 0.03}" # options of nsd-step
for rpm in 15 45; do
    jq -n -f scene.jq --argjson grain "$grain" --argjson dt "$dt" --argjson rpm $rpm --argjson count "$count" --argjson mu "$mu" --argjson mu_r_ratio "$mu_r_ratio" |
        nsd-gen - | nsd-step "${step[@]}" --until "$until" --every 0.01s -o "drum-$rpm.h5"
    photo=()
    if [ -n "${PHOTOS-}" ]; then
        gunzip -c "$PHOTOS/measured-${rpm}rpm.bmp.gz" >photo.bmp
        ffmpeg -nostdin -loglevel error -y -i photo.bmp -pix_fmt rgb24 "photo-$rpm.png"
        photo=(--photo "photo-$rpm.png")
        pictures+=(-i "photo-$rpm.png")
    fi
    # the frames of the last 0.2 s, inside a circle of 0.6 of the drum's area
    nsd-stat -m silhouette -s "$(jq -n "($until - 0.205) / $dt | round")": --window -0.042,0.042,-0.042,0.042 --pixels 406 --radius 0.0325332 \
        "${photo[@]}" --silhouette "silhouette-$rpm.png" "drum-$rpm.h5" | tail -n 1 |
        jq -r --argjson rpm $rpm '.silhouette | [$rpm, .area * 1e6, (.photo, .differ, .surplus, .missing | if . then . * 1e6 else "-" end)] | @tsv'
    pictures+=(-i "silhouette-$rpm.png")
done >areas.tsv
cat areas.tsv
ffmpeg -nostdin -loglevel error -y "${pictures[@]}" -filter_complex "hstack=inputs=$((${#pictures[@]} / 2))" drums.png
