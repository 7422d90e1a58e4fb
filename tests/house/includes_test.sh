#!/usr/bin/env bash
# includes.sh must find each use without its include, and nothing where a header of ours has it.
# usage: includes_test.sh
set -euo pipefail
check=$(dirname "${BASH_SOURCE[0]}")/includes.sh
readonly check
house=$(mktemp -d)
trap 'rm -rf "$house"' EXIT

# expect_complaint TEXT LINE...: of the file of these lines.
expect_complaint() {
  local complaints
  printf '%s\n' "${@:2}" >"$house/sim/use.cpp"
  if complaints=$("$check" "$house") || [[ $complaints != "$1"* ]]; then
    printf 'includes.sh should have said\n  %s\nbut said\n  %s\n' "$1" "${complaints:-nothing}" >&2
    exit 1
  fi
}

mkdir -p "$house/include/leeway" "$house/sim"
printf '%s\n' '#include <vector>' '#include "sim/two.hpp"' >"$house/include/leeway/one.hpp"
printf '%s\n' '#include "leeway/one.hpp"' '#include <Eigen/LU>' >"$house/sim/two.hpp"
expect_complaint 'sim/use.cpp:3: uses what is in <string_view>' \
  '#include "leeway/one.hpp"' '' 'std::string_view text;'
expect_complaint 'sim/use.cpp:2: uses what is in <vector>' '#include <array>' 'std::vector<int> a;'
expect_complaint 'sim/use.cpp:2: uses what is in <Eigen/Core>' '' 'Eigen::Vector3d a;'
expect_complaint 'sim/use.cpp:2: uses what is in <algorithm>' '' 'int a = std::max(1, 2);'
expect_complaint 'sim/use.cpp:1: uses what is in <doctest/doctest.h>' 'TEST_CASE("a") {}'
printf '%s\n' '#include "sim/two.hpp"' '// std::string' 'std::vector<Eigen::Vector3d> all;' \
  >"$house/sim/use.cpp"
"$check" "$house" # in order
