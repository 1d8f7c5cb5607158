// Journal: systemd's journal by its own datagrams, so that what an event says can be searched for by field.
// In: a priority, a message, fields. Out: one datagram. Never blocks, and needs no library. (systemd: native journal protocol)
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace axisgate {

class Journal {
public:
    using Field = std::pair<std::string_view, std::string_view>;  ///< "AXISGATE_AXIS", "feeder"; an empty value is left out

    /// Whether this process's standard error is the journal: then lines on it would lose their fields. (systemd.exec(5), JOURNAL_STREAM)
    [[nodiscard]] static bool is_standard_error() noexcept;
    explicit Journal(const std::string& socket_path = "/run/systemd/journal/socket");
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// `priority`: 0 (emergency) to 7 (debug), as in syslog(3). False: the journal did not take it.
    bool send(int priority, std::string_view message, std::span<const Field> fields = {}) const;

private:
    int fd_ = -1;
};

}  // namespace axisgate
