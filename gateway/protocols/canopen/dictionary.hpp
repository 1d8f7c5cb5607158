// Dictionary: the object dictionary of a node, used by its SDO server, its PDOs and its model: entries with type, access, bounds and bytes.
// Entries are added when it is built; afterwards they are read and written by index and subindex, with an abort code for every refusal.
// The owner gives an entry its effect with two hooks: one is called before a write takes effect, the other before a read. The dictionary
// does not grow after it was built.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "gateway/core/value.hpp"
#include "gateway/protocols/canopen/data_type.hpp"
#include "gateway/protocols/canopen/sdo_server.hpp"

namespace axisgate::canopen {

/// The spelling of EDS files: ro, wo, rw, rwr (rw, in a TPDO), rww (rw, in an RPDO), const.
enum class EntryAccess : std::uint8_t { read_only, write_only, read_write, read_write_input, read_write_output, constant };
[[nodiscard]] std::string_view name_of(EntryAccess access) noexcept;
[[nodiscard]] std::optional<EntryAccess> entry_access_named(std::string_view name) noexcept;  ///< in lower case
[[nodiscard]] constexpr bool can_read(EntryAccess a) noexcept { return a != EntryAccess::write_only; }
[[nodiscard]] constexpr bool can_write(EntryAccess a) noexcept { return a != EntryAccess::read_only && a != EntryAccess::constant; }

/// Which kind of PDO may carry an entry.
enum class Mappable : std::uint8_t { no, transmit, receive, both };

struct Entry {
    DataType type = DataType::unsigned32;
    EntryAccess access = EntryAccess::read_write;
    Mappable mappable = Mappable::no;
    std::string name{};
    std::vector<std::uint8_t> bytes{};          ///< as long as the type; any length for strings and domains
    std::optional<std::int64_t> low{}, high{};  ///< bounds of whole numbers
    std::size_t most_bytes = 0;                 ///< limit for strings and domains; 0: the limit of the server
};

class Dictionary : public SdoStore {
public:
    Dictionary() = default;
    Dictionary(const Dictionary& of);
    Dictionary(Dictionary&&) = default;  // entries keep their places
    Dictionary& operator=(const Dictionary& of) { return *this = Dictionary(of); }
    Dictionary& operator=(Dictionary&&) = default;
    /// Called when a write has passed the type and bounds checks, before it takes effect. Any result but `none` refuses it and changes
    /// nothing.
    using OnWrite = std::function<Abort(Address, std::span<const std::uint8_t>)>;
    /// Called before a read, so that the owner can update the entry. Any result but `none` refuses the read.
    using OnRead = std::function<Abort(Address)>;
    void on_write(OnWrite f) { on_write_ = std::move(f); }
    void on_read(OnRead f) { on_read_ = std::move(f); }

    /// Adds or replaces an entry. Bytes of a wrong length are replaced by zeros of the right length.
    void add(Address address, Entry entry);
    [[nodiscard]] const Entry* find(Address address) const;
    [[nodiscard]] bool has(std::uint16_t index) const;
    [[nodiscard]] const std::map<Address, Entry>& entries() const noexcept { return entries_; }

    /// A write by the owner: type and bounds are checked, access and hooks are not. False: there is no such entry, or the value does not
    /// fit.
    bool set(Address address, const Value& value);
    bool set_bytes(Address address, std::span<const std::uint8_t> bytes);
    /// Unknown if there is no such entry or its bytes are not a valid value.
    [[nodiscard]] Value value(Address address) const;
    /// The value of a whole number; nothing for other types.
    [[nodiscard]] std::optional<std::int64_t> integer(Address address) const;

    [[nodiscard]] Abort read(Address address, std::vector<std::uint8_t>& into) override;
    [[nodiscard]] Abort admits(Address address, std::optional<std::size_t> size) override;
    [[nodiscard]] Abort write(Address address, std::span<const std::uint8_t> bytes, bool sized) override;

private:
    [[nodiscard]] Abort missing(Address address) const;
    [[nodiscard]] static Abort fits(const Entry& entry, std::span<const std::uint8_t> bytes);
    [[nodiscard]] Entry* at(Address address) const;
    std::map<Address, Entry> entries_;
    std::unordered_map<std::uint32_t, Entry*> places_;  // the same entries in a hash table, for look-ups with every PDO: faster than a tree
                                                        // with hundreds of entries
    OnWrite on_write_;
    OnRead on_read_;
};

}  // namespace axisgate::canopen
