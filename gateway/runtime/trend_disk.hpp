// Trends that survive a restart: once a minute new rows are written to a file of their own on the disk's thread; at the start the files are
// read, and each axis gets its earlier rows at its first report. Bounded: the oldest files are deleted when all take more than `bound`. A
// damaged file is skipped and reported.
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

    /// `unmarked`: if the site marks no axis (AxisSpec::trend_on_disk), all axes are kept, otherwise none.
    TrendDisk(boost::asio::thread_pool& disk, std::string directory, std::uint64_t bound, bool unmarked)
        : disk_(disk), directory_(std::move(directory)), bound_(bound), unmarked_(unmarked) {}
    /// Reads rows that are not older than `keep`. `unix_offset_ns` converts an instant of this run to a time. Empty, or the data that could
    /// not be read.
    [[nodiscard]] std::string open(std::int64_t now_unix_ns, std::int64_t unix_offset_ns, Duration keep);
    /// Before the first row of an axis: adds its earlier rows.
    void bring_back(AxisId axis, Trends& trends, const SiteState& site);
    /// Writes if it is time.
    void keep(const Trends& trends, const SiteState& site, Instant now, std::int64_t unix_offset_ns);
    /// Writes the rest on this thread.
    void end(const Trends& trends, const SiteState& site, Instant now, std::int64_t unix_offset_ns);

private:
    /// Empty if there is nothing to keep.
    [[nodiscard]] std::string packed(const Trends& trends, const SiteState& site, Instant now, std::int64_t unix_offset_ns) const;
    boost::asio::thread_pool& disk_;
    std::string directory_;
    std::uint64_t bound_;
    bool unmarked_;
    std::map<std::string, std::vector<TrendRow>> old_;  ///< by name of the axis
    Instant written_{};                                 ///< up to this instant; earlier rows are in older files
};

}  // namespace axisgate
