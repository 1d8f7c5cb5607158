// Maintains the list of alarms: feeds it with events and time, stores the changes, and reports them to the live feed and as events. Bounds:
// those of AlarmList; one batch of documents is on its way to the disk, and later changes form one further batch; at most 64 answers wait
// for a batch, and further ones are refused. Service thread only; the owner calls on_deadline.
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
    static constexpr Duration publish_period = std::chrono::milliseconds(200);  ///< the shortest time between two publications of the list
    static constexpr std::size_t most_waiting = 64;

    using Needs = PortSet<ClockPort, DocumentPort, EventPort, SitePort>;
    AlarmService(const Needs& ports, std::function<Instant()> clock);
    ~AlarmService() override;
    AlarmService(const AlarmService&) = delete;
    AlarmService& operator=(const AlarmService&) = delete;
    /// Reads the stored alarms, then the events after them; then listens.
    void begin();
    /// Stops listening, and sends no more requests.
    void detach();

    /// Called when deadline() may have changed for another reason than on_deadline.
    std::function<void()> rearm;
    /// Called with the list when it has changed.
    std::function<void(const boost::json::object& list)> publish;

    [[nodiscard]] const AlarmList& list() const noexcept { return list_; }
    /// {"unacknowledged", "dropped", "alarms"}: active alarms first, then newest first. The counts are of all alarms, whatever the filter
    /// is.
    [[nodiscard]] boost::json::object document(std::optional<AlarmFilter> only = std::nullopt) const;

    using Then = std::function<void(std::string fault)>;
    /// Each returns an empty text, or the reason for a refusal; `then` gets an empty text when the change is on the disk, or the reason why
    /// not.
    [[nodiscard]] std::string acknowledge(const std::vector<std::uint64_t>& ids, const std::string& comment, const Origin& origin,
                                          Then then);
    [[nodiscard]] std::string shelve(std::uint64_t id, std::int64_t for_s, const std::string& reason, const Origin& origin, Then then);
    [[nodiscard]] std::string unshelve(std::uint64_t id, const Origin& origin, Then then);
    /// All alarms that can be acknowledged now.
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
    std::uint64_t seen_ = 0;  ///< the newest event that the list includes
    bool unpublished_ = false;
    Instant published_{};
};

[[nodiscard]] boost::json::object alarm_document(const Alarm& alarm);

}  // namespace axisgate
