#!/usr/bin/env bash
# Every example does what it claims: those of README.md, of the manuals' EXAMPLES, of the TUTORIAL of nsd-pipelines(7) and nsd-tutorial(7)
# and of each tool's --help are taken from there and run, with the files that they name. What each of
# them claims is in `claim` below; an example that is not there fails, and so does one that shows
# another output than it makes.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

repository=$PWD

# ---- what there is: a command begins with "$ ", a block of them with an empty line ----

of_readme() # fenced sh blocks, and what make does
{
    awk '/^```sh$/ { sh = 1; print ""; next } /^```$/ { sh = 0; next }
         sh && NF && !/^#/ { print "$ " $0 } /^    make / { sub(/ *#.*/, ""); print "\n$ " substr($0, 5) }' README.md
}
of_manual() # FILE SECTION: displays, their escapes undone
{
    awk -v section="$2" '
        /^\.Sh / { on = $0 == ".Sh " section; next }
        !on { next }
        /^\.Bd .*-compact/ { next } # a table
        /^\.Bd / { print ""; block = 1; next }
        /^\.Ed/ { block = 0; next }
        /^\.Dl / { print "\n" substr($0, 5); next }
        block' "$1" |
        sed -e "s/\\\\(aq/'/g" -e 's/\\(dq/"/g' -e 's/\\(ha/^/g' -e 's/\\(ti/~/g' -e 's/\\&//g' -e 's/\\e/\\/g'
}
of_help() # TOOL: what stands behind the options
{
    "$1" --help | awk '/ --version  / { on = 1; next } /^The manual/ { exit } on && NF { sub(/^ +/, ""); print "\n$ " $0 }'
}

# ---- files that examples name ----

mkdir "$tmp/stock"
ln -s "$repository/scenes" "$tmp/stock/scenes"
(
    cd "$tmp/stock"
    exec 2>/dev/null
    nsd-gen 500 >a.h5
    nsd-step --solver auto -n 1000 --every 10 --contacts a.h5 >out.h5
    nsd-step -n 10 out.h5 >more.h5
    nsd-cat --last out.h5 >packing.h5
    nsd-export -o dump.liggghts --to lammps packing.h5
    nsd-cat --frames 700 out.h5 | nsd-detect >contacts.h5
    nsd-solve contacts.h5 >solved.h5
    cp packing.h5 edited.h5
    cp "$repository/cookbook/drum/scene.json" drum.json
    { echo '# x y z r'; nsd-info -p a.h5 | jq -r '[.x[], .radius] | @tsv' | head -n 300; } >balls.txt
    nsd-step -n 1000000 -o killed.h5 a.h5 &
    for ((w = 0; w < 500; w++)); do # until there is a frame
        if nsd-info killed.h5 >/dev/null; then break; fi
        sleep 0.02
    done
    kill -9 $!
    if [ -e "$problems/KaplasTower-i1061-4.hdf5" ]; then
        ln -s "$problems/KaplasTower-i1061-4.hdf5" .
    else
        nsd-detect --fclib=local contacts.h5 | tail -c +513 >problem.hdf5
        h5copy -i problem.hdf5 -o KaplasTower-i1061-4.hdf5 -s /fclib_local -d /fclib_local
        rm problem.hdf5
    fi
) || true

# ---- claims; in the example's directory, with its output in stdout ----

