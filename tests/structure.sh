#!/bin/sh
# The rules of src that a script can check; CONTRIBUTING.md has all of them.
#
#   tests/structure.sh SOURCE
#
# - A folder includes only folders above it in the map of src/README.md. Headers of features/ are as high as store/.
# - Headers include each other in no cycle.
# - The base name of a file is unique; a file has at most 600 lines, a function 60.
# - No identifier is in use that was replaced by the field's name (tests/old_names.txt), and no public name of 0.2 that is
#   gone, but in the history and in what takes programs over.
# - Subjects of commits have at most 60 characters, from FIRST on. A shallow clone is not checked for that.
set -eu
FIRST=e1369fbbf87335dc2525e58c932e01728e43f0a0
cd "$1/src"
wrong=0

# Print what is wrong, if anything is.
expect_none() { # text, what is wrong with each of its lines
  [ -z "$1" ] || {
    echo "$1" | sed "s/^/WRONG: $2: /"
    wrong=1
  }
}

ranks=$(sed -n '/^## The folders/,/^## Equilibrium/s/^| \(`[^|]*\) |.*/\1/p' README.md | tr -d '`,')
[ -n "$ranks" ] || {
  echo "src/README.md has no table of folders" >&2
  exit 1
}
grep -rn '^ *# *include "' --include='*.[ch]' --include='*.def' . | sed 's#^\./##' | awk -v ranks="$ranks" '
  BEGIN {
    count = split(ranks, name, /[ \n]+/)
    for (i = 1; i <= count; i++) {
      sub("/$", "", name[i])
      rank[name[i]] = i
    }
  }
  {
    from = $0
    sub("/.*", "", from)
    if ($0 ~ "^features/[^:]*[.]h:")
      from = "store"
    to = $0
    sub("^[^\"]*\"", "", to)
    sub("\".*", "", to)
    if (to !~ "/")
      next
    sub("/.*", "", to)
    if (to == "features")
      to = "store"
    checked++
    if (!(from in rank) || !(to in rank)) {
      print "WRONG: the map of src/README.md lacks a folder: " $0
      wrong++
    } else if (rank[to] > rank[from]) {
      print "WRONG: " from "/ stands above " to "/: " $0
      wrong++
    }
  }
  END {
    print checked + 0 " includes, " wrong + 0 " wrong"
    exit wrong > 0 || checked < 100
  }' || wrong=1

expect_none "$(grep -rn '^ *# *include "' --include='*.h' . | sed -n 's#^\./\([^:]*\):.*"\(.*[.]h\)".*#\1 \2#p' |
  tsort 2>&1 >/dev/null)" 'headers include each other'

expect_none "$(find . -name '*.[ch]' -o -name '*.def' | sed 's#.*/##' | sort | uniq -d)" 'two files have this name'

expect_none "$(find . -name '*.[ch]' -exec wc -l {} + | awk '$1 > 600 && $2 != "total" { print $2 " has " $1 }')" \
  'a file has more than 600 lines'

# clang-format puts the head of a function and its closing brace at the beginning of a line, and nothing else so.
expect_none "$(find . -name '*.[ch]' -exec awk '
  FNR == 1 { inside = 0 }
  /^[a-zA-Z].*\(/ && !inside { start = FNR }
  /^[^ \/].*\{$/ && !inside && !/^(typedef|struct|enum|union)/ && !/= \{/ { inside = 1 }
  /^\}/ {
    if (inside && FNR - start + 1 > 60)
      print FILENAME ":" start " has " FNR - start + 1
    inside = 0
  }' {} +)" 'a function has more than 60 lines'

cd ..
expect_none "$(grep -rnowFf tests/old_names.txt src tests --include='*.[ch]' --include='*.def')" 'an old name'

public_names() {
  cat "$@" | grep -oE '\b(mspring|MSPRING)_[A-Za-z0-9_]+' | sort -u
}
gone=$(public_names tests/abi/old_calls.c | grep -vxF "$(public_names include/massspring/*.h)")
expect_none "$(grep -rInowF "$gone" ./*.md src include tests examples bench pkgconfig --exclude=CHANGELOG.md \
  --exclude=old_calls.c --exclude='*migrate*')" 'a name of 0.2'

if git rev-parse --quiet --verify "$FIRST^{commit}" >/dev/null 2>&1; then
  expect_none "$(git log --no-merges --format='%h %s' "$FIRST..HEAD" | awk 'length($0) - index($0, " ") > 60')" 'a long subject'
fi
exit $wrong
