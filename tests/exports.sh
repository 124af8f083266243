#!/bin/sh
# What the built libraries are made of, seen from outside.
#
#   exports.sh symbols      LIBRARY.so HEADER...   it exports what the headers declare, and nothing else; what may
#                                               change under a version of its own, this minor one
#   exports.sh dependencies LIBRARY.so          it needs libc, libm and threads at most
#   exports.sh instructions LIBRARY.a           no fused multiply-add, no approximate reciprocal, but in the inverse of
#                                               src/kernels/inverse_avx512.h; wide registers only in the files that
#                                               are chosen at run time
#
# NM, OBJDUMP and READELF come from the environment if they are not the system's.
set -eu
check=$1 library=$2
shift 2

skip() {
  echo "skipped: $1"
  exit 77
}
NM=${NM:-nm} OBJDUMP=${OBJDUMP:-objdump} READELF=${READELF:-readelf}
for tool in "$NM" "$OBJDUMP" "$READELF"; do
  command -v "$tool" >/dev/null || skip "no $tool here (Debian, Ubuntu: binutils)"
done
"$READELF" -h "$library" >/dev/null 2>&1 || skip "$library is no ELF file"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

case $check in
symbols)
  # Declarations: names before a parenthesis, outside of comments.
  declared() {
    sed -e 's|//.*||' -e 's|(MSPRING_CALL [*]|*|g' -e 's|([*]|*|g' "$@" | grep -o 'mspring_[a-z0-9_]* *(' | tr -d ' (' | sort -u
  }
  # Version nodes (type A) are names of versions, not of symbols.
  "$NM" -D --defined-only "$library" | awk '$2 != "A" { sub(/@@?/, " ", $3); print $3 }' | sort >"$scratch/versions"
  cut -d ' ' -f 1 "$scratch/versions" >"$scratch/exported"
  declared "$@" >"$scratch/declared"
  count=$(wc -l <"$scratch/declared")
  echo "$count functions declared, $(wc -l <"$scratch/exported") symbols exported"
  [ "$count" -ge 50 ] # or the pattern above has gone blind
  diff "$scratch/declared" "$scratch/exported" || {
    echo "< declared but not exported, > exported but not declared"
    exit 1
  }
  if grep -v '^mspring_' "$scratch/exported"; then
    echo "these do not begin with mspring_"
    exit 1
  fi
  include=$(dirname "$1")
  version=$(sed -n 's/^#define MSPRING_VERSION_M[A-Z]* //p' "$include/version.h" | paste -sd.)
  declared "$include/lab.h" "$include/massspring_gradient.h" | sed "s/\$/ MASSSPRING_LAB_$version/" >"$scratch/lab"
  grep MASSSPRING_LAB_ "$scratch/versions" | diff "$scratch/lab" - || {
    echo "src/massspring.map has other functions under MASSSPRING_LAB_$version"
    exit 1
  }
  ;;
dependencies)
  "$READELF" -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\].*/\1/p' >"$scratch/needed"
  cat "$scratch/needed"
  grep -q . "$scratch/needed"
  if grep -vE '^(libc|libm|libpthread|ld-linux[-_a-z0-9]*|ld-musl[-_a-z0-9]*|libc\.musl[-_a-z0-9]*)\.so(\.[0-9]+)*$' "$scratch/needed"; then
    echo "the library needs more than libc, libm and threads"
    exit 1
  fi
  "$READELF" -d "$library" | grep -E 'RPATH|RUNPATH' && exit 1
  "$READELF" -d "$library" | grep -E 'SONAME.*\[libmassspring\.so\.[0-9.]+\]'
  ;;
instructions)
  "$OBJDUMP" -d --no-show-raw-insn "$library" >"$scratch/code"
  # The disassembly is one: there are square roots in it.
  grep -qE 'sqrt|sqebr' "$scratch/code"
  awk '
    /file format/ { member = $1; sub(/:$/, "", member) }
    # The inverse: four fused operations for each approximation, and no others.
    member ~ /(^|[(/])avx512\./ && $2 == "vrcp14ps" { ++inverses; next }
    member ~ /(^|[(/])avx512\./ && $2 ~ /^vfn?madd[123]+ps$/ { ++fused; next }
    $2 ~ /^(vfn?m[as]|fn?m(add|sub)$|fml[as]$|m[as][de]br?$)/ { bad("fused multiply-add", $0) }
    $2 ~ /^(v?rsqrt|v?rcp|vrecp|frsqrt|frecp)/ { bad("approximate reciprocal", $0) }
    # gradient_kernel.c has them in functions with a target of their own, which the CPU chooses among.
    /%[yz]mm/ && member !~ /avx|gradient_kernel/ { bad("wide register outside of the files for it", $0) }
    /%zmm/ && member !~ /avx512|gradient_kernel/ { bad("512-bit register outside of the file for it", $0) }
    function bad(what, line) { if (++count <= 10) print member ": " what ": " line }
    END { if (fused != 4 * inverses) bad("fused operations for " inverses + 0 " inverses", fused + 0) }
    END { print count + 0 " bad instructions in " NR " lines"; exit count > 0 }
  ' "$scratch/code"
  ;;
esac
