// Axis texts: the documents of axes as JSON text, made once per picture and not once per request.
// In: pictures. Out: what GET /axes/{name} answers. Warm thread only.
// Bound: one text per axis of the site in force; another site empties all.
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

/// Ends an axis' text, of which the closing brace has been taken off, with `age_ms`; null if it was never seen.
void put_age(bool ever_seen, std::int64_t at_unix_ns, std::int64_t now_unix_ns, std::string& text);

class AxisTexts {
public:
    using Needs = PortSet<AxisPort, ClockPort, SitePort>;
    /// The axis with this index in `site`, with its age now.
    [[nodiscard]] std::string text(const Needs& ports, const std::shared_ptr<const SiteState>& site, std::size_t index);
    /// How many texts were made anew so far.
    [[nodiscard]] std::uint64_t made() const noexcept { return made_; }

private:
    struct Kept {
        std::uint64_t revision = 0;  ///< of the picture it was made from, or of one before
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
