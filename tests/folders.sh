#!/bin/sh
# Folders of src include only what stands above them in the map of src/README.md, so no circle can come about.
#
#   tests/folders.sh SOURCE
set -eu
cd "$1/src"
# The first column of the table, in its order: each name in it is a folder.
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
    to = $0
    sub("^[^\"]*\"", "", to)
    sub("\".*", "", to)
    if (to !~ "/")
      next
    sub("/.*", "", to)
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
    print checked + 0 " checked, " wrong + 0 " wrong"
    exit wrong > 0 || checked < 100
  }'
