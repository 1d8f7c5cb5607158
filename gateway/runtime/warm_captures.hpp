// The capture port: running captures, fed by the recorder's records, and those that are stored as files. The hot thread is asked to poll
// faster; the engine ends this by itself in any case.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/runtime/file_shelf.hpp"
#include "gateway/runtime/warm_recorder.hpp"
#include "gateway/services/ports/captures.hpp"

namespace axisgate {

class WarmCaptures final : public CapturePort, RecordListener {
public:
    static constexpr std::size_t most_given_up = 8;  ///< shown until their names are used again; beyond this number the oldest is removed
    static constexpr Duration records_late = std::chrono::milliseconds(600);  ///< delay of records behind the time

    WarmCaptures(const WarmThreads& threads, WarmRecorder& recorder, EventPort& events)
        : threads_(threads), recorder_(recorder), events_(events), shelf_(threads, recorder.disk(), "capture", ".axc") {}
    ~WarmCaptures() override;
    WarmCaptures(const WarmCaptures&) = delete;
    WarmCaptures& operator=(const WarmCaptures&) = delete;

    /// Must follow the recorder's begin().
    void begin(const RecorderSettings& settings);

    [[nodiscard]] CaptureRoom capture_room() const override { return {shelf_.bytes(), bound_, shelf_.disk_fault()}; }
    [[nodiscard]] std::vector<CaptureInfo> captures() override;
    void arm(CaptureOrder order, std::function<void(RecordingFault, CaptureInfo)> then) override;
    void load_capture(const std::string& name, std::function<void(RecordingFault, boost::json::array)> then) override;
    void rename_capture(const std::string& name, const std::string& to, std::function<void(RecordingFault)> then) override;
    void remove_capture(const std::string& name, std::function<void(RecordingFault)> then) override;

private:
    /// A capture that is not on the disk.
    struct Running {
        CaptureOrder order;
        Capture capture;
        bool ended = false;    ///< the line was ordered to end the fast polling
        bool written = false;  ///< on its way to the disk
    };
    void on_picture(AxisId axis, const PictureRecord& picture, Instant at) override;
    void on_command(const Command& command, Instant at) override;
    void on_time(Instant now) override;
    void end(Running& r);
    void keep(const std::shared_ptr<Running>& r);
    void forget_oldest();
    [[nodiscard]] std::shared_ptr<Running> running(const std::string& name) const;
    [[nodiscard]] static CaptureInfo info_of(const Running& r);

    const WarmThreads& threads_;
    WarmRecorder& recorder_;
    EventPort& events_;
    std::uint64_t bound_ = 0;
    std::deque<std::shared_ptr<Running>> running_;  ///< including those that were given up
    FileShelf<CaptureInfo> shelf_;
};

}  // namespace axisgate
