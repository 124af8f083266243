#!/bin/sh
# The lab's window, with real keys and a real mouse: an X server without a screen (Xvfb), and xdotool for the hands.
#
#   tests/lab_window.sh LAB SOURCE [PICTURES]
#
# Pulls, pins and cuts a bar, switches solvers, undoes, takes pictures, quits; then looks at what was recorded, and plays
# that again without a window: it has to end in the same state. Exit status 77: no Xvfb, no xdotool, or no SDL2.
# With PICTURES, the pictures are kept there.
set -u
lab=$1
command -v Xvfb >/dev/null || {
  echo 'skipped: no Xvfb (Debian, Ubuntu: apt-get install xvfb)'
  exit 77
}
command -v xdotool >/dev/null || {
  echo 'skipped: no xdotool (Debian, Ubuntu: apt-get install xdotool)'
  exit 77
}
scratch=$(mktemp -d) || exit 1
server= window=
finish() {
  [ -z "$window" ] || kill "$window" 2>/dev/null
  [ -z "$server" ] || kill "$server" 2>/dev/null
  rm -rf "$scratch"
}
trap finish EXIT
wrong=0
complain() {
  echo "$*" >&2
  wrong=$((wrong + 1))
}

# Wait until a command succeeds, a minute at most: machines may be busy.
await() {
  tries=0
  until "$@" >/dev/null 2>&1; do
    tries=$((tries + 1))
    if [ $tries -gt 600 ]; then
      complain "waited in vain for: $*"
      cat "$scratch"/*.err >&2
      return 1
    fi
    sleep 0.1
  done
}

# The server chooses a display that is free.
Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp 3>"$scratch/display" 2>"$scratch/server.err" &
server=$!
await test -s "$scratch/display" || exit 1
DISPLAY=:$(cat "$scratch/display")
export DISPLAY
unset SDL_VIDEODRIVER XAUTHORITY

"$lab" bar --record "$scratch/recording.lab" --frames "$scratch/pictures" >"$scratch/out" 2>"$scratch/window.err" &
window=$!
sleep 0.2
if grep -q 'built without SDL2' "$scratch/window.err"; then
  echo 'skipped: the lab was built without SDL2'
  exit 77
fi
await xdotool search --name '^massspring lab$' || exit 1
# Without a window manager the keys go to where the mouse is.
xdotool mousemove 900 160
recorded() {
  grep -qE "$1" "$scratch/recording.lab"
}
await_recorded() {
  await recorded "$1"
}

# The lab writes what it has understood; lines come when its buffer is full or a picture is taken, so each part ends in
# a picture.
picture() {
  xdotool key w
  await test -s "$scratch/pictures/lab_$1.png"
}

# The picture is empty until the first frame.
xdotool key w
await test -s "$scratch/pictures/lab_000.png" || exit 1

xdotool key space # the bar holds still, so that it can be hit
# A click asks for the spring under it; the mouse rests on a button, which explains itself.
xdotool mousemove 384 178 click 1 sleep 0.2 mousemove 60 100 sleep 0.2
picture 001
# Drag: from the bar's free end, wherever it is, downwards. The view is the upper one of two.
xdotool mousemove 1180 130 mousedown 1 mousemove 1170 140 sleep 0.2 mousemove 1160 150 sleep 0.2
picture 002
xdotool mouseup 1
# Pin what is under the mouse, then cut there, by X and by shift.
xdotool mousemove 1000 110 key p
xdotool keydown x mousemove 800 70 mousedown 1 mousemove 800 120 sleep 0.2 mousemove 804 200 mouseup 1 keyup x
xdotool keydown shift mousemove 500 70 mousedown 1 mousemove 500 120 sleep 0.2 mousemove 504 200 mouseup 1 keyup shift
# The other solver on the upper side, a slider, colours, gravity off and on, help.
xdotool mousemove 900 160 key t
xdotool mousemove 60 121 mousedown 1 sleep 0.1 mousemove 90 121 sleep 0.1 mouseup 1
xdotool mousemove 900 160 key c key g key g
xdotool key space
sleep 0.5
picture 003
xdotool key h
picture 004
xdotool key h key u
xdotool mousemove 900 160 click 4 click 4
xdotool mousedown 3 mousemove 880 150 sleep 0.2 mousemove 860 140 mouseup 3
# What a plot shows under the mouse; all of them as a table; what was done until now as a script; and the list of scenes.
xdotool mousemove 244 640 sleep 0.2
picture 005
xdotool key v
await test -s "$scratch/pictures/lab_006.csv"
xdotool key y
await test -s "$scratch/pictures/lab_007.lab"
xdotool mousemove 120 57 click 1 sleep 0.2
picture 008
xdotool mousemove 900 160
xdotool key q
await sh -c "! kill -0 $window" || exit 1
wait "$window" || complain "exit status $?"
window=

for action in 'grab [0-9]' 'pull [0-9]' 'drop' 'pin [0-9]' 'cut ([-0-9.]+ ){3}' 'solver left implicit' 'gravity [0-9]' \
  'colour force' 'gravity 0$' 'help on' 'help off' 'undo' 'camera [0-9]' 'screenshot lab_005' 'pause' 'play' \
  'spring left [0-9]' 'table lab_006' 'scenes on'; do
  recorded "^[0-9.]+ $action" || complain "not recorded: $action"
done
[ "$(grep -cE ' cut ' "$scratch/recording.lab")" -eq 2 ] || complain 'two cuts were made'
grep -q '^left .*implicit' "$scratch/out" || complain "no switch of solvers: $(cat "$scratch/out")"

# What was recorded, again: to the same frame and the same state.
[ "$(head -n 1 "$scratch/pictures/lab_006.csv" | tr , '\n' | wc -l)" -eq 11 ] || complain 'a table of other columns'
(cd "$scratch" && "$lab" --headless --script pictures/lab_007.lab --frames saved_pictures --every 100000 --no-clock >saved) || complain 'the saved script does not play'
grep -q '^right implicit' "$scratch/saved" || complain "the saved script ends elsewhere: $(cat "$scratch/saved")"

frames=$(sed -n 's/^state after \([0-9]*\) frames.*/\1/p' "$scratch/out")
grep -vE ' (screenshot|table) ' "$scratch/recording.lab" >"$scratch/again.lab"
echo "$(awk -v frames="$frames" 'BEGIN { printf "%.6f", frames / 64 }') end" >>"$scratch/again.lab"
"$lab" --headless --script "$scratch/again.lab" --stop-after "$frames" --no-clock >"$scratch/again" ||
  complain 'the recording does not play'
[ "$(tail -n 1 "$scratch/out")" = "$(tail -n 1 "$scratch/again")" ] ||
  complain "the recording ends elsewhere: $(tail -n 1 "$scratch/out"), $(tail -n 1 "$scratch/again")"

if [ $# -gt 2 ]; then
  mkdir -p "$3"
  cp "$scratch"/pictures/* "$scratch/recording.lab" "$3"
fi
cat "$scratch/out"
echo "$wrong wrong"
[ $wrong -eq 0 ]
