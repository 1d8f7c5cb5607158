// Streamed set-points on their way from other threads to the hot one: one place per axis, in which the newest one counts. The handler is
// called once per axis with a new set-point, on the receiver's thread. It never blocks, grows or queues: a set-point that was not taken
// when the next one comes is lost.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <functional>
#include <memory>
#include <utility>

#include "gateway/axis/image.hpp"
#include "gateway/core/command.hpp"
#include "gateway/runtime/doorbell.hpp"

namespace axisgate {

class SetPointSlots {
public:
    /// The receiver must be stopped before the slots are destroyed.
    SetPointSlots(Doorbell& receiver, std::function<void(const SetPoint&)> handler)
        : handler_(std::move(handler)), call_(receiver, [this] { empty(); }) {}
    ~SetPointSlots() {
        for (auto& slot : slots_)
            delete slot.load();
    }
    SetPointSlots(const SetPointSlots&) = delete;
    SetPointSlots& operator=(const SetPointSlots&) = delete;

    /// Any thread. An impossible axis is ignored.
    void put(SetPoint p) {
        const std::size_t i = index_of(p.axis);
        if (i >= Image::max_ids) return;
        delete slots_[i].exchange(std::make_unique<SetPoint>(std::move(p)).release(), std::memory_order_acq_rel);
        filled_[i / 64].fetch_or(std::uint64_t{1} << (i % 64), std::memory_order_release);
        call_.ring();
    }

private:
    void empty() {
        for (std::size_t w = 0; w < filled_.size(); ++w) {
            if (filled_[w].load(std::memory_order_relaxed) == 0) continue;
            for (std::uint64_t bits = filled_[w].exchange(0, std::memory_order_acq_rel); bits != 0; bits &= bits - 1) {
                const std::size_t i = w * 64 + static_cast<std::size_t>(std::countr_zero(bits));
                const std::unique_ptr<SetPoint> p(slots_[i].exchange(nullptr, std::memory_order_acq_rel));
                if (p) handler_(*p);
            }
        }
    }

    std::array<std::atomic<SetPoint*>, Image::max_ids> slots_{};
    std::array<std::atomic<std::uint64_t>, Image::max_ids / 64> filled_{};
    std::function<void(const SetPoint&)> handler_;
    Doorbell::Call call_;
};

}  // namespace axisgate
