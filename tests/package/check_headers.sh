#!/usr/bin/env bash
# The installed headers are those of include/leeway, except the simulators', which stay at home, and
# their door. usage: check_headers.sh SOURCE_INCLUDE INSTALLED_INCLUDE
set -euo pipefail

headers() { (cd "$1" && find leeway -name '*.hpp' | sort); }

diff <(headers "$1" | grep -vE '^leeway/(sim/|studies\.hpp$)') <(headers "$2") || {
  echo "Only in the source: <; only installed: >. lib/cmake/install.cmake says what is installed." >&2
  exit 1
}
