# SPDX-License-Identifier: Apache-2.0
# Compiles one shader from GLSL to SPIR-V (warnings are errors), optimises it with spirv-opt unless DEBUG_INFO is
# on, validates it with spirv-val, and writes it as a C++ array.
get_filename_component(dir ${OUTPUT} DIRECTORY)
file(MAKE_DIRECTORY ${dir})
if(FAMILY)
    set(family -DLIGHT_FAMILY_${FAMILY})
endif()
if(DEFINE)
    string(REPLACE "+" ";-D" defines "-D${DEFINE}") # several are joined by '+'
    list(APPEND family ${defines})
endif()
# Modules run on every device of Vulkan 1.1 (engine/DECISIONS.md, 58), so all shaders are compiled for it.
set(VULKAN vulkan1.1)
set(spv ${OUTPUT}.spv)
# Debuggers get code that is not optimised, with its source. glslang 12 cannot make the best form of this, -gVS, for
# every shader: it crashes (shade_tiles) or makes invalid code (cluster_lists). These shaders get -g instead, which has
# the source and line numbers, but no variables.
set(debug_info "none")
if(DEBUG_INFO)
    set(debug_info -gVS -g)
endif()
foreach(kind ${debug_info})
    if(kind STREQUAL "none")
        set(kind)
    endif()
    execute_process(
        COMMAND ${GLSLANG} -V ${kind} --target-env ${VULKAN} --quiet -I${INCLUDE} ${family}
            --depfile ${OUTPUT}.d.in -o ${spv} ${INPUT}
        OUTPUT_VARIABLE log ERROR_VARIABLE log RESULT_VARIABLE failed)
    if(failed OR log MATCHES "WARNING")
        set(fault "${INPUT}:\n${log}")
        continue()
    endif()
    # Puts functions that return only at their end in the place of their calls, and removes what is never used.
    # Drivers then have to do it only for the others (engine/DECISIONS.md, 47, which also says why other passes
    # are left out). It changes no calculation. Bindings and specialisation constants that a kernel does not
    # use stay, because the engine reads them all.
    if(NOT DEBUG_INFO)
        execute_process(
            COMMAND ${SPIRV_OPT} --target-env=${VULKAN} --scalar-block-layout --preserve-bindings
                --preserve-spec-constants --eliminate-dead-branches --inline-entry-points-exhaustive
                --eliminate-dead-functions --private-to-local --eliminate-local-single-block
                --eliminate-local-single-store --eliminate-dead-code-aggressive ${spv} -o ${spv}
            OUTPUT_VARIABLE log ERROR_VARIABLE log RESULT_VARIABLE failed)
        if(failed)
            set(fault "spirv-opt ${INPUT}:\n${log}")
            continue()
        endif()
    endif()
    execute_process(COMMAND ${SPIRV_VAL} --target-env ${VULKAN} --scalar-block-layout ${spv}
        OUTPUT_VARIABLE log ERROR_VARIABLE log RESULT_VARIABLE failed)
    if(failed)
        set(fault "spirv-val ${INPUT}:\n${log}")
        continue()
    endif()
    set(fault)
    break()
endforeach()
if(fault)
    file(REMOVE ${OUTPUT})
    message(FATAL_ERROR "${fault}")
endif()
# glslang's depfile names the .spv file as its target; the build system needs the C++ file there. The depfile escapes
# spaces of the path, so only the end of the name is looked for.
file(READ ${OUTPUT}.d.in deps)
string(REPLACE ".spv: " ": " deps "${deps}")
file(WRITE ${OUTPUT}.d "${deps}")

file(READ ${spv} hex HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${hex}")
string(REGEX REPLACE "((0x........,)(0x........,)(0x........,)(0x........,)(0x........,)(0x........,)(0x........,)(0x........,))" "\\1\n" words "${words}")
file(WRITE ${OUTPUT} "#include \"gpu/spirv.h\"
namespace candelabra::spirv
{
static const uint32_t ${SYMBOL}_words[] = {\n${words}};
extern const gpu::Spirv ${SYMBOL};
const gpu::Spirv ${SYMBOL}{\"${NAME}\", ${SYMBOL}_words};
} // namespace candelabra::spirv
")
