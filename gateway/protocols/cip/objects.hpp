// Objects: Identity, Assembly, Parameter, TCP/IP Interface, Ethernet Link, QoS and Connection Configuration of an adapter.
// Their attributes come from the device's values and the state of its connections (CIP volume 1, chapter 5; volume 2, chapter 5).
#pragma once

#include <array>

#include "gateway/protocols/cip/object.hpp"

namespace axisgate::cip {

/// The state of the connections for the objects, and closing them.
struct Connections {
    [[nodiscard]] virtual std::size_t open() const = 0;
    [[nodiscard]] virtual std::size_t most() const = 0;
    [[nodiscard]] virtual std::vector<std::uint16_t> numbers() const = 0;
    [[nodiscard]] virtual bool io_open() const = 0;  ///< a connection with implicit data is open
    [[nodiscard]] virtual bool owned() const = 0;    ///< a connection commands
    [[nodiscard]] virtual bool running() const = 0;  ///< its originator is in run mode
    /// Whether a connection of another originator commands the output; `output` 0: any output.
    [[nodiscard]] virtual bool owned_by_other(std::uint32_t output, const Peer& than) const = 0;
    virtual void close_all(End why, Instant now) = 0;
    virtual ~Connections() = default;
};

class IdentityObject final : public Object {
public:
    IdentityObject(const Values& values, Connections& connections) : values_(values), connections_(connections) {}
    [[nodiscard]] std::uint32_t class_id() const noexcept override { return class_id::identity; }
    [[nodiscard]] std::uint16_t last_attribute() const override { return 9; }
    [[nodiscard]] std::span<const std::uint16_t> all(std::uint32_t instance) const override;
    [[nodiscard]] General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) override;
    [[nodiscard]] Response other(std::uint8_t service, std::uint32_t instance, View data, Context& context) override;
    /// The item of ListIdentity.
    [[nodiscard]] Bytes item() const;
    [[nodiscard]] std::uint16_t status() const;

private:
    const Values& values_;
    Connections& connections_;
};

class AssemblyObject final : public Object {
public:
    AssemblyObject(Values& values, const Connections& connections) : values_(values), connections_(connections) {}
    /// Attribute 3 of an output: the answer comes when the drives have answered. In a list it cannot be set.
    [[nodiscard]] Response set_single(std::uint32_t instance, std::uint32_t attribute, View data, const Context& context) override;
    [[nodiscard]] std::uint32_t class_id() const noexcept override { return class_id::assembly; }
    [[nodiscard]] std::uint16_t revision() const noexcept override { return 2; }
    [[nodiscard]] bool has(std::uint32_t instance) const override { return values_.assembly(instance).has_value(); }
    [[nodiscard]] std::uint32_t last_instance() const override;
    [[nodiscard]] std::uint32_t instances() const override;
    [[nodiscard]] std::uint16_t last_attribute() const override { return 4; }
    [[nodiscard]] General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) override;

private:
    Values& values_;
    const Connections& connections_;
};

/// Attribute 1, the value, comes from the drive and is answered when the drive has reported it.
class ParameterObject final : public Object {
public:
    explicit ParameterObject(Values& values) : values_(values) {}
    [[nodiscard]] std::uint32_t class_id() const noexcept override { return class_id::parameter; }
    [[nodiscard]] bool has(std::uint32_t instance) const override { return instance >= 1 && instance <= values_.parameters(); }
    [[nodiscard]] std::uint32_t last_instance() const override { return values_.parameters(); }
    [[nodiscard]] std::uint16_t last_attribute() const override { return 21; }
    [[nodiscard]] std::span<const std::uint16_t> all(std::uint32_t instance) const override;
    [[nodiscard]] General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) override;
    [[nodiscard]] General set(std::uint32_t instance, std::uint32_t attribute, const Context& context, Reader& data) override;
    [[nodiscard]] std::uint16_t last_attribute_of_class() const override { return 10; }
    [[nodiscard]] General get_of_class(std::uint32_t attribute, const Context& context, Bytes& to) override;
    [[nodiscard]] Response other(std::uint8_t service, std::uint32_t instance, View data, Context& context) override;
    [[nodiscard]] bool is_late(std::uint32_t attribute) const noexcept override { return attribute == 1; }
    [[nodiscard]] General ask(std::uint32_t instance, const Context& context) override;
    /// Attribute 4: enumerated, read only.
    [[nodiscard]] static std::uint16_t descriptor(const ParameterInfo& p) noexcept;

private:
    Values& values_;
};

