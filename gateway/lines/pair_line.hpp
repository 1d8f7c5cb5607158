// PairLine: a line whose other end is in this process, on another thread: the mirror line, which ends in the fleet.
// In: who takes the other end. Out: see StreamLine. Never waits for the other end: what it does not read is bounded by the kernel's buffer
// and the line's own queue; where it closes its end, the line goes down and a new pair is made after a pause.
#pragma once

#include <functional>

#include "gateway/lines/stream_line.hpp"

namespace axisgate {

/// Is given one end of a connected pair of sockets, which is its own from then on; called on the line's thread. Empty: nobody takes it.
using PairEnd = std::function<void(int fd)>;

class PairLine final : public StreamLine {
public:
    PairLine(const LineBase& base, PairEnd other) : StreamLine(base), other_(std::move(other)) {}
    ~PairLine() override { close(); }

private:
    void start() override;
    void on_gone(int error) override;
    PairEnd other_;
};

}  // namespace axisgate