frames() { nsd-info "$1" | jq -s -e "[.[] | select(.step != null).step] | $2"; }
touching() { nsd-info --last "$1" | jq -e '.contacts > 0'; }
converged() { nsd-info "$1" | jq -s -e 'map(select(.converged != null)) | length > 0 and all(.converged)'; }
bodies() { nsd-info "$1" | jq -s -e ".[0] | .bodies == $2"; }
settings() { nsd-info "$1" | jq -s -e ".[0] | $2"; } # of the document
output() { jq -s -e "$1" stdout; }                    # JSON values
table() # COLUMNS [ROWS]: numbers, and in the last row something in each
{
    awk -F'\t' -v columns="$1" -v rows="${2:-0}" '
        NF != columns || /[^0-9.eE\t+-]/ { print "line " NR ": " $0; bad = 1 }
        END { exit bad || NR == 0 || (rows && NR != rows) }' "${3:-stdout}"
}
named() # COLUMNS ROWS FILE: under names in the first line
{
    awk -F'\t' -v columns="$1" -v rows="$2" 'NF != columns { bad = 1 } END { exit bad || NR != rows }' "$3"
}
falls() { awk -F'\t' '{ e[NR] = $2 } END { exit !(NR > 9 && e[NR] < 0.05 * e[1]) }' "${1:-stdout}"; }
png() # FILE [WxH]
{
    [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] && [ "$(stat -c %s "$1")" -gt 2000 ] || return
    [ -z "${2-}" ] || [ "$(od -An -j16 -N8 -tu1 "$1" | awk '{ print $3 * 256 + $4 "x" $7 * 256 + $8 }')" = "$2" ]
}
fclib() { h5ls "$1/fclib_local/vectors/mu" | grep -q '{[1-9]'; }
statuses() { awk '$1 > 0 && $2 ~ /^(free|stick|slide)$/ { n++ } END { exit !(n > 0 && n == NR) }' stdout; }
listed() { [ "$(grep -c '<DataSet ' "$1/grains.pvd")" = "$2" ]; } # DIRECTORY N: of nsd-export, of N frames
series() { [ $(($# - 1)) = "$1" ]; } # N FILE ...

# claim COMMAND N: runs what shows that it did what it says; N is its -n. 99: nothing is claimed.
page() # FILE N: an HTML page of N frames
{
    sed -n 's/.*id="meta">\(.*\)<\/script>/\1/p' "$1" | jq -e ".frames | length == $2" && grep -q '</html>' "$1"
}
claim()
{
    case $1 in
    # README.md
    'make '*) ;; # that it has a rule: it was run with -n
    # packings
    'nsd-gen 500 > balls.h5') bodies balls.h5 500 ;;
    'nsd-gen -d 2 2000 > discs.h5') bodies discs.h5 '2000 and .dim == 2' ;;
    'nsd-gen --check scenes/'*' | jq .dt') output 'length == 1 and .[0] > 0' ;;
    'nsd-gen --keys | grep -i friction') awk -F '\t' 'NF != 7 { bad = 1 } $2 == "mu" { has = 1 } END { exit bad || !has }' stdout ;;
    'nsd-gen --schema > scene.schema.json') jq -e '."$defs"."wall-3d".properties.until' scene.schema.json ;;
    'nsd-gen --check scenes/press.json | '*) grep -qE '^pressure\s[0-9.e-]+$' stdout ;;
    'nsd-gen scenes/column.json > column.h5') bodies column.h5 '.bodies and .bodies > 100' ;;
    *'.mu = 0.5'*'{"file": "balls.txt"}'*'> rough.h5')
        bodies rough.h5 300 && settings rough.h5 '.material | all(.mu == 0.5)' && frames rough.h5 ".[-1] == $2" ;;
    *'.mu = 0.5'*'> rough.h5') bodies rough.h5 500 && settings rough.h5 '.material | all(.mu == 0.5)' ;;
    *'scenes/shear.json'*'> shear.h5') bodies shear.h5 200 ;;
    *'{file: "balls.txt"}'*'> table.h5') bodies table.h5 300 ;;
    *'nsd-gen scenes/pour.json'*'> poured.h5') frames poured.h5 ".[-1] == $2" ;;
    *'poured.h5'*'.removed[0].bodies'*) output '.[0] > 100' ;;
    *'.capillary = '*'> wet.h5') frames wet.h5 ".[-1] == $2" && settings wet.h5 '.material | all(.capillary)' ;;
    *'wet.h5'*'.balance.bond_energy'*) output '.[0] < 0' ;;
    *'nsd-gen scenes/bonded.json'*'> fallen.h5') frames fallen.h5 ".[-1] == $2" ;;
    *'fallen.h5'*'.beta > 0'*) output '.[0] > 250 and .[0] <= 303' ;;
    *'nsd-gen scenes/sieve.json'*'> settled.h5') frames settled.h5 ".[-1] == $2" ;;
    *'nsd-info --scene '*'nsd-step'*'> tilted.h5') settings tilted.h5 '.bodies > 0 and .gravity[0] == 2' && frames tilted.h5 ".[-1] == $2" ;;
    *'nsd-info --scene '*'> tilted.h5') settings tilted.h5 '.bodies > 0 and .gravity[0] >= 2' ;;
    *'nsd-step -n '*'--in-place out.h5') frames out.h5 "length > $2 and .[-1] == 1000 + $2" ;;
    # steps
    *'nsd-step'*'--every 100'*'> column.h5') touching column.h5 && converged column.h5 && frames column.h5 "length == $2 / 100" ;;
    *'nsd-step'*'--every 10 > fast.h5') touching fast.h5 && converged fast.h5 && frames fast.h5 "length == $2 / 10" ;;
    *'nsd-step'*'--protocol paper'*'> half.h5') touching half.h5 && converged half.h5 && settings half.h5 '.options.solver == "nlgs"' ;;
    *'nsd-step'*'--log run.json'*) [ "$(wc -l <run.json)" = "$2" ] && frames out.h5 "length == $2" ;;
    *'nsd-step'*'--every '*' -o out.h5') touching out.h5 && converged out.h5 ;;
    *'nsd-step -n '*'-o more.h5 out.h5') frames more.h5 "length == $2 and .[0] > 1" && touching more.h5 ;;
    *'nsd-step -n '*'| nsd-cat > '*) f=${1##* } && frames "$f" "length == $2" && settings "$f" ".frames == $2" ;;
    *'nsd-step'*'nsd-cat --last > packing.h5') touching packing.h5 && frames packing.h5 'length == 1' ;;
    *'nsd-step'*'| nsd-detect > contacts.h5') touching contacts.h5 && frames contacts.h5 "length == 1 and .[0] == $2" ;;
    *'nsd-step'*'> out.h5') touching out.h5 && converged out.h5 && frames out.h5 "length == $2" ;;
    *'--with '*'> lifted.h5') frames lifted.h5 "length == $2" && nsd-info --last -p lifted.h5 | jq -s -e '.[0].v[2] > 0 and .[1].v[2] < 0' ;;
    'nsd-step'*'--with '*'> leaning.h5') frames leaning.h5 "length == $2" && h5ls leaning.h5/nsd/outside/answer/text ;;
    # contacts
    'nsd-cat --last out.h5 | nsd-detect > contacts.h5') touching contacts.h5 && frames contacts.h5 '. == [1000]' ;;
    'nsd-cat --frames 700 out.h5 | nsd-detect > contacts.h5') touching contacts.h5 && frames contacts.h5 '. == [700]' ;;
    'nsd-info -c contacts.h5 | jq .gap') output "length > 100 and all(. <= 5e-7) and min < 0 and length == $(nsd-info --last contacts.h5 | jq .contacts)" ;;
    *'nsd-detect --gap 1e-4'*'jq .contacts' | 'nsd-info contacts.h5 | jq '*'.contacts'*) output '.[0] > 0' ;;
    'nsd-detect --fclib=local '*'> problem.h5') fclib problem.h5 ;;
    'h5dump -n contacts.h5') grep -q /contacts/frame stdout ;;
    'h5dump -d /contacts/gap contacts.h5') grep -q '(0): -' stdout ;;
    # solutions
    *'KaplasTower'*'| jq .natural') output 'length == 1 and .[0] >= 0 and .[0] <= 1e-10' ;;
    *'| nsd-solve'*'| nsd-err | jq .natural' | 'nsd-solve -m eal < contacts.h5 | nsd-err | jq .natural' | 'nsd-err solved.h5 | jq .natural')
        output 'length == 1 and .[0] > 0 and .[0] <= 1e-4' ;;
    *'| nsd-err | jq .self_stress') output 'length == 1 and .[0] > 0.001 and .[0] < 0.3' ;;
    'nsd-solve -m eal < contacts.h5 > solved.h5') converged solved.h5 ;;
    *'nsd-detect --overlap-rule keep > keep.h5') settings keep.h5 '.overlap_rule == "keep"' && touching keep.h5 ;;
    'nsd-solve --protocol paper'*'> paper.h5')
        settings paper.h5 '.options | .solver == "nlgs" and .order == "natural" and .alpha' && grep -q 'NOT CONVERGED' stderr ;;
    'for m in '*) output 'map(.[0]) == ["sbp", "sal", "ebp", "eal", "exact"] and all(.[1] <= 1e-4)' ;;
    *'-m sal --history'*'> curve.tsv') table 3 '' curve.tsv && falls curve.tsv ;;
    'nsd-solve -m sbp --history contacts.h5 | '* | 'nsd-info --history solved.h5 | '*) table 2 && falls ;;
    'nsd-solve -m ebp --history contacts.h5 > solved.h5') converged solved.h5 && nsd-info --history solved.h5 ;;
    'nsd-detect packing.h5 | nsd-solve'*'| nsd-move > '*) f=${1##* } && frames "$f" '. == [1001] or . == [801]' && touching "$f" ;;
    'nsd-step -m sal -n 1 packing.h5 > same.h5') frames same.h5 'length == 1' ;;
    'h5diff one.h5 same.h5 /particles') touching one.h5 ;;
    'nsd-move solved.h5 > next.h5') frames next.h5 'length == 1 and .[0] == 701' && touching next.h5 ;;
    *'--contacts | nsd-err | '*'[.step, .contacts, .velocity]'*)
        output "length == $2 and (map(.[1]) | max > 0) and all(.[2] <= 1)" ;;
    *'--contacts | nsd-err | '*'[.step, .velocity, .max_overlap]'*) output "length == $2 and all(.[1] <= 1) and (map(.[2]) | max > 0)" ;;
    *'--contacts | nsd-err | jq .velocity') output "length == $2 and all(. <= 1)" ;;
    'nsd-step --solver auto --contacts -n 10 out.h5 | nsd-err') output 'length == 10 and all(.contacts > 0 and .velocity <= 1)' ;;
    # what there is in documents
    *'[.step, .contacts, .sweeps, .natural, .max_penetration]'*) table 5 "$(nsd-info out.h5 | jq -s '.[0].frames')" ;;
    *'[.step, .sweeps, .natural]'*) table 3 "$(nsd-info out.h5 | jq -s '.[0].frames')" ;;
    *'.kinetic_energy'*'> energy.tsv') table 2 '' energy.tsv ;;
    'nsd-info --last -b out.h5 | '*'[.position[], .radius]'*) table 4 500 ;;
    *'nsd-info -b | '*'[.step, .velocity[0], .angular_velocity[1]]'*) # 5/7 of the first speed, and its spin
        output '.[-1][0] >= 650 and (.[-1][1] - 1.0714 | fabs < 1e-3) and (.[-1][2] - 214.29 | fabs < 0.1)' ;;
    *'.history[]'*) output 'map(.command) == ["nsd-gen", "nsd-step"]' ;;
    *'-c out.h5 | jq -r .status | '* | *'-c solved.h5 | jq -r .status | '*) statuses ;;
    *'map(.r[0]) | max / 5e-5'*) output 'length == 1 and .[0] > 0' ;;
    *'map(.sweeps) | add'*) output '.[0] > 0' ;;
    # copies
    'nsd-cat --frames 0:1000:100 out.h5 > thin.h5') frames thin.h5 '. == [range(100; 1001; 100)]' ;;
    'nsd-cat --vtk '*' out.h5 > paraview.h5') frames paraview.h5 'length == 100' && h5ls paraview.h5/VTKHDF | grep -Eq 'Points|surfaces' ;;
    *'nsd-cat --vtk all > bricks.h5') frames bricks.h5 'length == 100' && h5ls bricks.h5/VTKHDF/surfaces/Polygons | grep -q Connectivity ;;
    'nsd-gen --from dump.liggghts '*) bodies out.h5 500 && frames out.h5 'length == 1000' ;;
    'nsd-cat out.h5 more.h5 > all.h5') frames all.h5 'length == 110 and .[0] == 10 and .[-1] == 1010' ;;
    'nsd-cat --stream out.h5 > stream.h5') frames stream.h5 'length == 100' && settings stream.h5 '.frames == 1' ;;
    'nsd-cat killed.h5 > whole.h5') frames whole.h5 'length >= 1' && h5dump -n whole.h5 ;;
    'tail -c +513 edited.h5 > plain.h5') h5dump -n plain.h5 && nsd-info plain.h5 ;;
    # pictures
    *'--size 1600x1200 -o step300.png out.h5') png step300.png 1600x1200 ;;
    'nsd-'*'nsd-view'*'.png' | 'nsd-view '*'> '*.png) png "${1##* }" ;;
    'nsd-view '*"'film%04d.png' out.h5") png film0000.png 360x640 && series "$(frames out.h5 length)" film*.png ;;
    'nsd-view '*"'film%05d.png' out.h5") png film00000.png && series 10 film*.png ;;
    'nsd-step'*'| nsd-web > run.html') page run.html 100 ;;
    'nsd-web out.h5 > out.html') page out.html "$(frames out.h5 length)" ;;
    'nsd-web --every 10 '*' -o heap.html out.h5') page heap.html 10 && grep -q '<title>A heap' heap.html ;;
    'nsd-view '*'-o film.mp4 out.h5') [ -s film.mp4 ] || [ -s film-00000.png ] ;;
    *'nsd-view --network --svg > forces.svg') [ "$(grep -c '<path' forces.svg)" -gt 800 ] ;;
    # measures
    *'drum.json'*'jq .surface.angle') output 'length >= 3 and .[-1] > 15 and .[-1] < 40' ;;
    *'nsd-stat > run.jsonl') jq -s -e "length == $2 and .[-1].stress.p > 0" run.jsonl ;;
    'nsd-stat out.h5 |'*'.fraction.fraction, .energy.kinetic'*) table 3 "$(frames out.h5 length)" ;;
    'nsd-stat --last -m profile --tsv out.h5 > profile.tsv') named 24 21 profile.tsv ;;
    'nsd-stat --last -f fields.vti out.h5') grep -aq 'Name="density"' fields.vti ;;
    'nsd-stat -m mixing --tracer large --tsv out.h5 > lacey.tsv') named 11 101 lacey.tsv ;;
    'nsd-stat -m departures --box -1,1,-1,1,0.002,0.005 --tsv out.h5 > stays.tsv') awk -F'\t' '$6 < 0 || NF != 8 { bad = 1 } END { exit bad || NR < 50 }' stays.tsv ;;
    'nsd-stat --last --grains out.h5 > grains.tsv') named 21 501 grains.tsv ;;
    # files of other programs
    'nsd-'*'nsd-export -o live/') listed live "$2" ;;
    'nsd-export -o paraview/ out.h5') listed paraview "$(frames out.h5 length)" && [ -s paraview/contacts-00099.vtp ] ;;
    'nsd-export --part contacts -o '*'.vtp'*) series "$(frames out.h5 length)" forces*.vtp ;;
    'nsd-export '*'> grains.csv') [ "$(wc -l <grains.csv)" = 501 ] ;;
    'nsd-export -o out.lammpstrj out.h5') [ "$(grep -c '^ITEM: ATOMS id type x y z ' out.lammpstrj)" = "$(frames out.h5 length)" ] ;;
    *'--part surfaces -o bricks.vtp') grep -q 'NumberOfPolys="390"' bricks.vtp ;; # 65 bricks of six faces
    'nsd-export --last -o heap.data out.h5') grep -q '^500 atoms$' heap.data ;;
    'python3 -m nsd.ondem write out.h5 -o heap.vtkhdf') h5ls heap.vtkhdf/ONDEM | grep -q Materials ;;
    'nsd-export -o out.gsd out.h5') [ "$(head -c 8 out.gsd | od -An -tx1 | tr -d ' ')" = df65df65df65df65 ] ;;
    'nsd-export -o out.xyz out.h5') [ "$(grep -c 'Properties=species:S:1:pos:R:3:' out.xyz)" = "$(frames out.h5 length)" ] ;;
    *'> forces.txt') table 1 "$(nsd-info --last out.h5 | jq .contacts)" forces.txt && awk '$1 < 0 { exit 1 }' forces.txt ;;
    'gnuplot '*) ;;
    # nsd-tutorial(7)
    'nsd-gen drum.json > start.h5') bodies start.h5 500 ;;
    'nsd-step --until 1.2 '*'-o drum.h5 start.h5') frames drum.h5 'length == 60 and .[-1] == 2400' ;;
    'nsd-info drum.h5 | jq -s '*) [ -s stdout ] ;;
    'nsd-view '*' -o drum.mp4 drum.h5') [ -s drum.mp4 ] || [ -s drum-00000.png ] ;;
    'nsd-stat -m surface drum.h5'*'> angle.tsv') table 2 60 angle.tsv ;;
    'tail -n 1 angle.tsv' | 'awk '*' angle.tsv') [ -s stdout ] ;;
    'jq '*'-o fast.h5') frames fast.h5 'length == 2' ;;
    '{ "title": "A drum half full'*) bodies stdout 500 ;;
    # nsd-fit(1)
    '{ "scene": "drum.json"'*) bodies stdout 500 ;;
    'nsd-fit '*) jq -e '.parameters.mu | .value > 0.05 and .value < 1' slope.fit/result.json && nsd-info out.h5 | grep -q '"step":10[,}]' ;;
    # without a prompt: Python
    *'with h5py.File("out.h5")'*) grep -q '^100 frames, the last is step 1000' stdout && grep -q '^[1-9][0-9]* contacts, at most [0-9.]* N' stdout ;;
    *'nsd.frames("out.h5")'*) table 3 100 <(tr ' ' '\t' <stdout) ;;
    *'MDAnalysis.Universe.empty'*) table 3 100 <(tr ' ' '\t' <stdout) ;;
    *'sys.stdin.buffer.read(512)'*) table 2 2 <(tr ' ' '\t' <stdout) ;;
    *) return 99 ;;
    esac
}

