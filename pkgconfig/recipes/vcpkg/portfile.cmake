# Template, untested.
vcpkg_from_github(
  OUT_SOURCE_PATH SOURCE_PATH
  REPO REPOSITORY
  REF "v${VERSION}"
  SHA512 0)
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS -DMASSSPRING_TESTS=OFF -DMASSSPRING_EXAMPLES=OFF -DMASSSPRING_BENCH=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/massspring)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
