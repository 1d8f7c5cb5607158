// Values: what the objects of the adapter mean: assemblies, parameters, the names of the device, and who owns an output.
// In: implemented by a door, or by a test. Out: asked by the objects and the connection manager. Never called from another thread.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/instant.hpp"
#include "gateway/protocols/cip/bytes.hpp"
#include "gateway/protocols/cip/status.hpp"

namespace axisgate::cip {

struct AssemblyInfo {
    enum class Role : std::uint8_t {
        input,          ///< produced: target to originator
        output,         ///< consumed: originator to target
        configuration,  ///< goes with Forward_Open
        input_only,     ///< heartbeat of a connection that reads and owns nothing
        listen_only     ///< heartbeat of one that lives as long as another that reads the same
    };
    Role role = Role::input;
    std::uint16_t size = 0;     ///< bytes of data, without header and sequence count
    std::uint32_t partner = 0;  ///< of an output: the input that an originator opens with it; 0: none
};

/// Elementary types by their number in CIP.
enum class DataType : std::uint8_t {
    boolean = 0xC1,
    sint = 0xC2,
    int16 = 0xC3,
    dint = 0xC4,
    lint = 0xC5,
    usint = 0xC6,
    uint16 = 0xC7,
    udint = 0xC8,
    real = 0xCA,
    lreal = 0xCB,
    short_string = 0xDA
};
/// Bytes; 0: they vary.
[[nodiscard]] constexpr std::uint8_t size_of(DataType type) noexcept {
    switch (type) {
        case DataType::boolean:
        case DataType::sint:
        case DataType::usint:
            return 1;
        case DataType::int16:
        case DataType::uint16:
            return 2;
        case DataType::dint:
        case DataType::udint:
        case DataType::real:
            return 4;
        case DataType::lint:
        case DataType::lreal:
            return 8;
        case DataType::short_string:
            break;
    }
    return 0;
}
struct ParameterInfo {
    std::string name, units, help;  ///< cut to 16, 4 and 64 characters where the object shows them
    DataType type = DataType::dint;
    bool readable = true, writable = false;
    Bytes min, max, fallback;  ///< as many bytes as the type has; of a text: none
    std::vector<std::pair<std::int64_t, std::string>> allowed;
};

/// Names an asked value until it is told.
using Token = std::uint64_t;

/// Number by which whoever carries bytes knows a TCP connection; 0: a datagram.
using SessionKey = std::uint64_t;

/// Who asks: the other end's address, and the connection if it is one.
struct Peer {
    Endpoint from;
    std::uint32_t connection = 0;  ///< id by which the adapter knows the connection; 0: an unconnected message
    SessionKey session = 0;        ///< by which it came, or was opened
};

enum class End : std::uint8_t {
    closed,        ///< by its originator
    timed_out,     ///< its originator was silent
    by_gateway,    ///< what it was opened for has changed
    to_make_room,  ///< for a connection of somebody else
    by_operator    ///< a person has closed it by another door
};

struct Device {
    std::uint16_t vendor = 0, device_type = 0, product_code = 0;
    std::uint8_t major = 1, minor = 1;
    std::uint32_t serial = 0;
    std::string name;       ///< up to 32 characters
    std::string host_name;  ///< up to 64
    std::uint32_t address = 0, mask = 0, router = 0;
    std::array<std::uint8_t, 6> mac{};
    std::uint32_t speed_mbit = 1000;
    std::uint16_t port = 44818, io_port = 2222;
    std::uint16_t consistency = 0;  ///< of the layout: changes with it
};

/// What there is, without its values: all that an EDS says.
struct Description {
    [[nodiscard]] virtual const Device& device() const = 0;
    [[nodiscard]] virtual std::optional<AssemblyInfo> assembly(std::uint32_t instance) const = 0;
    /// All of them, ascending.
    [[nodiscard]] virtual const std::vector<std::uint32_t>& assemblies() const = 0;
    [[nodiscard]] virtual std::uint32_t parameters() const = 0;  ///< instances 1..n
    [[nodiscard]] virtual const ParameterInfo* parameter(std::uint32_t instance) const = 0;
    virtual ~Description() = default;
};

struct Values : Description {
    /// Appends exactly the assembly's size.
    virtual void read(std::uint32_t instance, Instant now, Bytes& to) = 0;
    /// Another number after each change of what an input shows, but for what time alone changes.
    [[nodiscard]] virtual std::uint64_t revision(std::uint32_t instance) const = 0;
    /// An explicit write of an output; `data` has the assembly's size. Refused while a connection owns it: the caller sees to that.
    /// `later`: Adapter::answered(token) follows, not from inside this call. `token` 0: nothing can be answered later.
    [[nodiscard]] virtual General write(std::uint32_t instance, View data, Token token, const Peer& who, Instant now, bool& later) = 0;
    /// A way by which messages came has ended: a connection of explicit messages, or a session (its connection is 0) with all of them.
    virtual void messages_ended(const Peer& /*way*/) {}
    /// Somebody commands by messages of this session.
    [[nodiscard]] virtual bool commands_by(SessionKey /*session*/) const { return false; }
    /// Two outputs (or one with itself) that command the same thing.
    [[nodiscard]] virtual bool overlap(std::uint32_t a, std::uint32_t b) const = 0;
    /// Another client holds what this output commands.
    [[nodiscard]] virtual bool held_by_another(std::uint32_t output, const Peer& who, Instant now) const = 0;

