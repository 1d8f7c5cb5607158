// Embedded drives by themselves on a line that any program can open: a maker's tool, a terminal, a test. There is no adapter; the tester's
// conditions are set over HTTP.
#include <fmt/core.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <csignal>
#include <cstdio>
#include <memory>

#include "gateway/core/line_uri.hpp"
#include "gateway/doors/http/hand_server.hpp"
#include "gateway/lines/make_line.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/command_tables.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/services/parameters/memory_file.hpp"
#include "gateway/site/options.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate {
namespace {
/// The drives' own time: real time since the start, scaled.
class ScaledClock {
public:
    explicit ScaledClock(double scale) : scale_(scale), begun_(monotonic_now()) {}
    [[nodiscard]] Instant now() const { return at(monotonic_now()); }
    [[nodiscard]] Instant at(Instant real) const {
        return time_zero + std::chrono::seconds(1) +
               Duration(static_cast<std::int64_t>(static_cast<double>((real - begun_).count()) * scale_));
    }
    [[nodiscard]] Instant real(Instant scaled) const {
        if (scaled == never) return never;
        const auto d = scaled - (time_zero + std::chrono::seconds(1));
        const double ns = static_cast<double>(d.count()) / scale_;
        return ns > 9e17 ? never : begun_ + Duration(static_cast<std::int64_t>(ns) + 1);
    }

private:
    double scale_;
    Instant begun_;
};

class TwinHost final : public LineEvents {
public:
    TwinHost(boost::asio::io_context& io, double scale, std::string state_file)
        : clock_(scale), timer_(io), state_file_(std::move(state_file)) {}

    struct Drive {
        std::string address;
        std::unique_ptr<Twin> twin;
        std::uint64_t saved = 0;
    };
    std::vector<Drive> drives;
    std::unique_ptr<Line> line;
    bool up = false;
    std::string why;

    void power_on(const std::map<std::string, NonVolatile>& memories) {
        for (auto& d : drives) {
            const auto m = memories.find(d.address);
            Out out;
            passed_ = clock_.now();
            d.twin->power_on(m == memories.end() ? NonVolatile{} : m->second, passed_, out);
            d.saved = d.twin->non_volatile_revision();
            send(out);
        }
        arm();
    }
    void on_frame(const Frame& frame) override {
        // At the time of the wire: frames that this process receives together after a pause did not reach the drives at one instant.
        Frame f = frame;
        f.at = passed_ = std::max(passed_, clock_.at(frame.at));
        for (auto& d : drives) {
            pass_until(d, f.at);
            Out out;
            d.twin->on_frame(f, f.at, out);
            send(out);
        }
        after();
    }
    void on_line_state(bool now_up, const std::string& text) override {
        up = now_up;
        why = text;
    }
    void on_sent(const Frame&) override {}

    /// As of now: a drive that was not asked may have moved since.
    std::vector<HandItem> hand(std::size_t index) {
        const Instant now = passed_ = std::max(passed_, clock_.now());
        pass_until(drives[index], now);
        Out out;
        drives[index].twin->on_deadline(now, out);
        send(out);
        after();
        return drives[index].twin->hand();
    }
    std::string set_hand(std::size_t index, const std::vector<std::pair<std::string, Value>>& items) {
        std::string wrong;
        const Instant now = passed_ = std::max(passed_, clock_.now());
        pass_until(drives[index], now);
        for (const auto& [name, value] : items) {
            Out out;
            wrong = drives[index].twin->set_hand(name, value, now, out);
            send(out);
            if (!wrong.empty()) break;
        }
        after();
        return wrong;
    }

private:
    /// Limit of deadlines that one late turn handles, each at its own instant; the rest follow in the next turn.
    static constexpr int events_per_turn = 10'000;
    /// Real time of one turn of the timer, so that bytes that a timer of the line reads meanwhile are handled in between.
    static constexpr Duration slice = std::chrono::milliseconds(1);

