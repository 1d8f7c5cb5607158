// Register writer: carries the writes of one door's clients into the register image: plans, tickets, time-outs, refusals.
// In: checked writes, results, time. Out: commands; each owner told once per command; events and registers 20 and 21 for what was refused.
// Never answers a client, never carries out a part of a write that it must refuse. Bounds: Settings::max_commands on their way, then busy.
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
        Door door = Door::none;                              ///< whose clients write, for events and authority
        Duration result_timeout = std::chrono::seconds(30);  ///< a result that has not come by then is taken for "no answer"
        std::size_t max_commands = 4096;                     ///< on their way at once, of all clients; a write beyond is answered busy
        /// What the door tells a client for a verdict: "exception 3".
        std::string (*answer)(Verdict) = nullptr;
    };
    struct Counters {
        Counter commands;           ///< given to the engine
        Counter results_unclaimed;  ///< results that nobody waited for any more: the client has gone, or it came after the time-out
        Counter results_timed_out;  ///< answered with no_answer by the writer itself
    };
    /// Who writes; lives until forget().
    struct Client {
        WriteOwner* owner = nullptr;
        std::shared_ptr<const std::string> who;       ///< for the audit: "192.0.2.7:51123"
        std::shared_ptr<const std::string> client{};  ///< by which it holds an axis; absent: `who` without its port
    };

    RegisterWriter(DoorPort& port, RegisterImage& image, Settings settings);
    ~RegisterWriter() override;
    RegisterWriter(const RegisterWriter&) = delete;
    RegisterWriter& operator=(const RegisterWriter&) = delete;
    /// The door's number, before the first write.
    void use_number(DoorNumber number) noexcept { tickets_.use_number(number); }

    struct Begun {
        Verdict verdict = Verdict::good;  ///< then `outstanding` calls of on_written(slot) come; else nothing was written
        std::uint16_t outstanding = 0;
    };
    /// `data` as UnitMap::write has it. Never tells the owner from inside this call.
    [[nodiscard]] Begun write(const Client& client, std::uint8_t slot, UnitMap& map, Table table, std::uint16_t address,
                              std::uint16_t count, const std::uint8_t* data, const RequestNote& note, Instant now);

    /// Gives what a map has planned; `plan` is used up. busy: there is no room, and the map has been told.
    [[nodiscard]] Begun give(const Client& client, std::uint8_t slot, UnitMap& map, WritePlan& plan, const RequestNote& note, Instant now);

    /// One of the door's tickets has ended.
    void on_result(const Result& result);
    /// The client has gone: results of its commands go to nobody.
    void forget(const WriteOwner& owner) noexcept { tickets_.forget(&owner); }
    void forget(const UnitMap& map) noexcept override { tickets_.forget(&map); }
    /// Ends what has waited longer than the result time-out, and tells refusals that have gathered. To be called now and then.
    void sweep(Instant now);
    /// Something waits for sweep().
    [[nodiscard]] bool waits() const noexcept { return tickets_.used() > 0 || refusals_.pending(); }
    [[nodiscard]] std::size_t waiting() const noexcept { return tickets_.used(); }

    /// Leaves an event and, for a write, the axis' registers 20 and 21. `answer`: as RefusalLog::add has it.
    void refused(const std::string& who, Refused why, const RequestNote& note, std::string_view answer, Instant now);
    /// An event of what is no register: `what` was to be written and was refused, because of `why`.
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
