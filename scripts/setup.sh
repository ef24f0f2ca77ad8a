#!/usr/bin/env bash
# Makes this machine ready to build, render and test; says beforehand what it will change. Quick when nothing is missing.
#
#   scripts/setup.sh build    Rust and a C linker
#   scripts/setup.sh vulkan   a usable Vulkan device: the one that is there, else Mesa's lavapipe (a driver for CPUs)
#   scripts/setup.sh test     what the tests want besides: lavapipe with ray query, glslc, the validation layers, a virtual X
#                             server, and an older lavapipe without ray query under target/drivers/
#   scripts/setup.sh ci       the same, and pip and a C++ compiler for .ci/run
#
# It installs on Debian 12, Debian 13 and Ubuntu 24.04 (and what is like them); elsewhere it says what to install.
set -euo pipefail
cd "$(dirname "$0")/.."

readonly rust_needed=1.88
# The first Mesa whose lavapipe has ray query in all three systems.
readonly mesa_needed=25.0
# A virtual X server, keys and a pointer for it, and the libraries that a window loads.
readonly window_packages="xvfb xdotool libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0"
readonly old_driver=target/drivers/mesa-22.3.6
# Quiet; a new machine may still be at its own updates, so wait for its lock.
readonly apt_options="-qq -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0"
readonly backports=/etc/apt/sources.list.d/luminaire-backports.sources

say() { printf 'set-up: %s\n' "$*"; }
fail() {
    printf 'set-up: %s\n' "$@" >&2
    exit 1
}

# The name of the system, as "debian bookworm".
system() {
    # shellcheck disable=SC1091
    (. /etc/os-release 2>/dev/null && echo "${ID:-unknown} ${VERSION_CODENAME:-}") || uname -s
}
has_apt() { command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; }
is_bookworm() { [ "$(system)" = "debian bookworm" ]; }

# Runs a command as root.
as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}
may_be_root() {
    [ "$(id -u)" = 0 ] || { command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; }
}

installed_version() { dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true; }
is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# Where apt gets a release from: the URI of its own sources, so that a mirror stays a mirror.
archive_of() {
    apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' |
        awk -v release="$1" '$2 == release && $3 == "main" { print $1; exit }'
}

backports_source() {
    printf 'Types: deb\nURIs: %s\nSuites: bookworm-backports\nComponents: main\n' "$1"
    local keyring=/usr/share/keyrings/debian-archive-keyring.gpg
    if [ -f "$keyring" ]; then printf 'Signed-By: %s\n' "$keyring"; fi
}

# Installs packages; NAME/bookworm-backports also makes that release known to apt.
install() {
    local with_backports=no commands
    case "$*" in *bookworm-backports*) [ -n "$(archive_of bookworm-backports)" ] || with_backports=yes ;; esac
    commands="  apt-get update"
    if [ $with_backports = yes ]; then
        commands="$commands
  write $backports (the release bookworm-backports, from the archive that apt uses already)
  apt-get update"
    fi
    commands="$commands
  apt-get install --no-install-recommends $*"
    if ! may_be_root; then
        fail "these packages are missing: $*" "run this as root, then try again:"$'\n'"$commands"
    fi
    say "will now run, as root:"
    printf '%s\n' "$commands"
    export DEBIAN_FRONTEND=noninteractive
    as_root apt-get $apt_options update || fail "apt-get update failed; see above"
    # On a machine whose package lists were empty, apt only now knows what it has.
    if [ $with_backports = yes ] && [ -z "$(archive_of bookworm-backports)" ]; then
        local uri
        uri=$(archive_of bookworm)
        [ -n "$uri" ] || fail "apt has no source for the release bookworm, so there is none for bookworm-backports"
        backports_source "$uri" | as_root tee "$backports" >/dev/null
        as_root apt-get $apt_options update || fail "apt-get update failed; see above, and $backports"
    fi
    say "installing; this may take a minute"
    as_root apt-get $apt_options install -y --no-install-recommends "$@" >/dev/null || fail "apt-get install failed; see above"
}

# The packages of the list that are not installed.
missing() {
    local package
    for package; do is_installed "$package" || echo "$package"; done
}

