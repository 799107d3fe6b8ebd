# CUDA, where it was asked for: RASTRUM_CUDA_FOUND says so. Nothing of the CPU build needs it; the
# translation units under tests/cuda keep the shared code compilable for the device.
set(RASTRUM_CUDA_FOUND OFF)
if(RASTRUM_CUDA)
  include(CheckLanguage)
  check_language(CUDA)
  if(NOT CMAKE_CUDA_COMPILER)
    message(FATAL_ERROR "RASTRUM_CUDA is ON, and no CUDA compiler was found: put nvcc on the PATH, "
      "or set CMAKE_CUDA_COMPILER")
  endif()
  # Machine code of the A100 and the H100, and PTX for what comes after them.
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES 80-real 90)
  endif()
  enable_language(CUDA)
  # CMake 3.25.1 does not know yet that nvcc has C++20.
  if(NOT DEFINED CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
    set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
  endif()
  set(cuda_flags --fmad=false --expt-relaxed-constexpr -Xcompiler=-ffp-contract=off
    -Werror=all-warnings)
  target_compile_options(rastrum_flags INTERFACE "$<$<COMPILE_LANGUAGE:CUDA>:${cuda_flags}>")
  set(RASTRUM_CUDA_FOUND ON)
endif()

# Thrust's headers also serve a plain C++ compiler: tests run the device's code on the CPU, with any
# compiler and its sanitizers, wherever a toolkit lies.
find_package(CUDAToolkit QUIET)
find_path(RASTRUM_CCCL_INCLUDE_DIR cuda/std/version
  HINTS ${CUDAToolkit_INCLUDE_DIRS} /usr/local/cuda/include PATH_SUFFIXES cccl
  DOC "The folder of thrust/, cub/ and cuda/")

# The library of device code (rastrum/cuda): its sources, which tests compile for the CPU too.
set(RASTRUM_DEVICE_SOURCES
  rastrum/cuda/library.cpp
  papers/table/family.cu
  papers/table/visibilities.cu
  papers/paper3/words.cu
  rastrum/render/cuda/layers.cu
  rastrum/render/cuda/rasterizer.cu
  rastrum/terrain/cuda/renderer.cu
  rastrum/terrain/cuda/shadows.cu)
list(TRANSFORM RASTRUM_DEVICE_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/)

# It and the program must be of one build: what passes between them are classes. So their version
# changes with the headers, as they are when this is configured.
file(GLOB_RECURSE headers LIST_DIRECTORIES NO
  ${PROJECT_SOURCE_DIR}/include/*.hpp ${PROJECT_SOURCE_DIR}/papers/*.hpp ${PROJECT_SOURCE_DIR}/papers/*.inl
  ${PROJECT_SOURCE_DIR}/rastrum/*.hpp ${PROJECT_SOURCE_DIR}/rastrum/*.inl)
set(digests "")
foreach(header IN LISTS headers)
  file(SHA256 ${header} digest)
  string(APPEND digests ${digest})
endforeach()
string(SHA256 digest "${digests}")
string(SUBSTRING ${digest} 0 12 digest)
set(RASTRUM_CUDA_LIBRARY_VERSION ${PROJECT_VERSION}-${digest})

# rastrum_device_version(TARGET): its library.cpp alone knows the version, which changes with every
# header: no kernel is to be compiled again for that.
function(rastrum_device_version target)
  set_source_files_properties(${PROJECT_SOURCE_DIR}/rastrum/cuda/library.cpp TARGET_DIRECTORY ${target}
    PROPERTIES COMPILE_DEFINITIONS "RASTRUM_CUDA_LIBRARY_VERSION=\"${RASTRUM_CUDA_LIBRARY_VERSION}\"")
endfunction()

# rastrum_device_module(TARGET): a module that programs open by the name of parallel/cuda/library.hpp.
function(rastrum_device_module target)
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME rastrum_cuda PREFIX lib CUDA_VISIBILITY_PRESET hidden)
  target_link_options(${target} PRIVATE LINKER:--version-script=${PROJECT_SOURCE_DIR}/cmake/module.map)
  rastrum_device_version(${target})
endfunction()

# Programs find the module where it is built, and where it is installed (RastrumInstall.cmake).
if(RASTRUM_CUDA_FOUND)
  include(GNUInstallDirs)
  list(APPEND CMAKE_BUILD_RPATH ${PROJECT_BINARY_DIR}/rastrum/cuda)
  list(APPEND CMAKE_INSTALL_RPATH $ORIGIN/../${CMAKE_INSTALL_LIBDIR})
endif()
