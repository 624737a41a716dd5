// SPDX-License-Identifier: Apache-2.0
#include "scene/file_kind.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include "io/image_file.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

constexpr const char* exportGltf = "; export it as glTF 2.0 (.glb)";
constexpr const char* lightsScenes = ", not a scene; --environment lights a scene with it";
constexpr const char* notScene = ", not a scene";

// A kind of file that begins with `magic` at the byte `offset`, or whose name ends in `extension`.
struct Kind {
    std::string_view magic;
    size_t offset;
    const char* what;
    const char* advice;
};
constexpr Kind byMagic[] = {
    {"\x89PNG", 0, "a PNG image", notScene},
    {"\xff\xd8\xff", 0, "a JPEG image", notScene},
    {"GIF8", 0, "a GIF image", notScene},
    {"WEBP", 8, "a WebP image", notScene},
    {"DDS ", 0, "a DDS image", notScene},
    {"\xabKTX ", 0, "a KTX image", notScene},
    {"v/1\x01", 0, "an OpenEXR image", lightsScenes},
    {"#?R", 0, "a Radiance HDR image", lightsScenes},
    {"PF\n", 0, "a PFM image", lightsScenes},
    {"PXR-USDC", 0, "a USD scene", exportGltf},
    {"#usda", 0, "a USD scene", exportGltf},
    {"Kaydara FBX", 0, "an FBX scene", exportGltf},
    {"; FBX", 0, "an FBX scene", exportGltf},
    {"BLENDER", 0, "a Blender file", exportGltf},
    {"ply\n", 0, "a PLY mesh", exportGltf},
    {"ply\r", 0, "a PLY mesh", exportGltf},
    {"%PDF", 0, "a PDF document", notScene},
    {"\x7f"
     "ELF",
     0, "a program", notScene},
};
constexpr Kind byExtension[] = {
    {".usd", 0, "a USD scene", exportGltf},      {".usda", 0, "a USD scene", exportGltf},
    {".usdc", 0, "a USD scene", exportGltf},     {".usdz", 0, "a USD scene", exportGltf},
    {".fbx", 0, "an FBX scene", exportGltf},     {".blend", 0, "a Blender file", exportGltf},
    {".obj", 0, "a Wavefront mesh", exportGltf}, {".dae", 0, "a COLLADA scene", exportGltf},
    {".stl", 0, "an STL mesh", exportGltf},      {".ply", 0, "a PLY mesh", exportGltf},
    {".3ds", 0, "a 3ds Max scene", exportGltf},  {".max", 0, "a 3ds Max scene", exportGltf},
    {".abc", 0, "an Alembic scene", exportGltf}, {".c4d", 0, "a Cinema 4D scene", exportGltf},
    {".ma", 0, "a Maya scene", exportGltf},      {".mb", 0, "a Maya scene", exportGltf},
};
// These come last: a .usdz file is an archive, a .blend file may be compressed, and a .dae file is
// XML.
constexpr const char* unpack = "; unpack it, and give the .glb, .gltf or .json file in it";
constexpr Kind general[] = {
    {"PK\x03\x04", 0, "a ZIP archive", unpack},
    {"\x1f\x8b", 0, "compressed with gzip", unpack},
    {"\x28\xb5\x2f\xfd", 0, "compressed with zstd", unpack},
    {"7z\xbc\xaf", 0, "a 7-Zip archive", unpack},
    {"<", 0, "XML or a web page", notScene},
};

template <size_t N>
std::optional<Kind> kindByMagic(const Kind (&kinds)[N], std::string_view start)
{
    for (const Kind& kind : kinds)
        if (start.size() >= kind.offset && start.substr(kind.offset).starts_with(kind.magic))
            return kind;
    return std::nullopt;
}

std::optional<Kind> kindByExtension(const std::string& path)
{
    for (const Kind& kind : byExtension)
        if (hasExtension(path, kind.magic))
            return kind;
    return std::nullopt;
}

bool mayBeScene(const std::filesystem::path& path)
{
    return hasExtension(path.string(), ".glb") || hasExtension(path.string(), ".gltf") ||
           hasExtension(path.string(), ".json");
}

// Names the scenes in a folder: "is a folder; it holds a.glb".
std::string folderText(const std::string& path)
{
    constexpr size_t shown = 3;
    std::vector<std::string> scenes;
    std::error_code unreadable;
    for (std::filesystem::directory_iterator at(path, unreadable), end; !unreadable && at != end;
         at.increment(unreadable))
        if (mayBeScene(at->path()))
            scenes.push_back(at->path().filename().string());
    std::ranges::sort(scenes);
    std::string names;
    for (size_t i = 0; i < std::min(scenes.size(), shown); ++i)
        names += (i ? ", " : "") + printable(scenes[i]);
    if (scenes.size() > shown)
        names += ", ...";
    return "is a folder, not a file; " +
           (names.empty() ? "it holds no .gltf, .glb or .json file" : "it holds " + names);
}

} // namespace

std::string otherFileKind(const std::string& path, std::string_view start)
{
    if (start.starts_with(lfsPointerStart))
        return std::string(lfsPointerText);
    std::optional<Kind> kind = kindByMagic(byMagic, start);
    if (!kind)
        kind = kindByExtension(path);
    if (!kind)
        kind = kindByMagic(general, start);
    if (kind)
        return std::string("is ") + kind->what + kind->advice;
    if (hasExtension(path, ".json") && start.starts_with("glTF"))
        return "is binary glTF, whose name must end in .glb";
    const size_t first = start.find_first_not_of(" \t\r\n");
    if (hasExtension(path, ".glb") && first != std::string_view::npos &&
        !start.starts_with("glTF") && !start.starts_with("\xef\xbb\xbf") && start[first] != '{')
        return "is not glTF: it begins with neither \"glTF\" nor {";
    return "";
}

void refuseOtherFiles(const std::string& path)
{
    std::error_code ignored;
    if (path.find('\0') != std::string::npos)
        return;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    if (std::filesystem::is_directory(status))
        failScene(path, "", folderText(path));
    if (!std::filesystem::is_regular_file(status))
        return;
    std::array<char, 64> bytes{};
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), bytes.size());
    const std::string_view start(bytes.data(), size_t(file.gcount()));
    if (const std::string kind = otherFileKind(path, start); !kind.empty())
        failScene(path, "", kind);
}

} // namespace candelabra::app
