// PairLine: a line whose other end is in this process, on another thread: the mirror line, whose other end is in the fleet.
// It never waits for the other end: bytes that the other end does not read are bounded by the kernel's buffer and by the line's own
// queue. If the other end is closed, the line goes down and a new pair is created after a pause.
#pragma once

#include <functional>

#include "gateway/lines/stream_line.hpp"

namespace axisgate {

/// Takes ownership of one end of a connected pair of sockets; called on the line's thread. Empty: the other end has no taker.
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
