// Alarm service: keeps the list of alarms: feeds it with events and time, stores what changed, tells the live feed and the events who did
// what. In: events, sites, acknowledgements and shelves, the clock it is given. Out: the list, documents, progress.
// Bounds: those of AlarmList; one batch of documents is on its way to the disk, what changes meanwhile is one further batch; at most 64
// answers wait for a batch, the next one is refused.
// Never used off the warm thread; never sleeps: whoever owns it calls on_deadline.
#pragma once

#include <boost/json/object.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/services/alarms/alarm.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/documents.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

class AlarmService final : public EventListener, public SiteListener, public std::enable_shared_from_this<AlarmService> {
public:
    static constexpr Duration publish_period = std::chrono::milliseconds(200);  ///< of the list, at most
    static constexpr std::size_t most_waiting = 64;

    using Needs = PortSet<ClockPort, DocumentPort, EventPort, SitePort>;
    AlarmService(const Needs& ports, std::function<Instant()> clock);
    ~AlarmService() override;
    AlarmService(const AlarmService&) = delete;
    AlarmService& operator=(const AlarmService&) = delete;
    /// Reads what is kept, and the events that came after it was kept; then listens.
    void begin();
    /// Listens no more, and asks nothing more.
    void detach();

    /// Called when deadline() may have changed by another cause than on_deadline.
    std::function<void()> rearm;
    /// The list, when it has changed.
    std::function<void(const boost::json::object& list)> publish;

    [[nodiscard]] const AlarmList& list() const noexcept { return list_; }
    /// {"unacknowledged", "dropped", "alarms"}: active ones first, then newest first. The counts are of all, whatever is asked for.
    [[nodiscard]] boost::json::object document(std::optional<AlarmFilter> only = std::nullopt) const;

    using Then = std::function<void(std::string fault)>;
    /// Each: empty, or why not; `then` is called when it is on disk (empty), or why it is not.
    [[nodiscard]] std::string acknowledge(const std::vector<std::uint64_t>& ids, const std::string& comment, const Origin& origin,
                                          Then then);
    [[nodiscard]] std::string shelve(std::uint64_t id, std::int64_t for_s, const std::string& reason, const Origin& origin, Then then);
    [[nodiscard]] std::string unshelve(std::uint64_t id, const Origin& origin, Then then);
    /// All that can be acknowledged now.
    [[nodiscard]] std::vector<std::uint64_t> open() const;

    [[nodiscard]] Instant deadline() const;
    void on_deadline(Instant now);

    void on_event(const Event& event) override;
    void on_site(const std::shared_ptr<const SiteState>& site) override;

private:
    struct Batch;
    void changed();
    void keep();
    void note(const Alarm& alarm, const std::string& what, const Origin& origin);
    [[nodiscard]] bool busy() const { return waiting_.size() >= most_waiting; }

    ClockPort& wall_;
    DocumentPort& documents_;
    EventPort& events_;
    SitePort& sites_;
    std::function<Instant()> clock_;
    AlarmList list_;
    bool attached_ = false;
    bool saving_ = false, fault_published_ = false;
    std::set<std::uint64_t> unsaved_;
    std::vector<Then> waiting_;
    std::uint64_t seen_ = 0;  ///< newest event that the list knows of
    bool unpublished_ = false;
    Instant published_{};
};

[[nodiscard]] boost::json::object alarm_document(const Alarm& alarm);

}  // namespace axisgate
