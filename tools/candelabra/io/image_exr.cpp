// SPDX-License-Identifier: Apache-2.0
// Reads and writes OpenEXR images block by block of rows, with OpenEXRCore, the C part of OpenEXR.
// The C++ classes of OpenEXR 3.1 are not used, because they trust files too much. They return
// uninitialised memory where a block decompresses to fewer bytes than it should, and allocate
// whatever memory an attribute of the header claims to need.
#include "io/image.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

#include <OpenEXR/openexr.h>
#include <fmt/format.h>

#include "io/chromaticities.h"
#include "io/image_file.h"

namespace candelabra::app
{

namespace
{

// An image that is being read from memory or written to memory.
struct ExrStream {
    exr_context_t context = nullptr;
    std::span<const uint8_t> input;
    std::vector<uint8_t> output;
    std::string error; // the first that OpenEXR reported

    ExrStream() = default;
    ~ExrStream() { exr_finish(&context); }
    ExrStream(const ExrStream&) = delete;
    ExrStream& operator=(const ExrStream&) = delete;

    std::string reasonOf(exr_result_t result) const
    {
        if (result == EXR_ERR_READ_IO)
            return "is cut short";
        return error.empty() ? exr_get_default_error_message(result) : error;
    }
};

// The most that OpenEXR may allocate at once. Its largest pieces hold blocks of rows: 32 rows of
// 16384 pixels with 128 channels of 32 bits fit. Damaged files ask for more.
constexpr size_t maxAllocation = size_t{1} << 28; // bytes

void* allocate(size_t bytes)
{
    return bytes <= maxAllocation ? std::malloc(bytes) : nullptr;
}

void keepError(exr_const_context_t context, exr_result_t, const char* message)
{
    void* stream = nullptr;
    if (!context || exr_get_user_data(context, &stream) != EXR_ERR_SUCCESS)
        return;
    std::string& error = static_cast<ExrStream*>(stream)->error;
    if (!error.empty())
        return;
    try { // exceptions must not pass through C code
        error = message;
    } catch (const std::bad_alloc&) {
        error.clear(); // reasonOf() then gives OpenEXR's text for the result
    }
}

int64_t sizeOfInput(exr_const_context_t, void* stream)
{
    return int64_t(static_cast<ExrStream*>(stream)->input.size());
}

// Returns how many of the bytes the input has.
int64_t readInput(exr_const_context_t, void* stream, void* buffer, uint64_t size, uint64_t offset,
                  exr_stream_error_func_ptr_t)
{
    const auto input = static_cast<ExrStream*>(stream)->input;
    const auto rest = input.subspan(std::min<uint64_t>(offset, input.size()));
    const auto bytes = rest.first(std::min<uint64_t>(size, rest.size()));
    if (!bytes.empty())
        std::memcpy(buffer, bytes.data(), bytes.size());
    return int64_t(bytes.size());
}

int64_t writeOutput(exr_const_context_t, void* stream, const void* buffer, uint64_t size,
                    uint64_t offset, exr_stream_error_func_ptr_t)
{
    std::vector<uint8_t>& output = static_cast<ExrStream*>(stream)->output;
    try { // exceptions must not pass through C code
        output.resize(std::max<size_t>(output.size(), offset + size));
    } catch (const std::bad_alloc&) {
        return -1;
    }
    if (size > 0)
        std::memcpy(&output[offset], buffer, size);
    return int64_t(size);
}

exr_context_initializer_t settings(ExrStream& stream)
{
    exr_context_initializer_t out = EXR_DEFAULT_CONTEXT_INITIALIZER;
    out.error_handler_fn = keepError;
    out.alloc_fn = allocate;
    out.free_fn = std::free;
    out.user_data = &stream;
    out.read_fn = readInput;
    out.size_fn = sizeOfInput;
    out.write_fn = writeOutput;
    // Without these flags OpenEXR fills in what is missing of the header and of the table of
    // blocks.
    out.flags = EXR_CONTEXT_FLAG_STRICT_HEADER | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return out;
}

// Returns where a channel lies in the pixels of color images, -1 for channels that they do not
// have.
int placeInColor(std::string_view channel)
{
    return channel == "R" ? 0 : channel == "G" ? 1 : channel == "B" ? 2 : -1;
}

class ExrWriter
{
public:
    explicit ExrWriter(const std::string& path) : path_(path) {}
    std::vector<uint8_t> encode(const Image& image);

private:
    void check(exr_result_t result) const
    {
        if (result != EXR_ERR_SUCCESS)
            failWrite(path_, "the EXR encoder failed: " + stream_.reasonOf(result));
    }
    void writeHeader(const Image& image);

