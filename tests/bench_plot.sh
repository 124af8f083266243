#!/bin/sh
# The bench's curves: drawn from its CSV, and broken CSV refused with the line and what is wrong.
#
#   tests/bench_plot.sh PLOT
set -u
plot=$1
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
wrong=0
table=$scratch/speed.csv
picture=$scratch/speed.svg

complain() {
  echo "$*" >&2
  wrong=$((wrong + 1))
}

# The table of these lines.
table() {
  printf '%s\n' "$@" >"$table"
}

# The table is drawn.
drawn() {
  rm -f "$picture"
  "$plot" "$table" "$picture" "$@" 2>"$scratch/err" || complain "exit status $?: $(cat "$scratch/err")"
  tail -n 1 "$picture" | grep -q '</svg>' || complain 'no whole picture'
}
has() {
  [ "$(grep -c -- "$1" "$picture")" -eq "$2" ] || complain "not $2 lines with $1 in the picture"
}

# The table is refused with these words, without a picture.
refused() {
  rm -f "$picture"
  if "$plot" "$table" "$picture" 2>"$scratch/err"; then
    complain "accepted: $(cat "$table")"
  fi
  grep -q -- "$1" "$scratch/err" || complain "no \"$1\" in \"$(cat "$scratch/err")\""
  [ ! -e "$picture" ] || complain "a picture of what is wrong: $1"
}

head=scene,particles,springs,solver,substeps,level,threads,us_per_step_min,us_per_step_median
head=$head,ns_per_spring_substep_median,baseline_ratio_median,bytes_per_particle
small=bar_80x5,400,1347,explicit,40,scalar,1,90.1,91.2,4.0,2.00,170.0
wide=bar_80x5,400,1347,explicit,40,avx2,1,50.1,51.2,1.0,8.00,170.0
large=grid_1581x1581,2499561,9991922,explicit,16,avx2,1,50.1,51.2,2.0,5.00,131.0
shared=grid_1581x1581,2499561,9991922,explicit,16,avx2,2,30.1,31.2,1.0,10.00,131.0

# One curve each for the naive step, scalar, and AVX2 with one worker and with two. The second part ends its lines as
# Windows does.
table $head $small $wide $large
printf '%s\r\n' $head $shared >>"$table"
drawn 'a <small> machine'
for name in 'naive step, 1 worker' 'scalar, 1 worker' 'avx2, 1 worker' 'avx2, 2 workers' 'a &lt;small&gt; machine'; do
  has ">.*$name<" 1
done
has '<circle' 10 # with one worker: 3 marks and 2 of the legend, each on an edge of paper

: >"$table"
refused 'nothing in it'
table $head
refused 'no line after the header'
table $small
refused 'speed.csv:1:1: no column scene'
table $head $small scene,springs
refused 'speed.csv:3:1: no column solver'
table $head $small bar_80x5,400,1347,explicit
refused 'speed.csv:3:.*has 4 columns, not the 12'
table $head $small,1
refused 'speed.csv:2:.*has 13 columns, not the 12'
table $head $small $large $small
refused 'speed.csv:4:1: bar_80x5, level scalar, threads 1, is on line 2'
while read -r change words; do
  table $head $wide "$(echo $small | sed "s/$change/")"
  refused "speed.csv:3:$words"
done <<'CHANGES'
,1347,/,many, 14: .many. is no number of springs
,1347,/,0, 14: .0. is no number of springs
,1347,/,, .*has 11 columns
explicit/direct 19: .direct.: only steps of the explicit solver
scalar/mmx 31: .mmx. is no level
scalar,1/scalar,0 38: .0. is no number of workers
scalar,1/scalar,1.5 38: a number of workers is whole
,4\.0,/,nan, 50: .nan. is no time in nanoseconds
,4\.0,/,-4, 50: .-4. is no time in nanoseconds
,2\.00,/,0, 54: .0. is no ratio of times
CHANGES
table $head $small $(echo $small | sed s/scalar,1/scalar,2/) $(echo $small | sed s/scalar,1/scalar,3/) \
  $(echo $small | sed s/scalar,1/scalar,4/)
refused 'speed.csv:5: a fourth number of workers, 4'
"$plot" "$scratch/missing.csv" "$picture" 2>"$scratch/err" && complain 'accepted: no file'
grep -q missing.csv "$scratch/err" || complain 'the missing file is not named'
table $head $small
"$plot" "$table" "$scratch/nowhere/speed.svg" 2>"$scratch/err" && complain 'accepted: no folder'
grep -q nowhere "$scratch/err" || complain 'the picture that cannot be written is not named'

echo "$wrong wrong"
[ $wrong -eq 0 ]
