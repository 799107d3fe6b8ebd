# Flags that every target of the project shares. The arithmetic flags are part of the picture rules: they
# forbid fused multiply-add, so that every machine gives the same bits.
add_library(rastrum_flags INTERFACE)

set(cxx_flags -ffp-contract=off -fno-math-errno
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wnon-virtual-dtor)
# Highway's functions for NEON may use AES, and g++ 12 inlines them only where their callers may, too. It uses none by itself.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64"
   AND NOT CMAKE_CXX_FLAGS MATCHES "-m(arch|cpu)=")
  list(APPEND cxx_flags -march=armv8-a+crypto)
endif()
if(RASTRUM_WERROR)
  list(APPEND cxx_flags -Werror)
endif()
target_compile_options(rastrum_flags INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:${cxx_flags}>")
# The project's own code includes its sources; users have only include/.
target_include_directories(rastrum_flags INTERFACE ${PROJECT_SOURCE_DIR})

if(RASTRUM_SANITIZE)
  set(sanitizer_flags
    -fsanitize=${RASTRUM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(RASTRUM_SANITIZE MATCHES "address,undefined")
    # The address sanitizer finds the same errors when memory is read or written. These checks are half of the
    # code.
    list(APPEND sanitizer_flags -fno-sanitize=null,object-size,vptr,pointer-overflow)
  endif()
  target_compile_options(rastrum_flags INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:${sanitizer_flags}>")
  target_link_options(rastrum_flags INTERFACE -fsanitize=${RASTRUM_SANITIZE})
  # Three instruction sets would cost a third of the compile time (simd_targets.hpp).
  target_compile_definitions(rastrum_flags INTERFACE RASTRUM_ONE_SIMD_TARGET)
endif()

# Only ELF has it. clang warns of it elsewhere.
if(CMAKE_EXECUTABLE_FORMAT STREQUAL "ELF")
  set(no_interposition -fno-semantic-interposition)
endif()

# rastrum_library(TARGET NAME): one of the installed libraries, Rastrum::NAME. Device and Python modules
# contain a copy of it, so its code is position-independent and compiled only once. Functions cannot be
# replaced at run time, so the compiler may inline them. A section for each function lets linkers drop unused
# ones (--gc-sections). Highway's headers are enough: only their assertions in debug builds need its library.
function(rastrum_library target name)
  add_library(Rastrum::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE
    "$<$<COMPILE_LANGUAGE:CXX>:${no_interposition};-ffunction-sections;-fdata-sections>")
  target_include_directories(${target} SYSTEM PRIVATE $<TARGET_PROPERTY:hwy::hwy,INTERFACE_INCLUDE_DIRECTORIES>)
  target_compile_definitions(${target} PRIVATE HWY_IS_DEBUG_BUILD=0)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:rastrum_flags>)
endfunction()
