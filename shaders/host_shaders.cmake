# SPDX-License-Identifier: Apache-2.0
# Makes copies of GLSL files in which every name that they declare outside functions has the prefix of the
# public C headers, so that none of them can be a name in a host's shader: normalize2 becomes cndNormalize2,
# Surface CndSurface, and TILE_SIZE CND_TILE_SIZE. Hosts and candelabra::compiler get these copies. The
# engine's own kernels are compiled from the files in this folder, whose short names are easier to read.
#
# Names are found by how declarations look: at the beginning of a line, and in blocks without an instance
# name. The arguments of macros that are called outside functions are names too, and whatever begins with
# them, because macros paste names together. So names of capitals with an underscore are renamed wherever
# they are, except what lists like X(1, NAME, ...) paste. Every use of a name is renamed, also where the name
# is that of a member or of a local variable. In comments single words such as "total" stay, unless the
# comment is indented like code. tests/structure/test_glsl_names.py fails if a name was missed.
#
# Usage: include it and call candelabra_host_shaders, or cmake -DDESTINATION=FOLDER -P host_shaders.cmake

cmake_minimum_required(VERSION 3.25)
set(candelabra_glsl_name "[A-Za-z_][A-Za-z0-9_]*")

# Sets `variable` to the name with its prefix.
function(candelabra_prefixed variable name)
    if(name MATCHES "^[A-Z][A-Z0-9_]*$")
        set(${variable} CND_${name} PARENT_SCOPE)
        return()
    endif()
    string(SUBSTRING ${name} 0 1 first)
    string(SUBSTRING ${name} 1 -1 rest)
    set(prefix cnd)
    if(first MATCHES "[A-Z]")
        set(prefix Cnd)
    endif()
    string(TOUPPER ${first} first)
    set(${variable} ${prefix}${first}${rest} PARENT_SCOPE)
endfunction()

# Sets `variable` to the files and what they include, as paths relative to `root`.
function(candelabra_glsl_closure variable root)
    set(closure)
    set(left ${ARGN})
    while(left)
        list(POP_FRONT left file)
        if(file IN_LIST closure OR file STREQUAL "shared/prelude_cpp.h") # the C++ half of prelude.h
            continue()
        endif()
        list(APPEND closure ${file})
        file(STRINGS ${root}/${file} includes REGEX "^#include \"")
        list(TRANSFORM includes REPLACE "^#include \"([^\"]*)\".*" "\\1")
        list(APPEND left ${includes})
    endwhile()
    set(${variable} ${closure} PARENT_SCOPE)
endfunction()

# Sets `variable` to the names that GLSL without comments declares outside functions. Instead of
# semicolons and brackets, which have a meaning in CMake's lists, the text has @, $ and `.
function(candelabra_declared_names variable code)
    set(name ${candelabra_glsl_name})
    string(REGEX REPLACE "[ \t]+" " " code "${code}")
    # Functions, structs, variables and constants: "precise vec3 name(", "shared uint name[8];".
    string(REGEX MATCHALL "\n(${name}($[^`\n]*`)? )+${name}" found "${code}")
    # "layout(...) const uint name", and of a block "layout(...) readonly buffer Block".
    string(REGEX MATCHALL "\nlayout\\([^)]*\\)( ${name})+" layouts "${code}")
    list(APPEND found ${layouts})
    # Members of blocks without an instance name.
    string(REGEX MATCHALL "\nlayout\\([^{@]*{[^}]*}@" blocks "${code}")
    string(REGEX REPLACE "\nlayout\\([^)]*\\)" "" blocks "${blocks}")
    string(REGEX MATCHALL "(\n ${name}|,) ${name}" members "${blocks}")
    list(APPEND found ${members})
    # The instance names of other blocks.
    string(REGEX MATCHALL "\n} ?${name}" instances "${code}")
    list(APPEND found ${instances})
    string(REGEX MATCHALL "# ?define ${name}" macros "${code}")
    list(APPEND found ${macros})
    # "evaluate_##FAMILY", and the arguments of "EVALUATION(name, response)".
    string(REGEX MATCHALL "${name}_##" pasted "${code}")
    list(TRANSFORM pasted REPLACE "##" "")
    string(REGEX MATCHALL "\n[A-Z][A-Z0-9_]*\\([^)\n]*" calls "${code}")
    string(REGEX MATCHALL "[(,] ?${name}" arguments "${calls}")
    list(APPEND found ${pasted} ${arguments})
    list(TRANSFORM found REPLACE "^(.*[^A-Za-z0-9_])?(${name})$" "\\2")
    list(TRANSFORM arguments REPLACE "^[(,] ?" "")
    set(${variable} ${found} PARENT_SCOPE)
    set(${variable}_begin_with ${arguments} PARENT_SCOPE)
endfunction()

