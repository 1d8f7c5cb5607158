// The ports that one service or door uses, taken from a larger set by their types. It owns none of them; the owners outlive it.
#pragma once

#include <concepts>
#include <tuple>

namespace axisgate {

/// Some of the ports, by their types; the owners outlive it. Made from a set that has them all, from single ports, or from an owner of all.
template <class... Port>
class PortSet {
public:
    explicit(sizeof...(Port) == 1) PortSet(Port&... ports) : ports_(ports...) {}
    template <class... More>
    PortSet(const PortSet<More...>& more) : ports_(more.template get<Port>()...) {}
    template <class Owner>
    requires(std::derived_from<Owner, Port>&&...) PortSet(Owner& owner) : ports_(static_cast<Port&>(owner)...) {}

    /// ports.get<AxisPort>(); a port that is not in the set does not compile.
    template <class One>
    [[nodiscard]] One& get() const noexcept {
        return std::get<One&>(ports_);
    }

private:
    std::tuple<Port&...> ports_;
};

}  // namespace axisgate
