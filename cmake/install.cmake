# hsdm_install(TARGET FOLDER): installs a program or a module into FOLDER of the prefix. A shared libhsdm is found from there
# by a relative path, so the prefix can be moved.
function(hsdm_install target folder)
  if(NOT HSDM_INSTALL)
    return()
  endif()
  install(TARGETS ${target} RUNTIME DESTINATION ${folder} LIBRARY DESTINATION ${folder})
  get_target_property(type hsdm TYPE)
  if(type STREQUAL "SHARED_LIBRARY")
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX})
    cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${folder} OUTPUT_VARIABLE to_library)
    set_property(TARGET ${target} APPEND PROPERTY INSTALL_RPATH "$ORIGIN/${to_library}")
  endif()
endfunction()
