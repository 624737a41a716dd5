// SPDX-License-Identifier: Apache-2.0
// The host's stalk: a cone that a compute shader bends, as others skin a mesh.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "host.hpp"

// What the host has in any case: a mesh.
struct Vertex {
    glm::vec3 position, normal;
};
struct Mesh {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
};

Mesh straightStalk();

class StalkBender
{
public:
    // `vertices`: with room for those of straightStalk(), usage STORAGE_BUFFER.
    StalkBender(const Host& host, VkBuffer vertices);
    ~StalkBender();
    StalkBender(const StalkBender&) = delete;
    StalkBender& operator=(const StalkBender&) = delete;

    // Writes the vertices, for the stages that read them. `bend`: the angle between the ends.
    void record(VkCommandBuffer cmd, float bend) const;

private:
    VkDevice device_;
    VkDescriptorSetLayout setLayout_;
    VkDescriptorPool pool_;
    VkDescriptorSet set_;
    VkPipelineLayout layout_;
    VkPipeline pipeline_;
};
