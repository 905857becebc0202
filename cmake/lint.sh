#!/bin/sh
# Runs clang-tidy over the sources in host/ that differ from the merge base with origin/main, or include a header that
# does; over all of them where there is no older base or the rules differ, or with `all`.   usage: sh cmake/lint.sh [all]
set -eu
cd "$(dirname "$0")/.."

# changed BASE: the files of ours that differ from the commit BASE, each on a line.
changed() {
    git diff --name-only --diff-filter=d "$1" -- host shaders/shared
}

# sources BASE: the sources that `changed` names, or that include a header that it names.
sources() {
    changed "$1" | grep '^host/.*\.cpp$' || true
    changed "$1" | grep '\.h$' | sed 's,^host/,,; s,^shaders/,,' | while read -r header; do
        grep -rlF "#include \"$header\"" host --include='*.cpp' || true
    done
}

base=$(git merge-base HEAD origin/main 2>/dev/null || true)
if [ "${1:-}" = all ] || [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ] ||
    ! git diff --quiet "$base" -- .clang-tidy; then
    files=$(find host -name '*.cpp')
    echo "clang-tidy: all sources of host/"
else
    files=$(sources "$base" | sort -u)
    echo "clang-tidy: what changed since $base:" $files
fi
[ -n "$files" ] || exit 0

# Each file on its own, with what CMake generates when it configures.
cmake --preset debug >build/lint.log || { cat build/lint.log; exit 1; }
printf '%s\n' $files | xargs -P "$(nproc)" -n 1 clang-tidy -quiet -p build/debug
