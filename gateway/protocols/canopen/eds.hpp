// EDS and DCF (CiA 306-1): the manufacturer's description of a device as a text file, and the same with the values of one device.
// Text of any origin and size is read into the device and its objects. Makers' files have odd rows: each is left out, or read by a rule
// that cannot harm (an unknown access is read only, an unknown type is a row of bytes, limits that contradict each other are none), and a
// note with its line says what was done. Only a file without an object, or beyond a bound (as in Ini, and 50,000 entries), is a fault. A
// description can be written as a DCF and made into an object dictionary.
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

/// A number or text of the file: `$NODEID+0x180` is 0x180 with `plus_node` set.
struct EdsValue {
    Value value;
    bool plus_node = false;
    [[nodiscard]] bool given() const noexcept { return known(value); }
    [[nodiscard]] Value of(std::uint8_t node) const;
    bool operator==(const EdsValue&) const = default;
};

/// One subindex; a variable has subindex 0 only.
struct EdsEntry {
    std::string name;
    DataType type = DataType::unsigned32;
    EntryAccess access = EntryAccess::read_write;
    bool mappable = false;
    EdsValue low, high, fallback;  ///< LowLimit, HighLimit, DefaultValue
    EdsValue configured;           ///< ParameterValue in a DCF
    std::uint32_t flags = 0;       ///< ObjFlags: bit 0: not written by a download of the configuration; bit 1: not read by an upload
    std::size_t line = 0;          ///< line of its section; 0: the entry comes from CompactSubObj or was made by the program
    bool operator==(const EdsEntry& o) const;  ///< ignores the line
};
enum class EdsShape : std::uint8_t { variable = 7, array = 8, record = 9, domain = 2 };
struct EdsObject {
    std::string name;
    EdsShape shape = EdsShape::variable;
    bool operator==(const EdsObject&) const = default;
};

/// DeviceComissioning in a DCF (the standard spells it so).
struct Commissioning {
    std::uint8_t node = 0;  ///< 1..127; 0: not given
    std::string node_name;
    std::uint32_t kbit = 0;  ///< Baudrate; 0: not given
    bool operator==(const Commissioning&) const = default;
};

struct Eds {
    std::string vendor, product, order_code;
    std::optional<std::uint32_t> vendor_number, product_number, revision_number;  ///< in the form of object 1018h
    std::vector<std::uint32_t> kbits;                                             ///< supported bit rates, ascending
    std::uint32_t receive_pdos = 0, transmit_pdos = 0;
    std::map<std::uint16_t, EdsObject> objects;
    std::map<Address, EdsEntry> entries;
    std::optional<Commissioning> commissioning;
    bool operator==(const Eds&) const = default;

    static constexpr std::size_t most_entries = 50'000;
};

/// Nothing if there are faults. `notes` lists odd rows and what was done with them, 50 at most.
[[nodiscard]] std::optional<Eds> read_eds(std::string_view text, std::vector<FileFault>& faults, std::vector<FileFault>& notes);

/// Writes the description with these values as ParameterValue and with this commissioning as a DCF. A value that does not fit the type of
/// its entry, or that has no entry, is left out and reported. `made` is for FileInfo: "02:15PM" and "11-22-2026" as in the standard, or
/// empty.
struct DcfDate {
    std::string time, date;
};
[[nodiscard]] std::string write_dcf(const Eds& eds, const Commissioning& commissioning, const std::map<Address, Value>& values,
                                    const DcfDate& made, std::vector<std::string>& left_out);

/// The object dictionary of such a device with this node number: configured values, otherwise defaults, otherwise zero.
[[nodiscard]] Dictionary dictionary_of(const Eds& eds, std::uint8_t node);

}  // namespace axisgate::canopen
