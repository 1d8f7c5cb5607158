// The axis port: pictures from the hot thread's image, commands through its mailbox, each result back to its sender. Service thread only.
// Bounded: at most 1024 commands wait; further ones are answered busy.
#pragma once

#include <unordered_map>

#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/axes.hpp"

namespace axisgate {

class WarmAxes final : public AxisPort {
public:
    explicit WarmAxes(const WarmThreads& threads);
    /// The mailbox for the results of this thread's commands.
    [[nodiscard]] Mailbox<Result>& results() noexcept { return results_; }

    [[nodiscard]] AxisPicture picture(AxisId axis) const override;
    [[nodiscard]] std::uint64_t picture_revision(AxisId axis) const override;
    Ticket submit(Command command, std::function<void(const Result&)> then) override;
    void set_point(SetPoint set_point) override { threads_.hot.set_points().put(std::move(set_point)); }
    void client_lost(const AuthorityClient& who, LossCause cause) override;

private:
    void answer(Result&& result);

    const WarmThreads& threads_;
    Mailbox<Result> results_;
    std::unordered_map<Ticket, std::function<void(const Result&)>> waiting_;
    std::uint64_t next_ticket_ = 1;
};

}  // namespace axisgate
