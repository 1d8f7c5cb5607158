// Carries the writes of one door's clients into the register image: plans, tickets, time-outs, refusals. A write is never carried out in
// part. Each owner is informed once per command; refusals cause events and registers 20 and 21. Bound: Settings::max_commands outstanding,
// then busy.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "gateway/core/counter.hpp"
#include "gateway/engine/door.hpp"
#include "gateway/registers/refusals.hpp"
#include "gateway/registers/register_image.hpp"
#include "gateway/registers/ticket_table.hpp"

namespace axisgate::registers {

class RegisterWriter final : public MapUser {
public:
    struct Settings {
        Door door = Door::none;                              ///< the door of the clients, for events and authority
        Duration result_timeout = std::chrono::seconds(30);  ///< a result that has not arrived after this time counts as "no answer"
        std::size_t max_commands = 4096;                     ///< limit of outstanding commands of all clients; further writes are answered
                                                             ///< busy
        /// The door's words for a verdict: "exception 3".
        std::string (*answer)(Verdict) = nullptr;
    };
    struct Counters {
        Counter commands;           ///< number of commands given to the engine
        Counter results_unclaimed;  ///< results without a waiting client: it has gone, or the result came after the time-out
        Counter results_timed_out;  ///< answered with no_answer by the writer itself
    };
    /// The client of a write; must live until forget().
    struct Client {
        WriteOwner* owner = nullptr;
        std::shared_ptr<const std::string> who;       ///< for the events: "192.0.2.7:51123"
        std::shared_ptr<const std::string> client{};  ///< the name with which it holds an axis; absent: `who` without its port
    };

    RegisterWriter(DoorPort& port, RegisterImage& image, Settings settings);
    ~RegisterWriter() override;
    RegisterWriter(const RegisterWriter&) = delete;
    RegisterWriter& operator=(const RegisterWriter&) = delete;
    /// The door's number; must be set before the first write.
    void use_number(DoorNumber number) noexcept { tickets_.use_number(number); }

    struct Begun {
        Verdict verdict = Verdict::good;  ///< if good, `outstanding` calls of on_written(slot) follow; otherwise nothing was written
        std::uint16_t outstanding = 0;
    };
    /// `data` as for UnitMap::write. The owner is never called from inside this call.
    [[nodiscard]] Begun write(const Client& client, std::uint8_t slot, UnitMap& map, Table table, std::uint16_t address,
                              std::uint16_t count, const std::uint8_t* data, const RequestNote& note, Instant now);

    /// Gives the commands that a map has planned; `plan` is used up. busy: there is no room, and the map was informed.
    [[nodiscard]] Begun give(const Client& client, std::uint8_t slot, UnitMap& map, WritePlan& plan, const RequestNote& note, Instant now);

    /// One of the door's tickets has ended.
    void on_result(const Result& result);
    /// The client has gone: results of its commands are discarded.
    void forget(const WriteOwner& owner) noexcept { tickets_.forget(&owner); }
    void forget(const UnitMap& map) noexcept override { tickets_.forget(&map); }
    /// Ends commands that have waited longer than the result time-out, and reports collected refusals. Must be called periodically.
    void sweep(Instant now);
    /// True if there is work for sweep().
    [[nodiscard]] bool waits() const noexcept { return tickets_.used() > 0 || refusals_.pending(); }
    [[nodiscard]] std::size_t waiting() const noexcept { return tickets_.used(); }

    /// Causes an event and, for a write, sets the axis' registers 20 and 21. `answer` as for RefusalLog::add.
    void refused(const std::string& who, Refused why, const RequestNote& note, std::string_view answer, Instant now);
    /// Causes an event for something that is not a register: `what` was to be written and was refused because of `why`.
    void refused(const std::string& who, AxisId axis, std::string_view what, std::string_view why, Instant now) {
        refusals_.add(who, axis, what, why, now);
    }
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }

private:
    void own_result(const TicketTable::Waiting& waiting, const Result& result);

    DoorPort& port_;
    RegisterImage& image_;
    Settings settings_;
    TicketTable tickets_;
    WritePlan plan_;
    RefusalLog refusals_;
    Counters counters_;
};

}  // namespace axisgate::registers
