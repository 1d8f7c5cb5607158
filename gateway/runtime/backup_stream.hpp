// The bytes of a backup in order, from and to a file or a text, with one kind of fault for all operations. Only the requested part of a
// file is in memory; a new file is readable only by this user from its first moment.
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
        damaged,            ///< truncated, altered, or different from its checksums
        not_ours,           ///< not a backup
        newer,              ///< of a form that this program does not know
        passphrase_needed,  ///< it is sealed, and no passphrase was given
        passphrase_wrong,
        passphrase_unfit,  ///< too easy to guess
        cannot_read,       ///< a member, or the backup itself
        cannot_write       ///< no space, no permission, a failing disk
    };
    Kind kind = Kind::damaged;
    std::string text;  ///< the fault and its object; may name files of this machine if the kind is cannot_read or cannot_write
};
template <class T = void>
using BackupResult = tl::expected<T, BackupFault>;
[[nodiscard]] inline tl::unexpected<BackupFault> backup_fault(BackupFault::Kind kind, std::string text) {
    return tl::unexpected<BackupFault>(BackupFault{kind, std::move(text)});
}

class ByteSource {
public:
    virtual ~ByteSource() = default;
    /// Fills `into`; fewer bytes mean the end.
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
    /// A regular file; pipes are refused.
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
    /// Makes the file, replacing an older one, mode 0600; if root makes it, it belongs to the owner of its folder.
    [[nodiscard]] static BackupResult<std::unique_ptr<FileSink>> create(const std::string& path);
    ~FileSink() override;
    FileSink(const FileSink&) = delete;
    FileSink& operator=(const FileSink&) = delete;
    [[nodiscard]] BackupResult<> write(std::string_view bytes) override;
    /// Makes the file durable.
    [[nodiscard]] BackupResult<> finish();

private:
    FileSink(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
    int fd_;
    std::string path_;
};

}  // namespace axisgate
