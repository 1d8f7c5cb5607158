// Limits events that clients can cause at any rate (refusals above all), so that people can read all of them and nobody can flood the
// storage. Events pass through `tell` at most at these rates:
//   identical events of one client in a row     one event at once; then their count, every `row_period` and when the row ends
//   one client (its address)                    5 events at once, then 1 per second; further ones are counted and reported with the next
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
    /// `what` is the word for the events in the counts.
    explicit EventRows(Tell tell, std::string_view what = "refusals", Duration row_lasts = row_period)
        : tell_(std::move(tell)), what_(what), row_lasts_(row_lasts) {}

    /// `host` is the client's address, by which clients are distinguished. `row` is the key by which two events are identical; empty: their
    /// texts.
    void add(std::string_view host, AxisId axis, Event event, std::string row, Instant now);
    /// Reports the counts of rows that have lasted for `row_period`.
    void flush(Instant now);
    /// True if there is work for flush().
    [[nodiscard]] bool pending() const noexcept;
    /// Number of events since the start that were reported only as part of a count.
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
        std::uint64_t again = 0;        ///< further events of the row that were not reported
        std::uint64_t unpublished = 0;  ///< other events that the rate kept back
        Instant row_published{};
        Instant received{};
    };
    Client& client_of(std::string_view host, Instant now);
    void tell(Client& c, std::string words, Instant now);
    void end_row(Client& c, Instant now);

    Tell tell_;
    std::string_view what_;  // a text that lives as long as the program
    Duration row_lasts_;
    Bucket all_;
    std::uint64_t counted_only_ = 0;
    std::vector<Client> clients_;
};

}  // namespace axisgate
