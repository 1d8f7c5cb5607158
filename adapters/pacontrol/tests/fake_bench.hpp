// Bench: the adapter against a simple fake control on a fake serial line, in virtual time. Not the twin: a few tables and straight motions.
// In: commands, scripts ("do not answer 0A94", "answer 300 ms late", "say this instead"). Out: everything the adapter said, with its
// instant, and what crossed the line. A byte takes its 9 bits at the line's rate (rate 0: no time).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "adapters/pacontrol/adapter.hpp"
#include "adapters/pacontrol/wire_number.hpp"
#include "gateway/core/wire_time.hpp"

namespace axisgate::pacontrol::test {

using namespace std::chrono_literals;

/// A catalogue of a few parameters of each form: the tests of the real one are elsewhere.
inline const Catalogue& catalogue() {
    static const Catalogue c = [] {
        const std::string head = R"({"family":"pacontrol","number":3,"title":"t","maker":"m","description":"d","parameters":[)";
        const auto p = [](std::string id, std::string type, std::string access, std::string wire, std::string more = "") {
            return R"({"id":")" + id + R"(","name":"n_)" + id + R"(","group":"g","type":")" + type + R"(","access":")" + access +
                   R"(","storage":"ram","description":"a parameter of the tests")" + more + R"(,"wire":{)" + wire + "}}";
        };
        const std::string array = R"(,"first":1,"count":1024)";
        const std::string text =
            head + p("I", "bool", "R", R"("scope":"drive","read":"1900","form":"bit")", array) + "," +
            p("O", "bool", "RW", R"("scope":"drive","read":"1902","write":"0902","form":"bit")", array) + "," +
            p("MW", "u16", "RW", R"("scope":"drive","read":"1905","write":"0905","form":"word")", R"(,"first":1,"count":64)") + "," +
            p("N", "i32", "RW", R"("scope":"drive","read":"1906","write":"0906","form":"integer")", array) + "," +
            p("R", "f32", "RW", R"("scope":"drive","read":"1907","write":"0907","form":"real")", array) + "," +
            p("SP2", "i32", "RW", R"("scope":"drive","read":"1700","write":"0700","number":2,"form":"integer")") + "," +
            p("AP6", "f32", "RW", R"("scope":"axis","read":"1800","write":"0800","number":6,"form":"real")") + "," +
            p("POS", "f32", "R", R"("scope":"axis","read":"190C","form":"real")") + "," +
            p("T", "text", "RW", R"("scope":"drive")", R"(,"first":1,"count":8)") + R"(],"commands":[],"errors":[]})";
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(text, faults);
        for (const auto& fault : faults)
            ADD_FAILURE() << fault;
        return *std::move(parsed);
    }();
    return c;
}

struct FakeAxis {
    double position = 0, start = 0, target = 0, speed = 10;
    double min = -500, max = 500;
    Instant begun{}, ends{};
    bool running = false, referenced = true, on = false;
    int rest = 0;  ///< 1910 while it stands
    bool positive_free = true, negative_free = true;
    bool held = false;          ///< the position that is told is the shaft's, and a hand holds it
    std::optional<double> lag;  ///< 1915, microsteps
    Instant renewed = never;
    void advance(Instant now) {
        if (!running) return;
        if (renewed != never && now - renewed >= 1s) return stop(renewed + 1s, 2);
        if (now >= ends) {
            position = target;
            running = false;
            rest = 0;
            renewed = never;
            return;
        }
        if (!held) position = start + (target > start ? 1 : -1) * speed * seconds(now - begun);
    }
    void go(double to, Instant now) {
        start = position;
        target = to;
        begun = now;
        ends = now + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(std::fabs(to - start) / speed));
        running = true;
    }
    void stop(Instant now, int with) {
        const Instant when = std::min(now, ends);
        if (running) position = start + (target > start ? 1 : -1) * speed * seconds(when - begun);
        running = false;
        renewed = never;
        rest = with;
    }
};

