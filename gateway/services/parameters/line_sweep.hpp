// The sweep of one drive on a line that no gateway serves: a site with this drive alone, the wait until the drive answers, the sweep, and
// the frames of the line meanwhile. The adapter only reads (core/only_reads.hpp). The owner drives the time of the gateway. Bounds:
// `start_limit` for the drive to answer; `most_frames` of the line, the oldest are dropped.
#pragma once

#include <memory>
#include <string>

#include "gateway/services/axis_place.hpp"
#include "gateway/services/parameters/drive_comparison.hpp"
#include "gateway/services/recipes/rehearsal_gateway.hpp"

namespace axisgate {

struct LineSweepWish {
    std::string family, uri, address;
    int channel = 1;  ///< the axis within the drive whose parameters are read
    std::uint32_t bit_rate = 0;
    std::map<std::string, std::string> options;  ///< of the line, of the drive and of its twin, with `specimen`
};
/// The site of this drive: one line, one drive, one axis, each with the name of the constant below.
[[nodiscard]] Site site_of(const LineSweepWish& wish, const Families& families);

class LineSweep {
public:
    static constexpr const char *line_name = "line", *drive_name = "drive", *axis_name = "axis";
    static constexpr std::size_t most_frames = 65'536;
    static constexpr Duration start_limit = std::chrono::seconds(10);

    /// `gateway` has a site of site_of() and real lines; it outlives the sweep.
    explicit LineSweep(RehearsalGateway& gateway);
    /// After each step of the gateway: begins the sweep when the drive answers.
    void turn();
    [[nodiscard]] bool over() const noexcept { return over_; }
    /// The time by which turn() must be called.
    [[nodiscard]] Instant deadline() const noexcept { return over_ || started_ ? never : give_up_; }

    /// After the end: what has prevented the sweep ("no uim342 answers ..."); empty: it has begun.
    [[nodiscard]] std::string fault() const;
    /// After the end, without a fault. `memory`: of the twin.
    [[nodiscard]] DriveComparisonInput input(NonVolatile memory, Duration tolerance) const;

private:
    [[nodiscard]] std::vector<SeenFrame> frames() const;
    [[nodiscard]] std::string other_family() const;

    RehearsalGateway& gateway_;
    Instant give_up_;
    AxisPlace axis_;
    std::shared_ptr<AxisJobs> jobs_ = std::make_shared<AxisJobs>();
    SweepPlan plan_;
    std::string identity_, fault_;
    std::shared_ptr<Sweep> sweep_ = std::make_shared<Sweep>();
    std::shared_ptr<bool> swept_ = std::make_shared<bool>(false);
    bool started_ = false, over_ = false;
};

}  // namespace axisgate
