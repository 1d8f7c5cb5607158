// PDO: which dictionary entries a process data object carries, and when it is sent (CiA 301, 7.2.2 and 7.5.2.35 ff.).
// A PDO is read from a node's dictionary or written into it, by lists of reads and writes that the owner carries out. Frames are packed
// and unpacked. A mapping has at most 64 entries and 64 bits. The meaning of the entries is not known here.
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

/// Seen from the node: it sends transmit PDOs.
enum class PdoDirection : std::uint8_t { transmit, receive };
inline constexpr std::uint16_t most_pdos = 512;  ///< in each direction
inline constexpr std::size_t most_mapped = 64, pdo_bits = 64;

struct MappedEntry {
    Address address;  ///< index 0001h..001Fh: a gap of that type, in receive PDOs
    std::uint8_t bits = 0;
    bool operator==(const MappedEntry&) const = default;
};
/// The value of a subindex from 1 of a mapping object.
[[nodiscard]] std::uint32_t mapping_word(const MappedEntry& entry) noexcept;
[[nodiscard]] MappedEntry mapped_entry(std::uint32_t word) noexcept;

using PdoMapping = std::vector<MappedEntry>;
[[nodiscard]] std::size_t bits_of(const PdoMapping& mapping) noexcept;
/// none, pdo_length (over 64 bits or 64 entries), or length (an entry without bits).
[[nodiscard]] Abort fault_of(const PdoMapping& mapping) noexcept;
/// The same, and also whether a node with this dictionary has each entry (no_object, no_subindex), permits its mapping (not_mappable) and
/// has as many bits (length).
[[nodiscard]] Abort fault_of(const PdoMapping& mapping, PdoDirection direction, const Dictionary& dictionary);

/// The length of a frame compared with its mapping.
enum class PdoLength : std::uint8_t {
    fits,
    longer,  ///< the first bytes are used, the rest is ignored (a node reports 8220h)
    shorter  ///< nothing is used (a node reports 8210h)
};
/// Returns the raw bits of each entry, in order. `into` is unchanged if the frame is shorter. A mapping with a fault counts as shorter.
[[nodiscard]] PdoLength unpack(const PdoMapping& mapping, std::span<const std::uint8_t> bytes, std::vector<std::uint64_t>& into);
/// The bytes of the frame; bits of a value above the width of its entry are cut off, missing values are 0. Nothing for a mapping with a
/// fault.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> pack(const PdoMapping& mapping, std::span<const std::uint64_t> values);
/// Raw bits of that width (1..64) as a signed number.
[[nodiscard]] std::int64_t as_signed(std::uint64_t raw, std::uint8_t bits) noexcept;

/// The communication object, 1400h.. and 1800h...
struct PdoSettings {
    std::uint32_t id = 0;  ///< 11 or, if `extended`, 29 bits
    bool valid = false;    ///< the PDO is in use
    bool extended = false;
    bool remote_allowed = false;  ///< may be requested by a remote frame (transmit PDOs)
    std::uint8_t transmission =
        255;  ///< 0: at the next SYNC after a change; 1..240: every n-th SYNC; 252 and 253: on request; 254 and 255: by event
    std::uint16_t inhibit_100us = 0;  ///< transmit: minimum time between two messages, in 100 us; 0: none
    std::uint16_t event_ms = 0;       ///< transmit: maximum time between two messages; receive: time after which a message is missed; 0:
                                      ///< off
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
/// The index of its communication object and of its mapping object.
[[nodiscard]] std::uint16_t settings_index(PdoDirection direction, std::uint16_t number) noexcept;
[[nodiscard]] std::uint16_t mapping_index(PdoDirection direction, std::uint16_t number) noexcept;

struct SdoWrite {
    Address address;
    std::vector<std::uint8_t> bytes;
    bool operator==(const SdoWrite&) const = default;
};
/// The writes that configure it in a node, in the order of the standard: disable, clear the mapping, fill it, set its count, enable. The
/// inhibit and event times are written only if they are not 0, since nodes need not have them. Nothing for a mapping with a fault.
[[nodiscard]] std::vector<SdoWrite> writes_of(const Pdo& pdo);

/// Reads a PDO from a node's dictionary, one entry after the other.
class PdoReader {
public:
    PdoReader(PdoDirection direction, std::uint16_t number) noexcept;
    /// The entry to read next; nothing when the reader has finished.
    [[nodiscard]] std::optional<Address> next() const noexcept;
    /// Takes the value of that entry.
    void on_value(std::span<const std::uint8_t> bytes);
    /// Takes a refusal. A refused optional entry (inhibit or event time) is ignored; any other means that the PDO cannot be read.
    void on_refused(Abort why);
    /// `none` while reading and after success; otherwise the reason why there is no PDO.
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
/// The same from a local dictionary; `fault` is set if there is no PDO.
[[nodiscard]] std::optional<Pdo> pdo_of(Dictionary& dictionary, PdoDirection direction, std::uint16_t number, Abort& fault);

}  // namespace axisgate::canopen
