#!/usr/bin/env bash
# Compiles shaders/*.comp into OUT (default: shaders/spirv, which is shipped), once for each intersector, with glslc.
# usage: build-shaders.sh [OUT]
set -euo pipefail
# The order of the files below must not depend on the language.
export LC_ALL=C
cd "$(dirname "$0")/.."
out=${1:-shaders/spirv}
command -v glslc >/dev/null || { echo "glslc is missing: on Debian and Ubuntu, apt-get install glslc" >&2; exit 1; }
mkdir -p "$out"
for source in shaders/*.comp; do
    name=$(basename "$source" .comp)
    glslc --target-env=vulkan1.2 -o "$out/${name}_bvh.spv" "$source"
    glslc --target-env=vulkan1.2 -DRAY_QUERY -o "$out/${name}_ray_query.spv" "$source"
done
# What they were made from, and by what: the test that rebuilds them compares bytes only for the same compiler.
{
    echo "glslc $(glslc --version | tr '\n' ' ' | sed 's/ *$//')"
    cat shaders/*.comp shaders/*.glsl | sha256sum | cut -d' ' -f1
} > "$out/provenance.txt"
