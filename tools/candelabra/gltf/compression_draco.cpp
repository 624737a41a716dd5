// SPDX-License-Identifier: Apache-2.0
// Primitives that are compressed by Draco.
#include "gltf/document.h"

#include <algorithm>
#include <optional>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>

#include "gltf/mesh.h"

namespace candelabra::app
{

namespace
{

// A triangle takes at least about a bit, and its vertex more: so few bytes for a triangle are a
// damaged number.
constexpr uint64_t mostTrianglesPerByte = 256;
// Bytes of all attributes of one vertex. Those of glTF have at most 16 bytes each.
constexpr uint64_t maxVertexBytes = 256;

// The largest allowed size of a primitive, and the reason why it was refused.
struct Limits {
    uint64_t triangles = 0, vertices = 0;
    std::string complaint;

    bool allow(uint64_t claimed, uint64_t allowed, const char* what)
    {
        if (claimed <= allowed)
            return true;
        complaint = "claims " + std::to_string(claimed) + " " + what + "; " +
                    std::to_string(allowed) + " are allowed by its accessors and its size";
        return false;
    }
};

// One of Draco's two decoders, which checks sizes before it allocates memory for them.
template <typename Decoder>
class LimitedDecoder : public Decoder
{
public:
    explicit LimitedDecoder(Limits& limits) : limits_(limits) {}

protected:
    // Both decoders begin with two numbers, of which one is the number of triangles and the other
    // that of vertices.
    bool DecodeConnectivity() override
    {
        draco::DecoderBuffer ahead = *this->buffer();
        uint32_t first = 0, second = 0;
        if (!draco::DecodeVarint(&first, &ahead) || !draco::DecodeVarint(&second, &ahead))
            return false;
        constexpr bool isSequential = std::is_same_v<Decoder, draco::MeshSequentialDecoder>;
        const uint32_t triangles = isSequential ? first : second;
        const uint32_t vertices = isSequential ? second : first;
        return limits_.allow(triangles, limits_.triangles, "triangles") &&
               limits_.allow(vertices, limits_.vertices, "vertices") &&
               Decoder::DecodeConnectivity();
    }

    // Called when the attributes are known and their values are not yet read.
    bool DecodeAllAttributes() override
    {
        const draco::PointCloud& points = *this->point_cloud();
        uint64_t bytes = 0;
        for (int i = 0; i < points.num_attributes(); ++i)
            bytes += uint64_t{points.attribute(i)->num_components()} *
                     uint64_t(draco::DataTypeLength(points.attribute(i)->data_type()));
        return limits_.allow(points.num_points(), limits_.vertices, "vertices") &&
               limits_.allow(bytes, maxVertexBytes, "bytes per vertex") &&
               Decoder::DecodeAllAttributes();
    }

private:
    Limits& limits_;
};

template <typename Decoder>
bool decode(Limits& limits, std::span<const uint8_t> bytes, draco::Mesh& mesh)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const draco::DecoderOptions options;
    return LimitedDecoder<Decoder>(limits).Decode(options, &buffer, &mesh).ok();
}

// Decodes a mesh. Fails if the data is broken or claims to be larger than `limits`.
void decodeMesh(const GltfDocument& document, const std::string& element, Limits limits,
                std::span<const uint8_t> bytes, draco::Mesh& mesh)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok())
        document.fail(element, "has no Draco data");
    if (header.version_major != 2 || header.version_minor != 2)
        document.fail(element, "is compressed by Draco " + std::to_string(header.version_major) +
                                   "." + std::to_string(header.version_minor) +
                                   ", but glTF has Draco 2.2; export again without Draco");
    if (header.encoder_type != draco::TRIANGULAR_MESH)
        document.fail(element, "is a cloud of points and not a mesh");
    const bool decoded = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING
                             ? decode<draco::MeshEdgebreakerDecoder>(limits, bytes, mesh)
                             : decode<draco::MeshSequentialDecoder>(limits, bytes, mesh);
    if (!decoded)
        document.fail(element,
                      limits.complaint.empty() ? "cannot be decompressed" : limits.complaint);
}

// Adds a buffer with `values`, and an accessor of them, to the document. Returns the accessor's
// index.
template <typename T>
int addAccessor(GltfDocument& document, const std::vector<T>& values, int components,
                int componentType, bool normalized)
{
    const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
    tinygltf::BufferView view;
    view.buffer = int(document.buffers.size());
    view.byteLength = values.size() * sizeof(T);
    document.buffers.emplace_back(bytes, bytes + view.byteLength);
    tinygltf::Accessor accessor;
    accessor.bufferView = int(document.model.bufferViews.size());
    accessor.componentType = componentType;
    accessor.normalized = normalized;
    accessor.count = values.size() / size_t(components);
    accessor.type = components == 1 ? TINYGLTF_TYPE_SCALAR : components;
    document.model.bufferViews.push_back(view);
    document.model.accessors.push_back(accessor);
    return int(document.model.accessors.size()) - 1;
}

