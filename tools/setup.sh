# Sourced by `run` and `test`: makes sure that the packages of packages.txt are there, then configures and builds.
# The caller has done `set -euo pipefail` and stands in the repository's root.

say() { printf '%s\n' "$*"; }
stop() { printf '%s: error: %s\n' "${0##*/}" "$*" >&2; exit 1; }

# is_at_least HAVE NEED: compares dotted versions.
is_at_least() { [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]; }

# is_there KIND NAME [LEAST]: is a command (of at least that version), a header or a file on this system?
is_there() {
    case $1 in
        cmd)
            command -v "$2" >/dev/null 2>&1 || return 1
            [ -z "${3:-}" ] || is_at_least "$("$2" --version 2>&1 | grep -oE '[0-9]+(\.[0-9]+)+' | head -n 1)" "$3" ;;
        header)
            local folder
            for folder in /usr/include /usr/local/include /opt/homebrew/include; do
                [ ! -e "$folder/$2" ] || return 0
            done
            return 1 ;;
        file) [ -e "$2" ] ;;
        *) stop "packages.txt: found '$1', need cmd, header or file" ;;
    esac
}

# missing_packages PURPOSE…: the packages of packages.txt for these purposes that are not there, a line each.
missing_packages() {
    local package purpose kind name least
    while read -r package purpose kind name least; do
        case " $* " in *" ${purpose%\?} "*) ;; *) continue ;; esac
        is_there "$kind" "$name" "$least" || say "$package"
    done < <(sed 's/#.*//; /^[[:space:]]*$/d' packages.txt)
}

# is_optional PACKAGE: may it be left out where the system has no such package?
is_optional() { grep -qE "^$1[[:space:]]+[a-z]+\?[[:space:]]" packages.txt; }

# install_packages PURPOSE…: installs what is missing with apt; elsewhere names it and stops.
install_packages() {
    local missing wanted=() package as_root=()
    mapfile -t missing < <(missing_packages "$@")
    [ ${#missing[@]} -gt 0 ] || return 0
    command -v apt-get >/dev/null 2>&1 || stop "missing on this system (Debian's names): ${missing[*]}"
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null 2>&1 || stop "missing packages; as root: apt-get install ${missing[*]}"
        as_root=(sudo)
        [ -t 0 ] || as_root=(sudo -n)
    fi
    say "installing ${missing[*]}"
    mkdir -p build
    if ! {
        "${as_root[@]}" apt-get update -q || true
        for package in "${missing[@]}"; do
            if ! is_optional "$package" || apt-cache show "$package" >/dev/null 2>&1; then wanted+=("$package"); fi
        done
        [ ${#wanted[@]} -eq 0 ] ||
            "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${wanted[@]}"
    } </dev/null >build/packages.log 2>&1; then
        tail -n 15 build/packages.log >&2
        stop "apt-get could not install ${wanted[*]}; the whole log: build/packages.log"
    fi
    mapfile -t missing < <(missing_packages "$@")
    wanted=()
    for package in "${missing[@]}"; do is_optional "$package" || wanted+=("$package"); done
    [ ${#wanted[@]} -eq 0 ] || stop "installed, but still not usable: ${wanted[*]}"
}

# configure PRESET [OPTION=VALUE…]: makes the build folder, or changes these options of one that is there.
configure() {
    local preset=$1 option options=() changed=
    shift
    for option in "$@"; do
        options+=(-D "$option")
        grep -qE "^${option%%=*}:[A-Z]+=${option#*=}\$" "build/$preset/CMakeCache.txt" 2>/dev/null || changed=1
    done
    [ -n "$changed" ] || [ ! -e "build/$preset/build.ninja" ] || return 0
    mkdir -p "build/$preset"
    say "configuring build/$preset"
    cmake --preset "$preset" "${options[@]}" >"build/$preset/configure.log" 2>&1 || {
        tail -n 30 "build/$preset/configure.log" >&2
        stop "cmake could not configure; the whole log: build/$preset/configure.log"
    }
}

# build PRESET [TARGET…]: builds what configure() made.
build() {
    local preset=$1
    shift
    say "building build/$preset"
    cmake --build "build/$preset" ${1:+--target "$@"}
}
