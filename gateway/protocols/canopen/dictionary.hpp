// Dictionary: a node's object dictionary as its SDO server, its PDOs and its model see it: entries with type, access, bounds and bytes.
// In: entries when it is built; reads and writes by place. Out: bytes, values, abort codes. What an entry does is its owner's: a hook is
// asked before a write takes effect, another before a read. Never grows after it was built; as large as who builds it lets it be.
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

/// As EDS files write it: ro, wo, rw, rwr (rw, in a TPDO), rww (rw, in an RPDO), const.
enum class EntryAccess : std::uint8_t { read_only, write_only, read_write, read_write_input, read_write_output, constant };
[[nodiscard]] std::string_view name_of(EntryAccess access) noexcept;
[[nodiscard]] std::optional<EntryAccess> entry_access_named(std::string_view name) noexcept;  ///< in lower case
[[nodiscard]] constexpr bool can_read(EntryAccess a) noexcept { return a != EntryAccess::write_only; }
[[nodiscard]] constexpr bool can_write(EntryAccess a) noexcept { return a != EntryAccess::read_only && a != EntryAccess::constant; }

/// Which PDOs may carry an entry.
enum class Mappable : std::uint8_t { no, transmit, receive, both };

struct Entry {
    DataType type = DataType::unsigned32;
    EntryAccess access = EntryAccess::read_write;
    Mappable mappable = Mappable::no;
    std::string name{};
    std::vector<std::uint8_t> bytes{};          ///< of the type's length; strings and domains any
    std::optional<std::int64_t> low{}, high{};  ///< of whole numbers
    std::size_t most_bytes = 0;                 ///< of strings and domains; 0: as long as the server's limit
};

class Dictionary : public SdoStore {
public:
    Dictionary() = default;
    Dictionary(const Dictionary& of);
    Dictionary(Dictionary&&) = default;  // entries keep their places
    Dictionary& operator=(const Dictionary& of) { return *this = Dictionary(of); }
    Dictionary& operator=(Dictionary&&) = default;
    /// Asked when a write has passed type and bounds, before it takes effect. Anything but `none` refuses it, and nothing is changed.
    using OnWrite = std::function<Abort(Address, std::span<const std::uint8_t>)>;
    /// Called before a read, so that the owner can set what is asked for. Anything but `none` refuses the read.
    using OnRead = std::function<Abort(Address)>;
    void on_write(OnWrite f) { on_write_ = std::move(f); }
    void on_read(OnRead f) { on_read_ = std::move(f); }

    /// Adds or replaces. Bytes of a wrong length become zeros of the right one.
    void add(Address address, Entry entry);
    [[nodiscard]] const Entry* find(Address address) const;
    [[nodiscard]] bool has(std::uint16_t index) const;
    [[nodiscard]] const std::map<Address, Entry>& entries() const noexcept { return entries_; }

    /// The owner's own hand: type and bounds count, access and hooks do not. False: no such entry, or none of its values.
    bool set(Address address, const Value& value);
    bool set_bytes(Address address, std::span<const std::uint8_t> bytes);
    /// Unknown if there is no such entry or its bytes are no value.
    [[nodiscard]] Value value(Address address) const;
    /// Whole numbers; nothing for others.
    [[nodiscard]] std::optional<std::int64_t> integer(Address address) const;

    [[nodiscard]] Abort read(Address address, std::vector<std::uint8_t>& into) override;
    [[nodiscard]] Abort admits(Address address, std::optional<std::size_t> size) override;
    [[nodiscard]] Abort write(Address address, std::span<const std::uint8_t> bytes, bool sized) override;

private:
    [[nodiscard]] Abort missing(Address address) const;
    [[nodiscard]] static Abort fits(const Entry& entry, std::span<const std::uint8_t> bytes);
    [[nodiscard]] Entry* at(Address address) const;
    std::map<Address, Entry> entries_;
    std::unordered_map<std::uint32_t, Entry*> places_;  // the same, for who asks with every PDO: a tree of some hundred is ten looks
    OnWrite on_write_;
    OnRead on_read_;
};

}  // namespace axisgate::canopen
