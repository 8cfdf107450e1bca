# Debian packages of the components, which `sh cmake/packages.sh` makes: hsdm (runtime, modules), libhsdm0.1 (library),
# libhsdm-dev (development, examples), hsdm-tools (tools) and, with HSDM_BUILD_PYTHON, python3-hsdm (python).
if(NOT BUILD_SHARED_LIBS)
  message(FATAL_ERROR "HSDM_DEBIAN makes a package of the shared library: use it with -DBUILD_SHARED_LIBS=ON")
endif()
find_program(GZIP gzip REQUIRED)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hsdm)
set(CPACK_PACKAGE_VENDOR "the hsdm developers")
set(CPACK_PACKAGE_CONTACT "the hsdm developers <developers@hsdm.invalid>") # Debian asks for an address; it is nobody's
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_NAME} built using CMake") # CPack's default, which it leaves out
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/libhsdm)

set(full_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(soname_package libhsdm${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(about "hsdm reconstructs the surfaces of scanned parts from point clouds:
quad-dominant meshes, a 2-manifold every time, with sharp edges marked.")

# The page of man(1), the files of the package's folder under share/doc, and the licence as Debian wants it.
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC) # SOURCE_DATE_EPOCH, where that is set
set(debian ${PROJECT_BINARY_DIR}/debian)
configure_file(cmake/debian/changelog.in ${debian}/changelog.Debian @ONLY)
file(READ LICENSE licence)
string(STRIP "${licence}" licence)
string(REPLACE "\n\n" "\n.\n" licence "${licence}")
string(REPLACE "\n" "\n " licence " ${licence}")
configure_file(cmake/debian/copyright.in ${debian}/copyright @ONLY)
configure_file(CHANGELOG.md ${debian}/changelog COPYONLY)
foreach(file changelog changelog.Debian)
  execute_process(COMMAND ${GZIP} -9nf ${debian}/${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# hsdm_debian_package(GROUP NAME SECTION SUMMARY DESCRIPTION DEPENDS COMPONENT...): the package of components, the first of which
# brings along its documents.
macro(hsdm_debian_package group name section summary description depends)
  string(TOUPPER ${group} GROUP)
  set(CPACK_DEBIAN_${GROUP}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${GROUP}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${GROUP}_DESCRIPTION "${summary}\n${about}\n\n${description}")
  set(CPACK_DEBIAN_${GROUP}_PACKAGE_DEPENDS "${depends}")
  list(APPEND CPACK_COMPONENTS_ALL ${ARGN})
  list(APPEND debian_groups ${group})
  foreach(component ${ARGN})
    list(APPEND components_of_${group} ${component})
  endforeach()
  list(GET components_of_${group} 0 first)
  hsdm_install_files(${first} share/doc/${name} ${debian}/copyright ${debian}/changelog.gz ${debian}/changelog.Debian.gz)
  install(FILES cmake/debian/lintian-overrides DESTINATION share/lintian/overrides RENAME ${name} COMPONENT ${first})
endmacro()

# What is loaded when it is asked for dpkg-shlibdeps does not see: libzip.
file(REAL_PATH ${ZIP_LIBRARY} zip_file)
execute_process(COMMAND dpkg-query -S ${zip_file} OUTPUT_VARIABLE zip_package RESULT_VARIABLE zip_status ERROR_QUIET)
if(NOT zip_status EQUAL 0)
  message(WARNING "${zip_file} is of no Debian package: the package of the library will not depend on libzip")
endif()
string(REGEX REPLACE ":.*" "" zip_package "${zip_package}")

set(CPACK_COMPONENTS_ALL)
hsdm_debian_package(hsdm hsdm graphics "scanned points to CAD-ready meshes"
  "This is the command, with the modules that it loads, manual pages and\ncompletions for bash, zsh and fish."
  "${soname_package} (= ${full_version})" runtime modules)
hsdm_debian_package(library ${soname_package} libs "scanned points to CAD-ready meshes, shared library"
  "This is the library that the command and other programs use." "${zip_package}" library)
hsdm_debian_package(dev libhsdm-dev libdevel "scanned points to CAD-ready meshes, development files"
  "These are the headers, the packages for CMake and pkg-config, and\nexamples."
  "${soname_package} (= ${full_version}), libopenmesh-dev, libtbb-dev" development examples)
hsdm_debian_package(tools hsdm-tools graphics "scans of known solids, and measurements of hsdm"
  "hsdm_generate writes scans of solids whose surface is known, with noise\nand outliers; hsdm_bench measures what becomes of such."
  "${soname_package} (= ${full_version})" tools)
if(HSDM_BUILD_PYTHON)
  # Built for one Python; the command is what `python3 -m hsdm` runs.
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  hsdm_debian_package(python python3-hsdm python "scanned points to CAD-ready meshes, Python module"
    "This is the module for Python ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}, on NumPy's arrays."
    "hsdm (= ${full_version}), ${soname_package} (= ${full_version}), python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy" python)
  install(CODE "file(REMOVE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share/doc/hsdm/LICENSE\")" COMPONENT python)
endif()
# Debian calls ldconfig by a trigger; see packages.sh on what CPack does.
file(CONFIGURE OUTPUT ${debian}/shlibs CONTENT "libhsdm ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} ${soname_package} (>= ${PROJECT_VERSION})\n")
file(CONFIGURE OUTPUT ${debian}/triggers CONTENT "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${debian}/shlibs;${debian}/triggers")

# Pages of man(1) are compressed.
set(docs "\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share")
foreach(component ${CPACK_COMPONENTS_ALL})
  install(CODE "file(GLOB pages \"${docs}/man/man1/*.1\")
    if(pages)
      execute_process(COMMAND ${GZIP} -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)
    endif()" COMPONENT ${component})
endforeach()

include(CPack)
foreach(group ${debian_groups})
  cpack_add_component_group(${group})
  foreach(component ${components_of_${group}})
    cpack_add_component(${component} GROUP ${group})
  endforeach()
endforeach()
