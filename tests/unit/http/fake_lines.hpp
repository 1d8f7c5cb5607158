// The line and the drive port for tests: reports, records, scans and conditions are set by the test; answers come inside the call.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "gateway/services/ports/drives.hpp"
#include "gateway/services/ports/lines.hpp"

namespace axisgate::http::test {

class FakeLines : public LinePort {
public:
    std::map<LineId, LineReport> line_states;
    std::map<LineId, std::vector<TraceEntry>> traces;
    std::vector<ScanWish> scan_wishes;
    std::map<LineId, ScanReport> scans;
    std::string scan_fault;
    std::vector<SystemPort> ports_of_host;

    std::vector<SystemPort> host_ports() const override { return ports_of_host; }
    LineReport line_report(LineId id) const override {
        const auto it = line_states.find(id);
        return it == line_states.end() ? LineReport{} : it->second;
    }
    Trace trace(LineId id, std::uint64_t since, std::size_t limit) const override {
        Trace t;
        t.next = 1;
        const auto it = traces.find(id);
        if (it == traces.end() || it->second.empty()) return t;
        const std::uint64_t oldest = it->second.front().sequence;
        t.next = std::clamp<std::uint64_t>(since, 1, it->second.back().sequence + 1);
        if (since < oldest) t.missed = oldest - std::max<std::uint64_t>(since, 1);
        for (const auto& e : it->second) {
            if (e.sequence < since || t.entries.size() >= limit) continue;
            t.entries.push_back(e);
            t.next = e.sequence + 1;
        }
        return t;
    }
    void start_scan(LineId line, ScanWish wish, Origin, std::function<void(std::string)> then) override {
        scan_wishes.push_back(std::move(wish));
        if (scan_fault.empty()) scans[line].state = ScanReport::State::running;
        then(scan_fault);
    }
    void cancel_scan(LineId line, std::function<void(ScanReport)> then) override {
        if (scans[line].state == ScanReport::State::running) scans[line].state = ScanReport::State::cancelled;
        then(scans[line]);
    }
    void scan_report(LineId line, std::function<void(ScanReport)> then) override { then(scans[line]); }
};

class FakeDrives : public DrivePort {
public:
    std::map<DriveId, DriveStatus> drive_states;
    std::map<DriveId, std::vector<HandItem>> hands;
    std::string hand_fault;

    DriveStatus drive_status(DriveId id) const override {
        const auto it = drive_states.find(id);
        return it == drive_states.end() ? DriveStatus{} : it->second;
    }
    void hand(DriveId id, std::function<void(std::optional<std::vector<HandItem>>)> then) override {
        const auto it = hands.find(id);
        then(it == hands.end() ? std::nullopt : std::optional(it->second));
    }
    void set_hand(DriveId id, std::vector<std::pair<std::string, Value>> items, Origin, std::function<void(std::string)> then) override {
        if (!hand_fault.empty()) return then(hand_fault);
        for (const auto& [k, v] : items) {
            for (auto& h : hands[id]) {
                if (h.name == k) h.value = v;
            }
        }
        then("");
    }
};

}  // namespace axisgate::http::test
