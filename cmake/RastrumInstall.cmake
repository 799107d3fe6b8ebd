# Installs the public headers, libraries, programs, examples and pages, and packages for find_package(Rastrum)
# and pkg-config. They are for the static libraries or, with BUILD_SHARED_LIBS, for librastrum.so, by the same
# names.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Rastrum)

# A static library leaves its dependencies to its users. For each possible dependency: its package for
# find_package, and its flags on a compiler's command line (none for headers only).
macro(rastrum_external target package flags)
  set(package_${target} "${package}")
  set(flags_${target} "${flags}")
endmacro()
rastrum_external(TBB::tbb TBB -ltbb)
rastrum_external(Threads::Threads Threads -pthread)
rastrum_external(ZLIB::ZLIB ZLIB -lz)
rastrum_external(PNG::PNG PNG -lpng)
rastrum_external(libdeflate::libdeflate libdeflate -ldeflate)
rastrum_external(muparser::muparser "muparser CONFIG" -lmuparser)
rastrum_external(JPEG::JPEG JPEG -ljpeg)
rastrum_external(OpenEXR::OpenEXR "OpenEXR CONFIG" "-lOpenEXR -lIlmThread -lIex -lImath")
rastrum_external(meshoptimizer::meshoptimizer "meshoptimizer CONFIG" -lmeshoptimizer)
rastrum_external(draco::draco "draco CONFIG" -ldraco)
rastrum_external(nlohmann_json::nlohmann_json "nlohmann_json CONFIG" "")
rastrum_external(MPI::MPI_CXX "MPI COMPONENTS CXX" "")

# Sets what `target` links beside Rastrum: a list of packages, and compiler flags, with the target's own
# first.
function(rastrum_links target packages flags)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    get_target_property(links ${target} LINK_LIBRARIES)
    set(said -l${target})
  elseif(type STREQUAL "SHARED_LIBRARY")
    set(said -lrastrum)
  endif()
  foreach(link IN LISTS links)
    # "::@(…)" marks the folder whose CMakeLists.txt linked the following library.
    if(link MATCHES "_INTERFACE:|^::@" OR link STREQUAL "rastrum")
      continue()
    elseif(NOT DEFINED package_${link})
      message(FATAL_ERROR "${target} links '${link}': say in cmake/RastrumInstall.cmake which package has it")
    endif()
    list(APPEND found "${package_${link}}")
    string(APPEND said " ${flags_${link}}")
  endforeach()
  set(${packages} "${found}" PARENT_SCOPE)
  set(${flags} "${said}" PARENT_SCOPE)
endfunction()

# rastrum_part(PART DESCRIPTION TARGET…): a component of the package, with a file of targets and a pkg-config
# file. The first target is its library.
macro(rastrum_part part description target)
  rastrum_links(${target} packages PC_LIBS)
  list(JOIN packages "\" \"" packages)
  string(APPEND RASTRUM_NEEDS "set(Rastrum_needs_${part} \"${packages}\")\n")
  install(TARGETS ${target} ${ARGN} EXPORT ${kind}_${part}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${rules} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} ${rules})
  install(EXPORT ${kind}_${part} FILE Rastrum_${kind}_${part}.cmake NAMESPACE Rastrum:: DESTINATION ${package_dir} ${rules})
  set(PC_NAME rastrum-${part})
  set(PC_REQUIRES rastrum)
  if(${part} STREQUAL "rastrum")
    set(PC_NAME rastrum)
    set(PC_REQUIRES "")
    list(TRANSFORM RASTRUM_CXX_LIBRARIES PREPEND " -l" OUTPUT_VARIABLE cxx_libraries)
    string(APPEND PC_LIBS ${cxx_libraries})
  endif()
  set(PC_DESCRIPTION "${description}")
  configure_file(cmake/rastrum.pc.in ${folder}/${PC_NAME}.pc @ONLY)
  install(FILES ${folder}/${PC_NAME}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig ${rules})
