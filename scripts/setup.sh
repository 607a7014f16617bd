# Sourced by the other scripts: finds the project's root and installs what a build needs.
# Debian 12 or a relative of it; elsewhere the tools must be there already.

nuvo_root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)

nuvo_packages=(cmake ninja-build g++ libboost-dev libboost-chrono-dev
    libboost-program-options-dev libnlopt-cxx-dev libgtest-dev nlohmann-json3-dev
    zlib1g-dev libpng-dev libgeos-dev libhwy-dev python3)

# The packages of "$@" that are not installed, one a line.
nuvo_missing_packages() {
    local package
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
            echo "$package"
    done
}

# Installs those of "$@" that are missing. Says what it does; silent when there is nothing to do.
nuvo_install() {
    local missing=() package sudo=() log
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        command -v cmake >/dev/null && command -v ninja >/dev/null && return 0
        echo "No apt-get here: please install the equivalents of: $*" >&2
        return 1
    fi
    # No process substitution here: it needs /proc, which a bare root may not have.
    for package in $(nuvo_missing_packages "$@"); do missing+=("$package"); done
    [ ${#missing[@]} -eq 0 ] && return 0
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "Please install as root: apt-get install ${missing[*]}" >&2
            return 1
        fi
        sudo=(sudo)
    fi
    echo "Installing ${missing[*]}" >&2
    log=$(mktemp)
    # The lock may be held by the system's own upgrades for a while.
    if "${sudo[@]}" apt-get -o DPkg::Lock::Timeout=300 -qq update >"$log" 2>&1 &&
        "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -qq \
            install -y --no-install-recommends "${missing[@]}" >>"$log" 2>&1; then
        rm -f "$log"
        return 0
    fi
    cat "$log" >&2
    rm -f "$log"
    echo "Could not install ${missing[*]}" >&2
    return 1
}

# Runs "$@" with its output kept back; shows it all if the command fails.
nuvo_quietly() {
    local log status=0
    log=$(mktemp)
    "$@" >"$log" 2>&1 || status=$?
    [ $status -eq 0 ] || cat "$log" >&2
    rm -f "$log"
    return $status
}

# Configures and builds a preset: nuvo_build PRESET [target]...
nuvo_build() {
    local preset=$1 target options=()
    shift
    for target in "$@"; do options+=(--target "$target"); done
    (
        cd "$nuvo_root"
        # A build tree that was moved or copied along with the sources cannot be used.
        if [ -f "build/$preset/CMakeCache.txt" ] &&
            ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$nuvo_root" "build/$preset/CMakeCache.txt"; then
            rm -rf "build/$preset"
        fi
        nuvo_quietly cmake --preset "$preset" &&
            nuvo_quietly cmake --build --preset "$preset" "${options[@]}"
    )
}
