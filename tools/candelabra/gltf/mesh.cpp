// SPDX-License-Identifier: Apache-2.0
#include "gltf/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "gltf/accessor.h"
#include "gltf/material.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

// The unit normal of a triangle times twice its area. It is computed in double precision, so that
// the products neither overflow nor vanish, whatever the unit of the file.
glm::dvec3 areaNormal(const Mesh& mesh, size_t triangle)
{
    const auto corner = [&](size_t k) {
        return glm::dvec3(mesh.vertices[mesh.indices[3 * triangle + k]].position);
    };
    return glm::cross(corner(1) - corner(0), corner(2) - corner(0));
}

glm::vec3 normalizedOr(const glm::dvec3& v, const glm::vec3& otherwise)
{
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : otherwise;
}

// Returns some unit tangent that is perpendicular to the unit normal.
glm::vec4 anyTangent(const glm::vec3& normal)
{
    // With the axis that is least aligned with the normal, the cross product is far from zero.
    const glm::vec3 a = glm::abs(normal);
    const glm::vec3 axis = a.x <= a.y && a.x <= a.z ? glm::vec3(1, 0, 0)
                           : a.y <= a.z             ? glm::vec3(0, 1, 0)
                                                    : glm::vec3(0, 0, 1);
    return glm::vec4(glm::normalize(glm::cross(axis, normal)), 1);
}

struct UvGradient {
    glm::dvec3 tangent{0}; // points to where u grows; its length is proportional to the area
    bool mirrored = false; // the texture is seen from its back
};

UvGradient uvGradient(const Mesh& mesh, size_t triangle, const TextureRef& ref)
{
    glm::dvec3 p[3];
    glm::dvec2 uv[3];
    for (size_t k = 0; k < 3; ++k) {
        const Vertex& v = mesh.vertices[mesh.indices[3 * triangle + k]];
        const glm::dvec3 w(v.uv[ref.uvSet], 1);
        p[k] = v.position;
        uv[k] = {glm::dot(glm::dvec3(ref.uRow), w), glm::dot(glm::dvec3(ref.vRow), w)};
    }
    const glm::dvec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
    const glm::dvec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
    const double determinant = d1.x * d2.y - d1.y * d2.x;
    UvGradient gradient;
    // In an image v points down, but the y of a normal map points up. So the bitangent
    // cross(normal, tangent) points against v, and a triangle that shows the image from the front
    // has the opposite winding in uv space.
    gradient.mirrored = determinant > 0;
    const glm::dvec3 t = (d2.y * e1 - d1.y * e2) * (determinant < 0 ? -1.0 : 1.0);
    const double length = glm::length(t), area = glm::length(glm::cross(e1, e2));
    if (determinant != 0 && length > 0 && std::isfinite(length))
        gradient.tangent = t / length * area;
    return gradient;
}

// Gives every corner its own vertex with the normal of its triangle.
void makeFlatNormals(Mesh& mesh)
{
    std::vector<Vertex> corners;
    corners.reserve(mesh.indices.size());
    for (size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const glm::vec3 normal = normalizedOr(areaNormal(mesh, t), {0, 1, 0});
        for (size_t k = 0; k < 3; ++k) {
            corners.push_back(mesh.vertices[mesh.indices[3 * t + k]]);
            corners.back().normal = normal;
        }
    }
    mesh.vertices = std::move(corners);
    for (size_t i = 0; i < mesh.indices.size(); ++i)
        mesh.indices[i] = uint32_t(i);
}

// Replaces normals of zero length by the area-weighted mean normal of the triangles around the
// vertex. Returns how many were replaced.
size_t repairNormals(Mesh& mesh)
{
    // The length of a unit vector that is quantised to 8 bits is wrong by up to 1%. A vector
    // shorter than 1e-3 was never meant to be a unit vector.
    const auto isBroken = [](const Vertex& v) { return !(glm::length(v.normal) > 1e-3f); };
    size_t broken = 0;
    for (const Vertex& v : mesh.vertices)
        broken += isBroken(v);
    if (broken == 0)
        return 0;
    std::vector<glm::dvec3> sums(mesh.vertices.size(), glm::dvec3(0));
    for (size_t t = 0; t < mesh.indices.size() / 3; ++t)
        for (size_t k = 0; k < 3; ++k)
            sums[mesh.indices[3 * t + k]] += areaNormal(mesh, t);
    for (size_t i = 0; i < mesh.vertices.size(); ++i)
        if (isBroken(mesh.vertices[i]))
            mesh.vertices[i].normal = normalizedOr(sums[i], {0, 1, 0});
    return broken;
}

