// The host of the replayed engine: its lines and doors repeat the recorded inputs. A record may have any origin; one that cannot be read
// ends the replay with a reason.
#include "gateway/engine/replay.hpp"

#include <fmt/format.h>

#include <deque>
#include <functional>
#include <map>
#include <set>
#include <unordered_map>

#include "gateway/engine/engine.hpp"

namespace axisgate {
namespace {

/// The data that all lines of the recording share, by line.
struct Cable {
    std::uint64_t handed = 0;
    std::set<std::uint64_t> refused;
    LineEvents* events = nullptr;
    /// A call of a line during a turn, with the index of the turn among the inputs.
    struct Within {
        std::size_t input;
        Instant at;
        FlightRecord record;
    };
    std::deque<Within> within;
};
using Cables = std::map<std::uint16_t, Cable>;

class RecordedLine final : public Line {
public:
    using Tell = std::function<void(Cable&)>;
    RecordedLine(Cable& cable, Tell tell) : cable_(cable), tell_(std::move(tell)) {}
    ~RecordedLine() override { cable_.events = nullptr; }
    void open(LineEvents& events, Instant) override {
        cable_.events = &events;
        tell_(cable_);
    }
    void close() override { cable_.events = nullptr; }
    bool send(const Frame&, Priority, Instant) override { return !cable_.refused.contains(++cable_.handed); }
    [[nodiscard]] Instant deadline() const override { return cable_.within.empty() ? never : cable_.within.front().at; }
    void on_deadline(Instant) override { tell_(cable_); }
    [[nodiscard]] LineStatus status(Instant) const override { return {}; }

private:
    Cable& cable_;
    Tell tell_;
};

class Player final : public EngineHost, FlightTap {
public:
    Player(const Families& families, const ReplayInput& recording) : families_(families), recording_(recording) {
        // Descriptions in the recording are valid for this replay only.
        families_.descriptions = std::make_shared<DescriptionShelf>();
        engine_ = std::make_unique<Engine>(families_, *this, image_, 16);
        engine_->set_tap(this);
    }

    ReplayReport run() {
        if (!read()) return std::move(report_);
        for (std::size_t i = 0; i < inputs_.size() && report_.fault.empty(); ++i) {
            last_ = i + 1 == inputs_.size();
            current_ = i;
            give(inputs_[i]);
            ++report_.inputs;
        }
        if (!inputs_.empty()) report_.span = inputs_.back().at - inputs_.front().at;
        for (auto& [key, stream] : streams_) {
            if (!report_.fault.empty()) break;
            for (; stream.next < stream.records.size(); ++stream.next)
                differs(to_text(stream.records[stream.next]), "");
        }
        return std::move(report_);
    }

private:
    struct Stream {
        std::vector<FlightRecord> records;
        std::size_t next = 0;
    };
    static std::uint32_t key_of(const FlightRecord& r) { return static_cast<std::uint32_t>(r.kind) << 16 | r.index; }

    bool read() {
        FlightReader inputs(recording_.inputs);
        while (const auto r = inputs.next()) {
            if (r->kind == FlightKind::last_received || r->kind == FlightKind::send_refused) {
                const auto n = unpack<std::int64_t>(r->payload);
                if (!n) return broken(*r);
                if (r->kind == FlightKind::last_received)
                    received_.push_back(*n);
                else
                    cables_[r->index].refused.insert(static_cast<std::uint64_t>(*n));
            } else if (const bool within = of_a_line(r->kind) && (r->index & flight_within) != 0; within && !inputs_.empty()) {
                FlightRecord plain = *r;
                plain.index = static_cast<std::uint16_t>(r->index & ~flight_within);
                cables_[plain.index].within.push_back({inputs_.size() - 1, inputs_.back().at, plain});
            } else if (is_input(r->kind)) {
                inputs_.push_back(*r);
            }
        }
        FlightReader window(recording_.window);
        while (const auto r = window.next()) {
            if (!is_input(r->kind)) streams_[key_of(*r)].records.push_back(*r);
        }
        if (inputs.damaged() || window.damaged()) report_.fault = "the records are damaged";
        if (report_.fault.empty() && (inputs_.empty() || inputs_.front().kind != FlightKind::site))
            report_.fault = "the recording does not begin with a site";
        return report_.fault.empty();
    }
    static bool of_a_line(FlightKind k) { return k == FlightKind::received || k == FlightKind::sent || k == FlightKind::line_state; }
    /// A call of a line during the current turn.
    void tell(Cable& cable) {
        while (!cable.within.empty() && cable.within.front().input <= current_ && report_.fault.empty()) {
            const FlightRecord r = cable.within.front().record;
            cable.within.pop_front();
            give(r);
        }
    }
    bool broken(const FlightRecord& r) {
        report_.fault = fmt::format("a record of kind {} cannot be read", name_of(r.kind));
        return false;
    }