    const std::string& path_;
    ExrStream stream_;
    struct Encoder : exr_encode_pipeline_t {
        Encoder() : exr_encode_pipeline_t(EXR_ENCODE_PIPELINE_INITIALIZER) {}
        ~Encoder() { exr_encoding_destroy(context, this); }
    } encoder_;
};

void ExrWriter::writeHeader(const Image& image)
{
    const exr_context_initializer_t with = settings(stream_);
    check(exr_start_write(&stream_.context, path_.c_str(), EXR_WRITE_FILE_DIRECTLY, &with));
    int part = 0;
    check(exr_add_part(stream_.context, nullptr, EXR_STORAGE_SCANLINE, &part));
    check(exr_initialize_required_attr_simple(stream_.context, part, int32_t(image.width),
                                              int32_t(image.height), EXR_COMPRESSION_ZIP));
    for (const char channel : std::string_view(image.channels == 3 ? "BGR" : "Y"))
        check(exr_add_channel(stream_.context, part, std::string(1, channel).c_str(),
                              EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
    check(exr_write_header(stream_.context));
}

std::vector<uint8_t> ExrWriter::encode(const Image& image)
{
    writeHeader(image);
    int32_t rows = 0; // in a block; the last may have fewer
    check(exr_get_scanlines_per_chunk(stream_.context, 0, &rows));
    const size_t pixelFloats = image.channels, rowFloats = pixelFloats * image.width;
    for (uint32_t y = 0; y < image.height; y += uint32_t(rows)) {
        exr_chunk_info_t block = {};
        check(exr_write_scanline_chunk_info(stream_.context, 0, int(y), &block));
        check(y == 0 ? exr_encoding_initialize(stream_.context, 0, &block, &encoder_)
                     : exr_encoding_update(stream_.context, 0, &block, &encoder_));
        for (int c = 0; c < encoder_.channel_count; ++c) {
            exr_coding_channel_info_t& channel = encoder_.channels[c];
            const int place = image.channels == 3 ? placeInColor(channel.channel_name) : 0;
            channel.encode_from_ptr =
                reinterpret_cast<const uint8_t*>(&image.pixels[y * rowFloats + size_t(place)]);
            channel.user_pixel_stride = int32_t(pixelFloats * sizeof(float));
            channel.user_line_stride = int32_t(rowFloats * sizeof(float));
        }
        check(exr_encoding_choose_default_routines(stream_.context, 0, &encoder_));
        check(exr_encoding_run(stream_.context, 0, &encoder_));
    }
    return std::move(stream_.output);
}

class ExrReader
{
public:
    ExrReader(const std::string& path, std::span<const uint8_t> bytes) : path_(path)
    {
        stream_.input = bytes;
    }
    Image read();

private:
    void check(exr_result_t result) const
    {
        if (result != EXR_ERR_SUCCESS)
            failRead(path_, stream_.reasonOf(result));
    }
    void readHeader();
    void readSize();
    void readChannels();
    void applyHeader();
    exr_chunk_info_t readBlockInfo(int y);
    void readBlock(const exr_chunk_info_t& block);
    // The place of a channel in the pixels of the image; -1: the channel is not read.
    int placeOf(std::string_view channel) const
    {
        return image_.channels == 3 ? placeInColor(channel) : channel == greyChannel_ ? 0 : -1;
    }

    const std::string& path_;
    ExrStream stream_;
    Image image_;
    exr_attr_box2i_t window_ = {};
    exr_compression_t compression_ = EXR_COMPRESSION_LAST_TYPE;
    std::string greyChannel_; // the one that is read, if the image is not in color
    uint32_t unread_ = 0;     // receives values of channels that are not read
    struct Decoder : exr_decode_pipeline_t {
        Decoder() : exr_decode_pipeline_t(EXR_DECODE_PIPELINE_INITIALIZER) {}
        ~Decoder() { exr_decoding_destroy(context, this); }
    } decoder_;
};

void ExrReader::readSize()
{
    check(exr_get_data_window(stream_.context, 0, &window_));
    const int64_t width = int64_t{window_.max.x} - window_.min.x + 1;
    const int64_t height = int64_t{window_.max.y} - window_.min.y + 1;
    if (width < 1 || width > maxImageSize || height < 1 || height > maxImageSize)
        failRead(path_, "its data window has " + std::to_string(width) + " x " +
                            std::to_string(height) + " pixels; 1 to " +
                            std::to_string(maxImageSize) + " a side can be read");
    image_.width = uint32_t(width);
    image_.height = uint32_t(height);
}

void ExrReader::readChannels()
{
    const exr_attr_chlist_t* list = nullptr;
    check(exr_get_channels(stream_.context, 0, &list));
    const std::span<const exr_attr_chlist_entry_t> channels(list->entries,
                                                            size_t(list->num_channels));
    const auto has = [&](std::string_view name) {
        return std::ranges::any_of(channels,
                                   [&](const auto& channel) { return channel.name.str == name; });
    };
    image_.channels = has("R") && has("G") && has("B") ? 3 : 1;
    if (image_.channels == 1)
        greyChannel_ = channels[0].name.str;
    for (const exr_attr_chlist_entry_t& channel : channels) {
        const std::string name = channel.name.str;
        if (channel.x_sampling != 1 || channel.y_sampling != 1)
            failRead(path_, "channel " + name + " is subsampled, which is not supported");
        if (channel.pixel_type == EXR_PIXEL_UINT && placeOf(name) >= 0)
            failRead(path_, "channel " + name + " has integers");
    }
}

void ExrReader::readHeader()
{
    const exr_context_initializer_t with = settings(stream_);
    if (exr_test_file_header(path_.c_str(), &with) != EXR_ERR_SUCCESS)
        failRead(path_, "is not an EXR file");
    check(exr_start_read(&stream_.context, path_.c_str(), &with));
    int parts = 0;
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    check(exr_get_count(stream_.context, &parts));
    check(exr_get_storage(stream_.context, 0, &storage));
    if (parts != 1 || storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED)
        failRead(path_, "is a multi-part or deep EXR file");
    if (storage != EXR_STORAGE_SCANLINE)
        failRead(path_, "is tiled, which is not supported");
    check(exr_get_compression(stream_.context, 0, &compression_));
    // OpenEXR 3.1.5 can write outside its memory while it decompresses damaged DWA blocks.
    if (compression_ > EXR_COMPRESSION_PIZ)
        failRead(path_, "has lossy compression (PXR24, B44 or DWA), which is not supported");
    readSize();
    readChannels();
}

exr_chunk_info_t ExrReader::readBlockInfo(int y)
{
    exr_chunk_info_t block = {};
    check(exr_read_scanline_chunk_info(stream_.context, 0, y, &block));
    // OpenEXR checks the size of compressed blocks when it decompresses them.
    if (compression_ == EXR_COMPRESSION_NONE && block.packed_size != block.unpacked_size)
        failRead(path_, "is damaged: a block of rows has " + std::to_string(block.packed_size) +
                            " bytes instead of " + std::to_string(block.unpacked_size));
    return block;
}

// Appends the rows of a block to the image.
void ExrReader::readBlock(const exr_chunk_info_t& block)
{
    const size_t first = image_.pixels.size(), rowFloats = size_t{image_.channels} * image_.width;
    image_.pixels.resize(first + rowFloats * size_t(block.height));
    for (int c = 0; c < decoder_.channel_count; ++c) {
        exr_coding_channel_info_t& channel = decoder_.channels[c];
        const int place = placeOf(channel.channel_name);
        // OpenEXR 3.1.5 crashes if one of three or four channels of halves is read and the others
        // have no pointer, so all of them get one.
        channel.decode_to_ptr = reinterpret_cast<uint8_t*>(&unread_);
        if (place < 0)
            continue;
        channel.decode_to_ptr = reinterpret_cast<uint8_t*>(&image_.pixels[first + size_t(place)]);
        channel.user_data_type = EXR_PIXEL_FLOAT; // halves are widened
        channel.user_bytes_per_element = sizeof(float);
        channel.user_pixel_stride = int32_t(image_.channels * sizeof(float));
        channel.user_line_stride = int32_t(rowFloats * sizeof(float));
    }
    check(exr_decoding_choose_default_routines(stream_.context, 0, &decoder_));
    check(exr_decoding_run(stream_.context, 0, &decoder_));
}

// Applies the attributes that say what the values are, or warns.
void ExrReader::applyHeader()
{
    exr_attr_chromaticities_t c = {};
    if (exr_attr_get_chromaticities(stream_.context, 0, "chromaticities", &c) == EXR_ERR_SUCCESS &&
        !convertToRec709(image_, {.red = {c.red_x, c.red_y},
                                  .green = {c.green_x, c.green_y},
                                  .blue = {c.blue_x, c.blue_y},
                                  .white = {c.white_x, c.white_y}}))
        image_.warnings.push_back(path_ + ": its chromaticities span no colours; its values are "
                                          "taken for Rec. 709");
    float white = 1;
    if (exr_attr_get_float(stream_.context, 0, "whiteLuminance", &white) == EXR_ERR_SUCCESS &&
        white != 1)
        image_.warnings.push_back(fmt::format(
            "{}: its header says that white (1, 1, 1) has {} cd/m^2 (whiteLuminance); its values "
            "are taken for cd/m^2",
            path_, white));
}

Image ExrReader::read()
{
    readHeader();
    int32_t rows = 0; // in a block; the last may have fewer
    check(exr_get_scanlines_per_chunk(stream_.context, 0, &rows));
    // The memory of the image grows with the blocks that the file has, because a short file may
    // claim to be a large image.
    for (int y = window_.min.y; y <= window_.max.y; y += rows) {
        const exr_chunk_info_t block = readBlockInfo(y);
        check(y == window_.min.y ? exr_decoding_initialize(stream_.context, 0, &block, &decoder_)
                                 : exr_decoding_update(stream_.context, 0, &block, &decoder_));
        readBlock(block);
    }
    applyHeader();
    return std::move(image_);
}

} // namespace

void saveExr(const std::string& path, const Image& image)
{
    requireImage(path, image);
    writeFileAtomically(path, ExrWriter(path).encode(image));
}

Image loadExr(const std::string& path)
{
    return ExrReader(path, readImageFile(path)).read();
}

} // namespace candelabra::app
