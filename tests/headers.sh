#!/bin/sh
# The public headers alone, as all compilers and tools that are here read them, with every warning.
#
#   headers.sh SOURCE WORK
#
# CC and CXX come from the environment. What this machine lacks is left out: clang, tcc, cffi for Python, bindgen, LuaJIT.
set -eu
source=$1 work=$2
mkdir -p "$work"
cd "$work"
include=$source/include/massspring
headers=$(for name in core contact laws batch lab massspring massspring_gradient; do echo "$include/$name.h"; done)
{
  echo '#define MSPRING_EXPERIMENTAL'
  echo '#include <massspring/massspring.h>'
  echo '#include <massspring/massspring_gradient.h>'
  # A struct that is used is laid out, and then -Wpadded sees it.
  # shellcheck disable=SC2086 # a list, here and below
  sed -n 's/^typedef struct \(mspring_[a-z_]*\) {$/extern int size_of_\1[sizeof(\1)];/p' $headers
  # Defaults are used, or no compiler would look at them.
  # shellcheck disable=SC2086
  sed -n 's/^MSPRING_DEFAULT(\(mspring_[a-z_]*\),.*/int use_\1(void); int use_\1(void) { return \1_default().struct_size != 0; }/p' $headers
} >headers.c
cp headers.c headers.cpp
strict="-I$source/include -fsyntax-only -Wall -Wextra -pedantic-errors -Werror"
# Not what C++98 cannot do, which is compiled as such.
all='-Weverything -Wno-c++98-compat -Wno-c++98-compat-pedantic -Wno-unknown-warning-option'
checked=0

wrong() {
  echo "WRONG: $*"
  exit 1
}

# Each struct with struct_size has mspring_x_default() behind it, but for mspring_hook_args, which the library makes.
# shellcheck disable=SC2086
awk '
  /^typedef struct mspring_[a-z_]* \{$/ { name = $3; sized = 0 }
  /^    uint32_t struct_size;/ { sized = 1 }
  /^\} mspring_[a-z_]*;$/ && sized && name != "mspring_hook_args" {
    expected = "MSPRING_DEFAULT(" name ", MSPRING_STRUCT_" substr(toupper(name), 9) ");"
    if ((getline behind) < 1 || behind != expected) { print "not behind its struct: " expected; bad = 1 }
  }
  /^\}/ { sized = 0 }
  END { exit bad }
' $headers
checked=$((checked + 1))

# It is in mspring_struct; in src/base/structs.def with its first size; in tests/abi/sizes.c with its size of today. One
# that is a member of another stands last there, so that both can grow.
# shellcheck disable=SC2086
awk '/^typedef struct mspring_[a-z_]* \{$/ { name = $3 } /^    uint32_t struct_size;/ { print name }' $headers | sort >in_headers
sed -n 's/^    MSPRING_STRUCT_\([A-Z_]*\) = [0-9].*/\1/p' "$include/core.h" | tr A-Z a-z | sed 's/^/mspring_/' |
  sort | diff in_headers -
sed -n 's/^[A-Z]*_STRUCT(\([a-z_]*\),.*/mspring_\1/p' "$source/src/base/structs.def" | sort | diff in_headers -
sed -n 's/^SIZE(\(mspring_[a-z_]*\),.*/\1/p' "$source/tests/abi/sizes.c" | grep -vxE 'mspring_(event|column|observation)' |
  sort | diff in_headers -
while read -r name; do
  # shellcheck disable=SC2086
  awk -v name="$name" '
    behind && !/^\} mspring_/ { print FILENAME ": " name " is a member of another struct, and not the last"; bad = 1 }
    { behind = $1 == name && /^    [a-z_]+ [a-z_, ]+;/ }
    END { exit bad }' $headers
done <in_headers
checked=$((checked + 1))

