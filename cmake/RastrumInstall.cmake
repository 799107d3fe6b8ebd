# Installation: the public headers, libraries, programs, examples, and packages for find_package(Rastrum)
# and for pkg-config.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Rastrum)

# A static library leaves its own libraries to whoever links it, so the package must find them too:
# one find_dependency for each imported target that `target` links, the private ones included.
function(rastrum_dependencies target out)
  set(package_TBB "TBB")
  set(package_ZLIB "ZLIB")
  set(package_PNG "PNG")
  set(package_libdeflate "libdeflate")
  set(package_muparser "muparser CONFIG")
  set(package_JPEG "JPEG")
  set(package_OpenEXR "OpenEXR CONFIG")
  set(package_meshoptimizer "meshoptimizer CONFIG")
  set(package_draco "draco CONFIG")
  set(package_nlohmann_json "nlohmann_json CONFIG")

  get_target_property(links ${target} LINK_LIBRARIES)
  set(calls "")
  foreach(link IN LISTS links)
    # "::@(…)" marks the folder whose CMakeLists.txt linked the library that follows.
    if(link MATCHES "BUILD_INTERFACE|^::@" OR link STREQUAL "rastrum")
      continue()
    elseif(NOT link MATCHES "^([A-Za-z_]+)::")
      message(FATAL_ERROR "${target} links '${link}', which is no imported target: an installed "
        "package could not find it elsewhere")
    elseif(NOT DEFINED package_${CMAKE_MATCH_1})
      message(FATAL_ERROR "say in cmake/RastrumInstall.cmake which package has '${link}'")
    endif()
    list(APPEND calls "find_dependency(${package_${CMAKE_MATCH_1}})")
  endforeach()
  list(REMOVE_DUPLICATES calls)
  list(JOIN calls "\n" calls)
  set(${out} "${calls}" PARENT_SCOPE)
endfunction()

# C++'s own libraries, which linkers that are called for C or Fortran do not add.
set(RASTRUM_CXX_LIBRARIES "")
get_target_property(type rastrum TYPE)
if(type STREQUAL "STATIC_LIBRARY")
  set(RASTRUM_CXX_LIBRARIES ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
  list(FILTER RASTRUM_CXX_LIBRARIES INCLUDE REGEX "^(stdc\\+\\+|c\\+\\+|c\\+\\+abi|m)$")
endif()

rastrum_dependencies(rastrum RASTRUM_FIND_DEPENDENCIES)
rastrum_dependencies(rastrum_io RASTRUM_FIND_IO_DEPENDENCIES)
rastrum_dependencies(rastrum_family RASTRUM_FIND_FAMILY_DEPENDENCIES)
configure_package_config_file(cmake/RastrumConfig.cmake.in
  ${PROJECT_BINARY_DIR}/cmake/RastrumConfig.cmake INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/RastrumConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)

file(GLOB public_headers CONFIGURE_DEPENDS include/rastrum/*.hpp papers/include/rastrum/*.hpp)
install(FILES ${public_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rastrum)
install(FILES include/rastrum.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS rastrum rastrum_shaders EXPORT RastrumTargets)
install(TARGETS rastrum_io EXPORT RastrumIoTargets)
install(TARGETS rastrum_family EXPORT RastrumFamilyTargets)
# Programs look for the library of device code by its name (parallel/cuda/library.hpp): those that
# are installed here, and those that link the package, wherever that lies.
if(TARGET rastrum_cuda)
  install(TARGETS rastrum_cuda EXPORT RastrumTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  target_link_options(rastrum INTERFACE
    $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${CMAKE_INSTALL_LIBDIR}>)
endif()
foreach(part Targets IoTargets FamilyTargets)
  install(EXPORT Rastrum${part} NAMESPACE Rastrum:: DESTINATION ${package_dir})
endforeach()

# How a compiler's command line names the library of an imported target; empty for headers alone.
function(rastrum_link_flag target out)
  set(flag_TBB::tbb -ltbb)
  set(flag_ZLIB::ZLIB -lz)
  set(flag_PNG::PNG -lpng)
  set(flag_libdeflate::libdeflate -ldeflate)
  set(flag_JPEG::JPEG -ljpeg)
  set(flag_OpenEXR::OpenEXR "-lOpenEXR -lIlmThread -lIex -lImath")
  set(flag_meshoptimizer::meshoptimizer -lmeshoptimizer)
  set(flag_draco::draco -ldraco)
  set(flag_muparser::muparser -lmuparser)
  set(${out} "${flag_${target}}" PARENT_SCOPE)
endfunction()
# pkg-config: rastrum, and what stands on it. Static libraries say all that they link.
function(rastrum_pkg_config name target description requires)
  get_target_property(links ${target} LINK_LIBRARIES)
  set(libraries "")
  foreach(link IN LISTS links)
    if(link MATCHES "^[A-Za-z_]+::")
      list(APPEND libraries ${link})
    endif()
  endforeach()
  set(PC_LIBS "-l${target}")
  foreach(library IN LISTS libraries)
    rastrum_link_flag(${library} flag)
    string(APPEND PC_LIBS " ${flag}")
  endforeach()
  file(RELATIVE_PATH PC_UP /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  if(NOT requires)
    list(TRANSFORM RASTRUM_CXX_LIBRARIES PREPEND " -l" OUTPUT_VARIABLE cxx_libraries)
    string(APPEND PC_LIBS ${cxx_libraries})
  endif()
  set(PC_NAME ${name})
  set(PC_DESCRIPTION "${description}")
  set(PC_REQUIRES "${requires}")
  configure_file(cmake/rastrum.pc.in ${PROJECT_BINARY_DIR}/cmake/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/cmake/${name}.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
rastrum_pkg_config(rastrum rastrum "Software rendering: arrays in, arrays out" "")
rastrum_pkg_config(rastrum-io rastrum_io "Rastrum's files" rastrum)
rastrum_pkg_config(rastrum-family rastrum_family "The published rasterizers beside Rastrum's own" rastrum)

install(DIRECTORY examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/rastrum/examples
  FILES_MATCHING PATTERN "*.cpp" PATTERN "*.c" PATTERN "*.f90" PATTERN CMakeLists.txt PATTERN inside EXCLUDE)
install(FILES
  ${PROJECT_BINARY_DIR}/cmake/RastrumConfig.cmake
  ${PROJECT_BINARY_DIR}/cmake/RastrumConfigVersion.cmake
  cmake/Findlibdeflate.cmake
  DESTINATION ${package_dir})
install(FILES LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Licences of the font whose outlines are in the library, and of the library's colour maps.
install(FILES rastrum/overlay/font/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.DejaVu)
install(FILES rastrum/scene/color_maps/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.colour_maps)
if(TARGET rastrum_program)
  install(TARGETS rastrum_program)
endif()
if(TARGET rastrum_bench_program)
  install(TARGETS rastrum_bench_program OPTIONAL)  # `./dev run` builds the program alone
endif()
