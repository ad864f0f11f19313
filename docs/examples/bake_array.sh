#!/bin/bash
# Hundreds of bodies on a Slurm cluster: eight tasks bake an eighth of the scenes each, and when all have ended a ninth
# says what the folder has. Scenes, meshes and the folder are on a file system that the nodes share. From this folder:
#   sbatch bake_array.sh patients images          # folder of scenes (.toml), folder of images
# An array that was cut off is submitted again: what is baked is kept.
#SBATCH --job-name=palpate-bake
#SBATCH --array=1-8
#SBATCH --cpus-per-task=2
#SBATCH --mem=4G
#SBATCH --time=04:00:00
set -euo pipefail
scenes=("${1:?folder of scenes}"/*.toml)
images=${2:?folder of images}
[ "$SLURM_ARRAY_TASK_ID" -ne 1 ] ||
  sbatch --job-name=palpate-merge --dependency="afterany:$SLURM_ARRAY_JOB_ID" --wrap="palpate bake ${scenes[*]@Q} -o ${images@Q} --merge"
palpate bake "${scenes[@]}" -o "$images" --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --jobs "$SLURM_CPUS_PER_TASK"
