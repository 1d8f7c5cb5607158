// PDO: which entries of a node's dictionary a process data object carries, and how it is sent (CiA 301, 7.2.2 and 7.5.2.35 ff.).
// In: what the node's dictionary says, or what is wanted; values, bytes. Out: the reads and writes that get it from and into a node, bytes
// of a frame, values. Bounded: 64 entries, 64 bits. Never sends, and never knows what an entry means.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gateway/protocols/canopen/abort.hpp"
#include "gateway/protocols/canopen/dictionary.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::canopen {

/// As the node sees it: it sends transmit PDOs.
enum class PdoDirection : std::uint8_t { transmit, receive };
inline constexpr std::uint16_t most_pdos = 512;  ///< of each direction
inline constexpr std::size_t most_mapped = 64, pdo_bits = 64;

struct MappedEntry {
    Address address;  ///< index 0001h..001Fh: a gap of that type, in receive PDOs
    std::uint8_t bits = 0;
    bool operator==(const MappedEntry&) const = default;
};
/// As subindex 1.. of a mapping object holds it.
[[nodiscard]] std::uint32_t mapping_word(const MappedEntry& entry) noexcept;
[[nodiscard]] MappedEntry mapped_entry(std::uint32_t word) noexcept;

using PdoMapping = std::vector<MappedEntry>;
[[nodiscard]] std::size_t bits_of(const PdoMapping& mapping) noexcept;
/// none, pdo_length (over 64 bits or 64 entries), or length (an entry without bits).
[[nodiscard]] Abort fault_of(const PdoMapping& mapping) noexcept;
/// The same, and whether a node with this dictionary has each entry (no_object, no_subindex), lets it be mapped that way (not_mappable) and
/// has as many bits (length).
[[nodiscard]] Abort fault_of(const PdoMapping& mapping, PdoDirection direction, const Dictionary& dictionary);

/// How much of a mapping was in a frame.
enum class PdoLength : std::uint8_t {
    fits,
    longer,  ///< the first bytes are taken, the rest is nobody's (a node reports 8220h)
    shorter  ///< nothing is taken (a node reports 8210h)
};
/// Raw bits of each entry, in order. `into` is left alone if the frame is shorter. A mapping with a fault counts as shorter.
[[nodiscard]] PdoLength unpack(const PdoMapping& mapping, std::span<const std::uint8_t> bytes, std::vector<std::uint64_t>& into);
/// Bytes of the frame; bits of a value above its entry's width are cut off, missing values are 0. Nothing for a mapping with a fault.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> pack(const PdoMapping& mapping, std::span<const std::uint64_t> values);
/// Raw bits as a signed number of that width (1..64).
[[nodiscard]] std::int64_t as_signed(std::uint64_t raw, std::uint8_t bits) noexcept;

/// The communication object, 1400h.. and 1800h...
struct PdoSettings {
    std::uint32_t id = 0;  ///< 11 or, if `extended`, 29 bits
    bool valid = false;    ///< in use
    bool extended = false;
    bool remote_allowed = false;  ///< of transmit PDOs
    std::uint8_t transmission =
        255;  ///< 0: at the next SYNC after a change, 1..240: every so many SYNCs, 252 and 253: asked for, 254 and 255: by event
    std::uint16_t inhibit_100us = 0;  ///< transmit: least time between two, in 100 us; 0: none
    std::uint16_t event_ms = 0;       ///< transmit: sent at least so often; receive: missed after; 0: not
    bool operator==(const PdoSettings&) const = default;
};
[[nodiscard]] std::uint32_t id_word(const PdoSettings& settings) noexcept;
void set_id_word(PdoSettings& settings, std::uint32_t word) noexcept;

struct Pdo {
    PdoDirection direction = PdoDirection::transmit;
    std::uint16_t number = 1;  ///< 1..512
    PdoSettings settings;
    PdoMapping mapping;
    bool operator==(const Pdo&) const = default;
};
/// Of its communication and of its mapping object.
[[nodiscard]] std::uint16_t settings_index(PdoDirection direction, std::uint16_t number) noexcept;
[[nodiscard]] std::uint16_t mapping_index(PdoDirection direction, std::uint16_t number) noexcept;

struct SdoWrite {
    Address address;
    std::vector<std::uint8_t> bytes;
    bool operator==(const SdoWrite&) const = default;
};
/// The writes that bring it into a node, in the order that the standard asks for: out of use, mapping cleared, filled, counted, in use
/// again. Inhibit and event time are written only if they are not 0: nodes need not have them. Nothing for a mapping with a fault.
[[nodiscard]] std::vector<SdoWrite> writes_of(const Pdo& pdo);

/// Reads a PDO out of a node's dictionary, one entry after the other.
class PdoReader {
public:
    PdoReader(PdoDirection direction, std::uint16_t number) noexcept;
    /// The entry to be read now; nothing: it is over.
    [[nodiscard]] std::optional<Address> next() const noexcept;
    /// What that read brought.
    void on_value(std::span<const std::uint8_t> bytes);
    /// It was refused. Of what a node need not have (inhibit and event time) nothing follows, of other entries that the PDO cannot be read.
    void on_refused(Abort why);
    /// none, while it goes on or when it is done; otherwise why there is no PDO.
    [[nodiscard]] Abort fault() const noexcept { return fault_; }
    [[nodiscard]] const Pdo& pdo() const noexcept { return pdo_; }

private:
    enum class Step : std::uint8_t { id, transmission, inhibit, event, count, entries, over };
    void fail(Abort why) noexcept;
    Pdo pdo_;
    Step step_ = Step::id;
    std::uint8_t count_ = 0;
    Abort fault_ = Abort::none;
};
/// The same from a dictionary at hand; `fault` says why there is none.
[[nodiscard]] std::optional<Pdo> pdo_of(Dictionary& dictionary, PdoDirection direction, std::uint16_t number, Abort& fault);

}  // namespace axisgate::canopen
