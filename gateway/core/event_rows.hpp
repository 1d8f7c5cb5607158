// Event rows: what clients cause as fast as they like (refusals above all), as events of which people can read all and nobody can flood
// the storage. In: events with their instant, by client. Out: events through `tell`. Never tells more than this:
//   identical events of one client in a row     one event at once; then their count, every `row_period` and when the row ends
//   one client (its address)                    5 events at once, then 1 per second; what is beyond is counted and told with the next one
//   all clients                                 32 events at once, then 8 per second
//   clients remembered                          64; then the one that was quiet for longest is forgotten
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/core/event.hpp"
#include "gateway/core/ids.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate {

class EventRows {
public:
    static constexpr double client_burst = 5, client_rate = 1, all_burst = 32, all_rate = 8;  ///< events, events/s
    static constexpr std::size_t most_clients = 64;
    static constexpr Duration row_period = std::chrono::seconds(10);

    using Tell = std::function<void(Event event, AxisId axis)>;
    /// `what`: as the counts call them.
    explicit EventRows(Tell tell, std::string_view what = "refusals", Duration row_period = EventRows::row_period)
        : tell_(std::move(tell)), what_(what), row_lasts_(row_period) {}

    /// `host`: the client's address, by which clients are told apart. `row`: what makes two of them identical; empty: their texts.
    void add(std::string_view host, AxisId axis, Event event, std::string row, Instant now);
    /// Tells the counts of rows that have lasted so long.
    void flush(Instant now);
    /// Something waits for flush().
    [[nodiscard]] bool pending() const noexcept;
    /// Those that have no event of their own, since the start: they are in the counts that others tell.
    [[nodiscard]] std::uint64_t counted_only() const noexcept { return counted_only_; }

private:
    struct Bucket {
        double level = 0;
        Instant at{};
        [[nodiscard]] bool take(double burst, double rate, Instant now) noexcept;
    };
    struct Client {
        std::string host;
        Bucket published;
        Event event;  ///< of the present row, with its own words
        std::string row;
        AxisId axis = no_axis;
        std::uint64_t again = 0;        ///< further ones of the row that were not told
        std::uint64_t unpublished = 0;  ///< others that the rate kept back
        Instant row_published{};
        Instant received{};
    };
    Client& client_of(std::string_view host, Instant now);
    void tell(Client& c, std::string words, Instant now);
    void end_row(Client& c, Instant now);

    Tell tell_;
    std::string_view what_;  // a word that lives as long as the program
    Duration row_lasts_;
    Bucket all_;
    std::uint64_t counted_only_ = 0;
    std::vector<Client> clients_;
};

}  // namespace axisgate
