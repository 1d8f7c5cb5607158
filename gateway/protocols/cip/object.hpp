// Object: the common part of all CIP objects: attributes of instances and of the class, read and written singly, in lists and all together.
// An answer has at most `most_answer` bytes of data.
#pragma once

#include <optional>
#include <span>

#include "gateway/core/instant.hpp"
#include "gateway/protocols/cip/message.hpp"
#include "gateway/protocols/cip/values.hpp"

namespace axisgate::cip {

/// The circumstances of a request that an object may need.
struct Context {
    Instant now{};
    Peer peer;
    SessionKey session = 0;
    const Device* device = nullptr;      ///< whose key a path may name
    Token token = 0;                     ///< token for a value that comes later
    std::optional<Endpoint> produce_to;  ///< item sockaddr T->O of the request
    std::optional<Endpoint> consume_at;  ///< set by the object: item sockaddr O->T of the answer
    std::optional<Endpoint> multicast;   ///< set by the object: item sockaddr T->O of the answer
    std::size_t most_answer = 504 - 4;   ///< maximum number of data bytes in the answer
};

class Object {
public:
    virtual ~Object() = default;
    [[nodiscard]] virtual std::uint32_t class_id() const noexcept = 0;
    [[nodiscard]] virtual std::uint16_t revision() const noexcept { return 1; }
    [[nodiscard]] virtual bool has(std::uint32_t instance) const { return instance == 1; }
    [[nodiscard]] virtual std::uint32_t last_instance() const { return 1; }
    [[nodiscard]] virtual std::uint32_t instances() const { return last_instance(); }
    /// The attributes of Get_Attributes_All in their order; empty if the object does not have that service.
    [[nodiscard]] virtual std::span<const std::uint16_t> all(std::uint32_t /*instance*/) const { return {}; }
    [[nodiscard]] virtual std::uint16_t last_attribute() const = 0;
    /// Appends the attribute. `attribute_not_supported` if there is none.
    [[nodiscard]] virtual General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) = 0;
    /// `data` begins with the attribute; the bytes that were used are skipped, so that a list can be read further.
    [[nodiscard]] virtual General set(std::uint32_t instance, std::uint32_t attribute, const Context& context, Reader& data);
    [[nodiscard]] virtual std::uint16_t last_attribute_of_class() const { return 7; }
    /// Whether the class attributes about instances are 32 bits wide: they are a UINT except in a few classes.
    [[nodiscard]] virtual bool counts_in_32_bits() const { return false; }
    /// Attributes of the class beyond 1, 2, 3, 6 and 7.
    [[nodiscard]] virtual General get_of_class(std::uint32_t attribute, const Context& context, Bytes& to);
    /// Any other service. Instance 0 is the class.
    [[nodiscard]] virtual Response other(std::uint8_t service, std::uint32_t instance, View data, Context& context);
    /// Whether the value of the attribute comes later; `write`: nothing, or the value.
    [[nodiscard]] virtual bool is_late(std::uint32_t /*attribute*/) const noexcept { return false; }
    [[nodiscard]] virtual General ask(std::uint32_t instance, const Context& context);

    /// Set_Attribute_Single, for objects whose writes are answered by a drive or a profile, now or later.
    [[nodiscard]] virtual Response set_single(std::uint32_t instance, std::uint32_t attribute, View data, const Context& context);

    /// Carries out any service. `path` names this class.
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
