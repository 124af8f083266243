#!/bin/sh
# The public headers alone, as all compilers and tools that are here read them, with every warning.
#
#   headers.sh SOURCE WORK
#
# CC and CXX come from the environment. What this machine lacks is left out: clang, tcc, cffi for Python, bindgen.
set -eu
source=$1 work=$2
mkdir -p "$work"
cd "$work"
{
  for header in "$source"/include/massspring/*.h; do
    echo "#include <massspring/$(basename "$header")>"
  done
  # A struct that is used is laid out, and then -Wpadded sees it.
  sed -n 's/^typedef struct \(mspring_[a-z_]*\) {$/extern int size_of_\1[sizeof(\1)];/p' "$source"/include/massspring/*.h
} >headers.c
cp headers.c headers.cpp
strict="-I$source/include -fsyntax-only -Wall -Wextra -pedantic-errors -Werror"
# Not what the documentation is like, and what C++98 cannot do, which is compiled as such.
all='-Weverything -Wno-documentation -Wno-documentation-unknown-command -Wno-c++98-compat -Wno-c++98-compat-pedantic'
all="$all -Wno-reserved-identifier -Wno-unknown-warning-option"
checked=0

# A struct with struct_size is filled by the host, which needs an init function, or by the library, and then the host
# sets struct_size. The comment says which. The library makes mspring_hook_args itself.
awk '
  /^\/\/\// { comment = comment $0 "\n"; next }
  /^typedef struct mspring_[a-z_]* \{$/ { name = $3; said = comment; comment = ""; next }
  name != "" && /^    uint32_t struct_size;/ {
    if (name != "mspring_hook_args" && !index(said, name "_init()") && !index(said, "Set struct_size first"))
      wrong = wrong " " name
  }
  { name = comment = "" }
  END { if (wrong != "") { print "neither an init function nor struct_size in the comment of:" wrong; exit 1 } }
' "$source"/include/massspring/*.h
checked=$((checked + 1))

# Each of them is in src/base/structs.def with its first size, as one that has an init function or as one that has none;
# and in tests/abi/sizes.c with its size of today. One that is a member of another would move what follows when it grows.
for header in "$source"/include/massspring/*.h; do
  awk '
    /^typedef struct mspring_[a-z_]* \{$/ { name = $3 }
    /^    uint32_t struct_size;/ { print name }
  ' "$header"
done | sort >in_headers
sed -n 's/^[A-Z]*_STRUCT(\([a-z_]*\),.*/mspring_\1/p' "$source/src/base/structs.def" | sort >in_table
diff in_headers in_table
sed -n 's/^INPUT_STRUCT(\([a-z_]*\),.*/mspring_\1/p' "$source/src/base/structs.def" | sort >with_defaults
sed -n 's/.*MSPRING_CALL \(mspring_[a-z_]*\)_init(.*/\1/p' "$source"/include/massspring/*.h | sort | diff - with_defaults
sed -n 's/^SIZE(\(mspring_[a-z_]*\),.*/\1/p' "$source/tests/abi/sizes.c" | grep -vx mspring_event | sort | diff - in_table
while read -r name; do
  ! grep -nE "^    $name [a-z_, ]*(\[[A-Z_]*\])?;" "$source"/include/massspring/*.h || {
    echo "$name is a member of another struct: the table has no way to let both grow"
    exit 1
  }
done <in_headers
checked=$((checked + 1))

for compiler in "${CC:-cc}" clang; do
  command -v "$compiler" >/dev/null || continue
  more=
  [ "$compiler" != clang ] || more=$all
  for standard in c99 c11 c17 c2x; do
    # shellcheck disable=SC2086 # the options are words
    "$compiler" -std=$standard $strict $more headers.c
    checked=$((checked + 1))
  done
done
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

if command -v tcc >/dev/null; then
  tcc -Wall -Werror -I"$source/include" -c headers.c -o headers.o
  checked=$((checked + 1))
else
  echo "left out: tcc"
fi

if python3 -c 'import cffi' 2>/dev/null; then
  # The whole of all headers, in four lines.
  python3 - "$source" <<'END'
import cffi, re, subprocess, sys
text = "".join(open(f"{sys.argv[1]}/include/massspring/{name}.h").read() for name in ("export", "massspring", "massspring_batch", "massspring_contact", "massspring_laws", "massspring_tools"))
flat = subprocess.run(["cc", "-E", "-P", "-DMSPRING_API=", "-DMSPRING_NODISCARD=", "-"], text=True, check=True,
                      input=re.sub('#include.*|__attribute__.*', '', text), capture_output=True).stdout
ffi = cffi.FFI()
ffi.cdef(flat)
assert ffi.sizeof("mspring_network_def") == 96 + 8 * (ffi.sizeof("void *") // 8), ffi.sizeof("mspring_network_def")
assert ffi.typeof("mspring_solver").elements[1] == "MSPRING_SOLVER_IMPLICIT"
END
  checked=$((checked + 1))
else
  echo "left out: cffi"
fi

if command -v bindgen >/dev/null; then
  bindgen headers.c -o headers.rs -- -I"$source/include" 2>bindgen.says
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
