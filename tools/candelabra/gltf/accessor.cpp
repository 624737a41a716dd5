// SPDX-License-Identifier: Apache-2.0
#include "gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace candelabra::app
{

namespace
{

// The largest number of elements of an accessor without a buffer view. Its elements are all zero,
// so the size of the file does not limit their number.
constexpr uint64_t maxZeroCount = uint64_t{1} << 24;

template <typename T>
T load(const uint8_t* p) // p need not be aligned
{
    T value;
    std::memcpy(&value, p, sizeof(T));
    return value;
}

// One component as a float. Normalised signed values map to [-1, 1], where the most negative one is
// clamped (glTF 2.0, section 3.6.2.2).
float component(const uint8_t* p, int type, bool normalized)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
        const float x = load<int8_t>(p);
        return normalized ? std::max(x / 127.0f, -1.0f) : x;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return normalized ? float(*p) / 255.0f : float(*p);
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
        const float x = load<int16_t>(p);
        return normalized ? std::max(x / 32767.0f, -1.0f) : x;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
        const float x = load<uint16_t>(p);
        return normalized ? x / 65535.0f : x;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return float(load<uint32_t>(p));
    default:
        return load<float>(p);
    }
}

uint32_t unsignedComponent(const uint8_t* p, int type)
{
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE)
        return *p;
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
        return load<uint16_t>(p);
    return load<uint32_t>(p);
}

} // namespace

GltfAccessor::GltfAccessor(const GltfDocument& document, int index)
    : document_(document), element_(gltfElement("accessors", size_t(index)))
{
    const tinygltf::Accessor& accessor = document.model.accessors[size_t(index)];
    const int components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
    const bool isMatrix = accessor.type > TINYGLTF_TYPE_VEC4 && accessor.type <= TINYGLTF_TYPE_MAT4;
    components_ = isMatrix ? 0 : components;
    componentType_ = accessor.componentType;
    isMatrix4_ = accessor.type == TINYGLTF_TYPE_MAT4 && isFloat();
    componentSize_ = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType)));
    normalized_ = accessor.normalized;
    const size_t elementSize = componentSize_ * size_t(components);
    if (accessor.bufferView >= 0)
        elements_ =
            locate(accessor.bufferView, accessor.byteOffset, accessor.count, elementSize, true);
    else if (accessor.count > maxZeroCount)
        document.fail(element_, "has " + std::to_string(accessor.count) +
                                    " elements and no bufferView; 16777216 are allowed");
    count_ = accessor.count;
    if (accessor.sparse.isSparse)
        readSparse(accessor);
}

GltfAccessor::Elements GltfAccessor::locate(int view, uint64_t byteOffset, uint64_t count,
                                            size_t elementSize, bool mayBeStrided) const
{
    const std::span<const uint8_t> bytes = document_.bufferView(view, element_);
    const size_t declared = document_.model.bufferViews[size_t(view)].byteStride;
    const size_t stride = mayBeStrided && declared ? declared : elementSize;
    if (stride < elementSize)
        document_.fail(element_, "has elements of " + std::to_string(elementSize) +
                                     " bytes, more than the byteStride of bufferViews[" +
                                     std::to_string(view) + "]");
    // count is compared first, so that the product below cannot overflow.
    if (byteOffset > bytes.size() || count > bytes.size() ||
        stride * (count - 1) + elementSize > bytes.size() - byteOffset)
        document_.fail(element_,
                       std::to_string(count) + " elements do not fit into the " +
                           std::to_string(bytes.size()) + " bytes of bufferViews[" +
                           std::to_string(view) + "]" +
                           (bytes.size() < document_.model.bufferViews[size_t(view)].byteLength
                                ? ", whose buffer is cut short"
                                : ""));
    return {bytes.data() + byteOffset, stride};
}

void GltfAccessor::readSparse(const tinygltf::Accessor& accessor)
{
    const auto& sparse = accessor.sparse;
    const auto count = uint64_t(sparse.count);
    const int type = sparse.indices.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        document_.fail(element_,
                       "sparse.indices.componentType must be unsigned, is " + std::to_string(type));
    const auto indexSize = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(type)));
    const Elements indices = locate(sparse.indices.bufferView, uint64_t(sparse.indices.byteOffset),
                                    count, indexSize, false);
    const int components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
    sparseValues_ = locate(sparse.values.bufferView, uint64_t(sparse.values.byteOffset), count,
                           componentSize_ * size_t(components), false);
    sparseIndices_.reserve(count);
    for (uint64_t k = 0; k < count; ++k) {
        const uint32_t i = unsignedComponent(indices.data + k * indices.stride, type);
        if (i >= count_)
            document_.fail(element_, "sparse index " + std::to_string(i) + " is beyond its " +
                                         std::to_string(count_) + " elements");
        if (k > 0 && i <= sparseIndices_.back())
            document_.fail(element_, "sparse indices do not increase strictly");
        sparseIndices_.push_back(i);
    }
}

const uint8_t* GltfAccessor::find(size_t i) const
{
    if (!sparseIndices_.empty()) {
        const auto it = std::ranges::lower_bound(sparseIndices_, i);
        if (it != sparseIndices_.end() && *it == i)
            return sparseValues_.data + size_t(it - sparseIndices_.begin()) * sparseValues_.stride;
    }
    return elements_.data ? elements_.data + i * elements_.stride : nullptr;
}

glm::vec4 GltfAccessor::read(size_t i) const
{
    glm::vec4 value{0};
    const uint8_t* p = find(i);
    for (int c = 0; p && c < components_; ++c) {
        value[c] = component(p + size_t(c) * componentSize_, componentType_, normalized_);
        if (!std::isfinite(value[c]))
            document_.fail(element_, "element " + std::to_string(i) + " is not finite");
    }
    return value;
}

uint32_t GltfAccessor::readUnsigned(size_t i) const
{
    const uint8_t* p = find(i);
    return p ? unsignedComponent(p, componentType_) : 0;
}

glm::dmat4 GltfAccessor::readMatrix(size_t i) const
{
    glm::dmat4 matrix{0};
    const uint8_t* p = find(i);
    for (int k = 0; p && k < 16; ++k) {
        matrix[k / 4][k % 4] = load<float>(p + size_t(k) * componentSize_);
        if (!std::isfinite(matrix[k / 4][k % 4]))
            document_.fail(element_, "element " + std::to_string(i) + " is not finite");
    }
    return matrix;
}

GltfAccessor gltfVertexAttribute(const GltfDocument& document, const std::string& element,
                                 int index, int minComponents, int maxComponents,
                                 size_t vertexCount)
{
    GltfAccessor accessor(document, index);
    if (accessor.components() < minComponents || accessor.components() > maxComponents)
        document.fail(element, accessor.element() + " has the wrong number of components");
    if (accessor.componentType() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        document.fail(element,
                      accessor.element() + " has 32-bit integers, which are not allowed here");
    if (vertexCount != 0 && accessor.count() != vertexCount)
        document.fail(element, accessor.element() + " has " + std::to_string(accessor.count()) +
                                   " elements, POSITION has " + std::to_string(vertexCount));
    return accessor;
}

GltfAccessor gltfColorAttribute(const GltfDocument& document, const std::string& element, int index,
                                int minComponents, int maxComponents, size_t vertexCount)
{
    GltfAccessor accessor =
        gltfVertexAttribute(document, element, index, minComponents, maxComponents, vertexCount);
    if (!accessor.isFloat() && !accessor.isNormalized())
        document.fail(element, accessor.element() + " has integers that are not normalized");
    return accessor;
}

} // namespace candelabra::app
