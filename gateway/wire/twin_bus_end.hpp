// One end of a twin bus that outlives it: a cable can be disconnected from a gateway while the drives behind it continue. It does not keep
// the bus alive by itself; an owner of the bus may be passed to it.
#pragma once

#include <memory>
#include <utility>

#include "gateway/wire/twin_bus.hpp"

namespace axisgate {

class TwinBusEnd final : public Line {
public:
    /// `keeps` lives as long as this end, for example the owner of the bus.
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
