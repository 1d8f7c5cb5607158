// Bench: the adapter against simple fake nodes on a fake line, in virtual time. Not the twin: a table of answers and a few flags.
// In: commands, scripts ("do not answer BG", "answer 30 ms late"). Out: everything the adapter said, with its instant, and what crossed the
// line. The line takes its time per frame and lets urgent frames overtake, as real lines do.
#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <sstream>

#include "adapters/uim342/adapter.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::uim342::test {

using namespace std::chrono_literals;
using Bytes = std::initializer_list<std::uint8_t>;
using Words = std::initializer_list<std::uint16_t>;
using Methods = std::initializer_list<std::int16_t>;

inline const Catalogue& catalogue() {
    static const Catalogue c = [] {
        std::ifstream f(AXISGATE_SOURCE_DIR "/schema/families/uim342.json");
        std::stringstream s;
        s << f.rdbuf();
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(s.str(), faults);
        for (const auto& fault : faults)
            ADD_FAILURE() << fault;
        return *std::move(parsed);
    }();
    return c;
}

inline std::string hex(const Message& m) {
    std::string s;
    char b[4];
    for (const unsigned v : {unsigned{m.cw}}) {
        std::snprintf(b, sizeof b, "%02X", v);
        s += b;
    }
    for (const auto v : m.data()) {
        std::snprintf(b, sizeof b, " %02X", v);
        s += b;
    }
    return s;
}

inline std::vector<std::uint8_t> le(std::uint32_t v, std::size_t n) {
    std::vector<std::uint8_t> b;
    for (std::size_t i = 0; i < n; ++i)
        b.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
    return b;
}

/// A drive made of a table. Knows nothing of ramps: a motion runs until the test ends it (or ends at once, see `instant_motion`).
struct FakeNode {
    explicit FakeNode(std::uint8_t address) : id(address) {
        values = {{0x0105, le(0, 1)},      {0x0107, le(address, 1)}, {0x0108, le(10, 1)},      {0x0600, le(0, 2)},  {0x0601, le(1, 2)},
                  {0x0602, le(0, 2)},      {0x0603, le(0, 2)},       {0x0604, le(0, 2)},       {0x0605, le(0, 2)},  {0x0606, le(1, 2)},
                  {0x0607, le(0, 2)},      {0x0700, le(1, 2)},       {0x0701, le(1, 2)},       {0x0702, le(1, 2)},  {0x0708, le(1, 2)},
                  {0x1000, le(16, 2)},     {0x1001, le(28, 2)},      {0x1002, le(50, 2)},      {0x1003, le(0, 2)},  {0x19FF, le(10000, 4)},
                  {0x1AFF, le(10000, 4)},  {0x1BFF, le(0, 4)},       {0x1CFF, le(1600000, 4)}, {0x2DFF, le(0, 4)},  {0x3400, le(0x8080, 2)},
                  {0x3401, le(0x8080, 2)}, {0x3402, le(0x8080, 2)},  {0x3403, le(0, 2)},       {0x3500, le(0, 2)},  {0x3501, le(0, 2)},
                  {0x3502, le(0, 2)},      {0x3D00, le(1000, 2)},    {0x3D01, le(100, 2)},     {0x3D02, le(17, 2)}, {0x3D03, le(1, 2)},
                  {0x3D04, le(3200, 2)},   {0x2E00, le(0, 4)},       {0x2E01, le(0, 4)},       {0x2E02, le(0, 4)},  {0x2E03, le(0, 4)},
                  {0x2E04, le(0, 4)},      {0x18FF, le(0, 1)}};
        for (std::uint16_t g = 2; g <= 7; ++g) {
            for (const std::uint16_t cw : Words{0x19, 0x1A, 0x1E, 0x1F, 0x20})
                group[static_cast<std::uint16_t>(g << 8 | cw)] = le(500u + g, 4);
        }
    }

