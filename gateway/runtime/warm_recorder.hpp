// The recorder port: keeps trends and the last period of records, and writes files on a thread of its own. A full disk is reported and
// stops only the recording. The hot thread never waits: records that cannot be taken in time are lost and counted.
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "gateway/engine/flight_record.hpp"
#include "gateway/runtime/config.hpp"
#include "gateway/runtime/file_shelf.hpp"
#include "gateway/runtime/record_ring.hpp"
#include "gateway/runtime/trend_disk.hpp"
#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/recorder.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

/// The limits of the recorder, and the alarms that cause a recording ([recorder] of the configuration).
struct RecorderSettings {
    std::string directory;               ///< of the recordings
    std::string captures;                ///< folder of the captures
    std::string trends;                  ///< folder of the trends
    std::uint64_t trend_disk_bytes = 0;  ///< 0: they are only in memory
    bool trend_disk_unmarked = false;    ///< all axes, if the site marks none
    Duration trend_length = std::chrono::minutes(10);
    std::size_t trend_bytes = 48u << 20, stretch_bytes = 32u << 20, inputs_bytes = 32u << 20;
    std::uint64_t disk_bytes = 512u << 20, captures_bytes = 64u << 20;
    std::vector<std::string> freeze_on;  ///< kinds of events of severity alarm
};

[[nodiscard]] RecorderSettings recorder_settings(const Config& config);

/// Receives records as they come.
struct RecordListener {
    virtual void on_picture(AxisId axis, const PictureRecord& picture, Instant at) = 0;
    virtual void on_command(const Command& command, Instant at) = 0;
    /// All records up to this instant have been delivered.
    virtual void on_time(Instant now) = 0;
    virtual ~RecordListener() = default;
};

class WarmRecorder final : public RecorderPort, EventListener {
public:
    static constexpr std::size_t ring_bytes = 4u << 20;
    static constexpr Duration after_alarm = std::chrono::seconds(2);      ///< duration of the recording behind it
    static constexpr Duration between_alarms = std::chrono::seconds(60);  ///< that cause a recording

    WarmRecorder(const WarmThreads& threads, EventPort& events, const SitePort& sites)
        : threads_(threads), events_(events), sites_(sites) {}
    ~WarmRecorder() override;
    WarmRecorder(const WarmRecorder&) = delete;
    WarmRecorder& operator=(const WarmRecorder&) = delete;

    /// Before the first site; the tap of the hot thread's engine is set.
    void begin(RecorderSettings settings);

    [[nodiscard]] TrendStretch trend(AxisId axis, Instant from, Instant to, std::size_t columns) override;
    [[nodiscard]] RecorderState recorder_state() override;
    [[nodiscard]] std::vector<RecordingInfo> recordings() const override { return shelf_.newest_first(); }
    void freeze(std::string name, std::string why, std::string who, std::function<void(RecordingFault, RecordingInfo)> then) override;
    void read_stretch(Instant from, std::function<void(const FlightRecord&)> each, std::function<void()> then) override;
    void load_recording(const std::string& name, std::function<void(std::optional<std::string>)> then) override {
        shelf_.load(name, std::move(then));
    }
    void play_back(const std::string& name, PlaybackWish wish, std::function<void(RecordingFault, boost::json::object)> then) override;
    void rename_recording(const std::string& name, const std::string& to, std::function<void(RecordingFault)> then) override {
        shelf_.rename(
            name, to, [](RecordingInfo& i) { i.automatic = false; }, std::move(then));  // a person who names it wants to keep it
    }
    void remove_recording(const std::string& name, std::function<void(RecordingFault)> then) override {
        shelf_.remove(name, std::move(then));
    }
    /// One listener at most; it must outlive this object.
    void listen(RecordListener* listener) { listener_ = listener; }
    [[nodiscard]] boost::asio::thread_pool& disk() noexcept { return disk_; }
    /// Drops jobs that wait for the disk, and waits for the running one.
    void end_disk() {
        disk_.stop();
        disk_.join();
    }
    /// Takes the records up to now.
    void look() { empty(); }

private:
    /// The side on the hot thread.
    struct Tap final : FlightTap {
        RecordRing ring{ring_bytes};
        ~Tap() override;
        void take(const FlightRecord& r) override { (void)ring.push(r); }
        void take_site(std::shared_ptr<const SiteInput> input, Instant now) override;
    };
    void on_event(const Event& event) override;
    void empty();
    /// Takes the next records, at most this number. Returns true if no record is left.
    [[nodiscard]] bool take(std::size_t most);
    void end_look();
    void wait(std::chrono::milliseconds pause);
    void keep(const FlightRecord& r);
    void freeze_this(std::string name, std::string why, std::string who, bool automatic,
                     std::function<void(RecordingFault, RecordingInfo)> then);
    void make_room_for_automatic();
    [[nodiscard]] std::string not_replayable() const;

    const WarmThreads& threads_;
    EventPort& events_;
    const SitePort& sites_;
    RecorderSettings settings_;
    Tap tap_;
    std::unique_ptr<Trends> trends_;
    std::unique_ptr<FlightLog> stretch_, inputs_;
    RecordListener* listener_ = nullptr;
    std::unique_ptr<TrendDisk> trend_disk_;
    bool found_ = false;  ///< records came since the last pause
    Instant frozen_at_{};
    std::unique_ptr<boost::asio::steady_timer> timer_, alarm_timer_;
    boost::asio::thread_pool disk_{1};
    FileShelf<RecordingInfo> shelf_{threads_, disk_, "recording", ".axr"};
};

}  // namespace axisgate
