#!/usr/bin/env bash
# Checks that the house is in order: no file includes one of a higher room, no source is too long, no
# folder too full. Prints file:line of each that breaks it. usage: check.sh ROOT
set -euo pipefail
cd "$1"

# From the ground up: a room includes itself and the rooms before it. A room is a folder of sources
# with the folders in it, and its public headers in include/leeway. The doors, the headers that are
# in include/leeway itself, are above all rooms.
readonly order=(
  lib/earth lib/sensors lib/strapdown lib/logs
  filters/model filters/covariance filters/ekf filters/alternatives filters/monitors filters/navigator
  sim/tools sim/motion sim/sensors sim/scene sim/analysis sim/trials sim/compare sim/reduce
  sim/inspect sim/replay sim/atlas sim/report sim/cli)
readonly max_lines=350 max_files=22

layers=()
for layer in include lib filters sim; do
  [[ ! -d $layer ]] || layers+=("$layer")
done
mapfile -t sources < <(find "${layers[@]}" -name '*.[ch]pp' | sort)
((${#sources[@]})) || { echo "no C++ source in $PWD" >&2 && exit 1; }

awk -v order="${order[*]}" -v max_lines=$max_lines -v max_files=$max_files '
  function complain(what) { print what; bad = 1 }

  # The place in the order of "leeway/earth/time.hpp", "filters/ekf/ekf.hpp" and the like; a door is
  # on the roof, another name nowhere: 0.
  function place(path,    part) {
    sub(/^include\//, "", path)
    split(path, part, "/")
    if (part[1] != "leeway") return level[part[1] "/" part[2]]
    if (part[2] == "sim") return level["sim/" part[3]]
    if (part[2] ~ /\.hpp$/) return roof
    return level["lib/" part[2]] + level["filters/" part[2]]
  }

  function end_file() {
    if (lines > max_lines) complain(file ": " lines " lines, more than " max_lines)
  }

  BEGIN {
    roof = split(order, room, " ") + 1
    room[roof] = "the doors"
    for (i = 1; i < roof; ++i) level[room[i]] = i
  }
  FNR == 1 {
    end_file()
    file = FILENAME
    from = place(file)
    if (!from) complain(file ": its folder is not in the order of tests/house/check.sh")
    folder = file
    sub(/\/[^\/]*$/, "", folder)
    ++files[folder]
  }
  { lines = FNR }
  /^[ \t]*#[ \t]*include[ \t]*("|<leeway\/)/ {
    included = $0
    sub(/^[^"<]*["<]/, "", included)
    sub(/[">].*/, "", included)
    to = place(included)
    if (!to) complain(file ":" FNR ": " included " is in no room; rooms are named from the root")
    else if (to > from)
      complain(file ":" FNR ": " room[from] " includes " included ", which is above, in " room[to])
  }
  END {
    end_file()
    for (folder in files)
      if (files[folder] > max_files)
        complain(folder ": " files[folder] " sources, more than " max_files)
    exit bad
  }' "${sources[@]}"
