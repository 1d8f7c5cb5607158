#include "gateway/site/site_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "gateway/core/line_uri.hpp"

namespace axisgate {
namespace {
std::string at(std::string_view list, std::size_t i, std::string_view key) { return fmt::format("/{}/{}/{}", list, i, key); }

template <class T>
std::string names_of(const std::vector<T>& list) {
    std::string s;
    for (const auto& x : list)
        s += (s.empty() ? "" : ", ") + x.name;
    return s.empty() ? "none" : s;
}

/// A byte line has one family, which it names; a CAN line may have several, if each states the identifiers of its frames.
void check_families(const Site& site, const Families& families, std::vector<SiteFault>& faults) {
    for (std::size_t i = 0; i < site.lines.size(); ++i) {
        const auto& l = site.lines[i];
        if (l.family.empty() && kind_of(l, families) == LineKind::bytes && parse_line_uri(l.uri).good()) {
            faults.push_back({fmt::format("/lines/{}/family", i),
                              fmt::format("line {}: family is missing: a line of bytes carries one, by which it is set up", l.name),
                              "use one of: " + families.names()});
        }
    }
    struct Known {
        const DriveSpec* drive;
        FamilyEntry entry;
        std::vector<CanIdentifiers> identifiers;  // empty: every frame
    };
    std::map<std::string, std::vector<Known>> on;
    for (std::size_t i = 0; i < site.drives.size(); ++i) {
        const auto& d = site.drives[i];
        const LineSpec* line = site.line(d.line);
        const auto fault = [&](std::string text, std::string remedy) {
            faults.push_back({fmt::format("/drives/{}/family", i), std::move(text), std::move(remedy)});
        };
        if (!line) continue;
        const LineKind kind = kind_of(*line, families);
        if (d.family.empty() && line->family.empty() && kind == LineKind::can) {
            fault(fmt::format("drive {}: family is missing, and its line {} names none", d.name, line->name),
                  "name it here, or at the line for each of its drives that names none; use one of: " + families.names());
        }
        const FamilyEntry entry = families.find(site.family_of(d));
        if (!d.family.empty()) {
            if (!entry.family) {
                fault(fmt::format("drive {}: there is no family {}", d.name, d.family), "use one of: " + families.names());
            } else if (kind == LineKind::bytes) {
                fault(fmt::format("drive {}: line {} carries bytes, and those of {} alone", d.name, line->name, line->family),
                      "leave family out, or put the drive on a line of its own family");
            } else if (!entry.family->uses_can) {
                fault(fmt::format("drive {}: {} does not speak on CAN", d.name, d.family), "put it on a line of bytes whose family it is");
            }
        }
        if (!entry.family || kind != LineKind::can || !entry.family->uses_can || d.address.empty() ||
            !entry.family->check_address(d.address).empty())
            continue;
        Known mine{&d, entry, {}};
        if (entry.family->can_identifiers) mine.identifiers = entry.family->can_identifiers({&d.address, 1});
        auto& others = on[line->name];
        for (const auto& o : others) {
            if (o.entry.family == entry.family) continue;
            const auto anything = [](const Known& k) { return !k.entry.family->can_identifiers; };
            if (anything(mine) || anything(o)) {
                fault(fmt::format("drive {}: {} cannot share a CAN line with other families", d.name,
                                  (anything(mine) ? entry : o.entry).family->name),
                      "put the drives on lines of their own");
                break;
            }
            if (std::ranges::any_of(mine.identifiers, [&](const CanIdentifiers& x) {
                    return std::ranges::any_of(o.identifiers, [&](const CanIdentifiers& y) { return x.meets(y); });
                })) {
                faults.push_back({fmt::format("/drives/{}/address", i),
                                  fmt::format("drive {} ({}) and drive {} ({}) use the same CAN identifiers", d.name, entry.family->name,
                                              o.drive->name, o.entry.family->name),
                                  "give one of them another address, or another line"});
                break;
            }
        }
        others.push_back(std::move(mine));
    }
    for (std::size_t i = 0; i < site.lines.size(); ++i) {
        if (site.families_on(site.lines[i]).size() > most_families_on_a_line)
            faults.push_back({fmt::format("/lines/{}", i),
                              fmt::format("line {} has drives of more than {} families", site.lines[i].name, most_families_on_a_line),
                              "put some of them on another line"});
    }
}

/// Whether the family of a line supports this kind of line.
void check_kind(const LineSpec& l, std::size_t i, LineUri::Kind kind, const Family& family, std::vector<SiteFault>& faults) {
    if (kind == LineUri::Kind::twin) return;
    const bool is_can = kind == LineUri::Kind::can, is_dds = kind == LineUri::Kind::dds;
    if (is_dds && !family.uses_dds) {
        faults.push_back({at("lines", i, "uri"), fmt::format("{} does not speak on dds: axes of other gateways alone are there", l.family),
                          "use the family remote, or another line"});
    } else if (!is_dds && family.uses_dds) {
        faults.push_back(
            {at("lines", i, "uri"), fmt::format("{} speaks on dds alone: its drives are axes of other gateways", l.family), "use dds"});
    } else if (is_can ? !family.uses_can : !family.uses_bytes) {
        faults.push_back({at("lines", i, "uri"), fmt::format("{} does not speak on {}", l.family, is_can ? "CAN" : "a byte line"),
                          is_can ? "use serial:, tcp: or twin" : "use can: or twin"});
    }
}

void check_line(const Site& site, std::size_t i, const Families& families, std::set<std::string>& uris, std::vector<SiteFault>& faults) {
    const auto& l = site.lines[i];
    const auto family = families.find(l.family);
    if (!l.family.empty() && !family.family) {
        faults.push_back({at("lines", i, "family"), fmt::format("there is no family {}", l.family), "use one of: " + families.names()});
    }
    if (l.uri.empty()) return;
    const auto uri = parse_line_uri(l.uri);
    if (!uri.good()) {
        faults.push_back({at("lines", i, "uri"), uri.fault,
                          "see the line URIs in the manual page: can:can0, serial:/dev/ttyUSB0?baud=9600, tcp:HOST:PORT, twin"});
        return;
    }
    if (family.family) check_kind(l, i, uri.uri.kind, *family.family, faults);
    if (uri.uri.kind != LineUri::Kind::twin && !uris.insert(l.uri).second) {
        faults.push_back({at("lines", i, "uri"), fmt::format("{} is used by two lines", l.uri), "put their drives on one line"});
    }
}

using Addresses = std::set<std::tuple<std::string, std::string_view, std::string>>;

void check_drive(const Site& site, std::size_t i, const Families& families, Addresses& addresses, std::vector<SiteFault>& faults) {
    const auto& d = site.drives[i];
    const LineSpec* line = site.line(d.line);
    if (!d.line.empty() && !line) {
        faults.push_back(
            {at("drives", i, "line"), fmt::format("drive {}: there is no line {}", d.name, d.line), "lines: " + names_of(site.lines)});
    }
    if (!line) return;
    if (const auto family = families.find(site.family_of(d)); family.family && !d.address.empty()) {
        if (std::string wrong = family.family->check_address(d.address); !wrong.empty()) {
            faults.push_back({at("drives", i, "address"), fmt::format("drive {}: {}", d.name, wrong),
                              "the factory address is " + std::string(family.family->factory_address)});
        }
    }
    if (!addresses.emplace(d.line, site.family_of(d), d.address).second) {
        faults.push_back({at("drives", i, "address"), fmt::format("two drives on {} have the address {}", d.line, d.address),
                          "give each drive an address of its own"});
    }
    if (line->uri == "dds" && d.presence != PresenceRule::device) {
        faults.push_back({at("drives", i, "presence"),
                          fmt::format("drive {}: what stands for an axis of another gateway is that axis, or nothing", d.name),
                          "use presence device: its own gateway simulates the drive, and that is shown here"});
    }
    if (line->uri == "twin" && d.presence == PresenceRule::device) {
        faults.push_back({at("drives", i, "presence"), fmt::format("drive {}: a twin line has no real drives", d.name),
                          "use presence twin or auto, or a real line"});
    }
}

struct Places {
    std::set<int> numbers;
    std::set<std::pair<std::string, int>> channels;
};

void check_axis(const Site& site, std::size_t i, const Families& families, Places& taken, std::vector<SiteFault>& faults) {
    const auto& a = site.axes[i];
    const DriveSpec* drive = site.drive(a.drive);
    if (!a.drive.empty() && !drive) {
        faults.push_back(
            {at("axes", i, "drive"), fmt::format("axis {}: there is no drive {}", a.name, a.drive), "drives: " + names_of(site.drives)});
    }
    if (a.number > 0 && !taken.numbers.insert(a.number).second) {
        faults.push_back({at("axes", i, "number"), fmt::format("axis {}: the number {} is taken", a.name, a.number),
                          "give each axis a number of its own: it is its place in the register map"});
    }
    if (!taken.channels.emplace(a.drive, a.channel).second) {
        faults.push_back({at("axes", i, "channel"), fmt::format("axis {}: channel {} of {} is taken", a.name, a.channel, a.drive),
                          "one axis per channel"});
    }
    const auto catalogue = drive ? catalogue_of(site, *drive, families) : nullptr;
    const int highest = catalogue ? catalogue->most_channels() : a.channel;
    if (a.channel > highest) {
        faults.push_back({at("axes", i, "channel"),
                          fmt::format("axis {}: a {} has {} channel{}", a.name, catalogue->family(), highest, highest == 1 ? "" : "s"),
                          fmt::format("use 1 to {}", highest)});
    }
}
}  // namespace

void check_relations(const Site& site, const Families& families, std::vector<SiteFault>& faults) {
    std::set<std::string> uris;
    for (std::size_t i = 0; i < site.lines.size(); ++i)
        check_line(site, i, families, uris, faults);
    check_families(site, families, faults);
    Addresses addresses;
    for (std::size_t i = 0; i < site.drives.size(); ++i)
        check_drive(site, i, families, addresses, faults);
    Places taken;
    for (std::size_t i = 0; i < site.axes.size(); ++i)
        check_axis(site, i, families, taken, faults);
}

}  // namespace axisgate
