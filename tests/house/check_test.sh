#!/usr/bin/env bash
# check.sh must find each disorder in a small house, and nothing in the house without it.
# usage: check_test.sh
set -euo pipefail
check=$(dirname "${BASH_SOURCE[0]}")/check.sh
readonly check
house=$(mktemp -d)
trap 'rm -rf "$house"' EXIT

# put FILE LINE...
put() {
  mkdir -p "$house/$(dirname "$1")"
  printf '%s\n' "${@:2}" >"$house/$1"
}

build_house() {
  rm -rf "${house:?}"/*
  put include/leeway/navigator.hpp '#include "leeway/navigator/navigator.hpp"'
  put include/leeway/navigator/navigator.hpp '#include "leeway/earth/time.hpp"'
  put include/leeway/earth/time.hpp '#include <string>'
  put filters/ekf/ekf.cpp '' '#include "leeway/earth/time.hpp"' '#include "filters/model/heading.hpp"'
  put sim/cli/commands/fuse.cpp '#include "leeway/navigator/navigator.hpp"' '#include "sim/tools/random.hpp"'
}

# expect_complaint TEXT: what check.sh must print, and fail.
expect_complaint() {
  local complaints
  if complaints=$("$check" "$house") || [[ $complaints != "$1"* ]]; then
    printf 'check.sh should have said\n  %s\nbut said\n  %s\n' "$1" "${complaints:-nothing}" >&2
    exit 1
  fi
  build_house
}

build_house
"$check" "$house" # in order

put filters/ekf/ekf.cpp '' '#include "leeway/navigator/navigator.hpp"'
expect_complaint 'filters/ekf/ekf.cpp:2: filters/ekf includes leeway/navigator/navigator.hpp, which is'
put lib/earth/time.cpp '#include "leeway/sensors/imu.hpp"'
expect_complaint 'lib/earth/time.cpp:1: lib/earth includes leeway/sensors/imu.hpp'
put include/leeway/earth/time.hpp '#include "leeway/sim/tools/random.hpp"'
expect_complaint 'include/leeway/earth/time.hpp:1: lib/earth includes leeway/sim/tools/random.hpp'
put include/leeway/sim/motion/jet.hpp '#include <leeway/navigator.hpp>'
expect_complaint 'include/leeway/sim/motion/jet.hpp:1: sim/motion includes leeway/navigator.hpp'
put sim/trials/trial.cpp '#include "sim/cli/options.hpp"'
expect_complaint 'sim/trials/trial.cpp:1: sim/trials includes sim/cli/options.hpp'
put sim/trials/trial.cpp '#include "trial_score.hpp"'
expect_complaint 'sim/trials/trial.cpp:1: trial_score.hpp is in no room'
put sim/attic/old.cpp '#include <string>'
expect_complaint 'sim/attic/old.cpp: its folder is not in the order'
mapfile -t lines < <(seq 351)
put lib/earth/time.cpp "${lines[@]/#/// }"
expect_complaint 'lib/earth/time.cpp: 351 lines'
for number in {1..23}; do put "lib/logs/log_$number.cpp" ''; done
expect_complaint 'lib/logs: 23 sources'
