// A stream of bytes that can be read or altered only with a passphrase: argon2id and secretstream of libsodium. A wrong passphrase and a
// damaged file are distinguished, and no byte of an unauthenticated chunk is passed on.
//
// Form, numbers little-endian: "AXISGATE-SEALED\n"; version (1 byte, 1); argon2id's passes (1 byte) and memory in KiB (4 bytes); salt (16);
// a tag that identifies the passphrase (16), derived beside the key and independent of it; secretstream's header (24); BLAKE2b-128 of all
// this (16). Then chunks of 64 KiB, each with 17 additional bytes; the last one, marked final, may be shorter. The first chunk
// authenticates the header as well.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/runtime/backup_stream.hpp"

namespace axisgate {

inline constexpr std::string_view sealed_magic = "AXISGATE-SEALED\n";
inline constexpr std::size_t most_passphrase_bytes = 1024;

/// Empty if it is good enough for sealing, by the rules of passwords; otherwise the reason.
[[nodiscard]] std::string passphrase_fault(std::string_view passphrase);

/// Of argon2id. A file contains the values with which it was made.
struct SealCost {
    std::uint8_t passes = 3;           ///< 1..10
    std::uint32_t memory_kib = 65536;  ///< 8..262144
};

class Sealer final : public ByteSink {
public:
    /// Takes 0.1 to 1 s and 64 MiB for the key, unless a test makes it cheaper. `to` must outlive it.
    [[nodiscard]] static BackupResult<std::unique_ptr<Sealer>> begin(ByteSink& to, const std::string& passphrase, SealCost cost = {});
    ~Sealer() override;
    Sealer(const Sealer&) = delete;
    Sealer& operator=(const Sealer&) = delete;
    [[nodiscard]] BackupResult<> write(std::string_view bytes) override;
    /// Writes the final chunk, without which the file cannot be opened.
    [[nodiscard]] BackupResult<> finish();

private:
    struct State;
    Sealer(ByteSink& to, std::unique_ptr<State> state);
    [[nodiscard]] BackupResult<> push(std::string_view chunk, bool last);
    ByteSink& to_;
    std::unique_ptr<State> state_;
    std::string waiting_;
};

class Unsealer final : public ByteSource {
public:
    /// Reads the header. A file that requires more than 256 MiB or 10 passes is refused before anything is computed.
    [[nodiscard]] static BackupResult<std::unique_ptr<Unsealer>> begin(ByteSource& from, const std::string& passphrase);
    ~Unsealer() override;
    Unsealer(const Unsealer&) = delete;
    Unsealer& operator=(const Unsealer&) = delete;
    /// The end is reported only after the final chunk with nothing behind it.
    [[nodiscard]] BackupResult<std::size_t> read(std::span<char> into) override;

private:
    struct State;
    Unsealer(ByteSource& from, std::unique_ptr<State> state);
    [[nodiscard]] BackupResult<> pull();
    ByteSource& from_;
    std::unique_ptr<State> state_;
    std::string chunk_;
    std::size_t at_ = 0;  ///< of chunk_, the number of bytes passed on
    bool ended_ = false;
};

}  // namespace axisgate
