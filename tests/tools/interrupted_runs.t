#!/usr/bin/env bash
# Runs that are stopped by a signal or killed: what they leave, and that the next one goes on with the same bits.
. tests/support/tap.sh

cd "$tmp"
nsd-gen 60 >start.h5
long=(env '--default-signal=HUP,INT,QUIT' nsd-step -n 100000000 --every 100000000)
steps_of() { nsd-info "$1" | jq -c -s 'map(select(.step != null).step)'; }
last() { nsd-info -p --last "$1"; }
until_there() { for ((w = 0; w < 1000; w++)); do [ ! -e "$1" ] || return 0; sleep 0.01; done; }

stopped() # SIGNAL OUTPUT: the run's status
{
    "${long[@]}" -o "$2" start.h5 2>said &
    local pid=$! s=0
    until_there "$2" && sleep 0.3
    kill "-$1" $pid
    wait $pid || s=$?
    return $s
}
for signal in TERM HUP; do
    status $((128 + $(kill -l $signal))) "a run that is stopped by SIG$signal ends with 128 and its number" stopped $signal "$signal.h5"
    k=$(nsd-info --last "$signal.h5" | jq .step)
    ok "after a last frame" [ "$k" -gt 0 ]
    like "and says so" "$(tail -n 1 said)" "stopped by signal [0-9]+ after step $k"
    nsd-step -n "$k" --every "$k" -o same.h5 start.h5 2>/dev/null
    ok "which is that of a run of so many steps" cmp <(last "$signal.h5") <(last same.h5)
