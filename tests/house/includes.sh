#!/usr/bin/env bash
# Checks that each file includes what it uses, itself or by a header of ours: what the build
# precompiles hides it from the compiler when an include is missing. Prints file:line of the first
# use of each name whose header is missing. usage: includes.sh ROOT
set -euo pipefail
cd "$1"

# A header, others that have its names too, and what is found in them.
readonly headers='
algorithm|: std::(ranges::[a-z_]+|(all|any|none)_of|for_each|find(_if)?|count(_if)?|search|equal)\(
algorithm|: std::(copy(_n|_if)?|fill(_n)?|transform|generate|remove_if|reverse|rotate|unique)\(
algorithm|: std::((stable_)?sort|is_sorted|nth_element|(lower|upper)_bound)\(
algorithm|: std::(max|min|clamp|minmax|(max|min)_element)\(
array|: std::(array|to_array)[<{ ]
charconv|: std::(from|to)_chars\(
chrono|: std::chrono::
cmath|: std::(sqrt|cbrt|hypot|sin|cos|tan|asin|acos|atan2?|sinh|cosh|tanh|erfc?|[lt]gamma)\(
cmath|: std::(exp|expm1|log|log10|log1p|pow|floor|ceil|l?l?round|trunc|fmod|remainder|abs)\(
cmath|: std::(copysign|is(finite|nan|inf)|fma|ldexp|frexp|modf|signbit|nextafter)\(
filesystem|: std::filesystem::
fstream|: std::[io]?fstream[ ({]
functional|: std::(function|greater|reference_wrapper|hash|plus|c?ref|invoke|identity)[<({]
limits|: std::numeric_limits<
map|: std::(multi)?map<
memory|: std::(unique_ptr|shared_ptr|make_unique|make_shared|weak_ptr)<
numeric|: std::(accumulate|iota|reduce|inner_product|partial_sum|gcd|transform_reduce)\(
optional|: std::(optional<|nullopt)
set|: std::(multi)?set<
span|: std::span[<({]
sstream|: std::[io]?stringstream
string_view|string: std::string_view
string|: std::(string[^_a-z]|to_string|sto[dil])
tuple|: std::(tuple<|tie\(|make_tuple|apply\()
variant|: std::(variant<|visit\(|get_if<|holds_alternative|monostate)
vector|: std::vector<
Eigen/Core|Eigen/Cholesky Eigen/Geometry Eigen/LU Eigen/QR Eigen/SVD Eigen/Dense: Eigen::
Eigen/Cholesky|Eigen/Dense: (Eigen::LD?LT<|\.ld?lt\(\))
Eigen/Geometry|Eigen/Dense: (Eigen::(Quaternion|AngleAxis|Isometry)|\.cross\()
Eigen/LU|Eigen/Geometry Eigen/Dense: (\.inverse\(\)|\.determinant\(\)|[lL]u\(\))
doctest/doctest.h|: (^|[^_A-Z])(TEST_CASE|CHECK|REQUIRE|CAPTURE)(_[A-Z]+)*\(
nlohmann/json.hpp|nlohmann/json_fwd.hpp: nlohmann::
spdlog/fmt/fmt.h|spdlog/fmt/ranges.h spdlog/spdlog.h fmt/color.h: fmt::'

folders=()
for folder in include lib filters sim tests docs; do
  [[ ! -d $folder ]] || folders+=("$folder")
done
mapfile -t sources < <(find "${folders[@]}" -name '*.[ch]pp' | sort)
((${#sources[@]})) || { echo "no C++ source in $PWD" >&2 && exit 1; }

awk -v headers="$headers" '
  # Whether the file includes one of the headers, itself or by our own.
  function has(file, wanted, visit,    i) {
    if (seen[file] == visit) return 0
    seen[file] = visit
    for (i = 1; i <= count[file]; ++i)
      if (index(wanted, " " included[file, i] " ")) return 1
    for (i = 1; i <= count[file]; ++i)
      if (has(where(included[file, i]), wanted, visit)) return 1
    return 0
  }

  function where(header) { return header ~ /^leeway\// ? "include/" header : header }

  BEGIN {
    rows = split(substr(headers, 2), row, "\n")
    for (i = 1; i <= rows; ++i) {
      pattern[i] = substr(row[i], index(row[i], ": ") + 2)
      names = substr(row[i], 1, index(row[i], ": ") - 1)
      header[i] = substr(names, 1, index(names, "|") - 1)
      sub(/\|/, " ", names)
      provider[i] = " " names " "
    }
  }
  /^[ \t]*#[ \t]*include/ {
    name = $0
    sub(/^[^"<]*["<]/, "", name)
    sub(/[">].*/, "", name)
    included[FILENAME, ++count[FILENAME]] = name
    next
  }
  /^[ \t]*\/\// { next }
  {
    for (i = 1; i <= rows; ++i)
      if (!((FILENAME, i) in first) && $0 ~ pattern[i]) {
        first[FILENAME, i] = FNR
        used[++uses] = FILENAME SUBSEP i
      }
  }
  END {
    for (u = 1; u <= uses; ++u) {
      split(used[u], part, SUBSEP)
      if (has(part[1], provider[part[2]], u)) continue
      print part[1] ":" first[used[u]] ": uses what is in <" header[part[2]] "> without it"
      bad = 1
    }
    exit bad
  }' "${sources[@]}"
