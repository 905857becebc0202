#!/bin/bash
# Renders a scene on a Slurm cluster: an array of tasks, each with samples of its own, and a job that merges their
# images. The same command again submits what is missing, from the checkpoints of unfinished tasks, and the merge.
#
#   usage: submit.sh [OPTIONS] SCENE --spp N -o IMAGE [-o IMAGE...] [OPTIONS of candela render]
#
# Options, and their variables:
#   --part N        CANDELA_PART        samples of a task; else as many as --task-time allows
#   --task-time M   CANDELA_TASK_TIME   the limit of a task for Slurm in minutes (30); rendering gets half of them
#   --speed S       CANDELA_SPEED       samples per pixel that a node renders in a minute; else measured here, for 5 s
#   --folder F      CANDELA_FOLDER      where parts, checkpoints, reports and logs go (IMAGE.parts); all nodes must see it
#                   CANDELA             the program (candela)
# Everything else is set by Slurm's own variables, such as SBATCH_PARTITION, SBATCH_ACCOUNT and SBATCH_GRES.
set -euo pipefail
scripts=$(cd "$(dirname "$0")" && pwd)
candela=${CANDELA:-candela}
part=${CANDELA_PART:-} task_time=${CANDELA_TASK_TIME:-30} speed=${CANDELA_SPEED:-} folder=${CANDELA_FOLDER:-}

fail() {
    echo "submit.sh: $*" >&2
    exit 2
}
usage() {
    sed -n '2,/^set -/{/^set -/d; s/^# \{0,1\}//; p}' "$0"
}
# shown TEXT: prints what may come from anywhere, cut and without control characters.
shown() {
    local LC_ALL=C
    printf '"%s"' "${1:0:40}" | LC_ALL=C tr -c '[:print:]' '?'
}
# whole NAME VALUE [REMEDY]: sets REPLY to the decimal number; fails unless it is a whole number above 0.
whole() {
    local LC_ALL=C
    [[ $2 =~ ^0*([1-9][0-9]{0,8})$ ]] || fail "$1: cannot use $(shown "$2"); expected a whole number above 0${3:+; $3}"
    REPLY=${BASH_REMATCH[1]}
}
# job_number TEXT: sets REPLY to the number of a job that sbatch printed.
job_number() {
    [[ $1 =~ ^([0-9]{1,10})(\;.*)?$ ]] || fail "sbatch printed $(shown "$1"), which is not the number of a job"
    REPLY=${BASH_REMATCH[1]}
}

while [ $# -gt 0 ]; do
    case $1 in
        --part | --task-time | --speed | --folder) [ $# -gt 1 ] || fail "$1 lacks its value" ;;&
        --part) part=$2; shift 2 ;;
        --task-time) task_time=$2; shift 2 ;;
        --speed) speed=$2; shift 2 ;;
        --folder) folder=$2; shift 2 ;;
        -h | --help) usage; exit 0 ;;
        -*) fail "$1 is not an option of submit.sh; give candela's options after the scene, and a file as ./$1" ;;
        *) break ;;
    esac
done
[ $# -gt 0 ] || { usage >&2; exit 2; }
scene=$1
shift
outputs=() options=() spp=
while [ $# -gt 0 ]; do
    case $1 in
        -o | --output) [ $# -gt 1 ] || fail "$1 lacks its value"; outputs+=("$2"); shift 2 ;;
        --output=*) outputs+=("${1#*=}"); shift ;;
        -o?*) outputs+=("${1#-o}"); shift ;;
        --spp) [ $# -gt 1 ] || fail "$1 lacks its value"; spp=$2; shift 2 ;;
        --spp=*) spp=${1#*=}; shift ;;
        --samples* | --adaptive | --target-error* | --time-limit* | --checkpoint | --checkpoint=* | --resume | --report* | --reference*)
            fail "$1 is not for parts of a rendering; leave it out" ;;
        *) options+=("$1"); shift ;;
    esac