# The comment of a function tells who may call it, whether it allocates and, if it can fail, how.
# shellcheck disable=SC2086
awk '
  /^\/\/\// { comment = said ? $0 : comment " " $0; said = 0; next }
  /^$/ { comment = ""; next }
  /^MSPRING_.* MSPRING_CALL mspring_/ {
    name = $0
    sub(/.* MSPRING_CALL /, "", name)
    sub(/\(.*/, "", name)
    form = "Threads: (any|shared|exclusive)[^:]*[.;] Allocates: "
    gsub(/ \/\/\/ /, " ", comment)
    if (comment !~ form || ($0 ~ /mspring_result MSPRING_CALL/ && comment !~ (form ".*[.] Errors: .*[.]$"))) {
      print name ": its comment does not end with Threads, Allocates, Errors"
      bad = 1
    }
    count++
    said = 1
  }
  END { exit bad || count < 100 }
' $headers
checked=$((checked + 1))

# Functions, structs, fields and constants are as many as recorded.
if command -v python3 >/dev/null; then
  python3 "$source/tests/abi/count" "$include" | diff "$source/tests/abi/counts.txt" - ||
    wrong "the headers have other numbers than tests/abi/counts.txt; if that is meant: tests/abi/renew"
  checked=$((checked + 1))
fi

for compiler in "${CC:-cc}" clang; do
  command -v "$compiler" >/dev/null || continue
  more=-Wconversion
  [ "$compiler" != clang ] || more=$all
  for standard in c99 c11 c17 c2x; do
    # shellcheck disable=SC2086 # the options are words
    "$compiler" -std=$standard $strict $more headers.c
    checked=$((checked + 1))
  done
done
# Other layouts: pointers of 32 bits. There is no C library.
if command -v clang >/dev/null; then
  for target in arm-none-eabi wasm32; do
    ! clang --print-targets | grep -qw "${target%%-*}" || {
      # shellcheck disable=SC2086
      clang --target=$target -ffreestanding -std=c99 $strict $all headers.c
      checked=$((checked + 1))
    }
  done
fi
for compiler in "${CXX:-c++}" clang++; do
  command -v "$compiler" >/dev/null || continue
  more=
  [ "$compiler" != clang++ ] || more=$all
  for standard in c++98 c++11 c++14 c++17 c++20; do
    # shellcheck disable=SC2086
    "$compiler" -std=$standard $strict $more -Wno-long-long -Wno-c++11-long-long headers.cpp
    checked=$((checked + 1))
  done
done

# Each header alone. lab.h says what it wants.
for header in core contact laws batch massspring massspring_gradient; do
  echo "#include <massspring/$header.h>" >alone.c
  # shellcheck disable=SC2086
  "${CC:-cc}" -std=c99 $strict alone.c
  checked=$((checked + 1))
done
echo '#include <massspring/lab.h>' >alone.c
# shellcheck disable=SC2086
! "${CC:-cc}" -std=c99 $strict alone.c 2>says || wrong "lab.h does without MSPRING_EXPERIMENTAL"
grep -q 'define MSPRING_EXPERIMENTAL before' says
# The names of 0.2 bring massspring.h, and say that they are to go.
for header in tools contact laws batch; do
  printf '#include <massspring/massspring_%s.h>\nint main(void) { return !MSPRING_VERSION; }\n' $header >old.c
  "${CC:-cc}" -std=c99 "-I$source/include" -fsyntax-only old.c 2>says
  grep -q "massspring_$header.h is a name of version 0.2: include massspring.h" says
  checked=$((checked + 1))
done

# The header that draws, whose code each compiler sees.
echo '#include <massspring_svg.h>' >svg.c
cp svg.c svg.cpp
own='-Wconversion -Wsign-conversion -Wdouble-promotion -Wshadow -Wcast-qual -Wformat=2'
for compiler in "${CC:-cc}" clang; do
  command -v "$compiler" >/dev/null || continue
  # shellcheck disable=SC2086
  "$compiler" -std=c99 $strict $own svg.c
  checked=$((checked + 1))
done
for compiler in "${CXX:-c++}" clang++; do
  command -v "$compiler" >/dev/null || continue
  # shellcheck disable=SC2086
  "$compiler" -std=c++98 $strict $own -Wold-style-cast -Wno-long-long -Wno-c++11-long-long svg.cpp
  checked=$((checked + 1))
done

# What a program may define itself.
for own in -DMSPRING_NODISCARD= -DMSPRING_API=extern '-DMSPRING_NODISCARD=__attribute__((unused))'; do
  # shellcheck disable=SC2086
  "${CC:-cc}" -std=c11 $strict "$own" headers.c
  # shellcheck disable=SC2086
  "${CXX:-c++}" -std=c++17 $strict "$own" headers.cpp
  checked=$((checked + 1))
done

# For parsers: declarations alone.
grep -v '_default()' headers.c >declarations.c
if command -v tcc >/dev/null; then
  tcc -Wall -Werror -I"$source/include" -c headers.c -o headers.o
  checked=$((checked + 1))
else
  echo "left out: tcc"
fi

# What cffi and LuaJIT take: the headers as the preprocessor leaves them, but for the system's.
{
  echo '#define MSPRING_NO_INLINE'
  echo '#define MSPRING_EXPERIMENTAL'
  # shellcheck disable=SC2086
  cat "$include/export.h" $headers | grep -vE '#include|#error|__attribute__'
} | "${CC:-cc}" -E -P -DMSPRING_API= -DMSPRING_NODISCARD= - >flat.h
if python3 -c 'import cffi' 2>/dev/null; then
  python3 - <<'END'
import cffi
ffi = cffi.FFI()
ffi.cdef(open("flat.h").read())
assert ffi.sizeof("mspring_network_def") == 120 + 4 * ffi.sizeof("void *"), ffi.sizeof("mspring_network_def")
assert ffi.typeof("mspring_solver").elements[1] == "MSPRING_SOLVER_IMPLICIT"
END
  checked=$((checked + 1))
else
  echo "left out: cffi"
fi
if command -v luajit >/dev/null; then
  luajit -e 'local ffi = require("ffi") ffi.cdef(io.open("flat.h"):read("*a")) assert(ffi.sizeof("mspring_event") == 16)'
  checked=$((checked + 1))
else
  echo "left out: LuaJIT"
fi

if command -v bindgen >/dev/null; then
  bindgen declarations.c -o headers.rs -- -DMSPRING_NO_INLINE "-I$source/include" 2>bindgen.says
  [ ! -s bindgen.says ]
  # Types and constants of enums are the same, and signed; functions and fields have these types.
  grep -q 'pub const mspring_solver_MSPRING_SOLVER_IMPLICIT: mspring_solver = 1;' headers.rs
  grep -q 'pub type mspring_solver = ::std::os::raw::c_int;' headers.rs
  grep -q 'pub solver: mspring_solver,' headers.rs
  grep -q 'pub const MSPRING_NONE: u32 = 4294967295;' headers.rs
  grep -q 'pub const MSPRING_MAX_PARTICLES: u32 = 67108864;' headers.rs
  ! command -v rustc >/dev/null || rustc -A warnings --crate-type lib --emit metadata headers.rs -o headers.rmeta
  checked=$((checked + 1))
else
  echo "left out: bindgen"
fi
echo "$checked checked, 0 wrong"
