# SPDX-License-Identifier: Apache-2.0
# Writes shader_sources.cpp. Usage: cmake -DROOT=shaders -DFILES=a;b -DOUTPUT=file -P embed.cmake
set(entries)
foreach(file ${FILES})
    file(READ ${ROOT}/${file} text)
    string(APPEND entries "    {\"${file}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"compiler/shader_sources.h\"
namespace candelabra::compiler
{
static const ShaderSource sources[] = {
${entries}};
std::span<const ShaderSource> shaderSources()
{
    return sources;
}
} // namespace candelabra::compiler
")
