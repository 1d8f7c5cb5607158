// Trend disk: trends that survive a restart: once a minute what is new goes into a file of its own; at the start the files are read.
// In: trends of the service thread; which axes, and their names, by the site in force. Out: files, written on the disk's thread; rows of
// before, given to an axis when it is heard first. Bounded: the oldest files go where they take more than `bound`. A file that is damaged
// is passed over and said.
#pragma once

#include <boost/asio/thread_pool.hpp>
#include <map>
#include <string>
#include <vector>

#include "gateway/services/recorder/trends.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

class TrendDisk {
public:
    static constexpr Duration period = std::chrono::minutes(1);

    /// `unmarked`: where the site marks no axis (AxisSpec::trend_on_disk), all of them are kept, and else none.
    TrendDisk(boost::asio::thread_pool& disk, std::string directory, std::uint64_t bound, bool unmarked)
        : disk_(disk), directory_(std::move(directory)), bound_(bound), unmarked_(unmarked) {}
    /// Reads what is not older than `keep`. `unix_offset_ns`: what makes an instant of this run a time. Empty, or what could not be read.
    [[nodiscard]] std::string open(std::int64_t now_unix_ns, std::int64_t unix_offset_ns, Duration keep);
    /// Before the first row of an axis: what was known of it goes first.
    void bring_back(AxisId axis, Trends& trends, const SiteState& site);
    /// Writes if it is time.
    void keep(const Trends& trends, const SiteState& site, Instant now, std::int64_t unix_offset_ns);
    /// Writes what is left, on this thread.
    void end(const Trends& trends, const SiteState& site, Instant now, std::int64_t unix_offset_ns);

private:
    /// Empty: there is nothing to keep.
    [[nodiscard]] std::string packed(const Trends& trends, const SiteState& site, Instant now, std::int64_t unix_offset_ns) const;
    boost::asio::thread_pool& disk_;
    std::string directory_;
    std::uint64_t bound_;
    bool unmarked_;
    std::map<std::string, std::vector<TrendRow>> old_;  ///< by name of the axis
    Instant written_{};                                 ///< up to here; what comes before open() is in older files
};

}  // namespace axisgate
