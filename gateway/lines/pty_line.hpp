// PtyLine: a pseudo-terminal made by us, under a name of the user's choice: a serial port that any program can open.
// In: a path at which to put the link. Out: see StreamLine.
// Never overwrites anything but a link, and takes away at the end only its own. Bytes that are sent while nobody has the other side open
// are lost, as on a cable without a listener.
#pragma once

#include <string>

#include "gateway/lines/stream_line.hpp"

namespace axisgate {

class PtyLine final : public StreamLine {
public:
    PtyLine(const LineBase& base, std::string path);
    ~PtyLine() override { close(); }

private:
    void start() override;
    void stop() override;
    void flush() override;
    void on_gone(int error) override;
    [[nodiscard]] std::string up_text() const override;
    void watch_for_somebody();

    std::string path_;
    std::string slave_;      // what the link points to; empty: there is no link of ours
    bool somebody_ = false;  // has the other side open
    asio::steady_timer watch_;
};

}  // namespace axisgate
