// SPDX-License-Identifier: Apache-2.0
// Reads the elements of glTF accessors, which may have any component type and may be strided,
// normalised or sparse. TinyGLTF leaves this to its users. Internal to the glTF loader. All
// functions throw SceneError.
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
    int components() const { return components_; } // 1..4; 0 for matrices
    int componentType() const { return componentType_; }
    bool isFloat() const { return componentType_ == TINYGLTF_COMPONENT_TYPE_FLOAT; }
    bool isNormalized() const { return normalized_; }
    const std::string& element() const { return element_; } // "accessors[3]"

    // Element i; components that the accessor does not have are 0. Fails if a component is not
    // finite.
    glm::vec4 read(size_t i) const;
    // The first component of element i of an accessor of unsigned integers.
    uint32_t readUnsigned(size_t i) const;
    // True if the elements are MAT4 of floats. Then readMatrix(i) is element i; it fails if a
    // component is not finite.
    bool isMatrix4() const { return isMatrix4_; }
    glm::dmat4 readMatrix(size_t i) const;

private:
    struct Elements {
        const uint8_t* data = nullptr; // nullptr: all elements are zero
        size_t stride = 0;             // bytes
    };
    Elements locate(int view, uint64_t byteOffset, uint64_t count, size_t elementSize,
                    bool mayBeStrided) const;
    void readSparse(const tinygltf::Accessor& accessor);
    const uint8_t* find(size_t i) const;

    const GltfDocument& document_;
    std::string element_;
    size_t count_ = 0;
    int components_ = 0;
    bool isMatrix4_ = false;
    int componentType_ = 0;
    size_t componentSize_ = 0;
    bool normalized_ = false;
    Elements elements_;
    std::vector<uint32_t> sparseIndices_; // strictly increasing
    Elements sparseValues_;
};

// Opens an accessor that holds an attribute of vertices. Fails, with a message that names
// `element`, if it has another number of components, 32-bit integers, or not `vertexCount`
// elements; a vertexCount of 0 is any number.
GltfAccessor gltfVertexAttribute(const GltfDocument& document, const std::string& element,
                                 int index, int minComponents, int maxComponents,
                                 size_t vertexCount);

// The same for an attribute of colours, whose integers must be normalised.
GltfAccessor gltfColorAttribute(const GltfDocument& document, const std::string& element, int index,
                                int minComponents, int maxComponents, size_t vertexCount);

} // namespace candelabra::app
