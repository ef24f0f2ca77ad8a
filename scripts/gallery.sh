#!/usr/bin/env bash
# Renders the pictures of docs/gallery.md from scenes/, with the program that `make build` made.
#
#   scripts/gallery.sh                     all of them into docs/images/: about fifty minutes on two idle cores without a GPU
#   scripts/gallery.sh [-o FOLDER] NAME... only some, by the name of the picture, perhaps into another folder
#
# Other options of `luminaire render` may be put into GALLERY_OPTIONS, for example GALLERY_OPTIONS="--backend cpu".
set -euo pipefail
cd "$(dirname "$0")/.."
program=${CARGO_TARGET_DIR:-target}/release/luminaire
[ -x "$program" ] || { echo "gallery: $program is missing: run make build" >&2; exit 1; }

# name of the picture, scene, width, samples a pixel, other options
pictures() {
    cat <<'END'
still-life             still-life/still-life.toml    1280 1024
plates                 plates/plates.toml           1920 4096 --height 1080 --noise 0.01
bare                   shapes/knot.obj               400 256
cornell                cornell/cornell.toml          512 512
simple                 simple/simple.toml            640 16
shadows                shadows/shadows.toml          640 192
spotlights             spotlights/spotlights.toml    640 512
directions-uniform     directions/directions.toml    480 64   --directions uniform
directions-cosine      directions/directions.toml    480 64   --directions cosine
directions-bsdf        directions/directions.toml    480 64
extinction-reweighted  extinction/extinction.toml    480 192  --estimator cosine
extinction-literal     extinction/extinction.toml    480 192  --estimator literal-extinction
extinction-threshold   extinction/extinction.toml    480 192  --estimator cosine --albedo-threshold 0.3
lamps                  lamps/lamps.toml              640 384
mirror                 mirror/mirror.toml            640 192
glass                  glass/glass.toml              640 448
lens                   lens/lens.toml                640 192
orthographic           lens/orthographic.toml        640 96
textures               textures/textures.toml        640 160
brick-wall             brick-wall/brick-wall.toml    640 384
environment            environment/environment.toml  640 256
metals                 metals/metals.toml            640 512
brushed                brushed/brushed.toml          640 512
car-paint              car-paint/car-paint.toml      640 512
frosted                frosted/frosted.toml          640 512
liquid                 liquid/liquid.toml            640 512
many-lights            many-lights/many-lights.toml  640 320
plates-direct          plates/plates.toml            480 64   --light-sampling direct
plates-none            plates/plates.toml            480 64   --light-sampling none
plates-mis             plates/plates.toml            480 64
instances              instances/instances.toml      640 64
END
}

folder=docs/images
if [ "${1:-}" = -o ]; then
    folder=${2:?"-o wants a folder"}
    shift 2
fi
for wanted; do
    pictures | awk -v name="$wanted" '$1 == name { found = 1 } END { exit !found }' ||
        { echo "gallery: there is no picture \`$wanted\`; there are: $(pictures | awk '{ printf "%s ", $1 }')" >&2; exit 2; }
done
mkdir -p "$folder"
while read -r name scene width spp options; do
    if [ $# != 0 ] && [[ " $* " != *" $name "* ]]; then continue; fi
    start=$SECONDS
    # shellcheck disable=SC2086 # the options are words
    "$program" render "scenes/$scene" --width "$width" --spp "$spp" $options ${GALLERY_OPTIONS:-} --quiet -o "$folder/$name.png" </dev/null
    echo "$folder/$name.png: $((SECONDS - start)) s"
done < <(pictures)