/// The classes of another manufacturer's device that a profile reproduces. One object serves all of them: the router passes the class.
class OwnObject final : public Object {
public:
    explicit OwnObject(Values& values) : values_(values) {}
    [[nodiscard]] bool serves(std::uint32_t class_id) const { return values_.has_own_class(class_id); }
    void name(std::uint32_t class_id) noexcept { class_ = class_id; }
    [[nodiscard]] std::uint32_t class_id() const noexcept override { return class_; }
    [[nodiscard]] bool has(std::uint32_t instance) const override { return values_.own_attribute(class_, instance, 0).has_value(); }
    [[nodiscard]] std::uint32_t last_instance() const override;
    [[nodiscard]] std::uint32_t instances() const override;
    [[nodiscard]] std::uint16_t last_attribute() const override;
    [[nodiscard]] General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) override;
    [[nodiscard]] Response set_single(std::uint32_t instance, std::uint32_t attribute, View data, const Context& context) override;

private:
    Values& values_;
    std::uint32_t class_ = 0;
};

class TcpIpObject final : public Object {
public:
    explicit TcpIpObject(const Values& values) : values_(values) {}
    [[nodiscard]] std::uint32_t class_id() const noexcept override { return class_id::tcp_ip; }
    [[nodiscard]] std::uint16_t revision() const noexcept override { return 4; }
    [[nodiscard]] std::uint16_t last_attribute() const override { return 13; }
    [[nodiscard]] std::span<const std::uint16_t> all(std::uint32_t instance) const override;
    [[nodiscard]] General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) override;
    [[nodiscard]] General set(std::uint32_t instance, std::uint32_t attribute, const Context& context, Reader& data) override;
    /// Attribute 13: a session without data for this long is closed, unless a connection uses it; 0: off.
    [[nodiscard]] std::uint16_t inactivity_s() const noexcept { return inactivity_s_; }

private:
    const Values& values_;
    std::uint16_t inactivity_s_ = 120;
};

class EthernetLinkObject final : public Object {
public:
    explicit EthernetLinkObject(const Values& values) : values_(values) {}
    [[nodiscard]] std::uint32_t class_id() const noexcept override { return class_id::ethernet_link; }
    [[nodiscard]] std::uint16_t revision() const noexcept override { return 4; }
    [[nodiscard]] std::uint16_t last_attribute() const override { return 10; }
    [[nodiscard]] std::span<const std::uint16_t> all(std::uint32_t instance) const override;
    [[nodiscard]] General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) override;

private:
    const Values& values_;
};

/// The DSCP marks of packets: implicit data by the priority that their originator asked for, sessions from their beginning. A changed mark
/// holds until the gateway ends.
class QosObject final : public Object {
public:
    static constexpr std::uint8_t dscp_urgent = 55, dscp_scheduled = 47, dscp_high = 43, dscp_low = 31, dscp_explicit = 27;
    [[nodiscard]] std::uint32_t class_id() const noexcept override { return class_id::qos; }
    [[nodiscard]] std::uint16_t last_attribute() const override { return 8; }
    [[nodiscard]] std::span<const std::uint16_t> all(std::uint32_t instance) const override;
    [[nodiscard]] General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) override;
    [[nodiscard]] General set(std::uint32_t instance, std::uint32_t attribute, const Context& context, Reader& data) override;
    /// Set_Attributes_All: all five marks or none.
    [[nodiscard]] Response other(std::uint8_t service, std::uint32_t instance, View data, Context& context) override;
    /// `priority`: 0 low, 1 high, 2 scheduled, 3 urgent.
    [[nodiscard]] std::uint8_t implicit_mark(std::uint8_t priority) const noexcept { return marks_[3 - (priority & 3)]; }
    [[nodiscard]] std::uint8_t explicit_mark() const noexcept { return marks_[4]; }

private:
    std::array<std::uint8_t, 5> marks_{dscp_urgent, dscp_scheduled, dscp_high, dscp_low, dscp_explicit};  // attributes 4 to 8
};

/// The list of connections that a device originates, which is empty for an adapter. Tools read its length, whether it has changed, and its
/// format.
class ConnectionConfigurationObject final : public Object {
public:
    [[nodiscard]] std::uint32_t class_id() const noexcept override { return class_id::connection_configuration; }
    [[nodiscard]] std::uint16_t revision() const noexcept override { return 3; }
    [[nodiscard]] bool has(std::uint32_t) const override { return false; }
    [[nodiscard]] std::uint32_t last_instance() const override { return 0; }
    [[nodiscard]] std::uint16_t last_attribute() const override { return 0; }
    [[nodiscard]] std::uint16_t last_attribute_of_class() const override { return 9; }
    [[nodiscard]] bool counts_in_32_bits() const override { return true; }
    [[nodiscard]] General get(std::uint32_t, std::uint32_t, const Context&, Bytes&) override { return General::attribute_not_supported; }
    [[nodiscard]] General get_of_class(std::uint32_t attribute, const Context& context, Bytes& to) override;
};

}  // namespace axisgate::cip
