# HSDM_BUILD_PYTHON: the Python package, unless told otherwise where pybind11 and Python's headers are. Debian's own Python, which has
# NumPy, goes before one that comes first in a user's PATH; -DPython_EXECUTABLE=... takes another.
if(NOT DEFINED Python_EXECUTABLE AND NOT SKBUILD AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
set(buildable OFF)
if(PROJECT_IS_TOP_LEVEL AND HSDM_BUILD_APPS AND NOT HSDM_SANITIZE AND NOT HSDM_COVERAGE) # Python itself has neither
  find_package(Python 3.9 COMPONENTS Interpreter Development.Module QUIET)
  if(Python_FOUND)
    set(PYBIND11_FINDPYTHON ON)
    find_package(pybind11 2.10 CONFIG QUIET)
  endif()
  if(pybind11_FOUND)
    set(buildable ON)
  endif()
endif()
# AUTO asks anew each time: what is missing may be installed when the tree is there.
set(HSDM_BUILD_PYTHON AUTO CACHE STRING "Build the Python package: ON, OFF, or AUTO: where it can be built")
if(HSDM_BUILD_PYTHON STREQUAL "AUTO")
  set(HSDM_BUILD_PYTHON ${buildable})
endif()
if(HSDM_BUILD_PYTHON AND NOT buildable)
  message(FATAL_ERROR "HSDM_BUILD_PYTHON needs pybind11 2.10, the headers of Python 3.9 or later and the command, in a build "
    "without sanitizers: install pybind11-dev and python3-dev, or configure with -DHSDM_BUILD_PYTHON=OFF")
endif()