    std::uint8_t id;
    std::map<std::uint16_t, std::vector<std::uint8_t>> values;  // cw << 8 | index (FF: none) -> data
    std::map<std::uint16_t, std::vector<std::uint8_t>> group;   // MF << 8 | cw
    std::vector<std::uint8_t> ml{0x22, 0x14, 0x13, 0x00, 0x2A, 0x01, 0x00, 0x00};
    bool on = false, stop = true, paif = false, tlif = false, lock = false, err = false;
    std::uint8_t inputs = 0, mode = 0, mf = 0;
    std::int32_t position = 0, relative = 0, speed = 0;
    std::array<std::uint8_t, 6> last_error{};
    bool instant_motion = false;  ///< PTP ends at its target at once
    bool silent = false;
    Duration latency = 200us;
    std::vector<Message> received;  ///< every instruction that reached it, in order
    std::vector<Instant> received_at;
    int busy = 0, most_busy = 0;  ///< instructions with acknowledgement that were not answered yet (stops apart)

    /// What a script wants of one instruction.
    struct Verdict {
        bool answer = true;  ///< false: executed or not, nothing is said
        bool execute = true;
        std::uint8_t error = 0;          ///< refuse with this code
        std::optional<Message> instead;  ///< say this
        std::optional<Duration> latency;
    };
    std::function<Verdict(const Message&)> script;
    static Verdict answer_if(bool yes) {
        Verdict v;
        v.answer = yes;
        return v;
    }
    static Verdict lost() {
        Verdict v;
        v.answer = v.execute = false;
        return v;
    }
    static Verdict refuse(std::uint8_t code) {  ///< 0: does as it is told
        Verdict v;
        v.error = code;
        return v;
    }
    static Verdict refuse_if(bool yes, std::uint8_t code) { return refuse(yes ? code : std::uint8_t{0}); }
    static Verdict late(Duration d) {
        Verdict v;
        v.latency = d;
        return v;
    }
    static Verdict say_instead(const Message& m) {
        Verdict v;
        v.instead = m;
        return v;
    }

    std::vector<std::uint8_t> status() const {
        const auto a = static_cast<std::uint8_t>(mode | (on ? 4 : 0) | inputs << 3);
        const auto b = static_cast<std::uint8_t>((stop ? 1 : 0) | (paif ? 2 : 0) | (tlif ? 8 : 0) | (lock ? 0x20 : 0) | (err ? 0x80 : 0));
        std::vector<std::uint8_t> d{0, a, b, 0};
        const auto p = le(static_cast<std::uint32_t>(relative), 4);
        d.insert(d.end(), p.begin(), p.end());
        return d;
    }
    std::vector<std::uint8_t> speed_and_position() const {
        std::vector<std::uint8_t> d{1};
        for (const auto v : le(static_cast<std::uint32_t>(speed), 3))
            d.push_back(v);
        for (const auto v : le(static_cast<std::uint32_t>(position), 4))
            d.push_back(v);
        return d;
    }
    Message say(std::uint8_t cw, const std::vector<std::uint8_t>& data) const { return message(id, cw, data); }
    Message error_report(std::uint8_t code, const Message& about) {
        const bool indexed =
            about.dl > 0 && (about.function() <= 0x07 || about.function() == 0x0F || about.function() == 0x10 || about.function() == 0x11 ||
                             about.function() == 0x2E || (about.function() >= 0x34 && about.function() <= 0x35) ||
                             about.function() == 0x3D || about.function() == 0x7E);
        last_error = {0, code, about.cw, indexed ? about.d[0] : std::uint8_t{0}, 0, 0};
        err = true;
        mf = 0;
        return say(0x0F, {last_error.begin(), last_error.end()});
    }
    std::uint32_t number(std::uint16_t key) const { return get_u32(values.at(key).data()); }

