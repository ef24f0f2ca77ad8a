#!/bin/bash
# One render over several machines, or several GPUs of one, with GNU parallel (https://www.gnu.org/software/parallel/).
#
#   docs/cluster/parallel.sh model.toml 4096 16 out/model                 JOBS (4) parts at a time, here
#   docs/cluster/parallel.sh model.toml 4096 16 out/model --sshlogin 2/node1,2/node2 --workdir .
#                                                                         on two nodes that share this folder
#
# What was finished is not done again: after a failure, run the same command.
set -eu
if [ $# -lt 4 ]; then
    echo "usage: $0 SCENE SPP PARTS FOLDER [options of GNU parallel]" >&2
    exit 2
fi
scene=$1 spp=$2 parts=$3 out=$4
shift 4
luminaire=${LUMINAIRE:-luminaire}
mkdir -p "$out"

for ((i = 0; i < parts; i++)); do
    part=$out/$(printf 'part-%06d' "$i")
    # A part is only there when it is whole.
    if [ ! -e "$part.exr" ]; then
        printf '%q ' "$luminaire" render "$scene" --samples "$((spp * i / parts))..$((spp * (i + 1) / parts))" \
            -o "$part.exr" --checkpoint "$part.checkpoint.exr" --resume --quiet
        printf '%s\n' "${LUMINAIRE_OPTIONS:-}"
    fi
# A job that fails or is killed is tried again, and goes on from its checkpoint.
done | parallel --jobs "${JOBS:-4}" --retries 5 --joblog "$out/jobs.log" "$@"
"$luminaire" merge "$out"/part-[0-9]*[0-9].exr -o "$out/picture.exr" -o "$out/picture.png"
rm -f "$out"/part-*.checkpoint.exr
