#!/bin/sh
# What the Markdown pages say is there: every block of C compiles as C99, every name of the library is one of its headers,
# every file and picture that they link to is there, and every program that they call is built.
#
#   tests/docs.sh SOURCE CC
set -eu
source=$1 compiler=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
wrong=0 blocks=0 names=0 links=0 programs=0

complain() {
  wrong=$((wrong + 1))
  echo "WRONG: $*"
}

cd "$source"
# A source archive (pkgconfig/dist) has none of these.
left_out='^$'
ls examples/pictures/*.png >/dev/null 2>&1 || left_out='pictures/[^/]*\.png$'
find . -name '*.md' -not -path './build*' -not -path './out/*' -not -path './.git/*' | sort >"$scratch/pages"
while read -r page; do
  # A file for each block.
  rm -f "$scratch"/block_*
  awk -v to="$scratch/block_" '/^```/ { if (in_it) in_it = 0; else if ($0 == "```c") { in_it = 1; n++ } next }
    in_it { print >(to n ".c") }' "$page"
  for block in "$scratch"/block_*.c; do
    [ -e "$block" ] || continue
    blocks=$((blocks + 1))
    "$compiler" -std=c99 -Wall -Wextra -pedantic -Werror -fsyntax-only -Iinclude -Isrc/gpu/include "$block" ||
      complain "$page: a block of C does not compile"
  done

  # The history and the way from 0.2 have names of before.
  case $page in
    ./CHANGELOG.md | */migrate.md) : >"$scratch/names" ;;
    *) grep -oE '\b(mspring|MSPRING)_[A-Za-z0-9_]*[A-Za-z0-9]' "$page" | sort -u >"$scratch/names" || true ;;
  esac
  while read -r name; do
    names=$((names + 1))
    grep -qE "\b($name|MSPRING_DEFAULT\(${name%_default})\b" CMakeLists.txt src/CMakeLists.txt include/*.h include/massspring/*.h src/gpu/include/massspring/*.h ||
      complain "$page: no header has $name"
  done <"$scratch/names"

  sed -E 's/\]\(/\n](/g' "$page" | sed -nE 's/^\]\(([^)#]+)(#[^)]*)?\).*/\1/p' | grep -v '://' >"$scratch/links" || true
  while read -r link; do
    links=$((links + 1))
    [ -e "$(dirname "$page")/$link" ] || echo "$link" | grep -q "$left_out" || complain "$page: there is no $link"
  done <"$scratch/links"

  grep -oE 'build/(examples|bench|tests)/[A-Za-z0-9_/-]*[a-z0-9]' "$page" | grep -v '/data$' | sort -u >"$scratch/programs" || true
  while read -r program; do
    programs=$((programs + 1))
    name=${program##*/}
    [ -n "$(find tests -name "$name.c")" ] ||
      grep -qE "(add_executable|massspring_example)\($name( |\)|\$)" examples/CMakeLists.txt \
        examples/lab/CMakeLists.txt bench/CMakeLists.txt || complain "$page: nothing builds $program"
  done <"$scratch/programs"
done <"$scratch/pages"

[ $blocks -gt 0 ] && [ $names -gt 50 ] && [ $links -gt 20 ] && [ $programs -gt 5 ] || complain "hardly anything found"
echo "$blocks blocks of C, $names names, $links links, $programs programs, $wrong wrong"
[ $wrong -eq 0 ]
