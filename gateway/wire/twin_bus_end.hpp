// TwinBusEnd: one end of a bus of twins that outlives it, as a cable that is pulled out of a gateway leaves the drives behind it as they
// are. In: a bus. Out: the same line. Never keeps the bus alive by itself: an owner of the bus may be handed over to be kept.
#pragma once

#include <memory>
#include <utility>

#include "gateway/wire/twin_bus.hpp"

namespace axisgate {

class TwinBusEnd final : public Line {
public:
    /// `keeps`: lives as long as this end, such as the owner of the bus.
    explicit TwinBusEnd(TwinBus& bus, std::shared_ptr<void> keeps = {}) : bus_(bus), keeps_(std::move(keeps)) {}
    ~TwinBusEnd() override { bus_.close(); }
    TwinBusEnd(const TwinBusEnd&) = delete;
    TwinBusEnd& operator=(const TwinBusEnd&) = delete;
    void open(LineEvents& events, Instant now) override { bus_.open(events, now); }
    void close() override { bus_.close(); }
    bool send(const Frame& frame, Priority priority, Instant now) override { return bus_.send(frame, priority, now); }
    [[nodiscard]] Instant deadline() const override { return bus_.deadline(); }
    void on_deadline(Instant now) override { bus_.on_deadline(now); }
    [[nodiscard]] LineStatus status(Instant now) const override { return bus_.status(now); }

private:
    TwinBus& bus_;
    std::shared_ptr<void> keeps_;
};

}  // namespace axisgate
