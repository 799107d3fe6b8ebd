# rastrum_unity(TARGETS...): compiles their sources ten at a time where RASTRUM_UNITY asks for it. From
# nothing that takes half as long: what they all include is parsed once. Who edits a source, and has
# its objects, is faster without.
function(rastrum_unity)
  if(RASTRUM_UNITY)
    set_target_properties(${ARGN} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 10)
  endif()
endfunction()