    // An exclusive owner's connection: `opened`, then new data in run mode, the fall to idle, and one `ended`.
    virtual void opened(std::uint32_t output, const Peer& who, Duration time_out, Instant now) = 0;
    virtual void consumed(std::uint32_t output, View data, const Peer& who, Instant now) = 0;
    virtual void idle(std::uint32_t output, const Peer& who, Instant now) = 0;
    virtual void ended(std::uint32_t output, const Peer& who, End why, Instant now) = 0;

    /// Asks for a value: Adapter::answered(token) follows, not from inside this call. Else why it is not asked.
    [[nodiscard]] virtual General ask(std::uint32_t instance, Token token, const Peer& who, Instant now) = 0;
    /// `value` has the right size.
    [[nodiscard]] virtual General set(std::uint32_t instance, View value, Token token, const Peer& who, Instant now) = 0;

    // Classes of the maker's own (0x64..0xC7), whose instances and attributes are what a device of another maker has there.
    struct OwnAttribute {
        DataType type = DataType::dint;
        bool readable = true, writable = false;
    };
    /// Nothing: there is no such class, or not this instance of it. `attribute` 0: whether there is the instance.
    [[nodiscard]] virtual std::optional<OwnAttribute> own_attribute(std::uint32_t /*class_id*/, std::uint32_t /*instance*/,
                                                                    std::uint32_t /*attribute*/) const {
        return std::nullopt;
    }
    [[nodiscard]] virtual bool has_own_class(std::uint32_t /*class_id*/) const { return false; }
    struct OwnPlace {
        std::uint32_t class_id = 0, instance = 0, attribute = 0;
    };
    [[nodiscard]] virtual General get_own(const OwnPlace& /*place*/, Instant /*now*/, Bytes& /*to*/) {
        return General::attribute_not_supported;
    }
    /// `value` has the right size. `later`: Adapter::answered(token) follows, not from inside this call.
    [[nodiscard]] virtual General set_own(const OwnPlace& /*place*/, View /*value*/, Token /*token*/, const Peer& /*who*/, Instant /*now*/,
                                          bool& /*later*/) {
        return General::attribute_not_supported;
    }
};

/// Hears of what is written to objects that are the device's own: how it marks its packets, how long it waits for a silent session.
struct DeviceListener {
    /// By Set_Attribute_Single and its like, or a reset. `attribute` 0: several.
    virtual void written(const Values::OwnPlace& /*place*/, const Peer& /*who*/, Instant /*now*/) {}
    virtual ~DeviceListener() = default;
};

}  // namespace axisgate::cip
