# Components of `cmake --install`, each with the licence: runtime (the command), library (a shared libhsdm), development
# (headers, package files, a static libhsdm), modules, examples; and python (apps/python), by its name alone. In Debian
# packages also tools (hsdm_generate, hsdm_bench).

# hsdm_install(TARGET FOLDER COMPONENT): installs a program or a module into FOLDER of the prefix. A shared libhsdm is found
# from there by a relative path, so the prefix can be moved.
function(hsdm_install target folder component)
  if(NOT HSDM_INSTALL)
    return()
  endif()
  install(TARGETS ${target} RUNTIME DESTINATION ${folder} COMPONENT ${component} ${ARGN}
                            LIBRARY DESTINATION ${folder} COMPONENT ${component} ${ARGN})
  get_target_property(type hsdm TYPE)
  if(type STREQUAL "SHARED_LIBRARY")
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX})
    cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${folder} OUTPUT_VARIABLE to_library)
    set_property(TARGET ${target} APPEND PROPERTY INSTALL_RPATH "$ORIGIN/${to_library}")
  endif()
endfunction()

# hsdm_install_files(COMPONENT FOLDER FILE...): files as they are, relative to the caller's folder.
function(hsdm_install_files component folder)
  install(FILES ${ARGN} DESTINATION ${folder} COMPONENT ${component})
endfunction()

# hsdm_install_tool(TARGET DESCRIPTION): a program of the component tools, with a manual page that shows what its --help does.
function(hsdm_install_tool target description)
  hsdm_install(${target} ${CMAKE_INSTALL_BINDIR} tools)
  set(page ${CMAKE_CURRENT_BINARY_DIR}/${target}.1)
  add_custom_command(TARGET ${target} POST_BUILD VERBATIM
    COMMAND sh ${PROJECT_SOURCE_DIR}/cmake/help_page.sh $<TARGET_FILE:${target}> ${description} ${page})
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
endfunction()
