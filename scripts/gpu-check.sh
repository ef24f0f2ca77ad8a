#!/usr/bin/env bash
# Checks and times luminaire on a GPU machine that has no Rust toolchain.
#
#   scripts/gpu-check.sh pack       here: builds, and puts all that is needed into target/gpu-check/
#   target/gpu-check/run.sh [OUT]   there: devices, the kernel's tests, a render, the table of accuracy, the benchmark; writes into OUT
#
# The tests run on whatever the GPU offers: where it has no ray query, they say so and test the compute BVH. A bare machine may lack the Vulkan loader
# and what NVIDIA's driver loads beside it: Debian's libvulkan1 libegl1 libglvnd0 libopengl0 libgl1 libglx0 libgles2 are enough
# (`dpkg -x FILE.deb /`, then `ldconfig`); VK_DRIVER_FILES names the driver's nvidia_icd.json where it lies in no usual folder.
set -euo pipefail

pack() {
    cd "$(dirname "$0")/.."
    local pack=target/gpu-check
    rm -rf $pack && mkdir -p $pack
    cargo build --release --examples --bins
    local tests
    tests=$(cargo test --release --no-run --test gpu --message-format json 2>/dev/null |
        sed -n 's/.*"executable":"\([^"]*\/gpu-[^"]*\)".*/\1/p' | tail -n 1)
    [ -n "$tests" ] || { echo "gpu-check: the tests of the kernel were not built" >&2; exit 1; }
    cp "$tests" $pack/gpu-tests
    cp target/release/luminaire target/release/examples/accuracy $pack
    cp -r scenes $pack
    cp "$0" $pack/run.sh
    cp scripts/gpu-bench.sh scripts/compare-mitsuba.py $pack
    strip $pack/gpu-tests $pack/luminaire $pack/accuracy 2>/dev/null || true
    du -sh $pack
}

check() {
    local out
    out=$(mkdir -p "${1:-out}" && cd "${1:-out}" && pwd)
    cd "$(dirname "$0")"
    ./luminaire devices | tee "$out/devices.txt"
    # Nobody wants an hour of a lent GPU to go to its processor.
    grep -q ' GPU$' "$out/devices.txt" || { echo "gpu-check: no GPU among these devices" >&2; exit 1; }
    # Sharp where it can be: a failed test ends the run, after its report.
    ./gpu-tests --nocapture 2>&1 | tee "$out/tests.txt" | grep -E '^(test |SKIP|test result)'
    ./luminaire render scenes/cornell/cornell.toml -o "$out/cornell.png" --spp 1024 --stats "$out/cornell.json"
    ./accuracy --out "$out/accuracy.md"
    ./gpu-bench.sh "$out/bench"
}

case "${1:-}" in
    pack) pack ;;
    *) if [ -x "$(dirname "$0")/gpu-tests" ]; then check "$@"; else echo "usage: $0 pack" >&2; exit 2; fi ;;
esac
