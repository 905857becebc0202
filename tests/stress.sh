#!/bin/sh
# Repeats the tests that wait (for windows, signals, intervals, time limits, failing devices, clients) beside other work:
# at nice 5, beside four busy loops, each of which has a session of its own, like the work of other users. Up to eight
# repetitions run at once, four tests at a time in each, which makes it harder for each and an hour of fifty. (A test at
# nice 5 gets a third of a loop's time, so the four of a repetition get about as much as one loop, which is also what a
# repetition gets where Linux groups tasks by session.)
#   usage: sh tests/stress.sh [REPETITIONS [TESTS]]   (50; TESTS: a regular expression of names, as for ctest -R)
set -eu
cd "$(dirname "$0")/.."
repetitions=${1:-50}
windows='View\.|ViewControls|ViewUsage|Presenter'
signals='Interrupt|CheckpointTest|AdaptiveCli.AResumed|AnInterrupted|ChangedPlaces|cli.Kills'
intervals='Progressive|TimeLimit|ByTheClock|CpuTime|IsTimed'
devices='DeviceFailure|SteadyRenderer'
servers='ServerTest|^serve$|^python$'
tests=${2:-$windows|$signals|$intervals|$devices|$servers}

# CTest asks the programs for their tests where they are new. It keeps the answers in build/release, so once, and alone.
number=$(ctest --test-dir build/release -R "$tests" -LE '^slow$' --show-only | sed -n 's/^Total Tests: *//p')
echo "$number tests in each repetition"
[ "$number" -gt 0 ]

folder=$PWD/build/stress
jobs=
trap 'kill $jobs 2>/dev/null' EXIT
trap 'exit 1' INT TERM
for _ in 1 2 3 4; do
    setsid sh -c 'while :; do :; done' &
    jobs="$jobs $!"
done

# repeat WORKER: every eighth repetition. CTest keeps its notes in a folder, so each worker has one of its own.
repeat() {
    running=
    trap '[ -z "$running" ] || kill -- "-$running" 2>/dev/null' EXIT
    trap 'exit 1' TERM
    mkdir -p "$folder/$1"
    echo "subdirs(\"$PWD/build/release\")" >"$folder/$1/CTestTestfile.cmake"
    for repetition in $(seq "$1" 8 "$repetitions"); do
        setsid nice -n 5 ctest --test-dir "$folder/$1" -R "$tests" -LE '^slow$' --output-on-failure \
            --parallel 4 >"$folder/$repetition.log" 2>&1 &
        running=$!
        wait "$running" || {
            echo "repetition $repetition failed: $folder/$repetition.log"
            return 1
        }
        running=
        grep -q "tests passed, 0 tests failed out of $number\$" "$folder/$repetition.log" || {
            echo "repetition $repetition ran other tests: $folder/$repetition.log"
            return 1
        }
        echo "repetition $repetition of $repetitions passed"
    done
}
workers=
for worker in 1 2 3 4 5 6 7 8; do
    repeat "$worker" &
    workers="$workers $!" jobs="$jobs $!"
done
failed=0
for worker in $workers; do
    wait "$worker" || failed=1
done
exit "$failed"
