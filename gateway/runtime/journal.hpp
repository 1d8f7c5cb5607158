// Sends datagrams to systemd's journal, so that events can be searched by field. It never blocks and needs no library. (systemd: native
// journal protocol)
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace axisgate {

class Journal {
public:
    using Field = std::pair<std::string_view, std::string_view>;  ///< "AXISGATE_AXIS", "feeder"; an empty value is left out

    /// True if this process's standard error is the journal: lines written there would lose their fields. (systemd.exec(5), JOURNAL_STREAM)
    [[nodiscard]] static bool is_standard_error() noexcept;
    explicit Journal(const std::string& socket_path = "/run/systemd/journal/socket");
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// `priority` is 0 (emergency) to 7 (debug), as in syslog(3). Returns false if the journal did not accept it.
    bool send(int priority, std::string_view message, std::span<const Field> fields = {}) const;

private:
    int fd_ = -1;
};

}  // namespace axisgate
