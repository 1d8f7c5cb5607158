// SiteStage is the state of a staged site: staged, applied on trial, then confirmed or rolled back; and the difference that it makes. The
// time is an argument. It puts no site in force and stores nothing: its owner does, and reports the result. At most one site is staged.
#pragma once

#include <boost/json/array.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/site/site.hpp"

namespace axisgate {

/// The client without its port, which changes with each connection: "anna 192.0.2.7:5123" is "anna 192.0.2.7".
[[nodiscard]] std::string identity_of(std::string_view who);

class SiteStage {
public:
    enum class State : std::uint8_t { none, staged, applying, applied, rolling_back };
    static constexpr std::uint32_t min_trial_s = 5, max_trial_s = 600;

    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] std::uint64_t id() const noexcept { return id_; }
    [[nodiscard]] const Site& site() const noexcept { return site_; }
    [[nodiscard]] const std::string& by() const noexcept { return by_; }
    /// The site was staged on this revision; during the trial, the revision for a roll back.
    [[nodiscard]] std::uint64_t base_revision() const noexcept { return base_revision_; }
    [[nodiscard]] std::int64_t confirm_by_unix_ns() const noexcept { return confirm_by_unix_ns_; }
    /// The site must not be changed in another way: a trial or a step of it is in progress.
    [[nodiscard]] bool busy() const noexcept { return state_ != State::none && state_ != State::staged; }

    /// Replaces a site that was staged before. Returns an empty text, or why it is refused.
    [[nodiscard]] std::string stage(Site site, std::uint64_t base_revision, std::string_view who);
    [[nodiscard]] std::string discard();
    /// Begins to apply. `revision` is now in force.
    [[nodiscard]] std::string begin_apply(std::uint64_t revision, std::uint32_t confirm_within_s, std::int64_t now_unix_ns,
                                          std::string_view who);
    /// The result: on trial, or permanent (begun with 0 s); after a failure the site is staged again.
    void applied(bool good);
    /// Whether this identity may confirm now.
    [[nodiscard]] std::string check_confirm(std::string_view who, std::int64_t now_unix_ns) const;
    void confirmed() { clear(); }
    /// The trial has expired without a confirmation: it must be rolled back now.
    [[nodiscard]] bool expired(std::int64_t now_unix_ns) const noexcept {
        return state_ == State::applied && now_unix_ns >= confirm_by_unix_ns_;
    }
    [[nodiscard]] std::string begin_roll_back();
    /// After a failure the trial continues, and the roll back is repeated from `again_unix_ns` on.
    void rolled_back(bool good, std::int64_t again_unix_ns);

private:
    void clear();

    State state_ = State::none;
    std::uint64_t id_ = 0;
    Site site_;
    std::string by_;
    std::uint64_t base_revision_ = 0;
    std::int64_t confirm_by_unix_ns_ = 0;
};
[[nodiscard]] std::string_view name_of(SiteStage::State state) noexcept;

/// The parts of the site in force that are equal in the next one and are not disturbed.
struct KeptParts {
    const Site& old;
    const Site& next;
    [[nodiscard]] bool line(const LineSpec& l) const {
        const LineSpec* n = next.line(l.name);
        return n && *n == l;
    }
    [[nodiscard]] bool drive(const DriveSpec& d) const {
        const DriveSpec* n = next.drive(d.name);
        const LineSpec* l = old.line(d.line);
        return n && *n == d && l && line(*l);
    }
    [[nodiscard]] bool axis(const AxisSpec& a) const {
        const AxisSpec* n = next.axis(a.name);
        const DriveSpec* d = old.drive(a.drive);
        return n && n->drive == a.drive && n->channel == a.channel && d && drive(*d);
    }
};

/// Entry by entry: {"kind": "added|removed|changed", "what": "lines/can0", "before": {}, "after": {}}; before or after is null if it does
/// not exist.
[[nodiscard]] boost::json::array site_diff(const Site& from, const Site& to);
/// The axes of `from` that lose their connection, because they, their drive or their line change or are removed.
[[nodiscard]] std::vector<std::string> disturbed_axes(const Site& from, const Site& to);

}  // namespace axisgate