# ---- running ----

unfinished() # a command that goes on in the next line
{
    [[ $1 = *\\ ]] || ! bash -n <<<"$1" 2>/dev/null
}

# Output as it is shown, whatever time it took, without empty lines
timeless() { sed -e 's/[0-9.e-]* s in/T s in/' -e '/^$/d'; }

declare -A done_there # examples of manuals, which --help may have, too: what they do to the same files they do once

example() # SOURCE COMMAND SHOWN: in $tmp/run
{
    local command name=${2//$'\n'/ } s=0 n good=0
    if [[ $1 == *' --help' && -n ${done_there[$2]-} ]]; then
        tap_result 0 "$1: ${name//  / }, as in ${done_there[$2]}"
        return
    fi
    command="$2"
    n=$(sed -En 's/.*nsd-step.* -n ([0-9]+).*/\1/p' <<<"$command" | tail -n 1)
    name="$1: ${name//  / }"
    case $command in
    'gnuplot '* | 'ffmpeg '*) command -v "${command%% *}" >/dev/null || { skip "$name" "no ${command%% *}"; return; } ;;
    *import*MDAnalysis*) has MDAnalysis || { skip "$name" "no MDAnalysis"; return; } ;;
    *import*h5py* | *nsd.ondem*) have_h5py || { skip "$name" "no h5py"; return; } ;;
    'nsd-fit '*) { has sklearn && has scipy; } || { skip "$name" "no scikit-learn"; return; } ;;
    esac
    cd "$tmp/run" || return
    # shellcheck disable=SC2086 # a target, and variables
    case $command in
    'make '*) make -C "$repository" --no-print-directory -n ${command#make } >stdout 2>stderr || s=$? ;;
    '{ "scene": "'*) # kept for the next block, and the scene that it names is made
        printf '%s\n' "$command" >"$tmp/stock/slope.json"
        nsd-gen "$(jq -r .scene <<<"$command")" >stdout 2>stderr || s=$? ;;
    '{ "'*) nsd-gen - <<<"$command" >stdout 2>stderr || s=$? ;;
    'nsd-fit '*) # two evaluations, after which the intervals still change
        command=${command/ -j 2 slope.json &&/ -j 2 --quiet -n 2 slope.json >fitted || [ \$? = 1 ];}
        bash -c "${command/ --until 5 > drum.h5/ -n 10 >out.h5}" >stdout 2>stderr || s=$?
        command=$2 ;;
    *import*nsd*) PYTHONPATH=$repository/python py -c "$command" >stdout 2>stderr || s=$? ;;
    *nsd.ondem*) PYTHONPATH=$repository/python bash -c "${command/#python3/\/usr\/bin\/python3}" >stdout 2>stderr || s=$? ;;
    import*sys.stdin*) cat a.h5 packing.h5 | py -c "$command" >stdout 2>stderr || s=$? ;;
    import*) py -c "$command" >stdout 2>stderr || s=$? ;;
    *) GNUTERM=dumb bash -o pipefail -c "$command" >stdout 2>stderr || s=$? ;;
    esac
    [ "$s" != 141 ] || s=0 # cut off by head
    [ "$s" = 0 ] && { claim "$(tr -s ' \n' ' ' <<<"$command" | sed 's/ $//')" "${n:-0}" >"$tmp/tap.out" 2>&1 || s=$?; }
    cat stdout stderr >shown
    cd "$repository" || return
    [ "$s" = 0 ] || good=1
    tap_result $good "$name"
    [ "$good" = 1 ] || [ -z "$first" ] || done_there[$2]=$1
    first=
    case $s in
    0) ;;
    99) diag "no claim in tests/tools/examples.t" ;;
    *) diag "gave $s" "$(head -n 4 "$tmp/run/stderr")" "$(head -n 4 "$tmp/run/stdout")" "$(head -n 4 "$tmp/tap.out")" ;;
    esac
    [ -z "$3" ] || is "and shows what it prints" "$(timeless <"$tmp/run/shown")" "$(timeless <<<"$3")"
}