    void set_driver(bool to) {
        on = to;
        if (on) return;
        stop = true;
        lock = false;
        speed = 0;
    }
    /// BG.
    Message take_begin(const Message& m) {
        const std::uint8_t f = m.function();
        if (!on) return error_report(0x3E, m);
        if (lock) return error_report(0x3F, m);
        paif = false;
        stop = false;
        if (mode == 0) {
            speed = static_cast<std::int32_t>(number(0x2E02));
            stop = speed == 0;
        } else if (instant_motion) {
            finish();
        }
        return say(f, {0, 0, 0, 0});
    }
    /// JV, SP, PR and PA.
    Message take_wanted(const Message& m) {
        const std::uint8_t f = m.function();
        const std::vector<std::uint8_t> data(m.d.begin(), m.d.begin() + m.dl);
        const std::uint8_t selected = std::exchange(mf, std::uint8_t{0});
        const std::uint8_t g = f == 0x1D ? std::uint8_t{0} : selected;  // JV has one value, and uses the selection up
        if (m.dl == 0) {
            if (g != 0) return say(f, group[static_cast<std::uint16_t>(g << 8 | f)]);
            const std::int32_t v = f == 0x1F ? relative : f == 0x20 ? position : speed;
            return say(f, le(static_cast<std::uint32_t>(v), 4));
        }
        const std::uint8_t index = f == 0x1F ? 3 : f == 0x20 ? 4 : 2;
        if (g != 0) {
            group[static_cast<std::uint16_t>(g << 8 | f)] = data;
        } else {
            if (f == 0x1E && mode == 0) return error_report(0x32, m);
            if (f != 0x1E) mode = f == 0x1D ? 0 : 1;
            if (f != 0x1E) values[0x2E00] = le(mode, 4);
            if (f == 0x1F) relative_set = true;
            if (f == 0x20) relative_set = false;
            values[static_cast<std::uint16_t>(0x2E00 | index)] = data;
        }
        std::vector<std::uint8_t> d{index};
        d.insert(d.end(), data.begin(), data.end());
        return say(0x2E, d);
    }
    /// Executes and answers one instruction.
    std::optional<Message> take(const Message& m) {
        const std::uint8_t f = m.function();
        const auto key = [&](std::uint8_t index) { return static_cast<std::uint16_t>(f << 8 | index); };
        const std::vector<std::uint8_t> data(m.d.begin(), m.d.begin() + m.dl);
        switch (f) {
            case 0x0B:
                return say(f, ml);
            case 0x0C:
                return say(f, {1, 2, 3, 4, 5, 6, 7, 8});
            case 0x0F:
                if (m.dl >= 2) last_error = {};
                return say(f, {m.d[0], last_error[1], last_error[2], last_error[3], 0, 0});
            case 0x11:
                if (m.dl == 2) paif = tlif = err = false;
                return say(f, m.d[0] == 0 ? status() : speed_and_position());
            case 0x15:
                if (m.dl == 1) set_driver(m.d[0] != 0);
                return say(f, {std::uint8_t{on}});
            case 0x16:
                return take_begin(m);
            case 0x17:
                stop = true;
                speed = 0;
                return say(f, {});
            case 0x18:
                if (m.dl == 1) mf = m.d[0];
                return say(f, {mf});
            case 0x1D:
            case 0x1E:
            case 0x1F:
            case 0x20:
                return take_wanted(m);
            case 0x19:
            case 0x1A:
            case 0x1B:
            case 0x1C:
            case 0x2D: {
                const std::uint8_t g = std::exchange(mf, std::uint8_t{0});
                auto& where = g != 0 && (f == 0x19 || f == 0x1A) ? group[static_cast<std::uint16_t>(g << 8 | f)] : values[key(0xFF)];
                if (m.dl != 0) where = data;
                return say(f, where);
            }
            case 0x21:
                if (!stop) return error_report(0x41, m);
                position = relative = 0;
                return say(f, {});
            case 0x37: {
                if (m.dl == 4) inputs = static_cast<std::uint8_t>((inputs & 7) | (m.d[0] & 1) << 3);
                return say(f, {static_cast<std::uint8_t>(inputs & 7), static_cast<std::uint8_t>(inputs >> 3 & 1), 0, 0});
            }
            case 0x7E:
                return m.d[0] == 1 || m.d[0] == 2 ? std::nullopt : std::optional(error_report(0x34, m));
            default:
                break;
        }
        const auto it = m.dl > 0 ? values.find(key(m.d[0])) : values.end();
        if (it == values.end()) return error_report(instruction(f) ? 0x34 : 0x32, m);
        if (m.dl > 1) it->second.assign(data.begin() + 1, data.end());
        std::vector<std::uint8_t> d{m.d[0]};
        d.insert(d.end(), it->second.begin(), it->second.end());
        return say(f, d);
    }
    /// The motion in progress ends at its target.
    void finish() {
        const std::int32_t target =
            relative_set ? position + static_cast<std::int32_t>(number(0x2E03)) : static_cast<std::int32_t>(number(0x2E04));
        relative = target - position;
        position = target;
        speed = 0;
        stop = paif = true;
    }
    bool relative_set = false;
};

