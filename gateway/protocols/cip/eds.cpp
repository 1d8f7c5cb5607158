// EDS: writes the sections in the order of the standard, with CR LF line ends and 7-bit characters. Each output is listed with its input.
#include "gateway/protocols/cip/eds.hpp"

#include <fmt/core.h>

#include <bit>
#include <cmath>
#include <iterator>
#include <map>

#include "gateway/protocols/cip/path.hpp"

namespace axisgate::cip {
namespace {
using Role = AssemblyInfo::Role;

/// A character beyond 7-bit ASCII becomes one question mark, for any number of bytes.
std::string plain(std::string_view text, std::size_t most) {
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (out.size() == most) break;
        if ((byte & 0xC0) == 0x80) continue;
        out += byte >= 0x7F ? '?' : byte < 0x20 ? ' ' : c == '"' || c == '\\' ? '\'' : c;
    }
    return '"' + out + '"';
}
std::string spelled(const Bytes& path) {
    std::string out;
    for (const std::uint8_t byte : path)
        out += fmt::format("{}{:02X}", out.empty() ? "" : " ", byte);
    return '"' + out + '"';
}
void put_point(Bytes& to, std::uint32_t instance) {
    if (instance <= 0xFF) {
        put8(to, 0x2C);
        put8(to, static_cast<std::uint8_t>(instance));
    } else {
        put8(to, 0x2D);
        put8(to, 0);
        put16(to, static_cast<std::uint16_t>(instance));
    }
}
std::string number_of(const Bytes& bytes, DataType type) {
    std::uint64_t raw = 0;
    for (std::size_t i = bytes.size(); i-- > 0;)
        raw = raw << 8 | bytes[i];
    if (bytes.empty()) return {};
    // A value that is not a finite number has no form in the sheet.
    const auto finite = [](auto n) { return std::isfinite(n) ? fmt::format("{}", n) : std::string(); };
    if (type == DataType::real) return finite(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
    if (type == DataType::lreal) return finite(std::bit_cast<double>(raw));
    const bool is_signed = type == DataType::sint || type == DataType::int16 || type == DataType::dint || type == DataType::lint;
    const unsigned shift = 64 - 8 * static_cast<unsigned>(bytes.size());
    return is_signed ? fmt::format("{}", static_cast<std::int64_t>(raw << shift) >> shift) : fmt::format("{}", raw);
}

class Sheet {
public:
    template <class... Args>
    void line(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
        text += "\r\n";
    }
    std::string text;
};

void parameters(Sheet& s, const Description& d, const EdsNames& names) {
    s.line("\r\n[ParamClass]\r\n        MaxInst = {};\r\n        Descriptor = 0x000B;\r\n        CfgAssembly = 0;", d.parameters());
    if (d.parameters() == 0) return;
    s.line("\r\n[Params]");
    for (std::uint32_t i = 1; i <= d.parameters(); ++i) {
        const ParameterInfo p = *d.parameter(i);
        Bytes path;
        put_class(path, class_id::parameter);
        put_instance(path, i);
        put_attribute(path, 1);
        s.line("        Param{} = 0, {}, {}, 0x{:04X}, 0x{:02X}, {}, {}, {}, {}, {}, {}, {}, 1, 1, 1, 0, , , , , 0;", i, path.size(),
               spelled(path), (p.allowed.empty() ? 0 : 2) | (p.writable ? 0 : 0x10), static_cast<unsigned>(p.type), size_of(p.type),
               plain(names.parameter(i), 32), plain(p.units, 16), plain(p.help, 64), number_of(p.min, p.type), number_of(p.max, p.type),
               number_of(p.fallback, p.type));
        if (p.allowed.empty()) continue;
        std::string list;
        for (const auto& [number, meaning] : p.allowed)
            list += fmt::format("{}{}, {}", list.empty() ? "" : ", ", number, plain(meaning, 64));
        s.line("        Enum{} = {};", i, list);
    }
}

void assemblies(Sheet& s, const Description& d, const EdsNames& names) {
    s.line("\r\n[Assembly]\r\n        Object_Name = \"Assembly Object\";\r\n        Object_Class_Code = 0x04;");
    for (const std::uint32_t instance : d.assemblies()) {
        Bytes path;
        put_class(path, class_id::assembly);
        put_instance(path, instance);
        put_attribute(path, 3);
        const std::uint16_t size = d.assembly(instance)->size;
        s.line("        Assem{} = {}, {}, {}, 0x0000, , , {}, ;", instance, plain(names.assembly(instance), 32), spelled(path), size,
               8u * size);
    }
}

void connection(Sheet& s, int number, std::uint32_t what, std::uint32_t how, const Description& d, std::uint32_t consumed,
                std::uint32_t produced, std::uint32_t configuration, const std::string& name) {
    Bytes path;
    put_class(path, class_id::assembly);
    put_instance(path, configuration);
    put_point(path, consumed);
    put_point(path, produced);
    s.line("        Connection{} =", number);
    s.line("                0x{:08X}, 0x{:08X},", what, how);
    s.line("                , {}, Assem{},", d.assembly(consumed)->size, consumed);
    s.line("                , {}, Assem{},", d.assembly(produced)->size, produced);
    s.line("                , , 0, Assem{},", configuration);
    s.line("                {}, \"\", {};", plain(name, 48), spelled(path));
}
}  // namespace

std::string eds_text(const Description& d, const EdsNames& names) {
    const Device& v = d.device();
    Sheet s;
    s.line("$ Made of the configuration in force: another one has another revision.");
    s.line(
        "[File]\r\n        DescText = {};\r\n        CreateDate = 11-23-2026;\r\n        CreateTime = 00:00:00;\r\n        Revision = "
        "{}.{};",
        plain(v.name + " EtherNet/IP adapter", 64), v.major, v.minor);
    s.line("\r\n[Device]\r\n        VendCode = {};\r\n        VendName = {};\r\n        ProdType = {};\r\n        ProdTypeStr = {};",
           v.vendor, plain(names.vendor, 48), v.device_type, plain(names.device_type, 48));
    s.line("        ProdCode = {};\r\n        MajRev = {};\r\n        MinRev = {};\r\n        ProdName = {};\r\n        Catalog = {};",
           v.product_code, v.major, v.minor, plain(v.name, 32), plain(names.catalog, 32));
    s.line("\r\n[Device Classification]\r\n        Class1 = EtherNetIP;");
    parameters(s, d, names);
    assemblies(s, d, names);

    s.line("\r\n[Connection Manager]\r\n        Object_Name = \"Connection Manager Object\";\r\n        Object_Class_Code = 0x06;");
    // Class 1, cyclic and change of state; sizes fixed, priorities scheduled; to the originator by multicast or point to point.
    constexpr std::uint32_t owner = 0x04030002, reader = 0x02030002, listener = 0x01030002;
    constexpr std::uint32_t with_header = 0x44640405, heartbeat = 0x44640305;
    std::uint32_t only_input = 0, only_listen = 0, configuration = 0;
    std::vector<std::uint32_t> inputs;
    std::multimap<std::uint32_t, std::uint32_t> owners;  // outputs, keyed by their input
    for (const std::uint32_t instance : d.assemblies()) {
        const AssemblyInfo info = *d.assembly(instance);
        if (info.role == Role::input_only) only_input = instance;
        if (info.role == Role::listen_only) only_listen = instance;
        if (info.role == Role::configuration) configuration = instance;
        if (info.size > 0 && info.role == Role::input) inputs.push_back(instance);
        if (info.size > 0 && info.role == Role::output) owners.emplace(info.partner, instance);
    }
    int number = 0;
    for (const std::uint32_t input : inputs) {
        const std::string of = names.assembly(input);
        for (auto [it, end] = owners.equal_range(input); it != end; ++it)
            connection(s, ++number, owner, with_header, d, it->second, input, configuration, "Owner: " + names.assembly(it->second));
        connection(s, ++number, reader, heartbeat, d, only_input, input, configuration, "Input only: " + of);
        connection(s, ++number, listener, heartbeat, d, only_listen, input, configuration, "Listen only: " + of);
    }
    s.line("\r\n[Capacity]\r\n        MaxMsgConnections = 64;\r\n        MaxIOProducers = 128;\r\n        MaxIOConsumers = 128;");
    s.line("        TSpec1 = TxRx, 32, 1000;");
    s.line("\r\n[Port]\r\n        Port1 = TCP, \"EtherNet/IP\", \"20 F5 24 01\", 2;");
    s.line("\r\n[TCP/IP Interface Class]\r\n        Revision = 4;\r\n        MaxInst = 1;\r\n        Number_Of_Static_Instances = 1;");
    s.line("\r\n[Ethernet Link Class]\r\n        Revision = 4;\r\n        MaxInst = 1;\r\n        Number_Of_Static_Instances = 1;");
    s.line("\r\n[QoS Class]\r\n        Revision = 1;\r\n        MaxInst = 1;\r\n        Number_Of_Static_Instances = 1;");
    return std::move(s.text);
}

}  // namespace axisgate::cip
