// SerialLine: a serial port (RS-232, RS-422, RS-485, a USB adapter) as a line, with the errors of the receiver counted.
// Only a few bytes are left in the driver at a time, because bytes in the driver can no longer be overtaken by a stop.
#pragma once

#include <string>

#include "gateway/core/line_uri.hpp"
#include "gateway/lines/parity_marks.hpp"
#include "gateway/lines/stream_line.hpp"

namespace axisgate {

class SerialLine final : public StreamLine {
public:
    SerialLine(const LineBase& base, std::string path, const SerialSettings& settings);
    ~SerialLine() override { close(); }

private:
    void start() override;
    [[nodiscard]] std::size_t filter(std::span<std::uint8_t> data) override;
    [[nodiscard]] std::size_t room_to_write() override;
    [[nodiscard]] Duration pause_before_write() const override;
    void on_gone(int error) override;

    std::string path_;
    SerialSettings settings_;
    Duration byte_time_;
    std::size_t most_unsent_;  ///< bytes
    ParityMarks marks_;
};

}  // namespace axisgate
