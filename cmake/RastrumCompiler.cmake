# Flags that every target of the project shares. The arithmetic ones are part of the picture rules:
# multiply and add stay apart, so that every machine gives the same bits.
add_library(rastrum_flags INTERFACE)

set(cxx_flags -ffp-contract=off -fno-math-errno
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wnon-virtual-dtor)
if(RASTRUM_WERROR)
  list(APPEND cxx_flags -Werror)
endif()
target_compile_options(rastrum_flags INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:${cxx_flags}>")
# The project's own code sees the sources; its users see include/ alone.
target_include_directories(rastrum_flags INTERFACE ${PROJECT_SOURCE_DIR})

if(RASTRUM_SANITIZE)
  set(sanitizer_flags
    -fsanitize=${RASTRUM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(RASTRUM_SANITIZE MATCHES "address,undefined")
    # The address sanitizer sees what these would, where it is read or written; they are half of the code.
    list(APPEND sanitizer_flags -fno-sanitize=null,object-size,vptr,pointer-overflow)
  endif()
  target_compile_options(rastrum_flags INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:${sanitizer_flags}>")
  target_link_options(rastrum_flags INTERFACE -fsanitize=${RASTRUM_SANITIZE})
  # Kernels of three instruction sets are a third of what compiling costs (simd_targets.hpp).
  target_compile_definitions(rastrum_flags INTERFACE RASTRUM_ONE_SIMD_TARGET)
endif()

# rastrum_library(TARGET NAME): one of the installed libraries, Rastrum::NAME. Modules (of devices, of Python) have a
# copy of it in them, so that all is compiled once for programs and for them. Nobody replaces its functions at
# run time: the compiler may go on inlining them. A section for each function lets linkers leave out what a program does
# not call (--gc-sections). Of Highway the headers are enough: only their assertions in debug builds need its library.
function(rastrum_library target name)
  add_library(Rastrum::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE
    "$<$<COMPILE_LANGUAGE:CXX>:-fno-semantic-interposition;-ffunction-sections;-fdata-sections>")
  target_include_directories(${target} SYSTEM PRIVATE $<TARGET_PROPERTY:hwy::hwy,INTERFACE_INCLUDE_DIRECTORIES>)
  target_compile_definitions(${target} PRIVATE HWY_IS_DEBUG_BUILD=0)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:rastrum_flags>)
endfunction()
