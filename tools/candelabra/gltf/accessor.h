// SPDX-License-Identifier: Apache-2.0
// Reads elements of glTF accessors of any component type, strided, normalised and sparse.
// Internal to the glTF loader. Everything throws SceneError.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gltf/document.h"

namespace candelabra::app
{

class GltfAccessor
{
public:
    // Checks that every element lies inside its buffer. The document must outlive the accessor.
    GltfAccessor(const GltfDocument& document, int index);

    size_t count() const { return count_; }
    int components() const { return components_; } // 1..4, 0 for matrices
    int componentType() const { return componentType_; }
    bool isFloat() const { return componentType_ == TINYGLTF_COMPONENT_TYPE_FLOAT; }
    bool isNormalized() const { return normalized_; }
    const std::string& element() const { return element_; } // "accessors[3]"

    // Element i, missing components 0; fails when a component is not finite.
    glm::vec4 read(size_t i) const;
    // Component 0 of element i of an unsigned accessor.
    uint32_t readUnsigned(size_t i) const;

private:
    struct Elements {
        const uint8_t* data = nullptr; // NULL: all zero
        size_t stride = 0;
    };
    Elements locate(int view, uint64_t byteOffset, uint64_t count, size_t elementSize,
                    bool mayBeStrided) const;
    void readSparse(const tinygltf::Accessor& accessor);
    const uint8_t* find(size_t i) const;

    const GltfDocument& document_;
    std::string element_;
    size_t count_ = 0;
    int components_ = 0;
    int componentType_ = 0;
    size_t componentSize_ = 0;
    bool normalized_ = false;
    Elements elements_;
    std::vector<uint32_t> sparseIndices_; // increasing
    Elements sparseValues_;
};

} // namespace candelabra::app
