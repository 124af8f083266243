#!/bin/sh
# What is handed out.
#
#   packages.sh archive       SOURCE BUILD WORK   the archive, unpacked somewhere, serves a program
#   packages.sh deb           SOURCE BUILD WORK   the Debian packages, in a root of their own, serve a program, which
#                                                 becomes a package that depends on them; they pass their autopkgtest
#                                                 and lintian, and no link of the manual is dead
#   packages.sh reproducible  SOURCE BUILD WORK   the same sources in another folder give the same bytes as in BUILD
#
# CMAKE, CPACK and CC come from the environment. If MASSSPRING_TEST_QUICK is set there, the Debian packages
# are made without optimisation.
set -eu
check=$1 source=$2 build=$3 work=$4/packages
CMAKE=${CMAKE:-cmake} CPACK=${CPACK:-cpack} CC=${CC:-cc}
# A compiler's cache would give back the very files to compare with.
export CC CCACHE_DISABLE=1
skip() {
  echo "skipped: $1"
  exit 77
}
# Build a program against what is in $work/root, and run it. The options are folders that its .pc does not name.
use_package() {
  command -v pkg-config >/dev/null || skip "no pkg-config here"
  PKG_CONFIG_PATH=$(dirname "$(find "$work/root" -name massspring.pc)")
  export PKG_CONFIG_PATH
  libdir=$(dirname "$PKG_CONFIG_PATH")
  # shellcheck disable=SC2046 # options are meant to be split
  "$CC" "$source/tests/consumer/main.c" -o "$work/shared" "$@" $(pkg-config --cflags --libs massspring)
  LD_LIBRARY_PATH=$libdir "$work/shared"
  # shellcheck disable=SC2046
  "$CC" -static "$source/tests/consumer/main.c" -o "$work/static" "$@" $(pkg-config --static --cflags --libs massspring)
  "$work/static"
}

# Make a package of that program, as another project would, and see what it depends on.
package_a_program() {
  mkdir -p "$work/swing/debian/swing/usr/bin" "$work/swing/debian/swing/DEBIAN"
  dpkg-deb --raw-extract "$work"/built/libmassspring0.3_*.deb "$work/swing/debian/libmassspring0.3"
  cd "$work/swing"
  cp "$work/shared" debian/swing/usr/bin/swing
  # shellcheck disable=SC2016 # for dpkg
  printf '%s\n' 'Source: swing' 'Maintainer: Some One <one@some.example>' '' 'Package: swing' 'Architecture: any' \
    'Depends: ${shlibs:Depends}' 'Description: a swing' >debian/control
  printf '%s\n' 'swing (1-1) unstable; urgency=medium' '' '  * A swing.' '' \
    ' -- Some One <one@some.example>  Sun, 22 Nov 2026 12:00:00 +0000' >debian/changelog
  dpkg-shlibdeps -Sdebian/libmassspring0.3 debian/swing/usr/bin/swing
  dpkg-gencontrol -pswing -Pdebian/swing
  dpkg-deb --root-owner-group --build debian/swing swing.deb
  dpkg-deb --field swing.deb Package Depends
  dpkg-deb --field swing.deb Depends | grep -qF 'libmassspring0.3 (>= 0.3.0)'
  cd "$work"
}

rm -rf "${work:?}/$check"
mkdir -p "$work/$check"
work=$work/$check

case $check in
archive)
  "$CPACK" --config "$build/CPackConfig.cmake" -G TGZ -B "$work" >"$work/log" 2>&1 || {
    cat "$work/log"
    exit 1
  }
  tar -tzf "$work"/massspring-*.tar.gz >"$work/files"
  cat "$work/files"
  # It is unpacked anywhere, and so has no usr in it.
  if grep -E '^[^/]*/usr/|^/|^\./' "$work/files"; then
    echo "these are in the wrong place"
    exit 1
  fi
  for file in $(cd "$source" && ls include/*.h include/massspring/*.h) share/doc/massspring/LICENSE share/doc/massspring/CHANGELOG.md; do
    grep -q "^massspring-[^/]*/$file\$" "$work/files"
  done
  mkdir "$work/root"
  tar -xzf "$work"/massspring-*.tar.gz --strip-components 1 -C "$work/root"
  use_package
  ;;
deb)
  # Full optimisation takes most of the time, and changes nothing of what is looked at here.
  DEB_BUILD_OPTIONS="nocheck parallel=2${MASSSPRING_TEST_QUICK:+ noopt}" "$source/pkgconfig/build-deb" \
    "$work/built" >"$work/log" 2>&1 || {
    status=$?
    tail -50 "$work/log"
    exit $status
  }
  for package in "$work"/built/*.deb; do
    name=$(dpkg-deb --field "$package" Package)
    dpkg-deb --field "$package" Package Depends Maintainer
    dpkg-deb --contents "$package" | awk '$1 !~ /^d/ { print $6 }' >"$work/$name.files"
    dpkg-deb --extract "$package" "$work/root"
  done
  # The runtime package is the library alone, and what is to be said of it.
  cat "$work/libmassspring0.3.files"
  if grep -vE '/lib/[^/]+/libmassspring\.so\.[0-9.]+$|/doc/libmassspring0.3/' "$work/libmassspring0.3.files"; then
    echo "these belong into the package for building"
    exit 1
  fi
  for name in libmassspring0.3 libmassspring-dev libmassspring-doc; do
    grep -q "/usr/share/doc/$name/copyright" "$work/$name.files"
    grep -q "/usr/share/doc/$name/changelog.gz" "$work/$name.files"
  done
  # The headers and the library lie where every compiler looks: the .pc names neither folder.
  pc=$(find "$work/root" -name massspring.pc)
  if grep -E '^(Libs|Cflags):.*[$/]' "$pc"; then
    echo "folders of the system"
    exit 1
  fi
  use_package "-I$work/root/usr/include" "-L$(dirname "$(dirname "$pc")")"
  (cd "$source" && CPPFLAGS="-I$work/root/usr/include" LDFLAGS="-L$libdir" LD_LIBRARY_PATH=$libdir \
    pkgconfig/debian/tests/readme)
  python3 -B "$source/tests/installed.py" "$work/root/usr" share/doc/libmassspring-doc
  package_a_program
  if command -v lintian >/dev/null; then
    # Nobody has asked Debian for these packages, so no bug there is closed by them.
    lintian --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs "$work"/built/*.changes
  else
    echo "no lintian here"
  fi
  ;;
reproducible)
  (cd "$source" && cp -r CMakeLists.txt LICENSE README.md CHANGELOG.md include src pkgconfig "$work")
  type=$(sed -n 's/^CMAKE_BUILD_TYPE:[A-Z]*=//p' "$build/CMakeCache.txt")
  [ "$type" = Release ] || skip "only release builds have no paths in them"
  scalar=$(sed -n 's/^MASSSPRING_SCALAR:BOOL=//p' "$build/CMakeCache.txt") # a build without tests has none
  "$CMAKE" -S "$work" -B "$work/build" -DCMAKE_BUILD_TYPE=Release -DMASSSPRING_TESTS=OFF -DMASSSPRING_EXAMPLES=OFF \
    -DMASSSPRING_BENCH=OFF -DMASSSPRING_SCALAR="$scalar" >/dev/null
  "$CMAKE" --build "$work/build" -j 2 --target massspring_shared massspring_static >/dev/null
  for library in libmassspring.so libmassspring.a; do
    cmp "$build/src/$library" "$work/build/src/$library"
    cksum "$work/build/src/$library"
  done
  ;;
esac