class Bench {
public:
    explicit Bench(LineKind line_kind = LineKind::can) : kind(line_kind), adapter(catalogue(), line_kind) {
        setup.id = LineId{0};
        setup.name = "line";
        setup.kind = kind;
    }

    /// A drive of the setup, and a fake behind its address; axis and drive numbers count up from 0.
    FakeNode& add(std::uint8_t id, std::map<std::string, std::string> options = {}, bool with_fake = true) {
        DriveSetup d;
        const auto n = static_cast<std::uint16_t>(setup.drives.size());
        d.id = DriveId{n};
        d.name = "d" + std::to_string(id);
        d.address = std::to_string(id);
        d.axes = {{AxisId{n}, 1}};
        d.options = std::move(options);
        setup.drives.push_back(d);
        if (with_fake)
            fakes[id] = std::make_unique<FakeNode>(id);
        else
            fakes[id] = nullptr;
        static FakeNode nobody(127);
        return with_fake ? *fakes[id] : nobody;
    }
    FakeNode& fake(std::uint8_t id) { return *fakes.at(id); }

    void configure() {
        call([&] { adapter.configure(setup, now, out); });
    }
    void line(bool up) {
        line_up = up;
        if (!up) {
            queue.clear();
            arriving.clear();
        }
        call([&] { adapter.on_line(up, now, out); });
    }
    /// Configured, up, every fake found and read.
    void start(Duration d = 500ms) {
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
        const Ticket t = c.ticket;
        call([&] { adapter.on_command(c, now, out); });
        return t;
    }
    /// Sends a command and lets time pass until it has its result (at most `limit`).
    Result ask(CommandBody body, bool until_done = false, std::uint16_t axis = 0, Duration limit = 20s) {
        const Ticket t = command(std::move(body), until_done, axis);
        const Instant end = now + limit;
        while (!results.contains(t) && now < end)
            step(end);
        if (!results.contains(t)) {
            ADD_FAILURE() << "no result within " << milliseconds_of(limit) << " ms";
            return {};
        }
        return results.at(t);
    }
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
    /// The drive says something by itself, now.
    void say(const Message& m) { arriving.emplace(now, m); }
    void raw(const Frame& f) {
        call([&] { adapter.on_frame(f, now, out); });
    }

