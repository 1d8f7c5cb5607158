// Backup stream: bytes of a backup in their order, from and to a file or a text, with one kind of fault for all that is done with them.
// In: paths, texts. Out: bytes, or a BackupFault. Never holds more of a file than it is asked for; a file that is made is readable by this
// user alone from its first moment.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace axisgate {

struct BackupFault {
    enum class Kind : std::uint8_t {
        damaged,            ///< cut short, altered, or not what its checksums say
        not_ours,           ///< no backup at all
        newer,              ///< of a form that this program does not know
        passphrase_needed,  ///< it is sealed, and none was given
        passphrase_wrong,
        passphrase_unfit,  ///< to seal with: too easily guessed
        cannot_read,       ///< a file that belongs into it, or the backup itself
        cannot_write       ///< no room, no right, a disk that fails
    };
    Kind kind = Kind::damaged;
    std::string text;  ///< what is wrong and with what; may name files of this machine if the kind is cannot_read or cannot_write
};
template <class T = void>
using BackupResult = tl::expected<T, BackupFault>;
[[nodiscard]] inline tl::unexpected<BackupFault> backup_fault(BackupFault::Kind kind, std::string text) {
    return tl::unexpected<BackupFault>(BackupFault{kind, std::move(text)});
}

class ByteSource {
public:
    virtual ~ByteSource() = default;
    /// Fills `into`; fewer bytes are the end.
    [[nodiscard]] virtual BackupResult<std::size_t> read(std::span<char> into) = 0;
};
class ByteSink {
public:
    virtual ~ByteSink() = default;
    [[nodiscard]] virtual BackupResult<> write(std::string_view bytes) = 0;
};

class TextSource final : public ByteSource {
public:
    explicit TextSource(std::string_view text) noexcept : text_(text) {}
    [[nodiscard]] BackupResult<std::size_t> read(std::span<char> into) override;

private:
    std::string_view text_;
};

class FileSource final : public ByteSource {
public:
    /// A regular file; a pipe is not waited for.
    [[nodiscard]] static BackupResult<std::unique_ptr<FileSource>> open(const std::string& path);
    ~FileSource() override;
    FileSource(const FileSource&) = delete;
    FileSource& operator=(const FileSource&) = delete;
    [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
    [[nodiscard]] BackupResult<std::size_t> read(std::span<char> into) override;

private:
    FileSource(int fd, std::string path, std::uint64_t size) : fd_(fd), path_(std::move(path)), size_(size) {}
    int fd_;
    std::string path_;
    std::uint64_t size_;
};

class FileSink final : public ByteSink {
public:
    /// Makes the file in the place of an older one, mode 0600; when root makes it, it belongs to the owner of the folder that it is in.
    [[nodiscard]] static BackupResult<std::unique_ptr<FileSink>> create(const std::string& path);
    ~FileSink() override;
    FileSink(const FileSink&) = delete;
    FileSink& operator=(const FileSink&) = delete;
    [[nodiscard]] BackupResult<> write(std::string_view bytes) override;
    /// On the disk.
    [[nodiscard]] BackupResult<> finish();

private:
    FileSink(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
    int fd_;
    std::string path_;
};

}  // namespace axisgate
