// Header, key, chunks. The key and the tag that identifies it are two halves of the output of argon2id, so that trying passphrases has the
// same cost with either. Keys are wiped when they are not needed any more.
#include "gateway/runtime/sealed.hpp"

#include <fmt/core.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>

#include "gateway/services/access/secrets.hpp"

namespace axisgate {
namespace {
using Kind = BackupFault::Kind;
using Bytes = const unsigned char*;

constexpr std::size_t chunk_bytes = 65536, more_bytes = crypto_secretstream_xchacha20poly1305_ABYTES;
constexpr std::size_t salt_bytes = crypto_pwhash_argon2id_SALTBYTES, tag_bytes = 16, check_bytes = 16;
constexpr std::size_t stream_bytes = crypto_secretstream_xchacha20poly1305_HEADERBYTES;
constexpr std::size_t version_at = 16, passes_at = 17, memory_at = 18, salt_at = 22, tag_at = salt_at + salt_bytes;
constexpr std::size_t stream_at = tag_at + tag_bytes, check_at = stream_at + stream_bytes, header_bytes = check_at + check_bytes;
constexpr unsigned char this_version = 1, most_passes = 10;
constexpr std::uint32_t least_memory_kib = 8, most_memory_kib = 262144;
using SealHeader = std::array<unsigned char, header_bytes>;

/// libsodium must be initialized once to choose its implementations; the call is safe from several threads.
void sodium_ready() { [[maybe_unused]] static const bool good = sodium_init() >= 0; }

struct SealKey {
    std::array<unsigned char, crypto_secretstream_xchacha20poly1305_KEYBYTES> key{};
    std::array<unsigned char, tag_bytes> tag{};
    SealKey() = default;
    SealKey(const SealKey&) = delete;
    SealKey& operator=(const SealKey&) = delete;
    ~SealKey() { sodium_memzero(key.data(), key.size()); }
    /// Returns false if there is not enough memory.
    [[nodiscard]] bool derive(const std::string& passphrase, const SealHeader& h) {
        std::uint32_t kib = 0;
        for (std::size_t i = 4; i-- > 0;)
            kib = kib << 8 | h[memory_at + i];
        std::array<unsigned char, crypto_kdf_KEYBYTES> master{};
        const bool good = crypto_pwhash(master.data(), master.size(), passphrase.data(), passphrase.size(), h.data() + salt_at,
                                        h[passes_at], std::size_t{kib} * 1024, crypto_pwhash_ALG_ARGON2ID13) == 0 &&
                          crypto_kdf_derive_from_key(key.data(), key.size(), 1, "axgseal1", master.data()) == 0 &&
                          crypto_kdf_derive_from_key(tag.data(), tag.size(), 2, "axgseal1", master.data()) == 0;
        sodium_memzero(master.data(), master.size());
        return good;
    }
};

std::array<unsigned char, check_bytes> check_of(const SealHeader& h) {
    std::array<unsigned char, check_bytes> sum{};
    (void)crypto_generichash(sum.data(), sum.size(), h.data(), check_at, nullptr, 0);
    return sum;
}

tl::unexpected<BackupFault> no_memory() {
    return backup_fault(Kind::cannot_write, "there is no memory for the key of the passphrase: 64 MiB are needed for a moment");
}
}  // namespace

std::string passphrase_fault(std::string_view passphrase) {
    std::string fault = password_fault(passphrase, {});
    constexpr std::string_view word = "password";
    for (std::size_t at = fault.find(word); at != std::string::npos; at = fault.find(word, at))
        fault.replace(at, word.size(), "passphrase");
    return fault;
}

struct Sealer::State {
    crypto_secretstream_xchacha20poly1305_state stream{};
    SealHeader header{};
    bool first = true;
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { sodium_memzero(&stream, sizeof stream); }
};

Sealer::Sealer(ByteSink& to, std::unique_ptr<State> state) : to_(to), state_(std::move(state)) {}
Sealer::~Sealer() = default;

BackupResult<std::unique_ptr<Sealer>> Sealer::begin(ByteSink& to, const std::string& passphrase, SealCost cost) {
    sodium_ready();
    if (const std::string fault = passphrase_fault(passphrase); !fault.empty()) return backup_fault(Kind::passphrase_unfit, fault);
    auto state = std::make_unique<State>();
    SealHeader& h = state->header;
    std::memcpy(h.data(), sealed_magic.data(), sealed_magic.size());
    h[version_at] = this_version;
    h[passes_at] = cost.passes;
    for (std::size_t i = 0; i < 4; ++i)
        h[memory_at + i] = static_cast<unsigned char>(cost.memory_kib >> (8 * i));
    randombytes_buf(h.data() + salt_at, salt_bytes);
    SealKey key;
    if (!key.derive(passphrase, h)) return no_memory();
    std::ranges::copy(key.tag, h.begin() + tag_at);
    (void)crypto_secretstream_xchacha20poly1305_init_push(&state->stream, h.data() + stream_at, key.key.data());
    std::ranges::copy(check_of(h), h.begin() + check_at);
    if (auto r = to.write({reinterpret_cast<const char*>(h.data()), h.size()}); !r) return tl::unexpected(r.error());
    return std::unique_ptr<Sealer>(new Sealer(to, std::move(state)));
}

BackupResult<> Sealer::push(std::string_view chunk, bool last) {
    std::string out(chunk.size() + more_bytes, '\0');
    const bool first = std::exchange(state_->first, false);
    (void)crypto_secretstream_xchacha20poly1305_push(
        &state_->stream, reinterpret_cast<unsigned char*>(out.data()), nullptr, reinterpret_cast<Bytes>(chunk.data()), chunk.size(),
        first ? state_->header.data() : nullptr, first ? header_bytes : 0,
        last ? crypto_secretstream_xchacha20poly1305_TAG_FINAL : crypto_secretstream_xchacha20poly1305_TAG_MESSAGE);
    return to_.write(out);
}

BackupResult<> Sealer::write(std::string_view bytes) {
    while (!bytes.empty()) {
        if (waiting_.size() == chunk_bytes) {  // more data follow, so this is not the last one
            if (auto r = push(waiting_, false); !r) return r;
            waiting_.clear();
        }
        const std::size_t n = std::min(bytes.size(), chunk_bytes - waiting_.size());
        waiting_.append(bytes.substr(0, n));
        bytes.remove_prefix(n);
    }
    return {};
}

BackupResult<> Sealer::finish() {
    const std::string last = std::exchange(waiting_, {});
    return push(last, true);
}

struct Unsealer::State {
    crypto_secretstream_xchacha20poly1305_state stream{};
    SealHeader header{};
    bool first = true;
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { sodium_memzero(&stream, sizeof stream); }
};

Unsealer::Unsealer(ByteSource& from, std::unique_ptr<State> state) : from_(from), state_(std::move(state)) {}
Unsealer::~Unsealer() = default;

BackupResult<std::unique_ptr<Unsealer>> Unsealer::begin(ByteSource& from, const std::string& passphrase) {
    sodium_ready();
    auto state = std::make_unique<State>();
    SealHeader& h = state->header;
    const auto n = from.read({reinterpret_cast<char*>(h.data()), h.size()});
    if (!n) return tl::unexpected(n.error());
    if (*n > version_at && h[version_at] > this_version)
        return backup_fault(Kind::newer, "it was sealed by a newer axisgate than this one");
    if (*n < h.size() || !std::equal(sealed_magic.begin(), sealed_magic.end(), h.begin()) || h[version_at] != this_version ||
        !std::ranges::equal(check_of(h), std::span(h).subspan(check_at)))
        return backup_fault(Kind::damaged, "its beginning is damaged or cut short");
    std::uint32_t kib = 0;
    for (std::size_t i = 4; i-- > 0;)
        kib = kib << 8 | h[memory_at + i];
    if (h[passes_at] < 1 || h[passes_at] > most_passes || kib < least_memory_kib || kib > most_memory_kib)
        return backup_fault(Kind::damaged, "its beginning asks for more memory or time than any axisgate does");
    if (passphrase.empty()) return backup_fault(Kind::passphrase_needed, "it is sealed, and no passphrase was given");
    if (passphrase.size() > most_passphrase_bytes) return backup_fault(Kind::passphrase_wrong, "the passphrase is wrong");
    SealKey key;
    if (!key.derive(passphrase, h)) return no_memory();
    if (sodium_memcmp(key.tag.data(), h.data() + tag_at, tag_bytes) != 0)
        return backup_fault(Kind::passphrase_wrong, "the passphrase is wrong");
    if (crypto_secretstream_xchacha20poly1305_init_pull(&state->stream, h.data() + stream_at, key.key.data()) != 0)
        return backup_fault(Kind::damaged, "its beginning is damaged");
    return std::unique_ptr<Unsealer>(new Unsealer(from, std::move(state)));
}

BackupResult<> Unsealer::pull() {
    std::string sealed(chunk_bytes + more_bytes, '\0');
    const auto n = from_.read(sealed);
    if (!n) return tl::unexpected(n.error());
    if (*n < more_bytes) return backup_fault(Kind::damaged, "it is cut short");
    chunk_.assign(*n - more_bytes, '\0');
    at_ = 0;
    unsigned char tag = 0;
    const bool first = std::exchange(state_->first, false);
    if (crypto_secretstream_xchacha20poly1305_pull(&state_->stream, reinterpret_cast<unsigned char*>(chunk_.data()), nullptr, &tag,
                                                   reinterpret_cast<Bytes>(sealed.data()), *n, first ? state_->header.data() : nullptr,
                                                   first ? header_bytes : 0) != 0) {
        chunk_.clear();
        return backup_fault(Kind::damaged, "it was altered after it was made, or is cut short");
    }
    if (tag != crypto_secretstream_xchacha20poly1305_TAG_FINAL) {
        if (*n < sealed.size()) return backup_fault(Kind::damaged, "it is cut short");
        return {};
    }
    ended_ = true;
    char more = 0;
    const auto after = from_.read({&more, 1});
    if (!after) return tl::unexpected(after.error());
    if (*after != 0) return backup_fault(Kind::damaged, "something was added to its end");
    return {};
}

BackupResult<std::size_t> Unsealer::read(std::span<char> into) {
    std::size_t done = 0;
    while (done < into.size()) {
        if (at_ == chunk_.size()) {
            if (ended_) break;
            if (auto r = pull(); !r) return tl::unexpected(r.error());
            continue;
        }
        const std::size_t n = std::min(into.size() - done, chunk_.size() - at_);
        std::copy_n(chunk_.begin() + static_cast<std::ptrdiff_t>(at_), n, into.begin() + static_cast<std::ptrdiff_t>(done));
        at_ += n;
        done += n;
    }
    return done;
}

}  // namespace axisgate
