#!/usr/bin/env bash
# Parses each source of the libraries and the program without what the build precompiles, and each
# public header that is not the first include of a source: every file includes what it uses.
# usage: alone.sh BUILD_DIR, configured with compile_commands.json
set -euo pipefail
commands=$(realpath "$1")/compile_commands.json
readonly commands
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

# The commands of the sources, to parse only, by clang, which is quicker at it. Of what JSON escapes
# there are only \" and \\.
parse_commands() {
  sed -n 's/^ *"command": "\(.*\)",\?$/\1/p' "$commands" |
    grep -E " -c $PWD/(lib|filters|sim)/[^ ]*\.cpp$" |
    sed -e 's/\\\(.\)/\1/g' -e 's/ -include [^ ]*//' -e 's/ -O[0-9]//' -e 's/^[^ ]*/clang++/' \
      -e 's/ -o [^ ]* -c / -w -fsyntax-only /' |
    awk '!seen[$NF]++'
}

# Whoever includes such a header has included others before.
unchecked_headers() {
  comm -23 <(cd include && find leeway -name '*.hpp' | sort) \
    <(find lib filters sim -name '*.cpp' -exec awk '
        /^#include/ { split($2, part, /["<>]/); print part[2]; nextfile }' {} + | sort -u)
}

all=$(parse_commands)
[[ -n $all ]] || { echo "$commands has no source of lib, filters, sim" >&2 && exit 1; }
any=$(grep -m 1 -E '/filters/[^ ]*$' <<<"$all")
for header in $(unchecked_headers); do
  all+=$'\n'"${any% *} -x c++ include/$header"
done
# shellcheck disable=SC2016  # for the inner bash
xargs -d '\n' -n 1 -P "$(nproc)" bash -c 'eval "$1" || { echo "alone: $1" >&2; exit 1; }' _ <<<"$all"
echo "$(wc -l <<<"$all") files parsed, each by itself"
