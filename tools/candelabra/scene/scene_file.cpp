// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_file.h"

#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "scene/scene_error.h"

namespace candelabra::app
{

namespace
{

// nlohmann::json needs up to 16 bytes for two bytes of text, which is 2 GiB for the largest file
// that is accepted.
constexpr size_t maxJsonBytes = size_t{256} << 20;
// The nesting of glTF and scene files is about 8 levels deep; "extras" may add a few.
constexpr int maxJsonDepth = 64;

class FileDescriptor
{
public:
    explicit FileDescriptor(int fd) : fd_(fd) {}
    ~FileDescriptor()
    {
        if (fd_ >= 0)
            close(fd_);
    }
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;
    int get() const { return fd_; }

private:
    int fd_;
};

// The deepest nesting of arrays and objects. Brackets inside strings are ignored.
int jsonDepth(std::string_view text)
{
    int depth = 0, deepest = 0;
    bool inString = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (inString) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                inString = false;
        } else if (c == '"') {
            inString = true;
        } else if (c == '[' || c == '{') {
            deepest = std::max(deepest, ++depth);
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return deepest;
}

// Shortens "[json.exception.parse_error.101] parse error at line 1, ..." to "line 1, ...".
std::string jsonErrorText(const char* what)
{
    std::string_view text = what;
    const size_t bracket = text.find("] ");
    if (bracket != std::string_view::npos)
        text.remove_prefix(bracket + 2);
    for (const std::string_view prefix : {"parse error at ", "parse error: "})
        if (text.substr(0, prefix.size()) == prefix)
            text.remove_prefix(prefix.size());
    return printable(text, 300);
}

} // namespace

void failScene(const std::string& file, const std::string& element, const std::string& reason)
{
    throw SceneError(printable(file, 4096) + ": " + (element.empty() ? "" : element + ": ") +
                     reason);
}

std::string printable(std::string_view text, size_t maxLength)
{
    std::string out(text.substr(0, maxLength));
    for (char& c : out)
        if (c < 0x20 || c > 0x7e)
            c = '?';
    if (text.size() > maxLength)
        out += "...";
    return out;
}

bool hasExtension(const std::string& path, std::string_view extension)
{
    std::string own = std::filesystem::path(path).extension().string();
    for (char& c : own)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return own == extension;
}

std::vector<uint8_t> readSceneFile(const std::string& path)
{
    return readSceneFile(path, path, "");
}

std::vector<uint8_t> readSceneFile(const std::string& path, const std::string& file,
                                   const std::string& element)
{
    if (path.empty() || path.find('\0') != std::string::npos)
        failScene(file, element, "not a file name");
    // With O_NONBLOCK, opening a pipe does not wait for somebody who writes to it.
    const FileDescriptor input(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat info = {};
    if (input.get() < 0 || fstat(input.get(), &info) != 0)
        failScene(file, element, std::string("cannot be opened: ") + std::strerror(errno));
    if (S_ISDIR(info.st_mode))
        failScene(file, element, "is a directory, not a file");
    if (!S_ISREG(info.st_mode))
        failScene(file, element, "is not a regular file");
    if (info.st_size == 0)
        failScene(file, element, "is empty");
    if (info.st_size > std::numeric_limits<uint32_t>::max())
        failScene(file, element, "is larger than 4 GiB");

    std::vector<uint8_t> bytes(static_cast<size_t>(info.st_size));
    size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = read(input.get(), bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            failScene(file, element, std::string("cannot be read: ") + std::strerror(errno));
        if (n == 0)
            failScene(file, element, "became shorter while it was read");
        done += static_cast<size_t>(n);
    }
    return bytes;
}

nlohmann::json parseSceneJson(const std::string& file, std::string_view text)
{
    if (text.size() > maxJsonBytes)
        failScene(file, "", "has more than 256 MiB of JSON");
    if (jsonDepth(text) > maxJsonDepth)
        failScene(file, "", "nests JSON deeper than " + std::to_string(maxJsonDepth) + " levels");
    try {
        return nlohmann::json::parse(text.begin(), text.end());
    } catch (const nlohmann::json::exception& e) {
        failScene(file, "", "is not valid JSON: " + jsonErrorText(e.what()));
    }
}

} // namespace candelabra::app
