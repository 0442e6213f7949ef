#!/bin/bash
# fuzz_for.sh TARGET CORPUS: fuzzes for ${FUZZ_SECONDS:-5} s, starting from the corpus. New inputs go to a scratch folder,
# what fails to ${FUZZ_ARTIFACTS:-crashes beside the folder of the program}. Status 1 where something failed: libFuzzer's
# own 77 would read as "skipped".
# The inputs are the same each time, so that a check that fails can be run again, and fails for what was changed; hunts
# for what nobody has found yet take another seed: docs/sanitizers.md.
set -eu
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/new"
artifacts=${FUZZ_ARTIFACTS:-$(dirname "$1")/../crashes}
mkdir -p "$artifacts"
"$1" -seed="${FUZZ_SEED:-1}" -max_total_time="${FUZZ_SECONDS:-5}" -timeout=5 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=0 -verbosity=0 \
  -artifact_prefix="$artifacts/" "$scratch/new" "$2" || exit 1
