// The destination of the program's lines and events: standard error, a file, or systemd's journal with a field for each part of an event.
// LogLimit prevents that one cause fills the log.
#pragma once

#include "gateway/core/event.hpp"
#include "gateway/runtime/config.hpp"
#include "gateway/runtime/log_limit.hpp"
#include "gateway/services/ports/events.hpp"

namespace axisgate {

/// Makes spdlog's default logger. Returns false if the file cannot be opened, which was reported.
[[nodiscard]] bool open_log(const Config& config);

/// Writes events into the log.
class LogListener final : public EventListener {
public:
    void on_event(const Event& event) override;

private:
    LogLimit limit_;
};

}  // namespace axisgate
