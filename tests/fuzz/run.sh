#!/bin/sh
# Builds the fuzzers of this folder with Clang, AddressSanitizer and UndefinedBehaviorSanitizer and runs them, each with
# 512 MiB and five seconds per input; the slowest known one takes one second on an idle machine. Findings are in
# build/fuzz/findings, and make the exit code differ from 0.
#   usage: sh tests/fuzz/run.sh [-max_total_time=SECONDS | -runs=INPUTS] [TARGET...]   (180 seconds; all targets)
# New inputs are kept in build/fuzz/corpora, for the next time.
set -eu
cd "$(dirname "$0")/../.."
effort=-max_total_time=180
case ${1:-} in -*) effort=$1; shift ;; esac
# shellcheck disable=SC2046  # The names of targets are words.
[ $# -gt 0 ] || set -- $(ls tests/fuzz/corpora)

if ! command -v clang++ >/dev/null; then
    . cmake/setup.sh
    install_packages render test
fi
sh cmake/basisu.sh
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz
mkdir -p build/fuzz/findings
export effort
export ASAN_OPTIONS=quarantine_size_mb=16 UBSAN_OPTIONS=print_stacktrace=1
# Runs as many at a time as there are processors; each says at its end how many inputs it ran.
# shellcheck disable=SC2016  # The inner shells replace these.
printf '%s\n' "$@" | xargs -P "$(nproc)" -I NAME sh -c '
    name=NAME
    mkdir -p "build/fuzz/corpora/$name"
    more=
    if [ "$name" = ktx ]; then more=build/basisu/fixtures; fi
    if "build/fuzz/tests/fuzz_$name" $effort -rss_limit_mb=512 -timeout=5 "-dict=tests/fuzz/$name.dict" \
        "-artifact_prefix=build/fuzz/findings/$name-" -print_final_stats=1 -verbosity=0 \
        "build/fuzz/corpora/$name" "tests/fuzz/corpora/$name" $more >"build/fuzz/$name.log" 2>&1; then
        echo "$name: $(sed -n "s/stat::number_of_executed_units: *//p" "build/fuzz/$name.log") inputs, no finding"
    else
        tail -n 40 "build/fuzz/$name.log"
        echo "$name: FOUND something; see build/fuzz/$name.log and build/fuzz/findings"
        exit 1
    fi'
