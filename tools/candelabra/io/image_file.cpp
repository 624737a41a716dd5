// SPDX-License-Identifier: Apache-2.0
#include "io/image_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/interrupts.h"

namespace candelabra::app
{

namespace
{

// A new file. The destructor closes it, and removes it unless keep() was called. If a signal ends
// the program meanwhile, the file is removed too.
class TemporaryFile
{
public:
    TemporaryFile(const std::string& path, mode_t mode)
        : path_(path),
          removed_(path),
          fd_(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, mode))
    {
        created_ = fd_ >= 0;
    }
    ~TemporaryFile()
    {
        if (fd_ >= 0)
            ::close(fd_);
        if (created_)
            unlink(path_.c_str());
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    int fd() const { return fd_; }
    bool close()
    {
        const int result = ::close(fd_);
        fd_ = -1;
        return result == 0;
    }
    void keep() { created_ = false; }

private:
    std::string path_;
    RemovedOnSignal removed_;
    int fd_;
    bool created_ = false;
};

} // namespace

void failWrite(const std::string& path, const std::string& reason)
{
    throw ImageError("cannot write " + path + ": " + reason);
}

void failRead(const std::string& path, const std::string& reason)
{
    throw ImageError("cannot read " + path + ": " + reason);
}

std::string temporaryName(const std::string& path)
{
    return path + ".part-" + std::to_string(getpid());
}

void writeFileAtomically(const std::string& path, std::span<const uint8_t> bytes)
{
    struct stat info = {};
    const bool exists = stat(path.c_str(), &info) == 0;
    if (exists && S_ISDIR(info.st_mode))
        failWrite(path, "is a directory");
    if (exists && !S_ISREG(info.st_mode)) // renaming would replace a device with a file
        failWrite(path, "is not a regular file");
    const std::string temporary = temporaryName(path);
    TemporaryFile file(temporary, exists ? info.st_mode & 0777 : 0666);
    if (file.fd() < 0)
        failWrite(path, std::strerror(errno));
    size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = write(file.fd(), bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            failWrite(path, std::strerror(errno));
        done += size_t(n);
    }
    if (!file.close() || std::rename(temporary.c_str(), path.c_str()) != 0)
        failWrite(path, std::strerror(errno));
    file.keep();
}

std::string writeRefusal(const std::string& path)
{
    const TemporaryFile file(temporaryName(path), 0600); // the destructor removes it
    return file.fd() < 0 ? std::strerror(errno) : "";
}

std::vector<uint8_t> readImageFile(const std::string& path)
{
    const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat info = {};
    const bool usable = fd >= 0 && fstat(fd, &info) == 0;
    const int openError = errno;
    const auto failAndClose = [&](const std::string& reason) {
        if (fd >= 0)
            close(fd);
        failRead(path, reason);
    };
    if (!usable)
        failAndClose(std::strerror(openError));
    if (!S_ISREG(info.st_mode))
        failAndClose("is not a regular file");
    if (info.st_size > UINT32_MAX)
        failAndClose("is larger than 4 GiB");
    std::vector<uint8_t> bytes(size_t(info.st_size));
    size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = read(fd, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            failAndClose(n < 0 ? std::strerror(errno) : "became shorter while it was read");
        done += size_t(n);
    }
    close(fd);
    if (std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size())
            .starts_with(lfsPointerStart))
        failRead(path, std::string(lfsPointerText));
    return bytes;
}

void requireImage(const std::string& path, const Image& image)
{
    const bool hasSize = image.width >= 1 && image.width <= maxImageSize && image.height >= 1 &&
                         image.height <= maxImageSize;
    const bool hasChannels = image.channels == 1 || image.channels == 3;
    if (!hasSize || !hasChannels ||
        image.pixels.size() != size_t{image.width} * image.height * image.channels)
        failWrite(path, "the image cannot have " + std::to_string(image.width) + " x " +
                            std::to_string(image.height) + " pixels of " +
                            std::to_string(image.channels) + " channels in " +
                            std::to_string(image.pixels.size()) + " values");
}

} // namespace candelabra::app
