// One twin under the fuzzer's control: whatever frames, times, memories and conditions it gets, the laws of twin.hpp hold; the program is
// aborted when one is broken. The protocol is known only to the target in adapters/<family>/fuzz.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "gateway/core/twin.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace axisgate::fuzz {

class TwinRun {
public:
    /// `sent` is called with each frame of the twin. Channels 0 to `channels` + 1 are examined: one on each side does not exist.
    TwinRun(std::unique_ptr<Twin> twin, int channels, std::function<void(const Frame&)> sent)
        : twin_(std::move(twin)), channels_(channels), sent_(std::move(sent)) {}

    [[nodiscard]] Instant now() const noexcept { return now_; }

    /// The first start, from any memory: a damaged one is repaired, and the result is the memory that is kept.
    void power_on(const NonVolatile& any) {
        twin_->power_on(any, now_, out_);
        drain();
        revision_ = twin_->non_volatile_revision();
        memory_ = twin_->non_volatile();
    }
    void restart() {
        const NonVolatile before = memory_;
        twin_->power_on(before, now_, out_);
        drain();
        require(twin_->non_volatile() == before, "a memory is kept over power-off as it is");
        revision_ = twin_->non_volatile_revision();
    }
    void frame(const Frame& f) {
        twin_->on_frame(f, now_, out_);
        look();
    }
    void pass(Duration step) {
        const Instant end = now_ + step;
        int met = 0, standing = 0;
        while (twin_->deadline() <= end && met < 2000) {
            const Instant due = std::max(now_, twin_->deadline());
            standing = due == now_ ? standing + 1 : 0;
            require(standing < 1000, "a deadline moves on");
            now_ = due;
            twin_->on_deadline(now_, out_);
            drain();
            ++met;
        }
        now_ = end;
        twin_->on_deadline(now_, out_);
        look();
    }
    void to_deadline() {
        if (twin_->deadline() != never) pass(std::max(Duration{0}, twin_->deadline() - now_));
    }
    void hand(FuzzedDataProvider& in) {
        const auto items = twin_->hand();
        require(!items.empty(), "there is a hand");
        const auto& item = items[in.ConsumeIntegralInRange<std::size_t>(0, items.size() - 1)];
        const std::string name = in.ConsumeIntegralInRange<int>(0, 15) ? item.name : in.ConsumeRandomLengthString(12);
        const Value value = any_value(in);
        const std::string fault = twin_->set_hand(name, value, now_, out_);
        require(item.writable || name != item.name || !fault.empty(), "what is not writable is refused");
        look();
    }

private:
    void drain() {
        require(out_.results.empty() && out_.feedback.empty() && out_.samples.empty(), "a twin gives frames alone");
        require(out_.frames.size() <= 1024, "one call gives a bounded amount");
        for (const auto& tx : out_.frames)
            sent_(tx.frame);
        out_.clear();
    }
    void look() {
        drain();
        for (int channel = 0; channel <= channels_ + 1; ++channel) {
            const auto m = twin_->mechanics(channel, now_);
            require(std::isfinite(m.position) && std::isfinite(m.velocity), "the mechanics stay numbers");
            require(std::fabs(m.velocity) < 1e12, "the mechanics stay within reason");
        }
        if (twin_->non_volatile_revision() == revision_) {
            require(twin_->non_volatile() == memory_, "a changed memory has another revision");
        } else {
            require(twin_->non_volatile_revision() > revision_, "a revision grows");
            revision_ = twin_->non_volatile_revision();
            memory_ = twin_->non_volatile();
        }
    }

    std::unique_ptr<Twin> twin_;
    int channels_;
    std::function<void(const Frame&)> sent_;
    Instant now_ = at_ns(1'000'000'000);
    Out out_;
    std::uint64_t revision_ = 0;
    NonVolatile memory_;
};

}  // namespace axisgate::fuzz
