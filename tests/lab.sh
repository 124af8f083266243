#!/bin/sh
# The headless lab from outside: its pictures, its last state, and what it says to mistakes.
#
#   tests/lab.sh LAB SOURCE
set -u
lab=$1
scripts=$2/examples/lab/scripts
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
wrong=0

complain() {
  echo "$*" >&2
  wrong=$((wrong + 1))
}

# Run; what comes out is in out, what is said in err.
succeed() {
  "$lab" "$@" >"$scratch/out" 2>"$scratch/err" </dev/null || complain "exit status $?: $* ($(cat "$scratch/err"))"
}
refused() {
  word=$1
  shift
  if "$lab" "$@" >"$scratch/out" 2>"$scratch/err" </dev/null; then
    complain "accepted: $*"
  fi
  grep -q -- "$word" "$scratch/err" || complain "no \"$word\" in \"$(cat "$scratch/err")\": $*"
}

# Whole pictures, of this size.
png() {
  [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || complain "$1 is no PNG"
  [ "$(tail -c 8 "$1" | head -c 4)" = IEND ] || complain "$1 has no end"
  [ "$(od -An -tx1 -j 16 -N 8 "$1" | tr -d ' \n')" = "$2" ] || complain "$1 has another size"
}

# The same state on every machine, and with any instruction set: that of explicit networks.
state='state after 231 frames: 4aa220e972d38cb1'
for level in '' scalar; do
  MSPRING_SIMD=$level
  export MSPRING_SIMD
  succeed --headless --script "$scripts/test.lab" --frames "$scratch/frames" --every 60 --size 640x400 --no-clock \
    --animation "$scratch/film.png" --shrink 2
  [ "$(tail -n 1 "$scratch/out")" = "$state" ] || complain "another state: $(tail -n 1 "$scratch/out") at $level"
done
unset MSPRING_SIMD
for picture in frame_00000 frame_00001 frame_00002 frame_00003 test; do
  png "$scratch/frames/$picture.png" 0000028000000190
done
[ -e "$scratch/frames/frame_00004.png" ] && complain 'too many frames'
png "$scratch/film.png" 00000140000000c8
grep -q acTL "$scratch/film.png" || complain 'the film does not move'

# Plots as a table: time and four quantities of two sides, the same on every machine.
printf '0 scene bar\n1 spring left 40 2 5\n1 table plots\n1 end\n' >"$scratch/script.lab"
succeed --headless --script "$scratch/script.lab" --frames "$scratch/frames" --every 1000 --no-clock
head -n 1 "$scratch/frames/plots.csv" | grep -qx 'seconds\(,\(left\|right\)_[a-z_A-Z]*\)\{8\}' || complain 'a table without its columns'
[ "$(wc -l <"$scratch/frames/plots.csv")" -eq 17 ] || complain 'another number of rows'
tail -n 1 "$scratch/frames/plots.csv" | grep -q '^1\.0' || complain 'the table ends elsewhere'

# Mistakes.
refused 'script.lab:2:5: .*gravitas' --headless --script "$(
  printf '0 pause\n0.5 gravitas 3\n' >"$scratch/script.lab"
  echo "$scratch/script.lab"
)"
printf '0 scene rope\n0 scene "no such thing.msn"\n' >"$scratch/script.lab"
refused 'script.lab:2:.*no such thing' --headless --script "$scratch/script.lab"
refused 'missing.lab' --headless --script "$scratch/missing.lab"
refused 'nowhere' nowhere.png --headless --stop-after 1
refused '--script or --stop-after' --headless
refused 'unknown option --frobnicate' --frobnicate x
refused 'value of --every' --every 0
refused 'value of --size' --size 10x10
refused 'value of --script' --script
refused 'one scene only' bar beam
refused 'frame' rope --headless --stop-after 1 --frames "$scratch/nowhere/frames"
succeed --actions
[ "$(wc -l <"$scratch/out")" -gt 30 ] || complain 'few actions'

echo "$wrong wrong"
[ $wrong -eq 0 ]