    const AxisFeedback& feedback(std::uint16_t axis = 0) const {
        static const AxisFeedback nothing;
        const auto it = last_feedback.find(AxisId{axis});
        return it == last_feedback.end() ? nothing : it->second;
    }
    Value sample(const std::string& id, std::uint16_t axis = 0) const {
        const auto p = catalogue().find(id);
        if (!p) {
            ADD_FAILURE() << id << " is not in the catalogue";
            return {};
        }
        const auto it = samples.find({AxisId{axis}, *p});
        return it == samples.end() ? Value{} : it->second;
    }
    static Point point(const std::string& id) {
        const auto p = catalogue().find(id);
        if (!p) ADD_FAILURE() << id << " is not in the catalogue";
        return p.value_or(Point{});
    }
    Result read(const std::string& id, std::uint16_t axis = 0) { return ask(ReadParameter{point(id)}, false, axis); }
    Result write(const std::string& id, std::int64_t v, std::uint16_t axis = 0) {
        return ask(WriteParameter{point(id), Value{v}}, false, axis);
    }
    Result native(const std::string& text) {
        Native n;
        n.send.assign(text.begin(), text.end());
        return ask(n);
    }
    Result native_hex(std::vector<std::uint8_t> bytes) {
        Native n;
        n.send = std::move(bytes);
        n.is_text = false;
        return ask(n);
    }
    /// What a node heard since mark(), polls (MS[0], MS[1]) left out, as "CW data" lines.
    std::vector<std::string> received(std::uint8_t id, bool polls = false) {
        std::vector<std::string> list;
        const auto& h = fakes.at(id)->received;
        for (std::size_t i = marks[id]; i < h.size(); ++i) {
            if (!polls && h[i].cw == 0x91 && h[i].dl == 1) continue;
            list.push_back(hex(h[i]));
        }
        return list;
    }
    void mark() {
        for (auto& [id, f] : fakes) {
            if (f) marks[id] = f->received.size();
        }
        sent_mark = sent.size();
    }
    std::size_t notices_of(const std::string& kind_of) const {
        return static_cast<std::size_t>(std::ranges::count_if(notices, [&](const Notice& n) { return n.kind == kind_of; }));
    }
    const DriveLink* link(std::uint16_t drive = 0) const {
        for (auto it = links.rbegin(); it != links.rend(); ++it) {
            if (it->drive == DriveId{drive}) return &*it;
        }
        return nullptr;
    }

    LineKind kind;
    LineAdapter adapter;
    LineSetup setup;
    Out out;
    Instant now = time_zero + 1h;
    bool line_up = false;
    CrcMode crc = CrcMode::twelve;                          ///< of the fake gateway on a byte line
    Duration frame_time = 130us;                            ///< one frame at 1 Mbit/s
    std::function<bool(const Frame&, bool to_drive)> lose;  ///< true: the frame is lost
    std::function<void()> on_sent;                          ///< the adapter gave a frame to the line
    std::map<std::uint8_t, std::unique_ptr<FakeNode>> fakes;

    std::map<Ticket, Result> results;
    std::map<Ticket, int> result_count;
    std::map<AxisId, AxisFeedback> last_feedback;
    std::vector<Out::Feedback> feedbacks;
    std::map<std::pair<AxisId, Point>, Value> samples;
    std::vector<Notice> notices;
    std::vector<DriveLink> links;
    struct Sent {
        Instant at;
        Message message;
        Priority priority;
        bool broadcast;
    };
    std::vector<Sent> sent;  ///< everything the adapter gave to the line
    std::size_t sent_mark = 0;
    Ticket tickets = 100;

private:
    struct Waiting {
        Message message;
        Frame frame;
        Priority priority;
    };

    template <class F>
    void call(F&& f) {
        out.clear();
        f();
        for (const auto& tx : out.frames) {
            Message m;
            if (kind == LineKind::can) {
                EXPECT_EQ(producer_of(tx.frame.id), host_id);
                m = message(consumer_of(tx.frame.id), static_cast<std::uint8_t>(tx.frame.id), tx.frame.data());
            } else {
                UiBytes b{};
                EXPECT_EQ(tx.frame.size, uimessage_size);
                std::ranges::copy(tx.frame.data(), b.begin());
                const auto check = check_uimessage(b, crc);
                if (!check.good) {
                    sent.push_back({now, {}, tx.priority, false});
                    continue;  // a gateway ignores what it cannot check
                }
                m = check.message;
            }
            if (on_sent) on_sent();
            const bool broadcast = !fakes.contains(m.id);
            sent.push_back({now, m, tx.priority, broadcast});
            if (line_up) queue.push_back({m, tx.frame, tx.priority});
        }
        for (const auto& fb : out.feedback) {
            last_feedback[fb.axis] = fb.value;
            feedbacks.push_back(fb);
        }
        for (const auto& s : out.samples)
            samples[{s.axis, s.point}] = s.value;
        for (const auto& r : out.results) {
            ++result_count[r.ticket];
            EXPECT_EQ(result_count[r.ticket], 1) << "ticket " << r.ticket << " answered twice: " << r.text;
            results[r.ticket] = r;
        }
        for (const auto& l : out.links)
            links.push_back(l);
        for (const auto& n : out.notices)
            notices.push_back(n);
    }

