// The documents of axes as JSON text (the answer of GET /axes/{name}), made once per picture and not once per request. Service thread only.
// Bound: one text per axis of the site in force; another site clears all.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

/// Completes an axis' text, whose closing brace was removed, with `age_ms`; null if there was no feedback yet.
void put_age(bool ever_seen, std::int64_t at_unix_ns, std::int64_t now_unix_ns, std::string& text);

class AxisTexts {
public:
    using Needs = PortSet<AxisPort, ClockPort, SitePort>;
    /// The text of the axis with this index in `site`, with its present age.
    [[nodiscard]] std::string text(const Needs& ports, const std::shared_ptr<const SiteState>& site, std::size_t index);
    /// Number of texts made so far.
    [[nodiscard]] std::uint64_t made() const noexcept { return made_; }

private:
    struct Kept {
        std::uint64_t revision = 0;  ///< of the picture from which it was made, or of an earlier one
        std::int64_t at_unix_ns = 0;
        bool ever_seen = false;
        Instant at{};
        std::string text;  ///< without the last brace; empty: not made yet
    };
    void make(Kept& kept, const Needs& ports, const std::shared_ptr<const SiteState>& site, std::size_t index, AxisId id);

    std::shared_ptr<const SiteState> site_;
    std::vector<Kept> kept_;
    std::uint64_t made_ = 0;
};

}  // namespace axisgate
