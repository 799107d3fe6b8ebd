# Finds the window's libraries as target Rastrum::Window: SDL2, and Dear ImGui as Debian builds it, with its
# SDL2 platform backend inside.
find_package(SDL2 QUIET CONFIG)
find_path(IMGUI_INCLUDE_DIR imgui.h PATH_SUFFIXES imgui)
find_library(IMGUI_LIBRARY imgui)
find_library(STB_LIBRARY stb)
mark_as_advanced(IMGUI_INCLUDE_DIR IMGUI_LIBRARY STB_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(RastrumWindow
  REQUIRED_VARS SDL2_LIBRARIES IMGUI_LIBRARY IMGUI_INCLUDE_DIR)

if(RastrumWindow_FOUND AND NOT TARGET Rastrum::Window)
  add_library(Rastrum::Window INTERFACE IMPORTED GLOBAL)
  target_include_directories(Rastrum::Window INTERFACE ${IMGUI_INCLUDE_DIR} ${SDL2_INCLUDE_DIRS})
  target_link_libraries(Rastrum::Window INTERFACE
    ${IMGUI_LIBRARY} $<$<BOOL:${STB_LIBRARY}>:${STB_LIBRARY}> ${SDL2_LIBRARIES})
endif()
