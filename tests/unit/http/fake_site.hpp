// The site port for tests: a small site of an invented family, put in force when the test wants; ids stay with the names.
#pragma once

#include <boost/json/parse.hpp>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "gateway/core/family.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate::http::test {

inline constexpr std::string_view catalogue_text = R"({
  "family": "demo", "number": 7, "title": "Demo drive", "channels": {"max": 2}, "drive_watchdog": {"available": true, "description": "Its own."}, "drive_limits": {"available": true, "description": "607Dh."},
  "parameters": [
    {"id": "AC", "name": "acceleration", "group": "motion", "type": "u32", "unit": "pulse/s^2", "min": 1, "max": 65000000, "default": 20000,
     "access": "RW", "storage": "eeprom", "description": "Acceleration of motions."},
    {"id": "ML", "name": "model", "group": "identity", "type": "text", "access": "R", "description": "Model name."},
    {"id": "KEY", "name": "unlock", "group": "identity", "type": "u16", "access": "W", "description": "Opens what is locked."},
    {"id": "MT", "name": "micro_steps", "group": "motor", "type": "u8", "allowed": {"1": "full", "16": "sixteenth"}, "default": 16,
     "access": "RW", "description": "Steps."},
    {"id": "PP", "name": "protocol", "group": "bus", "type": "u8", "min": 0, "max": 200, "access": "RW", "description": "Array.", "first": 1, "count": 8, "addressing": true},
    {"id": "N", "name": "registers", "group": "program", "type": "f64", "access": "RW", "description": "Long array.", "first": 1, "count": 2000}
  ],
  "commands": [{"id": "BG", "name": "begin", "description": "Starts.", "confirm": "The axis moves."},
    {"id": "GO", "name": "go", "arguments": [{"name": "position", "type": "i32", "unit": "mm", "scale": 0.0001}, {"name": "speed", "type": "u16", "default": 5}]}],
  "freedoms": [
    {"name": "reply_ms", "unit": "ms", "min": 0, "max": 200, "default": 0, "description": "an answer comes this late", "source": "silent", "named": {"slow": 200}},
    {"name": "echo", "min": 0, "max": 1, "default": 1, "values": {"0": "off", "1": "on"}, "description": "commands are repeated", "source": "L12"}],
  "errors": [{"code": 49, "kind": "error", "name": "overcurrent", "text": "too much current", "cause": "short", "remedy": "look"}]
})";

inline std::string check_demo_address(std::string_view address) {
    return address.find_first_not_of("0123456789") == std::string_view::npos && !address.empty() ? "" : "an address is a number";
}

/// Decodes a frame as its number since the decoder was made, so that a test sees whether it was made anew.
struct DemoDecoder final : Decoder {
    int n = 0;
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) override {
        return {std::string(to_drive.value_or(false) ? "to" : "from") + " the drive, frame " + std::to_string(++n) + " of " +
                std::to_string(frame.data().size()) + " bytes"};
    }
    std::vector<std::string> finish() override { return {}; }
};
inline std::unique_ptr<Decoder> make_demo_decoder(const Catalogue&, LineKind) { return std::make_unique<DemoDecoder>(); }

class FakeSite : public SitePort {
public:
    explicit FakeSite(std::string_view site_text);
    ~FakeSite() override;

    static constexpr std::string_view default_site = R"({
      "lines": [{"name": "can0", "uri": "twin", "family": "demo", "bitrate": 1000000}, {"name": "can1", "uri": "twin", "family": "demo"}],
      "drives": [{"name": "feeder", "line": "can0", "address": 5}, {"name": "slide", "line": "can0", "address": 6}, {"name": "bare", "line": "can1", "address": 7}],
      "axes": [{"name": "feeder", "drive": "feeder", "number": 1, "unit": "mm", "increments_per_unit": 3200},
               {"name": "slide", "drive": "slide", "number": 2, "increments_per_unit": 1}],
      "mappings": [{"unit": 2, "table": "holding", "address": 0, "point": "slide.position", "type": "i32"}] })";

    /// Puts a site in force as if it had been applied; ids stay with the names.
    void put_site(std::string_view text);
    void put_site(Site site);
    [[nodiscard]] AxisId axis(const std::string& name) { return AxisId{id_of("axis " + name)}; }
    [[nodiscard]] DriveId drive(const std::string& name) { return DriveId{id_of("drive " + name)}; }
    [[nodiscard]] LineId line(const std::string& name) { return LineId{id_of("line " + name)}; }

    Catalogue catalogue;
    Family family{};
    std::set<SiteListener*> site_listeners;
    enum class Apply { now, later, fail, overtake_once, overtake_always } apply = Apply::now;
    std::vector<std::pair<Site, std::uint64_t>> applied;  ///< with the expected revision
    std::function<void()> apply_waiting;

    const Families& families() const override { return families_; }
    std::shared_ptr<const SiteState> site() const override { return site_; }

    void apply_site(Site site, std::uint64_t expected, Origin, std::function<void(SiteAnswer)> then) override {
        applied.emplace_back(site, expected);
        if (apply == Apply::fail) return then({false, "the disk is full", site_});
        if (apply == Apply::overtake_once || apply == Apply::overtake_always) {
            if (apply == Apply::overtake_once) apply = Apply::now;
            put_site(Site(site_->site));  // another client was faster
            return then({false, "the site has another revision", site_});
        }
        auto go = [this, site = std::move(site), then]() mutable {
            put_site(std::move(site));
            then({true, "", site_});
        };
        if (apply == Apply::later) {
            apply_waiting = std::move(go);
        } else {
            go();
        }
    }

    std::map<std::uint64_t, SiteRevision> kept_sites;
    std::vector<SiteRevision> site_history(std::size_t limit, std::uint64_t before) const override {
        std::vector<SiteRevision> out;
        for (auto it = kept_sites.rbegin(); it != kept_sites.rend() && out.size() < limit; ++it) {
            if (before == 0 || it->first < before) out.push_back(it->second);
        }
        return out;
    }
    std::optional<SiteRevision> site_revision(std::uint64_t n) const override {
        const auto it = kept_sites.find(n);
        return it == kept_sites.end() ? std::nullopt : std::optional(it->second);
    }
    void listen(SiteListener* l) override { site_listeners.insert(l); }
    void unlisten(SiteListener* l) override { site_listeners.erase(l); }

private:
    std::uint16_t id_of(const std::string& name) { return ids_.emplace(name, static_cast<std::uint16_t>(ids_.size())).first->second; }

    Families families_;
    std::shared_ptr<const SiteState> site_;
    std::map<std::string, std::uint16_t> ids_;
};

inline AxisSpec axis_spec(std::string name, std::string drive, int number, int channel = 1) {
    AxisSpec a;
    a.name = std::move(name);
    a.drive = std::move(drive);
    a.number = number;
    a.channel = channel;
    return a;
}

}  // namespace axisgate::http::test
