# Sourced by demo.sh and test.sh: installs the missing packages of packages.txt with apt, as root or with sudo. Does
# nothing, and needs no network, if none is missing.
# shellcheck shell=sh
# shellcheck disable=SC2005,SC2046,SC2086  # Lists of packages split into words; `echo $(...)` makes a line of several.

# packages WHEN...: prints the names in packages.txt that are for one of these uses.
packages() {
    grep -v '^#' cmake/packages.txt | while read -r name when purpose; do
        case " $* " in *" $when "*) echo "$name" ;; esac
    done
}

# list_packages NAME...: prints each on a line with what it is for.
list_packages() {
    grep -v '^#' cmake/packages.txt | while read -r name when purpose; do
        case " $* " in *" $name "*) printf '  %-24s  %s\n' "$name" "$purpose" ;; esac
    done
}

# missing NAME...: prints those that are not installed, but optional ones only if apt can install them.
missing() {
    for name in "$@"; do
        status=$(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null) || status=absent
        [ "$status" != installed ] || continue
        case " $(echo $(packages optional)) " in
            *" $name "*) apt-cache show "$name" >/dev/null 2>&1 || continue ;;
        esac
        echo "$name"
    done
}

# as_root COMMAND...
as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

# give_up REASON NAME...: says why nothing can be installed here, and what is needed.
give_up() {
    echo "$1 Install these yourself, by the names that your system has for them:" >&2
    shift
    list_packages "$@" >&2
    exit 1
}

# install_packages WHEN...: installs the missing packages for these uses.
install_packages() {
    wanted=$(echo $(packages "$@"))
    command -v apt-get >/dev/null || give_up "This system has no apt-get." $wanted
    absent=$(missing $wanted)
    [ -n "$absent" ] || return 0
    if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
        give_up "Packages are missing, and without root or sudo none can be installed." $absent
    fi
    echo "Updating apt's lists of packages"
    as_root apt-get update -qq
    # Again: before the update, a fresh system knew no optional package.
    absent=$(echo $(missing $wanted))
    echo "Installing these packages, and what they depend on:"
    list_packages $absent
    as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends -o DPkg::Lock::Timeout=300 $absent
}
