// Bench commands: what the benches of the adapter share: commands go in, their results and the drives' links come out.
// In: a bench with `adapter`, `setup`, `now`, `out`, `drain` and `run`. Out: the same bench with commands.
// Never moves time by itself but in `wait`.
#pragma once

#include <gtest/gtest.h>

#include "adapters/mcode/adapter.hpp"

namespace axisgate::mcode::test {

/// `Bench` derives from it.
template <class Bench>
struct BenchCommands {
    std::vector<Result> results;
    std::vector<DriveLink> links;
    Ticket next = 1;

    Ticket command(CommandBody body, std::size_t axis = 0, bool until_done = false) {
        Command c;
        c.ticket = next++;
        c.until_done = until_done;
        c.axis = AxisId{static_cast<std::uint16_t>(axis)};
        c.body = std::move(body);
        bench().adapter.on_command(c, bench().now, bench().out);
        bench().drain();
        return c.ticket;
    }
    const Result* result(Ticket t) const {
        for (const auto& r : results) {
            if (r.ticket == t) return &r;
        }
        return nullptr;
    }
    /// The result, waited for in the bench's time.
    Result wait(CommandBody body, std::size_t axis = 0, Duration limit = std::chrono::seconds(10)) {
        constexpr Duration step = std::chrono::milliseconds(5);
        const Ticket t = command(std::move(body), axis);
        for (Duration d{}; d < limit && !result(t); d += step)
            bench().run(step);
        const Result* r = result(t);
        if (!r) ADD_FAILURE() << "no result";
        return r ? *r : Result{};
    }
    bool online(std::size_t drive = 0) const {
        bool on = false;
        for (const auto& l : links) {
            if (l.drive == static_cast<const Bench*>(this)->setup.drives[drive].id) on = l.online;
        }
        return on;
    }

private:
    Bench& bench() { return static_cast<Bench&>(*this); }
};

}  // namespace axisgate::mcode::test
