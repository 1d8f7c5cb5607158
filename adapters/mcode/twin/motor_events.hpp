// MotorEvents: what the motor has to tell the language, in order.
// In: events. Out: the same, oldest first.
// Never more than 64: beyond them the newest is dropped, and no error raises more than one at once.
#pragma once

#include <deque>

#include "adapters/mcode/twin/mechanism.hpp"

namespace axisgate::mcode::twin {

class MotorEvents {
public:
    void emit(MotorEvent::Kind kind, int code = 0, Word word = {}) {
        if (waiting_.size() < limit) waiting_.push_back({kind, code, word});
    }
    void raise(int code) { emit(MotorEvent::Kind::error, code); }
    [[nodiscard]] std::optional<MotorEvent> next() {
        if (waiting_.empty()) return std::nullopt;
        const MotorEvent e = waiting_.front();
        waiting_.pop_front();
        return e;
    }
    void clear() noexcept { waiting_.clear(); }

private:
    static constexpr std::size_t limit = 64;
    std::deque<MotorEvent> waiting_;
};

}  // namespace axisgate::mcode::twin
