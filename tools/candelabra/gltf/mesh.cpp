// SPDX-License-Identifier: Apache-2.0
#include "gltf/mesh.h"

#include <algorithm>
#include <limits>

#include "gltf/accessor.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

constexpr uint32_t unused = std::numeric_limits<uint32_t>::max();

class PrimitiveReader
{
public:
    PrimitiveReader(const GltfDocument& document, const tinygltf::Primitive& primitive,
                    std::string element, GltfMeshBudget& budget)
        : document_(document), primitive_(primitive), element_(std::move(element)), budget_(budget)
    {
    }

    std::optional<Mesh> read(const Material& material);

private:
    std::optional<GltfAccessor> attribute(const char* name, int minComponents,
                                          int maxComponents) const;
    std::vector<uint32_t> readIndices(size_t vertexCount) const;
    std::vector<uint32_t> triangles(const std::vector<uint32_t>& corners) const;
    void takeBudget(uint64_t vertices, uint64_t indices) const
    {
        takeGltfBudget(document_, element_, vertices, indices, budget_);
    }
    // Renumbers `indices` so that only the vertices that the triangles use are kept: exporters let
    // many primitives share one large vertex buffer. Returns the numbers of these vertices in the
    // file, in increasing order.
    std::vector<uint32_t> compact(std::vector<uint32_t>& indices) const;
    void readPositions(const std::vector<uint32_t>& used, Mesh& mesh) const;
    void readUvs(const std::vector<uint32_t>& used, Mesh& mesh) const;
    void readColors(const std::vector<uint32_t>& used, Mesh& mesh) const;
    bool readNormals(const std::vector<uint32_t>& used, Mesh& mesh) const;
    bool readTangents(const std::vector<uint32_t>& used, Mesh& mesh) const;
    void fillTangents(const Material& material, Mesh& mesh) const;

    const GltfDocument& document_;
    const tinygltf::Primitive& primitive_;
    std::string element_;
    GltfMeshBudget& budget_;
    size_t vertexCount_ = 0; // every attribute accessor must have as many elements
};

