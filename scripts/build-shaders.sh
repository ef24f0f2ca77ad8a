#!/usr/bin/env bash
# Compiles shaders/*.comp into OUT (default: shaders/spirv, which is shipped), once for each intersector, with glslc.
# Optimised, so that a driver has less to read: half of the start of a render was that.
# usage: build-shaders.sh [OUT [OPTION]]     OPTION of glslc: -O, or -O0 for SPIR-V with the names of the sources
set -euo pipefail
# The order of the files below must not depend on the language.
export LC_ALL=C
cd "$(dirname "$0")/.."
out=${1:-shaders/spirv}
optimise=${2:--O}
command -v glslc >/dev/null || { echo "glslc is missing: on Debian and Ubuntu, apt-get install glslc" >&2; exit 1; }
mkdir -p "$out"
for source in shaders/*.comp; do
    name=$(basename "$source" .comp)
    glslc "$optimise" --target-env=vulkan1.2 -o "$out/${name}_bvh.spv" "$source"
    glslc "$optimise" --target-env=vulkan1.2 -DRAY_QUERY -o "$out/${name}_ray_query.spv" "$source"
done
# What they were made from, and by what: the test that rebuilds them compares bytes only for the same compiler.
{
    echo "glslc $(glslc --version | tr '\n' ' ' | sed 's/ *$//')"
    cat shaders/*.comp shaders/*.glsl | sha256sum | cut -d' ' -f1
} > "$out/provenance.txt"