// Computes tangents that point to where u grows in the uv set ref.uvSet, transformed by `ref`.
// Vertices at which triangles of both orientations meet are split. If u has no direction there, the
// tangent is any that is perpendicular to the normal.
void makeTangents(Mesh& mesh, const TextureRef& ref)
{
    struct Sum {
        glm::dvec3 tangent{0};
        bool used = false;
    };
    const size_t original = mesh.vertices.size();
    std::vector<Sum> sums[2] = {std::vector<Sum>(original), std::vector<Sum>(original)};
    std::vector<bool> mirroredTriangle(mesh.indices.size() / 3);
    for (size_t t = 0; t < mirroredTriangle.size(); ++t) {
        const UvGradient gradient = uvGradient(mesh, t, ref);
        mirroredTriangle[t] = gradient.mirrored;
        for (size_t k = 0; k < 3; ++k) {
            Sum& sum = sums[gradient.mirrored][mesh.indices[3 * t + k]];
            sum.tangent += gradient.tangent;
            sum.used = true;
        }
    }
    const auto tangent = [&](const Vertex& v, const Sum& sum, float handedness) {
        const glm::dvec3 n(v.normal);
        const glm::vec3 any(anyTangent(v.normal));
        const glm::dvec3 t = sum.tangent - n * glm::dot(n, sum.tangent);
        // If the tangent is parallel to the normal, the remainder is rounding and not a direction.
        const bool clear = glm::length(t) > 1e-6 * glm::length(sum.tangent);
        return glm::vec4(clear ? normalizedOr(t, any) : any, handedness);
    };
    std::vector<uint32_t> twin(original);
    for (uint32_t i = 0; i < original; ++i) {
        twin[i] = i;
        if (sums[1][i].used && sums[0][i].used) {
            twin[i] = uint32_t(mesh.vertices.size());
            mesh.vertices.push_back(mesh.vertices[i]);
        }
        if (sums[1][i].used)
            mesh.vertices[twin[i]].tangent = tangent(mesh.vertices[i], sums[1][i], -1);
        if (!sums[1][i].used || twin[i] != i)
            mesh.vertices[i].tangent = tangent(mesh.vertices[i], sums[0][i], 1);
    }
    for (size_t t = 0; t < mirroredTriangle.size(); ++t)
        for (size_t k = 0; mirroredTriangle[t] && k < 3; ++k)
            mesh.indices[3 * t + k] = twin[mesh.indices[3 * t + k]];
}

constexpr uint32_t unused = std::numeric_limits<uint32_t>::max();

class PrimitiveReader
{
public:
    PrimitiveReader(const GltfDocument& document, const tinygltf::Primitive& primitive,
                    std::string element, const GltfPose& pose, GltfMeshBudget& budget)
        : document_(document),
          primitive_(primitive),
          element_(std::move(element)),
          pose_(pose),
          budget_(budget)
    {
    }

    std::optional<Mesh> read(const Material& material);

private:
    // Finds out how many vertices there are. Returns false, with a warning, if there are none.
    bool countVertices();
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
    // Makes the vertices, with all that needs no triangles: positions, UVs and colours.
    void readVertices(const std::vector<uint32_t>& used, Mesh& mesh) const;
    void readPositions(const std::vector<uint32_t>& used, Mesh& mesh) const;
    void readUvs(const std::vector<uint32_t>& used, Mesh& mesh) const;
    void readColors(const std::vector<uint32_t>& used, Mesh& mesh) const;
    // Normals of zero length stay as they are.
    bool readNormals(const std::vector<uint32_t>& used, Mesh& mesh) const;
    bool readTangents(const std::vector<uint32_t>& used, Mesh& mesh) const;
    void fillTangents(const Material& material, Mesh& mesh) const;

