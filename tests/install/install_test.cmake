# Run by ctest: install, look at what is there, build installed examples against it, run one of
# them; then programs of one library and of several, by CMake and by pkg-config.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK_DIR})
set(prefix ${WORK_DIR}/prefix)
set(examples ${WORK_DIR}/examples)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nended with ${code}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
if(EXISTS ${BUILD_DIR}/apps/rastrum/rastrum)
  run(${prefix}/bin/rastrum --version)
  if(NOT output MATCHES "${VERSION}")
    message(FATAL_ERROR "the installed program says '${output}', not version ${VERSION}")
  endif()
endif()
file(STRINGS ${SOURCE_DIR}/CITATION.cff cited REGEX "^version: ${VERSION}$")
if(NOT cited)
  message(FATAL_ERROR "CITATION.cff says another version than version.hpp, ${VERSION}")
endif()

# Only the public headers are installed, and each can be included by itself from there, with warnings
# as errors. A header that a source of the library includes first is not tried: the build has shown it.
file(GLOB_RECURSE sources ${SOURCE_DIR}/rastrum/*.cpp ${SOURCE_DIR}/papers/*.cpp)
set(shown)
foreach(source IN LISTS sources)
  file(STRINGS ${source} first REGEX "^#include" LIMIT_COUNT 1)
  list(APPEND shown "${first}")
endforeach()
set(public)
foreach(folder include/rastrum papers/include/rastrum)
  file(GLOB headers RELATIVE ${SOURCE_DIR}/${folder} ${SOURCE_DIR}/${folder}/*.hpp)
  list(APPEND public ${headers})
endforeach()
file(GLOB_RECURSE installed RELATIVE ${prefix}/include/rastrum ${prefix}/include/*)
if(NOT "../rastrum.h" IN_LIST installed)
  message(FATAL_ERROR "the header of C is not installed")
endif()
list(REMOVE_ITEM installed ../rastrum.h)
list(SORT public)
list(SORT installed)
if(NOT public STREQUAL installed)
  message(FATAL_ERROR "the public headers are\n  ${public}\nand there are installed\n  ${installed}")
endif()
foreach(header IN LISTS installed)
  if("#include <rastrum/${header}>" IN_LIST shown)
    continue()
  endif()
  set(source ${WORK_DIR}/headers/${header}.cpp)
  file(WRITE ${source} "#include <rastrum/${header}>\n#include <rastrum/${header}>\n")
  run(${CXX_COMPILER} -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Werror
    -I${prefix}/include ${source})
endforeach()

# The header of C, in both languages.
find_program(C_COMPILER NAMES cc gcc clang REQUIRED)
set(source ${WORK_DIR}/headers/rastrum.h.c)
file(WRITE ${source} "#include <rastrum.h>\n#include <rastrum.h>\n")
run(${C_COMPILER} -std=c99 -fsyntax-only -pedantic -Wall -Wextra -Wstrict-prototypes -Werror -I${prefix}/include ${source})
run(${CXX_COMPILER} -std=c++98 -fsyntax-only -pedantic -Wall -Wextra -Werror -I${prefix}/include -x c++ ${source})

# The release build of what is linked, and nothing of what is built here runs for long.
set(build -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O0)
run(${CMAKE_COMMAND} -S ${prefix}/share/rastrum/examples -B ${examples} -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} ${build})
# Two of them: the project has built all, and they include public headers alone (check_includes.py).
run(${CMAKE_COMMAND} --build ${examples} --target example_fit_camera example_render_file)

file(STRINGS ${examples}/CMakeCache.txt found REGEX "^Rastrum_DIR:")
if(NOT found MATCHES "${prefix}")
  message(FATAL_ERROR "the examples were built against another Rastrum: ${found}")
endif()

run(${examples}/fit_camera)
if(NOT output MATCHES "eye 0 0 3.4641")
  message(FATAL_ERROR "fit_camera printed:\n${output}")
endif()

# A program that only renders links oneTBB, and nothing else that does not come with the compiler.
set(renders ${WORK_DIR}/source/renders)
file(WRITE ${renders}/renders.cpp [[
#include <cstdio>
#include <vector>

#include <rastrum/render.hpp>

int main() {
  const std::vector<rastrum::Vec3> positions{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  rastrum::MeshView mesh;
  mesh.positions = positions;
  const rastrum::InstanceView instance{mesh};
  rastrum::SceneView scene;
  scene.instances = {&instance, 1};
  const auto image = rastrum::render(scene, rastrum::fit_camera(scene, 1.0F, false),
                                     {.width = 64, .height = 64});
  int covered = 0;
  for (const rastrum::Rgba8 p : image.pixels()) covered += p.a != 0;
  std::printf("%d of %zu pixels\n", covered, image.pixels().size());
  return covered > 100 ? 0 : 1;
}
]])
file(WRITE ${renders}/CMakeLists.txt [[
cmake_minimum_required(VERSION 3.25)
project(Renders LANGUAGES CXX)
find_package(Rastrum REQUIRED)
if(TARGET Rastrum::io OR TARGET Rastrum::family OR TARGET PNG::PNG OR TARGET hwy::hwy)
  message(FATAL_ERROR "find_package(Rastrum) finds more than was asked for")
endif()
add_executable(renders renders.cpp)
target_link_libraries(renders PRIVATE Rastrum::rastrum)
]])
run(${CMAKE_COMMAND} -S ${renders} -B ${WORK_DIR}/renders -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} ${build})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/renders)
run(${WORK_DIR}/renders/renders)
run(ldd ${WORK_DIR}/renders/renders)
string(REGEX MATCHALL "lib[a-zA-Z0-9_+-]+\\.so" libraries "${output}")
list(REMOVE_ITEM libraries libtbb.so libstdc++.so libm.so libgcc_s.so libc.so libpthread.so libdl.so
  librt.so)
if(libraries)
  message(FATAL_ERROR "a program that only renders links ${libraries}:\n${output}")
endif()

# As a subproject: the core alone, without the libraries of files, and nothing of the parent is changed.
set(parent ${WORK_DIR}/source/parent)
file(WRITE ${parent}/parent.cpp "int main() {}")
file(WRITE ${parent}/CMakeLists.txt [[
cmake_minimum_required(VERSION 3.25)
project(Parent LANGUAGES CXX)
set(before "${CMAKE_BUILD_TYPE};${CMAKE_CXX_FLAGS};${CMAKE_CXX_STANDARD};${CMAKE_MODULE_PATH}")
add_subdirectory(${RASTRUM_SOURCE} rastrum EXCLUDE_FROM_ALL)
set(after "${CMAKE_BUILD_TYPE};${CMAKE_CXX_FLAGS};${CMAKE_CXX_STANDARD};${CMAKE_MODULE_PATH}")
if(NOT before STREQUAL after OR NOT "$CACHE{CMAKE_BUILD_TYPE}" STREQUAL "")
  message(FATAL_ERROR "the parent had ${before}, and now has ${after}, $CACHE{CMAKE_BUILD_TYPE}")
endif()
if(TARGET Rastrum::io OR TARGET Rastrum::family OR TARGET PNG::PNG OR NOT TARGET Rastrum::rastrum)
  message(FATAL_ERROR "a subproject is the core alone")
endif()
add_executable(parent parent.cpp)
]])
set(hidden "")
foreach(package PNG JPEG ZLIB libdeflate nlohmann_json OpenEXR GTest)
  list(APPEND hidden -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
run(${CMAKE_COMMAND} -S ${parent} -B ${WORK_DIR}/parent -G ${GENERATOR} -DRASTRUM_SOURCE=${SOURCE_DIR}
  -DCMAKE_BUILD_TYPE= -DCMAKE_CXX_COMPILER=${CXX_COMPILER} ${hidden})
# Nothing of it is built that nobody links.
run(${CMAKE_COMMAND} --build ${WORK_DIR}/parent)

# The other components, each found and linked by itself.
set(parts ${WORK_DIR}/source/parts)
file(WRITE ${parts}/family.cpp [[
#include <cstdio>

#include <rastrum/family.hpp>

int main() {
  rastrum::Renderer renderer = rastrum::family::make_renderer({}, {.rasterizer = "binned"});
  rastrum::Image<rastrum::Rgba8> image(8, 8);
  const rastrum::FrameStats stats =
      renderer.render({}, {}, {.width = 8, .height = 8}, {.color8 = image});
  std::puts(stats.rasterizer.c_str());
  return stats.rasterizer == "binned" ? 0 : 1;
}
]])
file(WRITE ${parts}/io.cpp [[
#include <rastrum/io.hpp>

int main() {
  return rastrum::io::scene_formats().size() > 4 ? 0 : 1;
}
]])
file(WRITE ${parts}/CMakeLists.txt [[
cmake_minimum_required(VERSION 3.25)
project(Parts LANGUAGES CXX)
find_package(Rastrum REQUIRED COMPONENTS family)
if(TARGET Rastrum::io OR TARGET PNG::PNG)
  message(FATAL_ERROR "the component family finds more than was asked for")
endif()
add_executable(family family.cpp)
target_link_libraries(family PRIVATE Rastrum::family)
find_package(Rastrum REQUIRED COMPONENTS io)
add_executable(io io.cpp)
target_link_libraries(io PRIVATE Rastrum::io)
]])
run(${CMAKE_COMMAND} -S ${parts} -B ${WORK_DIR}/parts -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} ${build})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/parts)
run(${WORK_DIR}/parts/family)
run(${WORK_DIR}/parts/io)

# A project of C alone.
set(draw_c ${prefix}/share/rastrum/examples/c)
file(WRITE ${WORK_DIR}/source/c/CMakeLists.txt [[
cmake_minimum_required(VERSION 3.25)
project(OfC LANGUAGES C)
find_package(Rastrum REQUIRED)
add_executable(draw ${DRAW_C}/draw.c)
target_compile_options(draw PRIVATE -std=c99 -pedantic -Wall -Wextra -Werror)
target_link_libraries(draw PRIVATE Rastrum::rastrum)
]])
run(${CMAKE_COMMAND} -S ${WORK_DIR}/source/c -B ${WORK_DIR}/c -G ${GENERATOR} -DDRAW_C=${draw_c}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_C_COMPILER=${C_COMPILER})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/c)
run(${WORK_DIR}/c/draw)
set(drawn "${output}")
file(STRINGS ${SOURCE_DIR}/tests/c/draw.digest digest)
if(NOT drawn STREQUAL "${digest}\n")
  message(FATAL_ERROR "the C example printed ${drawn}, not ${digest}")
endif()

# Without CMake.
find_program(PKG_CONFIG pkg-config)
if(NOT PKG_CONFIG)
  message(STATUS "pkg-config is not there: rastrum.pc was not tried")
  return()
endif()
file(GLOB_RECURSE pc ${prefix}/*/rastrum.pc)
cmake_path(GET pc PARENT_PATH pc_dir)
set(ENV{PKG_CONFIG_PATH} ${pc_dir})
foreach(program rastrum:${renders}/renders.cpp rastrum-family:${parts}/family.cpp
        rastrum-io:${parts}/io.cpp)
  string(REGEX MATCH "^([^:]+):(.*)$" match ${program})
  set(package ${CMAKE_MATCH_1})
  set(source ${CMAKE_MATCH_2})
  run(${PKG_CONFIG} --modversion ${package})
  if(NOT output MATCHES "${VERSION}")
    message(FATAL_ERROR "${package}.pc says version ${output}")
  endif()
  run(${PKG_CONFIG} --cflags --libs ${package})
  string(STRIP "${output}" flags)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  if(flags MATCHES "-std=|-ffp")
    message(FATAL_ERROR "${package}.pc decides how its user compiles: ${flags}")
  endif()
  run(${CXX_COMPILER} -std=c++23 ${source} -o ${WORK_DIR}/${package} ${flags})
  run(${WORK_DIR}/${package})
endforeach()

# By the linker that is called for C, which has C++'s libraries from the package.
run(${PKG_CONFIG} --cflags --libs rastrum)
string(STRIP "${output}" flags)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(${C_COMPILER} ${draw_c}/draw.c -o ${WORK_DIR}/draw_c ${flags})
run(${WORK_DIR}/draw_c)
if(NOT output STREQUAL drawn)
  message(FATAL_ERROR "by pkg-config the C example printed ${output}, not ${drawn}")
endif()
