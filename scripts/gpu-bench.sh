#!/usr/bin/env bash
# Ray query against compute BVH and all the other measurements of `luminaire bench`, on this machine's GPU, in one command. OUT/index.html is one
# file that can be sent as it is.
#
#   scripts/gpu-bench.sh [OUT] [OURS.toml THEIRS.xml REFERENCE]...
#
# OUT is out/gpu-bench unless it is given. With triples of scenes, and MITSUBA=PYTHON naming a Python that has Mitsuba 3, the two renderers race as
# well (scripts/compare-mitsuba.py race; VARIANT is Mitsuba's, cuda_ad_rgb unless it is given). LONG=1 takes about an hour.
#
# Wants a Vulkan driver, and either the program beside this script or a Rust toolchain.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
out=${1:-out/gpu-bench}
shift || true
if (($# % 3)); then
    echo "usage: $0 [OUT] [OURS.toml THEIRS.xml REFERENCE]..." >&2
    exit 2
fi
mkdir -p "$out"

if [ -x "$here/luminaire" ]; then
    program=$here/luminaire
    cd_to=$here
else
    cd_to=$here/..
    (cd "$cd_to" && cargo build --release)
    program=${CARGO_TARGET_DIR:-$(cd "$cd_to" && pwd)/target}/release/luminaire
fi
out=$(cd "$out" && pwd)
races=()
for file in "$@"; do races+=("$(realpath "$file")"); done
# The standard scenes are looked for in the current folder.
cd "$cd_to"

"$program" devices | tee "$out/devices.txt"
# A section that fails does not keep the others from the page, nor the races from being run.
failed=0
"$program" bench --out "$out" --page "$out/page.md" ${LONG:+--long} || failed=$?

set -- "${races[@]}"
while (($#)); do
    if [ -z "${MITSUBA:-}" ]; then
        echo "SKIP: MITSUBA=PYTHON is not set; no race against Mitsuba" >&2
        break
    fi
    name=$(basename "$(dirname "$1")")-$(basename "$1" .toml)
    "$MITSUBA" "$here/compare-mitsuba.py" race "$1" "$2" "$3" --variant "${VARIANT:-cuda_ad_rgb}" --luminaire "$program" | tee "$out/race-$name.txt"
    shift 3
done
echo "$out/index.html"
exit "$failed"
