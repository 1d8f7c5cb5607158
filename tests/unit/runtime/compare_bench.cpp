#include "tests/unit/runtime/compare_bench.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/json.hpp>

#include "gateway/runtime/catalogues.hpp"
#include "gateway/wire/frame_export.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate::compare_test {

const Families& families() {
    static const Families loaded = [] {
        std::vector<std::string> faults;
        auto f = load_families(faults);
        EXPECT_TRUE(faults.empty());
        return f;
    }();
    return loaded;
}

Families families_with(const std::string& family, const std::string& freedoms) {
    static std::vector<std::unique_ptr<Catalogue>> kept;
    Families out = families();
    for (auto& e : out.entries) {
        if (e.family->name != family) continue;
        boost::json::object page = e.catalogue->document();
        page["freedoms"] = boost::json::parse(freedoms);
        std::vector<std::string> faults;
        auto catalogue = Catalogue::parse(boost::json::serialize(page), faults);
        EXPECT_TRUE(catalogue) << (faults.empty() ? "" : faults.front());
        kept.push_back(std::make_unique<Catalogue>(std::move(*catalogue)));
        e.catalogue = kept.back().get();
    }
    return out;
}

RecordedTwin::RecordedTwin(const Families& families, const Wish& wish) : family_(families.find(wish.family)) {
    TwinBusOptions o;
    o.kind = wish.kind;
    o.bit_rate = wish.kind == LineKind::can ? family_.family->default_can_bit_rate : family_.family->default_bit_rate;
    o.full_duplex = true;
    bus_ = std::make_unique<TwinBus>(o);
    TwinSetup t;
    t.address = wish.address;
    t.kind = wish.kind;
    t.bit_rate = o.bit_rate;
    t.options = wish.twin_options;
    bus_->add(DriveId{0}, make_specimen(*family_.family, *family_.catalogue, t), {}, now_);
    if (wish.pushed != 0) EXPECT_EQ(bus_->set_hand(DriveId{0}, "position", Value{wish.pushed}, now_), "");
    adapter_ = family_.family->make_adapter(*family_.catalogue, wish.kind);
    LineSetup setup;
    setup.id = LineId{0};
    setup.name = "line";
    setup.kind = wish.kind;
    setup.bit_rate = o.bit_rate;
    DriveSetup d;
    d.id = DriveId{0};
    d.name = "drive";
    d.address = wish.address;
    d.axes.push_back({AxisId{0}, 1});
    setup.drives.push_back(d);
    begin_ = now_ += std::chrono::seconds(5);  // the drive's start is over when the recording begins
    Out out;
    adapter_->configure(setup, now_, out);
    take(out);
    bus_->open(*this, now_);
}

RecordedTwin::~RecordedTwin() { bus_->close(); }

void RecordedTwin::run(Duration time) {
    const Instant end = now_ + time;
    for (;;) {
        const Instant at = std::min(bus_->deadline(), adapter_->deadline());
        if (at > end) break;
        now_ = std::max(now_, at);
        if (bus_->deadline() <= now_) bus_->on_deadline(now_);
        if (adapter_->deadline() > now_) continue;
        Out out;
        adapter_->on_deadline(now_, out);
        take(out);
    }
    now_ = end;
}

Result RecordedTwin::ask(CommandBody body) {
    Command c;
    c.ticket = ++tickets_;
    c.axis = AxisId{0};
    c.body = std::move(body);
    Out out;
    adapter_->on_command(c, now_, out);
    take(out);
    for (int i = 0; i < 10'000 && !results_.contains(tickets_); ++i)
        run(std::chrono::milliseconds(1));
    EXPECT_TRUE(results_.contains(tickets_)) << "one command, one result";
    return results_[tickets_];
}

Result RecordedTwin::read(const std::string& parameter) {
    const auto point = family_.catalogue->find(parameter);
    EXPECT_TRUE(point) << parameter;
    return ask(ReadParameter{point.value_or(Point{})});
}

std::string RecordedTwin::candump() const { return candump_text(entries_, "can0"); }

std::string RecordedTwin::hex() const {
    std::string text;
    for (const TraceEntry& e : entries_) {
        text += fmt::format("({}.{:09}) {}", e.at_unix_ns / 1'000'000'000, e.at_unix_ns % 1'000'000'000, e.to_drive ? '>' : '<');
        for (const std::uint8_t b : e.frame.data())
            text += fmt::format(" {:02X}", b);
        text += '\n';
    }
    return text;
}

void RecordedTwin::take(const Out& out) {
    for (const auto& f : out.frames)
        (void)bus_->send(f.frame, f.priority, now_);
    for (const auto& r : out.results)
        results_[r.ticket] = r;
}

void RecordedTwin::on_frame(const Frame& frame) {
    now_ = std::max(now_, frame.at);
    note(frame, false);
    Out out;
    adapter_->on_frame(frame, now_, out);
    take(out);
}

void RecordedTwin::on_line_state(bool up, const std::string&) {
    Out out;
    adapter_->on_line(up, now_, out);
    take(out);
}

void RecordedTwin::on_sent(const Frame& frame) { note(frame, true); }

void RecordedTwin::note(const Frame& frame, bool to_drive) {
    if (frame.at < begin_) return;
    TraceEntry e;
    e.sequence = entries_.size() + 1;
    e.at_unix_ns = 1'700'000'000'000'000'000 + ns_of(frame.at);
    e.to_drive = to_drive;
    e.frame = frame;
    entries_.push_back(e);
}

}  // namespace axisgate::compare_test
