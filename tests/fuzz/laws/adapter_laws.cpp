// The run of one adapter and the check of its laws; compiled once for the targets of all families.
#include "tests/fuzz/adapter_laws.hpp"

#include <deque>
#include <map>
#include <set>

#include "gateway/axis/guard.hpp"

namespace axisgate::fuzz {
namespace {

class AdapterRun {
public:
    AdapterRun(const FamilyEntry& entry, const FamilyFrames& frames, FuzzedDataProvider& in, std::vector<std::string> addresses)
        : e_(entry), frames_(frames), in_(in), addresses_(std::move(addresses)) {
        kind_ = e_.family->uses_can && (!e_.family->uses_bytes || in_.ConsumeBool()) ? LineKind::can : LineKind::bytes;
        adapter_ = e_.family->make_adapter(*e_.catalogue, kind_);
        for (std::size_t i = 0; i < addresses_.size(); ++i) {
            TwinSetup t;
            t.address = addresses_[i];
            t.kind = kind_;
            twins_.push_back(e_.family->make_twin(*e_.catalogue, t));
            Out out;
            twins_.back()->power_on({}, now_, out);
        }
    }

    void run() {
        wanted_ = in_.ConsumeIntegralInRange<unsigned>(1, (1u << addresses_.size()) - 1);
        configure();
        line(true);
        for (int step = 0; step < 600 && in_.remaining_bytes() > 0; ++step)
            one();
        // The end of the line ends every command that has not ended by itself.
        line(false);
        for (const auto& [ticket, count] : tickets_)
            require(count == 1, "every ticket gets exactly one result");
    }

private:
    void one() {
        switch (in_.ConsumeIntegralInRange<int>(0, 15)) {
            case 0:
            case 1:
                pass(any_step(in_));
                break;
            case 2:
                to_deadline();
                break;
            case 3:
            case 4:
                command();
                break;
            case 5:
                give(any_frame(in_));
                break;
            case 6:
            case 7:
                give(frames_.plausible(in_, kind_, addresses_));
                break;
            case 8:
                if (in_.ConsumeIntegralInRange<int>(0, 7) == 0) line(!up_);
                break;
            case 9:
                wanted_ = in_.ConsumeIntegralInRange<unsigned>(0, (1u << addresses_.size()) - 1);
                configure();
                break;
            case 10:  // an unnecessary call
                adapter_->on_deadline(now_, out_);
                drain();
                break;
            case 11:
                hand();
                break;
            default:
                wire(in_.ConsumeIntegralInRange<std::size_t>(1, 32));
                break;
        }
    }

    // --- the wire -------------------------------------------------------------------------------------------------------

