# rastrum_unity(TARGETS...): compiles their sources ten at a time if RASTRUM_UNITY is on. A build from nothing
# takes half as long, because headers are parsed once for ten sources; a rebuild after an edit is faster
# without it. Sources that include themselves once per instruction set stay alone, and so do those that include
# windows.h, which has macros such as `near`.
function(rastrum_unity)
  if(RASTRUM_UNITY)
    set_target_properties(${ARGN} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 10)
    foreach(target ${ARGN})
      get_target_property(sources ${target} SOURCES)
      list(FILTER sources INCLUDE REGEX "_(simd|windows)\\.cpp$")
      if(sources)
        set_source_files_properties(${sources} TARGET_DIRECTORY ${target} PROPERTIES
          SKIP_UNITY_BUILD_INCLUSION ON)
      endif()
    endforeach()
  endif()
endfunction()
