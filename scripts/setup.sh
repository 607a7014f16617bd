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
        # One line for each architecture of a package.
        dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
            echo "$package"
    done
}

# Installs those of "$@" that are missing. Says what it does; silent when there is nothing to do.
nuvo_install() {
    local missing=() package sudo=()
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
    # The lock may be held by the system's own upgrades for a while.
    local apt=("${sudo[@]}" env DEBIAN_FRONTEND=noninteractive
        apt-get -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 -q)
    echo "Installing ${missing[*]}" >&2
    nuvo_watch_quietly "Reading the list of packages" "${apt[@]}" update &&
        nuvo_watch_quietly "Installing, about a minute" \
            "${apt[@]}" install -y --no-install-recommends "${missing[@]}" && return 0
    echo "Could not install ${missing[*]}" >&2
    return 1
}

# Shows where a command is from the lines it prints: steps of ninja and ctest, packages of apt.
nuvo_show_progress() {
    local title=$1 line where
    while IFS= read -r line; do
        if [[ $line =~ ^\[([0-9]+/[0-9]+)\] || $line =~ ^\ *([0-9]+/[0-9]+)\ Test ]]; then
            where=${BASH_REMATCH[1]}
        elif [[ $line =~ ^(Get:|Unpacking|Setting\ up) ]]; then
            where=${line%% (*}
        else
            continue
        fi
        printf '\r%-78.78s' "$title: $where" >&2
    done
    printf '\r%-78s\r' "" >&2
}

# nuvo_watch TITLE LOG COMMAND...: says what it does, on a terminal how far it is; the command's
# output goes to LOG.
nuvo_watch() {
    local title=$1 log=$2 status=0
    shift 2
    if [ -t 2 ]; then
        (set -o pipefail; "$@" 2>&1 | tee "$log" | nuvo_show_progress "$title") || status=$?
    else
        echo "$title" >&2
        "$@" >"$log" 2>&1 || status=$?
    fi
    return $status
}

# The same with a log that only a failure shows.
nuvo_watch_quietly() {
    local log status=0
    log=$(mktemp)
    nuvo_watch "$1" "$log" "${@:2}" || status=$?
    [ $status -eq 0 ] || cat "$log" >&2
    rm -f "$log"
    return $status
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

# Ends where the address sanitizer would take each stack for overrun: it reads its bounds there.
nuvo_check_proc() {
    [ -r /proc/self/maps ] && return
    echo "${0##*/}: the sanitizers need /proc (mount -t proc proc /proc)${1:+, or $1}" >&2
    exit 2
}

# Seconds of one core that a step of a build takes: with one instruction set, under sanitizers, else.
nuvo_step_seconds() { case $1 in native) echo 1 ;; fuzz | sanitize | thread) echo 6 ;; *) echo 2 ;; esac; }

# Configures and builds a preset: nuvo_build PRESET [target]...
nuvo_build() {
    local preset=$1 target options=() message steps minutes plural=
    shift
    for target in "$@"; do options+=(--target "$target"); done
    (
        cd "$nuvo_root"
        # A build tree that was moved or copied along with the sources cannot be used.
        if [ -f "build/$preset/CMakeCache.txt" ] &&
            ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$nuvo_root" "build/$preset/CMakeCache.txt"; then
            rm -rf "build/$preset"
        fi
        nuvo_quietly cmake --preset "$preset" || exit 1
        # Only of a new tree is it known how much there is to do: a dry run stops where files are
        # looked for again.
        message=Building
        if [ ! -f "build/$preset/.ninja_log" ]; then
            steps=$(ninja -C "build/$preset" -t commands "$@" 2>/dev/null | wc -l) || steps=0
            minutes=$((steps * $(nuvo_step_seconds "$preset") / $(nproc) / 60 + 1))
            [ $minutes -eq 1 ] || plural=s
            message="Building, about $minutes minute$plural"
        fi
        nuvo_watch_quietly "$message" cmake --build --preset "$preset" "${options[@]}"
    )
}