    void step(Instant end) {
        Instant next = std::min(end, adapter.deadline());
        if (!queue.empty()) next = std::min(next, std::max(now, line_free));
        if (!arriving.empty()) next = std::min(next, arriving.begin()->first);
        if (next > now) now = next;
        if (!arriving.empty() && arriving.begin()->first <= now) {
            const Message m = arriving.begin()->second;
            arriving.erase(arriving.begin());
            deliver(m);
            return;
        }
        if (!queue.empty() && line_free <= now) {
            // Urgent before commands before polls; among equals in order.
            std::size_t best = 0;
            for (std::size_t i = 1; i < queue.size(); ++i) {
                if (queue[i].priority < queue[best].priority) best = i;
            }
            const Waiting w = queue[best];
            queue.erase(queue.begin() + static_cast<std::ptrdiff_t>(best));
            line_free = now + frame_time;
            if (!lose || !lose(w.frame, true)) receive(w.message);
            return;
        }
        if (adapter.deadline() <= now) call([&] { adapter.on_deadline(now, out); });
    }

    void receive(const Message& m) {
        for (auto& [id, f] : fakes) {
            if (!f || f->silent) continue;
            const auto group = f->values[0x0108][0];
            if (m.id != id && m.id != 0 && m.id != group) continue;
            f->received.push_back(m);
            f->received_at.push_back(now);
            FakeNode::Verdict v;
            if (f->script) v = f->script(m);
            const Duration latency = v.latency.value_or(f->latency);
            std::optional<Message> reply;
            if (v.error) {
                reply = f->error_report(v.error, m);
            } else if (v.instead) {
                reply = *v.instead;
                reply->id = id;
            } else if (v.execute) {
                reply = f->take(m);
            }
            const bool is_error = reply && reply->cw == 0x0F && m.function() != 0x0F;
            if (!reply || !v.answer || (!m.wants_ack() && !is_error) || (m.function() == 0x7E && !is_error)) continue;
            // A drive answers in order.
            Instant at = now + frame_time + latency;
            at = std::max(at, last_reply[id]);
            last_reply[id] = at;
            arriving.emplace(at, *reply);
        }
    }

    void deliver(const Message& m) {
        if (!line_up) return;
        Frame f;
        if (kind == LineKind::can) {
            f = Frame::can_extended(can_id(m.id, host_id, m.cw), m.data());
        } else {
            f = Frame::run(to_uimessage(m, crc));
        }
        f.at = now;
        if (lose && lose(f, false)) return;
        call([&] { adapter.on_frame(f, now, out); });
    }

    std::deque<Waiting> queue;
    std::multimap<Instant, Message> arriving;
    std::map<std::uint8_t, Instant> last_reply;
    std::map<std::uint8_t, std::size_t> marks;
    Instant line_free{};
};

inline std::vector<std::string> lines(std::initializer_list<const char*> l) { return {l.begin(), l.end()}; }

inline Move absolute(std::int64_t target, std::optional<std::int64_t> v = {}, std::optional<std::int64_t> a = {},
                     std::optional<std::int64_t> d = {}) {
    Move m;
    m.kind = Move::Kind::absolute;
    m.target = target;
    m.velocity = v;
    m.acceleration = a;
    m.deceleration = d;
    return m;
}
inline Move relative(std::int64_t target, std::int64_t v) {
    Move m = absolute(target, v);
    m.kind = Move::Kind::relative;
    return m;
}
inline Move jog(std::int64_t v) {
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = v;
    return m;
}

}  // namespace axisgate::uim342::test
