# Sourced by run and nightly: stages, and how long each took.
# shellcheck shell=bash

# Warnings are errors with the compiler of Debian 12 alone: others, which users may have, warn of other things.
# shellcheck disable=SC2034  # The scripts that source this one use it.
strict=-DCANDELA_WERROR=GNU-12
took=()

# stage NAME COMMAND...: runs it in a shell of its own, so that what it exports ends with it; when the script ends, all
# stages are listed with their seconds, a failed one last.
stage() {
    running=$1 began=$SECONDS
    echo "=== $1"
    ("${@:2}")
    took+=("$(printf '%-14s %5d s' "$1" $((SECONDS - began)))")
    running=
}

# on_this_system COMMAND...: runs it; its exit code 3 says that it is for another system.
on_this_system() {
    "$@" || [ $? -eq 3 ]
}

report() {
    printf '%s\n' "${took[@]}"
    [ -z "$running" ] || echo "$running failed after $((SECONDS - began)) s"
    echo "all stages     $(printf '%5d' $SECONDS) s"
}
running=
trap report EXIT
