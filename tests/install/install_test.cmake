# Run by ctest: install, look at what is there, build examples/ against it, run one of them.
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

# Copied away from the source tree, so that no header can be found beside them.
file(COPY ${SOURCE_DIR}/examples DESTINATION ${WORK_DIR}/source)
run(${CMAKE_COMMAND} -S ${WORK_DIR}/source/examples -B ${examples} -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${examples})

file(STRINGS ${examples}/CMakeCache.txt found REGEX "^Rastrum_DIR:")
if(NOT found MATCHES "${prefix}")
  message(FATAL_ERROR "the examples were built against another Rastrum: ${found}")
endif()

run(${examples}/fit_camera)
if(NOT output MATCHES "eye 0 0 3.4641")
  message(FATAL_ERROR "fit_camera printed:\n${output}")
endif()

# What only renders links oneTBB, and nothing else that does not come with the compiler.
set(renders ${WORK_DIR}/source/renders)
file(WRITE ${renders}/renders.cpp [[
#include <cstdio>
#include <vector>

#include <rastrum/render/render.hpp>

int main() {
  const std::vector<rastrum::Vec3> positions{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  rastrum::InstanceView instance;
  instance.mesh.positions = positions;
  rastrum::SceneView scene;
  scene.instances = {&instance, 1};
  rastrum::RenderOptions options;
  options.width = options.height = 64;
  const auto image = rastrum::render(scene, rastrum::fit_camera(scene, 1.0F, false), options);
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
if(TARGET Rastrum::io OR TARGET PNG::PNG OR TARGET hwy::hwy)
  message(FATAL_ERROR "find_package(Rastrum) finds more than was asked for")
endif()
add_executable(renders renders.cpp)
target_link_libraries(renders PRIVATE Rastrum::rastrum)
]])
run(${CMAKE_COMMAND} -S ${renders} -B ${WORK_DIR}/renders -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/renders)
run(${WORK_DIR}/renders/renders)
run(ldd ${WORK_DIR}/renders/renders)
string(REGEX MATCHALL "lib[a-zA-Z0-9_+-]+\\.so" libraries "${output}")
list(REMOVE_ITEM libraries libtbb.so libstdc++.so libm.so libgcc_s.so libc.so libpthread.so libdl.so
  librt.so)
if(libraries)
  message(FATAL_ERROR "a program that only renders links ${libraries}:\n${output}")
endif()
