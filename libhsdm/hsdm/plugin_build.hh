#pragma once
// How a module, or the program that loads it, was built, as a text that both have.

#include "hsdm/version.hh"

#include <OpenMesh/Core/System/config.h>

#include <cstddef> // libstdc++ says here how it was configured

/// For HSDM_STRINGIFY alone.
#define HSDM_STRINGIFY_(x) #x
/// What a macro stands for, as a string literal.
#define HSDM_STRINGIFY(x) HSDM_STRINGIFY_(x)

#ifdef _GLIBCXX_DEBUG
#define HSDM_PLUGIN_CONTAINERS "checked (_GLIBCXX_DEBUG)"
#else
#define HSDM_PLUGIN_CONTAINERS "unchecked"
#endif
#if defined(_GLIBCXX_USE_CXX11_ABI) && !_GLIBCXX_USE_CXX11_ABI
#define HSDM_PLUGIN_STRINGS "older than C++11 (_GLIBCXX_USE_CXX11_ABI=0)"
#else
#define HSDM_PLUGIN_STRINGS "of C++11"
#endif
#ifdef __has_feature
#define HSDM_HAS_FEATURE_(x) __has_feature(x)
#else
#define HSDM_HAS_FEATURE_(x) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || HSDM_HAS_FEATURE_(address_sanitizer)
#define HSDM_PLUGIN_SANITIZER "address"
#elif defined(__SANITIZE_THREAD__) || HSDM_HAS_FEATURE_(thread_sanitizer)
#define HSDM_PLUGIN_SANITIZER "thread"
#else
#define HSDM_PLUGIN_SANITIZER "none"
#endif

/// What module and loader must have in common to share a mesh: hsdm, compiler, OpenMesh, and what changes the
/// layout of their types. NDEBUG does not: in OpenMesh and hsdm it only adds checks to functions, so a module
/// with assertions runs in a program without, and the other way about. Each part has a name and a value, so
/// that those which differ can be told.
#define HSDM_PLUGIN_BUILD                                                                                    \
    "hsdm " HSDM_VERSION ", compiler " __VERSION__ ", OpenMesh " HSDM_STRINGIFY(                             \
        OM_VERSION) ", C++ ABI " HSDM_STRINGIFY(__GXX_ABI_VERSION) ", strings " HSDM_PLUGIN_STRINGS          \
                                                                   ", containers " HSDM_PLUGIN_CONTAINERS    \
                                                                   ", sanitizer " HSDM_PLUGIN_SANITIZER
