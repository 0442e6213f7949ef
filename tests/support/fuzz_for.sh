#!/bin/bash
# fuzz_for.sh TARGET CORPUS: replays the corpus, then fuzzes for ${FUZZ_SECONDS:-5} s, starting from it. New inputs go to a
# scratch folder, what fails to ${FUZZ_ARTIFACTS:-crashes beside the folder of the program}. Status 1 where something
# failed: libFuzzer's own 77 would read as "skipped".
# New inputs follow from ${FUZZ_SEED}, by default the day (UTC, as 20261122): a check that fails can be run again on that
# day, or later with the seed that it prints.
set -eu
seed=${FUZZ_SEED:-$(date -u +%Y%m%d)}
echo "seed $seed (FUZZ_SEED=$seed repeats it)"
scratch=$(mktemp -d)
fuzzer=
trap '[ -z "$fuzzer" ] || kill "$fuzzer" 2>/dev/null || true; rm -rf "$scratch"' EXIT
mkdir "$scratch/new"
artifacts=${FUZZ_ARTIFACTS:-$(dirname "$1")/../crashes}
mkdir -p "$artifacts"
options=(-seed="$seed" -timeout=5 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=0 -artifact_prefix="$artifacts/")

# By itself, since this ends in order, with the search for leaks at the end.
"$1" "${options[@]}" -verbosity=0 -runs=0 "$2" || exit 1

# -max_total_time counts whole seconds from the start of the process, and one too many: 1 s were 2. Here the time begins when
# the corpus is known, and ends with SIGUSR1: libFuzzer finishes what it is at, which it searches for leaks each time.
exec 3< <(exec "$1" "${options[@]}" -verbosity=1 "$scratch/new" "$2" 2>&1)
fuzzer=$!
while read -r line <&3; do
  echo "$line"
  if [[ $line == *INITED* ]]; then
    (sleep "${FUZZ_SECONDS:-5}" && kill -USR1 "$fuzzer") &
    break
  fi
done
grep -v '^#[0-9]' <&3 || true  # all but its progress
status=0
wait "$fuzzer" || status=1
fuzzer=
exit $status
