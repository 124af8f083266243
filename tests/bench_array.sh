#!/bin/sh
# The array of jobs for the map: its body with the variable of Slurm, as xargs and GNU parallel start it, and the sum of
# its tables, which must be that of one run over the same cases.
#
#   tests/bench_array.sh SOURCE BENCH
set -u
array=$1/bench/map_array bench=$2
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
wrong=0

complain() {
  echo "$*" >&2
  wrong=$((wrong + 1))
}

# What runs of the same cases have in common, in whatever order the rows came.
rows() {
  "$array" sum "$1" | sort
}

# Shard 1 of 300 is shards 1 and 301 of 600.
one() {
  env SLURM_ARRAY_TASK_ID="$1" "$array" "$2" "$bench" "$scratch/$3" --family bounce
}
one 1 300 whole || complain "exit status $?"
one 1 600 parts && one 301 600 parts || complain "exit status $?"
[ "$(rows "$scratch/whole" | wc -l)" -gt 2 ] || complain "no counts: $(rows "$scratch/whole")"
[ "$(rows "$scratch/whole")" = "$(rows "$scratch/parts")" ] || complain "the sum differs: $(rows "$scratch/parts")"
"$bench" --map --csv --family bounce --shard 1/300 | sort >"$scratch/table"
rows "$scratch/whole" | cmp - "$scratch/table" || complain 'the sum is not what the bench prints'

# As xargs starts them, and parallel if it is there.
printf '%s\n' 1 301 | xargs -P 2 -I{} env SLURM_ARRAY_TASK_ID={} "$array" 600 "$bench" "$scratch/xargs" --family bounce ||
  complain "xargs: exit status $?"
rows "$scratch/xargs" | cmp - "$scratch/table" || complain 'xargs: the sum differs'
if parallel --version 2>/dev/null | grep -q '^GNU'; then
  printf '%s\n' 1 301 |
    parallel -j 2 SLURM_ARRAY_TASK_ID={} "$array" 600 "$bench" "$scratch/parallel" --family bounce ||
    complain "parallel: exit status $?"
  rows "$scratch/parallel" | cmp - "$scratch/table" || complain 'parallel: the sum differs'
else
  echo 'not tested: there is no GNU parallel'
fi

# A job whose table is there ends at once; one that dies leaves none; a job without its number is a mistake.
SLURM_ARRAY_TASK_ID=1 "$array" 300 false "$scratch/whole" || complain 'a finished job ran again'
printf '#!/bin/sh\necho family,solver\nkill -KILL $$\n' >"$scratch/dies" && chmod +x "$scratch/dies"
SLURM_ARRAY_TASK_ID=2 "$array" 300 "$scratch/dies" "$scratch/whole" 2>/dev/null && complain 'a job that died succeeded'
[ "$(ls "$scratch/whole")" = map_1_300.csv ] || complain "left: $(ls "$scratch/whole")"
(unset SLURM_ARRAY_TASK_ID && "$array" 300 "$bench" "$scratch/whole" 2>/dev/null)
[ $? -eq 2 ] || complain 'a job without a number'

echo "$wrong wrong"
[ $wrong -eq 0 ]