    /// Carries frames to the twins and back; the fuzzer decides which are lost, doubled or corrupted.
    void wire(std::size_t most) {
        for (std::size_t n = 0; n < most && !sent_.empty(); ++n) {
            Frame f = sent_.front();
            sent_.pop_front();
            const int luck = in_.ConsumeIntegralInRange<int>(0, 31);
            if (luck == 1) continue;
            if (luck == 2) spoil(f);
            for (std::size_t i = 0; i < twins_.size(); ++i) {
                Out answers;
                twins_[i]->on_frame(f, now_, answers);
                collect(answers);
            }
            twins_due();
            if (in_.ConsumeBool()) pass(Duration{in_.ConsumeIntegralInRange<std::int64_t>(0, 500'000)});
        }
    }
    void twins_due() {
        for (auto& t : twins_) {
            int n = 0;
            while (t->deadline() <= now_) {
                Out answers;
                t->on_deadline(now_, answers);
                collect(answers);
                require(++n < 10'000, "a twin's deadline moves on");
            }
        }
    }
    void collect(const Out& answers) {
        for (const auto& tx : answers.frames) {
            const int luck = in_.ConsumeIntegralInRange<int>(0, 31);
            if (luck == 1) continue;
            Frame f = tx.frame;
            if (luck == 2) spoil(f);
            give(f);
            if (luck == 3) give(f);
        }
    }
    void spoil(Frame& f) {
        if (f.size == 0) return;
        const auto i = in_.ConsumeIntegralInRange<std::size_t>(0, f.size - 1u);
        if (in_.ConsumeBool()) {
            f.storage[i] = in_.ConsumeIntegral<std::uint8_t>();
        } else {
            f.size = static_cast<std::uint16_t>(i);
        }
    }

    // --- calls of the adapter -------------------------------------------------------------------------------------------

    void configure() {
        LineSetup s;
        s.id = LineId{0};
        s.name = "line";
        s.kind = kind_;
        s.bit_rate = kind_ == LineKind::can ? 1'000'000 : 57'600;
        configured_.clear();
        for (std::size_t i = 0; i < addresses_.size(); ++i) {
            if (!(wanted_ >> i & 1u)) continue;
            DriveSetup d;
            d.id = DriveId{static_cast<std::uint16_t>(i)};
            d.name = "d" + std::to_string(i);
            d.address = addresses_[i];
            d.axes.push_back({AxisId{static_cast<std::uint16_t>(i)}, 1});
            s.drives.push_back(std::move(d));
            configured_.push_back(addresses_[i]);
        }
        adapter_->configure(s, now_, out_);
        drain();
    }
    void line(bool up) {
        up_ = up;
        if (!up) sent_.clear();
        adapter_->on_line(up, now_, out_);
        drain();
    }
    void give(const Frame& f) {
        if (!up_) return;
        Frame seen = f;
        seen.at = now_;
        adapter_->on_frame(seen, now_, out_);
        drain();
    }
    void to_deadline() {
        const Instant d = adapter_->deadline();
        if (d == never) return;
        pass(std::max(Duration{0}, d - now_));
    }
    /// Advances the time; every deadline on the way is met at its instant, up to a bound, as by a busy loop.
    void pass(Duration step) {
        const Instant end = now_ + step;
        int met = 0, standing = 0;
        while (adapter_->deadline() <= end && met < 200) {
            const Instant due = std::max(now_, adapter_->deadline());
            standing = due == now_ ? standing + 1 : 0;
            require(standing < 100, "an adapter's deadline moves on");
            now_ = due;
            adapter_->on_deadline(now_, out_);
            drain();
            ++met;
        }
        now_ = end;
        twins_due();
    }

    void command() {
        Command c;
        const auto index = in_.ConsumeIntegralInRange<std::size_t>(0, addresses_.size() - 1);
        if (!(wanted_ >> index & 1u)) return;  // the engine asks only for axes of the setup
        c.axis = AxisId{static_cast<std::uint16_t>(index)};
        c.until_done = in_.ConsumeBool();
        c.origin.door = Door::internal;
        auto body = any_body();
        if (!body) return;
        c.body = std::move(*body);
        if (in_.ConsumeIntegralInRange<int>(0, 15) != 0) {
            c.ticket = ++last_ticket_;
            tickets_[c.ticket] = 0;
        }
        adapter_->on_command(c, now_, out_);
        drain();
    }
    std::optional<CommandBody> any_body() {
        switch (in_.ConsumeIntegralInRange<int>(0, 14)) {
            case 0:
            case 1:
                return Enable{};
            case 2:
                return Disable{};
            case 3:
                return QuickStop{};
            case 4:
                return Halt{};
            case 5:
                return ResetFault{};
            case 6:
                return Home{in_.ConsumeIntegral<std::int16_t>()};
            case 7:
                return SetPosition{in_.ConsumeIntegral<std::int32_t>()};
            case 8:
            case 9: {
                Move m;
                m.kind = static_cast<Move::Kind>(in_.ConsumeIntegralInRange<int>(0, 2));
                m.target = in_.ConsumeIntegral<std::int32_t>();
                if (in_.ConsumeBool()) m.velocity = in_.ConsumeIntegral<std::uint32_t>();
                if (in_.ConsumeBool()) m.acceleration = in_.ConsumeIntegral<std::uint32_t>();
                if (in_.ConsumeBool()) m.deceleration = in_.ConsumeIntegral<std::uint32_t>();
                m.prepare_only = in_.ConsumeIntegralInRange<int>(0, 3) == 0;
                if (guard_move(m, AxisLimits{}, 0)) return std::nullopt;  // the guard would have refused it
                return m;
            }
            case 10: {
                StartTogether s;
                for (std::size_t i = 0; i < addresses_.size(); ++i) {
                    if (wanted_ >> i & 1u && in_.ConsumeBool()) s.axes.push_back(AxisId{static_cast<std::uint16_t>(i)});
                }
                if (s.axes.empty()) return std::nullopt;
                return s;
            }
            case 11:
                return ReadParameter{any_point()};
            case 12: {
                const Point p = any_point();
                auto checked = e_.catalogue->check_write(p, any_value(in_));
                if (!checked.fault.empty()) return std::nullopt;
                return WriteParameter{p, std::move(checked.value)};
            }
            case 13: {
                Native n;
                n.is_text = in_.ConsumeBool();
                const std::string s = in_.ConsumeRandomLengthString(40);
                n.send.assign(s.begin(), s.end());
                return n;
            }
            default: {
                Action a;
                const auto commands = e_.catalogue->commands();
                if (!commands.empty() && in_.ConsumeBool()) {
                    const auto& c = commands[in_.ConsumeIntegralInRange<std::size_t>(0, commands.size() - 1)];
                    a.name = in_.ConsumeBool() ? c.name : c.id;
                } else {
                    a.name = in_.ConsumeRandomLengthString(16);
                }
                a.argument = in_.ConsumeRandomLengthString(16);
                return a;
            }
        }
    }
    Point any_point() {
        const auto i = in_.ConsumeIntegralInRange<std::uint16_t>(0, static_cast<std::uint16_t>(e_.catalogue->parameters().size() - 1));
        const Parameter& p = e_.catalogue->parameters()[i];
        if (p.count == 0) return {i, 0};
        return {i, static_cast<std::uint16_t>(p.first + in_.ConsumeIntegralInRange<int>(0, p.count - 1))};
    }
    void hand() {
        auto& t = twins_[in_.ConsumeIntegralInRange<std::size_t>(0, twins_.size() - 1)];
        const auto items = t->hand();
        const auto& item = items[in_.ConsumeIntegralInRange<std::size_t>(0, items.size() - 1)];
        Out answers;
        (void)t->set_hand(item.name, any_value(in_), now_, answers);
        collect(answers);
    }

    // --- laws -----------------------------------------------------------------------------------------------------------

    void drain() {
        Out got;
        std::swap(got, out_);
        require(got.frames.size() <= 4096 && got.results.size() <= 4096 && got.notices.size() <= 4096, "one call gives a bounded amount");
        for (const auto& r : got.results) {
            require(r.ticket != no_ticket, "a command without a ticket gets no result");
            const auto it = tickets_.find(r.ticket);
            require(it != tickets_.end(), "a result has a ticket that was given");
            require(++it->second == 1, "a ticket gets one result alone");
            require(good(r) || !r.text.empty(), "what is refused or failed says why");
            require(good(r) == (r.reason == Reason::none), "what is refused or failed has a reason, and nothing else has one");
            require(index_of(r.axis) < addresses_.size(), "a result has an axis of the line");
        }
        for (const auto& f : got.feedback) {
            require(index_of(f.axis) < addresses_.size(), "feedback has an axis of the line");
            require(f.value.at <= now_, "nothing is known before it was said");
        }
        for (const auto& s : got.samples)
            require(e_.catalogue->parameter(s.point) != nullptr && known(s.value), "a sample has a point and a value");
        for (const auto& n : got.notices)
            require(!n.kind.empty() && !n.text.empty(), "a notice has a kind and a text");
        for (const auto& l : got.links)
            require(index_of(l.drive) < addresses_.size(), "a link has a drive of the line");
        require(up_ || got.frames.empty(), "nothing is sent on a line that is down");
        for (const auto& tx : got.frames) {
            const std::string wrong = frames_.wrong(tx.frame, kind_, configured_);
            if (!wrong.empty()) std::fprintf(stderr, "sent: %s: %s\n", to_text(tx.frame).c_str(), wrong.c_str());
            require(wrong.empty(), "nothing is sent but the protocol, to drives that the setup names");
            sent_.push_back(tx.frame);
        }
        while (sent_.size() > 4096)
            sent_.pop_front();
    }

    const FamilyEntry& e_;
    const FamilyFrames& frames_;
    FuzzedDataProvider& in_;
    std::vector<std::string> addresses_, configured_;
    LineKind kind_{};
    std::unique_ptr<Adapter> adapter_;
    std::vector<std::unique_ptr<Twin>> twins_;
    Out out_;
    Instant now_ = at_ns(1'000'000'000);
    bool up_ = false;
    unsigned wanted_ = 0;
    std::map<Ticket, int> tickets_;
    Ticket last_ticket_ = 0;
    std::deque<Frame> sent_;
};

}  // namespace

void run_adapter(const FamilyEntry& entry, const FamilyFrames& frames, FuzzedDataProvider& in, std::vector<std::string> addresses) {
    AdapterRun(entry, frames, in, std::move(addresses)).run();
}

}  // namespace axisgate::fuzz
