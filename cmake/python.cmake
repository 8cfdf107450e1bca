# HSDM_BUILD_PYTHON: the Python package, by default where pybind11 and Python's headers are. Debian's own Python, which has
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
option(HSDM_BUILD_PYTHON "Build the Python package" ${buildable})
if(HSDM_BUILD_PYTHON AND NOT buildable)
  message(FATAL_ERROR "HSDM_BUILD_PYTHON needs pybind11 2.10, the headers of Python 3.9 or later and the command, in a build "
    "without sanitizers: install pybind11-dev and python3-dev, or configure with -DHSDM_BUILD_PYTHON=OFF")
endif()
