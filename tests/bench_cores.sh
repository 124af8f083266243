#!/bin/sh
# The table of many_cores has a row for each scene and as many cells in each row. A bench that fails is an error.
#
#   tests/bench_cores.sh SOURCE BENCH
set -u
cores=$1/bench/many_cores bench=$2
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
wrong=0

complain() {
  echo "$*" >&2
  wrong=$((wrong + 1))
}

"$cores" "$bench" --scene bar_8x5 --scene rope_9 >"$scratch/table" || complain "exit status $?"
grep -q '^| bar_8x5 .*[0-9]\.[0-9][0-9] / [0-9]' "$scratch/table" || complain "no row: $(cat "$scratch/table")"
[ "$(grep -c '^|' "$scratch/table")" -eq 4 ] || complain "rows: $(cat "$scratch/table")"
[ "$(grep '^|' "$scratch/table" | awk -F'|' '{ print NF }' | sort -u | wc -l)" -eq 1 ] || complain 'uneven rows'
"$cores" "$bench" --scene bar_0x0 >"$scratch/none" 2>&1 && complain 'no such scene, and no error'
"$cores" false >"$scratch/none" 2>&1 && complain 'no bench, and no error'

echo "$wrong wrong"
[ $wrong -eq 0 ]
