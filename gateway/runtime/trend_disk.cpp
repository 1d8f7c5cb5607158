// A file (.axt) is named by the time at which it was written, in milliseconds, so that the order of names is that of time. The service
// thread waits for the disk only at its end.
#include "gateway/runtime/trend_disk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/json/object.hpp>
#include <boost/json/serialize.hpp>
#include <filesystem>

#include "gateway/axis/image.hpp"
#include "gateway/core/text.hpp"
#include "gateway/runtime/file_shelf.hpp"
#include "gateway/services/recorder/axr.hpp"

namespace axisgate {
namespace {
constexpr std::size_t most_files = 4096;
constexpr std::string_view trend_suffix = ".axt";

void put_u32(std::string& out, std::size_t v) {
    for (unsigned i = 0; i < 4; ++i)
        out.push_back(static_cast<char>(v >> (8 * i)));
}
/// Empty at the end, or if damaged.
std::optional<std::span<const char>> take_part(std::span<const char>& in) {
    if (in.size() < 4) return std::nullopt;
    std::size_t size = 0;
    for (unsigned i = 0; i < 4; ++i)
        size |= static_cast<std::size_t>(static_cast<std::uint8_t>(in[i])) << (8 * i);
    if (size > in.size() - 4) return std::nullopt;
    const auto part = in.subspan(4, size);
    in = in.subspan(4 + size);
    return part;
}

std::vector<std::string> trend_files(const std::string& directory) {
    auto names = names_in(directory, trend_suffix, most_files);
    std::ranges::sort(names);
    return names;
}

/// Writes one file, then deletes the oldest ones.
void put_trends(const std::string& directory, const std::string& name, const std::string& bytes, std::uint64_t bound) {
    if (!put_on_disk(directory + "/" + name + std::string(trend_suffix), directory, bytes).empty()) return;  // the next one may fit
    auto names = trend_files(directory);
    std::uint64_t sum = 0;
    std::error_code ec;
    for (const auto& n : names)
        sum += std::filesystem::file_size(directory + "/" + n + std::string(trend_suffix), ec);
    for (const auto& n : names) {
        if (sum <= bound && names.size() < most_files) break;
        const std::string path = directory + "/" + n + std::string(trend_suffix);
        sum -= std::min<std::uint64_t>(sum, std::filesystem::file_size(path, ec));
        delete_from_disk(path);
    }
}
}  // namespace

std::string TrendDisk::open(std::int64_t now_unix_ns, std::int64_t unix_offset_ns, Duration keep) {
    written_ = at_ns(now_unix_ns - unix_offset_ns);
    std::size_t damaged = 0;
    std::string why;
    for (const auto& name : trend_files(directory_)) {
        const auto written_ms = parse_whole(name, 0, INT64_MAX / 1'000'000);
        if (!written_ms || *written_ms * 1'000'000 < now_unix_ns - keep.count() || *written_ms * 1'000'000 > now_unix_ns) continue;
        const auto bytes = read_whole(directory_ + "/" + name + std::string(trend_suffix));
        const Axr axr = bytes ? read_axr(*bytes) : Axr{"it cannot be read", {}};
        bool good = axr.fault.empty();
        if (!good) why = axr.fault;
        for (auto rest = axr.section(axr_trends); good && !rest.empty();) {
            const auto axis = take_part(rest), packed_rows = take_part(rest);
            auto rows = packed_rows ? unpack_rows(*packed_rows) : std::nullopt;
            good = axis && rows;
            if (!good) continue;
            auto& known = old_[std::string(axis->data(), axis->size())];
            for (TrendRow& r : *rows) {
                r.at = at_ns(ns_of(r.at) - unix_offset_ns);
                if (known.empty() || r.at >= known.back().at) known.push_back(r);
            }
        }
        if (!good) ++damaged;
    }
    return damaged == 0 ? std::string() : fmt::format("{} files of trends in {} are damaged and passed over: {}", damaged, directory_, why);
}

void TrendDisk::bring_back(AxisId axis, Trends& trends, const SiteState& site) {
    if (old_.empty() || trends.knows(axis)) return;
    const auto i = std::ranges::find(site.axis_ids, axis) - site.axis_ids.begin();
    if (static_cast<std::size_t>(i) >= site.site.axes.size()) return;
    const auto it = old_.find(site.site.axes[static_cast<std::size_t>(i)].name);
    if (it == old_.end()) return;
    if (!it->second.empty()) {
        TrendRow gone = it->second.back();  // from here on all values are unknown
        gone.demand_known = false;
        gone.flags = flag_stale;
        gone.statusword = 0;
        it->second.push_back(gone);
    }
    trends.restore(axis, it->second);
    old_.erase(it);
}

std::string TrendDisk::packed(const Trends& trends, const SiteState& site, Instant now, std::int64_t unix_offset_ns) const {
    AxrWriter w;
    w.begin(axr_meta);
    w.add(boost::json::serialize(boost::json::object{{"version", AXISGATE_VERSION}, {"to_unix_ns", ns_of(now) + unix_offset_ns}}));
    w.begin(axr_trends);
    const bool all = unmarked_ && std::ranges::none_of(site.site.axes, &AxisSpec::trend_on_disk);
    bool some = false;
    for (std::size_t i = 0; i < site.axis_ids.size() && i < site.site.axes.size(); ++i) {
        if (!all && !site.site.axes[i].trend_on_disk) continue;
        std::vector<TrendRow> rows;
        for (const auto& c : trends.read(site.axis_ids[i], written_, now, 0).columns) {
            rows.push_back(c.first);
            rows.back().at = at_ns(ns_of(c.first.at) + unix_offset_ns);
        }
        if (rows.empty()) continue;
        const std::string coded = pack_rows(rows);
        std::string part;
        put_u32(part, site.site.axes[i].name.size());
        part += site.site.axes[i].name;
        put_u32(part, coded.size());
        part += coded;
        w.add(part);
        some = true;
    }
    return some ? w.finish() : std::string();
}

void TrendDisk::keep(const Trends& trends, const SiteState& site, Instant now, std::int64_t unix_offset_ns) {
    if (now - written_ < period) return;
    std::string bytes = packed(trends, site, now, unix_offset_ns);
    written_ = now;
    if (bytes.empty()) return;
    const auto ms = (ns_of(now) + unix_offset_ns) / 1'000'000;
    boost::asio::post(disk_, [directory = directory_, bound = bound_, name = std::to_string(ms), bytes = std::move(bytes)] {
        put_trends(directory, name, bytes, bound);
    });
}

void TrendDisk::end(const Trends& trends, const SiteState& site, Instant now, std::int64_t unix_offset_ns) {
    const std::string bytes = packed(trends, site, now, unix_offset_ns);
    if (!bytes.empty()) put_trends(directory_, std::to_string((ns_of(now) + unix_offset_ns) / 1'000'000), bytes, bound_);
}

}  // namespace axisgate
