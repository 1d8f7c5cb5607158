// The states of the live feed, each as one prepared frame with a version number that all its clients share. The hub asks; each source is
// examined at most once per instant.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/core/instant.hpp"
#include "gateway/doors/http/stream_queue.hpp"
#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/drives.hpp"
#include "gateway/services/ports/lines.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate::http {

/// `{"topic": ..., "at": ..., "data": ...}` as a WebSocket frame.
[[nodiscard]] SharedFrame stream_message(std::string_view topic, std::int64_t at_unix_ns, const boost::json::value& data);

struct Source {
    enum class Kind : std::uint8_t { axis, drive, line };
    Kind kind = Kind::axis;
    std::string topic;          ///< "axes/feeder"
    std::uint32_t number = 0;   ///< of the topic, for queues; never used twice
    std::size_t index = 0;      ///< in the site's list
    std::uint64_t version = 0;  ///< increases with each frame worth sending
    SharedFrame frame;          ///< the newest

    // the data from which the frame was made
    std::uint64_t picture_revision = 0;
    AxisPicture picture{};
    std::string text;  ///< of drives and lines: the serialised data
    Instant built{}, looked{};
    bool fresh = true;  ///< nothing was made since the site came into force
};

class StreamSources {
public:
    /// If only the instant of an axis' data advances, a frame is sent at this period.
    static constexpr std::chrono::milliseconds time_only_period{1000};
    /// Drives and lines are examined at this period at most.
    static constexpr std::chrono::milliseconds slow_period{250};

    using Needs = PortSet<AxisPort, ClockPort, DrivePort, LinePort, SitePort>;
    explicit StreamSources(const Needs& ports)
        : axes_(ports.get<AxisPort>()),
          clock_(ports.get<ClockPort>()),
          drives_(ports.get<DrivePort>()),
          lines_(ports.get<LinePort>()),
          sites_(ports.get<SitePort>()) {}

    /// Takes another site: sources of the same name stay (their next look makes a new frame if anything differs), others come and go.
    void take_site(std::shared_ptr<const SiteState> site);
    [[nodiscard]] const SiteState& site() const { return *site_; }
    [[nodiscard]] std::shared_ptr<Source> find(std::string_view topic) const;
    [[nodiscard]] const std::map<std::string, std::shared_ptr<Source>, std::less<>>& all() const noexcept { return by_topic_; }
    /// A number for a topic that is not a source ("lines/can0/frames" of one client).
    [[nodiscard]] std::uint32_t next_number() noexcept { return ++last_number_; }

    /// Examines the source and makes a new frame if it changed. `force`: makes one in any case (a snapshot; this alone does not increase
    /// the version). Returns whether this was any work.
    bool look(Source& source, Instant now, bool force = false);

private:
    bool look_axis(Source& source, Instant now, bool force);
    bool look_slow(Source& source, Instant now, bool force);

    const AxisPort& axes_;
    const ClockPort& clock_;
    const DrivePort& drives_;
    const LinePort& lines_;
    const SitePort& sites_;
    std::shared_ptr<const SiteState> site_;
    std::map<std::string, std::shared_ptr<Source>, std::less<>> by_topic_;
    std::uint32_t last_number_ = 0;
};

}  // namespace axisgate::http
