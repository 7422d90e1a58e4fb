#!/usr/bin/env bash
# Every relative link of README.md and docs/ leads to a file that is there, and so does every path
# in the tables of docs/seed.md.
# usage: check_links.sh PROJECT_DIR
set -euo pipefail
cd "$1"

broken=0
while IFS=: read -r page link; do
  target=${link%%#*}
  [[ -z $target || $target == *://* || -e ${page%/*}/$target ]] && continue
  echo "$page: link to $target, which is not there"
  broken=1
done < <(grep -roP '\]\(\K[^)\s]+' --include='*.md' ./README.md ./docs)

while read -r path; do
  [[ -e $path ]] && continue
  echo "docs/seed.md: names $path, which is not there"
  broken=1
done < <(grep -oP '`\K(include|lib|filters|sim|tests|docs)/[^`]*' docs/seed.md)
exit "$broken"
