# Run by ctest: installs, checks what is there, and builds programs as users would, by CMake and by
# pkg-config: with the static libraries, as a subproject, and with the shared library, which has the same
# objects.
cmake_minimum_required(VERSION 3.25)

# --- Helpers -------------------------------------------------------------------------------------

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nended with ${code}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# configure(NAME SOURCE OPTION…): into WORK_DIR/NAME. Builds without optimization, because the programs run
# only briefly; what is linked has the release configuration.
function(configure name source)
  run(${CMAKE_COMMAND} -S ${source} -B ${WORK_DIR}/${name} -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_C_COMPILER=${C_COMPILER}
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O0 ${ARGN})
  set(output "${output}" PARENT_SCOPE)
endfunction()

# Checks which libraries a program links, beside those of the compiler.
function(expect_libraries program expected)
  run(readelf -d ${program})
  string(REGEX MATCHALL "lib[a-zA-Z0-9_+-]+\\.so" libraries "${output}")
  list(REMOVE_ITEM libraries libstdc++.so libm.so libgcc_s.so libpthread.so libc.so)
  if(NOT libraries STREQUAL expected)
    message(FATAL_ERROR "${program} links ${libraries}, not ${expected}:\n${output}")
  endif()
endfunction()

function(expect_digest)
  file(STRINGS ${SOURCE_DIR}/tests/c/draw.digest digest)
  if(NOT output STREQUAL "${digest}\n")
    message(FATAL_ERROR "the C example printed ${output}, not ${digest}")
  endif()
endfunction()

# pkg_config_program(PACKAGE COMPILER… SOURCE): compiles by pkg-config's flags and runs.
function(pkg_config_program package)
  run(${PKG_CONFIG} --cflags --libs ${package})
  string(STRIP "${output}" flags)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  if(flags MATCHES "-std=|-ffp")
    message(FATAL_ERROR "${package}.pc decides how its user compiles: ${flags}")
  endif()
  run(${ARGN} -o ${WORK_DIR}/${package} ${flags})
  run(${WORK_DIR}/${package})
  set(output "${output}" PARENT_SCOPE)
endfunction()

# --- What is installed ---------------------------------------------------------------------------

function(check_version)
  file(STRINGS ${SOURCE_DIR}/CITATION.cff cited REGEX "^version: ${VERSION}$")
  if(NOT cited)
    message(FATAL_ERROR "CITATION.cff says another version than version.hpp, ${VERSION}")
  endif()
  if(EXISTS ${BUILD_DIR}/apps/rastrum/rastrum)
    run(${prefix}/bin/rastrum --version)
    if(NOT output MATCHES "${VERSION}")
      message(FATAL_ERROR "the installed program says '${output}', not version ${VERSION}")
    endif()
  endif()
endfunction()

# Only the public headers are installed, and each compiles alone there, with warnings as errors. Headers that
# a source of the library includes first are left out, since the build has tested them.
function(check_headers)
  set(public ../rastrum.h)
  foreach(folder include/rastrum papers/include/rastrum)
    file(GLOB headers RELATIVE ${SOURCE_DIR}/${folder} ${SOURCE_DIR}/${folder}/*.hpp)
    list(APPEND public ${headers})
  endforeach()
  file(GLOB_RECURSE installed RELATIVE ${prefix}/include/rastrum ${prefix}/include/*)
  list(REMOVE_ITEM installed mpi/mpi_ranks.hpp)  # installed only if there is an MPI
  list(SORT public)
  list(SORT installed)
  if(NOT public STREQUAL installed)
    message(FATAL_ERROR "the public headers are\n  ${public}\nand there are installed\n  ${installed}")
  endif()

  file(GLOB_RECURSE sources ${SOURCE_DIR}/rastrum/*.cpp ${SOURCE_DIR}/papers/*.cpp)
  set(shown)
  foreach(source IN LISTS sources)
    file(STRINGS ${source} first REGEX "^#include" LIMIT_COUNT 1)
    list(APPEND shown "${first}")
  endforeach()
  list(REMOVE_ITEM installed ../rastrum.h)
  foreach(header IN LISTS installed)
    if(NOT "#include <rastrum/${header}>" IN_LIST shown)
      set(source ${WORK_DIR}/headers/${header}.cpp)
      file(WRITE ${source} "#include <rastrum/${header}>\n#include <rastrum/${header}>\n")
      run(${CXX_COMPILER} -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Werror -I${prefix}/include ${source})
    endif()
  endforeach()

  # The C header, in both languages.
  set(source ${WORK_DIR}/headers/rastrum.h.c)
  file(WRITE ${source} "#include <rastrum.h>\n#include <rastrum.h>\n")
  set(strict -fsyntax-only -pedantic -Wall -Wextra -Werror -I${prefix}/include)
  run(${C_COMPILER} -std=c99 -Wstrict-prototypes ${strict} ${source})
  run(${CXX_COMPILER} -std=c++98 ${strict} -x c++ ${source})
endfunction()

function(check_pages)
  foreach(page changes.md conventions.md c.md LICENSE)
    file(GLOB_RECURSE found ${prefix}/share/doc/*/${page})
    if(NOT found)
      message(FATAL_ERROR "${page} is not installed")
    endif()
  endforeach()
endfunction()

# --- Programs of users ---------------------------------------------------------------------------

