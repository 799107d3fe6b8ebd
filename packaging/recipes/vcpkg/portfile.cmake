# Untried (../README.md).
vcpkg_from_github(
  OUT_SOURCE_PATH SOURCE_PATH
  REPO OWNER/rastrum
  REF "v${VERSION}"
  SHA512 0
  HEAD_REF main)

vcpkg_check_features(OUT_FEATURE_OPTIONS features
  FEATURES
    program RASTRUM_BUILD_APPS
    tbb RASTRUM_TBB
  INVERTED_FEATURES
    draco CMAKE_DISABLE_FIND_PACKAGE_draco
    exr CMAKE_DISABLE_FIND_PACKAGE_OpenEXR
    formulas CMAKE_DISABLE_FIND_PACKAGE_muparser
    meshopt CMAKE_DISABLE_FIND_PACKAGE_meshoptimizer)

vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS ${features} -DRASTRUM_WINDOW=OFF -DRASTRUM_BUILD_TESTS=OFF -DRASTRUM_BUILD_EXAMPLES=OFF -DRASTRUM_BUILD_BENCH=OFF
    -DCMAKE_DISABLE_FIND_PACKAGE_GDAL=ON -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON
  MAYBE_UNUSED_VARIABLES RASTRUM_WINDOW)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME Rastrum CONFIG_PATH lib/cmake/Rastrum)
vcpkg_fixup_pkgconfig()
if("program" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES rastrum AUTO_CLEAN)
endif()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST
  "${SOURCE_PATH}/LICENSE" "${SOURCE_PATH}/rastrum/overlay/font/LICENSE" "${SOURCE_PATH}/rastrum/scene/color_maps/LICENSE")
