#!/usr/bin/env bash
# Compares the instructions of the hot kernels with the baseline, which is of one toolchain: any
# other skips the comparison. usage: check.sh PROGRAM BASELINE [--update]
set -euo pipefail

readonly program=$1 baseline=$2 mode=${3-}
readonly tolerance_percent=2

skip() {
  echo "Skipped: $*"
  exit 77  # ctest's SKIP_RETURN_CODE
}

# Of the functions that glibc has for several processors, those that every x86-64 can run.
plain_x86_64=-AVX,-AVX2,-AVX512F,-AVX512VL,-AVX_Fast_Unaligned_Load,-FMA,-FMA4,-ERMS,-FSRM
plain_x86_64+=,-SSSE3,-SSE4_1,-SSE4_2

# "name instructions", per call of each kernel.
count() {
  local dir dumps
  dir=$(mktemp -d)
  trap 'rm -rf "$dir"' RETURN
  GLIBC_TUNABLES=glibc.cpu.hwcaps=$plain_x86_64 valgrind --tool=callgrind \
    --collect-atstart=no --callgrind-out-file="$dir/out" --log-file="$dir/log" "$program" ||
    { cat "$dir/log" >&2 && return 1; }
  mapfile -t dumps < <(printf '%s\n' "$dir"/out.* | sort -V)
  awk '/^desc: Trigger: Client Request: / { calls = $5; name = $6 }
       /^totals: / && name { printf "%-26s %12.1f\n", name, $2 / calls; name = "" }' \
    "${dumps[@]}"
}

[[ -x $program ]] || skip "not built: no valgrind/callgrind.h (Debian: valgrind)"
command -v valgrind >/dev/null || skip "no valgrind (Debian: valgrind)"
toolchain="$("$program" --build), $(valgrind --version)"

if [[ $mode == --update ]]; then
  counts=$(count)
  printf '# %s\n' "$toolchain" "instructions per call; ./run counts writes this file" |
    cat - <(echo "$counts") | tee "$baseline"
  exit
fi

expected_toolchain=$(sed -n '1s/^# //p' "$baseline")
[[ $toolchain == "$expected_toolchain" ]] ||
  skip "the baseline is of $expected_toolchain; this is $toolchain"

count | awk -v tolerance=$tolerance_percent '
  FNR == NR { if (!/^#/) expected[$1] = $2; next }
  !($1 in expected) { printf "%-26s %12.1f  not in the baseline\n", $1, $2; bad = 1; next }
  {
    change = 100 * ($2 / expected[$1] - 1)
    verdict = change > tolerance ? "MORE" : change < -tolerance ? "fewer" : ""
    if (verdict) bad = 1
    printf "%-26s %12.1f %12.1f %+7.1f %% %s\n", $1, expected[$1], $2, change, verdict
    delete expected[$1]
  }
  END {
    for (name in expected) { printf "%-26s is in the baseline only\n", name; bad = 1 }
    if (bad) print "More than " tolerance " % apart. If it is meant: ./run counts"
    exit bad
  }' "$baseline" -