    const GltfDocument& document_;
    const tinygltf::Primitive& primitive_;
    std::string element_;
    const GltfPose& pose_;
    GltfMeshBudget& budget_;
    size_t vertexCount_ = 0; // every attribute accessor must have as many elements
    std::optional<GltfPosedVertices> posed_;
};

std::optional<GltfAccessor> PrimitiveReader::attribute(const char* name, int minComponents,
                                                       int maxComponents) const
{
    const auto found = primitive_.attributes.find(name);
    if (found == primitive_.attributes.end())
        return std::nullopt;
    return gltfVertexAttribute(document_, element_ + ".attributes." + name, found->second,
                               minComponents, maxComponents, vertexCount_);
}

std::vector<uint32_t> PrimitiveReader::readIndices(size_t vertexCount) const
{
    std::vector<uint32_t> corners;
    if (primitive_.indices < 0) {
        takeBudget(0, vertexCount);
        corners.resize(vertexCount);
        for (size_t i = 0; i < vertexCount; ++i)
            corners[i] = uint32_t(i);
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
        document_.warn(element_, "is a triangle list of " + std::to_string(n) +
                                     " corners, not a multiple of 3; those of the last, incomplete "
                                     "triangle are left out");
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
    const auto [low, high] = std::ranges::minmax_element(indices);
    const uint32_t first = *low;
    std::vector<uint32_t> newNumber(size_t{*high - first} + 1, unused);
    for (const uint32_t i : indices)
        newNumber[i - first] = 0;
    std::vector<uint32_t> used;
    for (size_t i = 0; i < newNumber.size(); ++i)
        if (newNumber[i] != unused) {
            newNumber[i] = uint32_t(used.size());
            used.push_back(first + uint32_t(i));
        }
    for (uint32_t& i : indices)
        i = newNumber[i - first];
    return used;
}

void PrimitiveReader::readVertices(const std::vector<uint32_t>& used, Mesh& mesh) const
{
    mesh.vertices.resize(used.size());
    readPositions(used, mesh);
    readUvs(used, mesh);
    readColors(used, mesh);
}

void PrimitiveReader::readPositions(const std::vector<uint32_t>& used, Mesh& mesh) const
{
    const auto accessor = attribute("POSITION", 3, 3);
    for (size_t i = 0; i < used.size(); ++i) {
        mesh.vertices[i].position = posed_->position(used[i], glm::dvec3(accessor->read(used[i])));
        const glm::vec3 p = glm::abs(mesh.vertices[i].position);
        constexpr auto limit = float(maxCoordinate);
        if (!(p.x <= limit && p.y <= limit && p.z <= limit))
            document_.fail(element_ + ".attributes.POSITION", accessor->element() + " element " +
                                                                  std::to_string(used[i]) +
                                                                  " is more than 1e12 m away");
    }
}

void PrimitiveReader::readUvs(const std::vector<uint32_t>& used, Mesh& mesh) const
{
    const char* names[] = {"TEXCOORD_0", "TEXCOORD_1"};
    for (size_t set = 0; set < 2; ++set) {
        const auto accessor = attribute(names[set], 2, 2);
        for (size_t i = 0; accessor && i < used.size(); ++i) {
            glm::vec2& uv = mesh.vertices[i].uv[set];
            uv = posed_->uv(used[i], set, glm::vec2(accessor->read(used[i])));
            if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
                document_.fail(element_ + ".attributes." + names[set],
                               accessor->element() + " element " + std::to_string(used[i]) +
                                   " is not finite with its morph targets");
        }
    }
}

void PrimitiveReader::readColors(const std::vector<uint32_t>& used, Mesh& mesh) const
{
    const auto found = primitive_.attributes.find("COLOR_0");
    if (found == primitive_.attributes.end())
        return;
    const GltfAccessor accessor = gltfColorAttribute(document_, element_ + ".attributes.COLOR_0",
                                                     found->second, 3, 4, vertexCount_);
    const bool hasAlpha = isGltfAlphaUsed(document_, primitive_.material);
    size_t outside = 0;
    for (size_t i = 0; i < used.size(); ++i) {
        glm::vec4 color = accessor.read(used[i]);
        if (accessor.components() < 4 || !hasAlpha)
            color.w = 1;
        // Colours multiply a reflectance, so they have the range of reflectances.
        outside += glm::any(glm::lessThan(color, glm::vec4(-1e-4f))) ||
                   glm::any(glm::greaterThan(color, glm::vec4(1.0001f)));
        glm::vec4& posed = mesh.vertices[i].color;
        posed = glm::clamp(posed_->color(used[i], color), glm::vec4(0), glm::vec4(1));
        if (!hasAlpha)
            posed.w = 1;
    }
    if (outside)
        document_.warn(element_, std::to_string(outside) +
                                     " vertex colours are not between 0 and 1 and are clamped");
}

bool PrimitiveReader::readNormals(const std::vector<uint32_t>& used, Mesh& mesh) const
{
    const auto accessor = attribute("NORMAL", 3, 3);
    if (!accessor)
        return false;
    for (size_t i = 0; i < used.size(); ++i) {
        // In double precision, because the square of a float may not fit into a float.
        const glm::dvec3 n = posed_->normal(used[i], glm::dvec3(accessor->read(used[i])));
        const double length = glm::length(n);
        mesh.vertices[i].normal = length > 1e-3 ? glm::vec3(n / length) : glm::vec3(0);
    }
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
        const glm::dvec3 n(v.normal), t = posed_->tangent(used[i], glm::dvec3(value));
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

bool PrimitiveReader::countVertices()
{
    const auto positions = attribute("POSITION", 3, 3);
    if (!positions) {
        document_.warn(element_, "has no POSITION and is left out");
        return false;
    }
    if (positions->count() >= unused)
        document_.fail(element_, "has too many vertices");
    vertexCount_ = positions->count();
    return true;
}

std::optional<Mesh> PrimitiveReader::read(const Material& material)
{
    if (!countVertices())
        return std::nullopt;
    Mesh mesh;
    mesh.indices = triangles(readIndices(vertexCount_));
    if (mesh.indices.empty()) {
        document_.warn(element_, "has no triangles and is left out");
        return std::nullopt;
    }
    posed_.emplace(document_, primitive_, element_, pose_, vertexCount_);
    const std::vector<uint32_t> used = compact(mesh.indices);
    const bool hasNormals = primitive_.attributes.count("NORMAL") != 0;
    // With flat normals every corner needs its own vertex. Tangents split a vertex into at most
    // two.
    takeBudget(hasNormals ? used.size() : mesh.indices.size(), 0);
    readVertices(used, mesh);
    if (!readNormals(used, mesh)) {
        makeFlatNormals(mesh);
        fillTangents(material, mesh); // without normals, glTF 2.0 has tangents ignored
        return mesh;
    }
    if (const size_t broken = repairNormals(mesh))
        document_.warn(element_,
                       std::to_string(broken) +
                           " normals have zero length and are computed from the triangles");
    if (!readTangents(used, mesh))
        fillTangents(material, mesh);
    return mesh;
}

} // namespace

std::string gltfPrimitive(size_t mesh, size_t primitive)
{
    return gltfElement("meshes", mesh) + "." + gltfElement("primitives", primitive);
}

void takeGltfBudget(const GltfDocument& document, const std::string& element, uint64_t vertices,
                    uint64_t indices, GltfMeshBudget& budget)
{
    if (vertices > budget.vertices)
        document.failTooLarge(element,
                              fmt::format("brings the scene above {} vertices", maxSceneVertices));
    if (indices > budget.indices)
        document.failTooLarge(element,
                              fmt::format("brings the scene above {} indices", maxSceneIndices));
    budget.vertices -= vertices;
    budget.indices -= indices;
}

std::optional<Mesh> readGltfPrimitive(const GltfDocument& document, size_t mesh, size_t primitive,
                                      const Material& material, const GltfPose& pose,
                                      GltfMeshBudget& budget)
{
    PrimitiveReader reader(document, document.model.meshes[mesh].primitives[primitive],
                           gltfPrimitive(mesh, primitive), pose, budget);
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
