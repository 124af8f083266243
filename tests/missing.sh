#!/bin/sh
# What examples/install-packages says of packages that cannot be had: on a system without apt-get, it names just these,
# as the other systems call them; where apt-get fails, it shows one line of its errors.
#
#   tests/missing.sh SOURCE
set -u
tool=$1/examples/install-packages
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
wrong=0

# A path with the tools of any system, and no package manager.
mkdir "$scratch/bin"
for program in sh env sed cut grep sort tr awk id cat rm mktemp ls; do
  ln -s "$(command -v $program)" "$scratch/bin/"
done
try() { # packages; what is said goes into $scratch/said
  PATH=$scratch/bin sh "$tool" "$@" >"$scratch/said" 2>&1 && complain "all is said to be there: $*"
}
complain() {
  wrong=$((wrong + 1))
  echo "WRONG: $*"
  sed 's/^/    /' "$scratch/said"
}
says() {
  grep -qxF -e "$1" "$scratch/said" || complain "it does not say: $1"
}

try clang xdotool libcmocka-dev
says 'Missing: clang xdotool libcmocka-dev'
says '  Debian, Ubuntu: apt-get install clang xdotool libcmocka-dev'
says '  Fedora: dnf install clang libcmocka-devel xdotool'
says '  Arch: pacman -S clang cmocka xdotool'
says '  macOS: brew install cmocka llvm'
try gcc make
says '  macOS: xcode-select --install'
try gcc cmake
says '  macOS: xcode-select --install; brew install cmake'

# apt-get, as root or through sudo, that fails with many words.
cat >"$scratch/bin/apt-get" <<'END'
#!/bin/sh
echo 'Reading package lists...' >&2
echo 'E: Unmet dependencies.' >&2
echo 'E: Something else.' >&2
exit 100
END
printf '#!/bin/sh\nexec "$@"\n' >"$scratch/bin/sudo"
chmod +x "$scratch/bin/apt-get" "$scratch/bin/sudo"
try clang
says 'E: Unmet dependencies.'
says 'Get them as an administrator: apt-get install clang'
[ "$(wc -l <"$scratch/said")" -eq 4 ] || complain 'it says more than that'

[ $wrong -eq 0 ]