    /// A drive reacts at the instant of the cause, however late this process runs.
    void pass_until(Drive& d, Instant now) {
        Instant last{};
        for (int i = 0; i < events_per_turn && d.twin->deadline() <= now; ++i) {
            Out out;
            last = std::max(d.twin->deadline(), last + std::chrono::microseconds(1));  // a drive that stays due must not stop the time
            if (last > now) return;
            d.twin->on_deadline(last, out);
            send(out);
        }
    }
    void send(const Out& out) {
        for (const auto& tx : out.frames)
            (void)line->send(tx.frame, tx.priority, monotonic_now());
    }
    void after() {
        save();
        arm();
    }
    void save() {
        bool changed = false;
        for (auto& d : drives) {
            const auto revision = d.twin->non_volatile_revision();
            changed = changed || revision != d.saved;
            d.saved = revision;
        }
        if (!changed || state_file_.empty()) return;
        std::map<std::string, NonVolatile> memories;
        for (auto& d : drives)
            memories[d.address] = d.twin->non_volatile();
        if (const std::string fault = write_file(state_file_, memories_to_json(memories)); !fault.empty()) complain(fault);
    }
    void arm() {
        Instant next = never;
        for (auto& d : drives)
            next = std::min(next, d.twin->deadline());
        const Instant real = clock_.real(next);
        if (real == armed_) return;
        armed_ = real;
        timer_.cancel();
        if (real == never) return;
        timer_.expires_at(std::chrono::steady_clock::time_point(
            std::chrono::duration_cast<std::chrono::steady_clock::duration>(real.time_since_epoch())));
        timer_.async_wait([this, real](const boost::system::error_code& ec) {
            // A timer whose time had come when it was cancelled calls back without an error: another one is set, or none.
            if (ec || real != armed_) return;
            armed_ = never;
            passed_ = std::max(passed_ + std::chrono::microseconds(1), clock_.at(std::min(real + slice, monotonic_now())));
            for (auto& d : drives) {
                pass_until(d, passed_);
            }
            after();
        });
    }

    ScaledClock clock_;
    Instant passed_{};  ///< the time of the drives; it is behind the clock while a late process catches up
    boost::asio::steady_timer timer_;
    Instant armed_ = never;
    std::string state_file_;
};

/// The checked request of the command line.
struct TwinPlan {
    LineUri uri;
    std::vector<std::string> addresses;
    std::map<std::string, std::string> options;
    std::map<std::string, NonVolatile> memories;
};

/// Empty if something is wrong, which was reported.
std::optional<TwinPlan> plan_of(const TwinOptions& o, const FamilyEntry& entry) {
    const Family& family = *entry.family;
    TwinPlan plan;
    auto uri = parse_line_uri(o.line_uri, family.default_bit_rate, family.default_format);
    bool usable = true;
    const auto refuse = [&usable](const std::string& text) {
        complain(text);
        usable = false;
    };
    if (!uri.good()) refuse("--line: " + uri.fault);
    if (uri.good() && (uri.uri.kind == LineUri::Kind::twin || uri.uri.kind == LineUri::Kind::dds))
        refuse("--line: twin and dds are lines of `serve` alone; use tcp-listen:HOST:PORT, pty:PATH, serial: or can:");
    if (!(o.time_scale >= 0.001 && o.time_scale <= 10000)) refuse("--time-scale: write a number from 0.001 to 10000");
    plan.uri = uri.uri;
    plan.addresses = o.addresses;
    if (plan.addresses.empty()) plan.addresses.emplace_back(family.factory_address);
    for (const auto& a : plan.addresses) {
        if (const std::string wrong = family.check_address(a); !wrong.empty()) refuse("--address: " + wrong);
        if (std::ranges::count(plan.addresses, a) > 1) refuse(fmt::format("--address: {} is there twice", a));
    }
    for (const auto& x : o.options) {
        const auto equals = x.find('=');
        if (equals == std::string::npos || equals == 0) {
            refuse("--option: write NAME=VALUE");
        } else {
            const std::string name = x.substr(0, equals), value = x.substr(equals + 1);
            if (const std::string wrong = check_option(*entry.catalogue, {OptionOf::twin}, name, value); !wrong.empty())
                refuse("--option: " + wrong);
            plan.options[name] = value;
        }
    }
    if (!o.specimen.empty()) {
        if (const std::string wrong = check_option(*entry.catalogue, {OptionOf::twin}, "specimen", o.specimen); !wrong.empty())
            refuse("--specimen: " + wrong);
        if (!plan.options.emplace("specimen", o.specimen).second)
            refuse("--specimen: --option names a specimen, too; leave one of them out");
    }
    if (usable && !o.state_file.empty()) {
        std::string fault;
        if (const auto text = read_file(o.state_file, fault)) {
            const std::string wrong = memories_from_json(*text, plan.memories);
            if (!wrong.empty()) refuse(fmt::format("--state {}: {}", o.state_file, wrong));
        } else if (const std::string made = write_file(o.state_file, memories_to_json({})); !made.empty()) {
            refuse("--state: " + made);
        }
    }
    return usable ? std::optional(std::move(plan)) : std::nullopt;
}

void connect_drives(TwinHost& host, boost::asio::io_context& io, const TwinOptions& o, const FamilyEntry& entry, const TwinPlan& plan) {
    const Family& family = *entry.family;
    const LineKind kind = plan.uri.kind == LineUri::Kind::can ? LineKind::can : LineKind::bytes;
    for (const auto& a : plan.addresses) {
        TwinSetup t;
        t.address = a;
        t.kind = kind;
        const bool rated = plan.uri.kind == LineUri::Kind::serial || plan.uri.kind == LineUri::Kind::pty;
        t.bit_rate = rated ? plan.uri.serial.baud : 0;
        t.options = plan.options;
        t.axes = 16;  // as many channels as the family has
        host.drives.push_back({a, make_specimen(family, *entry.catalogue, t), 0});
    }
    LineSetup setup;
    setup.name = o.line_uri;
    setup.kind = kind;
    setup.bit_rate = kind == LineKind::can ? family.default_can_bit_rate : family.default_bit_rate;
    host.line = make_real_line(o.line_uri, setup, io, family.default_format, {}, Duration::zero());
    host.line->open(host, monotonic_now());
    host.power_on(plan.memories);
}

std::unique_ptr<http::HandServer> hand_server(TwinHost& host, boost::asio::io_context& io, const std::string& bind) {
    if (bind.empty()) return nullptr;
    std::vector<http::HandServer::Drive> list;
    for (std::size_t i = 0; i < host.drives.size(); ++i) {
        list.push_back({host.drives[i].address, [&host, i] { return host.hand(i); },
                        [&host, i](const std::vector<std::pair<std::string, Value>>& items) { return host.set_hand(i, items); }});
    }
    return std::make_unique<http::HandServer>(io, bind, std::move(list));
}
}  // namespace

