#!/bin/bash
# fuzz_for.sh TARGET CORPUS: fuzzes for ${FUZZ_SECONDS:-5} s, starting from the corpus. New inputs go to a scratch folder,
# what fails to ${FUZZ_ARTIFACTS:-crashes beside the folder of the program}. Status 1 where something failed: libFuzzer's
# own 77 would read as "skipped".
# The corpus is replayed first. New inputs follow from ${FUZZ_SEED}, by default the day (UTC, as 20261122): a check that
# fails can be run again on that day, or later with the seed that it prints.
set -eu
seed=${FUZZ_SEED:-$(date -u +%Y%m%d)}
echo "seed $seed (FUZZ_SEED=$seed repeats it)"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/new"
artifacts=${FUZZ_ARTIFACTS:-$(dirname "$1")/../crashes}
mkdir -p "$artifacts"
"$1" -seed="$seed" -max_total_time="${FUZZ_SECONDS:-5}" -timeout=5 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=0 -verbosity=0 \
  -artifact_prefix="$artifacts/" "$scratch/new" "$2" || exit 1
