// DCF writer: writes a description with the values of one device as CiA 306-1 defines it, so that `read_eds` reads the same again.
// The text has CR LF line ends; values that had to be left out are reported in words.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "gateway/core/text.hpp"
#include "gateway/protocols/canopen/eds.hpp"

namespace axisgate::canopen {
namespace {

/// Whether the text is one line without blanks at its ends: the file format cannot hold any other.
bool is_line(std::string_view text) {
    return std::ranges::none_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }) &&
           trimmed(text).size() == text.size();
}
std::string as_line(std::string_view text) {
    std::string t(text);
    std::ranges::replace_if(
        t, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
    return std::string(trimmed(t));
}

std::string text_of(DataType type, const EdsValue& v) {
    std::string number;
    if (const auto* n = std::get_if<std::int64_t>(&v.value)) {
        number = is_signed(type) ? fmt::format("{}", *n) : fmt::format("0x{:X}", *n);
    } else if (const auto* b = std::get_if<bool>(&v.value)) {
        number = *b ? "0x1" : "0x0";
    } else {
        number = axisgate::to_text(v.value);
    }
    return v.plus_node ? "$NODEID+" + number : number;
}

class Writer {
public:
    std::string take() { return std::move(out_); }
    void section(std::string_view name) { out_ += fmt::format("{}[{}]\r\n", out_.empty() ? "" : "\r\n", name); }
    void key(std::string_view name, std::string_view value) { out_ += fmt::format("{}={}\r\n", name, value); }
    void number(std::string_view name, std::uint64_t value) { key(name, fmt::format("{}", value)); }
    void hex(std::string_view name, std::uint64_t value) { key(name, fmt::format("0x{:X}", value)); }
    void value(std::string_view name, DataType type, const EdsValue& v) {
        if (v.given()) key(name, text_of(type, v));
    }

private:
    std::string out_;
};

void write_entry(Writer& w, const EdsEntry& e) {
    w.hex("DataType", static_cast<std::uint64_t>(e.type));
    w.key("AccessType", name_of(e.access));
    w.value("LowLimit", e.type, e.low);
    w.value("HighLimit", e.type, e.high);
    w.value("DefaultValue", e.type, e.fallback);
    w.number("PDOMapping", e.mappable ? 1 : 0);
    if (e.flags != 0) w.hex("ObjFlags", e.flags);
    w.value("ParameterValue", e.type, e.configured);
}

void write_list(Writer& w, std::string_view name, const Eds& eds, auto&& belongs) {
    std::vector<std::uint16_t> list;
    for (const auto& [index, object] : eds.objects) {
        if (belongs(index)) list.push_back(index);
    }
    w.section(name);
    w.number("SupportedObjects", list.size());
    for (std::size_t i = 0; i < list.size(); ++i)
        w.key(fmt::format("{}", i + 1), fmt::format("0x{:04X}", list[i]));
}

void write_head(Writer& w, const Eds& eds, const Commissioning& c, const DcfDate& made) {
    w.section("FileInfo");
    w.key("FileName", fmt::format("node{}.dcf", c.node));
    w.number("FileVersion", 1);
    w.number("FileRevision", 0);
    w.key("EDSVersion", "4.0");
    w.key("Description", as_line(eds.product));
    w.key("CreationTime", as_line(made.time));
    w.key("CreationDate", as_line(made.date));
    w.key("CreatedBy", "axisgate");
    w.section("DeviceInfo");
    w.key("VendorName", as_line(eds.vendor));
    if (eds.vendor_number) w.hex("VendorNumber", *eds.vendor_number);
    w.key("ProductName", as_line(eds.product));
    if (eds.product_number) w.hex("ProductNumber", *eds.product_number);
    if (eds.revision_number) w.hex("RevisionNumber", *eds.revision_number);
    w.key("OrderCode", as_line(eds.order_code));
    for (const std::uint32_t rate : {10u, 20u, 50u, 125u, 250u, 500u, 800u, 1000u})
        w.number(fmt::format("BaudRate_{}", rate), std::ranges::count(eds.kbits, rate) > 0 ? 1 : 0);
    w.number("NrOfRXPDO", eds.receive_pdos);
    w.number("NrOfTXPDO", eds.transmit_pdos);
    w.section("DeviceComissioning");  // the standard spells it so
    w.number("NodeID", c.node);
    w.key("NodeName", as_line(c.node_name));
    if (c.kbit != 0) w.number("Baudrate", c.kbit);
}

}  // namespace

std::string write_dcf(const Eds& eds, const Commissioning& c, const std::map<Address, Value>& values, const DcfDate& made,
                      std::vector<std::string>& left_out) {
    Eds filled = eds;
    for (const auto& [address, value] : values) {
        const auto it = filled.entries.find(address);
        if (it == filled.entries.end()) {
            left_out.push_back(fmt::format("{} is not in the description", to_text(address)));
            continue;
        }
        EdsEntry& e = it->second;
        const auto bytes = encode(e.type, value);
        const auto* text = std::get_if<std::string>(&value);
        if (!bytes || e.type == DataType::domain || (text && !is_line(*text))) {
            left_out.push_back(fmt::format("{} ({}): a DCF cannot hold this value", to_text(address), name_of(e.type)));
            continue;
        }
        // The value as it will be read again: numbers in the form of the type; an empty text counts as no value.
        e.configured = {bytes->empty() ? Value{} : decode(e.type, *bytes).value_or(Value{}), false};
    }
    Writer w;
    write_head(w, filled, c, made);
    const auto mandatory = [](std::uint16_t i) { return i == 0x1000 || i == 0x1001 || i == 0x1018; };
    const auto maker = [](std::uint16_t i) { return i >= 0x2000 && i < 0x6000; };
    write_list(w, "MandatoryObjects", filled, mandatory);
    write_list(w, "OptionalObjects", filled, [&](std::uint16_t i) { return !mandatory(i) && !maker(i); });
    write_list(w, "ManufacturerObjects", filled, maker);
    auto at = filled.entries.begin();
    for (const auto& [index, object] : filled.objects) {
        while (at != filled.entries.end() && at->first.index < index)
            ++at;
        w.section(fmt::format("{:04X}", index));
        w.key("ParameterName", as_line(object.name));
        w.hex("ObjectType", static_cast<std::uint64_t>(object.shape));
        if (object.shape == EdsShape::variable || object.shape == EdsShape::domain) {
            if (at != filled.entries.end() && at->first == Address{index, 0}) write_entry(w, (at++)->second);
            continue;
        }
        auto end = at;
        std::size_t count = 0;
        for (; end != filled.entries.end() && end->first.index == index; ++end)
            ++count;
        w.number("SubNumber", count);
        for (; at != end; ++at) {
            w.section(fmt::format("{:04X}sub{:X}", index, at->first.sub));
            w.key("ParameterName", as_line(at->second.name));
            w.hex("ObjectType", at->second.type == DataType::domain ? 2 : 7);
            write_entry(w, at->second);
        }
    }
    return w.take();
}

}  // namespace axisgate::canopen
