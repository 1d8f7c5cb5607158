// The events of the HTTP door itself: changes that no service reports, and refusals (401, 403, or a 409 to a request that would change
// something). They are bounded by EventRows, with all requests of unknown clients in one row. They contain no body, query or header.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "gateway/core/event_rows.hpp"
#include "gateway/doors/http/message.hpp"
#include "gateway/services/ports/events.hpp"

namespace axisgate::http {

class Audit {
public:
    /// Rows of a page that continues without a session, or of a scraper without a token, last for days.
    static constexpr Duration row_period = std::chrono::minutes(1);

    explicit Audit(EventPort& events)
        : events_(events), refusals_([this](Event e, AxisId) { events_.note(std::move(e)); }, "refusals", row_period) {}
    Audit(const Audit&) = delete;
    Audit& operator=(const Audit&) = delete;

    struct Asked {
        bool changes = false;  ///< neither GET nor HEAD
        std::string what;      ///< "POST /api/v1/axes/feeder/commands", without the query
        std::string who, peer;
        std::string_view kind{};  ///< of the event for a good answer; empty: another part reports it
        std::string told{};       ///< its text
    };
    [[nodiscard]] static bool is_refusal(unsigned status, bool changes) noexcept {
        return status == 401 || status == 403 || (status == 409 && changes);
    }
    void answered(const Asked& asked, const Response& response, Instant now);
    /// Reports the counts of rows that have lasted for the period. Must be called periodically.
    void flush(Instant now) { refusals_.flush(now); }
    /// Number of refusals without an event of their own.
    [[nodiscard]] std::uint64_t counted_only() const noexcept { return refusals_.counted_only(); }

private:
    EventPort& events_;
    EventRows refusals_;
};

/// "POST /api/v1/lines", shortened if it is long.
[[nodiscard]] std::string what_is_asked(const Request& request);

}  // namespace axisgate::http
