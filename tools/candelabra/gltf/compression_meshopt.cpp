// SPDX-License-Identifier: Apache-2.0
// Buffer views that are compressed by the codecs of meshoptimizer.
#include "gltf/document.h"

#include <meshoptimizer.h>

#include "scene/json_value.h"

namespace candelabra::app
{

namespace
{

// No codec of meshoptimizer's version 0 makes data smaller than by this factor: the smallest code
// of a vertex buffer is 2 bits for 16 bytes.
constexpr uint64_t mostCompression = 64;
// All decompressed views together may have as many bytes as a file.
constexpr uint64_t maxDecompressedBytes = uint64_t{1} << 32;

struct CompressedView {
    const JsonValue& source;
    std::span<const uint8_t> bytes;
    uint64_t count = 0, stride = 0;
    std::string mode, filter;
};

// The codecs and filters demand these sizes without checking them.
void checkSizes(const CompressedView& view)
{
    const auto demand = [&](bool isRight, const std::string& what) {
        if (!isRight)
            view.source.fail(what);
    };
    const uint64_t stride = view.stride;
    if (view.mode == "ATTRIBUTES") {
        demand(stride % 4 == 0, "byteStride of ATTRIBUTES must be a multiple of 4");
    } else {
        demand(stride == 2 || stride == 4, "byteStride of " + view.mode + " must be 2 or 4");
        demand(view.mode != "TRIANGLES" || view.count % 3 == 0,
               "count of TRIANGLES must be a multiple of 3");
        demand(view.filter == "NONE", "filter must be NONE for " + view.mode);
    }
    demand(view.filter != "OCTAHEDRAL" || stride == 4 || stride == 8,
           "byteStride must be 4 or 8 for the filter OCTAHEDRAL");
    demand(view.filter != "QUATERNION" || stride == 8,
           "byteStride must be 8 for the filter QUATERNION");
    const uint64_t size = view.count * stride;
    demand(size / mostCompression <= view.bytes.size(),
           "claims " + std::to_string(size) + " bytes, too many for the " +
               std::to_string(view.bytes.size()) + " bytes that they are compressed to");
}

std::vector<uint8_t> decompress(const CompressedView& view)
{
    const uint64_t count = view.count, stride = view.stride;
    std::vector<uint8_t> out(count * stride);
    const unsigned char* data = view.bytes.data();
    const size_t size = view.bytes.size();
    const int failure = view.mode == "ATTRIBUTES"
                            ? meshopt_decodeVertexBuffer(out.data(), count, stride, data, size)
                        : view.mode == "TRIANGLES"
                            ? meshopt_decodeIndexBuffer(out.data(), count, stride, data, size)
                            : meshopt_decodeIndexSequence(out.data(), count, stride, data, size);
    // The first byte names the codec and its version. Version 1 of vertex buffers is newer than the
    // library; the codecs of indices have had both versions from the start.
    if (failure && data[0] == 0xa1)
        view.source.fail("is compressed by a newer version of the codec; export with "
                         "EXT_meshopt_compression (gltfpack -cc) or without compression");
    if (failure)
        view.source.fail("cannot be decompressed");
    if (view.filter == "OCTAHEDRAL")
        meshopt_decodeFilterOct(out.data(), count, stride);
    else if (view.filter == "QUATERNION")
        meshopt_decodeFilterQuat(out.data(), count, stride);
    else if (view.filter == "EXPONENTIAL")
        meshopt_decodeFilterExp(out.data(), count, stride);
    return out;
}

CompressedView compressedView(const GltfDocument& document, const JsonValue& source)
{
    const nlohmann::json& json = source.json();
    const auto buffer = json["buffer"].get<size_t>();
    const std::span<const uint8_t> bytes = document.buffers[buffer];
    const uint64_t offset = json.value("byteOffset", uint64_t{0});
    const uint64_t length = json["byteLength"].get<uint64_t>();
    if (offset > bytes.size() || length > bytes.size() - offset)
        source.fail("extends beyond buffers[" + std::to_string(buffer) + "] of " +
                    std::to_string(bytes.size()) + " bytes");
    return {.source = source,
            .bytes = bytes.subspan(offset, length),
            .count = json["count"].get<uint64_t>(),
            .stride = json["byteStride"].get<uint64_t>(),
            .mode = json["mode"].get<std::string>(),
            .filter = json.value("filter", "NONE")};
}

} // namespace

void decompressMeshopt(GltfDocument& document)
{
    const auto views = document.json.find("bufferViews");
    if (views == document.json.end())
        return;
    uint64_t total = 0;
    for (size_t i = 0; i < views->size(); ++i)
        for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
            const auto* extension = GltfDocument::extension((*views)[i], name);
            if (!extension || !document.isUsed("/bufferViews", i))
                continue;
            const JsonValue source(document.file, *extension,
                                   gltfElement("bufferViews", i) + ".extensions." + name);
            const CompressedView view = compressedView(document, source);
            checkSizes(view);
            total += view.count * view.stride;
            if (total > maxDecompressedBytes)
                source.fail("brings the decompressed data above 4 GiB");
            std::vector<uint8_t> bytes = decompress(view);
            tinygltf::BufferView& plain = document.model.bufferViews[i];
            plain.buffer = int(document.buffers.size());
            plain.byteOffset = 0;
            plain.byteLength = bytes.size();
            document.buffers.push_back(std::move(bytes));
            break;
        }
}

} // namespace candelabra::app