done
int() { /usr/bin/python3 -c 'import subprocess, sys, time, signal, os
p = subprocess.Popen(sys.argv[1:] + ["-o", "int.h5", "start.h5"], stderr=subprocess.DEVNULL)
while not os.path.exists("int.h5"): time.sleep(0.01)
time.sleep(0.3); p.send_signal(signal.SIGINT); sys.exit(p.wait())' "${long[@]}"; }
status 130 "and SIGINT" int
is "leaves one frame" "$(steps_of int.h5 | jq length)" 1
piped() { "${long[@]}" start.h5 2>/dev/null >piped.h5 & local pid=$! s=0; sleep 0.5; kill -TERM $pid; wait $pid || s=$?; return $s; }
status 143 "into standard output, too" piped
is "one frame" "$(steps_of piped.h5 | jq length)" 1
status 0 "a run that is done is not stopped" nsd-step -n 3 -o done.h5 start.h5

# ---- beside a program in the loop, which ignores signals and the end of its input ----

# shellcheck disable=SC2016 # text for another shell
deaf='trap "" TERM INT HUP PIPE; n=0; while [ $n -lt 2 ] && read -r l; do echo "{}"; n=$((n + 1)); done; (echo $BASHPID >>pids; sleep 60) | (echo $BASHPID >>pids; sleep 60)'
waits=(env '--default-signal=INT,HUP' nsd-step -n 9 --with "bash -c '$deaf'")
until_two() { for ((w = 0; w < 500; w++)); do [ "$(wc -l <pids)" -lt 2 ] || return 0; sleep 0.01; done; }
orphans() # how many of the program's processes live on, after a while
{
    local pid alive
    for ((w = 0; w < 100; w++)); do
        alive=0
        while read -r pid; do
            if [ "$(ps -o stat= -p "$pid" | tr -d ' ' | cut -c1)" != "" ]; then alive=$((alive + 1)); fi
        done <pids
        [ $alive -gt 0 ] || break
        sleep 0.02
    done
    echo $alive
}
asked() # SIGNAL ...: while it waits for an answer; the run's status, its time in seconds, its frames, and who lives on
{
    : >pids
    "${waits[@]}" -o asked.h5 start.h5 2>said &
    local pid=$! s=0 begun
    until_two
    begun=${EPOCHREALTIME/./}
    for signal; do kill "-$signal" $pid && sleep 0.1; done
    wait $pid || s=$?
    echo "$s $(((${EPOCHREALTIME/./} - begun) / 2000000)) $(steps_of asked.h5) $(orphans)"
}
for signal in TERM HUP INT; do
    is "SIG$signal ends the wait for an answer at once, after the last step" "$(asked $signal)" "$((128 + $(kill -l $signal))) 0 [1,2] 0"
    like "and says so" "$(tail -n 1 said)" "stopped by signal [0-9]+ after step 2, which is kept"
done
is "a second signal ends the run, and the program" "$(asked TERM TERM)" "143 0 [1,2] 0"
is "so does SIGKILL, before or after the frame of the step is on disk" "$(asked KILL 2>/dev/null | sed "s/\[1\]/[1,2]/")" "137 0 [1,2] 0"
: >pids
s=0
# shellcheck disable=SC2016 # text for another shell
nsd-step -n 100000 --with 'trap "" PIPE; echo $$ >>pids; while read -r l; do echo "{}"; done; sleep 60' start.h5 2>/dev/null | head -c 1 >/dev/null || s=${PIPESTATUS[0]}
is "and a reader that has gone: SIGPIPE" "$s $(orphans)" "141 0"
: >pids
setsid "${waits[@]}" -o asked.h5 start.h5 2>said &
pid=$!
until_two
s=0
kill -INT -- "-$(ps -o pgid= -p $pid | tr -d ' ')"
wait $pid || s=$?
is "a signal for the group, as from a terminal" "$s $(steps_of asked.h5) $(orphans)" "130 [1,2] 0"

s=0
nsd-step -n 2 --with-timeout 0.5 --with 'read -r l; echo >begun; sleep 0.2; echo "{}"; read -r l; echo "{}"' -o asked.h5 start.h5 2>said &
pid=$!
until_there begun
kill -STOP $pid && sleep 1 && kill -CONT $pid
wait $pid || s=$?
is "a run that was suspended has its answer, and the time for the next" "$s $(steps_of asked.h5)" "0 [1,2]"

# ---- checkpoints ----

"${long[@]}" --save 0.05s -o killed.h5 start.h5 2>/dev/null &
pid=$!
until_there killed.h5.save && sleep 0.3
kill -9 $pid
wait $pid 2>/dev/null || true
k=$(nsd-info --last killed.h5.save | jq .step)
ok "--save keeps the state while the run goes on" [ "$k" -gt 0 ]
nsd-step -n 50 -o resumed.h5 killed.h5.save 2>/dev/null
nsd-step -n $((k + 50)) --every $((k + 50)) -o whole.h5 start.h5 2>/dev/null
ok "from which another goes on with the same bits" cmp <(last resumed.h5) <(last whole.h5)
nsd-step -n 1000 --every 500 --save 0.01s -j 2 -o saved.h5 start.h5 2>/dev/null
nsd-step -n 1000 --every 500 -o plain.h5 start.h5 2>/dev/null
ok "it does not change the output" cmp saved.h5 plain.h5
ok "and is not left at the end" test ! -e saved.h5.save
for wrong in x -1s 0s 1d s 0; do refuses 64 "--save $wrong" nsd-step --save=$wrong -o w.h5 start.h5; done
refuses 64 "--save without a name" nsd-step --save 1s start.h5
refuses 64 "--save to its input" eval 'cp start.h5 x.h5.save && nsd-step --save 1s -o x.h5 x.h5.save'

# ---- progress ----

nsd-step -n 3000 --progress 0.05 --every 1000 start.h5 2>said >/dev/null
like "progress has the memory and what is written" "$(grep -m 1 ' left: ' said)" ' left: .*, [0-9.e+]+ MB of memory, [0-9.e+]+ MB written$'
nsd-step -n 200 -o many.h5 start.h5 2>/dev/null
nsd-step -i -n 1 --progress 1000 many.h5 2>said
ok "no line says that one frame of many is copied" eval '! grep copied said'

done_testing