struct FakeControl {
    std::vector<FakeAxis> axes{4};
    int mode = 1;
    int error = 0;
    bool external_stop = true, silent = false;
    Duration latency = 1ms;
    CheckForm reply_check = CheckForm::with_etx;
    std::optional<CheckForm> demands;  ///< requests must carry this form (or 0)
    std::map<std::uint32_t, double> inputs, outputs, flags, n, r, system, axis_parameters;
    Instant online_at = never;
    int pending = -1;  ///< axis that is being processed
    Duration reference_time = 3s;
    Instant reference_ends = never;
    std::string last = "0;1;1;0;0;0";
    bool unreset = false;

    struct Verdict {
        bool answer = true, execute = true;
        std::optional<std::uint16_t> quit;
        std::optional<std::vector<std::uint8_t>> instead;
        std::optional<Duration> latency;
    };
    std::function<Verdict(const Request&)> script;
    static Verdict lost() { return {false, false, {}, {}, {}}; }
    static Verdict unanswered() { return {false, true, {}, {}, {}}; }
    static Verdict refuse(std::uint16_t q) { return {true, false, q, {}, {}}; }
    static Verdict late(Duration d) { return {true, true, {}, {}, d}; }
    static Verdict say(std::vector<std::uint8_t> b) { return {true, true, {}, std::move(b), {}}; }

