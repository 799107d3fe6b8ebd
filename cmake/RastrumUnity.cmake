# rastrum_unity(TARGETS...): compiles their sources ten at a time where RASTRUM_UNITY asks for it. A
# build from nothing takes half as long, since headers are parsed once for all ten. Rebuilding after
# an edit is faster without it.
function(rastrum_unity)
  if(RASTRUM_UNITY)
    set_target_properties(${ARGN} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 10)
  endif()
endfunction()
