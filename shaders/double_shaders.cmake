# SPDX-License-Identifier: Apache-2.0
# Makes C++ of shaders, so that tests and benchmarks can call the formulas that
# ship in double precision. GLSL is nearly C++ already: the text of a shader becomes part of the body of a
# class, whose members are the functions and constants of the shader, and tools/formula/glsl.h has the types
# and functions that GLSL has built in. These are the differences:
#   float x                              double x
#   inout T x, out T x                   T& x
#   precise T x                          T x; only GPUs may fuse operations
#   const T x, outside functions         static constexpr T x
#   layout(constant_id = ID) const T x = value    static constexpr T x = Constants::specialised(ID, value)
#   a.xy                                 a.xy()
#   T(a, b), where T is a struct         T{a, b}, by a macro of that name
#   T x, without a value                 T x{}, because compilers warn about copies of it
# The fitted constants of shared/conic_constants.h become variables, which tools/fit changes.
#
# Usage: include it and call candelabra_double_shaders

include(${CMAKE_CURRENT_LIST_DIR}/host_shaders.cmake)

# candelabra_double_shaders(DESTINATION HEADER shader...) writes HEADER, which is to be included in the body of a
# class, to the folder DESTINATION, and sets candelabra_double_shaders to the shaders that it is made of.
function(candelabra_double_shaders destination header)
    set(root ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
    set(given ${ARGN})
    candelabra_glsl_closure(files ${root} ${given})
    list(REMOVE_ITEM files shared/prelude.h)
    set(name ${candelabra_glsl_name})
    foreach(file ${files})
        file(READ ${root}/${file} text)
        # The files of shaders/shared are also included as they are.
        string(REGEX REPLACE "\n#ifndef CND_(${name})\n#define CND_" "\n#ifndef DOUBLE_\\1\n#define DOUBLE_"
            text "${text}")
        string(REPLACE "\n#include \"shared/prelude.h\"" "" text "${text}")
        string(REPLACE "\n#include \"" "\n#include \"double/" text "${text}")
        string(REGEX REPLACE "\n *#extension[^\n]*" "" text "${text}")
        string(REGEX REPLACE "([^A-Za-z0-9_])float([^A-Za-z0-9_])" "\\1double\\2" text "${text}")
        string(REGEX REPLACE "([^A-Za-z0-9_])precise " "\\1" text "${text}")
        string(REGEX REPLACE "([^A-Za-z0-9_])(inout|out) (${name}) (${name}[,)])" "\\1\\3& \\4" text "${text}")
        string(REGEX REPLACE "\nlayout\\(constant_id = (${name})\\) const (${name} ${name}) = ([^\n]*);"
            "\nstatic constexpr \\2 = Constants::specialised(\\1, \\3);" text "${text}")
        string(REPLACE ") const double name = value;" ") double name = value;" text "${text}")
        string(REGEX REPLACE "(\n|[)] )const (${name} ${name})" "\\1static constexpr \\2" text "${text}")
        string(REGEX REPLACE "(\n +([A-Z]${name}|double|vec[234]) ${name});" "\\1{};" text "${text}")
        string(REGEX REPLACE "[.]([xyzw][xyzw]+)([^A-Za-z0-9_(])" ".\\1()\\2" text "${text}")
        string(REGEX REPLACE "\nstruct (${name}) {" "\n#define \\1(...) \\1{__VA_ARGS__}\nstruct \\1 {"
            text "${text}")
        file(CONFIGURE OUTPUT ${destination}/double/${file} CONTENT "${text}" @ONLY)
    endforeach()
    list(TRANSFORM given REPLACE "(.+)" "#include \"double/\\1\"\n")
    string(CONCAT text ${given})
    file(CONFIGURE OUTPUT ${destination}/${header} CONTENT "${text}" @ONLY)
    set(candelabra_double_shaders ${files} PARENT_SCOPE)
endfunction()
