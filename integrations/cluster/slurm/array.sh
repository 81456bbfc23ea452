#!/bin/bash
# A sweep as an array of jobs, without Dask or Ray, and a last job that takes their parts over.
# On a shared disk: bash array.sh FOLDER JOBS [options of sbatch, such as --time=02:00:00] [-- options of sweep.py]
set -euo pipefail
folder=$1 jobs=$2
shift 2
options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  options+=("$1")
  shift
done
shift $(($# > 0))
sweep="python sweep.py '$folder' --threads \${SLURM_CPUS_PER_TASK:-1} $*"
array=$(sbatch --parsable --job-name=armill --output=armill-%A_%a.log --array=0-$((jobs - 1)) "${options[@]}" \
  --wrap "$sweep --shard \$SLURM_ARRAY_TASK_ID $jobs")
# Also after a failed job: the last one computes what is missing.
last=$(sbatch --parsable --job-name=armill --output=armill-%j.log --dependency=afterany:"$array" "${options[@]}" --wrap "$sweep")
echo "array $array, then job $last"
