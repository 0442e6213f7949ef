#!/bin/bash
# fuzz_for.sh TARGET CORPUS: fuzzes for ${FUZZ_SECONDS:-10} s, starting from the corpus; new inputs go to a scratch folder.
set -eu
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/new"
"$1" -max_total_time="${FUZZ_SECONDS:-10}" -timeout=5 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=0 -verbosity=0 \
  -artifact_prefix="${FUZZ_ARTIFACTS:-$scratch}/" "$scratch/new" "$2"