# Builds two examples, and the MPI one if there is MPI. The project has built all, and they include only
# public headers (check_includes.py).
function(check_examples)
  configure(examples ${prefix}/share/rastrum/examples)
  file(STRINGS ${WORK_DIR}/examples/CMakeCache.txt found REGEX "^Rastrum_DIR:")
  if(NOT found MATCHES "${prefix}")
    message(FATAL_ERROR "the examples were built against another Rastrum: ${found}")
  endif()
  set(targets example_fit_camera example_render_file)
  if(EXISTS ${prefix}/include/rastrum/mpi)
    list(APPEND targets example_wave)
  endif()
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/examples --target ${targets})
  run(${WORK_DIR}/examples/fit_camera)
  if(NOT output MATCHES "eye 0 0 3.4641")
    message(FATAL_ERROR "fit_camera printed:\n${output}")
  endif()
endfunction()

# Builds a program for each of `components`. One that only renders links only `library`.
function(check_components kind library components)
  configure(${kind} ${HERE}/user)
  if(kind STREQUAL "shared" AND NOT output MATCHES "no component family: the published rasterizers need the static")
    message(FATAL_ERROR "it is not said that the shared library has no family:\n${output}")
  endif()
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/${kind})
  foreach(component IN LISTS components)
    run(${WORK_DIR}/${kind}/${component})
  endforeach()
  expect_libraries(${WORK_DIR}/${kind}/core "${library}")
endfunction()

# A project with only C.
function(check_c)
  configure(c ${HERE}/c -DDRAW_C=${draw_c})
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/c --clean-first)
  run(${WORK_DIR}/c/draw)
  expect_digest()
endfunction()

function(check_subproject)
  set(hidden "")
  foreach(package TBB PNG JPEG ZLIB libdeflate nlohmann_json OpenEXR GTest)
    list(APPEND hidden -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
  endforeach()
  configure(parent ${HERE}/parent -DRASTRUM_SOURCE=${SOURCE_DIR} -DCMAKE_BUILD_TYPE= ${hidden})
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/parent)  # nothing is built that is not linked
endfunction()

# Without CMake. A C linker gets C++'s libraries from the package.
function(check_pkg_config components)
  if(NOT PKG_CONFIG)
    message(STATUS "skipped: no pkg-config (Debian: pkg-config)")
    return()
  endif()
  file(GLOB_RECURSE pc ${prefix}/*/rastrum.pc)
  cmake_path(GET pc PARENT_PATH pc_dir)
  set(ENV{PKG_CONFIG_PATH} ${pc_dir})
  set(ENV{LD_LIBRARY_PATH} ${pc_dir}/..)
  foreach(component IN LISTS components)
    string(REPLACE rastrum-core rastrum package rastrum-${component})
    run(${PKG_CONFIG} --modversion ${package})
    if(NOT output MATCHES "${VERSION}")
      message(FATAL_ERROR "${package}.pc says version ${output}")
    endif()
    pkg_config_program(${package} ${CXX_COMPILER} -std=c++23 ${HERE}/user/${component}.cpp)
  endforeach()
  if(CLANG)
    pkg_config_program(rastrum ${CLANG} -std=c++20 -Wall -Wextra -Werror ${HERE}/user/core.cpp)
  else()
    message(STATUS "skipped: no clang++-14 (Debian: clang-14)")
  endif()
  pkg_config_program(rastrum ${C_COMPILER} ${draw_c})
  expect_digest()
endfunction()

# --- The shared library --------------------------------------------------------------------------

# Installs this build's librastrum.so and its package in place of the static ones. A build with
# BUILD_SHARED_LIBS has only these rules, so it is configured and not built.
function(install_shared)
  configure(only_shared ${SOURCE_DIR} -DBUILD_SHARED_LIBS=ON -DRASTRUM_BUILD_APPS=OFF -DRASTRUM_BUILD_TESTS=OFF
    -DRASTRUM_BUILD_EXAMPLES=OFF -DRASTRUM_BUILD_BENCH=OFF)
  file(GLOB_RECURSE static ${prefix}/*.a ${prefix}/*.pc ${prefix}/*/RastrumConfig.cmake ${prefix}/*/Rastrum_static*)
  file(REMOVE ${static})
  run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component shared)
endfunction()

# The library exports only what public headers declare, and everything that the examples' objects need.
function(check_symbols)
  file(GLOB library ${prefix}/*/librastrum.so)
  run(${PYTHON} ${HERE}/shown_symbols.py ${library} ${SOURCE_DIR})
  file(GLOB objects ${BUILD_DIR}/examples/CMakeFiles/example_*.dir/*.o ${BUILD_DIR}/examples/CMakeFiles/example_*.dir/c/*.o)
  list(FILTER objects EXCLUDE REGEX "family_row")  # needs Rastrum::family, which is only static
  foreach(object IN LISTS objects)
    run(${CXX_COMPILER} ${object} ${library} -o ${WORK_DIR}/linked)
  endforeach()
endfunction()

# --- All of it -----------------------------------------------------------------------------------

file(REMOVE_RECURSE ${WORK_DIR})
set(HERE ${CMAKE_CURRENT_LIST_DIR})
set(prefix ${WORK_DIR}/prefix)
set(draw_c ${prefix}/share/rastrum/examples/c/draw.c)
find_program(C_COMPILER NAMES cc gcc clang REQUIRED)
find_program(CLANG clang++-14)
find_program(PKG_CONFIG pkg-config)
find_program(PYTHON python3 REQUIRED)

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
check_version()
check_headers()
check_pages()
check_examples()
check_subproject()
check_components(static "${THREADS}" "core;io;family")
check_pkg_config("core;io;family")
check_c()

install_shared()
check_symbols()
check_components(shared librastrum.so "core;io")
check_pkg_config("core;io")
check_c()
