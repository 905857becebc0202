#!/bin/sh
# Repeats the tests that wait (for windows, signals, intervals, time limits, failing devices) beside other work: four at
# a time, at nice 19, beside four busy loops, each of which has a session of its own, like the work of other users.
#   usage: sh tests/stress.sh [REPETITIONS [TESTS]]   (50; TESTS: a regular expression of names, as for ctest -R)
set -eu
cd "$(dirname "$0")/.."
repetitions=${1:-50}
windows='View\.|ViewControls|ViewUsage|Presenter'
signals='Interrupt|CheckpointTest|AdaptiveCli.AResumed|AnInterrupted|OneFailing'
intervals='Progressive|TimeLimit|ByTheClock|CpuTime|IsTimed'
devices='DeviceFailure|SteadyRenderer'
tests=${2:-$windows|$signals|$intervals|$devices}

loops=
trap 'kill $loops' EXIT
trap 'exit 1' INT TERM
for _ in 1 2 3 4; do
    setsid sh -c 'while :; do :; done' &
    loops="$loops $!"
done
for repetition in $(seq "$repetitions"); do
    echo "repetition $repetition of $repetitions"
    nice -n 19 ctest --preset ci -R "$tests" --stop-on-failure --parallel 4
done
