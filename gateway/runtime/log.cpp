// One line of text, or one datagram of the journal, for each event. Two loggers share one sink: the default one, whose lines are limited by
// their text, and one for events, which are limited by their cause.
#include "gateway/runtime/log.hpp"

#include <fmt/core.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <array>
#include <memory>
#include <mutex>

#include "gateway/core/plain_text.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/journal.hpp"

namespace axisgate {
namespace {
constexpr auto events_logger = "axisgate.events";

std::shared_ptr<Journal>& the_journal() {
    static std::shared_ptr<Journal> journal;
    return journal;
}

int priority_of(spdlog::level::level_enum level) {
    switch (level) {
        case spdlog::level::critical:
            return 2;
        case spdlog::level::err:
            return 3;
        case spdlog::level::warn:
            return 4;
        case spdlog::level::info:
            return 6;
        default:
            return 7;
    }
}

class JournalSink final : public spdlog::sinks::base_sink<std::mutex> {
    void sink_it_(const spdlog::details::log_msg& m) override {
        (void)the_journal()->send(priority_of(m.level), {m.payload.data(), m.payload.size()});
    }
    void flush_() override {}
};

/// Every line passes this sink: names and texts of unknown origin stay on their line and cannot move the cursor.
class PlainSink final : public spdlog::sinks::base_sink<std::mutex> {
public:
    explicit PlainSink(spdlog::sink_ptr end) : end_(std::move(end)) {}

private:
    void sink_it_(const spdlog::details::log_msg& m) override {
        const std::string_view text(m.payload.data(), m.payload.size());
        if (is_plain(text)) return end_->log(m);
        const std::string shown = one_line(text);
        spdlog::details::log_msg plain = m;
        plain.payload = shown;
        end_->log(plain);
    }
    void flush_() override { end_->flush(); }

    spdlog::sink_ptr end_;
};

/// Passes on the lines that the limit allows.
class LimitedSink final : public spdlog::sinks::base_sink<std::mutex> {
public:
    explicit LimitedSink(spdlog::sink_ptr end) : end_(std::move(end)) {}

private:
    void sink_it_(const spdlog::details::log_msg& m) override {
        const Instant now = monotonic_now();
        for (const auto& h : limit_.ended(now)) {
            const std::string text =
                fmt::format("{} more times within {} s: {}", h.lines, LogLimit::period / std::chrono::seconds(1), h.cause);
            end_->log({m.logger_name, m.level, text});
        }
        if (limit_.allows({m.payload.data(), m.payload.size()}, now)) end_->log(m);
    }
    void flush_() override { end_->flush(); }

    spdlog::sink_ptr end_;
    LogLimit limit_;
};

spdlog::level::level_enum level_of(Severity s) {
    return s == Severity::alarm ? spdlog::level::err : s == Severity::warning ? spdlog::level::warn : spdlog::level::info;
}

void log_event(const Event& e) {
    const auto level = level_of(e.severity);
    const auto log = spdlog::get(events_logger);
    if (!log || !log->should_log(level)) return;
    if (const auto& journal = the_journal()) {
        const std::string code = e.code == 0 ? std::string() : fmt::format("{}", e.code);
        const std::string id = e.id == 0 ? std::string() : fmt::format("{}", e.id);
        const std::array<Journal::Field, 11> fields{{{"AXISGATE_KIND", e.kind},
                                                     {"AXISGATE_LINE", e.line},
                                                     {"AXISGATE_DRIVE", e.drive},
                                                     {"AXISGATE_AXIS", e.axis},
                                                     {"AXISGATE_DOOR", e.door},
                                                     {"AXISGATE_WHO", e.who},
                                                     {"AXISGATE_CODE", code},
                                                     {"AXISGATE_EVENT", id},
                                                     {"AXISGATE_PARAMETER", e.parameter},
                                                     {"AXISGATE_OLD", e.old_value},
                                                     {"AXISGATE_NEW", e.new_value}}};
        (void)journal->send(priority_of(level), one_line(fmt::format("{}: {}", e.kind, e.text)), fields);
        return;
    }
    std::string where;
    if (!e.line.empty()) where += " line=" + e.line;
    if (!e.drive.empty()) where += " drive=" + e.drive;
    if (!e.axis.empty()) where += " axis=" + e.axis;
    if (!e.door.empty()) where += " by=" + e.door + (e.who.empty() ? "" : "/" + e.who);
    log->log(level, "{}{}: {}", e.kind, where, e.text);
}
}  // namespace

bool open_log(const Config& c) {
    try {
        spdlog::sink_ptr end;
        if (!c.log_file.empty()) {
            end = std::make_shared<spdlog::sinks::basic_file_sink_mt>(c.log_file);
        } else if (Journal::is_standard_error()) {
            the_journal() = std::make_shared<Journal>();
            end = std::make_shared<JournalSink>();
        } else {
            end = std::make_shared<spdlog::sinks::stderr_sink_mt>();
        }
        end->set_pattern("%Y-%m-%dT%H:%M:%S.%f%z %l %v");
        end = std::make_shared<PlainSink>(std::move(end));
        const auto level = spdlog::level::from_str(c.log_level);
        auto lines = std::make_shared<spdlog::logger>("axisgate", std::make_shared<LimitedSink>(end));
        auto events = std::make_shared<spdlog::logger>(events_logger, end);
        for (const auto& log : {lines, events}) {
            log->set_level(level);
            log->flush_on(spdlog::level::info);
        }
        spdlog::register_logger(std::move(events));
        spdlog::set_default_logger(std::move(lines));
        return true;
    } catch (const spdlog::spdlog_ex& e) {
        complain(
            fmt::format("cannot open the log file {}: {}; check the folder and its rights, or leave log.file empty", c.log_file, e.what()));
        return false;
    }
}

void LogListener::on_event(const Event& event) {
    const Instant now = monotonic_now();
    for (const auto& h : limit_.ended(now)) {
        Event more;
        more.severity = Severity::warning;
        more.kind = "log";
        more.text = fmt::format("{} more events of {} within {} s: all of them are in /events", h.lines, h.cause,
                                LogLimit::period / std::chrono::seconds(1));
        log_event(more);
    }
    const std::string cause =
        fmt::format("{}{}{}{}{}{}{}", event.kind, event.line.empty() ? "" : " line ", event.line, event.drive.empty() ? "" : " drive ",
                    event.drive, event.axis.empty() ? "" : " axis ", event.axis);
    if (limit_.allows(cause, now)) log_event(event);
}

}  // namespace axisgate