int command_twin(const TwinOptions& o) {
    const auto families = families_or_complain();
    if (!families) return exit_failed;
    const auto entry = family_or_complain(*families, o.family);
    if (!entry) return exit_usage;
    const auto plan = plan_of(o, *entry);
    if (!plan) return exit_usage;

    (void)std::signal(SIGPIPE, SIG_IGN);
    boost::asio::io_context io{1};
    TwinHost host(io, o.time_scale, o.state_file);
    connect_drives(host, io, o, *entry, *plan);
    const auto hand = hand_server(host, io, o.hand_bind);
    if (const std::string fault = hand ? hand->open() : ""; !fault.empty()) {
        complain(fault);
        return exit_failed;
    }
    boost::asio::signal_set signals(io, SIGINT, SIGTERM);
    signals.async_wait([&io](const boost::system::error_code& ec, int) {
        if (!ec) io.stop();
    });
    boost::asio::steady_timer wait(io);
    std::string reported;
    std::function<void()> look = [&] {
        if (host.up) {
            std::string list;
            for (const auto& a : plan->addresses)
                list += (list.empty() ? "" : ",") + a;
            fmt::print("ready {} addresses={} line={}{}\n", o.family, list, host.line->status(monotonic_now()).text,
                       hand ? " hand=" + hand->address() : "");
            std::fflush(stdout);
            return;
        }
        if (!host.why.empty() && host.why != reported) {
            reported = host.why;
            complain(fmt::format("{}: {}; trying again", o.line_uri, reported));
        }
        wait.expires_after(std::chrono::milliseconds(5));
        wait.async_wait([&look](const boost::system::error_code& ec) {
            if (!ec) look();
        });
    };
    look();
    io.run();
    host.line->close();
    io.restart();
    for (int i = 0; i < 100 && io.poll() > 0; ++i) {
    }
    return exit_good;
}

}  // namespace axisgate
