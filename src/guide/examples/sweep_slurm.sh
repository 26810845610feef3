#!/bin/bash
# A sweep in parts under Slurm: an array job runs them, a job that depends on it merges them, and parts that are not there
# (killed, out of memory, their node gone) are run again, three times at most.
#
#   sweep_slurm.sh PARTS FOLDER PROGRAM [words of rigidtap sweep]...
#   sweep_slurm.sh 8 out gcode/s7000.ngc --runs 100000 --law torque-curve-smooth --share 0.75
#
# The report of the whole is FOLDER/report.json. RIGIDTAP is the program, CPUS the cores of one part, SBATCH_... what sbatch
# itself reads (SBATCH_PARTITION, SBATCH_ACCOUNT, SBATCH_TIMELIMIT). FOLDER has to be on a disk that every node sees.
set -euo pipefail

# Part K of N, as one task of the array. A part's file appears whole or not at all.
part() {
    "$RIGIDTAP" sweep "$@" --quiet --jobs "$CPUS" \
        --shard "$SLURM_ARRAY_TASK_ID/$PARTS" --out "$FOLDER/$SLURM_ARRAY_TASK_ID.part"
}

merge() {
    local missing=() files=() number
    for ((number = 1; number <= PARTS; number++)); do
        files+=("$FOLDER/$number.part")
        if [[ ! -e $FOLDER/$number.part ]]; then missing+=("$number"); fi
    done
    if ((${#missing[@]} > 0)); then
        echo "round $ROUND: parts ${missing[*]} are missing" >&2
        if ((ROUND >= 3)); then exit 1; fi
        ROUND=$((ROUND + 1)) submit "$(IFS=, && echo "${missing[*]}")" "$@"
        return
    fi
    "$RIGIDTAP" sweep "$@" --quiet --format json --merge "${files[@]}" >"$FOLDER/report.json.part"
    mv "$FOLDER/report.json.part" "$FOLDER/report.json"
}

# submit PARTS_TO_RUN words...
submit() {
    local array=$1 job
    shift
    # sbatch runs a copy of this file: the copy is told where this one is.
    export SCRIPT PARTS FOLDER ROUND RIGIDTAP CPUS
    job=$(sbatch --parsable --array="$array" --cpus-per-task="$CPUS" --job-name=rigidtap-part \
        --output="$FOLDER/part-%a.log" --open-mode=append "$SCRIPT" part "$@")
    sbatch --parsable --dependency="afterany:$job" --job-name=rigidtap-merge \
        --output="$FOLDER/merge.log" --open-mode=append "$SCRIPT" merge "$@"
}

case ${1-} in
    part | merge) "$@" ;;
    [1-9]*)
        PARTS=$1 FOLDER=$(realpath -m "$2") ROUND=1
        SCRIPT=$(realpath "$0") RIGIDTAP=${RIGIDTAP:-rigidtap} CPUS=${CPUS:-1}
        shift 2
        mkdir -p "$FOLDER"
        # What another sweep left there is not merged into this one.
        rm -f "$FOLDER"/*.part "$FOLDER"/report.json
        submit "1-$PARTS" "$@"
        ;;
    *)
        echo "usage: $0 PARTS FOLDER PROGRAM [words of rigidtap sweep]..." >&2
        exit 2
        ;;
esac
