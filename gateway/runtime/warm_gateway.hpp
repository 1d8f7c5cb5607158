// WarmGateway: the Gateway that HTTP sees: it gives commands to the hot thread, sites and queries to the store, and keeps the newest samples.
// In: calls on the warm thread; mailboxes from hot and cold. Out: callbacks on the warm executor.
// Never used on another thread. Bounded: so many commands wait at most; the next is told to come again.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

#include "gateway/registers/register_image.hpp"
#include "gateway/runtime/event_outlet.hpp"
#include "gateway/services/gateway.hpp"
#include "gateway/runtime/cold.hpp"
#include "gateway/runtime/hot.hpp"
#include "gateway/store/reader.hpp"

namespace axisgate {

class WarmGateway final : public Gateway {
public:
    /// `reader` is this thread's own connection to the database.
    WarmGateway(boost::asio::io_context& warm, Hot& hot, Cold& cold, Families families, std::unique_ptr<StoreReader> reader);

    [[nodiscard]] Mailbox<Result>& results() noexcept { return results_; }
    [[nodiscard]] Mailbox<Sample>& samples() noexcept { return samples_; }
    /// Events that the cold thread has numbered; called on the cold thread.
    void events_written(std::vector<Event> events);
    [[nodiscard]] std::uint64_t lost_events() const noexcept { return events_.lost(); }
    void set_doors(std::vector<DoorInfo> doors) { doors_ = std::move(doors); }
    void set_site(std::shared_ptr<const SiteState> site);
    /// More sentences for not_ready and more lines for metrics, from the service.
    std::function<std::vector<std::string>()> more_not_ready;
    std::function<std::string()> more_metrics;
    /// The Modbus door, from the service; called on the hot thread.
    std::function<ModbusReport()> modbus_on_hot;
    std::function<void(bool)> modbus_read_only_on_hot;
    void modbus_report(std::function<void(std::optional<ModbusReport>)> then) override;
    void set_modbus_read_only(bool on, Origin origin, std::function<void(std::string, bool)> then) override;

    [[nodiscard]] std::vector<DoorInfo> doors() const override { return doors_; }
    [[nodiscard]] double uptime_s() const override;
    [[nodiscard]] std::int64_t now_unix_ns() const override;
    [[nodiscard]] std::int64_t to_unix_ns(Instant instant) const override;
    [[nodiscard]] const Families& families() const override { return families_; }
    [[nodiscard]] std::vector<std::string> not_ready() const override;
    [[nodiscard]] std::string metrics() const override;
    [[nodiscard]] std::shared_ptr<const SiteState> site() const override { return site_; }
    void apply_site(Site site, std::uint64_t expected_revision, Origin origin, std::function<void(SiteAnswer)> then) override;
    [[nodiscard]] AxisPicture picture(AxisId axis) const override;
    [[nodiscard]] std::uint64_t picture_revision(AxisId axis) const override;
    Ticket submit(Command command, std::function<void(const Result&)> then) override;
    void set_point(SetPoint set_point) override { hot_.set_points().put(std::move(set_point)); }
    void client_lost(const AuthorityClient& who, LossCause cause) override;
    [[nodiscard]] LiveParameter live(AxisId axis, Point point) const override;
    [[nodiscard]] std::vector<StoredParameter> stored(const std::string& axis) const override;
    [[nodiscard]] std::vector<StoredParameter> history(const std::string& axis, const std::string& parameter, std::size_t limit) const override;
    [[nodiscard]] LineReport line_report(LineId line) const override;
    [[nodiscard]] DriveStatus drive_status(DriveId drive) const override;
    [[nodiscard]] Trace trace(LineId line, std::uint64_t since, std::size_t limit) const override;
    void hand(DriveId drive, std::function<void(std::optional<std::vector<HandItem>>)> then) override;
    void set_hand(DriveId drive, std::vector<std::pair<std::string, Value>> items, Origin origin, std::function<void(std::string)> then) override;
    [[nodiscard]] std::vector<Event> events(const EventQuery& query) const override;
    void events_settled(std::function<void()> then) override;
    void listen(GatewayListener* listener) override { listeners_.push_back(listener); }
    void unlisten(GatewayListener* listener) override { std::erase(listeners_, listener); }
    void note(Event event) override;
    void start_scan(LineId line, ScanWish wish, Origin origin, std::function<void(std::string)> then) override;
    void cancel_scan(LineId line, std::function<void(ScanReport)> then) override;
    void scan_report(LineId line, std::function<void(ScanReport)> then) override;
    [[nodiscard]] std::vector<Document> documents(const std::string& kind) const override;
    [[nodiscard]] std::optional<Document> document(const std::string& kind, const std::string& name) const override;
    void save_document(const std::string& kind, Document document, std::function<void(std::string)> then) override;
    void delete_document(const std::string& kind, const std::string& name, std::function<void(std::string)> then) override;

