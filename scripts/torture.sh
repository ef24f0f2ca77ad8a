#!/usr/bin/env bash
# Does to long renders what machines do to them, and checks that nothing is lost: kills, full disks, lost devices, tasks of a cluster that die.
#
#   scripts/torture.sh            all of it, some minutes; as root, because a full disk is a mounted one and Slurm is started
#   scripts/torture.sh --short    some kills, a lost device, parts, flipped bits, outputs that are inputs, little memory: no root, a minute
#
# Prints a table. Exit code 1 if anything was lost. What cannot be tried here is said to be skipped. BACKEND and BIN say what to try.
set -uo pipefail
cd "$(dirname "$0")/.."

kills=50 spp=2048
[ "${1:-}" = --short ] && kills=5 spp=512
bin=$(realpath "${BIN:-${CARGO_TARGET_DIR:-target}/release/luminaire}")
backend=${BACKEND:-auto}
scene=$PWD/scenes/cornell/cornell.toml
jobs=$PWD/docs/cluster
work=$(mktemp -d)
lost=0
rows=()

# What was started here must not stay.
finish() {
    for pid in $(cat "$work"/slurm/*.pid 2>/dev/null); do kill "$pid" 2>/dev/null; done
    mountpoint -q "$work/small" && umount "$work/small"
    rm -rf "$work"
}
trap finish EXIT

row() {
    rows+=("$(printf '| %-46s | %-6s | %s |' "$1" "$2" "$3")")
    printf '%-46s  %-6s  %s\n' "$1" "$2" "$3"
    [ "$2" = lost ] && lost=1
}

# row NAME DETAIL COMMAND...: held if the command succeeds.
check() {
    local name=$1 detail=$2
    shift 2
    if "$@" >"$work/check.log" 2>&1; then row "$name" held "$detail"; else
        row "$name" lost "$detail"
        sed 's/^/    /' "$work/check.log" | tail -5
    fi
}

# Not a function: in the background that would be a shell, and the program its child, which a signal does not reach.
render=("$bin" render "$scene" --width 64 --backend "$backend" --quiet)
now() { date +%s%N; }

cd "$work" || exit 1
started=$(now)
"${render[@]}" --spp $spp -o whole.exr || { echo "error: the scene does not render on $backend at all"; exit 1; }
alone=$((($(now) - started) / 1000000))

# --- SIGKILL at random moments
killed=0 rounds=0
while [ $killed -lt $kills ]; do
    rm -f c.exr killed.exr
    rounds=$((rounds + 1))
    while [ ! -e killed.exr ]; do
        "${render[@]}" --spp $spp -o killed.exr --checkpoint c.exr --checkpoint-every 0.05 --resume &
        if [ $killed -lt $kills ]; then
            sleep "$(awk -v s=$RANDOM -v all=$alone 'BEGIN { printf "%.3f", 0.2 + s / 32768 * all / 2000 }')"
            if kill -KILL $! 2>/dev/null; then killed=$((killed + 1)); fi
        fi
        wait $! 2>/dev/null
    done
    cmp -s killed.exr whole.exr || { row "SIGKILL at random moments" lost "round $rounds differs"; break; }
    # A round that nobody could kill says that the render is too short.
    [ $rounds -gt $((kills * 3)) ] && { row "SIGKILL at random moments" lost "only $killed kills came in time"; break; }
done
[ $killed -ge $kills ] && check "SIGKILL at random moments" "$killed kills in $rounds renders, the same bits" cmp killed.exr whole.exr
check "nothing is left over of killed writes" "no temporary file" bash -c '! ls -A | grep -q luminaire.tmp'

# --- SIGTERM and Ctrl-C
for signal in TERM INT; do
    rm -f c.exr s.exr
    "${render[@]}" --spp $spp -o s.exr --checkpoint c.exr --checkpoint-every 0.1 &
    while [ ! -e c.exr ] && kill -0 $! 2>/dev/null; do sleep 0.02; done
    kill -$signal $!
    wait $!
    code=$?
    "${render[@]}" --spp $spp -o s.exr --checkpoint c.exr --resume
    check "SIG$signal" "exit code $code, resumed to the same bits" bash -c "[ $code = 130 ] && cmp s.exr whole.exr"
done

# --- A device that is lost
rm -f c.exr l.exr
LUMINAIRE_LOSE_DEVICE_AFTER=6 "${render[@]}" --spp $spp -o l.exr --checkpoint c.exr 2>lost.log
code=$?
cp c.exr c-lost.exr
"${render[@]}" --spp $spp -o l.exr --checkpoint c.exr --resume
check "a lost device (simulated)" "exit code $code, resumed to the same bits" bash -c "[ $code = 3 ] && cmp l.exr whole.exr"
cp c-lost.exr c.exr
"$bin" render "$scene" --width 64 --backend cpu --quiet --spp $spp -o l.exr --checkpoint c.exr --resume
check "the same, resumed on the reference" "RMSE below 1e-4" "$bin" compare l.exr whole.exr --max-rmse 1e-4

# --- Parts
"${render[@]}" --samples 0..$((spp / 3)) -o p1.exr
"${render[@]}" --samples $((spp / 3))..$((spp * 3 / 4 + 1)) -o p2.exr
"${render[@]}" --samples $((spp * 3 / 4 + 1))..$spp -o p3.exr
"$bin" merge p2.exr p3.exr p1.exr -o m1.exr >/dev/null
"$bin" merge p3.exr p1.exr p2.exr -o m2.exr >/dev/null
check "three parts, merged in two orders" "the same bits" cmp m1.exr m2.exr
check "merged parts against the whole" "RMSE below 1e-7" "$bin" compare m1.exr whole.exr --max-rmse 1e-7
for bad in "p1.exr p3.exr" "p1.exr p2.exr p2.exr p3.exr" "p1.exr whole.exr" "p2.exr p3.exr"; do
    # shellcheck disable=SC2086
    check "merge $bad" "refused" bash -c "! $bin merge $bad -o bad.exr && [ ! -e bad.exr ]"
done

# --- Flipped bits
cp p1.exr sound.exr
size=$(stat -c %s sound.exr)
steps=64
[ "${1:-}" = --short ] && steps=12
flipped=0
for step in $(seq $steps); do
    at=$((size * step / (steps + 1)))
    cp sound.exr flipped.exr
    byte=$(od -An -tu1 -j $at -N 1 flipped.exr | tr -d ' ')
    # shellcheck disable=SC2059
    printf "\\x$(printf %x $((byte ^ 1 << step % 8)))" | dd of=flipped.exr bs=1 seek=$at conv=notrunc 2>/dev/null
    "$bin" merge flipped.exr -o bad.exr >/dev/null 2>&1 || flipped=$((flipped + 1))
done
check "a part with a flipped bit" "$flipped of $steps refused" bash -c "[ $flipped = $steps ] && [ ! -e bad.exr ] && $bin merge sound.exr -o good.exr"

# --- Two jobs, one checkpoint
rm -f c.exr
"${render[@]}" --spp 4000000000 -o j1.exr --checkpoint c.exr --checkpoint-every 0.05 &
job=$!
while [ ! -e c.exr ] && kill -0 $job 2>/dev/null; do sleep 0.02; done
"${render[@]}" --spp $spp -o j2.exr --checkpoint ./c.exr --resume 2>second.log
code=$?
kill -KILL $job 2>/dev/null
wait $job 2>/dev/null
check "two jobs with one checkpoint" "the second is refused, exit code $code" bash -c "[ $code = 1 ] && grep -q 'process $job' second.log && [ ! -e j2.exr ]"
"${render[@]}" --spp 1 -o j2.exr --checkpoint c.exr --resume
check "the lock of a killed job" "is in nobody's way" bash -c "[ $? = 0 ] && [ ! -e c.exr.lock ]"

# --- An output that is an input
mkdir -p model/textures
printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n' >model/m.obj
printf 'newmtl a\nKe 1 1 1\nmap_Ke textures/m.png\nmap_Kd m.png\n' >model/m.mtl
"${render[@]}" --spp 1 -o model/textures/m.png
cp model/textures/m.png model/m.png
ln -s textures/m.png model/soft.png
ln model/textures/m.png model/hard.png
ln -s model here
cp -r model before
model=$PWD/model
spared=0 ways=0
spare() {
    ways=$((ways + 1))
    (cd model && "$bin" "$@" >/dev/null 2>&1)
    [ $? = 2 ] && spared=$((spared + 1))
}
small=(render m.obj --width 8 --spp 1 --backend cpu --quiet)
for name in textures/m.png ./textures/m.png textures/../textures/m.png "$model/textures/m.png" soft.png hard.png ../here/textures/m.png m.png; do
    spare "${small[@]}" -o "$name"
done
spare "${small[@]}"
spare "${small[@]}" -o ok.png --error-map soft.png
spare compare m.png textures/m.png --heatmap hard.png
spare merge ../p1.exr -o ../model/../p1.exr
check "an output that is an input, $ways ways" "$spared refused, nothing has changed" \
    bash -c "[ $spared = $ways ] && diff -r --no-dereference model before && cmp p1.exr sound.exr"

# --- Little address space
limits="200 300 400 600 800 1000 1400 2000"
[ "${1:-}" = --short ] && limits="200 400 1000"
dead=0 tries=0
for limit in $limits; do
    for what in "render $scene --width 16 --spp 1 --backend auto -o v.png" "render $scene --width 16 --spp 1 --backend cpu -o v.png" \
        "render $scene --width 16 --spp 1 --backend compute-bvh -o v.png" devices "inspect $scene"; do
        tries=$((tries + 1))
        # shellcheck disable=SC2086
        (ulimit -v $((limit * 1024)) && exec "$bin" $what >/dev/null 2>&1)
        code=$?
        # What does not name a device has to work.
        case $what in *auto* | inspect*) [ $code = 0 ] ;; *) [ $code -le 2 ] ;; esac || dead=$((dead + 1))
    done
done
check "ulimit -v of 200 MB to 2 GB" "$tries runs: the reference or an error, none crashed" [ $dead = 0 ]

if [ "${1:-}" != --short ]; then
    # --- Disks
    mkdir small
    if mount -t tmpfs -o size=4m none small 2>/dev/null; then
        "${render[@]}" --spp 16 -o small/p.exr --checkpoint small/c.exr
        cp small/c.exr c-before.exr
        cp small/p.exr p-before.exr
        dd if=/dev/zero of=small/filler bs=64k 2>/dev/null
        "${render[@]}" --spp 64 -o small/p.exr --checkpoint small/c.exr --resume 2>full.log
        code=$?
        check "disk full" "exit code $code, the old files are intact" \
            bash -c "[ $code = 1 ] && cmp small/c.exr c-before.exr && cmp small/p.exr p-before.exr && grep -q 'No space left' full.log"
        rm small/filler
        "${render[@]}" --spp 64 -o small/p.exr --checkpoint small/c.exr --resume
        "${render[@]}" --spp 64 -o p64.exr
        check "with room again" "resumed to the same bits" cmp small/p.exr p64.exr
        mount -o remount,ro small
        cp small/c.exr c-before.exr
        "${render[@]}" --spp 128 -o p128.exr --checkpoint small/c.exr --resume 2>ro.log
        code=$?
        check "read-only folder" "exit code $code before it renders, the old file is intact" \
            bash -c "[ $code = 1 ] && cmp small/c.exr c-before.exr && [ ! -e p128.exr ]"
        umount small
    else
        row "disk full, read-only folder" SKIP "no disk can be mounted here; it takes root"
    fi

    # --- GNU parallel, one job killed
    if command -v parallel >/dev/null; then
        export LUMINAIRE=$bin LUMINAIRE_OPTIONS="--width 64 --backend $backend --checkpoint-every 0.2" JOBS=2
        "$jobs/parallel.sh" "$scene" $spp 4 parallel --will-cite >parallel.log 2>&1 &
        while ! ls parallel/part-*.checkpoint.exr >/dev/null 2>&1 && kill -0 $! 2>/dev/null; do sleep 0.05; done
        pkill -KILL -f -o "$bin render .*parallel/part-" && victims=1 || victims=0
        wait $!
        check "GNU parallel, 4 jobs, one killed" "merged: RMSE below 1e-7" \
            bash -c "[ $victims = 1 ] && $bin compare parallel/picture.exr whole.exr --max-rmse 1e-7"
    else
        row "GNU parallel" SKIP "it is not installed (Debian: parallel)"
    fi

    # --- Slurm on this machine, one task killed
    if command -v slurmctld >/dev/null && command -v munged >/dev/null && [ "$(id -u)" = 0 ]; then
        mkdir -p slurm/state slurm/spool
        dd if=/dev/urandom of=slurm/munge.key bs=1 count=256 2>/dev/null
        chmod 600 slurm/munge.key
        chmod 755 "$work" slurm
        host=$(hostname -s)
        cat >slurm/slurm.conf <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/slurm/munge.socket,cred_expire=5
StateSaveLocation=$work/slurm/state
SlurmdSpoolDir=$work/slurm/spool
SlurmctldPidFile=$work/slurm/slurmctld.pid
SlurmdPidFile=$work/slurm/slurmd.pid
SlurmctldLogFile=$work/slurm/slurmctld.log
SlurmdLogFile=$work/slurm/slurmd.log
SlurmctldPort=26817
SlurmdPort=26818
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=bf_interval=1,sched_interval=1
NodeName=$host NodeHostname=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
        export SLURM_CONF=$work/slurm/slurm.conf
        munged --force --key-file=slurm/munge.key --socket="$work/slurm/munge.socket" --pid-file="$work/slurm/munged.pid" \
            --log-file="$work/slurm/munged.log" --seed-file="$work/slurm/munged.seed"
        slurmctld -f "$SLURM_CONF"
        sleep 1
        slurmd -f "$SLURM_CONF"
        for _ in $(seq 100); do sinfo -h -o %t 2>/dev/null | grep -q idle && break; sleep 0.1; done
        export SCENE=$scene SPP=$spp OUT=$work/slurm-out LUMINAIRE=$bin
        export LUMINAIRE_OPTIONS="--width 64 --backend $backend --checkpoint-every 0.2"
        array=$(sbatch --parsable --array=0-3 "$jobs/array.sbatch")
        merge=$(sbatch --parsable --dependency="afterok:$array" "$jobs/merge.sbatch")
        for _ in $(seq 600); do ls slurm-out/part-*.checkpoint.exr >/dev/null 2>&1 && break; sleep 0.05; done
        pkill -KILL -f -o "$bin render .*slurm-out/part-" && victims=1 || victims=0
        for _ in $(seq 1800); do
            [ -e slurm-out/picture.png ] && break
            squeue -h -j "$merge" 2>/dev/null | grep -q . || break
            sleep 0.1
        done
        # A task that was queued again says so in its log.
        again=$(grep -l 'going on from' luminaire-"$array"-*.log 2>/dev/null | wc -l)
        check "Slurm array of 4, one task killed and queued again" "merged: RMSE below 1e-7" \
            bash -c "[ $victims = 1 ] && [ $again -ge 1 ] && $bin compare slurm-out/picture.exr whole.exr --max-rmse 1e-7"
    else
        row "Slurm array" SKIP "it is not installed (Debian: slurm-wlm, munge), or this is not root"
    fi
fi

printf '\n| what was done | | found |\n|---|---|---|\n'
printf '%s\n' "${rows[@]}"
exit $lost