# candelabra_prefix_names(SOURCE DESTINATION file...) copies the files from one folder to another. Together
# they must hold all that any of them includes, so that they agree on the names.
function(candelabra_prefix_names source destination)
    # Characters that are in no file stand for others: `code_begin` and `code_end` are put around names in
    # code, `comment_begin` and `comment_end` around names in comments.
    set(number 0)
    foreach(character code_begin code_end comment_begin comment_end semicolon open close backslash)
        math(EXPR number "${number} + 1")
        string(ASCII ${number} ${character})
    endforeach()
    set(names)
    set(tokens)
    set(pasted)
    set(begin_with)
    foreach(file ${ARGN})
        set(marked)
        file(READ ${source}/${file} text)
        string(REPLACE ";" "${semicolon}" text "${text}")
        string(REPLACE "[" "${open}" text "${text}")
        string(REPLACE "]" "${close}" text "${text}")
        string(REPLACE "\\" "${backslash}" text "${text}")
        string(REPLACE "\n" ";" lines "${text}")
        set(code "\n")
        foreach(line IN LISTS lines)
            set(comment)
            if(line MATCHES "^#include ")
                string(APPEND marked "${line}\n")
                continue()
            endif()
            if(line MATCHES "^ *//   ")
                set(statement "${line}")
            else()
                string(FIND "${line}" "//" at)
                string(SUBSTRING "${line}" 0 ${at} statement)
                if(at GREATER_EQUAL 0)
                    string(SUBSTRING "${line}" ${at} -1 comment)
                endif()
                string(APPEND code "${statement}\n")
            endif()
            string(REGEX REPLACE "(${candelabra_glsl_name})" "${code_begin}\\1${code_end}" statement "${statement}")
            string(REGEX REPLACE "(${candelabra_glsl_name})" "${comment_begin}\\1${comment_end}" comment "${comment}")
            string(APPEND marked "${statement}${comment}\n")
        endforeach()
        set(marked_${file} "${marked}")
        string(REGEX MATCHALL "${candelabra_glsl_name}" found "${code}")
        list(APPEND tokens ${found})
        string(REGEX MATCHALL " X\\([0-9]+, ${candelabra_glsl_name}" found "${code}")
        list(APPEND pasted ${found})
        string(REPLACE "${semicolon}" "@" code "${code}")
        string(REPLACE "${open}" "$" code "${code}")
        string(REPLACE "${close}" "`" code "${code}")
        candelabra_declared_names(found "${code}")
        list(APPEND names ${found})
        list(APPEND begin_with ${found_begin_with})
    endforeach()
    list(REMOVE_DUPLICATES tokens)
    set(capitals ${tokens})
    list(FILTER capitals INCLUDE REGEX "^[A-Z][A-Z0-9]*_[A-Z0-9_]*$")
    list(APPEND names ${capitals})
    list(REMOVE_DUPLICATES begin_with)
    foreach(beginning IN LISTS begin_with)
        set(longer ${tokens})
        list(FILTER longer INCLUDE REGEX "^${beginning}[A-Z_]")
        list(APPEND names ${longer})
    endforeach()
    list(REMOVE_DUPLICATES names)
    list(TRANSFORM pasted REPLACE ".* " "")
    list(REMOVE_ITEM names ${pasted})
    list(FILTER names EXCLUDE REGEX "^(Cnd|CND_|CANDELABRA_|candelabra|GL_|in$|main$)")
    foreach(name IN LISTS names)
        candelabra_prefixed(prefixed_${name} ${name})
        if(prefixed_${name} IN_LIST tokens)
            message(FATAL_ERROR
                "${name} and ${prefixed_${name}} would have the same name in the shaders for hosts")
        endif()
    endforeach()
    foreach(file ${ARGN})
        set(text "${marked_${file}}")
        string(REGEX MATCHALL "${candelabra_glsl_name}" found "${text}")
        list(REMOVE_DUPLICATES found)
        foreach(name IN LISTS found)
            if(NOT DEFINED prefixed_${name})
                continue()
            endif()
            string(REPLACE "${code_begin}${name}${code_end}" "${prefixed_${name}}" text "${text}")
            if(name MATCHES "[a-z0-9_][A-Z]|^[A-Z0-9_]+$")
                string(REPLACE "${comment_begin}${name}${comment_end}" "${prefixed_${name}}" text "${text}")
            endif()
        endforeach()
        string(REGEX REPLACE "[${code_begin}${code_end}${comment_begin}${comment_end}]" "" text "${text}")
        string(REPLACE "${semicolon}" ";" text "${text}")
        string(REPLACE "${open}" "[" text "${text}")
        string(REPLACE "${close}" "]" text "${text}")
        string(REPLACE "${backslash}" "\\" text "${text}")
        string(REGEX REPLACE "\n$" "" text "${text}")
        file(CONFIGURE OUTPUT ${destination}/${file} CONTENT "${text}" @ONLY) # written only if it differs
    endforeach()
endfunction()

# Writes to `destination` what hosts include, lib/forward.glsl and lib/gbuffer.glsl with what these include,
# and sets candelabra_included_shaders to these files; and the kernels that candelabra::compiler compiles with
# functions of hosts, and sets candelabra_compiled_shaders to all files.
function(candelabra_host_shaders destination)
    set(root ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
    set(kernels shade_tiles shade_unlisted shade_brute count_pairs pair_visibility tile_clusters
        split_tiles cpu/tile_clusters cpu/split_tiles surface_overlay shade_environment)
    list(TRANSFORM kernels REPLACE "(.+)" "kernels/\\1.comp")
    candelabra_glsl_closure(included ${root} lib/forward.glsl lib/gbuffer.glsl)
    candelabra_glsl_closure(compiled ${root} ${included} ${kernels})
    candelabra_prefix_names(${root} ${destination} ${compiled})
    set(candelabra_included_shaders ${included} PARENT_SCOPE)
    set(candelabra_compiled_shaders ${compiled} PARENT_SCOPE)
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
    candelabra_host_shaders(${DESTINATION})
endif()