    // --- warm_keep.cpp: what is kept, staged, and read from the registers ---
    /// The hot thread's register image; before start.
    void use_registers(registers::RegisterImage& image) { registers_ = &image; }
    [[nodiscard]] std::vector<SnapshotInfo> snapshots(const std::string& axis) const override;
    [[nodiscard]] std::optional<AxisSnapshot> snapshot(const std::string& axis, std::uint32_t n) const override;
    void save_snapshot(AxisSnapshot snapshot, std::string axis, std::function<void(std::uint32_t n, std::string fault)> then) override;
    void delete_snapshot(std::string axis, std::uint32_t n, std::function<void(std::string fault)> then) override;
    [[nodiscard]] std::vector<SiteRevision> site_history(std::size_t limit, std::uint64_t before) const override;
    [[nodiscard]] std::optional<SiteRevision> site_revision(std::uint64_t revision) const override;
    [[nodiscard]] const SiteStage& site_stage() const override { return stage_; }
    std::string stage_site(Site site, std::uint64_t base_revision, const Origin& origin) override;
    std::string discard_stage() override { return stage_.discard(); }
    void apply_stage(std::uint32_t confirm_within_s, Origin origin, std::function<void(SiteAnswer)> then) override;
    void confirm_stage(Origin origin, std::function<void(std::string fault)> then) override;
    void roll_back_stage(Origin origin, std::function<void(SiteAnswer)> then) override;
    void read_registers(std::uint8_t unit, registers::Table table, std::uint16_t address, std::uint16_t count,
                        std::function<void(std::optional<registers::RegisterRead>)> then) override;
    void backup(std::function<void(std::optional<std::string> bytes, std::string fault)> then) override;
    void restore(std::string bytes, Origin origin, std::function<void(RestoreFault)> then) override;
    void waiting_backup(std::function<void(std::optional<WaitingBackup>)> then) override;
    void cancel_restore(Origin origin, std::function<void(std::string fault)> then) override;

private:
    /// What was said, by whom (AxisPicture::source) and when.
    struct Said {
        LiveParameter what;
        std::uint32_t source = 0;
        Instant at{};
    };
    void take(Sample&& sample);
    void arm_trial(std::chrono::nanoseconds from_now);
    void take_back(Origin origin, std::string why, std::function<void(SiteAnswer)> then);
    void tell_site(std::string text, const Origin& origin, Severity severity);
    void answer(Result&& result);
    void finish_site(bool good, std::string fault, std::shared_ptr<const SiteState> state, const std::function<void(SiteAnswer)>& then, bool not_stored = false);

    boost::asio::io_context& io_;
    Hot& hot_;
    Cold& cold_;
    Families families_;
    std::unique_ptr<StoreReader> reader_;
    Mailbox<Result> results_;
    Mailbox<Sample> samples_;
    std::shared_ptr<const SiteState> site_ = std::make_shared<const SiteState>();
    std::vector<DoorInfo> doors_;
    registers::RegisterImage* registers_ = nullptr;  // of the hot thread, for its jobs
    EventOutlet events_;
    std::vector<GatewayListener*> listeners_;
    std::unordered_map<Ticket, std::function<void(const Result&)>> waiting_;
    std::unordered_map<std::uint64_t, Said> live_;  // by axis << 32 | parameter << 16 | element
    std::uint64_t next_ticket_ = 1;
    bool applying_ = false;
    SiteStage stage_;
    boost::asio::steady_timer trial_{io_};
    Site trial_base_;  // what an applied stage is taken back to
    bool on_trial_ = false;    ///< the site that is being put in force may be taken back: what the store knows by name stays until it is confirmed
    bool confirming_ = false;  ///< the disk is asked; until it has answered nothing is rolled back
    Instant started_;
};

}  // namespace axisgate