done
[ -n "$spp" ] || fail "--spp is missing: the samples per pixel of the whole picture"
[ ${#outputs[@]} -gt 0 ] || fail "no output given; use -o FILE.exr, -o FILE.png, or both"
outputs=("${outputs[@]/#-/./-}")  # A name that begins with a dash is not an option.
whole --spp "$spp"
spp=$REPLY
whole --task-time "$task_time"
task_time=$REPLY
[ -z "$part" ] || { whole --part "$part"; part=$REPLY; }
[[ -z $speed || $speed =~ ^[0-9]{1,12}(\.[0-9]{0,12})?$ && $speed =~ [1-9] ]] ||
    fail "--speed: cannot use $(shown "$speed"); expected samples per pixel and minute, above 0"
[ -f "$scene" ] || fail "$scene does not exist; check the name"
command -v "$candela" >/dev/null || fail "there is no program \"$candela\"; set CANDELA to where it is"
command -v sbatch >/dev/null || fail "there is no sbatch: this machine does not submit to Slurm"
folder=${folder:-${outputs[0]%.*}.parts}
[[ $folder != *[$'\n\\']* ]] ||
    fail "$(shown "$folder"): Slurm cannot write to a folder whose name has a line feed or a backslash; give another --folder"
[[ $folder == /* ]] || folder=$PWD/$folder
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
# Slurm's lists of names have commas, and two folders may have one name.
job=$(basename "$folder" | LC_ALL=C tr -c 'A-Za-z0-9._\n' _)
job=candela-$job-$(cksum <<<"$folder" | cut -d ' ' -f 1)

queued=$(squeue --noheader --me --name="$job,$job-merge" --format=%A | sort -u | tr '\n' ' ')
[ -z "$queued" ] || fail "jobs of this picture are still in the queue: ${queued% }; wait for them, or scancel them"

# A task has the same samples each time, so that it finds its checkpoint.
if [ -f "$folder/part-size" ]; then
    whole "$folder/part-size" "$(head -c 64 "$folder/part-size" | tr '\0' '?')" \
        "write the samples of its tasks there again, or give another --folder"
    before=$REPLY
    [ -z "$part" ] || [ "$part" = "$before" ] || fail "--part: $folder was begun with $before; keep it, or give another --folder"
    part=$before
elif [ -z "$part" ]; then
    if [ -z "$speed" ]; then
        echo "Measuring the speed of this machine; --speed gives that of the nodes"
        report=$("$candela" render "$scene" ${options[@]+"${options[@]}"} --spp 16777216 --time-limit 5s --quiet --report - -o "$folder/speed.exr")
        rm -f "$folder/speed.exr"
        # number NAME: prints a number of the report.
        number() {
            sed -n "s/^ *\"$1\": *\([0-9][0-9.e+-]*\),*$/\1/p" <<<"$report" | grep . || fail "the report of $candela has no $1"
        }
        rate=$(number samples_per_second)
        width=$(number width)
        height=$(number height)
        speed=$(LC_ALL=C awk -v rate="$rate" -v width="$width" -v height="$height" \
            'BEGIN { print 60 * rate / (width * height) }')
    fi
    part=$(LC_ALL=C awk -v speed="$speed" -v minutes="$task_time" -v spp="$spp" \
        'BEGIN { n = int(speed * minutes / 2); if (n < 1) n = 1; if (n > spp) n = spp; print n }')
fi
echo "$part" >"$folder/part-size.new"
mv -T "$folder/part-size.new" "$folder/part-size"
tasks=$(((spp + part - 1) / part))
whole "MaxArraySize of scontrol show config" "$(scontrol show config | sed -n 's/^MaxArraySize *= *//p')"
most=$REPLY
[ "$tasks" -lt "$most" ] || fail "$tasks tasks of $part sample(s) are more than Slurm allows, $((most - 1)); give a longer --task-time or a larger --part"

# The tasks whose samples no part holds yet, in Slurm's notation.
parts=("$folder"/part-*.exr)
if [ -e "${parts[0]}" ]; then
    missing=$("$candela" merge --missing "0..$spp" "${parts[@]}")
else
    missing=0..$spp
fi
array=$(while IFS= read -r range; do
    [ -n "$range" ] || continue
    [[ $range =~ ^([0-9]{1,9})\.\.([0-9]{1,9})$ ]] || fail "$candela printed $(shown "$range") as missing samples"
    seq $((10#${BASH_REMATCH[1]} / part)) $(((10#${BASH_REMATCH[2]} - 1) / part))
done <<<"$missing" | sort -nu | awk '  # 0 1 2 5 becomes 0-2,5
    function flush() { printf "%s%s", separator, first == last ? first : first "-" last; separator = "," }
    NR > 1 && $1 == last + 1 { last = $1; next }
    NR > 1 { flush() }
    { first = last = $1 }
    END { if (NR) flush() }')

logs=${folder//%/%%}  # Slurm replaces %x and its like.
dependency=()
if [ -n "$array" ]; then
    tasks_job=$(sbatch --parsable --job-name="$job" --array="$array" --time="$task_time" --output="$logs/%x-%A-%a.log" \
        "$scripts/render.sbatch" "$candela" "$folder" "$part" "$spp" "$scene" ${options[@]+"${options[@]}"})
    job_number "$tasks_job"
    tasks_job=$REPLY
    dependency=(--dependency="afterany:$tasks_job")
    echo "Job $tasks_job: tasks $array of $part sample(s) each"
fi
merge_job=$(sbatch --parsable --job-name="$job-merge" ${dependency[@]+"${dependency[@]}"} --output="$logs/merge.log" \
    "$scripts/merge.sbatch" "$candela" "$folder" "$spp" "${outputs[@]}")
job_number "$merge_job"
merge_job=$REPLY
echo "Job $merge_job: merges them to ${outputs[*]}"
echo "Watch them: squeue --job=${tasks_job:+$tasks_job,}$merge_job; tail $(printf %q "$folder")/*.log"
echo "If a task fails, the merge says so in $folder/merge.log: the same command again submits what is missing."