fresh() # what a block of examples finds; $first until one has run
{
    first=1
    rm -rf "$tmp/run"
    cp -a "$tmp/stock" "$tmp/run"
}

run() # SOURCE [once]: the examples on standard input; a block finds the files afresh, unless once
{
    local line command='' shown='' count=0
    fresh
    while IFS= read -r line <&3 || [ -n "$line" ]; do
        if [ -n "$command" ] && [ -z "$shown" ] && unfinished "$command"; then
            command+=$'\n'$line
        elif [[ $line = '$ '* || -z $line ]]; then
            [ -z "$command" ] || { example "$1" "$command" "$shown"; count=$((count + 1)); }
            shown='' command=${line#\$ }
            [ -n "$line" ] || [ -n "${2-}" ] || fresh
        elif [ -z "$command" ]; then
            command=$line # a block without a prompt is one text
            while IFS= read -r line <&3 && [ -n "$line" ]; do command+=$'\n'$line; done
            example "$1" "$command" ''
            command='' count=$((count + 1))
            [ -n "${2-}" ] || fresh
        else
            shown+=$line$'\n'
        fi
    done 3<&0
    [ -z "$command" ] || { example "$1" "$command" "$shown"; count=$((count + 1)); }
    ok "$1 has examples" [ "$count" -gt 0 ]
}

hidden() # lines of README.md that look like an example and are not in a block that is run
{
    awk '/^```/ { sh = !sh; next } !sh && /^    (\$ )?(nsd-|jq )/' README.md
}
is "README.md has no example outside of its sh blocks" "$(hidden)" ""
run README.md once < <(of_readme; echo)
for manual in man/*; do
    if grep -q '^\.\\" keys ' "$manual"; then continue; fi # scenes: tests/project/docs.t
    grep -q '^\.Sh EXAMPLES' "$manual" || continue
    run "${manual#man/}" < <(of_manual "$manual" EXAMPLES)
done
for tool in tools/*.c; do
    tool=$(basename "$tool" .c)
    run "$tool --help" < <(of_help "$tool")
done
run nsd-pipelines.7 once < <(of_manual man/nsd-pipelines.7 TUTORIAL)
run nsd-tutorial.7 once < <(of_manual man/nsd-tutorial.7 TUTORIAL)
done_testing
