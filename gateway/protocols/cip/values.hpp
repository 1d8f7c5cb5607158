// Values: the data behind the objects of the adapter: assemblies, parameters, the names of the device, and the owner of each output.
// A door implements the interface (or a test); the objects and the connection manager call it, always on the same thread.
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
        configuration,  ///< sent with Forward_Open
        input_only,     ///< heartbeat of a connection that reads and owns no output
        listen_only     ///< heartbeat of a connection that lives as long as another one that reads the same
    };
    Role role = Role::input;
    std::uint16_t size = 0;     ///< bytes of data, without header and sequence count
    std::uint32_t partner = 0;  ///< of an output: the input that an originator opens with it; 0: none
};

/// Elementary types with their CIP numbers.
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
/// Size in bytes; 0: variable.
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
    std::string name, units, help;  ///< cut to 16, 4 and 64 characters when the object shows them
    DataType type = DataType::dint;
    bool readable = true, writable = false;
    Bytes min, max, fallback;  ///< as many bytes as the type has; empty for a text
    std::vector<std::pair<std::int64_t, std::string>> allowed;
};

/// Identifies a requested value until it is answered.
using Token = std::uint64_t;

/// Identifies a TCP connection; 0: a datagram.
using SessionKey = std::uint64_t;

/// The sender of a request: its address, and its connection if it has one.
struct Peer {
    Endpoint from;
    std::uint32_t connection = 0;  ///< id of the connection in the adapter; 0: an unconnected message
    SessionKey session = 0;        ///< session over which it came, or was opened
};

enum class End : std::uint8_t {
    closed,        ///< by its originator
    timed_out,     ///< its originator was silent
    by_gateway,    ///< the resource that it uses has changed
    to_make_room,  ///< to make room for another connection
    by_operator    ///< an operator has closed it through another door
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
    std::uint16_t consistency = 0;  ///< changes with the layout
};

/// The device without its present values: the content of an EDS.
struct Description {
    [[nodiscard]] virtual const Device& device() const = 0;
    [[nodiscard]] virtual std::optional<AssemblyInfo> assembly(std::uint32_t instance) const = 0;
    /// All of them, ascending.
    [[nodiscard]] virtual const std::vector<std::uint32_t>& assemblies() const = 0;
    [[nodiscard]] virtual std::uint32_t parameters() const = 0;                                      ///< instances 1..n
    [[nodiscard]] virtual std::optional<ParameterInfo> parameter(std::uint32_t instance) const = 0;  ///< made on demand
    virtual ~Description() = default;
};

struct Values : Description {
    /// Appends exactly as many bytes as the assembly has.
    virtual void read(std::uint32_t instance, Instant now, Bytes& to) = 0;
    /// A number that changes with each change of an input's data, except changes of times alone.
    [[nodiscard]] virtual std::uint64_t revision(std::uint32_t instance) const = 0;
    /// An explicit write of an output; `data` has the assembly's size. The caller refuses it while a connection owns the output.
    /// `later`: Adapter::answered(token) follows, not from inside this call. `token` 0: no later answer is possible.
    [[nodiscard]] virtual General write(std::uint32_t instance, View data, Token token, const Peer& who, Instant now, bool& later) = 0;
    /// A path for messages has ended: a connection of explicit messages, or a session (its connection is 0) with all its connections.
    virtual void messages_ended(const Peer& /*way*/) {}
    /// Whether messages of this session command an axis.
    [[nodiscard]] virtual bool commands_by(SessionKey /*session*/) const { return false; }
    /// Whether two outputs (or one with itself) command the same axis.
    [[nodiscard]] virtual bool overlap(std::uint32_t a, std::uint32_t b) const = 0;
    /// Whether another client has control of what this output commands.
    [[nodiscard]] virtual bool held_by_another(std::uint32_t output, const Peer& who, Instant now) const = 0;

    // An exclusive owner's connection: `opened`, then new data in run mode, the fall to idle, and one `ended`.
    virtual void opened(std::uint32_t output, const Peer& who, Duration time_out, Instant now) = 0;
    virtual void consumed(std::uint32_t output, View data, const Peer& who, Instant now) = 0;
    virtual void idle(std::uint32_t output, const Peer& who, Instant now) = 0;
    virtual void ended(std::uint32_t output, const Peer& who, End why, Instant now) = 0;

    /// Requests a value: Adapter::answered(token) follows, not from inside this call. Any other result is the reason for a refusal.
    [[nodiscard]] virtual General ask(std::uint32_t instance, Token token, const Peer& who, Instant now) = 0;
    /// `value` has the right size.
    [[nodiscard]] virtual General set(std::uint32_t instance, View value, Token token, const Peer& who, Instant now) = 0;

    // Manufacturer specific classes (0x64..0xC7), with instances and attributes as in a device of another manufacturer.
    struct OwnAttribute {
        DataType type = DataType::dint;
        bool readable = true, writable = false;
    };
    /// Nothing if there is no such class or instance. `attribute` 0 asks whether the instance exists.
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

/// Is called for writes to objects of the device itself: the marks of its packets, and its time-out for silent sessions.
struct DeviceListener {
    /// A write by Set_Attribute_Single or a similar service, or a reset. `attribute` 0: several.
    virtual void written(const Values::OwnPlace& /*place*/, const Peer& /*who*/, Instant /*now*/) {}
    virtual ~DeviceListener() = default;
};

}  // namespace axisgate::cip
