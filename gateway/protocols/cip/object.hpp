// Object: what all CIP objects have in common: attributes of instances and of the class, read and written alone, in lists and all together.
// In: a service with its path taken apart. Out: the answer with its status. Never more data in an answer than `most_answer`.
#pragma once

#include <optional>
#include <span>

#include "gateway/core/instant.hpp"
#include "gateway/protocols/cip/message.hpp"
#include "gateway/protocols/cip/values.hpp"

namespace axisgate::cip {

/// What an object may want to know beside the request.
struct Context {
    Instant now{};
    Peer peer;
    SessionKey session = 0;
    const Device* device = nullptr;      ///< whose key a path may name
    Token token = 0;                     ///< under which a value that comes later is told
    std::optional<Endpoint> produce_to;  ///< item sockaddr T->O of the request
    std::optional<Endpoint> consume_at;  ///< to be told: item sockaddr O->T of the answer
    std::optional<Endpoint> multicast;   ///< to be told: item sockaddr T->O of the answer
    std::size_t most_answer = 504 - 4;   ///< bytes of data that the answer may have
};

class Object {
public:
    virtual ~Object() = default;
    [[nodiscard]] virtual std::uint32_t class_id() const noexcept = 0;
    [[nodiscard]] virtual std::uint16_t revision() const noexcept { return 1; }
    [[nodiscard]] virtual bool has(std::uint32_t instance) const { return instance == 1; }
    [[nodiscard]] virtual std::uint32_t last_instance() const { return 1; }
    [[nodiscard]] virtual std::uint32_t instances() const { return last_instance(); }
    /// Attributes of Get_Attributes_All in their order; none: it has not that service.
    [[nodiscard]] virtual std::span<const std::uint16_t> all(std::uint32_t /*instance*/) const { return {}; }
    [[nodiscard]] virtual std::uint16_t last_attribute() const = 0;
    /// Appends the attribute. `attribute_not_supported` if there is none.
    [[nodiscard]] virtual General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) = 0;
    /// `data` begins with the attribute; what is taken of it is skipped, so that lists can be read on.
    [[nodiscard]] virtual General set(std::uint32_t instance, std::uint32_t attribute, const Context& context, Reader& data);
    [[nodiscard]] virtual std::uint16_t last_attribute_of_class() const { return 7; }
    /// Of what the class tells of its instances: a UINT, but for a few classes.
    [[nodiscard]] virtual bool counts_in_32_bits() const { return false; }
    /// Attributes of the class beyond 1, 2, 3, 6 and 7.
    [[nodiscard]] virtual General get_of_class(std::uint32_t attribute, const Context& context, Bytes& to);
    /// A service that is not one of those above. Instance 0: the class.
    [[nodiscard]] virtual Response other(std::uint8_t service, std::uint32_t instance, View data, Context& context);
    /// Attributes whose value comes later; `write`: nothing, or the value.
    [[nodiscard]] virtual bool is_late(std::uint32_t /*attribute*/) const noexcept { return false; }
    [[nodiscard]] virtual General ask(std::uint32_t instance, const Context& context);

    /// Set_Attribute_Single. For those whose writes are answered by something behind them, now or later.
    [[nodiscard]] virtual Response set_single(std::uint32_t instance, std::uint32_t attribute, View data, const Context& context);

    /// Any service. `path` names this class.
    [[nodiscard]] Response serve(std::uint8_t service, const Path& path, View data, Context& context);

private:
    void put_count(Bytes& to, std::uint32_t count) const;
    [[nodiscard]] General read(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to);
    [[nodiscard]] Response get_single(std::uint32_t instance, std::uint32_t attribute, const Context& context);
    [[nodiscard]] Response get_all(std::uint32_t instance, const Context& context);
    [[nodiscard]] Response get_list(std::uint32_t instance, View data, const Context& context);
    [[nodiscard]] Response set_list(std::uint32_t instance, View data, const Context& context);
};

}  // namespace axisgate::cip
