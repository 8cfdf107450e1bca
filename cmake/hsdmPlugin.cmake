# hsdm_add_plugin(NAME SOURCE...): a processing module for hsdm, the target NAME, which becomes NAME.so. It links hsdm::hsdm,
# which find_package(hsdm) or add_subdirectory(hsdm) provides, and exports the function that HSDM_PLUGIN defines and nothing
# else: neither the library in it nor what the module is made of can be mistaken for the program's or another module's.
# Installing it and further libraries are up to the caller, as with any target.
function(hsdm_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE hsdm::hsdm)
  target_link_options(${name} PRIVATE LINKER:--version-script=${CMAKE_CURRENT_FUNCTION_LIST_DIR}/hsdmPlugin.map)
  set_target_properties(${name} PROPERTIES PREFIX "" SUFFIX .so DEBUG_POSTFIX "")
endfunction()