    void advance(Instant now) {
        if (mode == 30 && now >= online_at) mode = 31;
        for (auto& a : axes)
            a.advance(now);
    }
    void set_mode(int m, Instant now) {
        mode = m;
        if (m < 30) {
            pending = -1;
            for (auto& a : axes) {
                a.stop(now, 0);
                a.on = false;
            }
        }
    }
    Reply reply(double v = 0, bool real = false, bool end = true) const {
        Reply x;
        x.end = end;
        x.status = static_cast<std::uint8_t>(mode);
        x.error = static_cast<std::uint16_t>(error);
        x.real = real;
        char b[48];
        if (real) {
            std::snprintf(b, sizeof b, "%.4f", v);
        } else {
            std::snprintf(b, sizeof b, "%.0f", v);
        }
        x.data = b;
        return x;
    }
    Reply quit(std::uint16_t q) const {
        Reply x = reply();
        x.quit = q;
        return x;
    }
    /// The answer to a poll.
    Reply polled(Instant now) {
        advance(now);
        if (pending >= 0) {
            auto& a = axes[static_cast<std::size_t>(pending)];
            if (reference_ends != never) {
                if (now < reference_ends) return reply(a.position, true, false);
                a.position = 0;
                a.referenced = true;
                reference_ends = never;
            } else if (a.running) {
                return reply(a.position, true, false);
            }
            pending = -1;
            return reply(a.position, true, true);
        }
        std::string fault;
        Reply x = *reply_of(last, fault);
        x.status = static_cast<std::uint8_t>(mode);
        x.error = static_cast<std::uint16_t>(error);
        return x;
    }
    /// What changes the mode of the control, or its error.
    std::optional<Reply> take_mode(const Request& q, Instant now) {
        switch (q.code) {
            case 0x0600:
                for (auto& x : axes)
                    x.stop(now, 2);
                pending = -1;
                mode = is_online(mode) ? 35 : is_automatic(mode) ? 15 : mode;
                return reply();
            case 0x0602:
                if (mode != 1 && mode != 15) return quit(20);
                mode = 11;
                return reply();
            case 0x0603:
                if (mode != 1 && mode != 35) return quit(20);
                if (!external_stop) return quit(44);
                mode = 30;
                online_at = now + 100ms;
                return reply();
            case 0x0A41:
                if (!is_automatic(mode)) return quit(20);
                set_mode(error ? 9 : 1, now);
                return reply();
            case 0x0A81:
                if (error >= 500) error = 0;
                set_mode(error ? 9 : 1, now);
                return reply();
            case 0x0909:
                if (unreset) {
                    Reply x = quit(21);
                    x.data = std::to_string(error);
                    return x;
                }
                error = 0;
                if (mode == 9) mode = 1;
                return reply();
            default:
                return std::nullopt;
        }
    }
    /// Inputs, outputs, flags, registers and parameters.
    std::optional<Reply> take_register(const Request& q, const CommandInfo& c, double v) {
        const auto store = [&](auto& where, bool real) {
            if (q.parameter < 1 || q.parameter > 1024) return quit(38);
            if (c.data != Carries::nothing) where[q.parameter] = v;
            return reply(where[q.parameter], real);
        };
        switch (q.code) {
            case 0x1900:
                if (q.parameter < 1 || q.parameter > 1024) return quit(35);
                return reply(inputs[q.parameter]);
            case 0x0902:
            case 0x1902:
                return store(outputs, false);
            case 0x0905:
            case 0x1905:
                return store(flags, false);
            case 0x0906:
            case 0x1906:
                return store(n, false);
            case 0x0907:
            case 0x1907:
                return store(r, true);
            case 0x0700:
            case 0x1700:
                return store(system, false);
            case 0x0800:
            case 0x1800:
                if (c.data != Carries::nothing) axis_parameters[q.parameter] = v;
                return reply(axis_parameters[q.parameter], true);
            default:
                return std::nullopt;
        }
    }
    /// What is shown of the control and of an axis.
    std::optional<Reply> take_question(const Request& q, const FakeAxis* a) const {
        switch (q.code) {
            case 0x190B:
                return reply(mode);
            case 0x190C:
                return reply(a->position, true);
            case 0x190D:
                return reply(a->running ? a->speed : 0, true);
            case 0x1910:
                return reply(a->running ? 1 : a->rest);
            case 0x1911: {
                std::uint32_t mask = 0;
                for (std::size_t i = 0; i < axes.size(); ++i)
                    mask |= axes[i].running ? 1u << i : 0u;
                return reply(mask);
            }
            case 0x1913:
                return reply(a->min, true);
            case 0x1914:
                return reply(a->max, true);
            case 0x1915:
                return a->lag ? reply(*a->lag, true) : quit(21);
            case 0x1921:
                return reply(0x01000000 + (a->positive_free ? 0x10000 : 0) + (a->negative_free ? 0x100 : 0) + (a->running ? 1 : a->rest));
            case 0x1934:
                if (q.parameter >= 51 && q.parameter - 51 < axes.size()) return reply(axes[q.parameter - 51].referenced ? 1 : 0);
                return quit(37);
            default:
                return std::nullopt;
        }
    }
    Reply take_move(const Request& q, FakeAxis& a, double v, Instant now) {
        const bool relative = q.code == 0x0A89 || q.code == 0x0A91 || q.code == 0x0A95;
        const double to = relative ? a.position + v : v;
        if (to < a.min || to > a.max) return quit(65);
        if (a.running) return quit(42);
        if (!a.referenced) return quit(43);
        if (!a.on) return quit(55);
        const double from = a.position;
        a.go(to, now);
        if (q.code == 0x0A90 || q.code == 0x0A91) a.renewed = now;
        const bool waits = q.code == 0x0A87 || q.code == 0x0A89;
        if (waits) pending = static_cast<int>(q.parameter) - 1;
        return reply(from, true, !waits);
    }
    std::optional<Reply> take_order(const Request& q, FakeAxis* a, double v, Instant now) {
        switch (q.code) {
            case 0x0A83:
                a->referenced = true;
                return reply();
            case 0x0A84:
                pending = static_cast<int>(q.parameter) - 1;
                reference_ends = now + reference_time;
                return reply(0, false, false);
            case 0x0A85:
                a->position = 0;
                return reply();
            case 0x0A86:
                a->position = v;
                return reply(v, true);
            case 0x0A96:
                a->position = v;
                a->referenced = true;
                return reply(v, true);
            case 0x0A8D:
                if (v > 1000) return quit(41);
                a->speed = v;
                if (a->running) a->go(a->target, now);
                return reply(v, true);
            case 0x0A8E:
                return reply(v, true);
            case 0x0A87:
            case 0x0A89:
            case 0x0A90:
            case 0x0A91:
            case 0x0A94:
            case 0x0A95:
                return take_move(q, *a, v, now);
            case 0x0A92:
                if (a->running && a->renewed != never) a->renewed = now;
                return reply(a->position, true);
            case 0x0A93:
            case 0x0A9A:
                a->stop(now, 2);
                if (pending == static_cast<int>(q.parameter) - 1) {
                    pending = -1;
                    reference_ends = never;
                }
                return reply(a->position, true);
            case 0x0A97:
                a->on = true;
                return reply();
            case 0x0A98:
                a->on = false;
                a->stop(now, 2);
                return reply();
            case 0x0AA0:
                a->rest = 8;
                return reply();
            case 0x0AA1:
                if (a->rest == 8) a->rest = 0;
                return reply();
            default:
                return std::nullopt;
        }
    }
    Reply take(const Request& q, Instant now) {
        advance(now);
        (void)polled(now);  // ends what has come to its end
        const CommandInfo* c = command_info(q.code);
        if (!c) return quit(19);
        const double v = real_of(q.data).value_or(0);
        const bool passes = q.code == 0x0600 || q.code == 0x0A81 || q.code == 0x0A93;
        if (pending >= 0 && !passes) return quit(20);
        if ((c->online_only && mode != 31) || (c->home_only && mode != 1 && mode != 9)) {
            if (!(q.code == 0x0A81 && is_online(mode))) return quit(20);
        }
        FakeAxis* a = nullptr;
        if (c->parameter == Takes::axis) {
            if (q.parameter < 1 || q.parameter > axes.size()) return quit(32);
            a = &axes[q.parameter - 1];
        }
        if (auto answer = take_mode(q, now)) return *answer;
        if (auto answer = take_register(q, *c, v)) return *answer;
        if (auto answer = take_question(q, a)) return *answer;
        return take_order(q, a, v, now).value_or(reply());
    }
};

