// Refusals: what a door of registers refused, told as events: the sentence that the other doors would say, who asked, register and value.
// In: refusals with their instant. Out: events through `tell`. Verdict codes alone leave a technician guessing; a PLC repeats its request
// a hundred times a second. Never tells more than this:
//   identical refusals of one client in a row   one event at once; then their count, every `row_period` and when the row ends
//   one client (its address)                    5 events at once, then 1 per second; what is beyond is counted and told with the next one
//   all clients                                 32 events at once, then 8 per second
//   clients remembered                          64; then the one that was quiet for longest is forgotten
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/core/event.hpp"
#include "gateway/registers/unit_map.hpp"

namespace axisgate::registers {

/// A request for people; kept while a drive is asked.
struct RequestNote {
    static constexpr std::size_t most_shown = 8;  ///< registers
    std::uint8_t unit = 0;
    std::uint8_t code = 0;  ///< the request's number in the door's protocol, told where nothing else is known of it
    bool write = false;
    Table table = Table::holding_registers;
    std::uint16_t address = 0;
    std::uint16_t count = 0;                ///< 0: the request was too short to say
    std::uint16_t values[most_shown] = {};  ///< the first registers of a write; of coils the first bit
};
/// "unit 1 register 34 = 80", "unit 2 registers 32..35 = 15 1 0 80", "unit 2 holding registers 10..19".
[[nodiscard]] std::string text_of(const RequestNote& note);

class RefusalLog {
public:
    static constexpr double client_burst = 5, client_rate = 1, all_burst = 32, all_rate = 8;  ///< events, events/s
    static constexpr std::size_t most_clients = 64;
    static constexpr Duration row_period = std::chrono::seconds(10);

    using Tell = std::function<void(Event event, AxisId axis)>;
    RefusalLog(Door door, Tell tell) : door_(door), tell_(std::move(tell)) {}

    /// `who`: "192.0.2.7:51123"; clients are told apart by their address. `answer`: what the client was told, in the door's words
    /// ("exception 3"); empty: nothing, the parameter channel shows it.
    void add(std::string_view who, Refused refused, const RequestNote& note, std::string_view answer, Instant now);
    /// Tells the counts of rows that have lasted for row_period.
    void flush(Instant now);
    /// Something waits for flush().
    [[nodiscard]] bool pending() const noexcept;

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
        AxisId axis = no_axis;
        std::uint64_t again = 0;        ///< further ones of the row that were not told
        std::uint64_t unpublished = 0;  ///< others that the rate kept back
        Instant row_published{};
        Instant received{};
    };
    Client& client_of(std::string_view host, Instant now);
    void tell(Client& c, std::string words, Instant now);
    void end_row(Client& c, Instant now);

    Door door_;
    Tell tell_;
    Bucket all_;
    std::vector<Client> clients_;
};

}  // namespace axisgate::registers
