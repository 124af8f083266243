#!/bin/bash
# Build the fuzz targets in the form that OSS-Fuzz asks for: with its compiler and flags, its engine, into $OUT, each with
# its seeds as NAME_seed_corpus.zip and, if there is one, a dictionary.
#
#   CC=clang CXX=clang++ CFLAGS='-O1 -g -fsanitize=address,fuzzer-no-link' LIB_FUZZING_ENGINE=-fsanitize=fuzzer \
#     OUT=/tmp/out tests/fuzz/build.sh [TARGET...]
set -eu
cd "$(dirname "$0")/../.."
: "${CC:=clang}" "${CXX:=clang++}" "${CFLAGS:=-O1 -g -fsanitize=address,undefined,fuzzer-no-link}"
: "${LIB_FUZZING_ENGINE:=-fsanitize=fuzzer}" "${OUT:?the folder to put the targets into}" "${WORK:=build-fuzz}"
[ $# -gt 0 ] || set -- archive calls hosts loaders scenes snapshot

cmake -S . -B "$WORK" -DCMAKE_C_COMPILER="$CC" -DCMAKE_CXX_COMPILER="$CXX" -DCMAKE_BUILD_TYPE=None \
  -DCMAKE_C_FLAGS="$CFLAGS" -DCMAKE_CXX_FLAGS="${CXXFLAGS:-$CFLAGS}" -DMASSSPRING_TESTS=ON -DMASSSPRING_ASSERTS=ON -DMASSSPRING_BENCH=OFF \
  -DMASSSPRING_LIBFUZZER=ON "-DMASSSPRING_FUZZING_ENGINE=$LIB_FUZZING_ENGINE" -DCMAKE_DISABLE_FIND_PACKAGE_cmocka=ON
cmake --build "$WORK" -j "${JOBS:-2}" --target "${@/#/fuzz_}"

mkdir -p "$OUT"
for target; do
  cp "$WORK/tests/fuzz_$target" "$OUT/"
  ! [ -d "tests/fuzz/corpus_$target" ] ||
    python3 -m zipfile -c "$OUT/fuzz_${target}_seed_corpus.zip" "tests/fuzz/corpus_$target"/*
  ! [ -f "tests/fuzz/$target.dict" ] || cp "tests/fuzz/$target.dict" "$OUT/fuzz_$target.dict"
done