// The values of an attribute for all vertices, as numbers of type T.
template <typename T>
std::optional<std::vector<T>> values(const draco::Mesh& mesh,
                                     const draco::PointAttribute& attribute, int components)
{
    const auto width = size_t(components);
    std::vector<T> out(mesh.num_points() * width);
    for (uint32_t i = 0; i < mesh.num_points(); ++i)
        if (!attribute.ConvertValue<T>(attribute.mapped_index(draco::PointIndex(i)),
                                       int8_t(components), &out[i * width]))
            return std::nullopt;
    return out;
}

// Adds an accessor with the attribute's values, in the type of accessor `like`. Returns its index.
int addAttribute(GltfDocument& document, const std::string& element, const draco::Mesh& mesh,
                 const draco::PointAttribute& attribute, const tinygltf::Accessor& like)
{
    const int components = tinygltf::GetNumComponentsInType(uint32_t(like.type));
    if (like.type > TINYGLTF_TYPE_VEC4 && like.type <= TINYGLTF_TYPE_MAT4)
        document.fail(element, "has an attribute of matrices");
    const auto add = [&](auto zero) {
        const auto found = values<decltype(zero)>(mesh, attribute, components);
        if (!found)
            document.fail(element, "has values that do not fit the type of their accessor");
        return addAccessor(document, *found, components, like.componentType, like.normalized);
    };
    switch (like.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return add(int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return add(uint8_t{});
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return add(int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return add(uint16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return add(uint32_t{});
    default:
        return add(float{});
    }
}

int addIndices(GltfDocument& document, const draco::Mesh& mesh)
{
    std::vector<uint32_t> indices;
    indices.reserve(size_t{3} * mesh.num_faces());
    for (uint32_t f = 0; f < mesh.num_faces(); ++f)
        for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(f)))
            indices.push_back(corner.value());
    return addAccessor(document, indices, 1, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, false);
}

// The limits that a primitive's accessors, and the primitives before it, set for Draco. `json` is
// the primitive in the file.
Limits limitsOf(const GltfDocument& document, const nlohmann::json& json,
                const std::string& element, size_t compressedBytes, const GltfMeshBudget& budget)
{
    const auto count = [&](const nlohmann::json& accessor) {
        return uint64_t{document.model.accessors[accessor.get<size_t>()].count};
    };
    const auto positions = json["attributes"].find("POSITION");
    if (positions == json["attributes"].end() || !json.contains("indices"))
        document.fail(element, "has no POSITION or no indices, which Draco needs");
    Limits limits;
    limits.triangles = std::min({count(json["indices"]) / 3, budget.indices / 3,
                                 mostTrianglesPerByte * uint64_t{compressedBytes}});
    limits.vertices =
        std::min({count(*positions), budget.vertices, std::max(3 * limits.triangles, uint64_t{3})});
    return limits;
}

void decompressPrimitive(GltfDocument& document, const nlohmann::json& json,
                         const nlohmann::json& extension, const std::string& element,
                         tinygltf::Primitive& primitive, GltfMeshBudget& budget)
{
    const std::span<const uint8_t> bytes =
        document.bufferView(extension["bufferView"].get<int>(), element);
    draco::Mesh mesh;
    decodeMesh(document, element, limitsOf(document, json, element, bytes.size(), budget), bytes,
               mesh);
    takeGltfBudget(document, element, mesh.num_points(), uint64_t{3} * mesh.num_faces(), budget);
    for (const auto& [name, id] : extension["attributes"].items()) {
        const auto declared = primitive.attributes.find(name);
        if (declared == primitive.attributes.end())
            continue; // the primitive does not use it
        const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id.get<uint32_t>());
        if (!attribute)
            document.fail(element, "has no attribute " + std::to_string(id.get<uint32_t>()) +
                                       ", which is to be " + name);
        const tinygltf::Accessor like = document.model.accessors[size_t(declared->second)];
        declared->second = addAttribute(document, element, mesh, *attribute, like);
    }
    primitive.indices = addIndices(document, mesh);
    primitive.mode = TINYGLTF_MODE_TRIANGLES; // Draco has lists of triangles, also for strips
}

} // namespace

void decompressDraco(GltfDocument& document)
{
    GltfMeshBudget budget;
    for (size_t m = 0; m < document.model.meshes.size(); ++m)
        for (size_t p = 0; p < document.model.meshes[m].primitives.size(); ++p) {
            const nlohmann::json& json = document.json["meshes"][m]["primitives"][p];
            const auto* extension = GltfDocument::extension(json, "KHR_draco_mesh_compression");
            if (extension && document.isUsed("/meshes", m))
                decompressPrimitive(document, json, *extension,
                                    gltfPrimitive(m, p) + ".extensions.KHR_draco_mesh_compression",
                                    document.model.meshes[m].primitives[p], budget);
        }
}

} // namespace candelabra::app