    template <class T, class F>
    void with(const FlightRecord& r, F&& f) {
        const auto v = unpack<T>(r.payload);
        if (!v) return (void)broken(r);
        f(*v);
    }
    void give(const FlightRecord& r) {
        now_ = r.at;
        Engine& e = *engine_;
        switch (r.kind) {
            case FlightKind::site:
                return give_site(r);
            case FlightKind::turn:
                return e.on_deadline(r.at);
            case FlightKind::command:
                return with<CommandRecord>(r, [&](const CommandRecord& c) { e.on_command(c.command, r.at); });
            case FlightKind::set_point:
                return with<SetPointRecord>(r, [&](const SetPointRecord& p) { (void)e.on_set_point(p.set_point, r.at); });
            case FlightKind::client_lost:
                return with<LossRecord>(r, [&](const LossRecord& l) { e.on_client_lost(l.who, l.cause, r.at); });
            case FlightKind::stored:
                return with<StoredRecord>(r, [&](const StoredRecord& s) { e.on_stored(s.order, s.fault, r.at); });
            case FlightKind::scan:
                return with<ScanWish>(r, [&](const ScanWish& w) { (void)e.start_scan(LineId{r.index}, w, r.at); });
            case FlightKind::look:
                return with<LookRecord>(r, [&](const LookRecord& l) { (void)e.look_closely(l.axes, l.period, l.until, r.at); });
            case FlightKind::scan_cancel:
                return e.cancel_scan(LineId{r.index}, r.at);
            case FlightKind::hand:
                return with<HandRecord>(r, [&](const HandRecord& h) { (void)e.set_hand(DriveId{r.index}, h.items, h.origin, r.at); });
            case FlightKind::twin_memory:
                return with<HandRecord>(r, [&](const HandRecord& h) {
                    (void)e.adopt(DriveId{r.index}, {h.items.begin(), h.items.end()}, h.origin, r.at);
                });
            case FlightKind::shut_down:
                return e.shut_down(r.at);
            case FlightKind::received:
            case FlightKind::sent:
                return with<FrameRecord>(r, [&](const FrameRecord& f) {
                    LineEvents* events = cables_[r.index].events;
                    if (!events) return differs(to_text(r), "");
                    Frame frame = f.frame;
                    frame.at = r.at;
                    r.kind == FlightKind::sent ? events->on_sent(frame) : events->on_frame(frame);
                });
            case FlightKind::line_state:
                return with<LineStateRecord>(r, [&](const LineStateRecord& s) {
                    if (LineEvents* events = cables_[r.index].events)
                        events->on_line_state(s.up, s.why);
                    else
                        differs(to_text(r), "");
                });
            default:
                return;
        }
    }
    void give_site(const FlightRecord& r) {
        auto in = read_site_input(r.payload, families_, report_.fault);
        if (!in) return;
        engine_->set_lease(in->lease);
        engine_->set_watchdog(in->watchdog);
        if (in->at_once)
            (void)engine_->apply_site(std::move(in->site), std::move(in->memory), in->revision, r.at);
        else
            engine_->change_site(std::move(in->site), std::move(in->memory), in->revision, r.at, {});
    }

    // EngineHost
    std::unique_ptr<Line> make_line(const LineSpec&, const LineSetup& setup) override {
        return std::make_unique<RecordedLine>(cables_[index_of(setup.id)], [this](Cable& c) { tell(c); });
    }
    void on_result(const Result&) override {}
    void on_event(Event, Instant) override {}
    void on_sample(const Sample&) override {}
    void on_store(StoreOrder) override {}
    void on_twin_memory(const std::string&, NonVolatile) override {}
    [[nodiscard]] std::optional<Instant> last_received(const AuthorityClient&) const override {
        if (next_received_ >= received_.size()) return std::nullopt;
        const std::int64_t at = received_[next_received_++];
        return at < 0 ? std::nullopt : std::optional(at_ns(at));
    }

    // FlightTap: the outputs of this engine.
    void take_site(std::shared_ptr<const SiteInput>, Instant) override {}
    void take(const FlightRecord& r) override {
        if (is_input(r.kind) || outcomes_++ < recording_.outcomes_before) return;
        Stream& stream = streams_[key_of(r)];
        if (stream.next >= stream.records.size()) {
            if (!last_) differs("", to_text(r));  // the recording may lack a part of the last input's outcomes
            return;
        }
        const FlightRecord& was = stream.records[stream.next++];
        ++report_.compared;
        if (was.at != r.at || !std::ranges::equal(was.payload, r.payload)) differs(to_text(was), to_text(r));
    }
    void differs(std::string recorded, std::string replayed) {
        if (report_.differences++ < ReplayReport::most_listed) report_.listed.push_back({std::move(recorded), std::move(replayed)});
    }

    Families families_;
    const ReplayInput& recording_;
    ReplayReport report_;
    Image image_;
    Cables cables_;
    std::vector<FlightRecord> inputs_;
    std::vector<std::int64_t> received_;
    mutable std::size_t next_received_ = 0;
    std::map<std::uint32_t, Stream> streams_;
    std::uint64_t outcomes_ = 0;
    std::size_t current_ = 0;
    bool last_ = false;
    Instant now_{};
    std::unique_ptr<Engine> engine_;  // destroyed first, because its lines use the other members
};

}  // namespace

ReplayReport replay(const Families& families, const ReplayInput& recording) { return Player(families, recording).run(); }

}  // namespace axisgate