build() {
    command -v cargo >/dev/null || fail "there is no Rust here (no cargo in PATH)" \
        "install it as https://www.rust-lang.org/tools/install says, open a new shell, and try again"
    local rust
    rust=$(cargo --version | awk '{ print $2 }')
    [ "$(printf '%s\n' $rust_needed "$rust" | sort -V | head -n 1)" = $rust_needed ] ||
        fail "Rust $rust is too old, $rust_needed is needed: run rustup update" "(without rustup, see https://www.rust-lang.org/tools/install)"
    command -v cc >/dev/null && return
    if has_apt; then install gcc libc6-dev; else fail "there is no C linker (cc): install gcc or clang"; fi
}

device_is_usable() { "${CARGO_TARGET_DIR:-target}/release/luminaire" devices >/dev/null 2>&1; }

# The packages that lavapipe with ray query needs and that are missing or too old.
lavapipe_packages() {
    missing libvulkan1
    local mesa
    mesa=$(installed_version mesa-vulkan-drivers)
    if [ -z "$mesa" ] || dpkg --compare-versions "$mesa" lt $mesa_needed; then
        if is_bookworm; then echo mesa-vulkan-drivers/bookworm-backports; else echo mesa-vulkan-drivers; fi
    fi
}

vulkan() {
    if device_is_usable; then return; fi
    if ! has_apt; then
        say "there is no usable Vulkan device, and this script cannot install one on $(system)"
        say "install the Vulkan loader and a driver (the GPU's, or Mesa's lavapipe: often mesa-vulkan-drivers or vulkan-swrast)"
        say "going on with the CPU reference"
        return
    fi
    local packages
    mapfile -t packages < <(lavapipe_packages)
    if [ ${#packages[@]} = 0 ]; then
        say "the Vulkan loader and Mesa's drivers are installed, but luminaire can use no device (see: luminaire devices)"
        return
    fi
    say "there is no usable Vulkan device; Mesa's lavapipe runs on any CPU"
    install "${packages[@]}"
}

# An older lavapipe that truly lacks ray query, beside the system's: Debian 12's own package, unpacked and not installed.
old_driver() {
    if [ -f $old_driver/lvp_icd.json ]; then return; fi
    local version library folder
    version=$(apt-cache madison mesa-vulkan-drivers | awk '$3 ~ /^22\./ { print $3; exit }')
    if [ -z "$version" ]; then
        say "SKIP: Mesa 22.3.6 (lavapipe without ray query) is not in this system's archive; tests on it will be skipped"
        return
    fi
    say "unpacking mesa-vulkan-drivers $version under $old_driver (it is not installed)"
    rm -rf $old_driver && mkdir -p $old_driver
    folder=$(mktemp -d)
    if ! (cd "$folder" && apt-get -qq -o APT::Sandbox::User=root download "mesa-vulkan-drivers=$version") || ! dpkg -x "$folder"/*.deb $old_driver; then
        say "SKIP: Mesa $version cannot be downloaded; tests on it will be skipped"
        rm -rf "$folder" $old_driver
        return
    fi
    rm -rf "$folder"
    library=$(cd $old_driver && echo usr/lib/*/libvulkan_lvp.so)
    if ldd "$old_driver/$library" | grep -q 'libLLVM-15.*not found'; then
        install libllvm15
    fi
    if ldd "$old_driver/$library" | grep 'not found'; then
        say "SKIP: Mesa $version lacks these libraries; tests on it will be skipped"
        rm -rf $old_driver
        return
    fi
    # A relative path counts from the file itself, so the folder may move.
    sed "s|\"library_path\": *\"[^\"]*\"|\"library_path\": \"./$library\"|" $old_driver/usr/share/vulkan/icd.d/lvp_icd.*.json \
        >$old_driver/lvp_icd.json
}

for_tests() {
    if ! has_apt; then
        say "on $(system) this script installs nothing. The tests want: the Vulkan loader, Mesa's lavapipe $mesa_needed or newer,"
        say "glslc (often in a package named shaderc), the Khronos validation layers, Xvfb and xdotool. Those that lack theirs say SKIP."
        return
    fi
    local packages
    mapfile -t packages < <(lavapipe_packages; missing glslc vulkan-validationlayers $window_packages "$@")
    if [ ${#packages[@]} != 0 ]; then install "${packages[@]}"; fi
    old_driver
}

case "${1:-}" in
build) build ;;
vulkan) vulkan ;;
test)
    build
    for_tests
    ;;
ci)
    build
    more=()
    python3 -m pip --version >/dev/null 2>&1 || more+=(python3-pip)
    command -v c++ >/dev/null || more+=(g++)
    for_tests "${more[@]}"
    ;;
*) fail "usage: scripts/setup.sh build|vulkan|test|ci" ;;
esac