endmacro()

# rastrum_package(static|shared RULE…): the part that differs between the packages. Each install() gets RULE.
function(rastrum_package kind)
  set(rules ${ARGN})
  set(folder ${PROJECT_BINARY_DIR}/package/${kind})
  file(RELATIVE_PATH PC_UP /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  set(RASTRUM_NEEDS "")
  set(RASTRUM_CXX_LIBRARIES "")
  set(about_core "Software rendering: arrays in, arrays out")
  set(about_io "Rastrum's files")
  if(kind STREQUAL "static")
    # C++'s own libraries, which linkers do not add for C or Fortran programs.
    set(RASTRUM_CXX_LIBRARIES ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
    list(FILTER RASTRUM_CXX_LIBRARIES INCLUDE REGEX "^(stdc\\+\\+|c\\+\\+|c\\+\\+abi|m)$")
    rastrum_part(rastrum "${about_core}" rastrum rastrum_shaders ${device})
    rastrum_part(io "${about_io}" rastrum_io)
    rastrum_part(family "The published rasterizers beside Rastrum's own" rastrum_family)
  else()
    rastrum_part(rastrum "${about_core}" rastrum_shared rastrum_shaders ${device})
    rastrum_part(io "${about_io}" rastrum_shared_io)
  endif()
  if(TARGET rastrum_mpi)
    rastrum_part(mpi "Ranks of MPI, compiled by mpicxx" rastrum_mpi)
  endif()
  configure_package_config_file(cmake/RastrumConfig.cmake.in ${folder}/RastrumConfig.cmake
    INSTALL_DESTINATION ${package_dir})
  install(FILES ${folder}/RastrumConfig.cmake DESTINATION ${package_dir} ${rules})
endfunction()

# Programs that are installed here, or that link the package anywhere, look for the library of device code by
# its name (parallel/cuda/library.hpp).
set(device "")
if(TARGET rastrum_cuda)
  set(device rastrum_cuda)
  target_link_options(rastrum INTERFACE
    $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${CMAKE_INSTALL_LIBDIR}>)
endif()
if(BUILD_SHARED_LIBS)
  rastrum_package(shared)
else()
  rastrum_package(static)
  rastrum_package(shared COMPONENT shared EXCLUDE_FROM_ALL)  # tests put it in the place of the static one
endif()
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/RastrumConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/RastrumConfigVersion.cmake cmake/Findlibdeflate.cmake
  DESTINATION ${package_dir})

file(GLOB public_headers CONFIGURE_DEPENDS include/rastrum/*.hpp)
if(NOT BUILD_SHARED_LIBS)
  file(GLOB family_headers CONFIGURE_DEPENDS papers/include/rastrum/*.hpp)
endif()
install(FILES ${public_headers} ${family_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rastrum)
install(FILES include/rastrum.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET rastrum_mpi)
  install(FILES rastrum/mpi/include/rastrum/mpi/mpi_ranks.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rastrum/mpi)
endif()

install(DIRECTORY examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/rastrum/examples
  FILES_MATCHING PATTERN "*.cpp" PATTERN "*.c" PATTERN "*.f90" PATTERN CMakeLists.txt PATTERN inside EXCLUDE)
# Pages without pictures, and without those for the project's developers.
file(GLOB pages CONFIGURE_DEPENDS docs/*.md)
list(FILTER pages EXCLUDE REGEX "/architecture.md$")
install(FILES ${pages} CHANGELOG.md LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Licences of the font and the colour maps that the library contains.
install(FILES rastrum/overlay/font/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.DejaVu)
install(FILES rastrum/scene/color_maps/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.colour_maps)
if(TARGET rastrum_program)
  install(TARGETS rastrum_program)
endif()
if(TARGET rastrum_bench_program)
  install(TARGETS rastrum_bench_program OPTIONAL)  # `./dev run` builds the program alone
endif()
