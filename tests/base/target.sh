#!/bin/sh
# The library is refused where float or double is computed in a wider type, and there alone. CPUs with AVX512-FP16, whose
# FLT_EVAL_METHOD is 16 in gnu mode, compute both as such.
#
#   base/target.sh SOURCE CC
set -eu
cd "$1"
compiler=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

takes() { # a FLT_EVAL_METHOD
  printf '#include <float.h>\n#undef FLT_EVAL_METHOD\n#define FLT_EVAL_METHOD %s\n#include "base/target.h"\n' "$1" \
    >"$scratch/target.c"
  "$compiler" -std=c11 -Isrc -fsyntax-only "$scratch/target.c" 2>"$scratch/said"
}
for method in 0 16 32; do
  takes $method || {
    cat "$scratch/said"
    echo "WRONG: a method of $method is refused"
    exit 1
  }
done
for method in -1 1 2 33 64 128; do
  if takes $method; then
    echo "WRONG: a method of $method is taken"
    exit 1
  fi
done

# The library as a program pastes it, in the mode that its compiler has by default.
echo 'int nothing;' >"$scratch/nothing.c"
if ! command -v python3 >/dev/null; then
  echo "left out: the pasted library, as there is no python3"
elif "$compiler" -march=sapphirerapids -fsyntax-only "$scratch/nothing.c" 2>/dev/null; then
  pkgconfig/amalgamate "$scratch"
  "$compiler" -std=gnu11 -march=sapphirerapids -Wall -Wextra -Werror -fsyntax-only "$scratch/massspring.c"
else
  echo "left out: $compiler does not know -march=sapphirerapids"
fi
