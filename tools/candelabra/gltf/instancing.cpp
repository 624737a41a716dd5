// SPDX-License-Identifier: Apache-2.0
#include "gltf/instancing.h"

#include <optional>

#include "gltf/accessor.h"
#include "gltf/nodes.h"

namespace candelabra::app
{

std::vector<glm::dmat4> readGltfInstancing(const GltfDocument& document, size_t node,
                                           size_t mostInstances)
{
    const auto* extension =
        GltfDocument::extension(document.json["nodes"][node], "EXT_mesh_gpu_instancing");
    if (!extension)
        return {glm::dmat4(1)};
    const nlohmann::json& attributes = (*extension)["attributes"];
    const std::string element =
        gltfElement("nodes", node) + ".extensions.EXT_mesh_gpu_instancing.attributes";
    std::optional<size_t> count;
    const auto find = [&](const char* name, int components) -> std::optional<GltfAccessor> {
        const auto found = attributes.find(name);
        if (found == attributes.end())
            return std::nullopt;
        GltfAccessor accessor(document, found->get<int>());
        if (accessor.components() != components)
            document.fail(element + "." + name,
                          accessor.element() + " has the wrong number of components");
        if (count && accessor.count() != *count)
            document.fail(element + "." + name,
                          accessor.element() + " has " + std::to_string(accessor.count()) +
                              " elements, others have " + std::to_string(*count));
        count = accessor.count();
        return accessor;
    };
    const auto translations = find("TRANSLATION", 3);
    const auto rotations = find("ROTATION", 4);
    const auto scales = find("SCALE", 3);
    if (!count) {
        document.warn(element, "has no TRANSLATION, ROTATION or SCALE; the mesh is drawn once");
        return {glm::dmat4(1)};
    }
    if (*count > mostInstances)
        document.failTooLarge(element,
                              "has " + std::to_string(*count) + " instances, more than the " +
                                  std::to_string(mostInstances) + " that the scene has room for");
    std::vector<glm::dmat4> out;
    out.reserve(*count);
    for (size_t i = 0; i < *count; ++i) {
        GltfTransform transform;
        if (translations)
            transform.translation = glm::dvec3(translations->read(i));
        if (rotations)
            transform.rotation = glm::dvec4(rotations->read(i));
        if (scales)
            transform.scale = glm::dvec3(scales->read(i));
        out.push_back(gltfMatrix(document, element + ".ROTATION", transform));
    }
    return out;
}

} // namespace candelabra::app
