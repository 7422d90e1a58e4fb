#!/usr/bin/env bash
# Compares the states and sigmas of a drive with the committed ones. A difference is a change of the
# filter, and its commit says why. usage: check.sh PROGRAM EXPECTED.csv [--update]
set -euo pipefail

readonly program=$1 expected=$2 mode=${3-}
# Of the largest magnitude in the column. Other compilers and C libraries round sines and sums
# otherwise, in the 16th digit, which the filter enlarges by some powers of ten.
readonly tolerance=1e-9

if [[ $mode == --update ]]; then
  "$program" >"$expected"
  exit
fi

"$program" | awk -F, -v tolerance=$tolerance '
  function abs(x) { return x < 0 ? -x : x }
  function fail(what) { print what; failed = 1; exit 1 }

  FNR == NR {
    expected[FNR] = $0
    expected_rows = FNR
    for (i = 2; FNR > 1 && i <= NF; ++i) if (abs($i) > scale[i]) scale[i] = abs($i)
    next
  }
  FNR == 1 {
    if ($0 != expected[1]) fail("The columns are no longer those of the committed trace.")
    split($0, column)
    next
  }
  {
    rows = FNR
    fields = split(expected[FNR], old)
    if ($1 != old[1] || $2 != old[2] || NF != fields)
      fail("Row " FNR " is of " $1 " at " $2 " s; the committed trace has " old[1] " at " old[2] " s there.")
    for (i = 3; i <= NF; ++i) {
      # Also where one of them is not a number.
      if (!(abs($i - old[i]) <= tolerance * scale[i]) || (($i ~ /n/) != (old[i] ~ /n/)))
        fail("The first difference: " $1 " at " $2 " s, " column[i] " is " $i ", was " old[i] ".")
    }
  }
  END {
    if (!failed && rows != expected_rows) {
      print "The trace has " rows + 0 " rows; the committed one has " expected_rows "."
      failed = 1
    }
    if (failed) print "If it is meant: ./run trace, look at git diff, and say in the commit why."
    exit failed
  }' "$expected" -