std::optional<GltfAccessor> PrimitiveReader::attribute(const char* name, int minComponents,
                                                       int maxComponents) const
{
    const auto found = primitive_.attributes.find(name);
    if (found == primitive_.attributes.end())
        return std::nullopt;
    GltfAccessor accessor(document_, found->second);
    const std::string element = element_ + ".attributes." + name;
    if (accessor.components() < minComponents || accessor.components() > maxComponents)
        document_.fail(element, accessor.element() + " has the wrong number of components");
    if (accessor.componentType() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        document_.fail(element,
                       accessor.element() + " has 32-bit integers, which are not allowed here");
    if (vertexCount_ != 0 && accessor.count() != vertexCount_)
        document_.fail(element, accessor.element() + " has " + std::to_string(accessor.count()) +
                                    " elements, POSITION has " + std::to_string(vertexCount_));
    return accessor;
}

std::vector<uint32_t> PrimitiveReader::readIndices(size_t vertexCount) const
{
    std::vector<uint32_t> corners;
    if (primitive_.indices < 0) {
        takeBudget(0, vertexCount);
        corners.resize(vertexCount);
        for (size_t i = 0; i < vertexCount; ++i)
            corners[i] = static_cast<uint32_t>(i);
        return corners;
    }
    const GltfAccessor accessor(document_, primitive_.indices);
    const int type = accessor.componentType();
    if (accessor.components() != 1 || (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                                       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                                       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
        document_.fail(element_ + ".indices", accessor.element() + " must be unsigned scalars");
    takeBudget(0, accessor.count());
    corners.resize(accessor.count());
    for (size_t i = 0; i < corners.size(); ++i) {
        corners[i] = accessor.readUnsigned(i);
        if (corners[i] >= vertexCount)
            document_.fail(element_ + ".indices",
                           accessor.element() + " element " + std::to_string(i) + " is " +
                               std::to_string(corners[i]) + ", but there are " +
                               std::to_string(vertexCount) + " vertices");
    }
    return corners;
}

// Converts triangle lists, strips and fans (glTF 2.0, section 3.7.2.1) to a list. Triangles that
// use a vertex twice are dropped: such triangles only join strips together.
std::vector<uint32_t> PrimitiveReader::triangles(const std::vector<uint32_t>& corners) const
{
    const size_t n = corners.size();
    const bool isList = primitive_.mode == TINYGLTF_MODE_TRIANGLES;
    if (isList && n % 3 != 0)
        document_.fail(element_, "is a triangle list of " + std::to_string(n) +
                                     " corners, not a multiple of 3");
    const size_t count = isList ? n / 3 : (n < 3 ? 0 : n - 2);
    if (!isList)
        takeBudget(0, 2 * uint64_t{count});
    std::vector<uint32_t> out;
    out.reserve(3 * count);
    for (size_t t = 0; t < count; ++t) {
        size_t a = 3 * t, b = a + 1, c = a + 2;
        if (primitive_.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            a = t;
            b = t + 1 + t % 2; // every second triangle has the opposite winding
            c = t + 2 - t % 2;
        } else if (primitive_.mode == TINYGLTF_MODE_TRIANGLE_FAN) {
            a = t + 1;
            b = t + 2;
            c = 0;
        }
        const uint32_t corner[3] = {corners[a], corners[b], corners[c]};
        if (corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0])
            out.insert(out.end(), corner, corner + 3);
    }
    return out;
}

std::vector<uint32_t> PrimitiveReader::compact(std::vector<uint32_t>& indices) const
{
    const auto [low, high] = std::minmax_element(indices.begin(), indices.end());
    const uint32_t first = *low;
    std::vector<uint32_t> newNumber(size_t{*high - first} + 1, unused);
    for (const uint32_t i : indices)
        newNumber[i - first] = 0;
    std::vector<uint32_t> used;
    for (size_t i = 0; i < newNumber.size(); ++i)
        if (newNumber[i] != unused) {
            newNumber[i] = static_cast<uint32_t>(used.size());
            used.push_back(first + static_cast<uint32_t>(i));
        }
    for (uint32_t& i : indices)
        i = newNumber[i - first];
    return used;
}

void PrimitiveReader::readPositions(const std::vector<uint32_t>& used, Mesh& mesh) const
{
    const auto accessor = attribute("POSITION", 3, 3);
    for (size_t i = 0; i < used.size(); ++i) {
        mesh.vertices[i].position = accessor->read(used[i]);
        const glm::vec3 p = glm::abs(mesh.vertices[i].position);
        if (std::max({p.x, p.y, p.z}) > static_cast<float>(maxCoordinate))
            document_.fail(element_ + ".attributes.POSITION", accessor->element() + " element " +
                                                                  std::to_string(used[i]) +
                                                                  " is more than 1e12 m away");
    }
}

void PrimitiveReader::readUvs(const std::vector<uint32_t>& used, Mesh& mesh) const
{
    const char* names[] = {"TEXCOORD_0", "TEXCOORD_1"};
    for (size_t set = 0; set < 2; ++set)
        if (const auto accessor = attribute(names[set], 2, 2))
            for (size_t i = 0; i < used.size(); ++i)
                mesh.vertices[i].uv[set] = accessor->read(used[i]);
}

void PrimitiveReader::readColors(const std::vector<uint32_t>& used, Mesh& mesh) const
{
    const auto accessor = attribute("COLOR_0", 3, 4);
    if (!accessor)
        return;
    if (!accessor->isFloat() && !accessor->isNormalized())
        document_.fail(element_ + ".attributes.COLOR_0",
                       accessor->element() + " has integers that are not normalized");
    for (size_t i = 0; i < used.size(); ++i) {
        glm::vec4 color = accessor->read(used[i]);
        if (accessor->components() == 3)
            color.w = 1;
        // Colours multiply a reflectance, so they have the range of reflectances.
        if (glm::any(glm::lessThan(color, glm::vec4(0))) ||
            glm::any(glm::greaterThan(color, glm::vec4(1.0001f))))
            document_.fail(element_ + ".attributes.COLOR_0", accessor->element() + " element " +
                                                                 std::to_string(used[i]) +
                                                                 " is not between 0 and 1");
        mesh.vertices[i].color = glm::min(color, glm::vec4(1));
    }
}

bool PrimitiveReader::readNormals(const std::vector<uint32_t>& used, Mesh& mesh) const
{
    const auto accessor = attribute("NORMAL", 3, 3);
    if (!accessor)
        return false;
    for (size_t i = 0; i < used.size(); ++i) {
        // In double precision, because the square of a float may not fit into a float.
        const glm::dvec3 n(accessor->read(used[i]));
        const double length = glm::length(n);
        mesh.vertices[i].normal = length > 1e-3 ? glm::vec3(n / length) : glm::vec3(0);
    }
    if (const size_t broken = repairNormals(mesh))
        document_.warn(element_,
                       std::to_string(broken) +
                           " normals have zero length and are computed from the triangles");
    return true;
}

bool PrimitiveReader::readTangents(const std::vector<uint32_t>& used, Mesh& mesh) const
{
    const auto accessor = attribute("TANGENT", 4, 4);
    if (!accessor)
        return false;
    size_t broken = 0;
    for (size_t i = 0; i < used.size(); ++i) {
        Vertex& v = mesh.vertices[i];
        const glm::vec4 value = accessor->read(used[i]);
        const glm::dvec3 n(v.normal), t(value);
        const glm::dvec3 inPlane = t - n * glm::dot(n, t);
        const double length = glm::length(inPlane);
        const bool usable = length > 1e-3 * glm::length(t) && glm::length(t) > 1e-3;
        broken += !usable;
        v.tangent = usable ? glm::vec4(glm::vec3(inPlane / length), 1) : anyTangent(v.normal);
        v.tangent.w = value.w < 0 ? -1.0f : 1.0f;
    }
    if (broken)
        document_.warn(element_, std::to_string(broken) +
                                     " tangents have no usable direction and are replaced");
    return true;
}

void PrimitiveReader::fillTangents(const Material& material, Mesh& mesh) const
{
    const char* uv = material.normalTexture.uvSet ? "TEXCOORD_1" : "TEXCOORD_0";
    if (material.normalTexture.texture >= 0 && primitive_.attributes.count(uv)) {
        makeTangents(mesh, material.normalTexture);
        return;
    }
    for (Vertex& v : mesh.vertices)
        v.tangent = anyTangent(v.normal);
}

std::optional<Mesh> PrimitiveReader::read(const Material& material)
{
    if (primitive_.mode < TINYGLTF_MODE_TRIANGLES) {
        document_.warn(element_, "consists of points or lines and is left out");
        return std::nullopt;
    }
    const auto positions = attribute("POSITION", 3, 3);
    if (!positions) {
        document_.warn(element_, "has no POSITION and is left out");
        return std::nullopt;
    }
    if (!primitive_.targets.empty())
        document_.warn(element_, "has morph targets; the mesh is drawn in its rest pose");
    if (positions->count() >= unused)
        document_.fail(element_, "has too many vertices");
    vertexCount_ = positions->count();
    Mesh mesh;
    mesh.indices = triangles(readIndices(vertexCount_));
    if (mesh.indices.empty()) {
        document_.warn(element_, "has no triangles and is left out");
        return std::nullopt;
    }
    const std::vector<uint32_t> used = compact(mesh.indices);
    const bool hasNormals = primitive_.attributes.count("NORMAL") != 0;
    // With flat normals every corner needs its own vertex. Tangents split a vertex into at most
    // two.
    takeBudget(hasNormals ? used.size() : mesh.indices.size(), 0);
    mesh.vertices.resize(used.size());
    readPositions(used, mesh);
    readUvs(used, mesh);
    readColors(used, mesh);
    if (!readNormals(used, mesh)) {
        makeFlatNormals(mesh);
        fillTangents(material, mesh); // without normals, glTF 2.0 has tangents ignored
    } else if (!readTangents(used, mesh)) {
        fillTangents(material, mesh);
    }
    return mesh;
}

} // namespace

void takeGltfBudget(const GltfDocument& document, const std::string& element, uint64_t vertices,
                    uint64_t indices, GltfMeshBudget& budget)
{
    if (vertices > budget.vertices)
        document.fail(element,
                      "brings the scene above " + std::to_string(maxSceneVertices) + " vertices");
    if (indices > budget.indices)
        document.fail(element,
                      "brings the scene above " + std::to_string(maxSceneIndices) + " indices");
    budget.vertices -= vertices;
    budget.indices -= indices;
}

std::optional<Mesh> readGltfPrimitive(const GltfDocument& document, size_t mesh, size_t primitive,
                                      const Material& material, GltfMeshBudget& budget)
{
    const std::string element =
        gltfElement("meshes", mesh) + "." + gltfElement("primitives", primitive);
    PrimitiveReader reader(document, document.model.meshes[mesh].primitives[primitive], element,
                           budget);
    return reader.read(material);
}

Mesh mirroredMesh(const Mesh& mesh)
{
    Mesh mirrored = mesh;
    for (Vertex& v : mirrored.vertices) {
        v.position.x = -v.position.x;
        v.normal.x = -v.normal.x;
        v.tangent.x = -v.tangent.x;
        v.tangent.w = -v.tangent.w; // a reflection reverses cross(normal, tangent)
    }
    for (size_t t = 0; t + 2 < mirrored.indices.size(); t += 3)
        std::swap(mirrored.indices[t + 1], mirrored.indices[t + 2]);
    return mirrored;
}

} // namespace candelabra::app
