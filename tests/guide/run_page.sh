#!/usr/bin/env bash
# Runs the commands of a page: its ```sh blocks, in their order, in an empty folder from which docs/
# and ../shared/ are where they are from the project's.
# usage: run_page.sh PAGE SHARED_DIR PROGRAM_DIR...
set -euo pipefail

readonly skipped=77
page=$1
shared=$2
for dir in "${@:3}"; do PATH=$dir:$PATH; done
docs=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../docs" && pwd)

commands=$(awk '/^```sh$/ {inside = 1; next} /^```$/ {inside = 0} inside' "$page")
[[ -n $commands ]] || {
  echo "$page has no sh block: nothing to run"
  exit 1
}
if grep -q '\.\./shared/' <<<"$commands" && [[ ! -d $shared/data/drives ]]; then
  echo "no recorded drives in $shared: skipped"
  exit "$skipped"
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/project"
ln -s "$docs" "$work/project/docs"
ln -s "$shared" "$work/shared"
cd "$work/project"
# mpirun refuses to run as root or with more ranks than cores unless told.
export PATH OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
  OMPI_MCA_rmaps_base_oversubscribe=1
bash -euo pipefail -xc "$commands"
