#!/bin/sh
# What is handed out.
#
#   packages.sh deb           SOURCE BUILD WORK   the Debian packages, in a root of their own, serve a program
#   packages.sh reproducible  SOURCE BUILD WORK   the same sources in another folder give the same bytes as in BUILD
#
# CMAKE, CPACK and CC come from the environment.
set -eu
check=$1 source=$2 build=$3 work=$4/packages
CMAKE=${CMAKE:-cmake} CPACK=${CPACK:-cpack} CC=${CC:-cc}
# A compiler's cache would give back the very files to compare with.
export CC CCACHE_DISABLE=1
skip() {
  echo "skipped: $1"
  exit 77
}
rm -rf "${work:?}/$check"
mkdir -p "$work/$check"
work=$work/$check

case $check in
deb)
  command -v dpkg-deb >/dev/null || skip "no dpkg-deb here"
  command -v pkg-config >/dev/null || skip "no pkg-config here"
  "$CPACK" --config "$build/CPackConfig.cmake" -G DEB -B "$work" >"$work/log" 2>&1 || {
    cat "$work/log"
    exit 1
  }
  for package in "$work"/*.deb; do
    dpkg-deb --field "$package" Package Depends
    dpkg-deb --extract "$package" "$work/root"
  done
  # The runtime package is the library alone.
  dpkg-deb --contents "$work"/libmassspring[0-9]*.deb | awk '$1 !~ /^d/ { print $6 }' >"$work/runtime"
  cat "$work/runtime"
  if grep -v '/libmassspring\.so\.[0-9]' "$work/runtime"; then
    echo "these belong into the package for building"
    exit 1
  fi
  PKG_CONFIG_PATH=$(dirname "$(find "$work/root" -name massspring.pc)")
  export PKG_CONFIG_PATH
  libdir=$(dirname "$PKG_CONFIG_PATH")
  # shellcheck disable=SC2046 # options are meant to be split
  "$CC" "$source/tests/consumer/main.c" -o "$work/shared" $(pkg-config --cflags --libs massspring)
  LD_LIBRARY_PATH=$libdir "$work/shared"
  # shellcheck disable=SC2046
  "$CC" -static "$source/tests/consumer/main.c" -o "$work/static" $(pkg-config --static --cflags --libs massspring)
  "$work/static"
  ;;
reproducible)
  (cd "$source" && cp -r CMakeLists.txt LICENSE README.md include src pkgconfig "$work")
  type=$(sed -n 's/^CMAKE_BUILD_TYPE:[A-Z]*=//p' "$build/CMakeCache.txt")
  [ "$type" = Release ] || skip "only release builds have no paths in them"
  "$CMAKE" -S "$work" -B "$work/build" -DCMAKE_BUILD_TYPE=Release -DMASSSPRING_TESTS=OFF -DMASSSPRING_EXAMPLES=OFF \
    -DMASSSPRING_BENCH=OFF >/dev/null
  "$CMAKE" --build "$work/build" -j 2 --target massspring_shared massspring_static >/dev/null
  for library in libmassspring.so libmassspring.a; do
    cmp "$build/src/$library" "$work/build/src/$library"
    cksum "$work/build/src/$library"
  done
  ;;
esac
