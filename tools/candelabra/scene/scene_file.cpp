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

// Says in a sentence what nlohmann::json says in its own words, such as "[json.exception.
// parse_error.101] parse error at line 1, column 5: syntax error while parsing value - unexpected
// end of input; expected ...".
std::string jsonErrorText(const nlohmann::json::exception& error)
{
    const std::string_view said = error.what();
    const auto has = [&](std::string_view text) { return said.find(text) != text.npos; };
    constexpr std::string_view overflow = "number overflow parsing ";
    if (const size_t at = said.find(overflow); at != said.npos)
        return "the number " + printable(said.substr(at + overflow.size()), 60) + " is too large";
    const size_t from = said.find("line "), to = said.find(':', from);
    const std::string place(from == said.npos ? "an unknown place" : said.substr(from, to - from));
    if (has("unexpected end of input") || has("missing closing quote"))
        return "it ends too early, at " + place + "; is the file cut short?";
    if (has("ill-formed UTF-8"))
        return place + " has bytes that are not UTF-8";
    for (const std::string_view before : {"last read: ", "unexpected "})
        if (const size_t at = said.find(before); at != said.npos) {
            const std::string_view rest = said.substr(at + before.size());
            return place + " is wrong, at " + printable(rest.substr(0, rest.find(';')), 60);
        }
    return place + " is wrong";
}

// Returns JSON with its NaN, Infinity and -Infinity in quotes. JSON has no such numbers, but some
// exporters write them: as texts they are values of the wrong type, which messages can name.
std::string withNonFiniteQuoted(std::string_view text)
{
    std::string out;
    bool inString = false;
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '"')
            inString = !inString;
        std::string_view word;
        for (const std::string_view one : {"NaN", "Infinity", "-Infinity"})
            if (!inString && text.substr(i).starts_with(one))
                word = one;
        if (!word.empty())
            out.append("\"").append(word).append("\"");
        else
            out += text[i];
        if (inString && text[i] == '\\' && i + 1 < text.size())
            out += text[i + 1];
        i += !word.empty() ? word.size() - 1 : inString && text[i] == '\\' ? 1 : 0;
    }
    return out;
}

} // namespace

std::string sceneMessage(const std::string& file, const std::string& element,
                         const std::string& reason)
{
    return printable(file, 4096) + ": " + (element.empty() ? "" : element + ": ") + reason;
}

void failScene(const std::string& file, const std::string& element, const std::string& reason)
{
    throw SceneError(sceneMessage(file, element, reason));
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
        c = char(std::tolower(static_cast<unsigned char>(c)));
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

    std::vector<uint8_t> bytes(size_t(info.st_size));
    size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = read(input.get(), bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            failScene(file, element, std::string("cannot be read: ") + std::strerror(errno));
        if (n == 0)
            failScene(file, element, "became shorter while it was read");
        done += size_t(n);
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
        if (const std::string quoted = withNonFiniteQuoted(text); quoted != text)
            return parseSceneJson(file, quoted);
        failScene(file, "", "is not valid JSON: " + jsonErrorText(e));
    }
}

} // namespace candelabra::app