class Bench {
public:
    explicit Bench(std::size_t axes = 1, std::uint32_t bit_rate = 0, std::map<std::string, std::string> drive = {},
                   std::map<std::string, std::string> line_options = {})
        : adapter(catalogue(), LineKind::bytes) {
        setup.id = LineId{0};
        setup.name = "line";
        setup.bit_rate = bit_rate;
        setup.bits_per_byte = 9;
        setup.options = std::move(line_options);
        DriveSetup d;
        d.id = DriveId{0};
        d.name = "pac";
        d.address = "com1";
        d.options = std::move(drive);
        for (std::size_t i = 0; i < axes; ++i)
            d.axes.push_back({AxisId{static_cast<std::uint16_t>(i)}, static_cast<int>(i) + 1});
        setup.drives.push_back(d);
    }

    void configure() {
        call([&] { adapter.configure(setup, now, out); });
    }
    void line(bool up) {
        line_up = up;
        if (!up) events.clear();
        call([&] { adapter.on_line(up, now, out); });
    }
    void start(Duration d = 3s) {
        configure();
        line(true);
        run(d);
    }
    Ticket command(CommandBody body, bool until_done = false, std::uint16_t axis = 0) {
        Command c;
        c.ticket = ++tickets;
        c.axis = AxisId{axis};
        c.body = std::move(body);
        c.until_done = until_done;
        call([&] { adapter.on_command(c, now, out); });
        return c.ticket;
    }
    Result ask(CommandBody body, bool until_done = false, std::uint16_t axis = 0, Duration limit = 60s) {
        const Ticket t = command(std::move(body), until_done, axis);
        return answer(t, limit);
    }
    Result answer(Ticket t, Duration limit = 60s) {
        run_until([&] { return results.contains(t); }, limit);
        if (!results.contains(t)) {
            ADD_FAILURE() << "no result within " << milliseconds_of(limit) << " ms";
            return {};
        }
        return results.at(t);
    }
    Result action(std::string name, std::string argument = "", std::uint16_t axis = 0) {
        return ask(Action{std::move(name), std::move(argument)}, false, axis);
    }
    Result enable(std::uint16_t axis = 0) { return ask(Enable{}, false, axis); }
    void run(Duration d) {
        const Instant end = now + d;
        while (now < end)
            step(end);
    }
    bool run_until(const std::function<bool()>& f, Duration limit = 20s) {
        const Instant end = now + limit;
        while (!f() && now < end)
            step(end);
        return f();
    }
    /// Bytes that the control says by itself, now.
    void raw(std::vector<std::uint8_t> bytes) {
        call([&] { adapter.on_frame(Frame::run(bytes), now, out); });
    }
    const AxisFeedback& feedback(std::uint16_t axis = 0) { return last_feedback[AxisId{axis}]; }
    static Point point(const std::string& id) {
        const auto p = catalogue().find(id);
        if (!p) ADD_FAILURE() << id << " is not in the catalogue";
        return p.value_or(Point{});
    }
    /// Requests since mark(), polls left out, as their texts.
    std::vector<std::string> reported() const {
        std::vector<std::string> list;
        for (std::size_t i = mark_at; i < sent.size(); ++i) {
            const std::string c = sent[i].text.substr(0, 4);
            if (c != "1911" && c != "190C" && c != "190D" && c != "1910" && c != "1921" && c != "1934" && c != "1915" && c != "EOT" &&
                sent[i].text != "1900;0;0;0" && !(c == "1800" && sent[i].priority == Priority::poll))
                list.push_back(sent[i].text);
        }
        return list;
    }
    void mark() { mark_at = sent.size(); }
    std::size_t notices_of(const std::string& kind) const {
        return static_cast<std::size_t>(std::ranges::count(notices, kind, &Notice::kind));
    }
    std::string notice_text(const std::string& kind) const {
        for (auto it = notices.rbegin(); it != notices.rend(); ++it) {
            if (it->kind == kind) return it->text;
        }
        return "";
    }

