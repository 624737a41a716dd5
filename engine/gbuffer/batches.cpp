// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/batches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include <glm/gtc/type_ptr.hpp>

#include "gpu/double_single.h"

namespace candelabra::gbuffer
{
namespace
{

struct BatchKey {
    MeshVariant variant;
    bool doubleSided, mirrored;
    uint32_t textureSet;
    uint32_t mesh;

    auto state() const { return std::tuple(variant, doubleSided, mirrored, textureSet); }
    bool operator<(const BatchKey& o) const
    {
        return std::tuple_cat(state(), std::tuple(mesh)) <
               std::tuple_cat(o.state(), std::tuple(o.mesh));
    }
    bool operator==(const BatchKey& o) const { return state() == o.state() && mesh == o.mesh; }
};

struct Keyed {
    BatchKey key;
    uint32_t instance;
};

void checkIndex(const std::string& what, size_t index, size_t count, const char* list)
{
    if (index >= count)
        gpu::failArgument(what + " " + std::to_string(index) + " is not below the number of " +
                          list + ", " + std::to_string(count));
}

TextureSet textureSetOf(const Material& m)
{
    TextureSet set{};
    set[gpu::TEXTURE_BASE_COLOR] = m.baseColorTexture.texture;
    set[gpu::TEXTURE_METALLIC_ROUGHNESS] = m.metallicRoughnessTexture.texture;
    set[gpu::TEXTURE_NORMAL] = m.normalTexture.texture;
    set[gpu::TEXTURE_EMISSIVE] = m.emissiveTexture.texture;
    return set;
}

// Returns the index of each material's texture set, and fills `sets`.
std::vector<uint32_t> collectTextureSets(const GeometryDesc& desc, std::vector<TextureSet>& sets)
{
    TextureSet none;
    none.fill(-1);
    sets = {none};
    std::map<TextureSet, uint32_t> known{{none, 0}};
    std::vector<uint32_t> setOfMaterial;
    for (size_t i = 0; i < desc.materials.size(); ++i) {
        const TextureSet set = textureSetOf(desc.materials[i]);
        for (const int32_t texture : set)
            if (texture != -1)
                checkIndex("material " + std::to_string(i) + ": texture", size_t(texture),
                           desc.textures.size(), "textures");
        const auto [entry, isNew] = known.try_emplace(set, uint32_t(sets.size()));
        if (isNew)
            sets.push_back(set);
        setOfMaterial.push_back(entry->second);
    }
    return setOfMaterial;
}

MeshVariant variantOf(const Material& material, const PackedMesh& mesh)
{
    MeshVariant v{.emissive = material.isEmissive(),
                  .colored = mesh.colored,
                  .tintsF0 = mesh.colored && material.metalness != 0,
                  .coverage = material.coverage,
                  .unlit = material.unlit};
    const TextureSet set = textureSetOf(material);
    for (uint32_t i = 0; i < set.size(); ++i)
        if (set[i] != -1 && (i != gpu::TEXTURE_EMISSIVE || v.emissive))
            v.textures |= 1u << i;
    return v;
}

std::vector<Keyed> sortInstances(const GeometryDesc& desc, const std::vector<PackedMesh>& meshes,
                                 const std::vector<uint32_t>& setOfMaterial)
{
    std::vector<Keyed> sorted;
    sorted.reserve(desc.instances.size());
    for (uint32_t i = 0; i < desc.instances.size(); ++i) {
        const Instance& instance = desc.instances[i];
        const std::string name = "instance " + std::to_string(i);
        checkIndex(name + ": mesh", instance.mesh, meshes.size(), "meshes");
        checkIndex(name + ": material", instance.material, desc.materials.size(), "materials");
        if (meshes[instance.mesh].levels.empty())
            continue;
        const Material& material = desc.materials[instance.material];
        const uint32_t set = setOfMaterial[instance.material];
        const bool mirrored =
            glm::determinant(glm::dmat3(glm::make_mat4(instance.worldFromObject))) < 0;
        sorted.push_back({{variantOf(material, meshes[instance.mesh]), material.doubleSided,
                           mirrored, set, instance.mesh},
                          i});
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    return sorted;
}

gpu::InstanceRecord instanceRecord(const glm::dmat4& worldFromObject, uint32_t material)
{
    const gpu::DoubleSingle position(worldFromObject[3]);
    return {worldFromObject[0], position.hi.x, worldFromObject[1], position.hi.y,
            worldFromObject[2], position.hi.z, position.lo,        float(material)};
}

// Returns a length that no unit vector of object space exceeds in world space, m. It is the longest
// axis if the axes are perpendicular.
double largestScale(const glm::dmat4& worldFromObject)
{
    const glm::dmat3 m(worldFromObject);
    const glm::dmat3 gram = glm::transpose(m) * m;
    double squared = 0; // the largest sum of a row bounds the eigenvalues
    for (int row = 0; row < 3; ++row)
        squared = std::max(squared, std::abs(gram[0][row]) + std::abs(gram[1][row]) +
                                        std::abs(gram[2][row]));
    return std::sqrt(squared);
}

gpu::InstanceBounds instanceBounds(const glm::dmat4& worldFromObject, const PackedMesh& mesh)
{
    const glm::dvec3 low = glm::make_vec3(mesh.min), high = glm::make_vec3(mesh.max);
    const gpu::DoubleSingle center(worldFromObject * glm::dvec4((low + high) * 0.5, 1));
    const glm::dvec3 half = (high - low) * 0.5;
    glm::dvec3 extent(0);
    for (int column = 0; column < 3; ++column)
        extent += glm::abs(glm::dvec3(worldFromObject[column])) * half[column];
    // Rounding to float may shrink the box by 2^-24 (relative), and the vertex shader rounds by
    // about as much.
    constexpr double growth = 1 + 4 * std::numeric_limits<float>::epsilon();
    return {center.hi, center.lo, glm::vec3(extent * growth),
            float(largestScale(worldFromObject) * growth)};
}

// Appends the chunks of one batch of `count` instances that starts at instance `first`.
void addChunks(Batches& b, uint32_t first, uint32_t count, uint32_t firstCommand,
               const PackedMesh& mesh)
{
    const uint32_t firstChunk = uint32_t(b.chunks.size());
    gpu::Chunk chunk{.firstInstance = first,
                     .firstChunk = firstChunk,
                     .lastChunk = firstChunk + (count - 1) / gpu::CHUNK_SIZE,
                     .firstCommand = firstCommand,
                     .levelCount = uint32_t(mesh.levels.size())};
    for (size_t level = 1; level < mesh.levels.size(); ++level)
        chunk.levelErrors[level - 1] = mesh.levels[level].error;
    for (uint32_t done = 0; done < count; done += gpu::CHUNK_SIZE) {
        chunk.firstInstance = first + done;
        chunk.count = std::min(gpu::CHUNK_SIZE, count - done);
        b.chunks.push_back(chunk);
    }
}

// Appends the commands of one batch of `count` instances, which has the last `pieces` pieces. The
// first run of the commands is the last run of `b` if `sameState` says that it may continue.
void addCommands(Batches& b, const BatchKey& key, uint32_t count, const PackedMesh& mesh,
                 uint32_t pieces, bool sameState, uint32_t maxDraws)
{
    const bool tested = pieces != 0;
    const uint32_t endOfPieces = uint32_t(b.pieces.batchOfPiece().size());
    sameState = sameState && b.runs.back().tested == tested;
    for (const PackedLevel& level : mesh.levels) {
        if (!sameState || b.runs.back().commandCount == maxDraws)
            b.runs.push_back({key.variant, key.doubleSided, key.mirrored, key.textureSet,
                              uint32_t(b.commands.size()), 0, tested, endOfPieces - pieces, 0});
        sameState = true;
        b.runs.back().pieceCount += pieces;
        pieces = 0; // if a second run follows, the first one draws all pieces
        ++b.runs.back().commandCount;
        b.commands.push_back(
            {level.indexCount, 0, level.firstIndex, mesh.vertexOffset, b.visibleCount});
        b.visibleCount += count;
    }
}

// Plans the triangles of the batch of the last `count` instances. Returns its number of pieces.
uint32_t addPieces(Batches& b, const BatchKey& key, uint32_t count, const PackedMesh& mesh)
{
    gpu::PieceBatch batch{.firstCommand = uint32_t(b.commands.size())};
    for (size_t i = b.bounds.size() - count; i < b.bounds.size(); ++i)
        batch.scale = std::max(batch.scale, b.bounds[i].scale);
    // Counter-clockwise in an image with y down is a negative area.
    batch.front = key.doubleSided ? 0.f : key.mirrored ? 1.f : -1.f;
    return b.pieces.add(mesh, key.mesh, count, batch);
}

void setRow(gpu::MaterialRecord& record, uint32_t texture, const TextureRef& ref)
{
    record.uvRows[2 * texture] = glm::vec4(glm::make_vec3(ref.uRow), ref.uvSet ? 1.f : 0.f);
    record.uvRows[2 * texture + 1] = glm::vec4(glm::make_vec3(ref.vRow), 0.f);
}

} // namespace

Batches buildBatches(const GeometryDesc& desc, const std::vector<PackedMesh>& meshes,
                     uint32_t maxDraws, uint32_t corners)
{
    Batches b;
    b.pieces = TrianglePieces(corners);
    const std::vector<uint32_t> setOfMaterial = collectTextureSets(desc, b.textureSets);
    const std::vector<Keyed> sorted = sortInstances(desc, meshes, setOfMaterial);
    BatchKey last{};
    for (size_t begin = 0; begin < sorted.size();) {
        const BatchKey key = sorted[begin].key;
        size_t end = begin;
        while (end < sorted.size() && end - begin < maxBatchInstances && sorted[end].key == key)
            ++end;

        const PackedMesh& mesh = meshes[key.mesh];
        const uint32_t count = uint32_t(end - begin);
        addChunks(b, uint32_t(begin), count, uint32_t(b.commands.size()), mesh);
        for (; begin < end; ++begin) {
            const Instance& instance = desc.instances[sorted[begin].instance];
            const glm::dmat4 worldFromObject = glm::make_mat4(instance.worldFromObject);
            b.instances.push_back(instanceRecord(worldFromObject, instance.material));
            b.bounds.push_back(instanceBounds(worldFromObject, mesh));
        }
        addCommands(b, key, count, mesh, addPieces(b, key, count, mesh),
                    !b.runs.empty() && key.state() == last.state(), maxDraws);
        last = key;
    }
    return b;
}

std::vector<bool> texturedMeshes(const GeometryDesc& desc)
{
    std::vector<bool> textured(desc.meshes.size());
    for (const Instance& instance : desc.instances) {
        if (instance.mesh >= desc.meshes.size() || instance.material >= desc.materials.size())
            continue; // buildBatches refuses it
        const Material& material = desc.materials[instance.material];
        const TextureSet set = textureSetOf(material);
        const bool textures = std::any_of(set.begin(), set.end(), [](int32_t t) { return t >= 0; });
        textured[instance.mesh] =
            textured[instance.mesh] || material.coverage != Coverage::Full || textures;
    }
    return textured;
}

gpu::MaterialRecord materialRecord(const Material& m)
{
    gpu::MaterialRecord r{};
    r.baseColor = glm::make_vec3(m.baseColor);
    r.alpha = m.alpha;
    r.metalness = m.metalness;
    r.perceptualRoughness = m.perceptualRoughness;
    r.normalScale = m.normalTexture.texture == -1 ? 0.f : m.normalScale;
    r.alphaCutoff = m.alphaCutoff;
    r.dielectricF0 = glm::make_vec3(m.dielectricF0);
    r.diffuseWeight = m.diffuseWeight;
    r.emission = glm::make_vec3(m.emission);
    r.specularWeight = m.specularWeight;
    setRow(r, gpu::TEXTURE_BASE_COLOR, m.baseColorTexture);
    setRow(r, gpu::TEXTURE_METALLIC_ROUGHNESS, m.metallicRoughnessTexture);
    setRow(r, gpu::TEXTURE_NORMAL, m.normalTexture);
    setRow(r, gpu::TEXTURE_EMISSIVE, m.emissiveTexture);
    return r;
}

} // namespace candelabra::gbuffer
