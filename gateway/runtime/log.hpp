// Log: where the program's lines and its events go: standard error, a file, or systemd's journal with a field for each part of an event.
// In: the configuration, events. Out: lines. Never lets one cause fill the log: see LogLimit.
#pragma once

#include "gateway/core/event.hpp"
#include "gateway/runtime/config.hpp"
#include "gateway/runtime/log_limit.hpp"
#include "gateway/services/ports/events.hpp"

namespace axisgate {

/// Makes spdlog's default logger. False: the file cannot be opened, which has been said.
[[nodiscard]] bool open_log(const Config& config);

/// Writes events into the log.
class LogListener final : public EventListener {
public:
    void on_event(const Event& event) override;

private:
    LogLimit limit_;
};

}  // namespace axisgate
