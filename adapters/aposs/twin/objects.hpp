// The object dictionary of a simulated MACS: the rows of the catalogue, and a CiA 402 application for two axes. The manual does not print
// the addresses of parameters in the dictionary (E-01): the rows state how certain each address is.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/protocols/canopen/dictionary.hpp"

namespace axisgate::aposs {
using canopen::Address;

inline constexpr int axes = 2;
inline constexpr std::uint16_t per_axis = 0x800;

enum class Scope : std::uint8_t { axis, global };
/// A parameter of one axis, or of the controller.
struct Key {
    Scope scope = Scope::axis;
    int axis = 0;  ///< from 0; 0 for a global parameter
    int number = 0;
    auto operator<=>(const Key&) const = default;
};
struct Row {
    Address address;
    Key key;
    std::string id;
    std::string storage;  ///< "parameter", "computed", "state"
    std::int64_t initial = 0;
    std::vector<std::int64_t> allowed;  ///< the only values; empty: the limits apply
};

class Objects {
public:
    /// `extra_pdo_ms`: event timer of all PDOs that the controller sends; 0: it is off.
    Objects(const Catalogue& catalogue, std::uint8_t node, std::int64_t extra_pdo_ms = 0);
    Objects(const Objects&) = delete;
    Objects& operator=(const Objects&) = delete;
    [[nodiscard]] const canopen::Dictionary& factory() const noexcept { return factory_; }
    [[nodiscard]] const Row* at(Address address) const;
    [[nodiscard]] const Row* of(const Key& key) const;
    /// By name: VELMAX of axis 0, CANBAUD of the controller.
    [[nodiscard]] const Row* named(std::string_view id, int axis) const;
    [[nodiscard]] const std::map<Key, Row>& rows() const noexcept { return rows_; }

private:
    canopen::Dictionary factory_;
    std::map<Key, Row> rows_;  ///< their addresses must not change: the two below point to them
    std::map<Address, const Row*> places_;
    struct Hash {
        using is_transparent = void;
        [[nodiscard]] std::size_t operator()(std::string_view id) const noexcept { return std::hash<std::string_view>{}(id); }
    };
    std::array<std::unordered_map<std::string, const Row*, Hash, std::equal_to<>>, axes> names_;
};

}  // namespace axisgate::aposs