    struct Sent {
        std::string text;  ///< "EOT" for a poll
        std::string check;
        Instant at;
        Priority priority;
        std::size_t size;
    };

    LineAdapter adapter;
    FakeControl control;
    LineSetup setup;
    Out out;
    Instant now = time_zero + 1h;
    bool line_up = false;
    std::map<Ticket, Result> results;
    std::map<AxisId, AxisFeedback> last_feedback;
    std::vector<std::pair<AxisId, AxisFeedback>> feedbacks;
    std::vector<Notice> notices;
    std::vector<DriveLink> links;
    std::vector<Sample> samples;
    std::vector<Sent> sent;
    std::size_t mark_at = 0;
    Ticket tickets = 0;
    Duration wire_used{};
    std::function<void(std::vector<std::uint8_t>&)> spoil;  ///< what the line does to answers

private:
    struct Event {
        Instant at;
        bool to_control;
        std::vector<std::uint8_t> bytes;
    };
    void step(Instant end) {
        Instant next = std::min(end, adapter.deadline());
        auto first = std::ranges::min_element(events, {}, &Event::at);
        if (first != events.end() && first->at <= next) {
            const Event e = *first;
            events.erase(first);
            now = std::max(now, e.at);
            if (e.to_control) {
                arrive(e.bytes);
            } else {
                call([&] { adapter.on_frame(Frame::run(e.bytes), now, out); });
            }
            return;
        }
        const bool due = adapter.deadline() <= next;
        now = std::max(now, next);
        if (!due) return;
        call([&] { adapter.on_deadline(now, out); });
        if (adapter.deadline() <= now && ++standing > 100) {
            ADD_FAILURE() << "the deadline does not move on";
            now = end;
            standing = 0;
        } else if (adapter.deadline() > now) {
            standing = 0;
        }
    }
    int standing = 0;
    void answer_with(const std::vector<std::uint8_t>& bytes, Duration after) {
        auto spoiled = bytes;
        if (spoil) spoil(spoiled);
        const Duration d = wire_time(spoiled.size() * 9, setup.bit_rate);
        wire_used += d;
        // Answers leave in order, whatever the delay of one.
        answered_until = std::max(now + after, answered_until) + d;
        if (!spoiled.empty()) events.push_back({answered_until, false, spoiled});
    }
    Instant answered_until{};
    void arrive(const std::vector<std::uint8_t>& bytes) {
        if (control.silent) return;
        Framer f;
        f.push(bytes, {[&](std::string_view text, std::string_view digits) {
                           std::string fault;
                           const auto q = request_of(text, fault);
                           ASSERT_TRUE(q) << fault;
                           const auto v = control.script ? control.script(*q) : FakeControl::Verdict{};
                           Reply r = control.reply();
                           const auto form = form_of_check(text, digits, CheckForm::text);
                           if (control.demands && form != control.demands && digits != "0") {
                               r = control.quit(16);
                           } else if (v.quit) {
                               r = control.quit(*v.quit);
                           } else if (v.execute) {
                               r = control.take(*q, now);
                           }
                           if (v.execute || v.quit) control.last = text_of(r);
                           if (!v.answer) return;
                           answer_with(v.instead ? *v.instead : framed(text_of(r), control.reply_check),
                                       v.latency.value_or(control.latency));
                       },
                       [&] { answer_with(framed(text_of(control.polled(now)), control.reply_check), control.latency); },
                       [&](FrameFault fault, std::span<const std::uint8_t>) { ADD_FAILURE() << name_of(fault); }});
    }
    template <class F>
    void call(F&& f) {
        out.clear();
        f();
        for (const auto& tx : out.frames) {
            ASSERT_TRUE(line_up);
            Sent s{"EOT", "", now, tx.priority, tx.frame.size};
            Framer framer;
            framer.push(tx.frame.data(), {[&](std::string_view text, std::string_view digits) {
                                              s.text = text;
                                              s.check = digits;
                                          },
                                          {},
                                          {}});
            sent.push_back(s);
            const Duration d = wire_time(std::uint64_t{tx.frame.size} * 9, setup.bit_rate);
            wire_used += d;
            events.push_back({now + d, true, {tx.frame.data().begin(), tx.frame.data().end()}});
        }
        for (const auto& x : out.feedback) {
            last_feedback[x.axis] = x.value;
            feedbacks.emplace_back(x.axis, x.value);
        }
        for (const auto& r : out.results) {
            EXPECT_TRUE(results.emplace(r.ticket, r).second) << "a second result for ticket " << r.ticket;
            EXPECT_TRUE(good(r) || !r.text.empty());
        }
        notices.insert(notices.end(), out.notices.begin(), out.notices.end());
        links.insert(links.end(), out.links.begin(), out.links.end());
        samples.insert(samples.end(), out.samples.begin(), out.samples.end());
    }
    std::vector<Event> events;
};

using Lines = std::vector<std::string>;

inline Move absolute(std::int64_t target, std::optional<std::int64_t> v = {}, std::optional<std::int64_t> a = {},
                     std::optional<std::int64_t> d = {}) {
    Move m;
    m.target = target;
    m.velocity = v;
    m.acceleration = a;
    m.deceleration = d;
    return m;
}

/// Found, enabled, nothing said yet.
struct Enabled : Bench {
    explicit Enabled(std::size_t axes = 1, std::map<std::string, std::string> drive = {}, std::uint32_t bit_rate = 0)
        : Bench(axes, bit_rate, std::move(drive)) {
        start();
        for (std::uint16_t i = 0; i < axes; ++i)
            EXPECT_EQ(enable(i).outcome, Outcome::accepted);
        run(500ms);
        mark();
    }
};

}  // namespace axisgate::pacontrol::test
