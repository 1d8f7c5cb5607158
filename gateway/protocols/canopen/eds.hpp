// EDS and DCF (CiA 306-1): a maker's description of a device as a text file, and the same with the values of one device in it.
// In: text of any origin and size; values. Out: the device and its objects, or all faults with their lines; a DCF; an object dictionary.
// Bounded as Ini is, and to 50,000 entries. Never guesses a type, an access or a number: what cannot be read is a fault, what is odd and
// can be used all the same is a note.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/value.hpp"
#include "gateway/protocols/canopen/data_type.hpp"
#include "gateway/protocols/canopen/dictionary.hpp"
#include "gateway/protocols/canopen/ini.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::canopen {

/// A number or text of the file: `$NODEID+0x180` is 0x180 with `plus_node`.
struct EdsValue {
    Value value;
    bool plus_node = false;
    [[nodiscard]] bool given() const noexcept { return known(value); }
    [[nodiscard]] Value of(std::uint8_t node) const;
    bool operator==(const EdsValue&) const = default;
};

/// One subindex; a variable is its subindex 0.
struct EdsEntry {
    std::string name;
    DataType type = DataType::unsigned32;
    EntryAccess access = EntryAccess::read_write;
    bool mappable = false;
    EdsValue low, high, fallback;  ///< LowLimit, HighLimit, DefaultValue
    EdsValue configured;           ///< ParameterValue of a DCF
    std::uint32_t flags = 0;       ///< ObjFlags: bit 0 not written by a download of the configuration, bit 1 not read by an upload
    std::size_t line = 0;          ///< of its section; 0: it was made by CompactSubObj or by hand
    bool operator==(const EdsEntry& o) const;  ///< the line does not count
};
enum class EdsShape : std::uint8_t { variable = 7, array = 8, record = 9, domain = 2 };
struct EdsObject {
    std::string name;
    EdsShape shape = EdsShape::variable;
    bool operator==(const EdsObject&) const = default;
};

/// DeviceComissioning of a DCF (the standard writes it so).
struct Commissioning {
    std::uint8_t node = 0;  ///< 1..127
    std::string node_name;
    std::uint32_t kbit = 0;  ///< Baudrate; 0: not told
    bool operator==(const Commissioning&) const = default;
};

struct Eds {
    std::string vendor, product, order_code;
    std::optional<std::uint32_t> vendor_number, product_number, revision_number;  ///< as 1018h holds them
    std::vector<std::uint32_t> kbits;                                             ///< bit rates that the device has, rising
    std::uint32_t receive_pdos = 0, transmit_pdos = 0;
    std::map<std::uint16_t, EdsObject> objects;
    std::map<Address, EdsEntry> entries;
    std::optional<Commissioning> commissioning;
    bool operator==(const Eds&) const = default;

    static constexpr std::size_t most_entries = 50'000;
};

/// Nothing if there are faults. `notes`: what is odd.
[[nodiscard]] std::optional<Eds> read_eds(std::string_view text, std::vector<FileFault>& faults, std::vector<FileFault>& notes);

/// The description with these values as ParameterValue and this commissioning: a DCF. A value that is none of its entry's type, or for
/// which there is no entry, is left out and told. `made`: for FileInfo, "02:15PM" and "11-22-2026" in the standard's form, or empty.
struct DcfDate {
    std::string time, date;
};
[[nodiscard]] std::string write_dcf(const Eds& eds, const Commissioning& commissioning, const std::map<Address, Value>& values,
                                    const DcfDate& made, std::vector<std::string>& left_out);

/// The object dictionary of such a device with this node number: configured values, else defaults, else zero.
[[nodiscard]] Dictionary dictionary_of(const Eds& eds, std::uint8_t node);

}  // namespace axisgate::canopen
